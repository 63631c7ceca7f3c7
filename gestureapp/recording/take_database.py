"""The file below a store of takes: opened, locked, checked, and its faults put into words.

A transaction is on the disk at its end (``synchronous = FULL``: journal and database are
synchronised), and a process that is killed at any moment leaves the database as it was after the
last one. The database is locked while it is open, by SQLite's own lock, which ends with the
process.
"""

import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Final

from gestureapp.errors import DiskFull, RecordingError, RecordingInvalid

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
        times_s BLOB NOT NULL, accel_g BLOB NOT NULL, crc32 INTEGER NOT NULL)""",
    """CREATE TABLE change (
        id INTEGER PRIMARY KEY, take_id INTEGER NOT NULL, words TEXT NOT NULL,
        old_label TEXT NOT NULL, old_excluded INTEGER NOT NULL, old_deleted INTEGER NOT NULL,
        new_label TEXT NOT NULL, new_excluded INTEGER NOT NULL, new_deleted INTEGER NOT NULL,
        is_undone INTEGER NOT NULL)""",
)
"""``times_s`` float64 (k), ``accel_g`` float32 (k, 3), both little-endian; ``crc32`` of the two in
this order, as SQLite itself does not notice a changed byte inside them."""

Value = str | int | float | bytes


class TakeDatabase:
    """One person's database, open and locked. Owned by the thread that made it.

    Args:
        path: Where it is; made when it is not there.
        person: Whose it is, or has to be.

    Raises:
        RecordingInvalid: it is damaged; it is kept aside under another name.
        DiskFull: no room is left there.
        RecordingError: it is another's, foreign or from a newer version (and left as it is), it
            cannot be written, or another application has it open.

    Attributes:
        path: As given.
        was_empty: A file without a byte was there, and has been begun anew: its making was cut off,
            or what was in it is gone.
    """

    def __init__(self, path: Path, person: str) -> None:
        self.path = path
        self.was_empty = _is_empty(path)
        with self._in_words():
            self._db = sqlite3.connect(path, timeout=BUSY_WAIT_S, isolation_level=None)
        try:
            self._open(person)
        except RecordingInvalid as error:
            raise self.set_aside(error) from error
        except BaseException:
            self._db.close()
            raise

    def close(self) -> None:
        """Let others have it. Idempotent."""
        self._db.close()

    def rows(self, query: str) -> list[tuple[Value, ...]]:
        """All rows of a query.

        Raises:
            RecordingError: it cannot be read.
        """
        with self._in_words():
            return self._db.execute(query).fetchall()

    def write(self, statement: str, values: tuple[Value, ...] = ()) -> int:
        """Change something, inside a transaction; the number of the row put in last.

        Raises:
            DiskFull: no room is left.
            RecordingError: it cannot be written.
        """
        with self._in_words():
            return self._db.execute(statement, values).lastrowid or 0

    @contextmanager
    def transaction(self) -> Iterator[None]:
        """All or nothing; on the disk at the end. Raises as ``write``; nothing has changed then."""
        with self._in_words():
            self._db.execute("BEGIN EXCLUSIVE")
            try:
                yield
                self._db.execute("COMMIT")
            except BaseException:
                if self._db.in_transaction:
                    self._db.execute("ROLLBACK")
                raise

    def set_aside(self, error: RecordingInvalid) -> RecordingInvalid:
        """Close a damaged database and keep it under another name; the error that says so."""
        self._db.close()
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

    def _open(self, person: str) -> None:
        with self._in_words():
            self._db.execute("PRAGMA locking_mode = EXCLUSIVE").fetchall()
            self._db.execute("PRAGMA synchronous = FULL")
        with self.transaction():
            version = self._number("PRAGMA user_version")
            is_new = not version and not self._number("SELECT count(*) FROM sqlite_master")
            if is_new:
                self._create(person)
        if not is_new:
            self._check(version, person)
        self.rows("PRAGMA journal_mode = TRUNCATE")

    def _create(self, person: str) -> None:
        for table in _TABLES:
            self.write(table)
        self.write("INSERT INTO person VALUES (?)", (person,))
        self.write(f"PRAGMA application_id = {APPLICATION_ID}")
        self.write(f"PRAGMA user_version = {SCHEMA}")

    def _check(self, version: int, person: str) -> None:
        if self._number("PRAGMA application_id") != APPLICATION_ID:
            raise RecordingError(self.path, "is no database of takes; move it elsewhere")
        if version > SCHEMA:
            reason = f"is from a newer version (schema {version}, this one reads {SCHEMA})"
            raise RecordingError(self.path, f"{reason}; update the application")
        found = [str(row[0]) for row in self.rows("PRAGMA quick_check(1)")]
        if found != ["ok"]:
            cause = found[0].splitlines()[-1] if found else "it does not answer"
            raise RecordingInvalid(self.path, cause)
        names = [str(row[0]) for row in self.rows("SELECT name FROM person")]
        if names != [person]:
            reason = f"has the takes of {', '.join(names) or 'nobody'}, not of {person}"
            raise RecordingError(self.path, f"{reason}; move it back to where it was")

    def _number(self, query: str) -> int:
        return int(self.rows(query)[0][0])

    @contextmanager
    def _in_words(self) -> Iterator[None]:
        """Translate what SQLite raises."""
        try:
            yield
        except sqlite3.Error as error:
            raise _error_of(self.path, error) from error


def _is_empty(path: Path) -> bool:
    """Whether there is a file with nothing in it, and no journal to bring something back."""
    if path.with_name(f"{path.name}-journal").exists():
        return False
    try:
        return path.stat().st_size == 0
    except OSError:  # not there; or opening it says why not
        return False


def _error_of(path: Path, error: sqlite3.Error) -> RecordingError:
    """What SQLite met, as ours: the code without its details is in the low byte."""
    code = getattr(error, "sqlite_errorcode", sqlite3.SQLITE_MISUSE) & 0xFF
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
