"""How far the arm itself can go along a line: joint limits and singular places. Pure.

The controller moves the tool on a straight line, or turns it about its point, and the joints follow
as they must. Here they are followed in steps: from the posture that the robot tells, without ever
changing the branch, until the first limit; that place is then narrowed down.
"""

import math
from dataclasses import dataclass

from gestureapp.robot.hp6 import (
    STRETCHED_DEG,
    Branch,
    Joints,
    Matrix,
    Vector,
    branch_of,
    joints_deg,
    normal_deg,
    rotation,
    solve,
    wrist_of,
)
from gestureapp.robot.values import Direction, Position, Refusal

Range = tuple[float, float]

AXIS_NAMES = ("S", "L", "U", "R", "B", "T")
STEP_MM = 20.0
STEP_DEG = 2.0
FINE_MM = 0.05
FINE_DEG = 0.02
"""The place of a limit is known this well; the end lies before it."""
JUMP_DEG = 60.0
"""No joint turns so far in one step while the margins are kept: it would be another branch."""
STANDING = 0.5
"""A robot that stands at the end of its last move may read this much beyond a limit, deg or mm."""
_WORSE = 1e-6


@dataclass(frozen=True, slots=True)
class ArmLimits:
    """What the joints may do.

    Attributes:
        tool_mm: Tool centre point seen from the flange.
        ranges_deg: Lowest and highest S, L, U, R, B, T, in the zeros of ``hp6``.
        joint_margin_deg: How far from the ends of the ranges the joints stay.
        wrist_margin_deg: How far B stays from zero, where R and T turn about one line.
        elbow_margin_deg: How far the elbow stays from stretched and from folded.
        shoulder_margin_mm: How far the wrist centre stays from the S axis.

    Raises:
        ValueError: a range is empty, or a margin is not above zero.
    """

    tool_mm: Vector
    ranges_deg: tuple[Range, Range, Range, Range, Range, Range]
    joint_margin_deg: float
    wrist_margin_deg: float
    elbow_margin_deg: float
    shoulder_margin_mm: float

    def __post_init__(self) -> None:
        margins = (self.wrist_margin_deg, self.elbow_margin_deg, self.shoulder_margin_mm)
        # Singular places are kept away from by more than a standing robot may be beyond a margin.
        if not all(STANDING < margin < math.inf for margin in margins):
            raise ValueError(f"margins of the arm must be above {STANDING}")
        if not 0 <= self.joint_margin_deg < math.inf:
            raise ValueError("the margin of the joints must not be below zero")
        if not all(low + 2 * self.joint_margin_deg < high for low, high in self.ranges_deg):
            raise ValueError("a range of a joint must be wider than its margins")
        if not all(map(math.isfinite, self.tool_mm)):
            raise ValueError("the tool's offset must be numbers")


@dataclass(frozen=True, slots=True)
class Reach:
    """How far the arm goes.

    Attributes:
        length: mm, or degrees of a rotation.
        limited_by: What ends it, in words; empty when it goes all the way.
    """

    length: float
    limited_by: str = ""


def find_arm_limit(position: Position, limits: ArmLimits) -> Refusal | None:
    """Why no increment may start here: the arm is beyond a limit of its own."""
    wrist_at, joints = _standing(position, limits)
    rooms = _rooms(joints, wrist_at[0], limits)
    worst = min(range(len(rooms)), key=rooms.__getitem__)
    if rooms[worst] >= -STANDING:
        return None
    asked = f"{-rooms[worst]:.1f} {'mm' if worst == _SHOULDER else 'deg'} too far"
    text = f"the arm stands beyond a limit of its own, {asked}: {_NAMES[worst]}"
    return Refusal("arm_limit", text, asked, _NAMES[worst])


def reach_along(
    position: Position, direction: Direction, length: float, limits: ArmLimits
) -> Reach:
    """How far the arm can follow, at most so far.

    Args:
        position: Start; within the limits, as `find_arm_limit` has it.
        direction: Along or about an axis; a rotation changes one angle and keeps the tool's point.
        length: As far as the field allows; mm, or degrees of a rotation.
        limits: Of the arm.
    """
    step, fine = (STEP_DEG, FINE_DEG) if direction.is_rotation else (STEP_MM, FINE_MM)
    walk = _Walk(position, direction, limits)
    gone, stride, doubtful = 0.0, step, math.inf
    while gone < length:
        ahead = min(gone + stride, length)
        failed = walk.go(ahead)
        if failed is None:
            gone = ahead
            if gone >= doubtful:  # a joint only turned fast there
                stride, doubtful = step, math.inf
        elif ahead - gone <= fine:
            return Reach(gone, failed)
        else:
            stride, doubtful = (ahead - gone) / 2, ahead
    return Reach(length)


_WristAt = tuple[Vector, Matrix]
"""Wrist centre and tool axes."""
_NAMES = (
    *(f"axis {name} limit" for name in AXIS_NAMES),
    "wrist limit (nearly straight)",
    "elbow nearly stretched",
    "elbow nearly folded",
    "shoulder limit (wrist over the base)",
)
_SHOULDER = len(_NAMES) - 1
_JUMP = "wrist limit (it would have to swing round)"


class _Walk:
    """The arm on its way along a line, in one branch. Owned by the caller of `reach_along`."""

    def __init__(self, position: Position, direction: Direction, limits: ArmLimits) -> None:
        self._limits = limits
        self._pose = position.pose
        self._direction = direction
        self._start, self._joints = _standing(position, limits)
        self._branch: Branch = branch_of(self._joints)
        rooms = _rooms(self._joints, self._start[0], limits)
        self._least = tuple(min(0.0, room) - _WORSE for room in rooms)

    def go(self, ahead: float) -> str | None:
        """Go on to a place on the line; or why it cannot, and stay."""
        wrist, tool = self._at(ahead)
        joints = _nearest(solve(wrist, tool, self._branch), self._joints)
        for i, room in enumerate(_rooms(joints, wrist, self._limits)):
            if room < self._least[i]:
                return _NAMES[i]
        if any(abs(a - b) > JUMP_DEG for a, b in zip(joints, self._joints, strict=True)):
            return _JUMP
        self._joints = joints
        return None

    def _at(self, ahead: float) -> _WristAt:
        sx, sy, sz = self._direction.unit
        if not self._direction.is_rotation:
            (x, y, z), tool = self._start
            return (x + sx * ahead, y + sy * ahead, z + sz * ahead), tool
        rx, ry, rz = self._pose.rotation_deg
        tool = rotation(rx + sx * ahead, ry + sy * ahead, rz + sz * ahead)
        return wrist_of(self._pose.position_mm, tool, self._limits.tool_mm), tool


def _standing(position: Position, limits: ArmLimits) -> tuple[_WristAt, Joints]:
    pose = position.pose
    tool = rotation(*pose.rotation_deg)
    wrist = wrist_of(pose.position_mm, tool, limits.tool_mm)
    return (wrist, tool), joints_deg(pose, limits.tool_mm, position.posture)


def _nearest(joints: Joints, before: Joints) -> Joints:
    """The same directions, as few turns as possible from where the joints were."""
    s, lower, upper, r, b, t = joints
    return (
        before[0] + math.remainder(s - before[0], 360.0),
        lower,
        upper,
        before[3] + math.remainder(r - before[3], 360.0),
        b,
        before[5] + math.remainder(t - before[5], 360.0),
    )


def _rooms(joints: Joints, wrist: Vector, limits: ArmLimits) -> tuple[float, ...]:
    """How far each limit is away, below zero beyond it; in the order of the names, deg and mm."""
    margin = limits.joint_margin_deg
    ranges = zip(joints, limits.ranges_deg, strict=True)
    kink = abs(normal_deg(joints[2] - STRETCHED_DEG))
    return (
        *[min(at - low, high - at) - margin for at, (low, high) in ranges],
        abs(joints[4]) - limits.wrist_margin_deg,
        kink - limits.elbow_margin_deg,
        180.0 - kink - limits.elbow_margin_deg,
        math.hypot(wrist[0], wrist[1]) - limits.shoulder_margin_mm,
    )
