"""The verdict on a take, at once and in words. Pure.

The first thing that is wrong is named; a take with nothing wrong is good and counts.
"""

import math
from collections.abc import Sequence
from typing import Final

from gestureapp.gestures import is_held
from gestureapp.guided.likeness import Likeness
from gestureapp.guided.motion import onset_s, rest_of, tilt_of, worst_gap_s
from gestureapp.recording.take_values import F64, Judgement, Take, Verdict

GAP_S: Final = 0.035
"""Longer without a sample, and the three samples of an activation may be from anywhen."""
SATURATED_G: Final = 2.95
"""The ADXL330 measures 3 g at least; above, parts differ, and the peak is cut off."""
EARLY_S: Final = 0.15
"""The right arm begins at most this long before the activation …"""
LATE_S: Final = 0.12
"""… and at most this long after it. Ordinary simulated people (15 to 45 ms apart) begin between
-0.11 and 0.12 s, practised ones between -0.04 and 0.01 s."""
LEVEL_DEG: Final = 15.0
"""A hand that is turned further is not level. Ordinary simulated people, whose straps and habits
are a few degrees off, hold it within 7 degrees (median) and 15 (99.7 %); practised ones within 5.
"""
HELD_DEG: Final = 40.0
"""A posture is there when the hand is turned at least this far; ordinary simulated people turn it
by 50 to 90 degrees."""
_HELD_SPAN_S: Final = 0.05
"""A posture is looked for in this much after the activation: what a recogniser sees first."""

_SHOWN_SPAN_S: Final = 0.5
"""Over this a movement, which begins and ends at rest, leaves the mean where gravity has it."""

GOOD: Final = Judgement(Verdict.GOOD, Verdict.GOOD.value)


def judge(
    label: str, times_s: F64, accel_g: F64, others: Sequence[Take], likeness: Likeness
) -> Judgement:
    """What a take of this gesture is worth.

    Args:
        label: What was asked for.
        times_s: From the activation, shape (k,).
        accel_g: Specific force, shape (k, 3), in g.
        others: The person's takes so far.
        likeness: Compares takes; of the same person.
    """
    gap_s = worst_gap_s(times_s)
    if gap_s > GAP_S:
        return Judgement(Verdict.GAP, f"gap of {gap_s * 1000:.0f} ms")
    if abs(accel_g).max() >= SATURATED_G:
        return _named(Verdict.SATURATED)
    shown = _posture_shown(accel_g[(times_s >= 0.0) & (times_s < _SHOWN_SPAN_S)])
    if shown not in ("", label):
        return Judgement(Verdict.UNLIKE, f"looks like {shown}")
    fault = _posture(times_s, accel_g) if is_held(label) else _movement(times_s, accel_g)
    if fault is not None:
        return fault
    odd = likeness.oddness(label, times_s, accel_g, others)
    return Judgement(Verdict.UNLIKE, odd) if odd else GOOD


def _posture_shown(accel_g: F64) -> str:
    """Which of RX and RY these readings show by gravity alone; empty when none."""
    if tilt_of(accel_g) < HELD_DEG:
        return ""
    x, y, _ = accel_g.mean(axis=0).tolist()
    axis, value = ("RY", x) if abs(x) > abs(y) else ("RX", y)
    return f"{axis}{'+' if value > 0.0 else '-'}"


def _movement(times_s: F64, accel_g: F64) -> Judgement | None:
    """What is wrong with a movement's beginning: it starts level, and with the activation."""
    onset = onset_s(times_s, accel_g)
    if math.isnan(onset):
        return _named(Verdict.NO_MOVEMENT)
    if onset > LATE_S:
        return Judgement(Verdict.TOO_LATE, f"too late by {onset * 1000:.0f} ms")
    if onset < -EARLY_S:
        return Judgement(Verdict.TOO_EARLY, f"too early by {-onset * 1000:.0f} ms")
    tilt_deg = tilt_of(rest_of(times_s, accel_g)[None])
    if tilt_deg > LEVEL_DEG:
        return Judgement(Verdict.NOT_LEVEL, f"not level: {tilt_deg:.0f}° before it")
    return None


def _posture(times_s: F64, accel_g: F64) -> Judgement | None:
    """What is wrong with a posture: it is there when the activation comes."""
    first = accel_g[(times_s >= 0.0) & (times_s < _HELD_SPAN_S)]
    if tilt_of(first) >= HELD_DEG:
        return None
    before, after = accel_g[times_s < 0.0], accel_g[times_s >= 0.0]
    if max(tilt_of(part) for part in _parts(after)) >= HELD_DEG:
        return Judgement(Verdict.TOO_LATE, "too late: not held when the left arm started")
    if max(tilt_of(part) for part in _parts(before)) >= HELD_DEG:
        return Judgement(Verdict.TOO_EARLY, "too early: no longer held")
    return Judgement(Verdict.NO_MOVEMENT, "no posture: the hand is level")


def _parts(accel_g: F64) -> list[F64]:
    """Stretches of ten readings, that a knock does not turn."""
    return [accel_g[k : k + 10] for k in range(0, len(accel_g), 10)]


def _named(verdict: Verdict) -> Judgement:
    return Judgement(verdict, verdict.value)
