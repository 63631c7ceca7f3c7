"""Waiting until a sensor lies or is held still, and what it read then. Pure."""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from gestureapp.sensing.calibration import Vector

F64 = NDArray[np.float64]

GAP_S: Final = 0.3
"""No sample for this long, and nobody knows whether the sensor lay still: the time begins anew."""
SILENT_S: Final = 1.0
"""No sample for this long is said in words."""
RATE_MIN_HZ: Final = 20.0
"""Fewer samples than this over the whole time are too few for a mean."""
_NO_ROWS: Final[F64] = np.empty((0, 4))
SWAY_G: Final = 0.0045
"""A lying ADXL330 behind a 10-bit converter stays below 4 mg in 99 of 100 cases; a simulated arm
that is held still wanders by 12 mg in 1.5 s, and by less than this in 1 of 50 cases."""
_BLOCKS: Final = 5
_SOME_TIME_S: Final = 1e-3
_FREEST: Final = 10
"""As long as there are fewer samples, their mean is itself noisy: twice the limit is allowed."""


@dataclass(frozen=True, slots=True)
class Still:
    """What was read while nothing moved.

    Attributes:
        mean_g: Mean of the samples once it had settled.
        noise_g: Standard deviation, per axis.
        n_values: How many different values each axis showed.
        t_s: When it ended.
    """

    mean_g: Vector
    noise_g: Vector
    n_values: tuple[int, int, int]
    t_s: float

    @property
    def is_frozen(self) -> bool:
        """Not a single digit has changed: no sensor is as quiet as that."""
        return self.n_values == (1, 1, 1)

    @property
    def magnitude_g(self) -> float:
        """Length of the mean."""
        return math.hypot(*self.mean_g)


class Stillness:
    """Collects samples until they have stayed together for long enough. Owned by one thread.

    Args:
        hold_s: For how long.
        within_g: Every sample lies this close to the mean, on every axis; noise is part of it.
        may_sway: It is held by hand or worn, so that it wanders slowly; what lies does not.
    """

    def __init__(self, hold_s: float, within_g: float, *, may_sway: bool = False) -> None:
        self._hold_s = hold_s
        self._may_sway = may_sway
        self._sways_since_s = math.nan
        self._within_g = within_g
        self._rows = _NO_ROWS
        self._newest_s = -math.inf
        self._heard_s = math.nan
        self._is_silent = False
        self._recent = _NO_ROWS
        self.moved_after_s = 0.0
        """How long it had been still when the last ``step`` met a movement; 0 when it met none."""

    def step(self, now_s: float, rows: F64) -> Still | None:
        """Take samples; what was read, once it has been still for long enough.

        Args:
            now_s: Monotonic clock.
            rows: Samples shape (n, 4): t_s, x, y, z in g, oldest first. Ones that were there
                before are left out, so a tail that overlaps may be handed in; also such as are
                no numbers.
        """
        self.moved_after_s = 0.0
        if math.isnan(self._heard_s):
            self._heard_s = now_s
        fresh = rows[(rows[:, 0] > self._newest_s) & np.isfinite(rows).all(axis=1)]
        found: Still | None = None
        for row in fresh:
            found = self._take(row) or found
        if len(fresh):
            self._heard_s = now_s
            recent = np.vstack([self._recent, fresh])
            self._recent = recent[recent[:, 0] > self._newest_s - self._hold_s]
        self._is_silent = now_s - self._heard_s > SILENT_S
        if self._is_silent:
            self.restart()
        return found

    @property
    def progress(self) -> float:
        """0 to 1 of the time to be still."""
        return min(1.0, self._span_s / self._hold_s)

    @property
    def is_silent(self) -> bool:
        """No samples come."""
        return self._is_silent

    @property
    def sways(self) -> bool:
        """Still for long enough and longer, but for a slow wandering."""
        return self._newest_s - self._sways_since_s > self._hold_s / 2.0

    @property
    def so_far(self) -> Still | None:
        """What has been read since it began to be still; None before there is enough to tell."""
        return _still(self._rows) if len(self._rows) >= _FREEST else None

    @property
    def noise_g(self) -> float:
        """Standard deviation of the newest samples if it lies still but for it; else NaN."""
        values = self._recent[:, 1:]
        if len(values) < _FREEST * _BLOCKS or _sways(values):
            return math.nan
        return float(values.std(axis=0).max())

    def restart(self) -> None:
        """The time begins anew with the next sample."""
        self._rows, self._sways_since_s = _NO_ROWS, math.nan

    @property
    def _span_s(self) -> float:
        return float(self._rows[-1, 0] - self._rows[0, 0]) if len(self._rows) else 0.0

    def _take(self, row: F64) -> Still | None:
        has_gap = bool(row[0] - self._newest_s > GAP_S)
        self._newest_s = float(row[0])
        if has_gap:
            self.restart()
        if len(self._rows) and not self._is_near(row):
            self._move()
        self._rows = np.vstack([self._rows, row])
        if self._span_s < self._hold_s:
            return None
        rows = self._rows
        settled = rows[len(rows) // _BLOCKS :]  # the first part is how it was laid down
        if not self._may_sway and _sways(settled[:, 1:]):
            self._wait_on(settled)
            return None
        found = _still(settled)
        self.restart()
        if len(rows) < RATE_MIN_HZ * self._hold_s:
            return None
        if np.abs(settled[:, 1:] - np.array(found.mean_g)).max() > self._within_g:
            self.moved_after_s = self._hold_s  # so slowly that the mean went with it
            return None
        self.moved_after_s = 0.0
        return found

    def _wait_on(self, settled: F64) -> None:
        if math.isnan(self._sways_since_s):
            self._sways_since_s = self._newest_s
        self._rows = settled

    def _move(self) -> None:
        self.moved_after_s = max(self.moved_after_s, self._span_s, _SOME_TIME_S)
        self.restart()

    def _is_near(self, row: F64) -> bool:
        limit_g = self._within_g * (2.0 if len(self._rows) < _FREEST else 1.0)
        mean = self._rows[:, 1:].mean(axis=0)
        return bool(np.abs(row[1:] - mean).max() <= limit_g)


def _still(rows: F64) -> Still:
    values = rows[:, 1:]
    counts = [len(np.unique(values[:, axis])) for axis in range(3)]
    return Still(
        _vector(values.mean(axis=0)),
        _vector(values.std(axis=0)),
        (counts[0], counts[1], counts[2]),
        float(rows[-1, 0]),
    )


def _sways(values: F64) -> bool:
    """Whether the means of fifths of the time differ by more than noise makes them.

    A mean of n samples is quieter than one by the root of n; four times that for certainty.
    """
    if len(values) < _FREEST:
        return False
    means = np.array([block.mean(axis=0) for block in np.array_split(values, _BLOCKS)])
    quiet_g = 4.0 * float(values.std(axis=0).max()) * math.sqrt(_BLOCKS / len(values))
    return bool(np.ptp(means, axis=0).max() > max(SWAY_G, quiet_g))


def _vector(values: F64) -> Vector:
    x, y, z = (float(value) for value in values)
    return x, y, z
