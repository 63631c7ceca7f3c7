"""How takes are divided for a cross-validation: nobody is heard by who has learned from him. Pure.

A fold is what one network does not see. Takes that belong together (a sitting, a repetition, a
person) stay in one fold, because they are more alike than takes of another day will be.
"""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from gestureapp.recognition.takes import TakeSet

MAX_FOLDS = 5
"""A network for each: more take longer and tell hardly more."""


class FoldBy(Enum):
    """What stays together."""

    SESSION = "session"
    """A sitting of a person."""
    TIME = "time"
    """Takes of a gesture that follow each other."""
    REPETITION = "repetition"
    """Takes with the same number, of all gestures and people."""
    USER = "user"
    """A person: the others' takes are all that a network has seen."""


@dataclass(frozen=True, slots=True)
class Division:
    """Which fold each take is in.

    Attributes:
        fold: From 0, shape (takes,), read-only.
        n_folds: At least 2.
        words: For people: ``by session: 3 sessions``.
    """

    fold: NDArray[np.int64]
    n_folds: int
    words: str

    def __post_init__(self) -> None:
        self.fold.setflags(write=False)


def divide(takes: TakeSet, by: FoldBy | None = None) -> Division:
    """Divide takes into at most ``MAX_FOLDS`` folds of nearly the same size.

    Args:
        takes: At least two of each gesture.
        by: What stays together. None chooses: the session where every gesture was recorded in two
            of them, else the repetition where the takes say it, else blocks in time.

    Raises:
        ValueError: the takes do not say what was asked for, or have only one of it.
    """
    if by is None:
        by = _choose(takes)
    if by is FoldBy.TIME:
        return _by_time(takes)
    groups = _groups(takes, by)
    names = sorted(set(groups), key=groups.index)
    if len(names) < 2:
        found = f"all takes have the same {by.value}" if names else f"the takes name no {by.value}"
        raise ValueError(f"cannot be divided by {by.value}: {found}; divide by time")
    fold_of = _balance(groups)
    folds = np.array([fold_of[group] for group in groups], dtype=np.int64)
    n_folds = len(set(fold_of.values()))
    words = f"by {by.value}: {len(names)} {by.value}s"
    if n_folds < len(names):
        words += f" in {n_folds} folds"
    return Division(folds, n_folds, words)


def _choose(takes: TakeSet) -> FoldBy:
    for by in (FoldBy.SESSION, FoldBy.REPETITION):
        groups = _groups(takes, by)
        seen = {label: set[str]() for label in takes.labels}
        for label, group in zip(takes.labels, groups, strict=False):
            seen[label].add(group)
        if all(len(found) > 1 for found in seen.values()):
            return by
    return FoldBy.TIME


def _groups(takes: TakeSet, by: FoldBy) -> Sequence[str]:
    """What each take belongs to; empty when the takes do not say it."""
    if by is FoldBy.SESSION and takes.session and takes.user:
        return [f"{u}\0{s}" for u, s in zip(takes.user, takes.session, strict=True)]
    texts: tuple[str, ...] = getattr(takes, by.value)
    return texts


def _balance(groups: Sequence[str]) -> dict[str, int]:
    """Each group's fold: the largest group first, always into the smallest fold."""
    sizes = Counter(groups)
    filled = [0] * min(MAX_FOLDS, len(sizes))
    fold_of = {}
    for group in sorted(sizes, key=lambda name: (-sizes[name], groups.index(name))):
        smallest = filled.index(min(filled))
        fold_of[group] = smallest
        filled[smallest] += sizes[group]
    return fold_of


def _by_time(takes: TakeSet) -> Division:
    """Takes of one gesture of one person in their order, cut into blocks."""
    users = takes.user or ("",) * len(takes)
    rows: dict[tuple[str, str], list[int]] = {}
    for row, key in enumerate(zip(users, takes.labels, strict=True)):
        rows.setdefault(key, []).append(row)
    fewest = min(map(len, rows.values()), default=2)
    n_folds = max(2, min(MAX_FOLDS, fewest))
    folds = np.zeros(len(takes), dtype=np.int64)
    for same in rows.values():
        folds[same] = np.arange(len(same)) * n_folds // len(same)
    return Division(folds, n_folds, f"by time: {n_folds} blocks of takes, one after the other")
