"""The whole field: an increment ends inside all that bounds it, and as far as it may."""

import math
from dataclasses import replace

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from gestureapp.cell.limits import field_of
from gestureapp.config import Settings
from gestureapp.robot.arm import find_arm_limit
from gestureapp.robot.obstacles import Column, KeepOut
from gestureapp.robot.values import Direction, Pose, Position, Posture, Refusal
from gestureapp.robot.workspace import (
    EDGE_MM,
    MIN_LENGTH_MM,
    FieldOfOperation,
    Plan,
    find_outside,
    plan,
)

FIXTURE = KeepOut("fixture", (900.0, -200.0, -300.0), (1200.0, 200.0, 400.0))
FIELD = replace(field_of(Settings()), keep_outs=(FIXTURE,))
BARE = replace(FIELD, arm=None)
HOME = Position(Pose(800.0, 0.0, 300.0, 180.0, 0.0, 0.0), Posture(1), 0)
TINY = 1e-6


def at(x, y, z, rx=180.0, ry=0.0, rz=0.0):
    return Position(Pose(x, y, z, rx, ry, rz), Posture(1), 0)


def along(axis, sign):
    return Direction(axis, sign, is_rotation=False)


COORDINATES = st.floats(-1300, 1300).map(lambda mm: round(mm, 3))
STARTS = st.builds(at, COORDINATES, COORDINATES, COORDINATES)
# Where the arm works with the tool down, and is seldom refused.
WORKING = st.builds(
    at,
    st.floats(350, 1000),
    st.floats(-600, 600),
    st.floats(-250, 600),
    st.floats(150, 210),
    st.floats(-25, 25),
    st.floats(-60, 60),
)
LENGTHS = st.builds(along, st.sampled_from([0, 1, 2]), st.sampled_from([-1, 1]))
TURNS = st.builds(Direction, st.sampled_from([0, 1, 2]), st.sampled_from([-1, 1]), st.just(True))


@st.composite
def boxes(draw):
    low = [draw(st.floats(-1300, 1200)) for _ in range(3)]
    return KeepOut("box", tuple(low), tuple(v + draw(st.floats(1, 700)) for v in low))


@st.composite
def fields(draw):
    floor = draw(st.floats(-1200, 200) | st.just(-math.inf))
    return replace(
        draw(st.sampled_from([FIELD, BARE])),
        margin_mm=draw(st.floats(0.01, 100)),
        floor_mm=floor,
        ceiling_mm=draw(st.floats(max(floor, -1000) + 1, 1300) | st.just(math.inf)),
        column=draw(st.none() | st.builds(Column, st.floats(1, 600), st.floats(-500, 1200))),
        keep_outs=tuple(draw(st.lists(boxes(), max_size=4))),
    )


def is_inside(point, field, slack_mm):
    distance = math.hypot(*point)
    return (
        field.int_radius_mm + slack_mm < distance < field.ext_radius_mm - slack_mm
        and field.floor_mm + slack_mm < point[2] < field.ceiling_mm - slack_mm
        and not any(body.holds(point, slack_mm) for body in field.obstacles)
    )


def on_ray(start, direction, mm):
    return tuple(p + u * mm for p, u in zip(start.pose.position_mm, direction.unit, strict=True))


@settings(max_examples=300)
@given(STARTS | WORKING, LENGTHS, fields())
def test_an_increment_ends_inside_everything_on_the_ray_with_its_margin(start, direction, field):
    planned = plan(start, direction, field)
    assume(isinstance(planned, Plan))

    assert planned.length >= MIN_LENGTH_MM
    assert planned.increment.translation_mm == tuple(
        u * planned.length + 0.0 for u in direction.unit
    )
    assert planned.increment.rotation_deg == (0.0, 0.0, 0.0)
    reach = planned.length + field.margin_mm - 0.001
    for i in range(401):
        assert is_inside(on_ray(start, direction, reach * i / 400), field, -0.0005)
    assert planned.end.position_mm == on_ray(start, direction, planned.length)
    if field.arm is not None:
        assert find_arm_limit(Position(planned.end, Posture(1), 0), field.arm) is None or (
            planned.limited_by
        )


@settings(max_examples=300)
@given(STARTS | WORKING, LENGTHS, fields())
def test_a_longer_increment_would_break_the_margin(start, direction, field):
    bare = replace(field, arm=None)
    planned = plan(start, direction, bare)
    assume(isinstance(planned, Plan))

    # One step of the wire farther, with its margin, comes into something.
    beyond = planned.length + field.margin_mm + 0.002
    assert not is_inside(on_ray(start, direction, beyond), bare, 0.0) or any(
        not is_inside(on_ray(start, direction, beyond - mm), bare, 0.001)
        for mm in (0.001, 0.002, 0.003)
    )
    with_arm = plan(start, direction, replace(field, arm=FIELD.arm))
    if isinstance(with_arm, Plan):
        assert with_arm.length <= planned.length
        assert (with_arm.length == planned.length) == (with_arm.limited_by == planned.limited_by)


@given(STARTS, LENGTHS | TURNS, fields())
def test_a_start_that_is_not_inside_is_refused_for_every_direction(start, direction, field):
    here = start.pose.position_mm
    refusal = find_outside(start, replace(field, arm=None))

    if is_inside(here, field, EDGE_MM + TINY):
        assert refusal is None
    elif not is_inside(here, field, EDGE_MM - TINY):
        assert refusal is not None
    if refusal is not None:
        assert refusal.reason in ("outside_field", "on_edge")
        assert plan(start, direction, field) == refusal


def test_a_place_a_hair_below_zero_reads_as_zero():
    refusal = find_outside(at(800, 0, -0.0), replace(BARE, floor_mm=-0.0))

    assert refusal.text == "the tool stands on the floor at z 0.0 mm, at z 0.0 mm"


@settings(max_examples=200)
@given(WORKING, TURNS)
def test_a_turn_ends_in_its_range_and_within_the_arm(start, direction):
    planned = plan(start, direction, FIELD)
    assume(isinstance(planned, Plan))

    low, high = FIELD.ranges_deg[direction.axis]
    end = planned.end.rotation_deg[direction.axis]
    assert low + FIELD.margin_deg - TINY <= end <= high - FIELD.margin_deg + TINY
    assert planned.end.position_mm == start.pose.position_mm
    if not planned.limited_by.startswith("range"):
        assert min(end - low, high - end) > FIELD.margin_deg


@pytest.mark.parametrize(
    ("start", "direction", "length", "limited_by"),
    [
        (at(600, 300, 0), along(2, -1), 280.0, "floor"),
        (at(500, 0, 700), along(2, 1), 280.0, "ceiling"),
        (at(950, 300, 0), along(1, -1), 80.0, "keep-out 'fixture'"),
        (at(600, 0, 0), along(0, 1), 280.0, "keep-out 'fixture'"),
        (at(1000, 0, 600), along(2, -1), 180.0, "keep-out 'fixture'"),
        (at(600, 0, 500), along(0, -1), 230.0, "column"),
        (at(300, 0, 900), along(2, -1), 80.0, "column"),
        (at(900, 100, 450), along(0, -1), 900 - math.sqrt(350**2 - 100**2) - 20, "column"),
    ],
)
def test_what_is_met_first_ends_the_increment(start, direction, length, limited_by):
    planned = plan(start, direction, BARE)

    assert planned.limited_by == limited_by
    assert planned.length == pytest.approx(length, abs=0.001)


@pytest.mark.parametrize(
    ("start", "reason", "text"),
    [
        (at(600, 300, -301), "outside_field", "the tool stands below the floor at z -300.0 mm"),
        (at(600, 300, -300), "on_edge", "the tool stands on the floor at z -300.0 mm"),
        (at(600, 0, 1001), "outside_field", "the tool stands above the ceiling at z 1000.0 mm"),
        (at(1000, 0, 0), "outside_field", "the tool stands inside the keep-out 'fixture'"),
        (at(900, 0, 0), "on_edge", "the tool stands on the edge of the keep-out 'fixture'"),
        (at(340, 0, 600), "outside_field", "the tool stands inside the column"),
        (at(350, 0, 600), "on_edge", "the tool stands on the edge of the column"),
    ],
)
def test_a_start_outside_is_refused_with_what_stands_there(start, reason, text):
    refusal = find_outside(start, BARE)

    assert refusal.reason == reason
    assert refusal.text.startswith(text)
    assert plan(start, along(0, 1), BARE) == refusal


def test_the_arm_ends_an_increment_before_the_field_does_and_says_so():
    down = plan(HOME, Direction(1, -1, is_rotation=True), FIELD)

    assert down.limited_by == "wrist limit (nearly straight)"
    assert 40 < down.length < 58
    bent = replace(FIELD, arm=replace(FIELD.arm, wrist_margin_deg=60.9))
    refusal = plan(HOME, Direction(1, -1, is_rotation=True), bent)
    assert refusal.reason == "at_limit"
    assert refusal.text == "no room for RY-: wrist limit (nearly straight)"


def test_an_arm_beyond_its_limits_is_refused_whatever_the_direction():
    straight = replace(FIELD, arm=replace(FIELD.arm, wrist_margin_deg=70.0))
    for direction in (along(0, 1), Direction(1, 1, is_rotation=True)):
        refusal = plan(HOME, direction, straight)
        assert isinstance(refusal, Refusal)
        assert refusal.reason == "arm_limit"


def test_the_tools_offset_moves_the_arms_limit_and_not_the_fields():
    long = replace(FIELD, keep_outs=(), arm=replace(FIELD.arm, tool_mm=(0.0, 0.0, 400.0)))
    short = plan(HOME, along(2, 1), replace(FIELD, keep_outs=()))
    ended = plan(HOME, along(2, 1), long)

    assert short.limited_by == "outer sphere"
    assert ended.limited_by == "axis B limit"
    assert ended.length < short.length


def test_home_leaves_useful_room_for_every_gesture():
    field = field_of(Settings())
    for axis in range(3):
        for sign in (-1, 1):
            assert plan(HOME, along(axis, sign), field).length > 300
            assert plan(HOME, Direction(axis, sign, is_rotation=True), field).length > 40


@pytest.mark.parametrize(
    "change",
    [
        {"floor_mm": 1000.0},
        {"floor_mm": math.nan},
        {"ceiling_mm": -301.0},
        {"keep_outs": (FIXTURE,) * 9},
    ],
)
def test_bounds_that_are_not_in_order_are_refused(change):
    with pytest.raises(ValueError, match=r"floor|keep-outs"):
        replace(FIELD, **change)


def test_eight_boxes_are_allowed():
    assert isinstance(replace(FIELD, keep_outs=(FIXTURE,) * 8), FieldOfOperation)
