"""A sensor with errors of its own, laid here and there, as rows of what it reads."""

import numpy as np

from gestureapp.setup.fit import UP
from gestureapp.setup.values import Position

RATE_HZ = 100.0
PERFECT = np.eye(3)
OFF = np.array([[1.08, 0.01, -0.01], [0.01, 0.93, 0.02], [-0.01, 0.02, 1.05]])
"""8 % of gain, 1 to 2 % of cross-axis: what the sensor reads of the truth."""
OFF_OFFSET_G = np.array([0.05, -0.08, 0.03])


def turn(vector_deg):
    """The rotation about this vector by its length in degrees."""
    vector = np.radians(np.asarray(vector_deg, float))
    angle = np.linalg.norm(vector)
    if angle == 0.0:
        return np.eye(3)
    x, y, z = vector / angle
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


class Lying:
    """A sensor and the clock of its samples."""

    def __init__(self, sensor=PERFECT, offset_g=(0.0, 0.0, 0.0), noise_g=0.003, seed=0):
        self.sensor, self.offset_g, self.noise_g = sensor, np.asarray(offset_g), noise_g
        self.rng = np.random.default_rng(seed)
        self.now_s = 100.0

    def reads(self, truth):
        """Rows (n, 4) of these true specific forces, one a period."""
        truth = np.atleast_2d(truth)
        times = self.now_s + np.arange(1, len(truth) + 1) / RATE_HZ
        self.now_s = float(times[-1])
        noise = self.rng.standard_normal(truth.shape) * self.noise_g
        return np.column_stack([times, truth @ self.sensor.T + self.offset_g + noise])

    def rest(self, up, seconds):
        """Lies so that this direction of its own points up."""
        return self.reads(np.tile(np.asarray(up, float), (round(seconds * RATE_HZ), 1)))

    def carried(self, start, end, seconds=0.6):
        """Is taken from one place to another."""
        share = np.linspace(0.0, 1.0, round(seconds * RATE_HZ))[:, None]
        way = (1 - share) * np.asarray(start, float) + share * np.asarray(end, float)
        jerk = 0.3 * np.sin(40 * share) * np.array([1.0, -1.0, 1.0])
        return self.reads(way + jerk)


def fed(machine, rows, step=10):
    """Hand rows over, some at a time, as a thread at 10 Hz would."""
    for k in range(0, len(rows), step):
        part = rows[k : k + step]
        machine.step(float(part[-1, 0]), part)
    return machine.view


def laid(machine, sensor, position, seconds=2.0, askew_deg=(0.0, 0.0, 0.0)):
    """Carry the sensor into a position and leave it there."""
    up = turn(askew_deg) @ np.array(UP[position])
    fed(machine, sensor.carried((0.5, 0.5, 0.5), up))
    return fed(machine, sensor.rest(up, seconds))


def waited(machine, sensor, seconds):
    """Time goes by and no sample comes."""
    for _ in range(round(seconds * 10)):
        sensor.now_s += 0.1
        machine.step(sensor.now_s, np.empty((0, 4)))
    return machine.view


ALL = tuple(Position)
