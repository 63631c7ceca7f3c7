"""The follower for many takes at once, for training; the numbers of ``movement.Follower``. Pure."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gestureapp.recognition.movement import (
    BACK,
    BACK_S,
    FAR_G,
    HISTORY_S,
    JUST_S,
    LAG_S,
    LEVEL,
    NOW_S,
    ONSET_G,
    ONSET_SIGMAS,
    STILL_G,
    STILL_S,
    STILL_SAMPLES,
    STILL_SPAN_S,
    TILT,
)
from gestureapp.recognition.window import EDGES_S, HALF_FULL, WIDTHS_S, Moment

F64 = NDArray[np.float64]
I64 = NDArray[np.int64]
Flags = NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class Streams:
    """Takes of any lengths, side by side; after a take's end its last sample stands.

    Attributes:
        times_s: Shape (takes, samples), not decreasing, also after the end; no gap of a second.
        accel_g: Shape (takes, samples, 3).
        n_samples: How many samples of each are real, shape (takes,).
    """

    times_s: F64
    accel_g: F64
    n_samples: I64


@dataclass(frozen=True, slots=True)
class Followed:
    """What a follower knew after each sample of each take; first shape (takes, samples).

    Attributes:
        streams: The takes.
        is_moving: A movement had begun, and the arm was not still since.
        is_still: The arm was still.
        is_posture: It was held still and tilted.
        onset_s: When the movement began; NaN before the first one.
        baseline_g: The reading before the movement, shape (takes, samples, 3).
        now_g: Mean of the newest readings, the same shape.
        quality: How well the baseline was known.
    """

    streams: Streams
    is_moving: Flags
    is_still: Flags
    is_posture: Flags
    onset_s: F64
    baseline_g: F64
    now_g: F64
    quality: F64

    @property
    def elapsed_s(self) -> F64:
        """Since the onset, NaN before the first one."""
        return self.streams.times_s - self.onset_s


def follow_all(streams: Streams, onset_g: float | F64 = ONSET_G) -> Followed:
    """Follow each take from its first sample on.

    Args:
        streams: The takes.
        onset_g: Deviation from the baseline that is a movement; one, or one for each take.
    """
    times, accel = streams.times_s, streams.accel_g
    state = _State(streams, np.broadcast_to(np.asarray(onset_g, np.float64), (len(times),)))
    rested = np.zeros(times.shape, np.bool_)
    moving, onset = np.zeros_like(rested), np.full(times.shape, np.nan)
    baseline, quality = np.zeros_like(accel), np.zeros_like(times)
    for i in range(times.shape[1]):
        rested[:, i] = state.step(i)
        moving[:, i], onset[:, i] = state.moving, state.onset_s
        baseline[:, i], quality[:, i] = state.baseline_g, state.quality
    still = rested & ~moving
    now = _recent_means(streams, state.sums)
    length = np.sqrt(np.einsum("...c,...c->...", now, now))
    posture = still & (now[..., 2] < TILT * (length + 1e-9))
    return Followed(streams, moving, still, posture, onset, baseline, now, quality)


class _State:
    """The followers of all takes after the same number of samples."""

    def __init__(self, streams: Streams, onset_g: F64) -> None:
        self.times, self.accel, self.floor_g = streams.times_s, streams.accel_g, onset_g
        n = len(self.times)
        self.rows = np.arange(n)
        self.sums = np.concatenate(
            [np.zeros((n, 1, 3)), np.cumsum(self.accel, axis=1)], axis=1, dtype=np.float64
        )
        squares = np.einsum("ijk,ijk->ij", self.accel, self.accel)
        self.squares = np.concatenate([np.zeros((n, 1)), np.cumsum(squares, axis=1)], axis=1)
        self.far_g = _lengths(self.accel - LEVEL)
        self.least_far_g = np.minimum.accumulate(self.far_g, axis=1)
        self.rest_from = _first_after(self.times, STILL_S + JUST_S)
        self.rest_to = np.maximum(_first_after(self.times, LAG_S - JUST_S), self.rest_from + 1)
        self.older = _first_after(self.times, LAG_S)
        self.oldest = _first_kept(self.times)
        first_g, far_g = self.accel[:, 0], self.far_g[:, 0]
        self.baseline_g = np.where((far_g < FAR_G)[:, None], first_g, LEVEL).astype(np.float64)
        self.moving = far_g > np.maximum(FAR_G, onset_g)
        self.onset_s = np.where(self.moving, self.times[:, 0], np.nan)
        self.quality, self.threshold_g = np.zeros(n), onset_g.copy()

    def step(self, i: int) -> Flags:
        """Take sample i of every take; which of them rest."""
        rested = self._look_for_rest(i)
        blind = (self.quality == 0.0) & ~self.moving & (self.older[:, i] > self.oldest[:, i])
        if blind.any():
            begin, end = self.oldest[:, i], np.maximum(self.older[:, i], self.oldest[:, i] + 1)
            self.baseline_g = np.where(blind[:, None], self._mean(begin, end), self.baseline_g)
        if i > 0:
            self._look_for_onset(i)
        return rested

    def _mean(self, begin: I64, end: I64) -> F64:
        sums: F64 = self.sums[self.rows, end] - self.sums[self.rows, begin]
        mean: F64 = sums / (end - begin)[:, None]
        return mean

    def _look_for_rest(self, i: int) -> Flags:
        begin, end = self.rest_from[:, i], self.rest_to[:, i]
        back = np.arange(int((i + 1 - begin).max()))
        window = self.accel[self.rows[:, None], np.maximum(i - back, begin[:, None])]
        spans_s = self.times[:, i] - self.times[self.rows, begin]
        rested: Flags = _lengths(window.max(axis=1) - window.min(axis=1)) < 2.0 * STILL_G
        rested &= (spans_s > STILL_SPAN_S) & (i + 1 - begin >= STILL_SAMPLES)
        mean = self._mean(begin, end)
        squares = (self.squares[self.rows, end] - self.squares[self.rows, begin]) / (end - begin)
        spread = np.sqrt(np.maximum(squares - np.einsum("ij,ij->i", mean, mean), 0.0))
        threshold = np.maximum(self.floor_g, ONSET_SIGMAS * spread)
        step_s = self.times[:, i] - self.times[:, max(i - 1, 0)]
        quality = np.maximum(0.5, np.minimum(1.0, self.quality + step_s / STILL_S))
        self.baseline_g = np.where(rested[:, None], mean, self.baseline_g)
        self.threshold_g = np.where(rested, threshold, self.threshold_g)
        self.quality = np.where(rested, quality, self.quality)
        self.moving = self.moving & ~rested
        return rested

    def _look_for_onset(self, i: int) -> None:
        far_g = self.far_g[:, i]
        leaves = far_g > np.maximum(FAR_G, self.floor_g)
        grows = far_g - self.least_far_g[:, i] > self.threshold_g
        new = ~self.moving & (_lengths(self.accel[:, i] - self.baseline_g) > self.threshold_g)
        new &= (self.quality > 0.0) | leaves | grows
        if not new.any():
            return
        j = np.flatnonzero(new)
        low = BACK * self.threshold_g[j]
        deviation = _lengths(self.accel[j, : i + 1] - self.baseline_g[j, None])
        quiet = deviation <= low[:, None]
        quiet[:, i] = False
        any_quiet = quiet.any(axis=1)
        last = np.where(any_quiet, i - np.argmax(quiet[:, ::-1], axis=1), 0)
        after, row = np.minimum(last + 1, i), np.arange(len(j))
        rise = np.maximum(deviation[row, after] - deviation[row, last], 1e-9)
        share = np.where(any_quiet, np.clip((low - deviation[row, last]) / rise, 0.0, 1.0), 0.0)
        onset = self.times[j, last] + share * (self.times[j, after] - self.times[j, last])
        self.onset_s[j] = np.maximum(onset, self.times[j, i] - BACK_S)
        self.moving[j] = True


def moments_at(
    followed: Followed, takes: I64, samples: I64, onset_shift_s: F64 | None = None
) -> Moment:
    """What a network saw at these samples of these takes; leading shape (pairs,).

    Args:
        followed: The takes.
        takes: Their numbers, shape (pairs,).
        samples: Number of the sample in each, shape (pairs,).
        onset_shift_s: Added to the onsets, shape (pairs,): how far off they might have been.

    Note:
        Equal to ``Follower.moment`` for movements that began less than ``HISTORY_S`` ago.
    """
    times, accel = followed.streams.times_s, followed.streams.accel_g
    now_s, moving = times[takes, samples], followed.is_moving[takes, samples]
    onset_s = np.where(moving, followed.onset_s[takes, samples], now_s)
    if onset_shift_s is not None:
        onset_s = np.minimum(onset_s + onset_shift_s * moving, now_s)
    baseline, elapsed_s = followed.baseline_g[takes, samples], now_s - onset_s
    ends_s = onset_s[:, None] + np.minimum(EDGES_S, elapsed_s[:, None])
    sums = _integrals(times, accel, takes, np.minimum(ends_s, now_s[:, None]))
    filled_s = np.minimum(EDGES_S[1:], elapsed_s[:, None]) - EDGES_S[:-1]
    full = filled_s > HALF_FULL * WIDTHS_S
    means = np.diff(sums, axis=1) / np.maximum(filled_s, 1e-4)[..., None] - baseline[:, None]
    return Moment(
        cells_g=np.where(full[..., None], means, 0.0),
        is_full=full.astype(np.float64),
        elapsed_s=elapsed_s,
        baseline_g=baseline,
        now_g=followed.now_g[takes, samples],
        is_still=followed.is_still[takes, samples].astype(np.float64),
        quality=followed.quality[takes, samples],
    )


def _integrals(times: F64, accel: F64, takes: I64, until_s: F64) -> F64:
    """Integral of each take's readings up to each time, shape (pairs, times, 3)."""
    steps = np.diff(times, axis=1)
    areas = 0.5 * (accel[:, 1:] + accel[:, :-1]) * steps[..., None]
    sums = np.concatenate([np.zeros((len(times), 1, 3)), np.cumsum(areas, axis=1)], axis=1)
    row = takes[:, None]
    until = np.maximum(until_s, times[takes, 0][:, None])
    # One search for all takes: each is moved behind the one before it.
    apart = float(times.max() - times.min()) + 1.0
    shifted = (times + apart * np.arange(len(times))[:, None]).ravel()
    at = np.searchsorted(shifted, until + apart * row, "right") - 1 - row * times.shape[1]
    at = np.clip(at, 0, times.shape[1] - 2)
    into, step = until - times[row, at], np.maximum(steps[row, at], 1e-9)
    rise = 0.5 * (accel[row, at + 1] - accel[row, at])
    found: F64 = sums[row, at] + accel[row, at] * into[..., None]
    found += rise * (into * into / step)[..., None]
    return found


def _recent_means(streams: Streams, sums: F64) -> F64:
    times = streams.times_s
    ends = np.arange(1, times.shape[1] + 1)[None]
    begins = np.minimum(_first_after(times, NOW_S), ends - 1)
    rows = np.arange(len(times))[:, None]
    means: F64 = (sums[rows, ends] - sums[rows, begins]) / (ends - begins)[..., None]
    return means


def _first_after(times: F64, ago_s: float) -> I64:
    """For each sample the number of the first one that is less than so long ago."""
    found = [np.searchsorted(row, row - ago_s, "right") for row in times]
    return np.array(found, np.int64).reshape(times.shape)


def _first_kept(times: F64) -> I64:
    """For each sample the number of the oldest one that a follower still has."""
    found = [np.searchsorted(row, row - HISTORY_S, "left") for row in times]
    return np.array(found, np.int64).reshape(times.shape)


def _lengths(vectors: F64) -> F64:
    lengths: F64 = np.sqrt(np.einsum("...c,...c->...", vectors, vectors))
    return lengths
