"""What the onset networks learn from: takes as the recogniser would meet them at a moment. Pure.

Each take is followed as it is and as it might have come in: with samples lost, with shaken time
stamps, and as a record that begins in the middle of the movement. A few moments of each are kept
with the gesture that was done: a network learns to answer at any of them.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from gestureapp.recognition.movement import ONSET_G, ONSET_MOST_G
from gestureapp.recognition.movement_batch import Followed, Streams, follow_all, moments_at
from gestureapp.recognition.takes import RATE_UNKNOWN_HZ, TakeSet
from gestureapp.recognition.window import Moment

F64 = NDArray[np.float64]
I64 = NDArray[np.int64]
Mask = NDArray[np.bool_]

LOST = (0.02, 0.10)
"""Shares of the samples that are lost in the two damaged copies of a take."""
LOST_NEGATIVE = 0.05
JITTER_S = 0.002
CUT_S = (-0.12, 0.06)
"""From the onset to where the cut copy begins."""
SHORTEST = 10
"""Samples that a cut leaves."""
ONSET_JITTER_S = 0.004
"""Onsets are found so exactly, standard deviation."""
ONSET_FACTOR = np.e
"""The last two copies are followed with thresholds of the onset up to so many times as high."""
YOUNGEST_S, OLDEST_S = 0.010, 0.300
"""A movement's age at the moments that are learned from."""
NEGATIVE_YOUNGEST_S, NEGATIVE_OLDEST_S = 0.030, 0.450
"""The first instants of a bump and of a push are the same: no network can tell them apart."""
HELD_S = (-0.2, 0.35)
"""Moments around the activation at which a posture is learned."""
SMALLEST_SHARE, WEAK = 0.30, 10.0
"""The onset is where this share of a weak movement is reached: one at this percentile."""
ONSET_STEP = 1.15
"""The onset is told in such steps: most folds of a person then share it, and their views."""
NEAR_S = (-0.2, 1.5)
JUST_S = 0.02
MIRROR = np.array([1.0, -1.0, 1.0])
"""Left-handed people: left and right change places."""


@dataclass(frozen=True, slots=True)
class Views:
    """Moments of takes.

    Attributes:
        moment: All of them; leading shape (n,).
        take: Number of the take that each is of, shape (n,).
    """

    moment: Moment
    take: I64

    def __len__(self) -> int:
        return len(self.take)

    def select(self, rows: I64 | Mask) -> "Views":
        """These only."""
        return Views(picked(self.moment, rows), self.take[rows])


@dataclass(frozen=True, slots=True)
class Variation:
    """How a movement differs from day to day, standard deviations.

    Attributes:
        tilt_deg: Rotation about each axis.
        gain: Of each axis, relative.
        offset_g: Of each axis.
        vigour: Of the movement's size, relative.
    """

    tilt_deg: float
    gain: float
    offset_g: float
    vigour: float

    def vary(self, moment: Moment, rng: np.random.Generator) -> Moment:
        """The same moments on other days, drawn anew for each."""
        n = len(moment.elapsed_s)
        turn = _rotations(rng.normal(0.0, np.radians(self.tilt_deg), (n, 3)))
        turn = turn * (1.0 + self.gain * rng.standard_normal((n, 1, 3)))
        vigour = np.exp(self.vigour * rng.standard_normal((n, 1)))
        offset_g = self.offset_g * rng.standard_normal((n, 3))
        baseline_g = np.einsum("ni,nij->nj", moment.baseline_g, turn)
        change_g = np.einsum("ni,nij->nj", moment.now_g, turn) - baseline_g
        return Moment(
            cells_g=np.matmul(moment.cells_g, turn) * vigour[:, :, None],
            is_full=moment.is_full,
            elapsed_s=moment.elapsed_s,
            baseline_g=baseline_g + offset_g,
            now_g=baseline_g + offset_g + change_g * vigour,
            is_still=moment.is_still,
            quality=moment.quality,
        )


def joined(parts: Sequence[Views]) -> Views:
    """All of them, one after the other."""
    moment = Moment(
        *(np.concatenate([getattr(part.moment, f.name) for part in parts]) for f in fields(Moment))
    )
    return Views(moment, np.concatenate([part.take for part in parts]))


def picked(moment: Moment, rows: I64 | Mask) -> Moment:
    """These moments only."""
    return Moment(*(getattr(moment, f.name)[rows] for f in fields(Moment)))


def mirrored(moment: Moment) -> Moment:
    """The same done with the other hand."""
    return Moment(
        cells_g=moment.cells_g * MIRROR,
        is_full=moment.is_full,
        elapsed_s=moment.elapsed_s,
        baseline_g=moment.baseline_g * MIRROR,
        now_g=moment.now_g * MIRROR,
        is_still=moment.is_still,
        quality=moment.quality,
    )


def streams_of(takes: TakeSet, rows: Sequence[int] | None = None) -> Streams:
    """Takes side by side, fed at their rate as ``hearing`` does it; all without ``rows``."""
    numbers = list(range(len(takes))) if rows is None else list(rows)
    rate_hz = takes.rate_hz or RATE_UNKNOWN_HZ
    length = np.diff(takes.offsets)[numbers]
    longest = max(2, int(length.max(initial=0)))
    accel_g = np.empty((len(numbers), longest, 3))
    for number, row in enumerate(numbers):
        found = takes.accel_g(row)
        accel_g[number, : len(found)] = found
        accel_g[number, len(found) :] = found[-1]
    t_s = (np.arange(longest)[None, :] - takes.activation[numbers][:, None]) / rate_hz
    return Streams(t_s, accel_g, length)


def personal_onsets_g(streams: Streams, shares: Sequence[Mask]) -> list[float]:
    """How far from rest a movement has begun: a share of a weak movement's size, in each share.

    Postures, which are still and tilted at the activation, say nothing.
    """
    seen = follow_all(streams, ONSET_G)
    t_s = streams.times_s
    is_held = (seen.is_posture & (np.abs(t_s) <= JUST_S)).any(axis=1)
    near = _inside(streams) & (t_s > NEAR_S[0]) & (t_s < NEAR_S[1])
    away_g = np.linalg.norm(streams.accel_g - seen.baseline_g, axis=2)
    size_g = np.where(near, away_g, 0.0).max(axis=1)
    found = []
    for share in shares:
        moved_g = size_g[share & ~is_held]
        weak_g = SMALLEST_SHARE * np.percentile(moved_g, WEAK) if len(moved_g) else ONSET_G
        steps = np.floor(np.log(max(weak_g, ONSET_G) / ONSET_G) / np.log(ONSET_STEP))
        found.append(min(ONSET_MOST_G, round(float(ONSET_G * ONSET_STEP**steps), 4)))
    return found


def gesture_views(
    streams: Streams, onset_g: float, per_copy: int, rng: np.random.Generator
) -> Views:
    """Moments of four copies of each take: ``per_copy`` of each, half as many of the cut one."""
    begin_s = _onsets_s(follow_all(streams, onset_g))
    cut = _cut(streams, begin_s + rng.uniform(*CUT_S, len(streams.n_samples)))
    copies = (streams, _damaged(streams, LOST[0], rng), _damaged(streams, LOST[1], rng), cut)
    found = []
    for copy, copied in enumerate(copies):
        level_g = np.full(len(streams.n_samples), onset_g)
        if copy >= 2:
            level_g *= ONSET_FACTOR ** rng.uniform(0.0, 1.0, len(streams.n_samples))
        seen = follow_all(copied, level_g)
        since_s = copied.times_s - begin_s[:, None]
        young = (since_s > -0.1 * OLDEST_S) & (since_s < OLDEST_S)
        young &= copied.times_s - seen.onset_s >= YOUNGEST_S
        held = seen.is_posture & (copied.times_s > HELD_S[0]) & (copied.times_s < HELD_S[1])
        wanted = ((seen.is_moving & young) | held) & _inside(copied)
        per = per_copy if copied is not cut else max(1, per_copy // 2)
        found.append(_drawn(seen, wanted, per, ONSET_JITTER_S if copy else 0.0, rng))
    return joined(found)


def negative_views(
    streams: Streams, onset_g: F64 | float, per: int, rng: np.random.Generator
) -> Views:
    """Moments of what is no gesture, from the first one on that a network can judge."""
    copied = _damaged(streams, LOST_NEGATIVE, rng)
    seen = follow_all(copied, onset_g)
    age_s = copied.times_s - seen.onset_s
    moving = seen.is_moving & (age_s >= NEGATIVE_YOUNGEST_S) & (age_s < NEGATIVE_OLDEST_S)
    near = np.abs(copied.times_s) < NEGATIVE_OLDEST_S
    return _drawn(seen, (moving | seen.is_posture) & near & _inside(copied), per, 0.0, rng)


def _onsets_s(seen: Followed) -> F64:
    """Begin of the movement under way at the activation, or the first after it; 0 without one."""
    after = seen.is_moving & (seen.streams.times_s >= -1e-9) & _inside(seen.streams)
    found = seen.onset_s[np.arange(len(seen.onset_s)), after.argmax(axis=1)]
    onsets_s: F64 = np.where(after.any(axis=1), found, 0.0)
    return onsets_s


def _inside(streams: Streams) -> Mask:
    """Where a take has not ended, shape (takes, samples)."""
    inside: Mask = np.arange(streams.times_s.shape[1]) < streams.n_samples[:, None]
    return inside


def _damaged(streams: Streams, lost: float, rng: np.random.Generator) -> Streams:
    """The same with samples lost and time stamps shaken."""
    keep = rng.random(streams.times_s.shape) > lost
    keep[:, 0] = True
    order = np.argsort(~(keep & _inside(streams)), axis=1, kind="stable")
    t_s = np.take_along_axis(streams.times_s, order, axis=1)
    t_s = np.maximum.accumulate(t_s + np.abs(rng.normal(0.0, JITTER_S, t_s.shape)), axis=1)
    accel_g = np.take_along_axis(streams.accel_g, order[:, :, None], axis=1)
    return _ended(t_s, accel_g, (keep & _inside(streams)).sum(axis=1))


def _cut(streams: Streams, begin_s: F64) -> Streams:
    """The same as records that begin at these times."""
    first = (streams.times_s < begin_s[:, None]).sum(axis=1)
    first = np.clip(first, 0, np.maximum(streams.n_samples - SHORTEST, 0))
    steps = np.arange(streams.times_s.shape[1])[None, :] + first[:, None]
    steps = np.minimum(steps, streams.n_samples[:, None] - 1)
    t_s = np.take_along_axis(streams.times_s, steps, axis=1)
    accel_g = np.take_along_axis(streams.accel_g, steps[:, :, None], axis=1)
    return _ended(t_s, accel_g, streams.n_samples - first)


def _ended(t_s: F64, accel_g: F64, length: I64) -> Streams:
    """After its end a take stands still, and time goes on."""
    step, last = np.arange(t_s.shape[1])[None, :], length[:, None] - 1
    over = step > last
    t_end = np.take_along_axis(t_s, last, axis=1) + 0.01 * (step - last)
    a_end = np.take_along_axis(accel_g, last[:, :, None], axis=1)
    return Streams(np.where(over, t_end, t_s), np.where(over[:, :, None], a_end, accel_g), length)


def _drawn(
    seen: Followed, wanted: Mask, per: int, jitter_s: float, rng: np.random.Generator
) -> Views:
    """``per`` moments by chance of each take that has any."""
    chance = rng.random((len(wanted), per))  # as many for each: takes do not bear on each other
    shift_s = rng.normal(0.0, jitter_s, chance.shape)
    rows = np.flatnonzero(wanted.any(axis=1))
    order = np.argsort(~wanted[rows], axis=1, kind="stable")
    chosen = (chance[rows] * wanted[rows].sum(axis=1)[:, None]).astype(np.int64)
    take, step = np.repeat(rows, per), np.take_along_axis(order, chosen, axis=1).ravel()
    return Views(moments_at(seen, take, step, shift_s[rows].ravel()), take)


def _rotations(angles_rad: F64) -> F64:
    """Rotations about vectors, to be applied from the right. Source: Rodrigues' formula."""
    size = np.linalg.norm(angles_rad, axis=-1) + 1e-12
    axis = angles_rad / size[:, None]
    x, y, z = axis.T
    zero = np.zeros_like(x)
    cross = np.stack([zero, z, -y, -z, zero, x, y, -x, zero], axis=-1).reshape(-1, 3, 3)
    c, s = np.cos(size)[:, None, None], np.sin(size)[:, None, None]
    found: F64 = np.eye(3) * c + s * cross + (1.0 - c) * axis[:, :, None] * axis[:, None, :]
    return found
