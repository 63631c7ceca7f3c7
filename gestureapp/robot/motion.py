"""The one open command: from the bytes sent to "reached" or "stopped short", read back. Pure.

``0000`` means accepted, not finished, and "running" may rise a little after it. So a move has ended
when the controller, asked after the acceptance, says not running, and either it was seen running,
or the target is reached, or it still says so after it has had time enough to start.
"""

from dataclasses import dataclass

from gestureapp.robot import messages as m
from gestureapp.robot.gate import Command
from gestureapp.robot.stopping import is_same_place
from gestureapp.robot.values import Pose, RobotStatus, StopReason

START_LIMIT_S = 0.3
"""A move that was accepted shows as running within this, or it never began."""
OVERDUE_FACTOR = 1.5
OVERDUE_S = 3.0
"""A move may take this much longer than length over speed: ramps, and the controller's override."""
TARGET_MM = 0.5
TARGET_DEG = 0.2
"""This close is there: the NX100 reads back 3 decimals of mm and 2 of degrees."""


@dataclass(frozen=True, slots=True)
class Reached:
    """The increment has come to its end."""

    pose: Pose


@dataclass(frozen=True, slots=True)
class StoppedShort:
    """The robot stands before the end, or does not come to it, though nobody stopped it."""

    reason: StopReason
    text: str


class Motion:
    """The open command. Owned by the supervisor.

    Attributes:
        command: What was let through.
        sent_s: When its header went out.
        seems_ended: The last two positions are one: ask whether it still runs.
    """

    def __init__(self, command: Command, sent_s: float) -> None:
        self.command = command
        self.sent_s = sent_s
        self.seems_ended = False
        self._accepted_s: float | None = None
        self._was_running = False
        self._idle_asked_s: float | None = None
        self._pose: Pose | None = None
        self._pose_asked_s = float("-inf")

    @property
    def activation_id(self) -> int:
        """Whose increment it is."""
        return self.command.proposal.activation_id

    @property
    def report(self) -> m.CommandSent:
        """What went out, not what was wanted."""
        planned, command = self.command.plan, self.command
        return m.CommandSent(
            self.activation_id,
            self.sent_s,
            planned.start,
            planned.increment,
            planned.limited_by,
            command.speed,
            command.proposal.direction.is_rotation,
        )

    def accepted(self, now_s: float) -> None:
        """The controller has said ``0000``."""
        self._accepted_s = now_s

    def note_status(self, status: RobotStatus, asked_s: float) -> None:
        """A status that was asked for at this time."""
        if self._accepted_s is None or asked_s < self._accepted_s:
            return
        if status.is_running:
            self._was_running = True
            self._idle_asked_s = None
        else:
            self._idle_asked_s = asked_s

    def note_pose(self, pose: Pose, asked_s: float) -> None:
        """A position that was asked for at this time."""
        self.seems_ended = self._pose is not None and is_same_place(self._pose, pose)
        self._pose, self._pose_asked_s = pose, asked_s

    def check(self, now_s: float) -> Reached | StoppedShort | None:
        """Has it come to an end?"""
        if self._accepted_s is None:
            return None
        if now_s - self._accepted_s > self.command.duration_s * OVERDUE_FACTOR + OVERDUE_S:
            text = f"the move takes longer than {now_s - self._accepted_s:.1f} s"
            return StoppedShort(StopReason.CELL_FAULT, text)
        if self._pose is None or self._idle_asked_s is None:
            return None
        if self._pose_asked_s < self._idle_asked_s:
            return None
        missing = self._missing(self._pose)
        if not missing:
            return Reached(self._pose)
        if not self._was_running and self._idle_asked_s - self._accepted_s < START_LIMIT_S:
            return None
        return StoppedShort(StopReason.ROBOT_CHANGED, f"the robot stands {missing} before the end")

    def _missing(self, pose: Pose) -> str:
        end = self.command.plan.end
        lengths = [abs(p - q) for p, q in zip(end.position_mm, pose.position_mm, strict=True)]
        turns = zip(end.rotation_deg, pose.rotation_deg, strict=True)
        angles = [abs((p - q + 180) % 360 - 180) for p, q in turns]
        if max(lengths) > TARGET_MM:
            return f"{max(lengths):.1f} mm"
        return f"{max(angles):.1f} deg" if max(angles) > TARGET_DEG else ""
