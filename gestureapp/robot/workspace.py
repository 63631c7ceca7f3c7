"""The field of operation: from a pose and a direction to the one increment, or a refusal. Pure.

The field is what lies between two spheres around the robot frame's origin (paper, equation 1). The
increment runs along the ray of equation 2 up to a margin short of the first boundary it meets
(equations 3 and 4). Rotations run to the end of the axis' range.
"""

import math
from dataclasses import dataclass

from gestureapp.robot.values import Direction, Pose, PoseIncrement, Refusal

Vector = tuple[float, float, float]

EDGE_MM = 0.001
"""A start this close to a sphere stands on its edge: RPOSC gives three decimals."""
EDGE_DEG = 0.01
"""The same for angles: the NX100 gives two decimals."""
MIN_LENGTH_MM = 1.0
"""Shorter increments are refused: they would only twitch."""
MIN_LENGTH_DEG = 0.5
"""The same for rotations."""

AXES = ("X", "Y", "Z")


@dataclass(frozen=True, slots=True)
class FieldOfOperation:
    """Where the tool may go.

    Attributes:
        ext_radius_mm: Outer sphere.
        int_radius_mm: Inner sphere.
        margin_mm: How far before a sphere, along the ray, an increment ends.
        ranges_deg: Lowest and highest rx, ry, rz. A range may pass 180, as Rx does for a tool that
            points down; angles are taken to the turn that lies nearest to the middle of the range.
        margin_deg: How far before the end of a range a rotation ends.

    Raises:
        ValueError: radii, margins or ranges are not in order.
    """

    ext_radius_mm: float
    int_radius_mm: float
    margin_mm: float
    ranges_deg: tuple[tuple[float, float], tuple[float, float], tuple[float, float]]
    margin_deg: float

    def __post_init__(self) -> None:
        if not 0 <= self.int_radius_mm < self.ext_radius_mm < math.inf:
            raise ValueError("the inner sphere must be smaller than the outer one")
        if not (0 < self.margin_mm < math.inf and 0 < self.margin_deg < math.inf):
            raise ValueError("margins must be above zero")
        if not all(0 < high - low < 360 for low, high in self.ranges_deg):
            raise ValueError("a range of angles must be wider than 0 and less than a turn")


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


def plan(pose: Pose, direction: Direction, field: FieldOfOperation) -> Plan | Refusal:
    """The increment from a pose in a direction, as far as the field allows, or a refusal."""
    if not all(math.isfinite(v) for v in (*pose.position_mm, *pose.rotation_deg)):
        return Refusal("bad_pose", "the robot's position is not a number")
    outside = find_outside(pose, field)
    if outside is not None:
        return outside
    if direction.is_rotation:
        return _plan_rotation(pose, direction, field)
    return _plan_translation(pose, direction, field)


def sphere_crossings(start: Vector, unit: Vector, radius: float) -> tuple[float, float] | None:
    """Where a line crosses a sphere around the origin (paper, equation 3).

    Args:
        start: Point on the line, mm.
        unit: Direction, length 1.
        radius: Of the sphere, mm.

    Returns:
        Both distances along ``unit``, smaller first; None when the line misses the sphere.
    """
    along = sum(s * u for s, u in zip(start, unit, strict=True))
    off_line = sum((s - along * u) ** 2 for s, u in zip(start, unit, strict=True))
    half_squared = radius * radius - off_line
    if half_squared < 0:
        return None
    half = math.sqrt(half_squared)
    return -along - half, -along + half


def nearest_turn(angle_deg: float, range_deg: tuple[float, float]) -> float:
    """The angle plus whole turns that lies nearest to the middle of a range."""
    middle = sum(range_deg) / 2
    return middle + math.remainder(angle_deg - middle, 360.0)


def find_outside(pose: Pose, field: FieldOfOperation) -> Refusal | None:
    """Why no increment may start here: outside the spheres, or on the edge of one."""
    distance = math.hypot(*pose.position_mm)
    limit = f"{field.int_radius_mm:.0f} to {field.ext_radius_mm:.0f} mm from the robot's origin"
    asked = f"{distance:.1f} mm"
    if distance >= field.ext_radius_mm + EDGE_MM or distance <= field.int_radius_mm - EDGE_MM:
        text = f"the tool stands outside the field of operation, at {asked}; allowed: {limit}"
        return Refusal("outside_field", text, asked, limit)
    if distance > field.ext_radius_mm - EDGE_MM or distance < field.int_radius_mm + EDGE_MM:
        text = f"the tool stands on the edge of the field of operation, at {asked} of {limit}"
        return Refusal("on_edge", text, asked, limit)
    return None


def _plan_translation(pose: Pose, direction: Direction, field: FieldOfOperation) -> Plan | Refusal:
    start, unit = pose.position_mm, direction.unit
    outer = sphere_crossings(start, unit, field.ext_radius_mm)
    inner = sphere_crossings(start, unit, field.int_radius_mm)
    # A start inside the outer sphere always has one crossing ahead of it.
    reach, limited_by = (outer[1] if outer else 0.0), "outer sphere"
    if inner is not None and 0 <= inner[0] < reach:
        reach, limited_by = inner[0], "inner sphere"
    length = _towards_zero(reach - field.margin_mm, 3)
    name = f"{AXES[direction.axis]}{'+' if direction.sign > 0 else '-'}"
    if length < MIN_LENGTH_MM:
        asked, limit = f"{reach:.1f} mm", f"{field.margin_mm:.1f} mm margin"
        text = f"no room along {name}: {asked} to the {limited_by}, {limit}"
        return Refusal("at_limit", text, asked, limit)
    dx, dy, dz = (u * length + 0.0 for u in unit)
    return Plan(pose, PoseIncrement(dx, dy, dz), length, limited_by)


def _plan_rotation(pose: Pose, direction: Direction, field: FieldOfOperation) -> Plan | Refusal:
    low, high = range_deg = field.ranges_deg[direction.axis]
    name = f"R{AXES[direction.axis].lower()}"
    angle = nearest_turn(pose.rotation_deg[direction.axis], range_deg)
    asked, limit = f"{name} {angle:.2f} deg", f"{low:.1f} to {high:.1f} deg"
    if angle < low - EDGE_DEG or angle > high + EDGE_DEG:
        return Refusal("outside_field", f"{asked} is outside its range of {limit}", asked, limit)
    end = high if direction.sign > 0 else low
    length = _towards_zero(abs(end - angle) - field.margin_deg, 2)
    if (end - angle) * direction.sign <= 0 or length < MIN_LENGTH_DEG:
        text = f"no room to turn: {asked}, range {limit}, margin {field.margin_deg:.1f} deg"
        return Refusal("at_limit", text, asked, limit)
    drx, dry, drz = (u * length + 0.0 for u in direction.unit)
    increment = PoseIncrement(drx_deg=drx, dry_deg=dry, drz_deg=drz)
    return Plan(pose, increment, length, f"range of {name}")


def _towards_zero(value: float, places: int) -> float:
    scale = 10.0**places
    return math.floor(value * scale) / scale
