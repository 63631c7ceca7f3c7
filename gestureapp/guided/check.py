"""Which takes of a gesture are odd, and where all takes lie beside each other. Pure.

The takes of a gesture are brought to one time base and compared with their median. The map shows
every take as one point: the two directions in which the takes' windows differ most (principal
components of their covariance).

The map's window is what the recogniser hears: three samples from the activation. On it, 30 takes of
each gesture by eight simulated people lie better apart than with the half second after the
activation or the whole take: the nearest take on the map is one of the same gesture for 77, 65 and
61 % of an ordinary person's takes, and for 98, 89 and 83 % of a practised one's.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gestureapp.recognition.model_weights import WINDOW_SAMPLES
from gestureapp.recording.take_values import Take

F64 = NDArray[np.float64]

GRID_S: F64 = np.arange(-50, 101) / 100.0
"""The common time base, from the activation: the span of a take at the paper's 100 Hz."""
GRID_S.setflags(write=False)
LEAST_TO_COMPARE = 5
"""With fewer takes that count nothing can be said about what is usual."""
ODD_RATIO = 2.0
"""A take this many times as far from the median as usual is odd.

Measured with ten simulated ordinary people, 30 takes of each gesture, one of them spoilt; share of
honest and of spoilt takes found odd:

    limit   honest   0.25 s late   hand at rest   another gesture   tilted 25 deg   half the size
    1.5     17 %     93 %          98 %           98 %              88 %            27 %
    2.0      6 %     88 %          75 %           95 %              81 %            12 %
    3.0      1 %     52 %          40 %           82 %              57 %             4 %
"""
USUAL_MIN_G = 0.06
"""Nobody is measured by less: six simulated practised people's takes are usually 0.03 to 0.08 g
from their median, and with this floor 4 % of them are found odd instead of 6 %; of ordinary
people's, which are at 0.07 to 0.22 g, as many as without."""
BAND_PERCENT = (10.0, 90.0)
"""Eight of ten takes lie between."""
_APART_S = 100.0
"""Takes are laid out on one time axis this far apart, to be interpolated in one go."""


@dataclass(frozen=True, slots=True)
class CheckedTake:
    """A take and how far it is from the others.

    Attributes:
        take: The take.
        number: Which of its gesture's takes it is, from 1, oldest first.
        distance_g: Root mean square over time of its distance from the median, in g.
        ratio: That, in units of what is usual for this gesture; NaN with too few takes to say.
    """

    take: Take
    number: int
    distance_g: float
    ratio: float

    @property
    def is_odd(self) -> bool:
        """It is far from the others, though it counts."""
        return self.take.counts and self.ratio >= ODD_RATIO

    @property
    def words(self) -> str:
        """How far it is: ``2.3 × as far as usual``; cut, so that below the limit it reads so."""
        if np.isnan(self.ratio):
            return "too few to compare"
        few = math.floor(10.0 * self.ratio) / 10.0
        ratio = f"{few:.1f} ×" if few < 10.0 else f"{few:.0f} ×"
        return f"{ratio} as far as usual" if self.is_odd else ratio


@dataclass(frozen=True, slots=True)
class GestureCheck:
    """All takes of one gesture beside each other. Arrays are read-only, on ``GRID_S``.

    Attributes:
        label: The gesture.
        takes: The odd ones first, then the others, then those that do not count; each group
            farthest first.
        curves_g: Shape (takes, times, 3), in the order of ``takes``.
        median_g: Of the takes that count, or of all when none does; shape (times, 3).
        low_g: Below lies a tenth of them; shape (times, 3).
        high_g: Above lies a tenth of them; shape (times, 3).
    """

    label: str
    takes: tuple[CheckedTake, ...]
    curves_g: F64
    median_g: F64
    low_g: F64
    high_g: F64

    @property
    def n_odd(self) -> int:
        """How many takes are odd."""
        return sum(checked.is_odd for checked in self.takes)


@dataclass(frozen=True, slots=True)
class TakeMap:
    """Every take as a point.

    Attributes:
        ids: Of the takes.
        labels: Of the takes.
        points: Shape (takes, 2), read-only, in g; the mean of all takes is at (0, 0).
        shares: How much of all difference between takes each direction shows, 0 to 1.
    """

    ids: tuple[int, ...]
    labels: tuple[str, ...]
    points: F64
    shares: tuple[float, float]


def check_gesture(label: str, takes: Sequence[Take]) -> GestureCheck:
    """Compare the takes of one gesture with their median.

    What is usual is the median of the distances of the takes that count: odd ones do not move it.

    Args:
        label: The gesture.
        takes: All its takes, in any order; those without samples are left out.
    """
    numbers = {take.id: 1 + i for i, take in enumerate(sorted(takes, key=lambda take: take.id))}
    present = [take for take in takes if len(take.times_s)]
    curves = resample(present, GRID_S)
    counts = np.array([take.counts for take in present], dtype=bool)
    reference = curves[counts] if counts.any() else curves
    if not len(reference):
        reference = np.zeros((1, len(GRID_S), 3))
    low, median, high = np.percentile(reference, [BAND_PERCENT[0], 50.0, BAND_PERCENT[1]], axis=0)
    away = curves - median
    distances = np.sqrt(np.einsum("ijk,ijk->i", away, away) / len(GRID_S))
    usual = float("nan")
    if int(counts.sum()) >= LEAST_TO_COMPARE:
        usual = max(USUAL_MIN_G, float(np.median(distances[counts])))
    checked = [
        CheckedTake(take, numbers[take.id], distance, distance / usual)
        for take, distance in zip(present, distances.tolist(), strict=True)
    ]
    order = sorted(range(len(checked)), key=lambda i: _rank(checked[i]))
    return GestureCheck(
        label,
        tuple(checked[i] for i in order),
        _frozen(curves[order]),
        _frozen(median),
        _frozen(low),
        _frozen(high),
    )


def distance_g(one: Take, other: Take) -> float:
    """Root mean square over time of the distance of two takes, in g."""
    first, second = resample([one, other], GRID_S)
    return float(np.sqrt(np.mean(np.sum((first - second) ** 2, axis=1))))


def map_takes(takes: Sequence[Take]) -> TakeMap:
    """Lay out takes of any gestures in the plane that shows most of their difference.

    Each take is its window: x, y and z in g of the first three samples from the activation on. A
    direction's sign is such that its largest part is positive, so that the same takes always give
    the same picture.

    Args:
        takes: Of any gestures; those without a whole window are left out.
    """
    present, windows = _windows(takes)
    ids = tuple(take.id for take in present)
    labels = tuple(take.label for take in present)
    if len(present) < 2:
        return TakeMap(ids, labels, _frozen(np.zeros((len(present), 2))), (0.0, 0.0))
    windows -= windows.mean(axis=0)
    values, vectors = np.linalg.eigh(windows.T @ windows)
    first_two = vectors[:, :-3:-1]
    largest = np.abs(first_two).argmax(axis=0)
    first_two = first_two * np.where(first_two[largest, [0, 1]] < 0, -1.0, 1.0)
    # By sample, so that a unit of the map is a g of all three.
    points = windows @ first_two / np.sqrt(WINDOW_SAMPLES)
    total = float(np.clip(values, 0.0, None).sum())
    first, second = (
        max(0.0, float(value)) / total if total > 0 else 0.0 for value in values[:-3:-1]
    )
    return TakeMap(ids, labels, _frozen(points), (first, second))


def _windows(takes: Sequence[Take]) -> tuple[list[Take], F64]:
    """The takes that have a whole window, and the windows, shape (takes, 9), in g."""
    present, windows = [], []
    for take in takes:
        first = int(np.searchsorted(take.times_s, 0.0))
        if first + WINDOW_SAMPLES <= len(take.times_s):
            present.append(take)
            windows.append(take.accel_g[first : first + WINDOW_SAMPLES].ravel())
    return present, np.array(windows).reshape(len(present), 3 * WINDOW_SAMPLES)


def resample(takes: Sequence[Take], times_s: F64) -> F64:
    """Takes on a common time base, linear between samples.

    Before the first and after the last sample of a take their values are held.

    Args:
        takes: Each with at least one sample.
        times_s: Times from the activation, rising.

    Returns:
        Shape (takes, times, 3), in g.
    """
    if not takes:
        return np.zeros((0, len(times_s), 3))
    starts = _APART_S * np.arange(len(takes))
    first = np.array([take.times_s[0] for take in takes])
    last = np.array([take.times_s[-1] for take in takes])
    wanted = np.clip(times_s[np.newaxis, :], first[:, np.newaxis], last[:, np.newaxis])
    wanted = (wanted + starts[:, np.newaxis]).ravel()
    known = np.concatenate([take.times_s for take in takes])
    known += np.repeat(starts, [len(take.times_s) for take in takes])
    accel = np.concatenate([take.accel_g for take in takes])
    on_grid = [np.interp(wanted, known, accel[:, axis]) for axis in range(3)]
    return np.stack(on_grid, axis=-1).reshape(len(takes), len(times_s), 3)


def _rank(checked: CheckedTake) -> tuple[bool, bool, float, int]:
    return (
        not checked.is_odd,
        not checked.take.counts,
        -checked.distance_g,
        checked.take.id,
    )


def _frozen(array: F64) -> F64:
    array.setflags(write=False)
    return array
