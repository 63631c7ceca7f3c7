"""What the controller has said last, and how old that is. Pure."""

from dataclasses import dataclass

from gestureapp.robot.values import Pose, RobotStatus


@dataclass(slots=True)
class Readings:
    """The newest answers. Owned by the supervisor.

    Attributes:
        status: Last RSTATS, or None.
        status_s: When it came.
        alarms: Codes of the last RALARM, empty while the state tells of none.
        pose: Last RPOSC, or None.
        pose_s: When it came.
    """

    status: RobotStatus | None = None
    status_s: float = float("-inf")
    alarms: tuple[int, ...] = ()
    pose: Pose | None = None
    pose_s: float = float("-inf")

    @property
    def is_held_by_command(self) -> bool:
        """HOLD 1 is on, as far as is known."""
        return self.status is not None and self.status.is_held_by_command
