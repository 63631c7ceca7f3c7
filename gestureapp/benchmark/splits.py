"""What is learned from and what is heard, of takes from a file. Pure."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from gestureapp.errors import ModelError, ModelMismatch
from gestureapp.recognition.folds import FoldBy, divide
from gestureapp.recognition.patterns import patterns_of
from gestureapp.recognition.takes import TakeSet

Part = tuple[TakeSet, TakeSet]
"""What is learned from, and what is heard."""


@dataclass(frozen=True, slots=True)
class Split:
    """One way to divide takes.

    Attributes:
        words: How.
        parts: Every take is heard in one of them. The source of what is learned from names the
            person or the fold, for messages.
    """

    words: str
    parts: Sequence[Part]


def only(takes: TakeSet, gestures: Sequence[str]) -> TakeSet:
    """The takes of these gestures; all when there are none.

    Raises:
        ModelMismatch: one is not in the file.
    """
    if not gestures:
        return takes
    if missing := [label for label in dict.fromkeys(gestures) if label not in takes.labels]:
        found = ", ".join(dict.fromkeys(takes.labels)) or "no takes at all"
        words = f"not in this file: {', '.join(missing)}; there are: {found}"
        raise ModelMismatch(takes.source, words)
    return takes.select([i for i, label in enumerate(takes.labels) if label in gestures])


def of_person(takes: TakeSet, user: str) -> TakeSet:
    """The takes of one person."""
    return takes.select([i for i, name in enumerate(takes.user) if name == user])


def splits_of(takes: TakeSet) -> tuple[list[Split], list[str]]:
    """Each person alone by repetition, and one person left out; and notes on who is missing.

    Raises:
        ModelError: the takes name neither repetition nor person, or nobody has two repetitions.
        NotEnoughTakes: says of which person or fold, and of which gesture, there are too few.
    """
    users = list(dict.fromkeys(takes.user))
    splits, notes = [], []
    if len(set(takes.repetition)) > 1:
        people = {_name(user): of_person(takes, user) for user in users} or {"": takes}
        once = [name for name, own in people.items() if len(set(own.repetition)) < 2]
        parts = [
            part
            for name, own in people.items()
            if name not in once
            for part in _folds(own, FoldBy.REPETITION, f"{name} alone, " if name else "")
        ]
        if parts:
            splits.append(Split("each person alone, by repetition", parts))
        if once:
            notes.append(f"Left out alone, with one repetition only: {', '.join(once)}.")
    if len(users) > 1:
        splits.append(Split("one person left out", list(_folds(takes, FoldBy.USER))))
    if not splits:
        reason = "the takes name neither 'repetition' nor 'user', or only one: nothing to split by"
        raise ModelError(takes.source, reason)
    for seen in (seen for split in splits for seen, _ in split.parts):
        patterns_of(seen)  # a contest takes its time: what nobody can learn from is told before
    return splits, notes


def _folds(takes: TakeSet, by: FoldBy, whose: str = "") -> Iterator[Part]:
    division = divide(takes, by)
    for number in range(division.n_folds):
        is_out = division.fold == number
        unseen = takes.select(np.flatnonzero(is_out).tolist())
        names = ", ".join(_name(name) for name in dict.fromkeys(getattr(unseen, by.value)))
        noun = "repetition " if by is FoldBy.REPETITION else ""
        source = Path(f"{takes.source} ({whose}without {noun}{names})")
        seen = takes.select(np.flatnonzero(~is_out).tolist())
        yield replace(seen, source=source), unseen


def _name(text: str) -> str:
    return text or "somebody without a name"
