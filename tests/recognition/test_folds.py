"""Division for a cross-validation: what belongs together stays together, nothing is left out."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gestureapp.recognition.folds import MAX_FOLDS, FoldBy, divide
from gestureapp.recognition.takes import TakeSet


def takes_of(labels, **who):
    n = len(labels)
    who = {name: tuple(map(str, texts)) for name, texts in who.items()}
    return TakeSet(np.zeros((n, 3)), np.arange(n + 1), tuple(labels), np.zeros(n), **who)


GROUPS = st.lists(st.integers(0, 8), min_size=2, max_size=60).filter(lambda g: len(set(g)) > 1)


@given(groups=GROUPS, by=st.sampled_from([FoldBy.SESSION, FoldBy.REPETITION, FoldBy.USER]))
def test_what_belongs_together_stays_in_one_fold_and_every_fold_is_used(groups, by):
    division = divide(takes_of(["a"] * len(groups), **{by.value: groups}), by)

    fold_of = {}
    for group, fold in zip(groups, division.fold.tolist(), strict=True):
        assert fold_of.setdefault(group, fold) == fold
    assert sorted(set(fold_of.values())) == list(range(division.n_folds))
    assert division.n_folds == min(MAX_FOLDS, len(set(groups)))


@given(counts=st.lists(st.integers(2, 40), min_size=1, max_size=5), seed=st.integers(0, 99))
def test_blocks_in_time_follow_each_other_and_leave_each_gesture_in_every_training(counts, seed):
    labels = [f"g{k}" for k, count in enumerate(counts) for _ in range(count)]
    labels = np.random.default_rng(seed).permutation(labels).tolist()

    division = divide(takes_of(labels), FoldBy.TIME)

    for label in set(labels):
        folds = division.fold[[name == label for name in labels]]
        assert np.all(np.diff(folds) >= 0)
        sizes = np.bincount(folds, minlength=division.n_folds)
        assert sizes.max() - sizes.min() <= 1
        assert sizes.max() < len(folds)


def test_sessions_are_chosen_when_every_gesture_was_recorded_in_two():
    division = divide(takes_of("abab", session=[1, 1, 2, 2]))

    assert division.words == "by session: 2 sessions"
    assert division.fold.tolist() == [0, 0, 1, 1]


def test_a_gesture_recorded_on_one_day_only_is_divided_by_time():
    assert divide(takes_of("aabb", session=[1, 1, 2, 2])).words.startswith("by time: 2 blocks")


def test_one_session_of_two_people_each_is_two_sessions():
    division = divide(takes_of("abab", session=[1, 1, 1, 1], user=["p", "p", "q", "q"]))

    assert division.words == "by session: 2 sessions"


def test_repetitions_are_chosen_where_no_session_is_told():
    division = divide(takes_of("a" * 12, repetition=[*range(6), *range(6)]))

    assert division.words == "by repetition: 6 repetitions in 5 folds"


@pytest.mark.parametrize("who", [{}, {"user": ["p", "p"]}])
def test_what_the_takes_do_not_say_cannot_divide_them(who):
    with pytest.raises(ValueError, match=r"cannot be divided by user: .*divide by time"):
        divide(takes_of("aa", **who), FoldBy.USER)
