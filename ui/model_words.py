"""Values of checking, training and trying into words. Pure; no widget."""

import math
from collections.abc import Sequence

from gestureapp.gestures import gesture
from gestureapp.guided.check import GestureCheck
from gestureapp.guided.trained_words import missing_words
from gestureapp.guided.trying import NOT_RECOGNISED
from gestureapp.guided.values import GestureProgress, Trying
from gestureapp.recognition.evaluation import Evaluation
from gestureapp.recognition.presets import Preset

PRESET_WORDS = {
    Preset.DEFAULT: "From the onset: follows the movement, answers as soon as it is sure",
    Preset.PAPER: "As the paper: learning rate 0.25, 100,000 cycles; longer",
}
_MINUTE_S = 60.0


def gesture_words(label: str) -> str:
    """What a person does, ``push forward``; empty for a gesture this window has no words for."""
    try:
        return gesture(label).words
    except KeyError:
        return ""


def sentence(text: str) -> str:
    """A text with a capital first letter, as it stands on the screen."""
    return text[:1].upper() + text[1:]


def missing_for_training(progress: Sequence[GestureProgress]) -> str:
    """What stands against training; empty when nothing does."""
    return sentence(missing_words(each.label for each in progress for _ in range(each.good)))


def ready_words(progress: Sequence[GestureProgress]) -> str:
    """What a training would be from, and which gestures the model would not know."""
    known = [each for each in progress if each.good]
    words = f"{sum(each.good for each in known)} takes of {len(known)} gestures count."
    unknown = ", ".join(each.label for each in progress if not each.good)
    return f"{words} The model will not know {unknown}: no takes." if unknown else words


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
    """What came of the last gesture tried, ``X+: wrong, heard Y-``; empty before the first."""
    if not trying.heard:
        return ""
    if trying.was_right:
        return f"{trying.answered}: right"
    heard = trying.heard if trying.heard == NOT_RECOGNISED else f"wrong, heard {trying.heard}"
    return f"{trying.answered}: {heard}"


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
