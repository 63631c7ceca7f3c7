"""When the probabilities of a moment are an answer: early, at the budget's end, or not. Pure."""

from dataclasses import dataclass

from gestureapp.recognition.movement import ONSET_G
from gestureapp.recognition.values import NO_GESTURE, Candidate

EARLY, LAST = 0.95, 0.60
"""For a model of the person's own takes; simulated people: 99.4 % recognised, 0.06 % wrong."""
EARLY_OF_OTHERS = 0.97
"""For a model without takes of the person."""
BUDGET_S = 0.160
"""After the later of activation and onset. Source: paper, its response time."""
BUDGET_MOST_S = 0.5
CANDIDATE = 0.25
"""Two gestures that are both at least so likely at the end are two candidates."""


@dataclass(frozen=True, slots=True)
class Decision:
    """How sure is sure enough, and what a movement is, for one model.

    Attributes:
        early: At or above this the likeliest gesture is the answer at once; 0 to 1.
        last: At or above this it is when the budget is over; not above ``early``.
        onset_g: Deviation from the baseline that is a movement of this person, 0.02 to 2 g.
        budget_s: The answer is there so long after the later of activation and onset, 0.05 to 0.5.

    Raises:
        ValueError: one is out of its range.
    """

    early: float = EARLY
    last: float = LAST
    onset_g: float = ONSET_G
    budget_s: float = BUDGET_S

    def __post_init__(self) -> None:
        ranges = {"early": (0.0, 1.0), "onset_g": (0.02, 2.0), "budget_s": (0.05, BUDGET_MOST_S)}
        for name, (least, most) in ranges.items():
            value = getattr(self, name)
            if not least < value <= most:
                raise ValueError(f"'{name}' is {value}, expected {least:g} to {most:g}")
        if not 0.0 < self.last <= self.early:
            raise ValueError(f"'last' is {self.last}, expected 0 to 'early' ({self.early})")


def judge_early(outputs: tuple[Candidate, ...], decision: Decision) -> str | None:
    """The gesture that is sure already, or None.

    Args:
        outputs: The gestures, then ``NO_GESTURE``.
        decision: The thresholds.
    """
    best = max(outputs, key=lambda c: c.confidence)
    is_sure = best.confidence >= decision.early and best.label != NO_GESTURE
    return best.label if is_sure else None


def judge_last(outputs: tuple[Candidate, ...], decision: Decision) -> tuple[str | None, str]:
    """Label and reason when the budget is over; arguments as for ``judge_early``."""
    ordered = sorted(outputs, key=lambda c: c.confidence, reverse=True)
    if ordered[0].label == NO_GESTURE:
        return None, f"nothing I know ({ordered[0].words})"
    if ordered[0].confidence >= decision.last:
        return ordered[0].label, ""
    best = [c for c in ordered if c.label != NO_GESTURE][:2]
    named = ", ".join(c.words for c in best)
    if len(best) == 2 and best[1].confidence >= CANDIDATE:
        return None, f"two candidates ({named})"
    return None, f"not sure ({named})"
