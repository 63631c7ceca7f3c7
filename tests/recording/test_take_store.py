"""One person's takes: kept whole, changed in transactions, refused in words."""

import tempfile
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import settings as examples
from hypothesis import strategies as st

from gestureapp.errors import DiskFull, RecordingError
from gestureapp.recording.take_store import NewTake, TakeStore, to_take_set
from gestureapp.recording.take_values import Judgement, Verdict

GOOD = Judgement(Verdict.GOOD, "good")
GAP = Judgement(Verdict.GAP, "gap of 43 ms")


def new_take(label="X+", judgement=GOOD, seed=0, n=150) -> NewTake:
    rng = np.random.default_rng(seed)
    times_s = np.arange(n) / 100.0 - 0.5 + rng.uniform(0.0, 0.01)
    accel_g = rng.normal(0.0, 1.0, (n, 3)).astype(np.float32).astype(np.float64)
    return NewTake(label, "2026-11-23T08:00:00+00:00", 1.75e9 + seed, judgement, times_s, accel_g)


@pytest.fixture
def store(tmp_path: Path):
    with closing(TakeStore(tmp_path, "Ana")) as opened:
        yield opened


def reopened(store: TakeStore) -> TakeStore:
    store.close()
    return TakeStore(store.path.parents[2], store.person)


def shown(store: TakeStore) -> list[tuple[int, str, bool, bool]]:
    return [(t.id, t.label, t.is_excluded, t.is_deleted) for t in store.takes()]


def test_a_take_comes_back_another_day_as_it_was(store: TakeStore):
    new = new_take("RZ+", GAP, seed=3)
    kept = store.add(new)
    with closing(reopened(store)) as again:
        (take,) = again.takes()

    assert (take.id, take.label, take.session) == (kept.id, "RZ+", new.session)
    assert (take.wall_s, take.judgement) == (new.wall_s, GAP)
    assert np.array_equal(take.times_s, new.times_s)
    assert np.array_equal(take.accel_g, new.accel_g)
    assert np.array_equal(take.accel_g, kept.accel_g)
    assert not take.counts
    with pytest.raises(ValueError, match="read-only"):
        take.accel_g[0, 0] = 1.0


def test_a_reading_finer_than_the_disk_is_the_same_before_and_after(store: TakeStore):
    kept = store.add(replace(new_take(), accel_g=np.full((150, 3), 1.0 / 3.0)))
    with closing(reopened(store)) as again:
        assert np.array_equal(again.takes()[0].accel_g, kept.accel_g)


def test_only_good_takes_that_nobody_took_out_count(store: TakeStore):
    ids = [store.add(new_take(seed=k)).id for k in range(3)]
    store.add(new_take(judgement=GAP))
    store.exclude(ids[0], is_excluded=True)
    store.delete(ids[1])

    assert [take.id for take in store.takes() if take.counts] == [ids[2]]


def test_every_change_is_undone_and_done_again_in_words(store: TakeStore):
    first, second = store.add(new_take()), store.add(new_take(seed=1))
    store.exclude(first.id, is_excluded=True)
    store.move(first.id, "Y+")
    store.delete(second.id)
    done = shown(store)

    words = [store.undo() for _ in range(6)]

    assert words == [
        "deletion of take 1 of X+",
        "move to Y+ of take 1 of X+",
        "exclusion of take 1 of X+",
        "take 2 of X+",
        "take 1 of X+",
        "",
    ]
    assert all(take.is_deleted for take in store.takes())
    assert store.redo_words == "take 1 of X+"
    assert [store.redo() for _ in range(6)] == [*words[-2::-1], ""]
    assert shown(store) == done


def test_undo_and_redo_outlive_the_application(store: TakeStore):
    store.add(new_take())
    store.add(new_take("Y-", seed=1))
    store.undo()
    with closing(reopened(store)) as again:
        assert (again.undo_words, again.redo_words) == ("take 1 of X+", "take 1 of Y-")
        again.redo()
        assert [t.counts for t in again.takes()] == [True, True]


def test_a_new_change_ends_what_could_be_done_again(store: TakeStore):
    take = store.add(new_take())
    store.add(new_take(seed=1))
    store.undo()
    store.exclude(take.id, is_excluded=True)
    with closing(reopened(store)) as again:
        assert again.redo() == ""
        assert shown(again) == [(1, "X+", True, False), (2, "X+", False, True)]


def test_what_is_so_already_or_unknown_is_no_change(store: TakeStore):
    take = store.add(new_take())
    store.exclude(take.id, is_excluded=False)
    store.move(take.id, "X+")
    store.delete(99)
    assert store.undo_words == "take 1 of X+"


OPERATIONS = st.lists(
    st.tuples(
        st.sampled_from(["add", "exclude", "include", "move", "delete", "undo", "redo", "reopen"]),
        st.integers(1, 5),
    ),
    max_size=30,
)


@given(OPERATIONS)
@examples(max_examples=40)
def test_any_order_of_changes_can_be_walked_back_and_forth(operations):
    """Against a model that remembers every picture: undo and redo are steps along them."""
    with tempfile.TemporaryDirectory() as folder:
        store = TakeStore(Path(folder), "Ana")
        pictures, at = [shown(store)], 0
        for what, take_id in operations:
            if what == "undo":
                at -= bool(store.undo())
            elif what == "redo":
                at += bool(store.redo())
            elif what == "reopen":
                store = reopened(store)
            else:
                before = store.undo_words, shown(store)
                change(store, what, take_id)
                if (store.undo_words, shown(store)) != before:
                    pictures[at + 1 :] = [shown(store)]
                    at += 1
            there = {take[0]: take for take in shown(store) if not take[3]}
            assert there == {take[0]: take for take in pictures[at] if not take[3]}
        store.close()


def change(store: TakeStore, what: str, take_id: int) -> None:
    match what:
        case "add":
            store.add(new_take(n=3))
        case "exclude" | "include":
            store.exclude(take_id, is_excluded=what == "exclude")
        case "move":
            store.move(take_id, f"Y{'+' if take_id % 2 else '-'}")
        case "delete":
            store.delete(take_id)


def test_a_full_disk_is_told_and_nothing_is_lost(store: TakeStore):
    store.add(new_take())
    pages = int(store._db.rows("PRAGMA page_count")[0][0])
    store._db.rows(f"PRAGMA max_page_count = {pages}")
    before = shown(store), store.undo_words

    with pytest.raises(DiskFull, match="no room is left on the disk; free some and go on"):
        store.add(new_take(seed=1, n=3000))

    assert (shown(store), store.undo_words) == before
    store._db.rows("PRAGMA max_page_count = 100000")
    store.add(new_take(seed=9))
    with closing(reopened(store)) as again:
        assert len(again.takes()) == len(before[0]) + 1


def test_a_folder_that_cannot_be_made_is_told_with_the_remedy(tmp_path: Path):
    (tmp_path / "people").write_text("a file where a folder should be")
    with pytest.raises(RecordingError, match=r"cannot be made: .*--data-dir"):
        TakeStore(tmp_path, "Ana")


def test_the_takes_that_count_become_a_set_to_train_from(store: TakeStore):
    store.add(new_take("X+", seed=1))
    store.add(new_take("Y+", GAP, seed=2))
    store.add(new_take("RZ-", seed=3, n=140))
    takes = to_take_set(store.takes(), "Ana")

    assert takes.labels == ("X+", "RZ-")
    assert takes.user == ("Ana", "Ana")
    assert takes.session == ("2026-11-23T08:00:00+00:00",) * 2
    assert takes.rate_hz == 100.0
    for index, take in enumerate(t for t in store.takes() if t.counts):
        first = int(takes.activation[index])
        assert take.times_s[first - 1] < 0.0 <= take.times_s[first]
        assert np.array_equal(takes.accel_g(index), take.accel_g)


def test_the_fingerprint_changes_with_what_counts_and_only_with_that(store: TakeStore):
    store.add(new_take())
    second = store.add(new_take(seed=1))
    whole = to_take_set(store.takes(), "Ana").fingerprint()
    store.add(new_take(judgement=GAP, seed=2))
    assert to_take_set(store.takes(), "Ana").fingerprint() == whole
    store.exclude(second.id, is_excluded=True)
    assert to_take_set(store.takes(), "Ana").fingerprint() != whole
    store.exclude(second.id, is_excluded=False)
    with closing(reopened(store)) as again:
        assert to_take_set(again.takes(), "Ana").fingerprint() == whole


def test_no_takes_are_a_set_without_takes():
    assert len(to_take_set((), "Ana")) == 0
