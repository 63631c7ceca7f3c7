"""How far the arm follows: its own march in small steps, from the joints, never finds more room."""

import math
from dataclasses import replace

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from gestureapp.robot import hp6
from gestureapp.robot.arm import FINE_DEG, FINE_MM, STANDING, ArmLimits, find_arm_limit, reach_along
from gestureapp.robot.values import Direction, Pose, Position, Posture

RANGES = (
    (-170.0, 170.0),
    (-90.0, 155.0),
    (-80.0, 80.0),
    (-180.0, 180.0),
    (-135.0, 135.0),
    (-360.0, 360.0),
)
LIMITS = ArmLimits((0.0, 0.0, 0.0), RANGES, 10.0, 10.0, 15.0, 100.0)
WIDE = replace(LIMITS, ranges_deg=((-180.0, 180.0), *RANGES[1:2], (-180.0, 180.0), *RANGES[3:]))
HOME = Position(Pose(800.0, 0.0, 300.0, 180.0, 0.0, 0.0), Posture(1), 0)
WAYS = [
    Direction(axis, sign, is_rotation)
    for axis in range(3)
    for sign in (-1, 1)
    for is_rotation in (False, True)
]
DIP = 0.2
"""Between two steps a singular place may be nearer than its margin by this much, deg or mm."""


def held(joints, tool_mm=(0.0, 0.0, 0.0)):
    return Position(hp6.tool_pose(joints, tool_mm), hp6.posture_of(joints), 0)


def at(position, direction, ahead):
    pose, unit = position.pose, direction.unit
    change = [u * ahead for u in unit]
    if direction.is_rotation:
        turned = [a + c for a, c in zip(pose.rotation_deg, change, strict=True)]
        return Pose(*pose.position_mm, *turned)
    moved = [a + c for a, c in zip(pose.position_mm, change, strict=True)]
    return Pose(*moved, *pose.rotation_deg)


def room(joints, pose, limits):
    """How far the nearest limit is, in the words of the settings; below zero beyond it."""
    s, lower, upper, r, b, t = joints
    ranges = zip((s, lower, upper, r, b, t), limits.ranges_deg, strict=True)
    joint = min(min(q - low, high - q) for q, (low, high) in ranges) - limits.joint_margin_deg
    shoulder = math.hypot(*hp6.wrist_mm(pose, limits.tool_mm)[:2]) - limits.shoulder_margin_mm
    straight = abs(upper - hp6.STRETCHED_DEG)
    elbow = min(straight, abs(360 - straight), abs(180 - straight)) - limits.elbow_margin_deg
    return min(joint, abs(b) - limits.wrist_margin_deg, elbow, shoulder)


def followed(pose, before, limits):
    """The one of the eight solutions nearest to the joints before: an independent choice."""
    solutions = [hp6.joints_deg(pose, limits.tool_mm, Posture(bits)) for bits in range(8)]
    unwound = [
        tuple(q + 360 * round((p - q) / 360) for q, p in zip(joints, before, strict=True))
        for joints in solutions
    ]
    return min(unwound, key=lambda joints: math.dist(joints, before))


STARTS = st.tuples(
    st.floats(-150, 150),
    st.floats(-70, 130),
    st.floats(-65, 60),
    st.floats(-160, 160),
    st.floats(15, 120).flatmap(lambda b: st.sampled_from([b, -b])),
    st.floats(-340, 340),
)
TOOLS = st.tuples(st.floats(-100, 100), st.floats(-100, 100), st.floats(-50, 300))


@settings(max_examples=150)
@given(STARTS, TOOLS, st.sampled_from(WAYS), st.sampled_from([LIMITS, WIDE]))
def test_all_the_way_the_arm_keeps_its_margins_and_its_branch(joints, tool_mm, direction, limits):
    limits = replace(limits, tool_mm=tool_mm)
    start = held(joints, tool_mm)
    assume(abs(abs(hp6.normal_deg(joints[3])) - 90) > 0.1)  # flip or not is told in one bit
    assume(find_arm_limit(start, limits) is None)
    length, step = (90.0, 0.5) if direction.is_rotation else (900.0, 4.0)

    reach = reach_along(start, direction, length, limits)

    assert 0 <= reach.length <= length
    least = min(0.0, room(joints, start.pose, limits))
    for i in range(math.ceil(reach.length / step) + 1):
        pose = at(start, direction, min(i * step, reach.length))
        before, joints = joints, followed(pose, joints, limits)
        assert room(joints, pose, limits) >= least - DIP
        assert max(abs(a - b) for a, b in zip(joints, before, strict=True)) < 90
        assert hp6.tool_pose(joints, tool_mm).position_mm == pytest.approx(
            pose.position_mm, abs=1e-3
        )
    assert room(joints, pose, limits) >= least - 1e-3  # at the end there is no dip


@settings(max_examples=150)
@given(STARTS, TOOLS, st.sampled_from(WAYS))
def test_a_little_farther_the_arm_would_be_beyond_a_limit(joints, tool_mm, direction):
    limits = replace(LIMITS, tool_mm=tool_mm)
    start = held(joints, tool_mm)
    assume(abs(abs(hp6.normal_deg(joints[3])) - 90) > 0.1)
    assume(room(joints, start.pose, limits) > 0)
    length, fine = (90.0, FINE_DEG) if direction.is_rotation else (900.0, FINE_MM)

    reach = reach_along(start, direction, length, limits)
    assume(reach.length < length)

    assert reach.limited_by
    steps = max(1, math.ceil(reach.length / (0.5 if direction.is_rotation else 5)))
    for i in range(1, steps + 1):
        joints = followed(at(start, direction, reach.length * i / steps), joints, limits)
    beyond = at(start, direction, reach.length + fine)
    after = followed(beyond, joints, limits)
    is_out = hp6.tool_pose(after, tool_mm).position_mm != pytest.approx(
        beyond.position_mm, abs=1e-3
    )
    assert room(after, beyond, limits) < 1e-3 or is_out


@pytest.mark.parametrize(
    ("joints", "direction", "limited_by"),
    [
        ((0, 1.5, -27.5, 0, -61, 0), Direction(0, 1, False), "elbow nearly stretched"),
        ((0, 1.5, -27.5, 0, -61, 0), Direction(1, -1, True), "wrist limit (nearly straight)"),
        ((150, -60, 20, 0, -40, 300), Direction(2, 1, True), "axis S limit"),
        ((0, -20, -60, 140, 110, 0), Direction(2, -1, False), "axis L limit"),
        ((140, 0, -60, 140, 60, 0), Direction(1, -1, False), "axis U limit"),
        ((0, 120, 40, 155, -100, 300), Direction(1, 1, False), "axis R limit"),
        ((0, 20, -27.5, 140, -100, 300), Direction(2, 1, True), "axis B limit"),
        ((0, 1.5, -27.5, 0, -61, 340), Direction(2, -1, True), "axis T limit"),
        ((0, -20, 0, 0, 110, 0), Direction(0, -1, False), "shoulder limit (wrist over the base)"),
    ],
)
def test_every_limit_has_its_name(joints, direction, limited_by):
    reach = reach_along(held(joints), direction, 1500.0, LIMITS)

    assert reach.limited_by == limited_by


def test_an_elbow_that_folds_up_is_told():
    folding = replace(WIDE, elbow_margin_deg=45.0)
    reach = reach_along(held((0, 20, -50, 0, -60, 0)), Direction(0, -1, False), 900.0, folding)
    assert reach.limited_by == "elbow nearly folded"


def test_the_posture_that_the_robot_tells_decides():
    pose = hp6.tool_pose((0, 1.5, -27.5, 0, -61, 0))
    usual, flipped = Position(pose, Posture(1), 0), Position(pose, Posture(0), 0)

    assert find_arm_limit(usual, LIMITS) is None
    refusal = find_arm_limit(flipped, LIMITS)  # R is 180 there
    assert (refusal.reason, refusal.limit) == ("arm_limit", "axis R limit")
    assert refusal.text == (
        "the arm stands beyond a limit of its own, 10.0 deg too far: axis R limit"
    )
    low = find_arm_limit(Position(pose, Posture(3), 0), LIMITS)
    assert low.limit == "axis U limit"


@pytest.mark.parametrize(("turn", "plus", "minus"), [(100, 300, 250), (-260, 90, 300)])
def test_t_a_whole_turn_away_has_other_room(turn, plus, minus):
    start = held((0, 1.5, -27.5, 0, -61, turn))
    for sign, length in ((1, plus), (-1, minus)):
        reach = reach_along(start, Direction(2, sign, True), 300.0, LIMITS)
        assert reach.length == pytest.approx(length, abs=FINE_DEG)


@pytest.mark.parametrize("direction", WAYS, ids=str)
def test_a_robot_at_the_end_of_a_move_may_go_back(direction):
    joints = hp6.joints_deg(HOME.pose)
    length = 300.0 if direction.is_rotation else 1500.0
    reach = reach_along(HOME, direction, length, LIMITS)
    for i in range(1, 101):
        joints = followed(at(HOME, direction, reach.length * i / 100), joints, LIMITS)
    end = at(HOME, direction, reach.length)
    # As the controller tells it: three decimals of mm, two of degrees.
    end = Pose(*(round(v, 3) for v in end.position_mm), *(round(v, 2) for v in end.rotation_deg))
    stands = Position(end, hp6.posture_of(joints), 0)

    assert find_arm_limit(stands, LIMITS) is None
    back = Direction(direction.axis, -direction.sign, direction.is_rotation)
    assert reach_along(stands, back, reach.length, LIMITS).length == reach.length
    assert not reach.limited_by or reach_along(stands, direction, length, LIMITS).length < 1


@pytest.mark.parametrize(("bend", "is_refused"), [(9.4, True), (9.6, False)])
def test_a_start_a_little_beyond_a_margin_is_that_of_a_standing_robot(bend, is_refused):
    start = held((0, 1.5, -27.5, 0, -bend, 0))

    assert (find_arm_limit(start, LIMITS) is not None) is is_refused
    assert LIMITS.wrist_margin_deg - STANDING == 9.5
    if not is_refused:
        assert reach_along(start, Direction(1, -1, True), 20.0, LIMITS).length < 0.1
        assert reach_along(start, Direction(1, 1, True), 20.0, LIMITS).length == 20.0


@pytest.mark.parametrize(
    "change",
    [
        {"wrist_margin_deg": STANDING},
        {"elbow_margin_deg": 0.0},
        {"shoulder_margin_mm": math.nan},
        {"joint_margin_deg": -0.1},
        {"joint_margin_deg": math.inf},
        {"joint_margin_deg": 80.0},
        {"ranges_deg": (*RANGES[:5], (10.0, -10.0))},
        {"tool_mm": (0.0, math.nan, 0.0)},
    ],
)
def test_limits_that_are_not_in_order_are_refused(change):
    with pytest.raises(ValueError, match=r"margin|offset"):
        replace(LIMITS, **change)
