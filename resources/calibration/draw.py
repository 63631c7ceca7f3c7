"""Writes the drawings of setting up as SVG files beside this one: ``python draw.py``.

The six positions of the calibration: a sensor's box on a table, its three axes as arrows, the one
that counts thick. Every line and letter has the colour of the text around it (``currentColor``); a
viewer that knows none draws black.
"""

from math import cos, radians, sin
from pathlib import Path

HERE = Path(__file__).resolve().parent

Vector = tuple[float, float, float]
Point = tuple[float, float]
Segment = tuple[Point, Point]

SIZE: Vector = (66.0, 46.0, 22.0)
"""Of the box along its own X, Y, Z: longest the way the forearm points, lowest upwards."""
TABLE = 68.0
"""Half of its edge."""
BOARD = 7.0
"""Its thickness."""
ARROW, MAIN_ARROW, DOWN_ARROW = 22.0, 40.0, 114.0
"""From the face on; the one that points down ends below the table."""
WIDTH, HEIGHT = 250.0, 270.0
_CENTRE: Point = (125.0, 138.0)

TOWARDS: dict[str, tuple[Vector, Vector, Vector]] = {
    "z-up": ((0, 1, 0), (1, 0, 0), (0, 0, 1)),
    "z-down": ((1, 0, 0), (0, 1, 0), (0, 0, -1)),
    "x-up": ((0, 0, 1), (0, 1, 0), (1, 0, 0)),
    "x-down": ((0, 0, -1), (1, 0, 0), (0, 1, 0)),
    "y-up": ((1, 0, 0), (0, 0, 1), (0, 1, 0)),
    "y-down": ((0, 1, 0), (0, 0, -1), (1, 0, 0)),
}
"""Where the sensor's X, Y, Z point: towards the right and the viewer, the left and the viewer, up.

These three directions are left-handed and the sensor's axes right-handed, so that the determinant
of each row is -1. Only what points down is out of sight.
"""

_TITLES = {"up": "up", "down": "down, into the table"}


def on_paper(place: Vector) -> Point:
    """An isometric view: x to the right, y down."""
    a, b, up = place
    turn = radians(30.0)
    return _CENTRE[0] + (a - b) * cos(turn), _CENTRE[1] + (a + b) * sin(turn) - up


def svg_of(position: str) -> str:
    """The drawing of a position as the text of an SVG file.

    Raises:
        KeyError: there is no such position.
    """
    axes = TOWARDS[position]
    main = "xyz".index(position[0])
    extent = tuple(sum(SIZE[axis] * abs(axes[axis][k]) for axis in range(3)) for k in range(3))
    a, b, high = extent
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH:.0f} {HEIGHT:.0f}" '
        'role="img" fill="none" stroke="currentColor" color="currentColor" '
        'stroke-width="2" stroke-linejoin="round" stroke-linecap="round">',
        f"<title>{position[0].upper()} {_TITLES[position[2:]]}</title>",
        *_table(_silhouette(a / 2, b / 2, high)),
        *_box(a / 2, b / 2, high),
    ]
    for axis in range(3):
        lines += _axis(axes[axis], "XYZ"[axis], (a, b, high), axis == main)
    return "\n".join([*lines, "</svg>", ""])


def _table(hidden: list[Point]) -> list[str]:
    """A board; what the box hides of its far edges is left out."""
    t = TABLE
    right, near, left, far = (
        on_paper(place) for place in ((t, -t, 0), (t, t, 0), (-t, t, 0), (-t, -t, 0))
    )
    below = [(x, y + BOARD) for x, y in (right, near, left)]
    face = [right, near, left, far]
    lines = [
        f'<polygon points="{_points(face)}" fill="currentColor" fill-opacity="0.05" '
        'stroke="none"/>',
        f'<polyline points="{_points([right, near, left])}" stroke-width="1.5"/>',
        f'<polyline points="{_points([right, *below, left])}" stroke-width="1.5"/>',
        f'<polyline points="{_points([near, below[1]])}" stroke-width="1.5"/>',
    ]
    for start, end in ((right, far), (far, left)):
        lines += [_line(one, 1.5) for one in outside(hidden, start, end)]
    return lines


def _silhouette(a: float, b: float, high: float) -> list[Point]:
    corners = ((a, -b, 0), (a, b, 0), (-a, b, 0), (-a, b, high), (-a, -b, high), (a, -b, high))
    return [on_paper(corner) for corner in corners]


def _box(a: float, b: float, high: float) -> list[str]:
    top = [(a, -b, high), (a, b, high), (-a, b, high), (-a, -b, high)]
    right = [(a, -b, 0), (a, b, 0), (a, b, high), (a, -b, high)]
    left = [(-a, b, 0), (a, b, 0), (a, b, high), (-a, b, high)]
    return [
        f'<polygon points="{_points([on_paper(corner) for corner in face])}" '
        f'fill="currentColor" fill-opacity="{shade}"/>'
        for face, shade in ((top, 0.04), (left, 0.12), (right, 0.22))
    ]


def _axis(way: Vector, name: str, extent: Vector, is_main: bool) -> list[str]:
    """An arrow from the middle of the face it leaves through, with its letter."""
    a, b, high = extent
    is_down = way[2] < 0
    start = (way[0] * a / 2, way[1] * b / 2, high / 2 + way[2] * high / 2)
    length = DOWN_ARROW if is_down else MAIN_ARROW if is_main else ARROW
    end = tuple(start[k] + way[k] * length for k in range(3))
    one, other = on_paper(start), on_paper((end[0], end[1], end[2]))
    width = 4.0 if is_main else 2.0
    lines = []
    if is_down:
        edge = (one[0], on_paper((TABLE, TABLE, 0))[1] + BOARD)
        lines.append(_line((one, edge), 2.0, dashed=True))
        one = edge
    lines += [_line((one, other), width), _head(one, other, 7.0 if is_main else 5.0)]
    return [*lines, _letter(name, one, other, is_main)]


def _head(start: Point, end: Point, size: float) -> str:
    (x, y), (ux, uy) = end, _unit(start, end)
    corners = [
        (x + ux * size, y + uy * size),
        (x - ux * size - uy * size * 0.8, y - uy * size + ux * size * 0.8),
        (x - ux * size + uy * size * 0.8, y - uy * size - ux * size * 0.8),
    ]
    return f'<polygon points="{_points(corners)}" fill="currentColor" stroke-width="1"/>'


def _letter(name: str, start: Point, end: Point, is_main: bool) -> str:
    (x, y), (ux, uy) = end, _unit(start, end)
    size = 26.0 if is_main else 16.0
    if abs(ux) < 0.1:  # beside an upright arrow, beyond a slanting one
        x, y = x + size * 0.8, y + size * 0.35
    else:
        x, y = x + ux * size, y + uy * size + size * 0.35
    weight = "bold" if is_main else "normal"
    return (
        f'<text x="{x:.1f}" y="{y:.1f}" font-family="sans-serif" font-size="{size:.0f}" '
        f'font-weight="{weight}" text-anchor="middle" fill="currentColor" stroke="none">'
        f"{name}</text>"
    )


def _unit(start: Point, end: Point) -> Point:
    dx, dy = end[0] - start[0], end[1] - start[1]
    length = (dx * dx + dy * dy) ** 0.5
    return dx / length, dy / length


def outside(shape: list[Point], start: Point, end: Point) -> list[Segment]:
    """What of a line lies outside a convex shape: none, one or two pieces (Cyrus and Beck)."""
    enter, leave = 0.0, 1.0
    dx, dy = end[0] - start[0], end[1] - start[1]
    middle = (sum(x for x, _ in shape) / len(shape), sum(y for _, y in shape) / len(shape))
    for (x1, y1), (x2, y2) in zip(shape, [*shape[1:], shape[0]], strict=True):
        nx, ny = y2 - y1, x1 - x2  # across the edge
        if (middle[0] - x1) * nx + (middle[1] - y1) * ny > 0:
            nx, ny = -nx, -ny  # outwards
        along, ahead = dx * nx + dy * ny, (x1 - start[0]) * nx + (y1 - start[1]) * ny
        if along < 0:
            enter = max(enter, ahead / along)
        elif along > 0:
            leave = min(leave, ahead / along)
        elif ahead < 0:
            return [(start, end)]
    if enter >= leave:
        return [(start, end)]
    cut = [(start[0] + dx * t, start[1] + dy * t) for t in (enter, leave)]
    pieces = [(start, cut[0])] * (enter > 0) + [(cut[1], end)] * (leave < 1)
    return pieces


def _line(segment: Segment, width: float, dashed: bool = False) -> str:
    (x1, y1), (x2, y2) = segment
    dashes = ' stroke-dasharray="3 5"' if dashed else ""
    return (
        f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" '
        f'stroke-width="{width:g}"{dashes}/>'
    )


def _points(corners: list[Point]) -> str:
    return " ".join(f"{x:.1f},{y:.1f}" for x, y in corners)


def main() -> None:
    """Write them all."""
    for position in TOWARDS:
        (HERE / f"{position}.svg").write_text(svg_of(position), encoding="utf-8")


if __name__ == "__main__":
    main()
