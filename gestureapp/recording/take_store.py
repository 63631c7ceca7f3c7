"""Everybody's takes: one SQLite database a person, in which every change is a transaction.

A take is on the disk whole before anybody is told of it: the journal is synchronised at every
commit, and a process that is killed at any moment leaves the database as it was after the last
one. The database is locked while it is open; a second application is refused in words.

Every change of a take (its addition, exclusion, move, deletion) is one row of a journal that says
how the take was before and after, so that undo and redo outlive the application. An addition that
is undone, and a deletion, put the take into the bin; nothing is ever erased.
"""

import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np

from gestureapp.errors import DiskFull, RecordingError, RecordingInvalid
from gestureapp.recording.people import TAKES_FILE, clean_name, make_person_folder
from gestureapp.recording.take_values import F64, Judgement, Take, Verdict

APPLICATION_ID: Final = 0x47545331
"""Marks our databases in their header: ``GTS1``."""
SCHEMA: Final = 1
BUSY_WAIT_S: Final = 0.3
"""A process that is just ending lets go of its lock by then."""

_TABLES: Final = (
    "CREATE TABLE person (name TEXT NOT NULL)",
    """CREATE TABLE take (
        id INTEGER PRIMARY KEY,
        label TEXT NOT NULL, is_excluded INTEGER NOT NULL, is_deleted INTEGER NOT NULL,
        session TEXT NOT NULL, wall_s REAL NOT NULL, verdict TEXT NOT NULL, words TEXT NOT NULL,
        times_s BLOB NOT NULL, accel_g BLOB NOT NULL)""",
    """CREATE TABLE change (
        id INTEGER PRIMARY KEY, take_id INTEGER NOT NULL, words TEXT NOT NULL,
        old_label TEXT NOT NULL, old_excluded INTEGER NOT NULL, old_deleted INTEGER NOT NULL,
        new_label TEXT NOT NULL, new_excluded INTEGER NOT NULL, new_deleted INTEGER NOT NULL,
        is_undone INTEGER NOT NULL)""",
)
"""``times_s`` float64 (k), ``accel_g`` float32 (k, 3), both little-endian."""


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
    old: tuple[str, bool, bool]
    new: tuple[str, bool, bool]


class TakeStore:
    """One person's takes. Owned by the thread that made it; no other may call it.

    Args:
        data: The data folder.
        person: Whose takes; a new name begins a new database.

    Raises:
        RecordingInvalid: the database is damaged (it is kept aside), foreign, or from a newer
            version (both left where they are).
        DiskFull: no room is left there.
        RecordingError: the name cannot be used, the folder cannot be written to, or another
            application has the database open.

    Attributes:
        person: The name as it is kept.
        path: The database.
    """

    def __init__(self, data: Path, person: str) -> None:
        self.person = clean_name(person)
        self.path = make_person_folder(data, person) / TAKES_FILE
        self._takes: dict[int, Take] = {}
        self._undoable: list[_Change] = []
        self._undone: list[_Change] = []
        with self._in_words():
            self._db = sqlite3.connect(self.path, timeout=BUSY_WAIT_S, isolation_level=None)
        try:
            self._open()
        except RecordingInvalid as error:
            self._db.close()
            raise self._set_aside(error) from error
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
        words, judgement = f"take {self._n_of(new.label) + 1} of {new.label}", new.judgement
        with self._transaction():
            row = (new.label, new.session, new.wall_s, judgement.verdict.value, judgement.words)
            take_id = self._db.execute(
                "INSERT INTO take (is_excluded, is_deleted, label, session, wall_s, verdict, words,"
                " times_s, accel_g) VALUES (0, 0, ?, ?, ?, ?, ?, ?, ?)",
                (*row, times_s.tobytes(), accel_g.tobytes()),
            ).lastrowid
            if take_id is None:
                raise RecordingError(self.path, "the take got no number; start the batch again")
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
        with self._transaction():
            change = self._note(take_id, words, old, new)
            self._write_state(take_id, new)
        self._set_state(take_id, new)
        self._done(change)

    def _put(self, change: _Change, state: tuple[str, bool, bool], *, is_undone: bool) -> None:
        with self._transaction():
            self._write_state(change.take_id, state)
            self._db.execute("UPDATE change SET is_undone = ? WHERE id = ?", (is_undone, change.id))
        self._set_state(change.take_id, state)

    def _note(
        self, take_id: int, words: str, old: tuple[str, bool, bool], new: tuple[str, bool, bool]
    ) -> _Change:
        """Write a change into the journal; what was undone cannot be done again any more."""
        self._db.execute("DELETE FROM change WHERE is_undone")
        change_id = self._db.execute(
            "INSERT INTO change (take_id, words, old_label, old_excluded, old_deleted,"
            " new_label, new_excluded, new_deleted, is_undone) VALUES (?, ?, ?, ?, ?, ?, ?, ?, 0)",
            (take_id, words, *old, *new),
        ).lastrowid
        return _Change(change_id or 0, words, take_id, old, new)

    def _done(self, change: _Change) -> None:
        self._undoable.append(change)
        self._undone.clear()

    def _write_state(self, take_id: int, state: tuple[str, bool, bool]) -> None:
        self._db.execute(
            "UPDATE take SET label = ?, is_excluded = ?, is_deleted = ? WHERE id = ?",
            (*state, take_id),
        )

    def _set_state(self, take_id: int, state: tuple[str, bool, bool]) -> None:
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

    # The file.

    def _open(self) -> None:
        with self._in_words():
            self._db.execute("PRAGMA locking_mode = EXCLUSIVE").fetchall()
            self._db.execute("PRAGMA synchronous = FULL")
        with self._transaction():
            version = self._number("PRAGMA user_version")
            is_new = not version and not self._number("SELECT count(*) FROM sqlite_master")
            if is_new:
                self._create()
        if not is_new:
            self._check(version)
        with self._in_words():
            self._db.execute("PRAGMA journal_mode = TRUNCATE").fetchall()
            self._load()

    def _create(self) -> None:
        for table in _TABLES:
            self._db.execute(table)
        self._db.execute("INSERT INTO person VALUES (?)", (self.person,))
        self._db.execute(f"PRAGMA application_id = {APPLICATION_ID}")
        self._db.execute(f"PRAGMA user_version = {SCHEMA}")

    def _check(self, version: int) -> None:
        with self._in_words():
            if self._number("PRAGMA application_id") != APPLICATION_ID:
                raise RecordingError(self.path, "is no database of takes; move it elsewhere")
            if version > SCHEMA:
                reason = f"is from a newer version (schema {version}, this one reads {SCHEMA})"
                raise RecordingError(self.path, f"{reason}; update the application")
            found = self._db.execute("PRAGMA quick_check(1)").fetchone()
            if found is None or found[0] != "ok":
                cause = str(found[0] if found else "no answer").splitlines()[0]
                raise RecordingInvalid(self.path, cause)
            names = [str(row[0]) for row in self._db.execute("SELECT name FROM person")]
        if names != [self.person]:
            reason = f"has the takes of {', '.join(names) or 'nobody'}, not of {self.person}"
            raise RecordingError(self.path, f"{reason}; move it back to where it was")

    def _load(self) -> None:
        for row in self._db.execute(
            "SELECT id, label, session, wall_s, verdict, words, is_excluded, is_deleted,"
            " times_s, accel_g FROM take ORDER BY id"
        ):
            try:
                take = _take_of(row)
            except (ValueError, TypeError) as error:
                raise RecordingInvalid(self.path, f"take {row[0]}: {error}") from error
            self._takes[take.id] = take
        for row in self._db.execute(
            "SELECT is_undone, id, words, take_id, old_label, old_excluded, old_deleted,"
            " new_label, new_excluded, new_deleted FROM change ORDER BY id"
        ):
            old = (str(row[4]), bool(row[5]), bool(row[6]))
            new = (str(row[7]), bool(row[8]), bool(row[9]))
            if row[3] not in self._takes:
                raise RecordingInvalid(self.path, f"change {row[1]} is of an unknown take")
            change = _Change(row[1], str(row[2]), row[3], old, new)
            (self._undone if row[0] else self._undoable).append(change)
        self._undone.reverse()

    def _set_aside(self, error: RecordingInvalid) -> RecordingInvalid:
        """Keep a damaged database under another name; the error that says so."""
        cause = str(error).removeprefix(f"{self.path}: ")
        number = 1
        while (aside := self.path.with_name(f"takes.damaged-{number}.sqlite")).exists():
            number += 1
        journal = self.path.with_name(f"{self.path.name}-journal")
        try:
            if journal.exists():
                journal.rename(aside.with_name(f"{aside.name}-journal"))
            self.path.rename(aside)
        except OSError as failed:
            reason = f"is damaged ({cause}) and cannot be renamed: {failed.strerror or failed}"
            return RecordingInvalid(self.path, f"{reason}; move it elsewhere")
        reason = f"is damaged ({cause}); kept as {aside.name}; put a copy back in its place"
        return RecordingInvalid(self.path, f"{reason}, or choose the person again to begin anew")

    def _number(self, query: str) -> int:
        return int(self._db.execute(query).fetchone()[0])

    @contextmanager
    def _transaction(self) -> Iterator[None]:
        """All or nothing; on the disk at the end."""
        with self._in_words():
            self._db.execute("BEGIN EXCLUSIVE")
            try:
                yield
                self._db.execute("COMMIT")
            except BaseException:
                if self._db.in_transaction:
                    self._db.execute("ROLLBACK")
                raise

    @contextmanager
    def _in_words(self) -> Iterator[None]:
        """Translate what SQLite raises."""
        try:
            yield
        except sqlite3.Error as error:
            raise _error_of(self.path, error) from error


def _take_of(row: tuple[object, ...]) -> Take:
    """A row as a take.

    Raises:
        ValueError: it does not fit together.
        TypeError: something in it is of the wrong type.
    """
    take_id, label, session, wall_s, verdict, words, is_excluded, is_deleted, times, accel = row
    if not isinstance(times, bytes) or not isinstance(accel, bytes):
        raise TypeError("its samples are missing")
    if not isinstance(take_id, int) or not isinstance(wall_s, int | float):
        raise TypeError("its number or time is missing")
    times_s = np.frombuffer(times, dtype="<f8")
    accel_g = np.frombuffer(accel, dtype="<f4").reshape(-1, 3)
    if len(times_s) != len(accel_g):
        raise ValueError(f"it has {len(times_s)} times for {len(accel_g)} samples")
    if not np.all(np.isfinite(times_s)) or not np.all(np.isfinite(accel_g)):
        raise ValueError("a sample is not a number")
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


def _frozen(array: "np.typing.NDArray[np.floating]") -> F64:
    values = array.astype(np.float64)
    values.setflags(write=False)
    return values


def _error_of(path: Path, error: sqlite3.Error) -> RecordingError:
    """What SQLite met, as ours: the code without its details is in the low byte."""
    code = getattr(error, "sqlite_errorcode", sqlite3.SQLITE_ERROR) & 0xFF
    match code:
        case sqlite3.SQLITE_FULL:
            return DiskFull(path, "no room is left on the disk; free some and go on")
        case sqlite3.SQLITE_BUSY | sqlite3.SQLITE_LOCKED:
            return RecordingError(path, "is in use by another gestureapp; close that one")
        case sqlite3.SQLITE_CORRUPT | sqlite3.SQLITE_NOTADB | sqlite3.SQLITE_ERROR:
            return RecordingInvalid(path, str(error))
        case sqlite3.SQLITE_READONLY | sqlite3.SQLITE_CANTOPEN | sqlite3.SQLITE_PERM:
            reason = f"cannot be written: {error}; check the folder's permissions"
            return RecordingError(path, reason)
        case sqlite3.SQLITE_IOERR:
            return RecordingError(path, f"the disk fails: {error}; check it, or use another")
        case _:
            return RecordingError(path, f"cannot be used: {error}; start the application again")
