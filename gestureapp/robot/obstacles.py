"""What stands in the field: planes, the column, boxes; where a ray meets them, exactly. Pure.

Robot frame, mm. A ray is a point and a direction of length 1. Touching counts as meeting.
"""

import math
from dataclasses import dataclass

Vector = tuple[float, float, float]
Span = tuple[float, float]

_EVERYWHERE: Span = (-math.inf, math.inf)


@dataclass(frozen=True, slots=True)
class Column:
    """A cylinder round the S axis, from below everything up to its top: the robot's own body.

    Raises:
        ValueError: it has no radius, or a size is no number.
    """

    radius_mm: float
    top_mm: float

    def __post_init__(self) -> None:
        if not (0 < self.radius_mm < math.inf and math.isfinite(self.top_mm)):
            raise ValueError("a column needs a radius above zero and a top")

    @property
    def name(self) -> str:
        """As it is called in a sentence."""
        return "column"

    def holds(self, point: Vector, grown_mm: float) -> bool:
        """Whether a point lies in it, were it so much larger."""
        is_low = point[2] <= self.top_mm + grown_mm
        return is_low and math.hypot(point[0], point[1]) <= self.radius_mm + grown_mm

    def distance(self, start: Vector, unit: Vector) -> float:
        """How far along the ray it is met first; infinite when it is not."""
        beside = _in_circle(start, unit, self.radius_mm)
        below = _between(start[2], unit[2], -math.inf, self.top_mm)
        return _first(_common(beside, below))


@dataclass(frozen=True, slots=True)
class KeepOut:
    """A box along the robot frame's axes that the tool stays out of.

    Attributes:
        label: What stands there, in the site's words.
        low_mm: Its lowest x, y, z.
        high_mm: Its highest.

    Raises:
        ValueError: it has no name, or a low corner is not below the high one.
    """

    label: str
    low_mm: Vector
    high_mm: Vector

    def __post_init__(self) -> None:
        corners = zip(self.low_mm, self.high_mm, strict=True)
        if not self.label or not all(-math.inf < low < high < math.inf for low, high in corners):
            raise ValueError("a keep-out needs a name, and a low corner below its high one")

    @property
    def name(self) -> str:
        """As it is called in a sentence."""
        return f"keep-out '{self.label}'"

    def holds(self, point: Vector, grown_mm: float) -> bool:
        """Whether a point lies in it, were it so much larger."""
        sides = zip(self.low_mm, point, self.high_mm, strict=True)
        return all(low - grown_mm <= at <= high + grown_mm for low, at, high in sides)

    def distance(self, start: Vector, unit: Vector) -> float:
        """How far along the ray it is met first; infinite when it is not."""
        inside: Span | None = _EVERYWHERE
        for at, step, low, high in zip(start, unit, self.low_mm, self.high_mm, strict=True):
            inside = _common(inside, _between(at, step, low, high))
        return _first(inside)


def sphere_crossings(start: Vector, unit: Vector, radius: float) -> Span | None:
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


def plane_distance(start: Vector, unit: Vector, height_mm: float) -> float:
    """How far along the ray a level plane is met; infinite when the ray never comes nearer."""
    missing = height_mm - start[2]
    return missing / unit[2] if missing * unit[2] > 0 else math.inf


def _in_circle(start: Vector, unit: Vector, radius: float) -> Span | None:
    """The part of a line inside an upright cylinder without ends."""
    level = unit[0] * unit[0] + unit[1] * unit[1]
    if level == 0:
        return _EVERYWHERE if math.hypot(start[0], start[1]) <= radius else None
    nearest = -(start[0] * unit[0] + start[1] * unit[1]) / level
    off = math.hypot(start[0] + nearest * unit[0], start[1] + nearest * unit[1])
    if off > radius:
        return None
    half = math.sqrt((radius * radius - off * off) / level)
    return nearest - half, nearest + half


def _between(at: float, step: float, low: float, high: float) -> Span | None:
    """The part of a line on which one coordinate lies between two values."""
    if step == 0:
        return _EVERYWHERE if low <= at <= high else None
    one, other = (low - at) / step, (high - at) / step
    return min(one, other), max(one, other)


def _common(a: Span | None, b: Span | None) -> Span | None:
    if a is None or b is None:
        return None
    begin, end = max(a[0], b[0]), min(a[1], b[1])
    return (begin, end) if begin <= end else None


def _first(inside: Span | None) -> float:
    """Where a ray comes in; a start inside is at zero."""
    if inside is None or inside[1] < 0:
        return math.inf
    return max(0.0, inside[0])
