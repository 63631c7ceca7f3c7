"""What the left arm says: stop, start or neither. Pure: samples in, posture out."""

import math
from dataclasses import dataclass

from gestureapp.sensing.values import ArmPosture

QUIET_MIN_G = 0.6
QUIET_MAX_G = 1.4
"""Outside of this the arm is shaken or thrown: the direction says nothing about its posture."""


Vector = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class LeftPostures:
    """Where gravity points in a person's two postures of the left arm, as unit vectors.

    Attributes:
        stop: Level: +Z.
        start: Turned about Y: -X (paper, figure 8).
    """

    stop: Vector = (0.0, 0.0, 1.0)
    start: Vector = (-1.0, 0.0, 0.0)

    @property
    def between_deg(self) -> float:
        """The angle between the two; NaN when one of them is no direction."""
        return _angle_deg(self.stop, self.start)


BUILT_IN = LeftPostures()
"""For whoever has recorded none."""


class PostureDetector:
    """Follows the left arm's posture with hysteresis and a debounce.

    A posture is taken after ``debounce`` samples in a row within ``enter_deg`` of it, and kept up
    to ``leave_deg``. It is left after ``debounce`` samples in a row that do not show it, whatever
    they show. A sample whose magnitude is far from 1 g shows no posture, so it ends one and starts
    none; one that would show both shows stop. Owned by one thread.

    Args:
        enter_deg: The arm comes into a posture within this angle of it.
        leave_deg: It stays so up to this angle; at least ``enter_deg``.
        debounce: Samples in a row that a change needs; at least 1.
        postures: Where gravity points in the two; the built-in ones are a right angle apart.

    Raises:
        ValueError: the angles are out of order or the built-in postures would overlap, or no
            debounce.
    """

    def __init__(
        self,
        enter_deg: float,
        leave_deg: float,
        debounce: int,
        postures: LeftPostures = BUILT_IN,
    ) -> None:
        if not 0 < enter_deg <= leave_deg or not enter_deg + leave_deg < 90:
            raise ValueError(
                f"posture angles {enter_deg} and {leave_deg} degrees: leave must be at least "
                "enter, and both together below 90"
            )
        if debounce < 1:
            raise ValueError(f"posture debounce {debounce}: at least 1 sample")
        self._enter_deg = enter_deg
        self._leave_deg = leave_deg
        self._debounce = debounce
        self._postures = postures
        self._posture = ArmPosture.NEITHER
        self._shown = ArmPosture.NEITHER
        self._n_shown = 0
        self._n_away = 0

    @property
    def posture(self) -> ArmPosture:
        """The posture after the last sample; neither before the first."""
        return self._posture

    def reset(self) -> None:
        """Forget everything, as after a lost sensor: a posture must be shown anew."""
        self._take(ArmPosture.NEITHER)

    def feed(self, accel_g: Vector) -> ArmPosture:
        """Take the next sample of the left arm, x, y, z in g; the posture from now on."""
        shown = self._shown_by(accel_g)
        if shown is self._posture:
            self._take(shown)
            return shown
        self._n_away += 1
        self._n_shown = self._n_shown + 1 if shown is self._shown else 1
        self._shown = shown
        if self._n_shown >= self._debounce:
            self._take(shown)
        elif self._n_away >= self._debounce:
            self._posture = ArmPosture.NEITHER
        return self._posture

    def _take(self, posture: ArmPosture) -> None:
        self._posture = posture
        self._shown = posture
        self._n_shown = 0
        self._n_away = 0

    def _shown_by(self, accel_g: Vector) -> ArmPosture:
        """What a single sample shows, seen from the present posture."""
        if not QUIET_MIN_G <= math.hypot(*accel_g) <= QUIET_MAX_G:
            return ArmPosture.NEITHER
        for direction, posture in (
            (self._postures.stop, ArmPosture.STOP),
            (self._postures.start, ArmPosture.START),
        ):
            limit_deg = self._leave_deg if posture is self._posture else self._enter_deg
            if _angle_deg(accel_g, direction) <= limit_deg:
                return posture
        return ArmPosture.NEITHER


def _angle_deg(one: Vector, other: Vector) -> float:
    lengths = math.hypot(*one) * math.hypot(*other)
    if not 0 < lengths < math.inf:
        return math.nan
    cosine = sum(a * b for a, b in zip(one, other, strict=True)) / lengths
    return math.degrees(math.acos(max(-1.0, min(1.0, cosine))))
