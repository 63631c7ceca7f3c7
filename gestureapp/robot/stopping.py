"""The one stop path: from "stop" to "stands, and that was read back". Pure.

HOLD first, repeated until standstill has been read back; servo off when that takes too long; a word
to the operator when it is still not confirmed after that. Whoever asks, for whatever reason, goes
through here.
"""

from dataclasses import dataclass

from gestureapp.robot import nx100
from gestureapp.robot.nx100 import Answer, Done, Failure, Request
from gestureapp.robot.values import Pose, Position, RobotStatus, StopReason

REPEAT_S = 0.25
"""HOLD is sent again this often while the robot is not known to stand."""
READS = 2
"""State and position are read between two stops, however slow the answers are: a controller that
needs longer than the repeat could otherwise never confirm, and servo off would never get a turn."""
ESCALATE_S = 0.6
"""Still moving after this: servo off."""
SLOWING_S = 0.3
"""HOLD from 250 mm/s takes about this on the emulator: a HOLD that could only be sent late, on a
new session, has so much time before servo off."""
UNCONFIRMED_S = 1.0
"""No standstill read back after this: the operator is told to use the hardware."""
STILL_MM = 0.05
STILL_DEG = 0.05
STILL_APART_S = 0.02
"""Two positions this far apart in time and this close in space are a standstill."""
UNHELD_S = 0.3
"""A controller that refuses HOLD must be seen not running for this long instead: the running bit
may rise late after an accepted move."""


@dataclass(frozen=True, slots=True)
class Standstill:
    """The robot stands: read back from the controller."""

    reason: StopReason
    took_s: float
    pose: Pose


@dataclass(frozen=True, slots=True)
class Unconfirmed:
    """The robot has not confirmed a stop in time. Said once per stop."""

    reason: StopReason
    text: str


@dataclass(slots=True)
class _Evidence:
    """What is known since the stop was asked for."""

    first_hold_s: float = float("inf")
    hold_sent_s: float = float("-inf")
    servo_off_sent_s: float = float("-inf")
    is_held: bool = False
    refusal: str = ""
    not_running_since_s: float | None = None
    newest: tuple[Pose, float] | None = None
    still: Pose | None = None
    read_pose_next: bool = False
    n_reads: int = READS
    n_told: int = 0
    counts: bool = False
    told: bool = False


class StopPath:
    """One stop at a time. Owned by the supervisor.

    Attributes:
        reason: Of the stop under way, or None.
        asked_s: When it was asked for.
    """

    def __init__(self) -> None:
        self.reason: StopReason | None = None
        self.asked_s = 0.0
        self._seen = _Evidence()

    @property
    def is_active(self) -> bool:
        """A stop is under way and standstill has not been read back."""
        return self.reason is not None

    def ask(self, reason: StopReason, now_s: float) -> bool:
        """Stop. True when this is news: a new stop, or a latched reason over the left arm's."""
        if self.reason is None:
            self._seen = _Evidence()
            self.reason, self.asked_s = reason, now_s
            return True
        if reason.is_latched and not self.reason.is_latched:
            self.reason = reason
            return True
        return False

    def next_request(self, now_s: float, frame: int) -> Request:
        """What to send next while the stop is under way."""
        if (urgent := self._urgent_request(now_s)) is not None:
            return urgent
        self._seen.read_pose_next = not self._seen.read_pose_next
        return nx100.read_pose(frame) if self._seen.read_pose_next else nx100.READ_STATUS

    def may_wait(self, now_s: float) -> bool:
        """Something small may go before: no stop is under way, or one that only reads by now."""
        if not self.is_active:
            return True
        return self._urgent_request(now_s) is None and not self._seen.told

    def sent(self, request: Request, now_s: float) -> None:
        """A request has gone out."""
        self._seen.counts = True
        if request == nx100.HOLD_ON:
            self._seen.first_hold_s = min(self._seen.first_hold_s, now_s)
            self._seen.hold_sent_s, self._seen.n_reads = now_s, 0
        elif request == nx100.SERVO_OFF:
            self._seen.servo_off_sent_s, self._seen.n_reads = now_s, 0
        elif request.name in ("RSTATS", "RPOSC"):
            self._seen.n_reads += 1

    def answered(self, request: Request, answer: Answer, now_s: float) -> None:
        """An answer has come; only what was asked after the stop counts."""
        if self.reason is None or not self._seen.counts:
            return
        if request.is_hold:
            self._seen.is_held = self._seen.is_held or isinstance(answer, Done)
            if isinstance(answer, Failure):
                self._seen.refusal = answer.words
        elif isinstance(answer, RobotStatus):
            self._note_status(answer, now_s)
        elif isinstance(answer, Position):
            self._note_pose(answer.pose, now_s)

    def link_broken(self) -> None:
        """The line was lost: HOLD is the first request on the next one, and nothing is known."""
        self._seen.hold_sent_s = self._seen.servo_off_sent_s = float("-inf")
        self._seen.first_hold_s = float("inf")
        self._seen.n_reads, self._seen.n_told = READS, 0
        self._seen.is_held = False
        self._seen.not_running_since_s = None
        self._seen.still = None

    def check(self, now_s: float) -> Standstill | Unconfirmed | None:
        """Has the robot confirmed, or has it failed to for too long?"""
        if self.reason is None:
            return None
        if self._stands(now_s) and self._seen.still is not None:
            confirmed = Standstill(self.reason, now_s - self.asked_s, self._seen.still)
            self.reason = None
            return confirmed
        if now_s - self.asked_s >= UNCONFIRMED_S and not self._seen.told:
            self._seen.told = True
            why = f" ({self._seen.refusal})" if self._seen.refusal else ""
            text = f"no standstill read back for {now_s - self.asked_s:.1f} s{why}"
            return Unconfirmed(self.reason, text)
        return None

    def _urgent_request(self, now_s: float) -> Request | None:
        seen = self._seen
        if now_s - seen.hold_sent_s >= REPEAT_S and seen.n_reads >= READS:
            return nx100.HOLD_ON
        if now_s - seen.servo_off_sent_s >= REPEAT_S and self._must_escalate(now_s):
            return nx100.SERVO_OFF
        return None

    def _must_escalate(self, now_s: float) -> bool:
        """HOLD has had its time, and was refused or did not bring the robot to a stand."""
        seen = self._seen
        if now_s - self.asked_s < ESCALATE_S or now_s - seen.first_hold_s < SLOWING_S:
            return False
        is_running = seen.n_told >= READS and seen.not_running_since_s is None
        return not seen.is_held or is_running or seen.n_told >= 2 * READS

    def _note_status(self, status: RobotStatus, now_s: float) -> None:
        self._seen.n_told += 1
        if status.is_running:
            self._seen.not_running_since_s = None
            self._seen.still = None
        elif self._seen.not_running_since_s is None:
            self._seen.not_running_since_s = now_s

    def _note_pose(self, pose: Pose, now_s: float) -> None:
        self._seen.n_told += 1
        if self._seen.newest is None:
            self._seen.newest = (pose, now_s)
            return
        before, at_s = self._seen.newest
        if not is_same_place(before, pose):
            self._seen.still = None
            self._seen.newest = (pose, now_s)
        elif now_s - at_s >= STILL_APART_S:
            self._seen.still = pose

    def _stands(self, now_s: float) -> bool:
        if self._seen.not_running_since_s is None:
            return False
        return self._seen.is_held or now_s - self._seen.not_running_since_s >= UNHELD_S


def is_same_place(a: Pose, b: Pose) -> bool:
    """Whether two poses differ by less than a standing robot's read-back does."""
    lengths = zip(a.position_mm, b.position_mm, strict=True)
    angles = zip(a.rotation_deg, b.rotation_deg, strict=True)
    return all(abs(p - q) <= STILL_MM for p, q in lengths) and all(
        abs((p - q + 180) % 360 - 180) <= STILL_DEG for p, q in angles
    )
