"""An arm that makes a gesture, as flat shapes to be painted. Pure, no Qt."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from enum import Enum
from functools import lru_cache
from math import cos, pi, radians, sin

from gestureapp.gestures import LABELS, Gesture, Kind, gesture
from ui.solid import (
    Matrix,
    Point,
    Prism,
    Vector,
    depth,
    flat,
    frame_along,
    hull,
    plus,
    ribbon,
    turn,
    turned,
)

LEFT_STOP = "left stop"
"""The left arm's stop posture: level."""
LEFT_START = "left start"
"""The left arm's start posture: turned about Y until X points down, as the right arm's RY-."""
FIGURES: tuple[str, ...] = (*LABELS, LEFT_STOP, LEFT_START)
"""Everything that can be drawn."""
_WORDS = {LEFT_STOP: "left hand level: stop", LEFT_START: "left hand tipped down: start"}


class Look(Enum):
    """What a shape is, and so how it is painted."""

    FLOOR = "floor"
    """A level plane under the arm."""
    SHADOW = "shadow"
    """The arm's shadow on it: it tells up from forward."""
    GHOST = "ghost"
    """The start posture."""
    SKIN = "skin"
    SIDE = "side"
    """What is in the shade; it has no outline."""
    EDGE = "edge"
    """An open line."""
    SENSOR = "sensor"
    ARROW = "arrow"
    """The movement."""


@dataclass(frozen=True, slots=True)
class Shape:
    """One outline, or an open line for an edge; ``points`` in m on paper, x right, y up."""

    look: Look
    points: tuple[Point, ...]


@dataclass(frozen=True, slots=True)
class Box:
    """The room a figure takes on paper, m."""

    left: float
    bottom: float
    right: float
    top: float


@dataclass(frozen=True, slots=True)
class _Pose:
    """Where an arm is: elbow, wrist, and how the hand is turned. A left hand is mirrored."""

    elbow: Vector
    wrist: Vector
    turn: Matrix
    is_left: bool = False

    def place(self, point: Vector) -> Vector:
        """Where a point of the hand is in the room."""
        return plus(self.wrist, turned(self.turn, point))


_ORIGIN: Vector = (0.0, 0.0, 0.0)
_FOREARM: Vector = (0.22, 0.0, 0.0)
_LEVEL: Matrix = turn(2, 0.0)
_REACH_M = (0.26, 0.26, 0.22)
"""How far the hand goes along X, Y, Z in the drawing."""
_TURN_RAD = (radians(78.0), radians(72.0), radians(52.0))
"""How far it turns about X, Y, Z."""
_ELBOW_FOLLOWS = 0.35
"""Share of a lift that the elbow takes part in."""
_FOREARM_FOLLOWS = 0.4
"""Share of a turn about Y that the forearm takes part in."""
_ELBOW_R, _WRIST_R = 0.042, 0.029
_HALF_M = 0.012
"""Half of the hand's thickness."""
_HAND: tuple[Point, ...] = (
    (0.000, 0.029),
    (0.022, 0.037),
    (0.048, 0.066),
    (0.074, 0.086),
    (0.088, 0.083),
    (0.086, 0.070),
    (0.070, 0.052),
    (0.076, 0.043),
    (0.100, 0.043),
    (0.158, 0.039),
    (0.170, 0.033),
    (0.186, 0.014),
    (0.188, 0.000),
    (0.182, -0.012),
    (0.162, -0.026),
    (0.142, -0.040),
    (0.132, -0.043),
    (0.084, -0.044),
    (0.030, -0.036),
    (0.000, -0.029),
)
"""A right hand from above, clockwise: +x to the finger tips, +y to the thumb."""
_FINGERS: tuple[tuple[Point, Point], ...] = (
    ((0.104, 0.021), (0.172, 0.022)),
    ((0.104, -0.001), (0.186, -0.001)),
    ((0.100, -0.022), (0.164, -0.022)),
)
_SENSOR: tuple[Point, ...] = ((0.024, 0.026), (0.084, 0.026), (0.084, -0.026), (0.024, -0.026))
_SENSOR_HIGH_M = 0.026
_STRAP_X = (0.044, 0.064)
_STRAP_Y = 0.042
_FLOOR_BELOW_M = 0.11
_ARROW_WIDTH_M, _ARROW_HEAD_M = 0.028, 0.075
_ICON_BROADER = 1.7
_ICON_ARM = 0.5
"""Share of the forearm that an icon shows."""
_TIP: Vector = (0.25, 0.0, 0.0)
_MARKS: dict[Kind, tuple[Vector, Vector, Vector]] = {
    Kind.MOVEMENT: ((0.02, -0.12, 0.0), (0.27, 0.0, 0.0), (0.20, -0.10, 0.0)),
    Kind.POSTURE: ((0.17, 0.15, 0.0), _TIP, _TIP),
}
"""The point beside the hand whose way the arrow follows, for X, Y and Z."""
_ARC_STEPS = 32


def words_of(name: str) -> str:
    """What a figure shows: ``push forward``.

    Raises:
        KeyError: nothing of this name can be drawn.
    """
    return _WORDS[name] if name in _WORDS else gesture(name).words


def figure(name: str, share: float, is_icon: bool = False) -> list[Shape]:
    """The shapes of a figure, to be painted in this order.

    Args:
        name: A gesture's label, ``LEFT_STOP`` or ``LEFT_START``.
        share: How much of the movement is done, 0 to 1; an icon has its own.
        is_icon: Whether it is to be read a few millimetres high: hand and a broad arrow alone.

    Raises:
        KeyError: nothing of this name can be drawn.
    """
    pose, arrow = _icon_pose(name) if is_icon else _pose(name, share), _arrow(name)
    shapes: list[Shape] = []
    if not is_icon:
        shapes += _ground(name, pose)
        shapes += _ghost(_pose(name, 0.0)) if arrow else []
    shapes += _arm(pose)
    if is_icon:
        shapes = [shape for shape in shapes if shape.look is not Look.EDGE]
    if arrow:
        broad = _ICON_BROADER if is_icon else 1.0
        points = ribbon(arrow, broad * _ARROW_WIDTH_M, broad * _ARROW_HEAD_M)
        shapes.append(Shape(Look.ARROW, points))
    return shapes


@lru_cache(maxsize=2 * len(FIGURES))
def box_of(name: str, is_icon: bool = False) -> Box:
    """The room that a figure takes from its first moment to its last.

    Raises:
        KeyError: nothing of this name can be drawn.
    """
    shares = (0.0,) if is_icon else (0.0, 0.25, 0.5, 0.75, 1.0)
    shapes = [shape for share in shares for shape in figure(name, share, is_icon)]
    xs, ys = zip(*(point for shape in shapes for point in shape.points), strict=True)
    return Box(min(xs), min(ys), max(xs), max(ys))


def _pose(name: str, share: float) -> _Pose:
    if name in _WORDS:
        return _pitched(radians(80.0) * share if name == LEFT_START else 0.0, is_left=True)
    wanted = gesture(name)
    if wanted.kind is Kind.MOVEMENT:
        return _moved(wanted, share)
    angle = wanted.sign * _TURN_RAD[wanted.axis] * share
    if wanted.axis == 0:
        return _Pose(_ORIGIN, _FOREARM, turn(0, angle))
    if wanted.axis == 1:  # RY+ is fingers up, which is the negative right-handed turn about Y
        return _pitched(-angle)
    about_elbow = turn(2, angle)
    return _Pose(_ORIGIN, turned(about_elbow, _FOREARM), about_elbow)


def _icon_pose(name: str) -> _Pose:
    """The hand large and beside its arrow: a movement half done, a turn done, and little arm."""
    is_movement = name not in _WORDS and gesture(name).kind is Kind.MOVEMENT
    pose = _pose(name, 0.5 if is_movement else 1.0)
    arm = plus(pose.elbow, pose.wrist, -1.0)
    return replace(pose, elbow=plus(pose.wrist, arm, _ICON_ARM))


def _pitched(angle_rad: float, is_left: bool = False) -> _Pose:
    """The hand turned about Y, fingers down when positive; the forearm follows."""
    wrist = turned(turn(1, angle_rad * _FOREARM_FOLLOWS), _FOREARM)
    return _Pose(_ORIGIN, wrist, turn(1, angle_rad), is_left)


def _moved(wanted: Gesture, share: float) -> _Pose:
    way = _way(wanted, share)
    elbow = plus(_ORIGIN, way, _ELBOW_FOLLOWS if wanted.axis == 2 else 1.0)
    return _Pose(elbow, plus(_FOREARM, way), _LEVEL)


def _way(wanted: Gesture, share: float) -> Vector:
    steps = [0.0, 0.0, 0.0]
    steps[wanted.axis] = wanted.sign * _REACH_M[wanted.axis] * share
    return steps[0], steps[1], steps[2]


def _arm(pose: _Pose) -> list[Shape]:
    """Forearm, hand and sensor, the farthest first."""
    hand, forearm = list(_hand(pose)), list(_forearm(pose))
    middle = plus(pose.elbow, plus(pose.wrist, pose.elbow, -1.0), 0.5)
    is_hand_behind = depth(pose.place((0.09, 0.0, 0.0))) > depth(middle)
    return [*hand, *forearm] if is_hand_behind else [*forearm, *hand]


def _forearm(pose: _Pose) -> Iterator[Shape]:
    side, over = frame_along(plus(pose.wrist, pose.elbow, -1.0))
    x, y = flat(pose.wrist)
    cut, wrist = [], []
    for i in range(20):
        c, s = cos(2.0 * pi * i / 20), sin(2.0 * pi * i / 20)
        rim = plus(plus(pose.elbow, side, c * _ELBOW_R), over, s * _ELBOW_R)
        cut.append(flat(rim))
        wrist.append((x + _WRIST_R * c, y + _WRIST_R * s))
    yield Shape(Look.SKIN, hull([*cut, *wrist]))
    yield Shape(Look.SIDE, tuple(cut))
    yield Shape(Look.EDGE, (*cut, cut[0]))


def _hand(pose: _Pose) -> Iterator[Shape]:
    prism = Prism(pose.place, _outline(pose), -_HALF_M, _HALF_M)
    if not prism.is_top_seen:
        yield from _sensor(pose)
    for side in prism.sides:
        yield Shape(Look.SIDE, side)
    for edge in prism.edges:
        yield Shape(Look.EDGE, edge)
    yield Shape(Look.SKIN, prism.cap)
    height = _HALF_M if prism.is_top_seen else -_HALF_M
    sign = -1.0 if pose.is_left else 1.0
    for ends in _FINGERS:
        line = tuple(flat(pose.place((x, sign * y, height))) for x, y in ends)
        yield Shape(Look.EDGE, line)
    if prism.is_top_seen:
        yield from _sensor(pose)


def _outline(pose: _Pose) -> tuple[Point, ...]:
    return tuple((x, -y) for x, y in reversed(_HAND)) if pose.is_left else _HAND


def _sensor(pose: _Pose) -> Iterator[Shape]:
    """The box on the back of the hand, and its strap."""
    first, last = _STRAP_X
    corners = ((first, -_STRAP_Y), (first, _STRAP_Y), (last, _STRAP_Y), (last, -_STRAP_Y))
    yield Shape(Look.SIDE, tuple(flat(pose.place((x, y, _HALF_M))) for x, y in corners))
    for x in _STRAP_X:
        ends = ((x, -_STRAP_Y, _HALF_M), (x, _STRAP_Y, _HALF_M))
        yield Shape(Look.EDGE, tuple(flat(pose.place(end)) for end in ends))
    box = Prism(pose.place, _SENSOR, _HALF_M, _HALF_M + _SENSOR_HIGH_M)
    for face in (*box.sides, box.cap):
        yield Shape(Look.SENSOR, face)


def _ghost(pose: _Pose) -> list[Shape]:
    hand = Prism(pose.place, _outline(pose), -_HALF_M, _HALF_M)
    forearm = next(_forearm(pose))
    return [Shape(Look.GHOST, forearm.points), Shape(Look.GHOST, hand.cap)]


def _ground(name: str, pose: _Pose) -> Iterator[Shape]:
    """A level plane below everything the figure does, and the arm's shadow on it."""
    poses = [_pose(name, share) for share in (0.0, 1.0)]
    places = [p.place((x, 0.0, 0.0)) for p in poses for x in (0.0, 0.188)]
    z = min(place[2] for place in places) - _FLOOR_BELOW_M
    x1 = max(place[0] for place in places) + 0.03
    y0, y1 = min(place[1] for place in places) - 0.10, max(place[1] for place in places) + 0.10
    x0 = min(p.elbow[0] for p in poses)
    corners = ((x0, y0), (x0, y1), (x1, y1), (x1, y0))
    yield Shape(Look.FLOOR, tuple(flat((x, y, z)) for x, y in corners))
    rim = [pose.place((x, y, 0.0)) for x, y in _outline(pose)]
    yield Shape(Look.SHADOW, tuple(flat((x, y, z)) for x, y, _ in rim))
    side, _ = frame_along(plus(pose.wrist, pose.elbow, -1.0))
    ends = ((pose.elbow, _ELBOW_R), (pose.wrist, _WRIST_R))
    arm = [plus(at, side, sign * r) for at, r in ends for sign in (-1.0, 1.0)]
    yield Shape(Look.SHADOW, hull([flat((x, y, z)) for x, y, _ in arm]))


def _arrow(name: str) -> list[Vector]:
    """The way of the arrow through the room; empty when nothing moves."""
    if name == LEFT_STOP:
        return []
    wanted = gesture("RY-" if name == LEFT_START else name)
    mark, first, last = _MARKS[wanted.kind][wanted.axis], 0.0, 1.0
    if wanted.kind is Kind.POSTURE and wanted.axis == 0:
        # Beside the edge that is lifted; a little longer than the turn, which is short there.
        mark, first, last = (mark[0], wanted.sign * mark[1], mark[2]), -0.2, 1.2
    steps = 1 if wanted.kind is Kind.MOVEMENT else _ARC_STEPS
    shares = [first + (last - first) * i / steps for i in range(steps + 1)]
    return [_pose(name, share).place(mark) for share in shares]
