"""How a hand gets from one place to another: minimum-jerk submovements that add up. Pure.

Positions, speeds and accelerations are sums over submovements, each of which starts and ends with
speed and acceleration zero. So a gesture may be started at any moment, also while an earlier one is
still under way, and nothing jumps.

Source: Flash and Hogan, The coordination of arm movements, J. Neurosci. 5 (1985) 1688, for the
profile; Flash and Henis, Arm trajectory modifications during reaching, J. Cogn. Neurosci. 3 (1991)
220, for adding a new submovement to the one under way.
"""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

F64 = NDArray[np.float64]


class Coordinate(IntEnum):
    """The hand's coordinates, in m and rad.

    X, Y, Z are its translation along the body's axes (+X forward, +Y left, +Z up). SWING lifts the
    forearm about the elbow (positive up). ROLL, PITCH and YAW turn the hand right-handed about X,
    Y, Z.
    """

    X = 0
    Y = 1
    Z = 2
    SWING = 3
    ROLL = 4
    PITCH = 5
    YAW = 6


N_COORDINATES = len(Coordinate)
PEAK_ACCELERATION = 10.0 / np.sqrt(3.0)
"""Peak of the profile's acceleration, 5.77 times distance over squared duration."""


def minimum_jerk(tau: F64) -> tuple[F64, F64, F64]:
    """Position, speed and acceleration of a unit movement of unit duration.

    Args:
        tau: Time since the start over the duration; any shape. Before 0 it rests at 0, after 1 at
            1.

    Returns:
        Three arrays of the shape of ``tau``.

    Source: Flash and Hogan 1985, equation for rest-to-rest movements.
    """
    t = np.clip(tau, 0.0, 1.0)
    s = t**3 * (10.0 - 15.0 * t + 6.0 * t * t)
    v = 30.0 * t * t * (1.0 - t) ** 2
    a = 60.0 * t * (1.0 - t) * (1.0 - 2.0 * t)
    return s, v, a


@dataclass(frozen=True, slots=True)
class Submovement:
    """One minimum-jerk change of the hand's coordinates.

    Attributes:
        start_s: When it begins.
        duration_s: How long it takes, above 0.
        change: Change of each coordinate, in the order of ``Coordinate``.
    """

    start_s: float
    duration_s: float
    change: tuple[float, ...]


class Motion:
    """The sum of all submovements so far. Owned by one arm; not for use by two threads."""

    def __init__(self) -> None:
        self._done: F64 = np.zeros(N_COORDINATES)
        self._parts: list[Submovement] = []

    @property
    def goal(self) -> F64:
        """Where the hand will be when everything asked for has been done; shape (7,)."""
        return self._done + sum((np.array(p.change) for p in self._parts), np.zeros(N_COORDINATES))

    def add(self, part: Submovement) -> None:
        """Add a submovement, whatever is under way."""
        self._parts.append(part)

    def cancel_from(self, t_s: float) -> None:
        """Drop every submovement that would begin at this time or later."""
        self._parts = [p for p in self._parts if p.start_s < t_s]

    def settle(self, t_s: float) -> None:
        """Forget the submovements that have ended; earlier times cannot be asked again."""
        for part in [p for p in self._parts if p.start_s + p.duration_s <= t_s]:
            self._done = self._done + np.array(part.change)
            self._parts.remove(part)

    def at(self, times_s: F64) -> tuple[F64, F64, F64]:
        """Coordinates, speeds and accelerations at these times.

        Args:
            times_s: Shape (n,).

        Returns:
            Three arrays of shape (n, 7), in m and rad, per s, per s squared.
        """
        n = len(times_s)
        if not self._parts:
            zero = np.zeros((n, N_COORDINATES))
            return zero + self._done, zero, zero
        starts = np.array([p.start_s for p in self._parts])
        durations = np.array([p.duration_s for p in self._parts])
        changes = np.array([p.change for p in self._parts])
        s, v, a = minimum_jerk((times_s[:, None] - starts) / durations)
        return (
            self._done + s @ changes,
            (v / durations) @ changes,
            (a / durations**2) @ changes,
        )
