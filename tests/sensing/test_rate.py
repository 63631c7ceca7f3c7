"""Rate, jitter and worst gap over sliding spans, against plain searches."""

import itertools
import statistics

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gestureapp.sensing.rate import GAP_SPAN_S, RateMeter, WorstGap


@given(st.lists(st.floats(0, 20), max_size=60), st.floats(0, 100))
def test_worst_gap_is_what_a_plain_search_finds(steps: list[float], wait_s: float):
    worst, times = WorstGap(), [0.0]
    worst.add(0.0)
    for step in steps:
        times.append(times[-1] + step)
        worst.add(times[-1])
    now_s = times[-1] + wait_s
    pairs = itertools.pairwise(times)
    gaps = [b - a for a, b in pairs if b > now_s - GAP_SPAN_S]
    assert worst.worst_s(now_s) == max(gaps, default=0.0)


@given(st.lists(st.floats(0, 0.5), min_size=1, max_size=60), st.floats(0, 3))
def test_rate_is_what_a_plain_count_finds(steps: list[float], wait_s: float):
    meter, times = RateMeter(), [0.0]
    meter.add(0.0)
    for step in steps:
        times.append(times[-1] + step)
        meter.add(times[-1])
    now_s = times[-1] + wait_s
    recent = [t for t in times if t > now_s - 2.0]
    assert meter.rate_hz(now_s) == (len(recent) / 2.0 if now_s >= 2.0 else 0.0)


@given(st.lists(st.floats(0, 0.5) | st.just(0.0), min_size=1, max_size=60), st.floats(0, 3))
def test_jitter_is_what_a_plain_standard_deviation_finds(steps: list[float], wait_s: float):
    meter, times = RateMeter(), [0.0]
    meter.add(0.0)
    for step in steps:
        times.append(times[-1] + step)
        meter.add(times[-1])
    now_s = times[-1] + wait_s
    recent = [t for t in times if t > now_s - 2.0]
    between = [b - a for a, b in itertools.pairwise(recent) if b > a]
    is_known = now_s >= 2.0 and len(between) >= 2
    expected_s = statistics.pstdev(between) if is_known else 0.0
    assert meter.jitter_s(now_s) == pytest.approx(expected_s, abs=1e-7)


def test_an_even_stream_has_no_jitter_after_an_hour_of_uneven_time():
    meter = RateMeter()
    for n in range(360_000):
        meter.add(50_000 + n * 0.01 + 0.004 * (n % 3))
    for n in range(360_000, 360_300):
        meter.add(50_000 + n * 0.01)
    assert meter.jitter_s(50_000 + 360_299 * 0.01) == pytest.approx(0, abs=1e-6)


def test_a_stream_faster_than_can_be_counted_keeps_its_jitter_right():
    meter = RateMeter()
    for n in range(30_000):
        meter.add(n * 0.0001 + 0.00005 * (n % 2))
    assert meter.jitter_s(2.9999) == pytest.approx(0.00005, rel=0.01)
