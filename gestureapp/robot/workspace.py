"""The field of operation: from a position and a direction to one increment, or a refusal. Pure.

The field is what lies between two spheres around the robot frame's origin (paper, equation 1),
above the floor, below the ceiling, and outside the column and the keep-outs. The increment runs
along the ray of equation 2 up to a margin short of the first boundary it meets (equations 3 and 4).
Rotations run to the end of the axis' range. Both end earlier where the arm can go no farther.
"""

import functools
import math
from collections.abc import Iterator
from dataclasses import dataclass

from gestureapp.robot.arm import ArmLimits, find_arm_limit, reach_along
from gestureapp.robot.obstacles import (
    Column,
    KeepOut,
    Vector,
    plane_distance,
    sphere_crossings,
)
from gestureapp.robot.values import Direction, Pose, PoseIncrement, Position, Refusal

EDGE_MM = 0.001
"""A start this close to a sphere stands on its edge: RPOSC gives three decimals."""
EDGE_DEG = 0.01
"""The same for angles: the NX100 gives two decimals."""
MIN_LENGTH_MM = 1.0
"""Shorter increments are refused: they would only twitch."""
MIN_LENGTH_DEG = 0.5
"""The same for rotations."""

MAX_KEEP_OUTS = 8

AXES = ("X", "Y", "Z")


@dataclass(frozen=True, slots=True)
class FieldOfOperation:
    """Where the tool may go.

    Attributes:
        ext_radius_mm: Outer sphere.
        int_radius_mm: Inner sphere.
        margin_mm: How far before a boundary, along the ray, an increment ends.
        ranges_deg: Lowest and highest rx, ry, rz. A range may pass 180, as Rx does for a tool that
            points down; angles are taken to the turn that lies nearest to the middle of the range.
        margin_deg: How far before the end of a range a rotation ends.
        floor_mm: Lowest z; minus infinity for none.
        ceiling_mm: Highest z; infinity for none.
        column: The robot's own body, or None.
        keep_outs: Up to eight boxes.
        arm: What the joints may do; None when they are not looked at.

    Raises:
        ValueError: radii, margins, ranges or heights are not in order, or there are too many boxes.
    """

    ext_radius_mm: float
    int_radius_mm: float
    margin_mm: float
    ranges_deg: tuple[tuple[float, float], tuple[float, float], tuple[float, float]]
    margin_deg: float
    floor_mm: float = -math.inf
    ceiling_mm: float = math.inf
    column: Column | None = None
    keep_outs: tuple[KeepOut, ...] = ()
    arm: ArmLimits | None = None

    def __post_init__(self) -> None:
        if not 0 <= self.int_radius_mm < self.ext_radius_mm < math.inf:
            raise ValueError("the inner sphere must be smaller than the outer one")
        if not (0 < self.margin_mm < math.inf and 0 < self.margin_deg < math.inf):
            raise ValueError("margins must be above zero")
        if not all(0 < high - low < 360 for low, high in self.ranges_deg):
            raise ValueError("a range of angles must be wider than 0 and less than a turn")
        if not self.floor_mm < self.ceiling_mm:
            raise ValueError("the floor must be below the ceiling")
        if len(self.keep_outs) > MAX_KEEP_OUTS:
            raise ValueError(f"there may be {MAX_KEEP_OUTS} keep-outs at most")

    @property
    def obstacles(self) -> tuple[Column | KeepOut, ...]:
        """The bodies in it."""
        return self.keep_outs if self.column is None else (self.column, *self.keep_outs)


@dataclass(frozen=True, slots=True)
class Plan:
    """What one activation makes the robot do.

    Attributes:
        start: Where it begins.
        increment: The one relative move, rounded towards zero to what the wire carries.
        length: Of the move, mm, or deg for a rotation.
        limited_by: What ends it, in words.
    """

    start: Pose
    increment: PoseIncrement
    length: float
    limited_by: str

    @property
    def end(self) -> Pose:
        """Where it ends."""
        x, y, z = self.start.position_mm
        rx, ry, rz = self.start.rotation_deg
        i = self.increment
        return Pose(
            x + i.dx_mm, y + i.dy_mm, z + i.dz_mm, rx + i.drx_deg, ry + i.dry_deg, rz + i.drz_deg
        )


@functools.lru_cache(maxsize=64)
def plan(position: Position, direction: Direction, field: FieldOfOperation) -> Plan | Refusal:
    """The increment from a position in a direction, as far as field and arm allow, or a refusal.

    Remembered: the gate asks again for the same one immediately before it is sent.
    """
    pose = position.pose
    if not all(math.isfinite(v) for v in (*pose.position_mm, *pose.rotation_deg)):
        return Refusal("bad_pose", "the robot's position is not a number")
    outside = find_outside(position, field)
    if outside is not None:
        return outside
    room = _turning_room if direction.is_rotation else _room
    found = room(pose, direction, field)
    return found if isinstance(found, Refusal) else _planned(position, direction, field, found)


def shortened(planned: Plan, direction: Direction, longest_mm: float, why: str) -> Plan:
    """A translation of at most this length: the same plan, or the beginning of it.

    Args:
        planned: As far as field and arm allow.
        direction: Its direction.
        longest_mm: At most so far.
        why: What ends it then, in words.
    """
    if planned.length <= longest_mm:
        return planned
    length = _towards_zero(longest_mm, 3)
    change: Vector = tuple(part * length + 0.0 for part in direction.unit)  # type: ignore[assignment]
    return Plan(planned.start, PoseIncrement(*change), length, why)


def nearest_turn(angle_deg: float, range_deg: tuple[float, float]) -> float:
    """The angle plus whole turns that lies nearest to the middle of a range."""
    middle = sum(range_deg) / 2
    return middle + math.remainder(angle_deg - middle, 360.0)


def find_outside(position: Position, field: FieldOfOperation) -> Refusal | None:
    """Why no increment may start here: outside the field, on its edge, beyond an arm's limit."""
    at = position.pose.position_mm
    for refusal in (_outside_spheres(at, field), _outside_planes(at, field), _inside(at, field)):
        if refusal is not None:
            return refusal
    return None if field.arm is None else find_arm_limit(position, field.arm)


@dataclass(frozen=True, slots=True)
class _Room:
    """How far the field lets the tool go, the margin taken off, what comes then, and too little."""

    length: float
    limited_by: str
    refusal: Refusal


def _outside_spheres(at: Vector, field: FieldOfOperation) -> Refusal | None:
    distance = math.hypot(*at)
    limit = f"{field.int_radius_mm:.0f} to {field.ext_radius_mm:.0f} mm from the robot's origin"
    asked = f"{distance:.1f} mm"
    if distance >= field.ext_radius_mm + EDGE_MM or distance <= field.int_radius_mm - EDGE_MM:
        text = f"the tool stands outside the field of operation, at {asked}; allowed: {limit}"
        return Refusal("outside_field", text, asked, limit)
    if distance > field.ext_radius_mm - EDGE_MM or distance < field.int_radius_mm + EDGE_MM:
        text = f"the tool stands on the edge of the field of operation, at {asked} of {limit}"
        return Refusal("on_edge", text, asked, limit)
    return None


def _outside_planes(at: Vector, field: FieldOfOperation) -> Refusal | None:
    for room, name, limit_mm, word in (
        (at[2] - field.floor_mm, "floor", field.floor_mm, "below"),
        (field.ceiling_mm - at[2], "ceiling", field.ceiling_mm, "above"),
    ):
        if room < EDGE_MM:
            asked, limit = f"z {at[2]:z.1f} mm", f"{name} at z {limit_mm:z.1f} mm"
            is_on_edge = room > -EDGE_MM
            text = f"the tool stands {'on' if is_on_edge else word} the {limit}, at {asked}"
            return Refusal("on_edge" if is_on_edge else "outside_field", text, asked, limit)
    return None


def _inside(at: Vector, field: FieldOfOperation) -> Refusal | None:
    asked = "x {:z.1f}, y {:z.1f}, z {:z.1f} mm".format(*at)
    for body in field.obstacles:
        if body.holds(at, -EDGE_MM):
            text = f"the tool stands inside the {body.name}, at {asked}"
            return Refusal("outside_field", text, asked, body.name)
        if body.holds(at, EDGE_MM):
            text = f"the tool stands on the edge of the {body.name}, at {asked}"
            return Refusal("on_edge", text, asked, body.name)
    return None


def _boundaries(
    start: Vector, unit: Vector, field: FieldOfOperation
) -> Iterator[tuple[float, str]]:
    """Every boundary and how far along the ray it is met."""
    outer = sphere_crossings(start, unit, field.ext_radius_mm)
    inner = sphere_crossings(start, unit, field.int_radius_mm)
    # A start inside the outer sphere always has one crossing ahead of it.
    yield (outer[1] if outer else 0.0), "outer sphere"
    if inner is not None and inner[0] >= 0:
        yield inner[0], "inner sphere"
    yield plane_distance(start, unit, field.floor_mm), "floor"
    yield plane_distance(start, unit, field.ceiling_mm), "ceiling"
    for body in field.obstacles:
        yield body.distance(start, unit), body.name


def _room(pose: Pose, direction: Direction, field: FieldOfOperation) -> _Room:
    boundaries = _boundaries(pose.position_mm, direction.unit, field)
    reach, limited_by = min(boundaries, key=lambda boundary: boundary[0])
    asked, limit = f"{reach:.1f} mm", f"{field.margin_mm:.1f} mm margin"
    text = f"no room along {_name(direction)}: {asked} to the {limited_by}, {limit}"
    refusal = Refusal("at_limit", text, asked, limit)
    return _Room(reach - field.margin_mm, limited_by, refusal)


def _turning_room(pose: Pose, direction: Direction, field: FieldOfOperation) -> _Room | Refusal:
    low, high = range_deg = field.ranges_deg[direction.axis]
    name = f"R{AXES[direction.axis].lower()}"
    angle = nearest_turn(pose.rotation_deg[direction.axis], range_deg)
    asked, limit = f"{name} {angle:z.2f} deg", f"{low:.1f} to {high:.1f} deg"
    if angle < low - EDGE_DEG or angle > high + EDGE_DEG:
        return Refusal("outside_field", f"{asked} is outside its range of {limit}", asked, limit)
    left = (high - angle) if direction.sign > 0 else (angle - low)
    text = f"no room to turn: {asked}, range {limit}, margin {field.margin_deg:.1f} deg"
    refusal = Refusal("at_limit", text, asked, limit)
    return _Room(left - field.margin_deg, f"range of {name}", refusal)


def _planned(
    position: Position, direction: Direction, field: FieldOfOperation, room: _Room
) -> Plan | Refusal:
    """The increment as far as there is room and the arm can follow."""
    is_rotation = direction.is_rotation
    least, places = (MIN_LENGTH_DEG, 2) if is_rotation else (MIN_LENGTH_MM, 3)
    length, limited_by = _towards_zero(room.length, places), room.limited_by
    if length < least:
        return room.refusal
    if field.arm is not None:
        reach = reach_along(position, direction, length, field.arm)
        if reach.limited_by:
            length, limited_by = _towards_zero(reach.length, places), reach.limited_by
    if length < least:
        text = f"no room for {_name(direction)}: {limited_by}"
        return Refusal("at_limit", text, f"{length} {'deg' if is_rotation else 'mm'}", limited_by)
    change: Vector = tuple(part * length + 0.0 for part in direction.unit)  # type: ignore[assignment]
    none = (0.0, 0.0, 0.0)
    increment = PoseIncrement(*none, *change) if is_rotation else PoseIncrement(*change)
    return Plan(position.pose, increment, length, limited_by)


def _name(direction: Direction) -> str:
    turn = "R" if direction.is_rotation else ""
    return f"{turn}{AXES[direction.axis]}{'+' if direction.sign > 0 else '-'}"


def _towards_zero(value: float, places: int) -> float:
    scale = 10.0**places
    return math.floor(value * scale) / scale
