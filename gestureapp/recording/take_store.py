"""One person's takes in a database in which every change is a transaction.

A take is on the disk whole before anybody is told of it.

Every change of a take (its addition, exclusion, move, deletion) is one row of a journal that says
how the take was before and after, so that undo and redo outlive the application. An addition that
is undone, and a deletion, put the take into the bin; nothing is ever erased.
"""

import zlib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from gestureapp.errors import RecordingInvalid
from gestureapp.gestures import LABELS
from gestureapp.recognition.takes import TakeSet
from gestureapp.recording.people import TAKES_FILE, clean_name, make_person_folder
from gestureapp.recording.take_database import TakeDatabase, Value
from gestureapp.recording.take_values import F64, Judgement, Take, Verdict

State = tuple[str, bool, bool]
"""What of a take can change: its label, is_excluded, is_deleted."""

_WAS_EMPTY: Final = (
    "was empty and has been begun anew; if takes are missing, put a copy back in its place"
)


@dataclass(frozen=True, slots=True)
class NewTake:
    """A take that has not been kept yet; attributes as those of ``Take``."""

    label: str
    session: str
    wall_s: float
    judgement: Judgement
    times_s: F64
    accel_g: F64


@dataclass(frozen=True, slots=True)
class _Change:
    """One row of the journal: how a take was before and after."""

    id: int
    words: str
    take_id: int
    old: State
    new: State


class TakeStore:
    """One person's takes. Owned by the thread that made it; no other may call it.

    Args:
        data: The data folder.
        person: Whose takes; a new name begins a new database.

    Raises:
        RecordingInvalid: the database is damaged; it is kept aside under another name.
        DiskFull: no room is left there.
        RecordingError: the name cannot be used, the folder cannot be written to, the database is
            foreign or from a newer version, or another application has it open.

    Attributes:
        person: The name as it is kept.
        path: The database.
        damage: Which takes could not be read and are left out, or that the file was empty; empty
            when nothing was wrong.
    """

    def __init__(self, data: Path, person: str) -> None:
        self.person = clean_name(person)
        self.path = make_person_folder(data, person) / TAKES_FILE
        self._takes: dict[int, Take] = {}
        self._undoable: list[_Change] = []
        self._undone: list[_Change] = []
        self.damage = ""
        self._db = TakeDatabase(self.path, self.person)
        try:
            self._load()
        except RecordingInvalid as error:
            raise self._db.set_aside(error) from error
        except BaseException:
            self._db.close()
            raise

    def close(self) -> None:
        """Let others have the database. Idempotent."""
        self._db.close()

    def takes(self) -> tuple[Take, ...]:
        """All takes, oldest first, those in the bin as well."""
        return tuple(self._takes.values())

    @property
    def undo_words(self) -> str:
        """What ``undo`` would take back; empty when nothing."""
        return self._undoable[-1].words if self._undoable else ""

    @property
    def redo_words(self) -> str:
        """What ``redo`` would do again; empty when nothing."""
        return self._undone[-1].words if self._undone else ""

    def add(self, new: NewTake) -> Take:
        """Keep a take; it is on the disk when this returns.

        Raises:
            DiskFull: no room is left; nothing has changed.
            RecordingError: it cannot be written; nothing has changed.
        """
        times_s = np.ascontiguousarray(new.times_s, dtype="<f8")
        accel_g = np.ascontiguousarray(new.accel_g, dtype="<f4")
        times, accel = times_s.tobytes(), accel_g.tobytes()
        words, judgement = f"take {self._n_of(new.label) + 1} of {new.label}", new.judgement
        with self._db.transaction():
            row = (new.label, new.session, new.wall_s, judgement.verdict.value, judgement.words)
            take_id = self._db.write(
                "INSERT INTO take (is_excluded, is_deleted, label, session, wall_s, verdict, words,"
                " times_s, accel_g, crc32) VALUES (0, 0, ?, ?, ?, ?, ?, ?, ?, ?)",
                (*row, times, accel, zlib.crc32(times + accel)),
            )
            there = (new.label, False, False)
            change = self._note(take_id, words, (new.label, False, True), there)
        take = Take(
            id=take_id,
            label=new.label,
            session=new.session,
            wall_s=new.wall_s,
            judgement=judgement,
            is_excluded=False,
            is_deleted=False,
            times_s=_frozen(times_s),
            accel_g=_frozen(accel_g),
        )
        self._takes[take_id] = take
        self._done(change)
        return take

    def exclude(self, take_id: int, *, is_excluded: bool) -> None:
        """Take a take out of the training, or back in. Nothing when it is so already, or unknown.

        Raises:
            DiskFull: no room is left; nothing has changed.
            RecordingError: it cannot be written; nothing has changed.
        """
        verb = "exclusion" if is_excluded else "inclusion"
        self._change(take_id, verb, is_excluded=is_excluded)

    def move(self, take_id: int, label: str) -> None:
        """Say that a take shows another gesture. Errors as for ``exclude``."""
        take = self._takes.get(take_id)
        if take is not None:
            self._change(take_id, f"move to {label}", label=label)

    def delete(self, take_id: int) -> None:
        """Put a take into the bin. Errors as for ``exclude``."""
        self._change(take_id, "deletion", is_deleted=True)

    def undo(self) -> str:
        """Take back the last change; what it was, or empty when there was none.

        Raises:
            DiskFull: no room is left; nothing has changed.
            RecordingError: it cannot be written; nothing has changed.
        """
        if not self._undoable:
            return ""
        change = self._undoable[-1]
        self._put(change, change.old, is_undone=True)
        self._undone.append(self._undoable.pop())
        return change.words

    def redo(self) -> str:
        """Do the change undone last again; what it was, or empty. Errors as for ``undo``."""
        if not self._undone:
            return ""
        change = self._undone[-1]
        self._put(change, change.new, is_undone=False)
        self._undoable.append(self._undone.pop())
        return change.words

    # Changes.

    def _change(
        self,
        take_id: int,
        what: str,
        label: str | None = None,
        is_excluded: bool | None = None,
        is_deleted: bool | None = None,
    ) -> None:
        take = self._takes.get(take_id)
        if take is None:
            return
        old = (take.label, take.is_excluded, take.is_deleted)
        new = (
            take.label if label is None else label,
            take.is_excluded if is_excluded is None else is_excluded,
            take.is_deleted if is_deleted is None else is_deleted,
        )
        if new == old:
            return
        words = f"{what} of take {self._number_of(take)} of {take.label}"
        with self._db.transaction():
            change = self._note(take_id, words, old, new)
            self._write_state(take_id, new)
        self._set_state(take_id, new)
        self._done(change)

    def _put(self, change: _Change, state: State, *, is_undone: bool) -> None:
        with self._db.transaction():
            self._write_state(change.take_id, state)
            self._db.write("UPDATE change SET is_undone = ? WHERE id = ?", (is_undone, change.id))
        self._set_state(change.take_id, state)

    def _note(self, take_id: int, words: str, old: State, new: State) -> _Change:
        """Write a change into the journal; what was undone cannot be done again any more."""
        self._db.write("DELETE FROM change WHERE is_undone")
        change_id = self._db.write(
            "INSERT INTO change (take_id, words, old_label, old_excluded, old_deleted,"
            " new_label, new_excluded, new_deleted, is_undone) VALUES (?, ?, ?, ?, ?, ?, ?, ?, 0)",
            (take_id, words, *old, *new),
        )
        return _Change(change_id, words, take_id, old, new)

    def _done(self, change: _Change) -> None:
        self._undoable.append(change)
        self._undone.clear()

    def _write_state(self, take_id: int, state: State) -> None:
        self._db.write(
            "UPDATE take SET label = ?, is_excluded = ?, is_deleted = ? WHERE id = ?",
            (*state, take_id),
        )

    def _set_state(self, take_id: int, state: State) -> None:
        label, is_excluded, is_deleted = state
        self._takes[take_id] = replace(
            self._takes[take_id], label=label, is_excluded=is_excluded, is_deleted=is_deleted
        )

    def _n_of(self, label: str) -> int:
        return sum(1 for t in self._takes.values() if t.label == label and not t.is_deleted)

    def _number_of(self, take: Take) -> int:
        """Which of its gesture's takes it is, from 1, as they are shown."""
        before = (t for t in self._takes.values() if t.label == take.label and t.id < take.id)
        return 1 + sum(1 for t in before if not t.is_deleted)

    def _load(self) -> None:
        takes = self._db.rows(
            "SELECT id, label, session, wall_s, verdict, words, is_excluded, is_deleted,"
            " times_s, accel_g, crc32 FROM take ORDER BY id"
        )
        left_out: dict[Value, str] = {}
        for row in takes:
            try:
                take = _take_of(row)
            except (ValueError, TypeError) as error:
                left_out[row[0]] = str(error)
            else:
                self._takes[take.id] = take
        self.damage = _damage_words(self.path, left_out)
        if self._db.was_empty:
            self.damage = f"{self.path}: {_WAS_EMPTY}"
        changes = self._db.rows(
            "SELECT is_undone, id, words, take_id, old_label, old_excluded, old_deleted,"
            " new_label, new_excluded, new_deleted FROM change ORDER BY id"
        )
        for is_undone, *rest in changes:
            change = _change_of(rest)
            if change.take_id in left_out:
                continue
            if change.take_id not in self._takes:
                raise RecordingInvalid(self.path, f"change {change.id} is of an unknown take")
            (self._undone if is_undone else self._undoable).append(change)
        self._undone.reverse()


def _damage_words(path: Path, left_out: Mapping[Value, str]) -> str:
    if not left_out:
        return ""
    number, why = next(iter(left_out.items()))
    many = f"{len(left_out)} takes are" if len(left_out) > 1 else "one take is"
    kept = "left out, all others are kept; record it again"
    return f"{path}: {many} damaged (take {number!r}: {why}) and {kept}"


def _take_of(row: tuple[Value, ...]) -> Take:
    """A row as a take.

    Raises:
        ValueError: it does not fit together.
        TypeError: something in it is of the wrong type.
    """
    take_id, label, session, wall_s, verdict, words, is_excluded, is_deleted, *samples = row
    times, accel, crc32 = samples
    if not isinstance(times, bytes) or not isinstance(accel, bytes):
        raise TypeError("its samples are missing")
    if not isinstance(take_id, int) or not isinstance(wall_s, int | float):
        raise TypeError("its number or time is missing")
    if label not in LABELS:
        raise ValueError(f"its gesture {label!r} is unknown")
    if zlib.crc32(times + accel) != crc32:
        raise ValueError("its samples have changed on the disk")
    times_s = np.frombuffer(times, dtype="<f8")
    accel_g = np.frombuffer(accel, dtype="<f4").reshape(-1, 3)
    if len(times_s) != len(accel_g):
        raise ValueError(f"it has {len(times_s)} times for {len(accel_g)} samples")
    return Take(
        id=take_id,
        label=str(label),
        session=str(session),
        wall_s=float(wall_s),
        judgement=Judgement(Verdict(verdict), str(words)),
        is_excluded=bool(is_excluded),
        is_deleted=bool(is_deleted),
        times_s=_frozen(times_s),
        accel_g=_frozen(accel_g),
    )


def _change_of(row: list[Value]) -> _Change:
    change_id, words, take_id, *states = row
    old = (str(states[0]), bool(states[1]), bool(states[2]))
    new = (str(states[3]), bool(states[4]), bool(states[5]))
    return _Change(int(change_id), str(words), int(take_id), old, new)


def _frozen(array: NDArray[np.floating]) -> F64:
    values = array.astype(np.float64)
    values.setflags(write=False)
    return values


def to_take_set(takes: Iterable[Take], person: str, rate_hz: float = 100.0) -> TakeSet:
    """The takes that count, as recognisers are trained from them.

    Args:
        takes: A person's, in any state.
        person: Whose they are.
        rate_hz: At which the sensor sends.
    """
    counting = [take for take in takes if take.counts]
    return TakeSet(
        samples=np.concatenate([np.zeros((0, 3)), *(take.accel_g for take in counting)]),
        offsets=np.cumsum([0, *(len(take.times_s) for take in counting)]),
        labels=tuple(take.label for take in counting),
        activation=np.array([np.searchsorted(t.times_s, 0.0) for t in counting], dtype=np.int64),
        user=(person,) * len(counting),
        session=tuple(take.session for take in counting),
        rate_hz=rate_hz,
        source=Path(f"the takes of {person}"),
    )
