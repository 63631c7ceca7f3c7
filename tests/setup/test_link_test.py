"""The link test: figures from arrivals, and the lowest trip level that they carry."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gestureapp.sensing.values import LinkState, Side
from gestureapp.setup.link_test import (
    RESERVE_S,
    TOTAL_S,
    TRIP_RANGE,
    LinkTest,
    carries,
    histogram,
    link_problem,
    lowest_trip_s,
)
from gestureapp.setup.values import Check, LinkTestView
from tests.setup.streams import health_of, rows_of

BEGAN_S = 500.0


def figures_of(times_s: np.ndarray, set_trip_s: float = 0.1, **health: object) -> LinkTestView:
    """A link test over samples that were received at these times after its begin."""
    test = LinkTest(Side.LEFT, BEGAN_S, health_of(n_lost=3, n_bad=5), set_trip_s)
    rows = rows_of(BEGAN_S + times_s)
    first = 0
    for tick in range(1, round(TOTAL_S / 0.1) + 1):
        now_s = BEGAN_S + 0.1 * tick + 1e-6
        end = int(np.searchsorted(rows[:, 0], now_s))
        test.step(now_s, 1.8e9, rows[first:end], health_of(**{"n_lost": 3, "n_bad": 5} | health))
        first = end
    assert not test.is_on
    return test.view


def regular(rate_hz: float = 100.0) -> np.ndarray:
    """Arrivals at this rate, without any jitter."""
    return np.arange(1, TOTAL_S * rate_hz + 20) / rate_hz


def test_a_regular_link_passes_with_its_figures():
    view = figures_of(regular(), n_lost=10, n_bad=6)
    assert view.outcome.check is Check.PASSED
    assert view.rate_hz == pytest.approx(100.0, rel=0.01)
    assert view.jitter_s < 1e-6
    assert view.worst_gap_s == pytest.approx(0.01)
    assert (view.n_lost, view.n_bad) == (7, 1)
    assert view.lowest_trip_s == TRIP_RANGE.low
    assert view.outcome.wall_s == 1.8e9
    assert "passed" in view.outcome.text


def test_a_level_that_the_link_cannot_carry_is_refused_with_the_figures():
    times_s = regular()
    times_s = times_s[(times_s < 10.005) | (times_s > 10.095)]
    view = figures_of(times_s, set_trip_s=0.1)
    assert view.worst_gap_s == pytest.approx(0.1, abs=0.011)
    assert view.outcome.check is Check.FAILED
    assert view.lowest_trip_s == pytest.approx(0.12)
    for figure in ("100 ms", "120 ms", "20 ms in reserve", "set the trip level to 120 ms"):
        assert figure in view.outcome.text


def test_the_same_link_passes_with_a_level_that_it_carries():
    times_s = regular()
    times_s = times_s[(times_s < 10.005) | (times_s > 10.095)]
    assert figures_of(times_s, set_trip_s=0.12).outcome.check is Check.PASSED


def test_samples_of_one_read_are_one_arrival():
    bursts = np.repeat(regular(25.0), 4)
    view = figures_of(bursts)
    assert view.rate_hz == pytest.approx(100.0, rel=0.02)
    assert view.worst_gap_s == pytest.approx(0.04)
    assert dict(view.histogram)[0.05] > 700


def test_silence_fails_without_a_level():
    view = figures_of(np.zeros(0))
    assert view.outcome.check is Check.FAILED
    assert "no data came" in view.outcome.text
    assert math.isnan(view.lowest_trip_s)


def test_silence_at_the_end_counts_as_a_gap():
    times_s = regular()
    view = figures_of(times_s[times_s < 29.0], set_trip_s=0.3)
    assert view.worst_gap_s == pytest.approx(1.0, abs=0.2)
    assert view.outcome.check is Check.FAILED
    assert "set the trip level" not in view.outcome.text  # no level allowed carries this


def test_a_connection_that_broke_is_said():
    view = figures_of(regular(), link=LinkState.NOT_CONNECTED)
    assert "the connection broke" in view.outcome.text


def test_one_ended_before_its_time_finds_nothing():
    test = LinkTest(Side.RIGHT, BEGAN_S, health_of(), 0.1)
    test.end()
    assert test.view.outcome.check is Check.NOT_RUN
    test.step(BEGAN_S + 31, 1.0, rows_of(np.array([BEGAN_S + 30])), health_of())
    assert test.view.outcome.check is Check.NOT_RUN


def test_a_link_that_was_not_tested_is_no_problem():
    assert link_problem(math.nan, 0.1) == ("", "")


@given(st.floats(0.0, 5.0))
def test_the_lowest_level_is_above_the_worst_gap_and_hardly_more(gap_s: float):
    lowest_s = lowest_trip_s(gap_s)
    assert lowest_s >= gap_s + RESERVE_S - 2e-5
    assert lowest_s <= max(gap_s + RESERVE_S + 0.0101, TRIP_RANGE.low)
    assert carries(lowest_s, lowest_s)
    assert not carries(lowest_s, lowest_s - 0.001)


@given(st.lists(st.floats(0.0, 10.0), max_size=200))
def test_every_gap_is_in_one_class(gaps_s: list[float]):
    classes = histogram(np.array(gaps_s))
    assert sum(count for _, count in classes) == len(gaps_s)
    low_s = -1.0
    for high_s, count in classes:
        assert count == sum(low_s < gap_s <= high_s for gap_s in gaps_s)
        low_s = high_s
