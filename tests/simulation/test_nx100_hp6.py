"""The emulated arm's geometry, against the published figures and against itself."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gestureapp.robot.values import Pose
from gestureapp.simulation import hp6


def test_home_is_where_the_link_lengths_put_it():
    home = hp6.tool_pose((0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    assert home.position_mm == pytest.approx((885.0, 0.0, 725.0))
    assert hp6.wrist_mm(home) == pytest.approx((790.0, 0.0, 725.0))


def test_reach_is_the_published_one():
    assert pytest.approx(1378.5, abs=0.05) == hp6.REACH_MM
    straight = (0.0, 90.0, 90.0 - math.degrees(math.atan2(155.0, 640.0)), 0.0, 0.0, 0.0)
    assert math.hypot(*hp6.wrist_mm(hp6.tool_pose(straight))) == pytest.approx(hp6.REACH_MM)


@given(
    st.floats(-160.0, 160.0),
    st.floats(-50.0, 60.0),
    st.floats(-60.0, 60.0),
    st.floats(-89.0, 89.0),
    st.floats(5.0, 120.0) | st.floats(-120.0, -5.0),
    st.floats(-170.0, 170.0),
)
def test_joints_of_a_pose_give_the_pose_back(s, lower, upper, r, b, t):
    pose = hp6.tool_pose((s, lower, upper, r, b, t), (10.0, -20.0, 120.0))
    again = hp6.tool_pose(hp6.joints_deg(pose, (10.0, -20.0, 120.0)), (10.0, -20.0, 120.0))
    assert again.position_mm == pytest.approx(pose.position_mm, abs=1e-4)
    for row, wanted in zip(
        hp6.rotation(*again.rotation_deg), hp6.rotation(*pose.rotation_deg), strict=True
    ):
        assert row == pytest.approx(wanted, abs=1e-6)


@given(st.floats(-2e3, 2e3), st.floats(-2e3, 2e3), st.floats(-2e3, 2e3), st.floats(-180, 180))
def test_every_pose_has_finite_pulses(x, y, z, turn):
    pulses = hp6.pulses(Pose(x, y, z, turn, 0.0, 0.0))
    assert len(pulses) == 6
    assert all(abs(pulse) <= 180 * 1341 + 1 for pulse in pulses)


@given(st.floats(-1e4, 1e4))
def test_shown_angle_is_the_same_direction_within_180(angle):
    shown = hp6.normal_deg(angle)
    assert -180.0 < shown <= 180.0
    assert math.cos(math.radians(shown)) == pytest.approx(math.cos(math.radians(angle)), abs=1e-8)
