"""The field of operation: every increment ends inside, on the ray, as far as the margin allows."""

import math

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from gestureapp.robot import workspace
from gestureapp.robot.nx100 import move_increment
from gestureapp.robot.obstacles import sphere_crossings
from gestureapp.robot.values import Direction, Pose, Position, Posture, Refusal
from gestureapp.robot.workspace import (
    EDGE_DEG,
    EDGE_MM,
    MIN_LENGTH_DEG,
    MIN_LENGTH_MM,
    FieldOfOperation,
    Plan,
    nearest_turn,
)

RANGES = ((120.0, 240.0), (-60.0, 60.0), (-90.0, 90.0))
FIELD = FieldOfOperation(1200.0, 500.0, 20.0, RANGES, 2.0)
WIRE_MM, WIRE_DEG = 0.001, 0.01
TINY = 1e-6


def pose(x=0.0, y=0.0, z=0.0, rx=180.0, ry=0.0, rz=0.0):
    return Pose(x, y, z, rx, ry, rz)


def plan(start, direction, field):
    return workspace.plan(Position(start, Posture(1), 0), direction, field)


def find_outside(start, field):
    return workspace.find_outside(Position(start, Posture(1), 0), field)


def along(axis, sign):
    return Direction(axis, sign, is_rotation=False)


def about(axis, sign):
    return Direction(axis, sign, is_rotation=True)


AXES = st.sampled_from([0, 1, 2])
SIGNS = st.sampled_from([-1, 1])
LENGTHS = st.builds(along, AXES, SIGNS)
TURNS = st.builds(about, AXES, SIGNS)


@st.composite
def fields(draw):
    ext_mm = draw(st.floats(50, 3000))
    return FieldOfOperation(
        ext_mm,
        draw(st.floats(0, 0.99)) * ext_mm,
        draw(st.floats(0.001, 100)),
        RANGES,
        draw(st.floats(0.01, 20)),
    )


COORDINATES = st.floats(-1500, 1500).map(lambda mm: round(mm, 3))
POINTS = st.builds(pose, COORDINATES, COORDINATES, COORDINATES)


def march(start, unit, field, step_mm=0.25):
    """Walk along the ray until the next step would leave the field: an independent reach."""
    walked, hops = 0.0, [256.0, 64.0, 16.0, 4.0, 1.0, step_mm]
    assert is_inside(start, field)
    hop = step_mm
    while True:
        walked += hop
        at = [s + u * walked for s, u in zip(start, unit, strict=True)]
        if not is_inside(at, field):
            walked -= hop
            break
    for hop in [step_mm / 2**k for k in range(1, len(hops) + 10)]:
        at = [s + u * (walked + hop) for s, u in zip(start, unit, strict=True)]
        if is_inside(at, field):
            walked += hop
    return walked


def is_inside(point, field):
    return field.int_radius_mm < math.hypot(*point) < field.ext_radius_mm


@given(POINTS, LENGTHS, fields())
def test_an_increment_ends_inside_on_the_ray_as_far_as_the_margin_allows(start, direction, field):
    planned = plan(start, direction, field)
    assume(isinstance(planned, Plan))

    unit = direction.unit
    moved = planned.increment.translation_mm
    assert planned.increment.rotation_deg == (0.0, 0.0, 0.0)
    assert planned.length >= MIN_LENGTH_MM
    assert moved == tuple(u * planned.length + 0.0 for u in unit)
    assert is_inside(planned.end.position_mm, field)
    # The margin lies ahead of the end, all of it inside; what the wire cannot say is the rest.
    reach = planned.length + field.margin_mm
    assert has_room(start, unit, reach - TINY, field, -TINY)
    assert not has_room(start, unit, reach + WIRE_MM + TINY, field, TINY)


def has_room(start, unit, mm, field, slack_mm):
    """Whether a whole piece of the ray lies inside, by its nearest and farthest points."""
    towards = -sum(s * u for s, u in zip(start.position_mm, unit, strict=True))
    nearest = math.hypot(*point_at(start, unit, min(mm, max(0.0, towards))))
    farthest = math.hypot(*point_at(start, unit, mm))
    return nearest > field.int_radius_mm + slack_mm and farthest < field.ext_radius_mm - slack_mm


def point_at(start, unit, mm):
    return [s + u * mm for s, u in zip(start.position_mm, unit, strict=True)]


@given(POINTS, LENGTHS, fields())
def test_every_start_in_the_field_gives_a_plan_unless_there_is_no_room(start, direction, field):
    distance = math.hypot(*start.position_mm)

    planned = plan(start, direction, field)

    if distance >= field.ext_radius_mm + EDGE_MM or distance <= field.int_radius_mm - EDGE_MM:
        assert planned.reason == "outside_field"
    elif distance > field.ext_radius_mm - EDGE_MM or distance < field.int_radius_mm + EDGE_MM:
        assert planned.reason == "on_edge"
    elif isinstance(planned, Refusal):
        assert planned.reason == "at_limit"
        shortest = MIN_LENGTH_MM + field.margin_mm + WIRE_MM + TINY
        assert not has_room(start, direction.unit, shortest, field, TINY)


@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("sign", [-1, 1])
@pytest.mark.parametrize(
    "start",
    [(800, 0, 300), (0, -700, 0), (-600, 550, 400), (30, 501, 40), (1150, 5, 5), (0, 0, 1190)],
)
def test_a_march_along_the_ray_finds_the_same_end(start, axis, sign):
    unit = along(axis, sign).unit
    reach = march(start, unit, FIELD)

    planned = plan(pose(*start), along(axis, sign), FIELD)

    if reach - FIELD.margin_mm < MIN_LENGTH_MM:
        assert planned.reason == "at_limit"
    else:
        assert 0 <= reach - FIELD.margin_mm - planned.length + 1e-3 <= WIRE_MM + 2e-3


def test_the_inner_sphere_ends_a_move_towards_it_and_a_miss_goes_on_to_the_outer_one():
    hit = plan(pose(800, 0, 0), along(0, -1), FIELD)
    assert (hit.length, hit.limited_by) == (280.0, "inner sphere")
    assert hit.increment.translation_mm == (-280.0, 0.0, 0.0)

    miss = plan(pose(800, 0, 500.001), along(0, -1), FIELD)
    across = 800 + math.sqrt(1200**2 - 500.001**2) - 20
    assert miss.length == pytest.approx(across, abs=0.001)
    assert miss.limited_by == "outer sphere"

    away = plan(pose(800, 0, 0), along(0, 1), FIELD)
    assert (away.length, away.limited_by) == (380.0, "outer sphere")
    assert away.end.position_mm == (1180.0, 0.0, 0.0)


def test_a_line_that_only_touches_the_inner_sphere_ends_there():
    touching = plan(pose(800, 0, 500), along(0, -1), FIELD)

    assert (touching.length, touching.limited_by) == (780.0, "inner sphere")


def test_a_field_without_an_inner_sphere_has_its_middle_as_the_only_obstacle():
    field = FieldOfOperation(1000.0, 0.0, 10.0, RANGES, 2.0)

    assert plan(pose(500, 0, 1), along(0, -1), field).limited_by == "outer sphere"
    assert plan(pose(500, 0, 0), along(0, -1), field).limited_by == "inner sphere"


@pytest.mark.parametrize(
    ("distance", "reason"),
    [
        (1200.001, "outside_field"),
        (1200.0005, "on_edge"),
        (1200.0, "on_edge"),
        (1199.9995, "on_edge"),
        (1199.998, None),
        (500.002, None),
        (500.0005, "on_edge"),
        (500.0, "on_edge"),
        (499.9995, "on_edge"),
        (499.999, "outside_field"),
        (0.0, "outside_field"),
    ],
)
def test_no_increment_starts_outside_or_on_the_edge(distance, reason):
    turned = plan(pose(0, distance, 0), about(2, 1), FIELD)
    assert getattr(turned, "reason", None) == reason
    moved = plan(pose(0, distance, 0), along(1, -1 if distance > 600 else 1), FIELD)
    assert getattr(moved, "reason", None) == reason
    found = find_outside(pose(0, distance, 0), FIELD)
    assert getattr(found, "reason", None) == reason
    if found is not None:
        assert f"{distance:.1f} mm" in found.text
        assert found.limit == "500 to 1200 mm from the robot's origin"


@pytest.mark.parametrize(("x", "length"), [(1179.0, 1.0), (1179.001, None), (1185.0, None)])
def test_less_than_the_shortest_length_is_no_room(x, length):
    planned = plan(pose(x, 0, 0), along(0, 1), FIELD)

    assert getattr(planned, "length", None) == length
    if length is None:
        assert planned.reason == "at_limit"
        assert planned.text.startswith("no room along X+")


def test_the_refusal_names_the_direction_and_what_is_met():
    refusal = plan(pose(510, 0, 0), along(0, -1), FIELD)

    assert refusal.text == "no room along X-: 10.0 mm to the inner sphere, 20.0 mm margin"


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("part", range(6))
def test_a_position_that_is_no_number_gives_no_increment(bad, part):
    parts = [800.0, 0.0, 0.0, 180.0, 0.0, 0.0]
    parts[part] = bad

    assert plan(Pose(*parts), along(0, 1), FIELD).reason == "bad_pose"


# Rotations.


@pytest.mark.parametrize(
    ("axis", "sign", "angle", "length"),
    [
        (0, 1, 180.0, 58.0),
        (0, 1, -180.0, 58.0),
        (0, -1, 180.0, 58.0),
        (0, -1, -180.0, 58.0),
        (0, 1, -130.0, 8.0),  # 230 in the range 120 to 240
        (0, -1, -130.0, 108.0),
        (0, 1, 125.0, 113.0),
        (1, 1, 59.0, None),
        (1, 1, 57.5, 0.5),
        (1, 1, 57.51, None),
        (1, -1, -60.0, None),
        (1, 1, -60.0, 118.0),
        (2, -1, 270.0, None),  # -90, the low end
        (2, 1, 270.0, 178.0),
    ],
)
def test_a_turn_goes_to_the_end_of_its_range_less_the_margin(axis, sign, angle, length):
    angles = [180.0, 0.0, 0.0]
    angles[axis] = angle

    planned = plan(pose(800, 0, 0, *angles), about(axis, sign), FIELD)

    if length is None:
        assert planned.reason == "at_limit"
        assert "no room to turn" in planned.text
    else:
        expected = [0.0, 0.0, 0.0]
        expected[axis] = sign * length
        assert planned.increment.rotation_deg == pytest.approx(tuple(expected), abs=WIRE_DEG)
        assert planned.increment.translation_mm == (0.0, 0.0, 0.0)
        assert planned.length == pytest.approx(length, abs=WIRE_DEG)
        assert planned.limited_by == f"range of {('Rx', 'Ry', 'Rz')[axis]}"


@pytest.mark.parametrize("angle", [60.02, -60.02, 180.0, -119.0])
def test_an_angle_outside_its_range_is_refused_both_ways(angle):
    for sign in (-1, 1):
        refusal = plan(pose(800, 0, 0, 180.0, angle, 0.0), about(1, sign), FIELD)
        assert refusal.reason == "outside_field"
        assert refusal.text.startswith("Ry ")


@pytest.mark.parametrize(("angle", "sign"), [(60.009, 1), (-60.009, -1), (60.0, 1), (-60.0, -1)])
def test_an_angle_on_the_end_of_its_range_turns_only_back(angle, sign):
    start = pose(800, 0, 0, 180.0, angle, 0.0)

    assert plan(start, about(1, sign), FIELD).reason == "at_limit"
    back = plan(start, about(1, -sign), FIELD)
    assert back.length == pytest.approx(60 + abs(angle) - 2.0, abs=WIRE_DEG)


@given(st.floats(-720, 720).map(lambda deg: round(deg, 2)), TURNS, fields(), st.data())
def test_a_turn_ends_in_its_range_and_as_far_as_the_margin_allows(angle, direction, field, data):
    low = data.draw(st.floats(-300, 300))
    width = data.draw(st.floats(1, 359))
    ranges = list(RANGES)
    ranges[direction.axis] = (low, low + width)
    radius = (field.int_radius_mm + field.ext_radius_mm) / 2
    field = FieldOfOperation(
        field.ext_radius_mm, field.int_radius_mm, field.margin_mm, tuple(ranges), field.margin_deg
    )
    angles = [180.0, 0.0, 0.0]
    angles[direction.axis] = angle
    planned = plan(pose(radius, 0, 0, *angles), direction, field)
    assume(isinstance(planned, Plan))

    turned = planned.increment.rotation_deg[direction.axis]
    here = angle + 360.0 * round((low + width / 2 - angle) / 360.0)
    assert turned * direction.sign == planned.length >= MIN_LENGTH_DEG
    end = here + turned
    limit = low + width if direction.sign > 0 else low
    room = (limit - end) * direction.sign
    assert field.margin_deg - TINY <= room <= field.margin_deg + WIRE_DEG + TINY
    assert low - EDGE_DEG <= here <= low + width + EDGE_DEG
    assert low < end < low + width


@given(st.floats(-1000, 1000), st.floats(-300, 300), st.floats(1, 359))
def test_the_nearest_turn_is_the_same_angle_and_nearest_to_the_middle(angle, low, width):
    middle = low + width / 2

    turn = nearest_turn(angle, (low, low + width))

    assert abs(turn - middle) <= 180 + TINY
    assert abs(math.remainder(turn - angle, 360.0)) < TINY


@given(POINTS, LENGTHS | TURNS, fields(), st.floats(-200, 200))
def test_what_goes_over_the_wire_never_exceeds_the_plan(start, direction, field, turn):
    start = Pose(*start.position_mm, 180.0, math.fmod(turn, 60), math.fmod(turn, 90))
    planned = plan(start, direction, field)
    assume(isinstance(planned, Plan))

    fields_ = move_increment(planned.increment, 10.0, 1, 0).data.split(",")

    sent = [float(text) for text in fields_[3:9]]
    wanted = (*planned.increment.translation_mm, *planned.increment.rotation_deg)
    assert all(abs(s) <= abs(w) + 1e-9 for s, w in zip(sent, wanted, strict=True))
    assert sent == pytest.approx(list(wanted), abs=1e-9)


# Geometry and settings.


def test_a_line_crosses_a_sphere_twice_once_or_never():
    assert sphere_crossings((-5, 0, 0), (1, 0, 0), 3) == (2, 8)
    assert sphere_crossings((0, 3, 0), (1, 0, 0), 3) == (0, 0)
    assert sphere_crossings((0, 3.001, 0), (1, 0, 0), 3) is None


@pytest.mark.parametrize(
    "change",
    [
        {"ext_radius_mm": 500.0},
        {"ext_radius_mm": math.inf},
        {"ext_radius_mm": math.nan},
        {"int_radius_mm": -0.001},
        {"int_radius_mm": 1200.0},
        {"int_radius_mm": math.nan},
        {"margin_mm": 0.0},
        {"margin_mm": math.inf},
        {"margin_deg": 0.0},
        {"margin_deg": math.nan},
        {"ranges_deg": (RANGES[0], (10.0, 10.0), RANGES[2])},
        {"ranges_deg": (RANGES[0], (10.0, 370.0), RANGES[2])},
        {"ranges_deg": (RANGES[0], RANGES[1], (20.0, 10.0))},
        {"ranges_deg": (RANGES[0], RANGES[1], (math.nan, 10.0))},
    ],
)
def test_a_field_that_is_not_in_order_is_refused(change):
    fields_ = {
        "ext_radius_mm": 1200.0,
        "int_radius_mm": 500.0,
        "margin_mm": 20.0,
        "ranges_deg": RANGES,
        "margin_deg": 2.0,
    }
    FieldOfOperation(**fields_)

    with pytest.raises(ValueError, match=r"sphere|margins|range"):
        FieldOfOperation(**{**fields_, **change})


@pytest.mark.parametrize(("axis", "sign"), [(3, 1), (-1, 1), (0, 0), (0, 2)])
def test_there_are_three_axes_and_two_signs(axis, sign):
    with pytest.raises(ValueError, match="no such direction"):
        Direction(axis, sign, is_rotation=False)
