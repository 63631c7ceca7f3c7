"""Where takes are, and files that are damaged, foreign, newer or in use."""

import os
import shutil
import signal
import sqlite3
import subprocess
import sys
import tempfile
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import settings as examples
from hypothesis import strategies as st

from gestureapp.errors import RecordingError, RecordingInvalid
from gestureapp.recording.people import (
    MAX_NAME_CHARS,
    clean_name,
    last_person,
    list_people,
    look_alike,
    make_person_folder,
    model_path,
    note_last_person,
    person_folder,
)
from gestureapp.recording.take_store import NewTake, TakeStore
from gestureapp.recording.take_values import Judgement, Verdict

NAMES = st.text(min_size=1, max_size=MAX_NAME_CHARS).filter(
    lambda name: 0 < len(clean_name(name)) <= MAX_NAME_CHARS
)


def add_take(store: TakeStore) -> int:
    values = np.linspace(-0.5, 0.99, 150)
    good = Judgement(Verdict.GOOD, "good")
    new = NewTake("X+", "today", 1.75e9, good, values, np.stack([values] * 3, axis=1))
    return store.add(new).id


@pytest.fixture
def kept(tmp_path: Path) -> Path:
    """A database with three takes, closed."""
    with closing(TakeStore(tmp_path, "Ana")) as store:
        for _ in range(3):
            add_take(store)
    return store.path


@given(NAMES, NAMES)
def test_two_names_never_share_a_folder_and_one_always_does(one, other):
    data = Path("data")
    is_same = clean_name(one) == clean_name(other)
    folders = [person_folder(data, name) for name in (one, other)]
    assert (folders[0] == folders[1]) is is_same
    assert (folders[0].name.casefold() == folders[1].name.casefold()) is is_same
    for folder in folders:
        assert folder.parent == data / "people"
        assert folder.name.isascii()
        assert len(folder.name) < 60
        assert set(folder.name) <= set("abcdefghijklmnopqrstuvwxyz0123456789-")


@pytest.mark.parametrize(
    "typed", ["ana lopez", "Ana  López", "ANALÓPEZ", "Ána Lopez", "Ａna Lopez"]
)
def test_a_new_name_that_only_looks_alike_is_not_a_new_person(tmp_path: Path, typed: str):
    TakeStore(tmp_path, "Ana Lopez").close()
    with pytest.raises(RecordingError, match="there is already Ana Lopez; choose that name"):
        TakeStore(tmp_path, typed)
    assert list_people(tmp_path) == ("Ana Lopez",)
    TakeStore(tmp_path, " Ana   Lopez ").close()
    TakeStore(tmp_path, "Anna Lopez").close()


def test_who_is_here_already_is_opened_whoever_looks_alike(tmp_path: Path):
    TakeStore(tmp_path, "Ana").close()
    for name in ("ana", "ANA"):  # as an earlier version made them
        folder = person_folder(tmp_path, name)
        folder.mkdir()
        (folder / "name.txt").write_text(name)
        TakeStore(tmp_path, name).close()
    assert set(list_people(tmp_path)) == {"Ana", "ana", "ANA"}


@given(st.lists(NAMES, max_size=4))
@examples(max_examples=25)
def test_everybody_who_has_a_folder_is_listed_by_name(names):
    with tempfile.TemporaryDirectory() as folder:
        kept = set()
        for name in names:
            if not look_alike(Path(folder), name):
                make_person_folder(Path(folder), name)
                kept.add(clean_name(name))
        assert set(list_people(Path(folder))) == kept


@pytest.mark.parametrize(
    "name", ["Ana", "Zoë", "../..", "a/b", "con", "名前", "x" * 60, 'q"u;o\te']
)
def test_any_name_gets_takes_of_its_own(tmp_path: Path, name: str):
    with closing(TakeStore(tmp_path, name)) as store:
        add_take(store)
    assert list_people(tmp_path) == (clean_name(name),)
    assert store.path.resolve().is_relative_to(tmp_path.resolve() / "people")
    assert model_path(tmp_path, name).parent == store.path.parent
    with closing(TakeStore(tmp_path, f"  {name} ")) as store:
        assert len(store.takes()) == 1


@pytest.mark.parametrize("name", ["", "   ", "\n", "x" * 61])
def test_no_name_and_a_name_without_end_are_refused(tmp_path: Path, name: str):
    with pytest.raises(RecordingError, match="name"):
        TakeStore(tmp_path, name)


def test_nobody_is_listed_where_nobody_is(tmp_path: Path):
    assert list_people(tmp_path) == ()
    (tmp_path / "people" / "stray").mkdir(parents=True)
    (tmp_path / "people" / "file").write_text("")
    (tmp_path / "people" / "stray" / "name.txt").write_bytes(b"\xff\xfe")
    assert list_people(tmp_path) == ()


def test_whoever_was_here_last_is_remembered_while_the_takes_are_there(tmp_path: Path):
    assert last_person(tmp_path) == ""
    note_last_person(tmp_path, "Ana")
    assert last_person(tmp_path) == "", "nothing could be kept, and nobody is there"
    TakeStore(tmp_path, "Ana").close()
    TakeStore(tmp_path, "Zoë").close()
    note_last_person(tmp_path, " Zoë ")
    assert last_person(tmp_path) == "Zoë"
    shutil.rmtree(person_folder(tmp_path, "Zoë"))
    assert last_person(tmp_path) == ""


def test_takes_in_use_are_refused_in_words_and_not_harmed(tmp_path: Path):
    with closing(TakeStore(tmp_path, "Ana")) as first:
        add_take(first)
        with pytest.raises(RecordingError, match="in use by another gestureapp; close that one"):
            TakeStore(tmp_path, "Ana")
        add_take(first)
    with closing(TakeStore(tmp_path, "Ana")) as again:
        assert len(again.takes()) == 2


@pytest.mark.parametrize(
    ("place", "cause"),
    [
        (0, "file is not a database"),
        (4096 * 2, "Page 3: "),
    ],
)
def test_a_damaged_database_is_kept_aside_and_refused_once(tmp_path, kept, place, cause):
    content = bytearray(kept.read_bytes())
    place %= len(content)
    content[place : place + 100] = b"\xa5" * 100
    kept.write_bytes(content)

    with pytest.raises(RecordingInvalid) as refused:
        TakeStore(tmp_path, "Ana")

    words = str(refused.value)
    assert "\n" not in words
    assert "is damaged" in words
    assert cause in words
    assert "kept as takes.damaged-1.sqlite" in words
    assert (kept.parent / "takes.damaged-1.sqlite").read_bytes() == bytes(content)
    assert list_people(tmp_path) == ("Ana",)
    with closing(TakeStore(tmp_path, "Ana")) as anew:
        assert anew.takes() == ()


@pytest.mark.parametrize(
    ("statement", "words"),
    [
        ("UPDATE take SET accel_g = x'00' WHERE id = 2", "take 2: its samples have changed"),
        ("UPDATE take SET times_s = 5 WHERE id = 2", "take 2: its samples are missing"),
        ("UPDATE take SET verdict = 'splendid' WHERE id = 2", "take 2: 'splendid'"),
        ("UPDATE take SET label = 'Q9' WHERE id = 2", "take 2: its gesture 'Q9' is unknown"),
    ],
)
def test_one_damaged_take_is_left_out_and_the_others_are_kept(tmp_path, kept, statement, words):
    with closing(sqlite3.connect(kept)) as db:
        db.execute(statement)
        db.commit()
    with closing(TakeStore(tmp_path, "Ana")) as store:
        assert [take.id for take in store.takes()] == [1, 3]
        assert "one take is damaged" in store.damage
        assert words in store.damage
        while store.undo_words:
            store.undo()
        assert all(take.is_deleted for take in store.takes())
        while store.redo_words:
            store.redo()
        add_take(store)
    with closing(TakeStore(tmp_path, "Ana")) as again:
        assert [take.id for take in again.takes() if not take.is_deleted] == [1, 3, 4]
    assert not (kept.parent / "takes.damaged-1.sqlite").exists()


@pytest.mark.parametrize(
    ("statement", "words"),
    [
        ("DELETE FROM take WHERE id = 3", "change 3 is of an unknown take"),
        ("DROP TABLE change", "no such table: change"),
    ],
)
def test_what_does_not_fit_together_is_damage(tmp_path: Path, kept: Path, statement, words):
    with closing(sqlite3.connect(kept)) as db:
        db.execute(statement)
        db.commit()
    with pytest.raises(RecordingInvalid, match=words):
        TakeStore(tmp_path, "Ana")
    assert (kept.parent / "takes.damaged-1.sqlite").exists()


@pytest.mark.parametrize(
    ("statement", "words"),
    [
        ("PRAGMA user_version = 2", r"newer version \(schema 2, this one reads 1\); update"),
        ("PRAGMA application_id = 5", "is no database of takes; move it elsewhere"),
        ("UPDATE person SET name = 'Bob'", "has the takes of Bob, not of Ana"),
    ],
)
def test_another_ones_database_is_refused_and_left_as_it_is(tmp_path, kept, statement, words):
    with closing(sqlite3.connect(kept)) as db:
        db.execute(statement)
        db.commit()
    content = kept.read_bytes()
    with pytest.raises(RecordingError, match=words):
        TakeStore(tmp_path, "Ana")
    assert kept.read_bytes() == content


def test_a_database_whose_making_was_cut_off_is_made_anew(tmp_path: Path):
    folder = make_person_folder(tmp_path, "Ana")
    (folder / "takes.sqlite").write_bytes(b"")
    with closing(TakeStore(tmp_path, "Ana")) as store:
        assert add_take(store) == 1
        assert "takes.sqlite: was empty and has been begun anew; if takes are" in store.damage
    with closing(TakeStore(tmp_path, "Ana")) as store:
        assert store.damage == ""
    with closing(TakeStore(tmp_path, "Bo")) as store:
        assert store.damage == "", "a new person has no empty file"


ADDS_FOR_EVER = """
import sys
from pathlib import Path
from gestureapp.recording.take_store import TakeStore
from tests.recording.test_take_store_files import add_take
store = TakeStore(Path(sys.argv[1]), "Ana")
while True:
    sys.stdout.write(f"{add_take(store)}\\n")
    sys.stdout.flush()
"""


@pytest.mark.process
@pytest.mark.parametrize("n_before_kill", [0, 1, 7, 30])
def test_killed_at_any_moment_every_take_that_was_told_of_is_there(tmp_path: Path, n_before_kill):
    command = [sys.executable, "-c", ADDS_FOR_EVER, str(tmp_path)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as child:
        assert child.stdout is not None
        told = [int(child.stdout.readline()) for _ in range(n_before_kill)]
        os.kill(child.pid, signal.SIGKILL)
        told += [int(line) for line in child.stdout.read().splitlines()]
    with closing(TakeStore(tmp_path, "Ana")) as store:
        ids = [take.id for take in store.takes()]
        assert ids[: len(told)] == told
        assert len(ids) <= len(told) + 1
        assert add_take(store) == len(ids) + 1


@pytest.mark.process
def test_a_second_application_is_refused_while_the_first_lives(tmp_path: Path):
    command = [sys.executable, "-c", ADDS_FOR_EVER, str(tmp_path)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as child:
        assert child.stdout is not None
        child.stdout.readline()
        try:
            with pytest.raises(RecordingError, match="in use by another gestureapp"):
                TakeStore(tmp_path, "Ana")
        finally:
            child.kill()
    TakeStore(tmp_path, "Ana").close()
