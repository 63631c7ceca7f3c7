"""The six positions as somebody would take them, well and badly."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gestureapp.recording.sensor_records import LevelRecord, SensorRecord
from gestureapp.sensing.values import Side
from gestureapp.setup.fit import UP
from gestureapp.setup.six_positions import SixPositions
from gestureapp.setup.values import Check, Position, PositionState
from tests.setup.lying import ALL, OFF, OFF_OFFSET_G, Lying, fed, laid, waited

P = Position


def states(view):
    return {one.position: one.state for one in view.positions}


def test_it_asks_for_the_first_position_before_anything_is_read():
    view = SixPositions(Side.LEFT).view
    assert (view.is_on, view.wanted, view.side) == (True, P.Z_UP, Side.LEFT)
    assert view.sentence == "Lay the sensor flat, its Z arrow up, and let go."
    assert set(states(view).values()) == {PositionState.MISSING}


@settings(max_examples=25)
@given(order=st.permutations(ALL), chunk=st.integers(1, 60), seed=st.integers(0, 1000))
def test_any_order_of_the_six_positions_calibrates_the_sensor(order, chunk, seed):
    sensor, machine = Lying(OFF, OFF_OFFSET_G, seed=seed), SixPositions(Side.RIGHT)
    for n, position in enumerate(order):
        assert machine.view.is_on
        fed(machine, sensor.carried((0.5, 0.5, 0.5), UP[position]), chunk)
        view = fed(machine, sensor.rest(UP[position], 2.0), chunk)
        assert sum(state is PositionState.DONE for state in states(view).values()) == n + 1
    assert (view.is_on, view.outcome.check) == (False, Check.PASSED)
    assert view.verdict.startswith("Good: within 0.")
    assert view.before_mg > 50.0 > 1.0 > view.worst_mg >= 0.0
    anywhere = sensor.rng.standard_normal((50, 3))
    anywhere /= np.linalg.norm(anywhere, axis=1)[:, None]
    for truth in anywhere:
        nominal = tuple(OFF @ truth + OFF_OFFSET_G)
        assert machine.fit.calibration.applied(nominal) == pytest.approx(truth, abs=0.005)


def test_a_position_shows_how_long_it_is_still_to_be_left_alone():
    sensor, machine = Lying(), SixPositions(Side.LEFT)
    view = fed(machine, sensor.rest(UP[P.X_DOWN], 0.75))
    (shown,) = [one for one in view.positions if one.position is P.X_DOWN]
    assert shown.state is PositionState.HOLD_STILL
    assert 0.4 < shown.progress < 0.6
    assert view.sentence == "X down: do not touch it or the table."
    view = fed(machine, sensor.rest(UP[P.X_DOWN], 1.0))
    assert states(view)[P.X_DOWN] is PositionState.DONE
    assert view.sentence == "X down is done. Lay the sensor flat, its Z arrow up, and let go."


def test_a_movement_begins_the_position_anew_and_says_so():
    sensor, machine = Lying(), SixPositions(Side.LEFT)
    fed(machine, sensor.rest(UP[P.Z_UP], 1.0))
    view = fed(machine, sensor.reads([(0.1, 0.1, 1.2)]))
    assert view.sentence.startswith("It moved: once more.")
    view = fed(machine, sensor.rest(UP[P.Z_UP], 1.4))
    assert PositionState.DONE not in states(view).values()
    view = fed(machine, sensor.rest(UP[P.Z_UP], 0.3))
    assert states(view)[P.Z_UP] is PositionState.DONE


def test_turning_it_slowly_is_no_stillness():
    sensor, machine = Lying(), SixPositions(Side.LEFT)
    angles = np.radians(np.linspace(-8, 8, 800))  # 2 degrees a second
    truth = np.column_stack([np.sin(angles), np.zeros(800), np.cos(angles)])
    view = fed(machine, sensor.reads(truth))
    assert PositionState.DONE not in states(view).values()


def test_a_position_taken_twice_is_said_and_not_taken_again():
    sensor, machine = Lying(), SixPositions(Side.LEFT)
    laid(machine, sensor, P.Z_UP)
    view = laid(machine, sensor, P.Z_UP)
    assert view.sentence.startswith("Z up was taken already. Turn it over")
    assert list(states(view).values()).count(PositionState.DONE) == 1


@pytest.mark.parametrize("askew_deg", [22, 30, 40])
def test_a_sensor_that_lies_too_far_askew_is_told_by_how_much(askew_deg):
    sensor, machine = Lying(), SixPositions(Side.LEFT)
    view = laid(machine, sensor, P.Z_UP, askew_deg=(askew_deg, 0, 0))
    assert f"It lies {askew_deg} degrees askew (Z up is nearest)" in view.sentence
    assert view.wanted is P.Z_UP
    assert laid(machine, sensor, P.Z_UP).wanted is P.Z_DOWN


def test_a_side_that_was_not_flat_is_named():
    sensor, machine = Lying(OFF, OFF_OFFSET_G), SixPositions(Side.LEFT)
    for position in ALL:
        view = laid(
            machine, sensor, position, askew_deg=(0, 12, 0) if position is P.X_UP else (0,) * 3
        )
    assert view.outcome.check is Check.FAILED
    assert view.verdict.startswith("Not flat: with X up it lay")
    assert view.sentence == "Not kept: the calibration as it was stays."
    with pytest.raises(ValueError, match="no calibration"):
        machine.record(SensorRecord("a"), 1.0)


@pytest.mark.parametrize("noise_g", [0.02, 0.05, 0.1])
def test_a_noisy_sensor_is_called_noisy(noise_g):
    sensor, machine = Lying(noise_g=noise_g), SixPositions(Side.LEFT)
    view = laid(machine, sensor, P.Z_UP, seconds=12.0)
    assert "Noisy: " in view.sentence
    assert "12 are allowed" in view.sentence
    assert PositionState.DONE not in states(view).values()


def test_a_shaking_hand_is_asked_to_let_go():
    sensor, machine = Lying(), SixPositions(Side.LEFT)
    seconds = np.arange(1200) / 100.0
    sway = np.column_stack([0.1 * np.sin(5 * seconds), 0.1 * np.cos(3 * seconds), np.ones(1200)])
    view = fed(machine, sensor.reads(sway))
    assert view.sentence.startswith("Not still for 8 s: let go of it.")


def test_samples_that_stop_coming_are_told_and_the_time_begins_anew():
    sensor, machine = Lying(), SixPositions(Side.LEFT)
    fed(machine, sensor.rest(UP[P.Z_UP], 1.2))
    assert waited(machine, sensor, 2.0).sentence.startswith("No samples come from the sensor")
    view = fed(machine, sensor.rest(UP[P.Z_UP], 1.2))
    assert states(view)[P.Z_UP] is PositionState.HOLD_STILL
    view = fed(machine, sensor.rest(UP[P.Z_UP], 0.5))
    assert states(view)[P.Z_UP] is PositionState.DONE


def test_a_frozen_sensor_is_told_and_nothing_is_taken():
    sensor, machine = Lying(noise_g=0.0), SixPositions(Side.LEFT)
    view = fed(machine, sensor.rest(UP[P.Z_UP], 5.0))
    assert view.wanted is P.Z_UP
    assert "the sensor is frozen" in view.sentence


def test_a_sensor_that_does_not_feel_being_turned_is_told_after_a_while():
    sensor, machine = Lying(), SixPositions(Side.LEFT)
    view = fed(machine, sensor.rest(UP[P.Z_UP], 30.0))
    assert "If you have turned it, it does not feel that" in view.sentence
    assert view.wanted is P.Z_DOWN


@pytest.mark.parametrize(("stuck_g", "axis"), [(0.0, 0), (0.8, 1), (-3.0, 2)])
def test_a_dead_axis_is_named_and_never_calibrated(stuck_g, axis):
    sensor = np.eye(3)
    sensor[axis] = 0.0
    offset = np.zeros(3)
    offset[axis] = stuck_g
    lying, machine = Lying(sensor, offset), SixPositions(Side.LEFT)
    said = [laid(machine, lying, position).sentence for position in ALL]
    assert machine.view.outcome.check is not Check.PASSED
    assert any(f"Axis {'XYZ'[axis]} has not moved" in sentence for sentence in said)


def test_an_axis_that_is_cut_off_before_one_g_is_refused():
    lying, machine = Lying(), SixPositions(Side.LEFT)
    for position in ALL:
        for rows in (
            lying.carried((0.5, 0.5, 0.5), UP[position]),
            lying.rest(UP[position], 2.0),
        ):
            rows[:, 3] = np.minimum(rows[:, 3], 0.9)
            view = fed(machine, rows)
    assert view.outcome.check is Check.FAILED
    assert view.verdict.startswith("Refused: axis Z ends before 1 g")


def test_numbers_that_are_none_and_samples_handed_in_twice_change_nothing():
    sensor, machine = Lying(), SixPositions(Side.LEFT)
    rows = sensor.rest(UP[P.Z_UP], 1.2)
    rows[50, 2] = np.nan
    for _ in range(5):
        view = fed(machine, rows)
    assert states(view)[P.Z_UP] is PositionState.HOLD_STILL


def test_after_the_end_nothing_more_is_taken():
    sensor, machine = Lying(), SixPositions(Side.LEFT)
    for position in ALL:
        laid(machine, sensor, position)
    before = machine.view
    assert laid(machine, sensor, P.Z_UP) == before


def test_what_is_kept_has_the_date_and_no_older_level_check():
    sensor, machine = Lying(OFF, OFF_OFFSET_G), SixPositions(Side.LEFT)
    for position in ALL:
        laid(machine, sensor, position)
    level = LevelRecord(5.0, True, 0.1, 0.1)
    kept = machine.record(SensorRecord("a", level=level), 1e9)
    assert (kept.sensor_id, kept.calibrated_wall_s, kept.level) == ("a", 1e9, None)
    assert kept.used == kept.calibration == machine.fit.calibration


@settings(max_examples=60)
@given(
    st.lists(
        st.tuples(*[st.floats(-20, 20) | st.just(np.nan) for _ in range(3)]),
        min_size=1,
        max_size=300,
    ),
    st.integers(1, 50),
)
def test_whatever_comes_it_goes_on_and_never_passes_by_chance(values, chunk):
    machine = SixPositions(Side.LEFT)
    rows = np.column_stack([np.arange(len(values)) / 100.0, np.array(values, float)])
    view = fed(machine, rows, chunk)
    assert view.outcome.check is Check.RUNNING
    assert view.sentence


def test_a_sensor_that_is_still_worn_is_not_taken_for_one_that_lies():
    sensor, machine = Lying(noise_g=0.005), SixPositions(Side.LEFT)
    seconds = np.arange(1000) / 100.0
    sway = 0.006 * np.sin(2 * np.pi * 0.4 * seconds)
    truth = np.column_stack([sway, -sway, np.ones(1000)])
    view = fed(machine, sensor.reads(truth))
    assert view.wanted is P.Z_UP
    assert view.sentence.startswith("It sways as if it were worn or held: lay it down")


def test_a_position_that_was_taken_on_the_arm_is_asked_for_once_more_and_only_once():
    sensor, machine = Lying(), SixPositions(Side.LEFT)
    sensor.noise_g = 0.006
    laid(machine, sensor, P.Z_UP)
    sensor.noise_g = 0.003
    for position in ALL[1:]:
        view = laid(machine, sensor, position)
    assert (view.is_on, view.wanted) == (True, P.Z_UP)
    assert view.sentence.startswith("With Z up it was not as still as otherwise: once more.")
    sensor.noise_g = 0.006
    view = laid(machine, sensor, P.Z_UP)
    assert view.outcome.check is Check.PASSED
