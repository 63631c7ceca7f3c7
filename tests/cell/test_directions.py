"""From a gesture to the robot's axes, whichever way the operator faces."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gestureapp.cell.robot_memory import direction_of
from gestureapp.config import YAWS_DEG
from gestureapp.gestures import GESTURES, LABELS, Kind
from gestureapp.robot.values import Direction

yaws = st.sampled_from(YAWS_DEG)


def matrix(yaw_deg: int, *, is_rotation: bool = False) -> np.ndarray:
    """Columns: what the operator's X+, Y+, Z+ (or turns about them) become."""
    prefix = "R" if is_rotation else ""
    columns = []
    for axis in "XYZ":
        found = direction_of(f"{prefix}{axis}+", yaw_deg)
        column = np.zeros(3)
        column[found.axis] = found.sign
        columns.append(column)
    return np.array(columns).T


@given(yaws, st.booleans())
def test_the_mapping_is_a_rotation_about_z_by_the_yaw(yaw_deg: int, is_rotation: bool):
    mapped = matrix(yaw_deg, is_rotation=is_rotation)
    angle = np.radians(yaw_deg)
    turn = [[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]]
    assert np.allclose(mapped, turn)
    assert np.isclose(np.linalg.det(mapped), 1.0)
    assert np.allclose(mapped @ mapped.T, np.eye(3))


@given(yaws, st.sampled_from(GESTURES))
def test_opposite_gestures_stay_opposite_and_kinds_stay_what_they_are(yaw_deg: int, gesture):
    found = direction_of(gesture.label, yaw_deg)
    sign = "-" if gesture.sign > 0 else "+"
    other = direction_of(f"{gesture.label[:-1]}{sign}", yaw_deg)
    assert (other.axis, other.sign) == (found.axis, -found.sign)
    assert found.is_rotation == other.is_rotation == (gesture.kind is Kind.POSTURE)


@given(yaws)
def test_no_two_gestures_ask_the_same_of_the_robot(yaw_deg: int):
    assert len({direction_of(label, yaw_deg) for label in LABELS}) == len(LABELS)


@pytest.mark.parametrize("label", LABELS)
def test_without_a_yaw_the_operators_axes_are_the_robots(label: str):
    axis = "XYZ".index(label.removeprefix("R")[0])
    sign = 1 if label.endswith("+") else -1
    assert direction_of(label) == Direction(axis, sign, label.startswith("R"))


def test_at_90_the_operators_front_is_the_robots_left():
    assert direction_of("X+", 90) == Direction(1, 1, is_rotation=False)
    assert direction_of("Y+", 90) == Direction(0, -1, is_rotation=False)
    assert direction_of("Z-", 90) == Direction(2, -1, is_rotation=False)
    assert direction_of("RX+", 90) == Direction(1, 1, is_rotation=True)


@pytest.mark.parametrize("yaw_deg", [45, 270, -180, 1])
def test_any_other_yaw_is_refused(yaw_deg: int):
    with pytest.raises(ValueError, match="must be one of"):
        direction_of("X+", yaw_deg)
