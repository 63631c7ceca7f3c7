"""The watchdogs: is the newest left sample, control tick or window tick too old? Pure.

Ages are taken on the monotonic clock that all processes of a machine share; a time in the future is
as bad as an old one.
"""

from dataclasses import dataclass

from gestureapp.robot.gate import AHEAD_S, Limits
from gestureapp.robot.messages import Beat
from gestureapp.robot.values import StopReason


@dataclass(frozen=True, slots=True)
class Stale:
    """Something was silent for too long, with the measured time in words."""

    reason: StopReason
    text: str


def find_stale(beat: Beat, limits: Limits, now_s: float) -> Stale | None:
    """The first thing that is too old, the left sensor before the rest."""
    for t_s, limit_s, reason in (
        (beat.left_s, limits.trip_level_s, StopReason.LEFT_SILENT),
        (beat.control_s, limits.control_limit_s, StopReason.CONTROL_STALE),
        (beat.gui_s, limits.gui_limit_s, StopReason.WINDOW_STALE),
    ):
        age_s = now_s - t_s
        if not -AHEAD_S <= age_s <= limit_s:
            text = f"{reason.value} for {age_s * 1000:.0f} ms, limit {limit_s * 1000:.0f} ms"
            return Stale(reason, text)
    return None
