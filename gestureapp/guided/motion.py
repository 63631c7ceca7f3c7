"""What can be read off one take: level, rest, onset, posture, and a curve to compare. Pure.

Times are from the activation, in s; readings in g, shape (k, 3), as the sensor gives them.
"""

import math
from typing import Final

import numpy as np

from gestureapp.recording.take_values import AFTER_S, BEFORE_S, F64

ONSET_G: Final = 0.12
"""So far from its rest the hand is on its way: four times an ordinary tremor, and reached within
10 ms by the weakest simulated movement."""
ONSET_SAMPLES: Final = 3
"""So many readings in a row, so that a knock is no onset."""
REST_SPAN_S: Final = 0.15
"""The hand is at rest where a stretch of this length varies least before the movement."""
CURVE_BEFORE_S: Final = 0.1
CURVE_AFTER_S: Final = 0.5
CURVE_STEP_S: Final = 0.02
_GRID: Final = np.arange(-CURVE_BEFORE_S, CURVE_AFTER_S, CURVE_STEP_S)


def worst_gap_s(times_s: F64) -> float:
    """The longest time without a sample in a take, its ends included."""
    edges = np.concatenate([[-BEFORE_S], times_s, [AFTER_S]])
    return float(np.max(np.diff(edges)))


def tilt_of(accel_g: F64) -> float:
    """The angle between the mean of these readings and straight up, in degrees."""
    x, y, z = accel_g.mean(axis=0).tolist()
    return math.degrees(math.atan2(math.hypot(x, y), z))


def rest_of(times_s: F64, accel_g: F64) -> F64:
    """What the hand reads at rest: the mean of the quietest stretch before the activation.

    Args:
        times_s: At least two of them before the activation.
        accel_g: The readings then.
    """
    begins = np.arange(-BEFORE_S, -REST_SPAN_S + 1e-9, 0.05)
    best, least = accel_g[:1], math.inf
    for begin_s in begins.tolist():
        part = accel_g[(times_s >= begin_s) & (times_s < begin_s + REST_SPAN_S)]
        spread = float(part.std(axis=0).sum()) if len(part) > 1 else math.inf
        if spread < least:
            best, least = part, spread
    rest: F64 = best.mean(axis=0)
    return rest


def onset_s(times_s: F64, accel_g: F64) -> float:
    """When the hand begins to move, from the activation; NaN when it does not."""
    away = np.linalg.norm(accel_g - rest_of(times_s, accel_g), axis=1) > ONSET_G
    runs = np.convolve(away, np.ones(ONSET_SAMPLES), mode="valid") >= ONSET_SAMPLES - 0.5
    return float(times_s[int(np.argmax(runs))]) if runs.any() else math.nan


def curve_of(times_s: F64, accel_g: F64, start_s: float) -> F64:
    """A take on a grid of its own around ``start_s``, to compare it with others; shape (n, 3)."""
    grid_s = _GRID + start_s
    return np.stack([np.interp(grid_s, times_s, accel_g[:, axis]) for axis in range(3)], axis=1)


def distance_g(one: F64, other: F64) -> float:
    """How far two curves are apart: root mean square over time of their difference, in g."""
    return float(np.sqrt(np.mean(np.sum((one - other) ** 2, axis=1))))
