"""Values of checking, training and trying into words. Pure; no widget."""

import math
from collections.abc import Sequence

from gestureapp.gestures import gesture
from gestureapp.guided.check import GestureCheck
from gestureapp.guided.trying import NOT_RECOGNISED
from gestureapp.guided.values import GestureProgress, Trying
from gestureapp.recognition.evaluation import Evaluation
from gestureapp.recognition.presets import MIN_TAKES, Preset

PRESET_WORDS = {
    Preset.DEFAULT: "Default: several starts, each ended where unseen takes are heard best",
    Preset.PAPER: "As the paper: learning rate 0.25, 100,000 cycles; longer",
}
_MINUTE_S = 60.0


def gesture_words(label: str) -> str:
    """What a person does, ``push forward``; empty for a gesture this window has no words for."""
    try:
        return gesture(label).words
    except KeyError:
        return ""


def missing_words(progress: Sequence[GestureProgress], least: int = MIN_TAKES) -> str:
    """What stands against training: ``Z- has 3 takes: at least 5 are needed``; empty when nothing.

    Args:
        progress: Of every gesture.
        least: How many takes each needs.
    """
    if not any(each.good for each in progress):
        return f"No takes yet: record at least {least} of each gesture."
    few = [each for each in progress if each.good < least]
    if not few:
        return ""
    some = [f"{each.label} has {each.good or 'no'} {_takes(each.good)}" for each in few[:3]]
    more = f" and {len(few) - 3} more gestures have too few" if len(few) > 3 else ""
    return f"{', '.join(some)}{more}: at least {least} of each are needed."


def remaining_words(remaining_s: float) -> str:
    """How long it will take: ``about 5 s left``; empty while unknown."""
    if not math.isfinite(remaining_s):
        return ""
    if remaining_s < 1.0:
        return "nearly done"
    if remaining_s < _MINUTE_S:
        return f"about {remaining_s:.0f} s left"
    return f"about {remaining_s / _MINUTE_S:.0f} min left"


def share_words(count: int, total: int) -> str:
    """A count with its share: ``28 (93.3 %)``."""
    return f"{count} ({100 * count / total:.1f} %)" if total else f"{count}"


def live_words(evaluation: Evaluation) -> str:
    """The figure of a live test, as Operate shows it: ``93 % of 60``."""
    return f"{100 * evaluation.recognised:.0f} % of {evaluation.n}"


def outcome_words(trying: Trying) -> str:
    """What came of the last gesture tried; empty before the first."""
    if not trying.heard:
        return ""
    if trying.was_right:
        return f"right: heard {trying.heard}"
    return trying.heard if trying.heard == NOT_RECOGNISED else f"wrong: heard {trying.heard}"


def check_words(check: GestureCheck) -> str:
    """One gesture's takes in a line: ``X+ push forward: 30 takes count, 2 of them odd``."""
    n_counting = sum(checked.take.counts for checked in check.takes)
    n_others = len(check.takes) - n_counting
    name = f"{check.label} {gesture_words(check.label)}".strip()
    parts = [f"{n_counting} {_takes(n_counting)} count{'s' if n_counting == 1 else ''}"]
    if check.n_odd:
        parts.append(f"{check.n_odd} of them odd")
    if n_others:
        parts.append(f"{n_others} {'does' if n_others == 1 else 'do'} not count")
    return f"{name}: {', '.join(parts)}"


def _takes(count: int) -> str:
    return "take" if count == 1 else "takes"
