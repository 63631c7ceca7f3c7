"""The arm's geometry, against the published figures and against itself in all its postures."""

import math

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from gestureapp.robot import hp6
from gestureapp.robot.values import Pose, Posture

TOOL_MM = (10.0, -20.0, 120.0)


def test_home_is_where_the_link_lengths_put_it():
    home = hp6.tool_pose((0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    assert home.position_mm == pytest.approx((885.0, 0.0, 725.0))
    assert hp6.wrist_mm(home) == pytest.approx((790.0, 0.0, 725.0))


def test_reach_is_the_published_one():
    assert pytest.approx(1378.5, abs=0.05) == hp6.REACH_MM
    straight = (0.0, 90.0, hp6.STRETCHED_DEG, 0.0, 0.0, 0.0)
    assert math.hypot(*hp6.wrist_mm(hp6.tool_pose(straight))) == pytest.approx(hp6.REACH_MM)


def test_a_tool_that_points_down_in_front_is_held_by_a_wrist_bent_down():
    s, lower, upper, r, b, t = hp6.joints_deg(Pose(800.0, 0.0, 300.0, 180.0, 0.0, 0.0))

    assert (s, r, t) == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)
    assert b == pytest.approx(-90.0 - (upper - lower))  # from the forearm's slope to straight down


def turns(low, high):
    return st.floats(low, high)


JOINTS = st.tuples(
    turns(-170, 170),
    turns(-90, 155),
    turns(-100, 250),
    turns(-350, 350),
    turns(-135, 135),
    turns(-350, 350),
)


@given(JOINTS)
def test_the_joints_of_a_pose_in_its_posture_are_those_it_was_made_of(joints):
    s, lower, upper, r, b, t = joints
    wrist = hp6.wrist_mm(hp6.tool_pose(joints))
    assume(abs(b) > 1 and math.hypot(*wrist[:2]) > 5)
    assume(1 < abs(upper - hp6.STRETCHED_DEG) < 179)
    assume(all(abs(abs(hp6.normal_deg(angle)) - 90) > 0.1 for angle in (r,)))
    assume(all(abs(abs(angle) - 180) > 1e-3 for angle in (r, t)))

    pose = hp6.tool_pose(joints, TOOL_MM)
    again = hp6.joints_deg(pose, TOOL_MM, hp6.posture_of(joints))

    wanted = (s, hp6.normal_deg(lower), hp6.normal_deg(upper), r, b, t)
    assert again == pytest.approx(wanted, abs=1e-3)


@pytest.mark.parametrize("bits", range(8))
def test_every_posture_holds_the_same_pose_with_other_joints(bits):
    pose = Pose(520.0, 210.0, 350.0, 150.0, 20.0, 30.0)
    joints = hp6.joints_deg(pose, TOOL_MM, Posture(bits))

    assert hp6.posture_of(joints) == Posture(bits)
    again = hp6.tool_pose(joints, TOOL_MM)
    assert again.position_mm == pytest.approx(pose.position_mm, abs=1e-6)
    assert again.rotation_deg == pytest.approx(pose.rotation_deg, abs=1e-6)
    others = [hp6.joints_deg(pose, TOOL_MM, Posture(i)) for i in range(8) if i != bits]
    assert all(math.dist(joints, other) > 10 for other in others)


@pytest.mark.parametrize("bit", [3, 4, 5])
def test_a_joint_told_beyond_half_a_turn_is_a_turn_away(bit):
    pose, axis = Pose(520.0, 210.0, 350.0, 150.0, 20.0, 30.0), {3: 3, 4: 5, 5: 0}[bit]
    usual = hp6.joints_deg(pose)
    beyond = hp6.joints_deg(pose, posture=Posture(1 | 1 << bit))

    assert abs(beyond[axis] - usual[axis]) == pytest.approx(360)
    assert 180 <= abs(beyond[axis]) <= 360
    assert beyond[:axis] + beyond[axis + 1 :] == usual[:axis] + usual[axis + 1 :]
    assert hp6.posture_of(beyond) == Posture(1 | 1 << bit)


@pytest.mark.parametrize("bend_deg", [0.0, 180.0, -180.0])
@pytest.mark.parametrize("turn_deg", [-170.0, 0.0, 40.0])
def test_a_straight_wrist_turns_by_t_alone(bend_deg, turn_deg):
    pose = hp6.tool_pose((10.0, 5.0, -20.0, 0.0, bend_deg, turn_deg))

    joints = hp6.joints_deg(pose)

    assert joints[3] == pytest.approx(0, abs=1e-3)
    again = hp6.rotation(*hp6.tool_pose(joints).rotation_deg)
    for row, wanted in zip(again, hp6.rotation(*pose.rotation_deg), strict=True):
        assert row == pytest.approx(wanted, abs=1e-6)


@given(
    st.floats(-2e3, 2e3), st.floats(-2e3, 2e3), st.floats(-2e3, 2e3), turns(-180, 180),
    st.integers(0, 63),
)  # fmt: skip
def test_every_pose_has_finite_joints(x, y, z, turn, bits):
    joints = hp6.joints_deg(Pose(x, y, z, turn, 0.0, 0.0), posture=Posture(bits))
    assert all(abs(angle) <= 360.0 for angle in joints)


@given(turns(-1e4, 1e4))
def test_shown_angle_is_the_same_direction_within_180(angle):
    shown = hp6.normal_deg(angle)
    assert -180.0 < shown <= 180.0
    assert math.cos(math.radians(shown)) == pytest.approx(math.cos(math.radians(angle)), abs=1e-8)


@given(turns(-180, 180), turns(-89, 89), turns(-180, 180))
def test_angles_of_a_rotation_are_those_it_was_made_of(rx, ry, rz):
    again = hp6.rotation(*hp6.angles(hp6.rotation(rx, ry, rz)))
    for row, wanted in zip(again, hp6.rotation(rx, ry, rz), strict=True):
        assert row == pytest.approx(wanted, abs=1e-9)
