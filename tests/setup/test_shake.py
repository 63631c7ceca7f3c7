"""Assigning by shaking: decided only when one moves clearly and the other does not."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gestureapp.sensing.values import Side
from gestureapp.setup.shake import CLEARLY, GIVEN_UP_S, SHAKEN_G, STILL_G, Shake
from tests.setup.streams import rows_of

NOTHING = np.zeros((0, 4))


def shaken(left_g: float, right_g: float, span_s: float = 3.0) -> Shake:
    """Both sensors are shaken so strongly for so long."""
    shake = Shake(100.0)
    for tick in range(round(span_s / 0.02)):
        now_s = 100.0 + 0.02 * (tick + 1)
        times_s = np.array([now_s - 0.01, now_s])
        shake.step(now_s, rows_of(times_s, left_g, tick), rows_of(times_s, right_g, tick + 9999))
    return shake


@pytest.mark.parametrize(
    ("left_g", "right_g", "side", "words"),
    [
        (0.8, 0.0, Side.LEFT, "That is the sensor that starts and stops"),
        (0.0, 0.8, Side.RIGHT, "swapped now"),
        (0.8, 0.8, None, "Both move"),
        (0.1, 0.02, None, "Shake the sensor on your LEFT arm"),
        (0.8, 0.3, None, "Both move"),
    ],
)
def test_who_is_shaken(left_g: float, right_g: float, side: Side | None, words: str):
    shake = shaken(left_g, right_g)
    assert shake.shaken is side
    assert words in shake.view.sentence
    assert shake.view.is_on is (side is None)


def test_a_left_handed_person_shakes_the_right_arm():
    shake = Shake(0.0, "right")
    assert shake.view.sentence == "Shake the sensor on your RIGHT arm."
    for tick in range(100):
        now_s = 0.02 * (tick + 1)
        times_s = np.array([now_s - 0.01, now_s])
        shake.step(now_s, rows_of(times_s, 0.8, tick), rows_of(times_s, 0.8, tick + 9999))
    assert "keep your left arm still, and shake the right one" in shake.view.sentence


def test_the_bars_show_who_moves():
    view = shaken(0.8, 0.0).view
    assert view.left_shake > 0.4
    assert view.right_shake < 0.05


def test_a_sensor_that_is_not_heard_decides_nothing():
    shake = Shake(0.0)
    for tick in range(100):
        now_s = 0.02 * (tick + 1)
        times_s = np.array([now_s - 0.01, now_s])
        shake.step(now_s, rows_of(times_s, 1.0, tick), NOTHING)
    assert shake.shaken is None
    assert "right arm's sensor sends nothing" in shake.view.sentence


def test_nobody_shakes_for_ever():
    shake = Shake(0.0)
    shake.step(GIVEN_UP_S + 0.1, NOTHING, NOTHING)
    assert not shake.view.is_on
    assert "nothing has changed" in shake.view.sentence


@given(st.floats(0.0, 2.0), st.floats(0.0, 2.0))
def test_no_decision_without_a_clear_one(left_g: float, right_g: float):
    shake = shaken(left_g, right_g, 1.5)
    if shake.shaken is None:
        return
    moving, still = (left_g, right_g) if shake.shaken is Side.LEFT else (right_g, left_g)
    assert moving > SHAKEN_G * 0.5
    assert still < STILL_G * 1.5
    assert moving > still * CLEARLY * 0.5
