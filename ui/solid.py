"""Solid things on flat paper: a parallel projection, prisms, ribbons and outlines. Pure, no Qt.

The view is from behind, from the right and from above, as over a person's right shoulder: forward
(+X) goes to the upper right, left (+Y) to the upper left, up (+Z) goes up. Lengths in m; on paper x
points to the right and y up.
"""

from collections.abc import Callable, Sequence
from math import cos, hypot, radians, sin

Point = tuple[float, float]
Vector = tuple[float, float, float]
Matrix = tuple[Vector, Vector, Vector]
Place = Callable[[Vector], Vector]
"""Where a point of a thing is in the room."""

_AZIMUTH, _ELEVATION = radians(36.0), radians(30.0)
_RIGHT: Vector = (sin(_AZIMUTH), -cos(_AZIMUTH), 0.0)
_UP: Vector = (cos(_AZIMUTH) * sin(_ELEVATION), sin(_AZIMUTH) * sin(_ELEVATION), cos(_ELEVATION))
_AWAY: Vector = (
    cos(_AZIMUTH) * cos(_ELEVATION),
    sin(_AZIMUTH) * cos(_ELEVATION),
    -sin(_ELEVATION),
)


def flat(place: Vector) -> Point:
    """Where a point of the room is on paper."""
    return _dot(place, _RIGHT), _dot(place, _UP)


def depth(place: Vector) -> float:
    """How far away a point is from who looks."""
    return _dot(place, _AWAY)


def turn(axis: int, angle_rad: float) -> Matrix:
    """A right-handed turn about X, Y or Z; its rows."""
    c, s = cos(angle_rad), sin(angle_rad)
    if axis == 0:
        return ((1.0, 0.0, 0.0), (0.0, c, -s), (0.0, s, c))
    if axis == 1:
        return ((c, 0.0, s), (0.0, 1.0, 0.0), (-s, 0.0, c))
    return ((c, -s, 0.0), (s, c, 0.0), (0.0, 0.0, 1.0))


def turned(rows: Matrix, place: Vector) -> Vector:
    """A point after a turn about the origin."""
    return _dot(rows[0], place), _dot(rows[1], place), _dot(rows[2], place)


def plus(first: Vector, second: Vector, scale: float = 1.0) -> Vector:
    """The sum of one vector and ``scale`` times another."""
    return (
        first[0] + scale * second[0],
        first[1] + scale * second[1],
        first[2] + scale * second[2],
    )


def frame_along(way: Vector) -> tuple[Vector, Vector]:
    """Two unit vectors square to a way that is not upright, and to each other."""
    along = _unit(way)
    side = _unit(_cross(along, (0.0, 0.0, 1.0)))
    return side, _cross(side, along)


class Prism:
    """An upright prism somewhere in the room: which of its faces are seen, and its edges.

    Args:
        place: Puts the prism into the room.
        outline: Its base, clockwise from above.
        low: Height of the base.
        high: Height of the top, above ``low``.

    Attributes:
        cap: Top or base, whichever is seen.
        is_top_seen: Whether that is the top.
        sides: The sides that are seen, the farthest first.
        edges: Lines round the seen sides, without the cap's own and those between two seen sides.
    """

    def __init__(self, place: Place, outline: Sequence[Point], low: float, high: float) -> None:
        tops = [place((x, y, high)) for x, y in outline]
        top = [flat(each) for each in tops]
        base = [flat(place((x, y, low))) for x, y in outline]
        self.is_top_seen = _area(top) < 0.0
        near, far = (top, base) if self.is_top_seen else (base, top)
        self.cap = tuple(near)
        after = [*range(1, len(top)), 0]
        walls = [(top[i], base[i], base[j], top[j]) for i, j in enumerate(after)]
        seen = [_area(wall) < 0.0 for wall in walls]
        order = sorted((i for i in after if seen[i]), key=lambda i: -depth(tops[i]))
        self.sides = [walls[i] for i in order]
        self.edges = [(far[i], far[after[i]]) for i in order]
        self.edges += [(near[i], far[i]) for i in after if seen[i] is not seen[i - 1]]


def ribbon(way: Sequence[Vector], width: float, head: float) -> tuple[Point, ...]:
    """A flat arrow along a way through the room, as wide everywhere on paper.

    Args:
        way: At least two points.
        width: Of the shaft on paper.
        head: Length of the head on paper, and about its width.
    """
    line = [flat(each) for each in way]
    tip = line[-1]
    while len(line) > 2 and hypot(tip[0] - line[-1][0], tip[1] - line[-1][1]) < head:
        line.pop()
    neck, before = line[-1], line[-2]
    if neck == tip:
        share = head / max(hypot(tip[0] - before[0], tip[1] - before[1]), head)
        neck = tip[0] + (before[0] - tip[0]) * share, tip[1] + (before[1] - tip[1]) * share
        line[-1] = neck
    sides = [
        _normal(line[max(i - 1, 0)], line[min(i + 1, len(line) - 1)]) for i in range(len(line))
    ]
    half = width / 2
    left = [(x + nx * half, y + ny * half) for (x, y), (nx, ny) in zip(line, sides, strict=True)]
    right = [(x - nx * half, y - ny * half) for (x, y), (nx, ny) in zip(line, sides, strict=True)]
    nx, ny = _normal(neck, tip)
    wing = head * 0.58
    barbs = ((neck[0] + nx * wing, neck[1] + ny * wing), tip)
    return (*left, *barbs, (neck[0] - nx * wing, neck[1] - ny * wing), *reversed(right))


def hull(points: Sequence[Point]) -> tuple[Point, ...]:
    """The convex outline round points.

    Source: Andrew, Another efficient algorithm for convex hulls in two dimensions (1979).
    """
    ordered = sorted(set(points))
    outline: list[Point] = []
    for way in (ordered, ordered[::-1]):
        part: list[Point] = []
        for point in way:
            while len(part) >= 2 and _area((part[-2], part[-1], point)) <= 0.0:
                part.pop()
            part.append(point)
        outline += part[:-1]
    return tuple(outline)


def _dot(first: Vector, second: Vector) -> float:
    return first[0] * second[0] + first[1] * second[1] + first[2] * second[2]


def _cross(first: Vector, second: Vector) -> Vector:
    return (
        first[1] * second[2] - first[2] * second[1],
        first[2] * second[0] - first[0] * second[2],
        first[0] * second[1] - first[1] * second[0],
    )


def _unit(way: Vector) -> Vector:
    return plus((0.0, 0.0, 0.0), way, 1.0 / hypot(*way))


def _normal(start: Point, end: Point) -> Point:
    """The unit vector to the left of a way on paper."""
    dx, dy = end[0] - start[0], end[1] - start[1]
    length = hypot(dx, dy) or 1.0
    return -dy / length, dx / length


def _area(points: Sequence[Point]) -> float:
    """Twice the area inside; negative when the corners go round clockwise."""
    before = points[-1]
    total = 0.0
    for point in points:
        total += before[0] * point[1] - point[0] * before[1]
        before = point
    return total
