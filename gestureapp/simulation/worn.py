"""From a hand's motion to the specific force at the sensor strapped on it. Pure."""

import math

import numpy as np
from numpy.typing import NDArray

from gestureapp.simulation.motion import Coordinate, Motion

F64 = NDArray[np.float64]

STANDARD_GRAVITY = 9.80665
"""m/s^2 in one g."""
SENSOR_ABOVE_WRIST_M = 0.03
"""Height of the sensor over the axis that the hand rolls about (the paper's box is 20 mm thick)."""
SENSOR_BEFORE_WRIST_M = 0.05
"""Distance of the sensor in front of the axis that the hand pitches about."""
POSTURE_SWAY_HZ = (0.15, 0.7)
"""Slow wandering of a hand that is held still."""
TREMOR_HZ = (8.0, 12.0)
"""Physiological tremor of the hand. Source: Elble and Koller, Tremor (1990)."""
_TREMOR_PARTS = 4
_SWAY_PARTS = 3


class WornSensor:
    """A sensor on a hand: geometry, strap, tremor and sway; owned by one arm.

    Args:
        strap_rad: Rotation of the sensor against the hand, about X, Y, Z.
        tremor_g: Tremor per axis, root mean square.
        sway_rad: Wandering of roll and pitch, root mean square.
        rng: Decides the course of tremor and sway.

    Attributes:
        yaw_radius_m: From the axis of turns about Z to the sensor.
        swing_radius_m: From the elbow to the sensor.
        before_wrist_m: From the axis of turns about Y forward to the sensor.
    """

    def __init__(
        self,
        strap_rad: tuple[float, float, float],
        tremor_g: float,
        sway_rad: float,
        rng: np.random.Generator,
    ) -> None:
        self.yaw_radius_m = 0.0
        self.swing_radius_m = 0.0
        self.before_wrist_m = SENSOR_BEFORE_WRIST_M
        self._strap = _rotation(*strap_rad)
        self._tremor = _Wander(rng, 3, _TREMOR_PARTS, TREMOR_HZ, tremor_g)
        self._sway = _Wander(rng, 2, _SWAY_PARTS, POSTURE_SWAY_HZ, sway_rad)

    def accel(self, motion: Motion, times_s: F64) -> F64:
        """Specific force in g at the sensor, shape (n, 3)."""
        q, v, a = motion.at(times_s)
        sway = self._sway.at(times_s)
        roll = q[:, Coordinate.ROLL] + sway[:, 0]
        pitch = q[:, Coordinate.PITCH] + sway[:, 1]
        force = self._in_heading(q, v, a) / STANDARD_GRAVITY
        force[:, 2] += 1.0
        force = _into_hand(force, roll, pitch) + self._of_turning(v, a) / STANDARD_GRAVITY
        return (force + self._tremor.at(times_s)) @ self._strap

    def _in_heading(self, q: F64, v: F64, a: F64) -> F64:
        """Acceleration of the wrist in level axes that turn with the hand's yaw, in m/s^2."""
        c, s = np.cos(q[:, Coordinate.YAW]), np.sin(q[:, Coordinate.YAW])
        swing, r = q[:, Coordinate.SWING], self.swing_radius_m
        v_swing, a_swing = v[:, Coordinate.SWING], a[:, Coordinate.SWING]
        forward = -r * (np.sin(swing) * a_swing + np.cos(swing) * v_swing**2)
        up = r * (np.cos(swing) * a_swing - np.sin(swing) * v_swing**2)
        centripetal = -self.yaw_radius_m * v[:, Coordinate.YAW] ** 2
        tangential = self.yaw_radius_m * a[:, Coordinate.YAW]
        x = c * a[:, Coordinate.X] + s * a[:, Coordinate.Y]
        y = -s * a[:, Coordinate.X] + c * a[:, Coordinate.Y]
        return np.stack(
            [x + forward + centripetal, y + tangential, a[:, Coordinate.Z] + up], axis=1
        )

    def _of_turning(self, v: F64, a: F64) -> F64:
        """What roll and pitch add, as the sensor is off their axes; sensor axes, m/s^2."""
        h, l = SENSOR_ABOVE_WRIST_M, self.before_wrist_m  # noqa: E741
        v_roll, a_roll = v[:, Coordinate.ROLL], a[:, Coordinate.ROLL]
        v_pitch, a_pitch = v[:, Coordinate.PITCH], a[:, Coordinate.PITCH]
        return np.stack(
            [
                h * a_pitch - l * v_pitch**2,
                -h * a_roll,
                -l * a_pitch - h * (v_roll**2 + v_pitch**2),
            ],
            axis=1,
        )


class _Wander:
    """A smooth sum of sines with random frequency and phase, of given root mean square."""

    def __init__(
        self,
        rng: np.random.Generator,
        channels: int,
        parts: int,
        band_hz: tuple[float, float],
        rms: float,
    ) -> None:
        self._omega = 2.0 * np.pi * rng.uniform(*band_hz, (channels, parts))
        self._phase = rng.uniform(0.0, 2.0 * np.pi, (channels, parts))
        self._size = rms * math.sqrt(2.0 / parts)

    def at(self, times_s: F64) -> F64:
        """Values of shape (n, channels)."""
        angle = times_s[:, None, None] * self._omega + self._phase
        values: F64 = self._size * np.sin(angle).sum(axis=2)
        return values


def _into_hand(force: F64, roll: F64, pitch: F64) -> F64:
    """Turn vectors of level axes into those of a hand pitched, then rolled about its own X."""
    cp, sp, cr, sr = np.cos(pitch), np.sin(pitch), np.cos(roll), np.sin(roll)
    x = cp * force[:, 0] - sp * force[:, 2]
    z = sp * force[:, 0] + cp * force[:, 2]
    y = cr * force[:, 1] + sr * z
    return np.stack([x, y, cr * z - sr * force[:, 1]], axis=1)


def _rotation(rx: float, ry: float, rz: float) -> F64:
    """Matrix of right-handed turns about X, then Y, then Z; its columns are the turned axes."""
    cx, sx, cy, sy = math.cos(rx), math.sin(rx), math.cos(ry), math.sin(ry)
    cz, sz = math.cos(rz), math.sin(rz)
    about_x = np.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]])
    about_y = np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    about_z = np.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]])
    turned: F64 = about_z @ about_y @ about_x
    return turned
