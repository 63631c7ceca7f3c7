"""Thresholds from answers to takes that the networks had not seen: at most 1 in 200 wrong. Pure.

The early decision is a walk along questions: the samples at which a network may be asked. Raising
either threshold answers later and less often, and is less often wrong; the least strict pair that
keeps the promise is taken, and where none does, the one with the least share of wrong answers to be
expected.
"""

from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from gestureapp.recognition.decision import BUDGET_S, EARLY, LAST
from gestureapp.recognition.model_file import Model
from gestureapp.recognition.movement_batch import Followed
from gestureapp.recognition.onset import GIVE_UP_S, MIN_ELAPSED_S, OLDEST_S

F64 = NDArray[np.float64]
I64 = NDArray[np.int64]

MOST_WRONG = 1 / 200
"""Of all answers, at most this share may name another gesture."""
EARLY_GRID = (EARLY, 0.97, 0.98, 0.99, 0.995)
LAST_GRID = (LAST, 0.65, 0.70, 0.75, 0.80, 0.85, 0.90)
"""Nothing less strict than the usual ones: the takes are of few days, and of gestures only."""
FEWEST = 198
"""So many answers, none of them wrong, are the fewest that speak for the promise: by Laplace's rule
of succession a share of (wrong + 1) / (answers + 2) has to be expected."""
TEMPERATURES = (0.8, 1.0, 1.25, 1.6, 2.0)
"""Simulated people's takes would choose less than 0.8; but a sharper network is surer of what is no
gesture as well, and none of that is among the takes."""
_EQUAL_S = 1e-9
_NEARLY_ZERO = 1e-9


@dataclass(frozen=True, slots=True)
class Questions:
    """When the networks are asked about takes: by take, then by time.

    Attributes:
        take: Number of the take, shape (n,).
        sample: Number of the sample in it, shape (n,).
    """

    take: I64
    sample: I64


@dataclass(frozen=True, slots=True)
class Calibration:
    """What was found.

    Attributes:
        early: An answer is given at once from this on.
        last: At the end of the budget, from this on.
        temperature: Divides the networks' last sums.
    """

    early: float
    last: float
    temperature: float


def questions_of(followed: Followed) -> Questions:
    """Where the recogniser asks its networks; the activation is at time 0."""
    t_s = followed.streams.times_s
    inside = np.arange(t_s.shape[1]) < followed.streams.n_samples[:, None]
    after = (t_s >= -_EQUAL_S) & inside
    moving, held = followed.is_moving, followed.is_posture
    begin_s = np.where(moving, np.fmax(followed.onset_s, 0.0), np.where(held, t_s, np.inf))
    begin_s = np.where(after, begin_s, np.inf)
    first = np.isfinite(begin_s).argmax(axis=1)
    first_s = begin_s[np.arange(len(begin_s)), first][:, None]
    old_enough = (followed.elapsed_s >= MIN_ELAPSED_S) & (followed.elapsed_s <= OLDEST_S)
    asked = (moving & old_enough) | held
    asked &= after & (t_s <= first_s + BUDGET_S + _EQUAL_S) & (first_s <= GIVE_UP_S)
    take, sample = np.nonzero(asked)
    return Questions(take, sample)


def decided(take: I64, shares: F64, early: float, last: float, n_takes: int) -> I64:
    """The output that each take is heard as; -1 for none. The last output is "none of them".

    Args:
        take: Of each question, in the order of ``Questions``.
        shares: Probabilities, shape (questions, outputs).
        early: Threshold of every question.
        last: Threshold of a take's last one.
        n_takes: How many there are.
    """
    best, share = shares.argmax(axis=1), shares.max(axis=1)
    is_last = np.append(take[1:] != take[:-1], True)[: len(take)]
    told = ((share >= early) | (is_last & (share >= last))) & (best < shares.shape[1] - 1)
    heard = np.full(n_takes, -1, dtype=np.int64)
    rows = np.flatnonzero(told)[::-1]
    heard[take[rows]] = best[rows]  # the first of a take comes last and stays
    return heard


def calibrate(take: I64, sums: F64, outputs: I64) -> Calibration:
    """Choose temperature and thresholds from questions about takes not seen in the training.

    Args:
        take: Of each question.
        sums: Logarithms of the probabilities of every member, shape (members, questions, outputs).
        outputs: The right output of each take.
    """
    fewest_answers = len(np.unique(take))
    if fewest_answers < FEWEST:
        return Calibration(EARLY, LAST, 1.0)
    temperature = min(TEMPERATURES, key=lambda t: _loss(shares_at(sums, t), outputs[take]))
    shares = shares_at(sums, temperature)
    found: list[tuple[float, int, float, float]] = []
    for early in EARLY_GRID:
        for last in (each for each in LAST_GRID if each <= early):
            heard = decided(take, shares, early, last, len(outputs))
            n, wrong = int((heard >= 0).sum()), int(((heard >= 0) & (heard != outputs)).sum())
            expected = (wrong + 1) / (n + 2)
            found.append((max(expected, MOST_WRONG), -n, early, last))
    _, _, early, last = min(found)
    return Calibration(early, last, temperature)


class Promise(Enum):
    """Whether at most 1 in 200 answers is wrong, by takes that the networks had not seen."""

    KEPT = "at most 1 in 200 wrong"
    NOT_SHOWN = "at most 1 in 200 wrong: not shown"
    UNKNOWN = "at most 1 in 200 wrong: not known"


def promise_of(model: Model) -> tuple[Promise, str] | None:
    """Whether a model's cross-validation speaks for it, and why in words; None of other kinds.

    The thresholds were chosen from the same takes, and none of them was anything but a gesture.
    """
    if model.decision is None:
        return None
    if model.cross_validation is None:
        return Promise.UNKNOWN, "no take was heard blind"
    confusion = model.cross_validation.evaluation.confusion
    n = int(confusion[:, :-1].sum())
    wrong = n - int(np.trace(confusion))
    words = f"{wrong} of {n} answers to takes heard blind were wrong"
    if n < FEWEST:
        return Promise.UNKNOWN, f"{words}, and {FEWEST} are the fewest that could show it"
    is_kept = (wrong + 1) / (n + 2) <= MOST_WRONG
    return (Promise.KEPT if is_kept else Promise.NOT_SHOWN), words


def shares_at(sums: F64, temperature: float) -> F64:
    """Probabilities averaged over the members, shape (questions, outputs)."""
    powers = np.exp((sums - sums.max(axis=-1, keepdims=True)) / temperature)
    shares: F64 = (powers / powers.sum(axis=-1, keepdims=True)).mean(axis=0)
    return shares


def _loss(shares: F64, outputs: I64) -> float:
    right = shares[np.arange(len(outputs)), outputs]
    return float(-np.log(np.maximum(right, _NEARLY_ZERO)).mean())
