"""Recording a person's two postures, and how far they must lie apart."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gestureapp.config import SiteSettings
from gestureapp.sensing.posture import LeftPostures
from gestureapp.setup.postures import (
    LEAST_MARGIN_DEG,
    PostureRecorder,
    between_deg,
    margin_deg,
    posture_problem,
)
from gestureapp.setup.values import Check
from tests.setup.lying import Lying, fed, turn, waited

SITE = SiteSettings()
LEVEL = np.array([0.0, 0.0, 1.0])


def turned(degrees):
    return turn((0, -degrees, 0)) @ LEVEL


def recorded(stop=LEVEL, start=None, site=SITE, noise_g=0.02):
    recorder, arm = PostureRecorder("Ada", site), Lying(noise_g=noise_g)
    start = turned(90) if start is None else start
    fed(recorder, arm.rest(stop, 5.0))
    fed(recorder, arm.carried(stop, start))
    fed(recorder, arm.rest(start, 2.5))
    return recorder


def test_stop_then_start_are_recorded_as_they_are_held():
    recorder = recorded(turn((10, 5, 0)) @ LEVEL, turned(80))
    view = recorder.view
    assert (view.person, view.is_on, view.outcome.check) == ("Ada", False, Check.PASSED)
    assert view.between_deg == pytest.approx(85.1, abs=1.0)
    assert view.margin_deg == pytest.approx(view.between_deg - 65.0)
    assert view.sentence.startswith("Postures recorded. 8")
    assert view.sentence.endswith(f"degrees between them, {view.margin_deg:.0f} to spare.")
    for vector, truth in (
        (recorder.postures.stop, turn((10, 5, 0)) @ LEVEL),
        (recorder.postures.start, turned(80)),
    ):
        assert math.hypot(*vector) == pytest.approx(1.0)
        assert all(type(value) is float for value in vector)
        assert vector == pytest.approx(truth, abs=0.01)


@given(st.floats(20.0, 180.0))
def test_the_built_in_limits_leave_what_is_left_of_the_angle(angle):
    postures = LeftPostures(start=tuple(turned(angle)))
    assert between_deg(postures.stop, postures.start) == pytest.approx(angle, abs=1e-6)
    assert margin_deg(postures, SITE) == pytest.approx(angle - 65.0, abs=1e-6)
    problem, remedy = posture_problem(postures, SITE)
    assert bool(problem) is bool(remedy) is (angle - 65.0 < LEAST_MARGIN_DEG)


def test_the_built_in_postures_may_be_armed_with():
    assert posture_problem(LeftPostures(), SITE) == ("", "")


def test_a_site_that_lets_postures_be_left_farther_needs_them_farther_apart():
    problem, remedy = posture_problem(
        LeftPostures(), replace(SITE, posture_enter_deg=43.0, posture_leave_deg=44.0)
    )
    assert problem == "stop and start posture are 90 degrees apart, 92 are needed"
    assert "record the postures anew" in remedy


def test_postures_too_near_to_each_other_are_not_kept():
    recorder = recorded(start=turned(50))
    assert recorder.postures is None
    assert recorder.view.outcome.check is Check.FAILED
    assert "degrees apart, 70 are needed: record the postures anew" in recorder.view.sentence
    assert recorder.view.margin_deg == pytest.approx(-15.0, abs=1.0)


def test_what_is_held_when_the_button_is_pressed_is_not_the_stop_posture():
    recorder, arm = PostureRecorder("Ada", SITE), Lying()
    fed(recorder, arm.rest(turned(120), 2.0))
    fed(recorder, arm.carried(turned(120), LEVEL))
    fed(recorder, arm.rest(LEVEL, 2.5))
    assert recorder.view.is_stop_done
    fed(recorder, arm.carried(LEVEL, turned(90)))
    fed(recorder, arm.rest(turned(90), 2.5))
    assert recorder.postures.stop == pytest.approx(LEVEL, abs=0.01)


def test_an_arm_that_stays_in_stop_is_told_and_then_it_ends():
    recorder, arm = PostureRecorder("Ada", SITE), Lying()
    fed(recorder, arm.rest(LEVEL, 12.0))
    assert "still in the stop posture" in recorder.view.sentence
    assert not recorder.view.is_start_done
    fed(recorder, arm.rest(LEVEL, 25.0))
    assert recorder.view.outcome.check is Check.FAILED
    assert recorder.postures is None


def test_a_sensor_that_is_not_calibrated_is_told():
    recorder, arm = PostureRecorder("Ada", SITE), Lying()
    fed(recorder, arm.rest(LEVEL * 0.7, 6.0))
    assert "reads 0.70 g where 1 g is: calibrate it first" in recorder.view.sentence
    assert not recorder.view.is_stop_done


def test_a_shaking_arm_and_a_silent_sensor_end_it():
    recorder, arm = PostureRecorder("Ada", SITE), Lying(noise_g=0.3)
    fed(recorder, arm.rest(LEVEL, 31.0))
    assert "The stop posture was not held still for 1.5 s" in recorder.view.outcome.text
    recorder, arm = PostureRecorder("Ada", SITE), Lying()
    view = waited(recorder, arm, 5.0)
    assert (view.is_on, view.sentence[:10]) == (True, "No samples")
    view = waited(recorder, arm, 30.0)
    assert (view.is_on, view.outcome.check) == (False, Check.FAILED)
