"""Releasing a hold: position read first, HOLD 0, then read back that nothing is held. Pure.

Whether HOLD 0 resumes an interrupted move is documented nowhere. So for a while after it the state
is read often, and the supervisor holds again when the robot runs without a new command.
"""

from enum import Enum

from gestureapp.robot import nx100
from gestureapp.robot.nx100 import Answer, Failure, Request
from gestureapp.robot.values import RobotStatus

WATCH_S = 0.5
"""How long after the release the state is read often."""
RETRY_S = 0.5
"""A release that failed is not tried again before this: reading the state must get its turn."""


class _Phase(Enum):
    NONE = 0
    READ_POSE = 1
    SEND = 2
    READ_BACK = 3


_AWAITED = {_Phase.READ_POSE: "RPOSC", _Phase.SEND: "HOLD", _Phase.READ_BACK: "RSTATS"}


class Release:
    """One release at a time. Owned by the supervisor."""

    def __init__(self) -> None:
        self._phase = _Phase.NONE
        self._released_s = float("-inf")
        self._failed_s = float("-inf")
        self._is_done = False

    @property
    def is_active(self) -> bool:
        """The hold is being released and that was not read back yet."""
        return self._phase is not _Phase.NONE

    def is_watching(self, now_s: float) -> bool:
        """Released a moment ago: a robot that runs now does so without a command."""
        return now_s - self._released_s < WATCH_S

    def may_resume(self, now_s: float) -> bool:
        """A robot that runs now goes on with what the hold has interrupted."""
        return self.is_active or self.is_watching(now_s)

    def may_begin(self, now_s: float) -> bool:
        """None is under way, and none has failed a moment ago."""
        return not self.is_active and now_s - self._failed_s >= RETRY_S

    def begin(self) -> None:
        """Release the hold."""
        self._phase = _Phase.READ_POSE

    def cancel(self) -> None:
        """A stop goes before."""
        self._phase = _Phase.NONE

    def next_request(self, frame: int) -> Request | None:
        """What to send next, or None while nothing is to be released."""
        return {
            _Phase.READ_POSE: nx100.read_pose(frame),
            _Phase.SEND: nx100.HOLD_OFF,
            _Phase.READ_BACK: nx100.READ_STATUS,
        }.get(self._phase)

    def answered(self, request: Request, answer: Answer, now_s: float) -> None:
        """An answer has come."""
        is_refused = isinstance(answer, Failure)
        if request == nx100.HOLD_OFF and not is_refused:
            self._released_s = now_s  # also when a stop or a disarm has come between
        if request.name != _AWAITED.get(self._phase):
            return
        if is_refused:
            self._fail(now_s)
        elif self._phase is _Phase.READ_POSE:
            self._phase = _Phase.SEND
        elif self._phase is _Phase.SEND:
            self._phase = _Phase.READ_BACK
        elif isinstance(answer, RobotStatus) and not answer.is_held_by_command:
            self._phase, self._is_done = _Phase.NONE, True
        else:
            self._fail(now_s)

    def _fail(self, now_s: float) -> None:
        self._phase = _Phase.NONE
        self._failed_s = now_s

    def take_done(self) -> bool:
        """Whether a release has just been read back; says so once."""
        is_done, self._is_done = self._is_done, False
        return is_done
