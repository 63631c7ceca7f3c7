"""The machine of a batch: count-in, beats, the left arm, pauses, lost sensors."""

import itertools
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gestureapp.guided.batch import COUNT_IN_S, LATE_S, SETTLE_S, Batch
from gestureapp.guided.values import Pace, Phase
from gestureapp.recording.take_values import AFTER_S
from gestureapp.sensing.values import ArmPosture, Side

STOP, START, NEITHER = ArmPosture.STOP, ArmPosture.START, ArmPosture.NEITHER
READY_S = COUNT_IN_S
DONE_S = AFTER_S + SETTLE_S


def by_rhythm(beat_s=1.5, size=10) -> Batch:
    return Batch(Pace.RHYTHM, beat_s, size, 0.0, STOP)


def hands_free(posture=STOP, size=10) -> Batch:
    return Batch(Pace.HANDS_FREE, 1.5, size, 0.0, posture)


def run(batch: Batch, until_s: float, from_s: float = 0.0, lost=None) -> list[float]:
    """Tick every 10 ms; the activations of the takes to be judged."""
    ticks = range(round(from_s * 100), round(until_s * 100) + 1)
    found = [batch.tick(tick / 100.0, lost) for tick in ticks]
    return [activation_s for activation_s in found if activation_s is not None]


def test_three_seconds_are_counted_in():
    batch = by_rhythm()
    counts = [(batch.tick(t, None), batch.count_in(t))[1] for t in (0.0, 0.9, 1.1, 2.1, 2.99)]
    assert counts == [3, 3, 2, 1, 1]
    batch.tick(3.0, None)
    assert batch.count_in(3.0) == 0


def test_the_first_beat_falls_on_the_end_of_the_count_in_and_the_next_follow():
    batch = by_rhythm(beat_s=2.0)
    assert batch.next_beat_s == 3.0
    assert run(batch, 10.0) == [3.0, 5.0, 7.0]


@given(st.floats(-10.0, 20.0))
def test_a_beat_lies_within_its_range_whatever_is_asked_for(beat_s):
    assert 1.1 <= by_rhythm(beat_s).beat_s <= 5.0


def test_a_take_is_judged_once_its_last_sample_is_there():
    batch = by_rhythm()
    assert run(batch, READY_S + DONE_S - 0.02) == []
    assert batch.phase is Phase.TAKING
    assert run(batch, READY_S + DONE_S + 0.02, READY_S + DONE_S - 0.01) == [3.0]
    assert batch.phase is Phase.WAITING


def test_missed_beats_are_never_caught_up():
    batch = by_rhythm(beat_s=1.5)
    run(batch, 2.9)
    assert batch.tick(3.0 + LATE_S + 0.01, None) is None
    assert (batch.phase, batch.n_missed, batch.next_beat_s) == (Phase.WAITING, 1, 4.5)
    assert batch.tick(20.0, None) is None
    assert batch.phase is Phase.WAITING
    assert batch.next_beat_s == 21.0


@given(st.lists(st.floats(0.001, 4.0), min_size=1, max_size=60), st.floats(1.1, 5.0))
def test_takes_by_rhythm_never_overlap_however_time_passes(steps_s, beat_s):
    batch, now_s, taken = by_rhythm(beat_s), 0.0, []
    for step_s in steps_s:
        now_s += step_s
        activation_s = batch.tick(now_s, None)
        if activation_s is not None:
            assert now_s >= activation_s + DONE_S
            taken.append(activation_s)
    gaps = [b - a for a, b in itertools.pairwise(taken)]
    assert all(gap_s >= beat_s - 1e-9 for gap_s in gaps)
    beats = [(activation_s - READY_S) / beat_s for activation_s in taken]
    assert all(math.isclose(beat, round(beat), abs_tol=1e-6) for beat in beats)


def test_the_left_arm_takes_as_it_starts_in_operation():
    batch = hands_free()
    run(batch, 4.0)
    batch.left(4.005, START)
    assert run(batch, 6.0, 4.01) == [4.005]


def test_the_left_arm_has_to_have_been_in_stop_before():
    batch = hands_free(posture=START)
    run(batch, 4.0)
    batch.left(4.0, NEITHER)
    batch.left(4.1, START)
    assert batch.phase is Phase.WAITING
    batch.left(4.5, STOP)
    batch.left(5.0, START)
    assert (batch.phase, batch.activation_s) == (Phase.TAKING, 5.0)


def test_a_left_arm_raised_while_counting_in_takes_nothing_until_it_was_lowered():
    batch = hands_free()
    batch.left(1.0, START)
    assert run(batch, 5.0) == []
    assert not batch.is_left_rested
    batch.left(5.0, STOP)
    batch.left(5.5, START)
    assert batch.activation_s == 5.5


def test_a_second_start_within_a_take_is_not_a_take():
    batch = hands_free()
    run(batch, 4.0)
    batch.left(4.0, START)
    batch.left(4.3, STOP)
    batch.left(4.6, START)
    assert run(batch, 8.0, 4.61) == [4.0]


def test_a_beat_does_nothing_hands_free_and_the_left_arm_nothing_by_rhythm():
    assert run(hands_free(), 20.0) == []
    batch = by_rhythm()
    run(batch, 2.99)
    batch.left(2.995, STOP)
    batch.left(2.999, START)
    assert run(batch, 4.2, 3.0) == [3.0]


def test_enough_good_takes_end_it_and_bad_ones_do_not():
    batch = by_rhythm(size=2)
    batch.judged(1)
    assert not batch.is_over
    batch.judged(2)
    assert batch.is_over
    assert run(batch, 30.0) == []
    assert math.isinf(batch.next_beat_s)


def test_a_pause_drops_the_take_and_going_on_counts_in_again():
    batch = by_rhythm()
    run(batch, 3.5)
    batch.pause()
    assert run(batch, 60.0, 3.51) == []
    batch.go_on(60.0)
    assert batch.count_in(60.0) == 3
    assert run(batch, 65.0, 60.01) == [63.0]


@pytest.mark.parametrize("pace", list(Pace))
def test_a_lost_sensor_drops_the_take_and_it_goes_on_with_a_new_count_in(pace):
    batch = Batch(pace, 1.5, 10, 0.0, STOP)
    run(batch, 3.5)
    batch.left(3.5, START)
    assert run(batch, 9.0, 3.51, Side.RIGHT) == []
    assert (batch.phase, batch.lost) == (Phase.SENSOR_LOST, Side.RIGHT)
    assert math.isinf(batch.next_beat_s)
    batch.tick(9.01, None)
    assert (batch.phase, batch.count_in(9.01), batch.lost) == (Phase.COUNT_IN, 3, None)
    if pace is Pace.RHYTHM:
        assert run(batch, 13.5, 9.02) == [pytest.approx(12.01)]


def test_a_left_arm_that_was_lost_has_to_show_stop_anew():
    batch = hands_free()
    run(batch, 4.0)
    batch.tick(4.1, Side.LEFT)
    run(batch, 9.0, 4.2)
    batch.left(9.0, START)
    assert batch.phase is Phase.WAITING


def test_a_paused_batch_waits_for_the_person_and_not_for_the_sensor():
    batch = by_rhythm()
    batch.pause()
    batch.tick(1.0, Side.RIGHT)
    batch.tick(2.0, None)
    assert batch.phase is Phase.PAUSED
    batch.go_on(3.0)
    batch.tick(3.01, Side.RIGHT)
    assert batch.phase is Phase.SENSOR_LOST


def test_what_is_over_is_over():
    batch = by_rhythm()
    batch.end()
    batch.pause()
    batch.go_on(1.0)
    batch.tick(2.0, Side.RIGHT)
    assert batch.phase is Phase.IDLE
