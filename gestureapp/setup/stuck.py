"""Axes that do not do what gravity asks of them, and positions that were none. Pure."""

import math
import statistics
from collections.abc import Mapping
from typing import Final

import numpy as np
from numpy.typing import NDArray

from gestureapp.setup.fit import UP
from gestureapp.setup.stillness import Still
from gestureapp.setup.values import Position

F64 = NDArray[np.float64]

_DEAD_SPAN_G: Final = 0.1
"""An axis that has not moved by more, while"""
_TURNED_SPAN_G: Final = 0.7
"""another has moved by so much: it was turned far enough for every axis to follow."""
_LIVELY: Final = 4
"""An axis that shows so many values at rest elsewhere cannot show a single one in its own."""


_SHAKY: Final = 1.4
"""Lying, the noise of one position is within a third of another's; on an arm it is half as much
again and more."""
_SHAKY_G: Final = 0.001


class AxisSpans:
    """How far each axis has gone in all that was read. Owned by one thread."""

    def __init__(self) -> None:
        self._low = np.full(3, np.inf)
        self._high = np.full(3, -np.inf)

    def take(self, rows: F64) -> None:
        """Take samples, shape (n, 4); such as are no numbers are left out."""
        values = rows[np.isfinite(rows).all(axis=1), 1:]
        if len(values):
            self._low = np.minimum(self._low, values.min(axis=0))
            self._high = np.maximum(self._high, values.max(axis=0))

    @property
    def dead_axis(self) -> str:
        """The letter of an axis that stays where it is while the sensor is turned; else empty."""
        spans = self._high - self._low
        axis = int(spans.argmin())
        is_turned = bool(spans.max() > _TURNED_SPAN_G)
        return "XYZ"[axis] if is_turned and spans[axis] < _DEAD_SPAN_G else ""


def clipped_axis(taken: Mapping[Position, Still]) -> str:
    """The letter of an axis whose reading is cut off before 1 g; empty when there is none.

    At its end an axis reads one single value, though it is noisy everywhere else.
    """
    for axis, name in enumerate("XYZ"):
        along = [s.n_values[axis] for p, s in taken.items() if UP[p][axis]]
        across = [s.n_values[axis] for p, s in taken.items() if not UP[p][axis]]
        if along and across and min(along) == 1 and min(across) >= _LIVELY:
            return name
    return ""


def shaky_position(taken: Mapping[Position, Still]) -> Position | None:
    """A position that is noisier than the others: the sensor was worn or touched; None for none."""
    noise_g = {position: math.hypot(*still.noise_g) for position, still in taken.items()}
    if len(noise_g) < len(UP):
        return None
    worst = max(noise_g, key=lambda position: noise_g[position])
    usual_g = statistics.median(noise_g[position] for position in noise_g if position is not worst)
    is_shaky = noise_g[worst] > max(_SHAKY * usual_g, usual_g + _SHAKY_G)
    return worst if is_shaky else None
