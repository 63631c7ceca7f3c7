"""The emulated arm on its way: which joints a path needs, and where it can go no farther. Pure.

An arm that is told to go along a line keeps its branch: it cannot swing its elbow or wrist over
while the tool stays on the line. So the joints are followed from the first place to the last.
"""

import math
from dataclasses import dataclass

from gestureapp.robot import hp6
from gestureapp.robot.hp6 import Joints
from gestureapp.robot.values import Pose
from gestureapp.simulation.nx100_motion import Path

Ranges = tuple[tuple[float, float], ...]

_STEP_MM = 10.0
_STEP_DEG = 1.0
_SLACK = 1e-6
"""So that a robot standing exactly on its limit can still move back from it; deg or mm."""
_SWING_DEG = 90.0
"""A joint that turned so far between two neighbouring places would have to be infinitely fast."""
_HALVINGS = 40


@dataclass(frozen=True, slots=True)
class Arm:
    """What the emulated arm is like.

    Attributes:
        tool_mm: Tool centre point seen from the flange.
        ranges_deg: Lowest and highest S, L, U, R, B, T.
    """

    tool_mm: hp6.Vector
    ranges_deg: Ranges

    def joints_at(self, pose: Pose, before: Joints) -> Joints:
        """Give the joints at a pose in the branch of other ones, as few turns away as possible."""
        tool = hp6.rotation(*pose.rotation_deg)
        wrist = hp6.wrist_of(pose.position_mm, tool, self.tool_mm)
        solved = hp6.solve(wrist, tool, hp6.branch_of(before))
        s, lower, upper, r, b, t = (
            was + math.remainder(now - was, 360.0) for now, was in zip(solved, before, strict=True)
        )
        return (s, lower, upper, r, b, t)

    def rooms(self, pose: Pose, joints: Joints) -> tuple[float, ...]:
        """Give how far every limit is away, below zero beyond it: six joints, and the reach, mm."""
        x, y, z = hp6.wrist_mm(pose, self.tool_mm)
        out = math.hypot(x, y) * (-1.0 if hp6.branch_of(joints).is_back else 1.0)
        from_shoulder = math.hypot(out - hp6.SHOULDER_OUT_MM, z)
        ranges = zip(joints, self.ranges_deg, strict=True)
        stretched = hp6.LOWER_ARM_MM + hp6.ELBOW_TO_WRIST_MM
        return (
            *(min(at - low, high - at) for at, (low, high) in ranges),
            stretched - from_shoulder,
        )


@dataclass(frozen=True, slots=True)
class Travel:
    """A path and the arm that goes along it.

    Attributes:
        path: Of the tool.
        arm: What goes along.
        trace: Fractions of the path, and the joints there, in order.
        limit: The fraction at which the arm can go no farther; infinity when it goes all the way.
    """

    path: Path
    arm: Arm
    trace: tuple[tuple[float, Joints], ...]
    limit: float

    @classmethod
    def of(cls, path: Path, arm: Arm, joints: Joints) -> "Travel":
        """Follow the arm along a path from where its joints are.

        Note:
            A robot that stands beyond a limit already may move as long as it does not get farther
            beyond it.
        """
        step = path.increment
        length_mm, turn_deg = math.hypot(*step.translation_mm), math.hypot(*step.rotation_deg)
        n = 1 + math.ceil(max(length_mm / _STEP_MM, turn_deg / _STEP_DEG))
        rooms = arm.rooms(path.pose_at(0.0), joints)
        least = tuple(min(0.0, room) - _SLACK for room in rooms)
        trace, limit = [(0.0, joints)], math.inf
        for i in range(1, n + 1):
            low, at = trace[-1][0], cls._follow(path, arm, i / n, trace[-1][1], least)
            if at is None:
                limit = cls._narrow(path, arm, (low, i / n), trace[-1][1], least)
                break
            trace.append((i / n, at))
        return cls(path, arm, tuple(trace), limit)

    def joints_at(self, fraction: float) -> Joints:
        """Give the joints at a fraction of the path."""
        before = [joints for at, joints in self.trace if at <= fraction] or [self.trace[0][1]]
        return self.arm.joints_at(self.path.pose_at(fraction), before[-1])

    @staticmethod
    def _follow(
        path: Path, arm: Arm, fraction: float, before: Joints, least: tuple[float, ...]
    ) -> Joints | None:
        pose = path.pose_at(fraction)
        joints = arm.joints_at(pose, before)
        rooms = arm.rooms(pose, joints)
        is_within = all(room >= low for room, low in zip(rooms, least, strict=True))
        swings = any(abs(a - b) > _SWING_DEG for a, b in zip(joints, before, strict=True))
        return joints if is_within and not swings else None

    @classmethod
    def _narrow(
        cls,
        path: Path,
        arm: Arm,
        span: tuple[float, float],
        before: Joints,
        least: tuple[float, ...],
    ) -> float:
        inside, outside = span
        for _ in range(_HALVINGS):
            middle = 0.5 * (inside + outside)
            joints = cls._follow(path, arm, middle, before, least)
            if joints is None:
                outside = middle
            else:
                inside, before = middle, joints
        return inside
