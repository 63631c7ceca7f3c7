"""Which sensor is on which arm: the one that is shaken is the left one. Pure."""

from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from gestureapp.sensing.values import Side
from gestureapp.setup.values import ShakeView

F64 = NDArray[np.float64]

SPAN_S: Final = 1.0
"""Long enough for three shakes, short enough that nobody gets tired."""
SHAKEN_G: Final = 0.4
"""An arm that is shaken on purpose moves by 0.5 to 2 g around its mean; one that walks, by 0.2."""
STILL_G: Final = 0.15
"""The other arm must be quieter than this; a standing person's is at 0.02 g."""
CLEARLY: Final = 4.0
"""So many times as strongly as the other one: a shaken table moves both."""
GIVEN_UP_S: Final = 60.0
"""Nobody shakes for so long; it can be begun again."""
_FULL_G: Final = 1.0
_MIN_ROWS: Final = 20
"""Fewer samples within the span say nothing about a movement."""


class Shake:
    """Follows both sensors until one moves clearly and the other does not. Owned by one thread.

    Args:
        now_s: When it begins, monotonic clock.
        arm: Where the sensor is worn that is to be shaken, the one that starts and stops: ``left``,
            or ``right`` of a left-handed person.

    Attributes:
        view: For the window.
        shaken: Which sensor it was, as they are assigned now; None until it is decided.
    """

    def __init__(self, now_s: float, arm: str = "left") -> None:
        self._arm, self._other = arm, "right" if arm == "left" else "left"
        self._ask = f"Shake the sensor on your {arm.upper()} arm."
        self._began_s = now_s
        self._rows = {side: np.zeros((0, 4)) for side in Side}
        self.view = ShakeView(is_on=True, sentence=self._ask)
        self.shaken: Side | None = None

    def step(self, now_s: float, left: F64, right: F64) -> None:
        """Take the new samples of both sensors, rows of t, x, y, z; nothing once it is decided."""
        if not self.view.is_on:
            return
        shakes = {
            side: self._shake_g(side, new, now_s)
            for side, new in ((Side.LEFT, left), (Side.RIGHT, right))
        }
        self.shaken = _decide(shakes)
        self.view = ShakeView(
            is_on=self.shaken is None,
            sentence=self._sentence(shakes, now_s),
            left_shake=_shown(shakes[Side.LEFT]),
            right_shake=_shown(shakes[Side.RIGHT]),
        )
        if self.shaken is None and now_s - self._began_s > GIVEN_UP_S:
            self.end("Nothing was shaken: nothing has changed. Begin again when you are ready.")

    def end(self, sentence: str = "") -> None:
        """End it; what is not decided stays as it was."""
        self.view = replace(self.view, is_on=False, sentence=sentence)

    def _shake_g(self, side: Side, new: F64, now_s: float) -> float:
        """How far a sensor moves around its mean, root of the mean square, g; NaN when unknown."""
        rows = np.concatenate([self._rows[side], new])
        rows = rows[rows[:, 0] > now_s - SPAN_S]
        self._rows[side] = rows
        if len(rows) < _MIN_ROWS:
            return float("nan")
        return float(np.sqrt(np.sum(np.var(rows[:, 1:], axis=0))))

    def _sentence(self, shakes: dict[Side, float], now_s: float) -> str:
        if self.shaken is Side.LEFT:
            return "That is the sensor that starts and stops: they are assigned rightly."
        if self.shaken is Side.RIGHT:
            return "That was the sensor for gestures: the two are swapped now."
        if now_s - self._began_s >= SPAN_S:
            for side, shake_g in shakes.items():
                if np.isnan(shake_g):
                    arm = self._arm if side is Side.LEFT else self._other
                    return f"The {arm} arm's sensor sends nothing: see what its card advises."
        if all(shake_g > STILL_G for shake_g in shakes.values()):
            return f"Both move: keep your {self._other} arm still, and shake the {self._arm} one."
        return self._ask


def _decide(shakes: dict[Side, float]) -> Side | None:
    """Comparisons with NaN are False: of a sensor that is not heard nothing is decided."""
    for side, other in ((Side.LEFT, Side.RIGHT), (Side.RIGHT, Side.LEFT)):
        moving, still = shakes[side], shakes[other]
        if moving >= SHAKEN_G and still <= STILL_G and moving >= CLEARLY * still:
            return side
    return None


def _shown(shake_g: float) -> float:
    return 0.0 if np.isnan(shake_g) else min(1.0, shake_g / _FULL_G)
