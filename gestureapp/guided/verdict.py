"""The verdict on a take, at once and in words. Pure."""

from collections.abc import Sequence
from typing import Final

from gestureapp.recording.take_values import F64, Judgement, Take, Verdict

LEVEL_DEG: Final = 15.0
"""The hand is level within this angle."""


def judge(label: str, times_s: F64, accel_g: F64, others: Sequence[Take]) -> Judgement:
    """What a take of this gesture is worth.

    Args:
        label: What was asked for.
        times_s: From the activation, shape (k,).
        accel_g: Specific force, shape (k, 3), in g.
        others: The person's takes so far.
    """
    if not len(times_s):
        return Judgement(Verdict.GAP, "no samples")
    return Judgement(Verdict.GOOD, "good")
