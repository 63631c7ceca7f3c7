"""The queue before the disk is bounded, keeps its order, and gives up plot data first."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gestureapp.cell.records import Record, Topic
from gestureapp.recording.backlog import Backlog, Dropped


def left(number, t_s):
    return Record(Topic.LEFT_ACCEL, t_s, {"seq": number})


def decision(number, t_s):
    return Record(Topic.STATE, t_s, {"activation_id": number})


def _numbers(entries):
    return [int(record.t_s) for _, record in entries]


def _record(is_plot, number):
    return left(number, float(number)) if is_plot else decision(number, float(number))


@settings(deadline=None)
@given(st.lists(st.booleans(), max_size=60), st.integers(1, 7))
def test_records_leave_in_the_order_they_came(kinds, n_max):
    backlog = Backlog(plot_mark=60, limit=60)
    for number, is_plot in enumerate(kinds):
        backlog.put(_record(is_plot, number))
    out = []
    while taken := backlog.take(n_max):
        assert len(taken) <= n_max
        out += _numbers(taken)
    assert out == list(range(len(kinds)))


@settings(deadline=None)
@given(st.lists(st.booleans(), max_size=40), st.integers(0, 20))
def test_restored_records_stand_in_front_again(kinds, n_taken):
    backlog = Backlog(plot_mark=60, limit=60)
    for number, is_plot in enumerate(kinds):
        backlog.put(_record(is_plot, number))
    taken = backlog.take(n_taken)
    backlog.put(decision(99, 99.0))
    backlog.restore(taken)
    assert _numbers(backlog.take(100)) == [*range(len(kinds)), 99]


@settings(deadline=None)
@given(st.lists(st.booleans(), max_size=60))
def test_nothing_vanishes_uncounted_and_no_decision_goes_before_plot_data(kinds):
    backlog = Backlog(plot_mark=5, limit=8)
    for number, is_plot in enumerate(kinds):
        backlog.put(_record(is_plot, number))
        assert len(backlog) <= 8
    dropped = backlog.dropped
    kept = [record for _, record in backlog.take(100)]
    assert len(kept) + dropped.n_all == len(kinds)
    if dropped.n_decisions:
        assert not any(record.topic.is_plot_data for record in kept)


def test_plot_data_is_dropped_from_the_mark_on_and_decisions_are_not():
    backlog = Backlog(plot_mark=3, limit=100)
    for number in range(5):
        backlog.put(left(number, float(number)))
    for number in range(5, 10):
        backlog.put(decision(number, float(number)))
    assert backlog.dropped == Dropped(n_plot=2, n_decisions=0)
    assert _numbers(backlog.take(100)) == [0, 1, 2, 5, 6, 7, 8, 9]


def test_at_the_limit_the_newest_decisions_are_kept():
    backlog = Backlog(plot_mark=2, limit=3)
    backlog.put(left(0, 0.0))
    for number in range(1, 6):
        backlog.put(decision(number, float(number)))
    assert backlog.dropped == Dropped(n_plot=1, n_decisions=2)
    assert _numbers(backlog.take(100)) == [3, 4, 5]


def test_restoring_into_a_full_queue_keeps_the_bound():
    backlog = Backlog(plot_mark=2, limit=3)
    for number in range(3):
        backlog.put(decision(number, float(number)))
    taken = backlog.take(2)
    for number in range(3, 5):
        backlog.put(decision(number, float(number)))
    backlog.restore(taken)
    assert len(backlog) == 3
    assert _numbers(backlog.take(9)) == [2, 3, 4]
    assert backlog.dropped.n_decisions == 2


@pytest.mark.parametrize(("mark", "limit"), [(0, 5), (6, 5)])
def test_a_mark_outside_the_limit_is_refused(mark, limit):
    with pytest.raises(ValueError, match="plot_mark"):
        Backlog(mark, limit)
