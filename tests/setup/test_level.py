"""The level check: what passes, what it changes, and that checks do not add up."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gestureapp.recording.sensor_records import SensorRecord
from gestureapp.sensing.calibration import Calibration
from gestureapp.sensing.values import Side
from gestureapp.setup.level import LIMIT_DEG, LIMIT_MG, LevelCheck, leveled
from gestureapp.setup.values import Check
from tests.setup.lying import Lying, fed, turn, waited

BASE = Calibration((0.02, -0.03, 0.01), ((1.05, 0.01, 0.0), (0.0, 0.95, 0.01), (0.0, 0.0, 1.02)))
CALIBRATED = SensorRecord("a", BASE, calibrated_wall_s=1e9)


def nominal_of(truth, base=BASE):
    return np.linalg.solve(np.array(base.matrix), np.asarray(truth).T).T + np.array(base.offset_g)


def checked(record, up, seconds=2.5, noise_g=0.003):
    """Lay a sensor down whose six positions' calibration reads ``up`` there, and check it."""
    check = LevelCheck(Side.LEFT, record)
    nominal = nominal_of(np.tile(up, (round(seconds * 100), 1)))
    used = np.array([record.used.applied(tuple(row)) for row in nominal])
    fed(check, Lying(noise_g=noise_g).reads(used))
    return check


_TILT = st.floats(-2.0, 2.0)


@settings(max_examples=40)
@given(x_deg=_TILT, y_deg=_TILT, scale=st.floats(0.97, 1.03))
def test_within_the_limits_it_reads_level_from_then_on(x_deg, y_deg, scale):
    up = turn((x_deg, y_deg, 0)) @ [0, 0, scale]
    check = checked(CALIBRATED, up)
    assert check.view.outcome.check is Check.PASSED
    record = check.record(2e9)
    assert (record.level.is_level, record.level.wall_s) == (True, 2e9)
    assert record.calibration == BASE
    assert record.used.applied(tuple(nominal_of(up))) == pytest.approx((0, 0, 1), abs=2e-3)


@settings(max_examples=40)
@given(x_deg=_TILT, y_deg=_TILT, scale=st.floats(0.96, 1.04))
def test_the_correction_is_a_turn_and_a_scale_no_larger_than_the_limits(x_deg, y_deg, scale):
    read = tuple(turn((x_deg, y_deg, 0)) @ [0, 0, scale])
    change = np.array(leveled(Calibration(), read).matrix)
    assert change @ change.T * scale**2 == pytest.approx(np.eye(3), abs=1e-9)
    assert np.linalg.det(change) > 0
    angle = np.degrees(np.arccos(min(1.0, (np.trace(change) * scale - 1) / 2)))
    assert angle <= np.hypot(x_deg, y_deg) + 1e-3
    assert change @ read == pytest.approx((0, 0, 1), abs=1e-9)


def test_checks_day_after_day_do_not_add_up():
    record = CALIBRATED
    for day in range(1, 4):
        check = checked(record, turn((2.0 * day, 0, 0)) @ [0, 0, 1.0])
        record = check.record(day * 86400.0)
        assert check.view.off_deg == pytest.approx(2.0 * day, abs=0.1)
    assert not record.level.is_level
    assert record.used == BASE


@pytest.mark.parametrize(
    ("up", "words"),
    [
        (turn((3.9, 0, 0)) @ [0, 0, 1], "3.9 degrees off level, 3 are allowed: lay it on a level"),
        ((0, 0, -1.0), "180.0 degrees off level"),
        ((0, 0, 1.06), "+60 mg off 1 g, 40 are allowed"),
        ((0, 0, 0.94), "-60 mg off 1 g"),
    ],
)
def test_outside_the_limits_it_says_what_to_do_and_changes_nothing(up, words):
    check = checked(CALIBRATED, up)
    assert check.view.outcome.check is Check.FAILED
    assert check.view.outcome.text.startswith(words)
    assert "calibrate anew" in check.view.outcome.text
    record = check.record(2e9)
    assert (record.level.is_level, record.used) == (False, BASE)


@pytest.mark.parametrize(("factor", "passes"), [(0.97, True), (1.03, False)])
def test_just_within_and_just_over_each_limit(factor, passes):
    for up in (turn((LIMIT_DEG * factor, 0, 0)) @ [0, 0, 1], (0, 0, 1 + LIMIT_MG * factor / 1000)):
        assert checked(CALIBRATED, up).record(1.0).level.is_level is passes


def test_it_shows_how_far_it_is_and_begins_anew_when_moved():
    check, sensor = LevelCheck(Side.RIGHT, SensorRecord("a")), Lying()
    view = fed(check, sensor.rest((0, 0, 1), 1.0))
    assert (view.side, view.outcome.check) == (Side.RIGHT, Check.RUNNING)
    assert 0.4 < view.progress < 0.6
    assert fed(check, sensor.reads([(0.2, 0, 1)])).progress < 0.1
    assert fed(check, sensor.rest((0, 0, 1), 1.9)).outcome.check is Check.RUNNING
    assert fed(check, sensor.rest((0, 0, 1), 0.3)).outcome.check is Check.PASSED


def test_without_samples_it_ends_by_itself_and_says_why():
    check = LevelCheck(Side.LEFT, CALIBRATED)
    view = waited(check, Lying(), 21.0)
    assert view.outcome.check is Check.FAILED
    assert view.outcome.text.startswith("No samples came from the sensor")
    assert check.record(1.0) is CALIBRATED


def test_a_sensor_that_is_never_still_ends_it():
    check, sensor = LevelCheck(Side.LEFT, CALIBRATED), Lying(noise_g=0.2)
    view = fed(check, sensor.rest((0, 0, 1), 21.0))
    assert view.outcome.text.startswith("It never lay still")


def test_a_frozen_sensor_is_not_level():
    view = fed(LevelCheck(Side.LEFT, CALIBRATED), Lying(noise_g=0.0).rest((0, 0, 1), 21.0))
    assert view.outcome.check is Check.FAILED
    assert "frozen" in view.outcome.text
