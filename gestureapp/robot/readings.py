"""What the controller has said last, and how old that is. Pure."""

from dataclasses import dataclass

from gestureapp.robot import messages as m
from gestureapp.robot.stopping import is_same_place
from gestureapp.robot.values import Position, RobotStatus


@dataclass(slots=True)
class Readings:
    """The newest answers. Owned by the supervisor.

    Attributes:
        status: Last RSTATS, or None.
        status_s: When it came.
        alarms: Codes of the last RALARM, empty while the state tells of none.
        position: Last RPOSC, or None.
        position_s: When it came.
    """

    status: RobotStatus | None = None
    status_s: float = float("-inf")
    alarms: tuple[int, ...] = ()
    position: Position | None = None
    position_s: float = float("-inf")

    @property
    def is_held_by_command(self) -> bool:
        """HOLD 1 is on, as far as is known."""
        return self.status is not None and self.status.is_held_by_command

    @property
    def wants_alarms(self) -> bool:
        """The state tells of an alarm or error, and which is not known yet."""
        status = self.status
        return status is not None and (status.has_alarm or status.has_error) and not self.alarms

    def take_status(self, status: RobotStatus, now_s: float) -> None:
        """Another state has come."""
        self.status, self.status_s = status, now_s
        if not (status.has_alarm or status.has_error):
            self.alarms = ()

    def take_position(self, position: Position, now_s: float) -> bool:
        """Another position has come; whether it is another place than the one before."""
        before = self.position
        has_moved = before is not None and not is_same_place(before.pose, position.pose)
        self.position, self.position_s = position, now_s
        return has_moved

    def report(self, now_s: float) -> m.StatusReport | None:
        """For the application; None before the first state."""
        status = self.status
        if status is None:
            return None
        return m.StatusReport(now_s, status.data_1, status.data_2, self.alarms)
