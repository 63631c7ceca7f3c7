"""What makes the guardian stop by itself: silence, the left arm, a robot that changes. Pure.

Ages are taken on the monotonic clock that all processes of a machine share; a time in the future is
as bad as an old one.
"""

from dataclasses import dataclass

from gestureapp.robot.gate import AHEAD_S, Limits, robot_blocker
from gestureapp.robot.messages import Beat
from gestureapp.robot.values import RobotStatus, StopReason

TICK_S = 0.005
IDLE_TICK_S = 0.02
"""How often the clocks are looked at while something may move, and otherwise."""
JUST_OVER_S = 0.0002
"""A watchdog trips above its limit, not on it."""


@dataclass(frozen=True, slots=True)
class Cause:
    """Why to stop, in words for a person."""

    reason: StopReason
    text: str


def find_stall(stalled_s: float, limits: Limits) -> Cause | None:
    """Whether this process itself was kept from running: nobody watched the arm meanwhile."""
    limit_s = limits.trip_level_s
    if stalled_s <= limit_s:
        return None
    reason = StopReason.COMPUTER_STALLED
    return Cause(reason, _too_long(reason, stalled_s, limit_s))


def find_stale(beat: Beat, limits: Limits, now_s: float) -> Cause | None:
    """The first thing that is too old, the left sensor before the rest.

    A left sensor that is not heard because the application does not run is told as what it is.
    """
    trip_s, silent_s = limits.trip_level_s, now_s - beat.control_s
    if now_s - beat.left_s > trip_s and trip_s / 2 < silent_s <= limits.control_limit_s:
        reason = StopReason.APPLICATION_STALLED
        text = f"{reason.value} for {silent_s * 1000:.0f} ms; the left sensor may be silent for"
        return Cause(reason, f"{text} {trip_s * 1000:.0f} ms at most")
    for t_s, limit_s, reason in (
        (beat.left_s, limits.trip_level_s, StopReason.LEFT_SILENT),
        (beat.control_s, limits.control_limit_s, StopReason.APPLICATION_STALLED),
        (beat.gui_s, limits.gui_limit_s, StopReason.WINDOW_STALE),
    ):
        age_s = now_s - t_s
        if not -AHEAD_S <= age_s <= limit_s:
            return Cause(reason, _too_long(reason, age_s, limit_s))
    return None


def _too_long(reason: StopReason, age_s: float, limit_s: float) -> str:
    return f"{reason.value} for {age_s * 1000:.0f} ms, limit {limit_s * 1000:.0f} ms"


def next_look_s(beat: Beat | None, limits: Limits, now_s: float, *, may_move: bool) -> float:
    """When the clocks have to be looked at again, if nothing new comes; monotonic seconds."""
    if not may_move:
        return now_s + IDLE_TICK_S
    if beat is None:
        return now_s + TICK_S
    stale_s = JUST_OVER_S + min(
        beat.left_s + limits.trip_level_s,
        beat.control_s + limits.control_limit_s,
        beat.gui_s + limits.gui_limit_s,
    )
    return min(now_s + TICK_S, stale_s) if stale_s > now_s else now_s + TICK_S


def find_left_end(beat: Beat, limits: Limits, *, is_test: bool = False) -> Cause | None:
    """Whether the left arm ends a move: in hold-to-run by leaving start, else by taking stop.

    For a stop test it rests: leaving stop ends it, latched.
    """
    if is_test:
        text = "the left arm left the stop posture"
        return None if beat.is_left_stop else Cause(StopReason.STOP_TEST, text)
    if beat.is_left_stop or (limits.is_hold_to_run and not beat.is_left_start):
        return Cause(StopReason.LEFT_ARM, "the left arm stopped it")
    return None


def find_change(
    status: RobotStatus, *, is_commanded: bool, may_move: bool, may_resume: bool
) -> Cause | None:
    """Whether the robot does something nobody asked for, or can no longer do what was asked.

    Args:
        status: As just read.
        is_commanded: A move of ours is open.
        may_move: Armed, or a move is open.
        may_resume: A hold is being or was just released.
    """
    if status.is_running and not is_commanded and (may_move or may_resume):
        text = "the robot runs without a command of ours; it is held again"
        if may_resume:
            text = "the robot went on when its hold was released; it is held again"
        return Cause(StopReason.UNEXPECTED_MOTION, text)
    if not may_move:
        return None
    if status.has_alarm or status.has_error:
        return Cause(StopReason.ROBOT_ALARM, "the robot has an alarm")
    refusal = robot_blocker(status, ignore_own_hold=not is_commanded)
    if refusal is None or refusal.reason == "running":
        return None
    return Cause(StopReason.ROBOT_CHANGED, refusal.text)
