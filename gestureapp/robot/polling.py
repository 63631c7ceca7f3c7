"""What to read from the controller, and how often, while nothing more urgent waits. Pure.

A stop waits for one outstanding answer at the most. RSTATS is the slow one on controllers that
pause before it, so a moving robot is followed by its position: whoever stops it, it stops changing,
and then its state is read at once. While the cell decides what a gesture was, RSTATS is left out
altogether: a move would wait behind it. Missed reads are never caught up.
"""

from enum import Enum

from gestureapp.robot import nx100
from gestureapp.robot.nx100 import Request


class Pace(Enum):
    """Seconds between reads of state and of position."""

    IDLE = (0.3, 0.25)
    ARMED = (0.25, 0.1)
    DECIDING = (float("inf"), 0.05)
    WATCHING = (0.1, 0.1)
    MOVING = (2.5, 0.05)
    ENDING = (0.1, 0.05)

    @property
    def status_s(self) -> float:
        """Between two RSTATS."""
        return self.value[0]

    @property
    def pose_s(self) -> float:
        """Between two RPOSC."""
        return self.value[1]


class Polling:
    """When the reads are due. Owned by the supervisor."""

    def __init__(self, frame: int) -> None:
        self._read_pose = nx100.read_pose(frame)
        self.restart()

    def restart(self) -> None:
        """A new session: everything is due."""
        self._status_s = float("-inf")
        self._pose_s = float("-inf")
        self._wants_alarms = False

    def want_alarms(self) -> None:
        """The state tells of an alarm: ask which."""
        self._wants_alarms = True

    def want_status(self) -> None:
        """The position changes unasked: read the state at once."""
        self._status_s = float("-inf")

    def next_request(self, now_s: float, pace: Pace) -> Request | None:
        """The read that is due, the state before the position, or None."""
        if self._wants_alarms:
            self._wants_alarms = False
            return nx100.READ_ALARMS
        if now_s - self._status_s >= pace.status_s:  # inf >= inf: one that is wanted goes always
            self._status_s = now_s
            return nx100.READ_STATUS
        if now_s - self._pose_s >= pace.pose_s:
            self._pose_s = now_s
            return self._read_pose
        return None
