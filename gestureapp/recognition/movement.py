"""When the right arm begins to move: baseline, onset and stillness, sample by sample. Pure.

The follower runs all the time, so that an onset before the activation is known. It looks at times
only, never at counts: samples may be lost, late, and of any rate from 50 to 200 Hz.
"""

import math

import numpy as np
from numpy.typing import NDArray

from gestureapp.recognition.window import N_CELLS, Moment, cells_of

F64 = NDArray[np.float64]

HISTORY_S = 1.0
"""Samples are kept so long; after a longer gap the follower begins anew."""
STILL_S = 0.15
"""The arm is still when all readings of so long ..."""
STILL_G = 0.10
"""... lie within this of their middle: half of their range, as a length over the axes."""
STILL_SPAN_S = 0.1
"""Readings that span less than this do not tell."""
STILL_SAMPLES = 3
LAG_S = 0.05
"""The newest readings are left out of the baseline: an onset just begun does not leak in."""
NOW_S = 0.045
"""The reading now is the mean of so long."""
ONSET_G = 0.10
"""Least deviation from the baseline that is a movement; a model may know its person's better."""
ONSET_MOST_G = 0.50
ONSET_SIGMAS = 4.0
"""A movement also exceeds the noise at rest so many times."""
BACK = 0.4
"""The onset is dated back to where the deviation left this share of the threshold ..."""
BACK_S = 0.06
"""... but no further than this. Measured on simulated people: median error 0 to +2 ms, 98 of 100
within -7 and +18 ms."""
FAR_G = 0.45
"""In a stream that begins with a movement: further from a level hand than this is no rest."""
TILT = math.cos(math.radians(35.0))
"""A hand tilted further than 35 degrees and held still is a posture."""
LEVEL: F64 = np.array([0.0, 0.0, 1.0])
LEVEL.setflags(write=False)
JUST_S = 1e-6
"""Times nearer than this are equal: the steps of a rate are no exact numbers."""
KEPT = 1024
"""Samples kept at most, whatever the rate."""


class Follower:
    """Follows one arm. Owned by one thread; knows no clock.

    Args:
        onset_g: Deviation from the baseline that is a movement, in g.

    Attributes:
        newest_s: Time of the newest sample, or minus infinity before the first.
        is_moving: A movement has begun, and the arm was not still since.
        is_still: The arm is still.
        onset_s: When the movement began, or NaN before the first one.
        baseline_g: The reading before the movement, shape (3,).
        now_g: Mean of the newest readings, shape (3,).
        quality: How well the baseline is known: 0 as long as the arm was never still, then to 1.
    """

    def __init__(self, onset_g: float = ONSET_G) -> None:
        self._onset_g = onset_g
        self._times = np.zeros(2 * KEPT)
        self._accel = np.zeros((2 * KEPT, 3))
        self._forget()

    def _forget(self) -> None:
        self._begin = self._end = 0
        self.newest_s = -math.inf
        self.is_moving = self.is_still = False
        self.onset_s = math.nan
        self.baseline_g: F64 = LEVEL
        self.now_g: F64 = LEVEL
        self.quality = 0.0
        self._threshold_g = self._onset_g
        self._least_far_g = math.inf

    @property
    def step_s(self) -> float:
        """Usual time between two samples of the last second; 0 before the second one.

        Their median: a gap in the stream does not lengthen it.
        """
        times = self._times[self._begin : self._end]
        return float(np.median(np.diff(times))) if len(times) > 1 else 0.0

    @property
    def is_posture(self) -> bool:
        """The arm is held still and tilted."""
        return self.is_still and bool(self.now_g[2] < TILT * (_length(self.now_g) + 1e-9))

    def feed(self, t_s: float, accel_g: tuple[float, float, float]) -> None:
        """Take a sample; a time before the last one's counts as the last one's."""
        last_s = self._times[self._end - 1] if self._end else t_s
        if abs(t_s - last_s) > HISTORY_S:
            self._forget()
            last_s = t_s
        is_first = self._end == 0
        times, accel = self._keep(max(t_s, float(last_s)), accel_g)
        t_s, reading = float(times[-1]), accel[-1]
        self.newest_s = t_s
        far_g = _length(reading - LEVEL)
        self._least_far_g = min(self._least_far_g, far_g)
        if is_first:
            self._start(t_s, reading, far_g)
        is_still = self._look_for_rest(times, accel)
        if self.quality == 0.0 and not self.is_moving:
            older = int(np.searchsorted(times, t_s - LAG_S, "right"))
            if older:
                self.baseline_g = accel[:older].mean(axis=0)
        if not self.is_moving and not is_first:
            self._look_for_onset(times, accel, far_g)
        self.is_still = is_still and not self.is_moving
        newest = min(int(np.searchsorted(times, t_s - NOW_S, "right")), len(times) - 1)
        self.now_g = accel[newest:].mean(axis=0)

    def moment(self) -> Moment:
        """What a network sees of the arm now."""
        cells, full = np.zeros((N_CELLS, 3)), np.zeros(N_CELLS)
        elapsed_s = 0.0
        if self.is_moving:
            times, accel = (
                self._times[self._begin : self._end],
                self._accel[self._begin : self._end],
            )
            elapsed_s = float(times[-1]) - self.onset_s
            cells, full = cells_of(times, accel, self.onset_s, self.baseline_g)
        return Moment(
            cells_g=cells,
            is_full=full,
            elapsed_s=np.array(elapsed_s),
            baseline_g=self.baseline_g,
            now_g=self.now_g,
            is_still=np.array(float(self.is_still)),
            quality=np.array(self.quality),
        )

    def _keep(self, t_s: float, accel_g: tuple[float, float, float]) -> tuple[F64, F64]:
        """The samples of the last second, with this one."""
        if self._end == len(self._times):
            kept = slice(max(self._begin, self._end - KEPT), self._end)
            n = kept.stop - kept.start
            self._times[:n], self._accel[:n] = self._times[kept].copy(), self._accel[kept].copy()
            self._begin, self._end = 0, n
        self._times[self._end], self._accel[self._end] = t_s, accel_g
        self._end += 1
        while t_s - self._times[self._begin] > HISTORY_S:
            self._begin += 1
        here = slice(self._begin, self._end)
        return self._times[here], self._accel[here]

    def _start(self, t_s: float, reading: F64, far_g: float) -> None:
        """The stream begins: perhaps in the middle of a movement."""
        self.baseline_g = reading.copy() if far_g < FAR_G else LEVEL
        if far_g > max(FAR_G, self._onset_g):
            self.is_moving, self.onset_s = True, t_s

    def _look_for_rest(self, times: F64, accel: F64) -> bool:
        t_s = float(times[-1])
        first = int(np.searchsorted(times, t_s - STILL_S - JUST_S, "right"))
        window = accel[first:]
        if len(window) < STILL_SAMPLES or t_s - times[first] <= STILL_SPAN_S:
            return False
        if _length(window.max(axis=0) - window.min(axis=0)) >= 2.0 * STILL_G:
            return False
        end = max(int(np.searchsorted(times, t_s - LAG_S + JUST_S, "right")), first + 1)
        rest = accel[first:end]
        self.baseline_g = rest.mean(axis=0)
        spread = float(np.square(rest - self.baseline_g).sum()) / len(rest)
        self._threshold_g = max(self._onset_g, ONSET_SIGMAS * math.sqrt(spread))
        step_s = float(times[-1] - times[-2])
        self.quality = max(0.5, min(1.0, self.quality + step_s / STILL_S))
        self.is_moving = False
        return True

    def _look_for_onset(self, times: F64, accel: F64, far_g: float) -> None:
        """A movement; before any rest was seen only one that leads away from a level hand."""
        if _length(accel[-1] - self.baseline_g) <= self._threshold_g:
            return
        leaves = far_g > max(FAR_G, self._onset_g)
        grows = far_g - self._least_far_g > self._threshold_g
        if self.quality > 0.0 or leaves or grows:
            self.onset_s = self._dated_back(times, accel)
            self.is_moving = True

    def _dated_back(self, times: F64, accel: F64) -> float:
        earliest_s = float(times[-1]) - BACK_S
        first = max(int(np.searchsorted(times, earliest_s, "right")) - 1, 0)
        away = accel[first:] - self.baseline_g
        deviation = np.sqrt(np.einsum("ij,ij->i", away, away))
        low = BACK * self._threshold_g
        quiet = np.flatnonzero(deviation[:-1] <= low)
        if not len(quiet):
            return max(float(times[first]), earliest_s)
        k = int(quiet[-1])
        share = (low - deviation[k]) / max(deviation[k + 1] - deviation[k], 1e-9)
        step_s = float(times[first + k + 1] - times[first + k])
        onset_s = float(times[first + k]) + min(max(share, 0.0), 1.0) * step_s
        return float(max(onset_s, earliest_s))


def _length(vector: F64) -> float:
    return math.sqrt(float(vector @ vector))
