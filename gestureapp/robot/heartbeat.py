"""Controller-side supervision: a network input that is toggled while all is well. Pure.

A ladder on the controller times the edges of that input and drives external hold when they cease,
so that a robot is held though application, guardian, computer or network are gone. Off unless the
site names an input.

How it keeps out of the way: a toggle goes before a read that is due, never before a stop, a command
or the line that is kept free for one. One that is overdue goes between two reads of a stop, between
the steps of a release, and while a gesture is decided. The left arm's start brings the next one
forward, as nothing can have been decided yet. With a period of 200 ms and 50 ms for each answer the
edges stay less than 500 ms apart; those missed are never caught up.
"""

from gestureapp.robot import nx100
from gestureapp.robot.beats import Beats
from gestureapp.robot.nx100 import Answer, Failure, Request
from gestureapp.robot.release import Release
from gestureapp.robot.stopping import StopPath
from gestureapp.robot.values import Refusal, RobotStatus

WORKS_S = 1.0
"""The input counts as toggled while the controller has taken a toggle within this."""
RETRY_S = 5.0
"""After a session that ended over a toggle: a controller without IOWRITE may end it each time."""


class Heartbeat:
    """Which value the input gets next, and when. Owned by the supervisor.

    Args:
        first: The byte's first input, its only toggled one; 0 for none.
        rate_hz: Toggles a second.
    """

    def __init__(self, first: int, rate_hz: float) -> None:
        self._input = first
        self._period_s = 1.0 / rate_hz
        self._value = 1
        self._sent_s = float("-inf")
        self._taken_s = float("-inf")
        self._retry_s = float("-inf")
        self._trouble = ""

    def next_request(
        self,
        now_s: float,
        beats: Beats,
        stop: StopPath,
        release: Release,
        status: RobotStatus | None,
    ) -> Request | None:
        """What to send when the line is free, or None.

        Args:
            now_s: Monotonic clock.
            beats: Of the application: without fresh ones nothing is toggled.
            stop: While it holds, switches or is overdue nothing is toggled.
            release: Its steps may be parted.
            status: As last read. A robot that is held externally is held by command first: when
                the ladder lets go of it, a controller may go on with an interrupted move.
        """
        if not self._input or status is None or now_s < self._retry_s:
            return None
        patience = beats.patience(now_s, is_busy=stop.is_active or release.is_active)
        if now_s - self._sent_s < patience.value * self._period_s:
            return None
        if not beats.is_application_fresh(now_s) or not stop.may_wait(now_s):
            return None
        request = nx100.write_input(self._input, self._value)
        if status.is_held_externally and not status.is_held_by_command:
            if stop.is_active:
                return None
            request = nx100.HOLD_ON
        self._sent_s = now_s
        return request

    def answered(self, request: Request, answer: Answer, now_s: float) -> None:
        """An answer has come. A refused value is tried again, as the input did not change."""
        if request.name != "IOWRITE":
            return
        if isinstance(answer, Failure):
            self._trouble = f"the robot refused {request}: {answer.words}"
            self._taken_s = float("-inf")
        else:
            self._trouble = ""
            self._taken_s = now_s
            self._value ^= 1

    def link_broken(self, request: Request | None, reason: str, now_s: float) -> None:
        """The session has ended, over this request."""
        self._taken_s = float("-inf")
        if request is not None and request.name == "IOWRITE":
            self._trouble = reason
            self._retry_s = now_s + RETRY_S

    def find_trouble(self, now_s: float) -> Refusal | None:
        """Why it stands against arming: it is wanted and does not work."""
        if not self._input or now_s - self._taken_s <= WORKS_S:
            return None
        why = self._trouble or f"#{self._input} is not toggled"
        return Refusal("supervision", f"controller supervision does not work: {why}")
