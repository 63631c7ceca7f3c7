"""What networks learn from: the windows of takes, and how a take might also have been. Pure."""

from collections import Counter
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gestureapp.errors import NotEnoughTakes
from gestureapp.gestures import LABELS
from gestureapp.recognition.model_weights import WINDOW_SAMPLES
from gestureapp.recognition.presets import MIN_TAKES
from gestureapp.recognition.takes import RATE_UNKNOWN_HZ, TakeSet

F64 = NDArray[np.float64]
I64 = NDArray[np.int64]

SHIFT_S = 0.012
"""Standard deviation of the shift in time: about the least that separates the two arms' starts."""
FARTHEST_S = 0.04
TILT_G = 0.05
"""Standard deviation of what is added to all samples of a take, per axis: 3 degrees of tilt."""
VIGOUR = 0.1
"""Relative standard deviation of how strongly a take departs from rest."""
REST_G = np.array([0.0, 0.0, 1.0])
"""A level hand at rest."""


@dataclass(frozen=True, slots=True)
class Patterns:
    """Takes as networks see them. Arrays are read-only.

    Attributes:
        labels: The gestures, in the order of the outputs.
        rows: Numbers of the takes that hold a whole window, shape (n,).
        around_g: Their samples around the activation less those of a level hand at rest, shape
            (n, 2 reach + 3, 3); the window begins at ``reach``. Where a take has no more samples,
            its last one stands.
        reach: Samples before and after the window.
        shift: Standard deviation of ``vary``'s shift, in samples.
        targets: 1 for the gesture that was done, else 0; shape (n, labels).
    """

    labels: tuple[str, ...]
    rows: I64
    around_g: F64
    reach: int
    shift: float
    targets: F64

    def __post_init__(self) -> None:
        for array in (self.rows, self.around_g, self.targets):
            array.setflags(write=False)

    def inputs_g(self) -> F64:
        """The windows as they are, less a level hand at rest, shape (n, 9)."""
        return self.around_g[:, self.reach : self.reach + WINDOW_SAMPLES].reshape(
            len(self.rows), -1
        )

    def vary(self, rng: np.random.Generator) -> F64:
        """The windows of takes as they might be on another day: shape (n, 9), drawn anew each time.

        Each take begins a little earlier or later, is made with a little more or less vigour, and
        by a hand tilted a little. These are the ways in which days differ; the sizes are chosen
        by what was best on fresh takes of simulated people.
        """
        n = len(self.rows)
        shift = np.rint(rng.normal(0.0, self.shift, n)).astype(np.int64)
        begin = self.reach + np.clip(shift, -self.reach, self.reach)
        window = self.around_g[np.arange(n)[:, None], begin[:, None] + np.arange(WINDOW_SAMPLES)]
        vigour = 1.0 + VIGOUR * rng.standard_normal((n, 1, 1))
        tilt = TILT_G * rng.standard_normal((n, 1, 3))
        varied: F64 = (window * vigour + tilt).reshape(n, -1)
        return varied


def ordered_labels(takes: TakeSet) -> tuple[str, ...]:
    """The gestures that occur: those of the gesture set in its order, then others by name."""
    found = set(takes.labels)
    return tuple(x for x in LABELS if x in found) + tuple(sorted(found - set(LABELS)))


def whole_takes(takes: TakeSet) -> list[int]:
    """Numbers of the takes that hold a whole window after the activation."""
    lengths = np.diff(takes.offsets)
    return np.flatnonzero(lengths - takes.activation >= WINDOW_SAMPLES).tolist()


def patterns_of(takes: TakeSet) -> Patterns:
    """What networks see of takes.

    Raises:
        NotEnoughTakes: says of which gesture there are too few.
    """
    labels, rows = ordered_labels(takes), whole_takes(takes)
    _refuse_few(takes, labels, rows)
    rate_hz = takes.rate_hz or RATE_UNKNOWN_HZ
    reach = max(1, round(FARTHEST_S * rate_hz))
    steps = np.arange(-reach, WINDOW_SAMPLES + reach)
    around = np.empty((len(rows), len(steps), 3))
    for number, row in enumerate(rows):
        accel_g = takes.accel_g(row)
        around[number] = accel_g[np.clip(takes.activation[row] + steps, 0, len(accel_g) - 1)]
    column = {label: k for k, label in enumerate(labels)}
    targets = np.zeros((len(rows), len(labels)))
    targets[np.arange(len(rows)), [column[takes.labels[row]] for row in rows]] = 1.0
    shift = SHIFT_S * rate_hz
    return Patterns(labels, np.array(rows), around - REST_G, reach, shift, targets)


def _refuse_few(takes: TakeSet, labels: tuple[str, ...], rows: list[int]) -> None:
    counts = Counter(takes.labels[row] for row in rows)
    few = [f"{counts[label]} of {label}" for label in labels if counts[label] < MIN_TAKES]
    if few:
        raise NotEnoughTakes(
            takes.source,
            f"only {', '.join(few)} with three samples after the activation; "
            f"at least {MIN_TAKES} of each gesture are needed, 30 are better",
        )
    if len(labels) < 2:
        raise NotEnoughTakes(takes.source, "takes of at least two gestures are needed")
