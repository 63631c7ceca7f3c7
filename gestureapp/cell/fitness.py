"""What setting up says of sensors and postures: unknown is not fit. Pure."""

from dataclasses import dataclass

from gestureapp.config import SiteSettings
from gestureapp.sensing.posture import LeftPostures
from gestureapp.sensing.values import Side


@dataclass(frozen=True, slots=True)
class Judgement:
    """Why something must not be armed with, and what to do; an empty problem means it may be."""

    problem: str = ""
    remedy: str = ""


FIT = Judgement()
NOT_CALIBRATED = Judgement("not calibrated", "Setup, step Calibrate")
"""Of a sensor that nobody has judged yet."""


class Fitness:
    """The judgements that hold now. Owned by the control thread.

    Attributes:
        postures: Of the left arm's postures; the built-in ones are fit.
    """

    def __init__(self) -> None:
        self._sensors = dict.fromkeys(Side, NOT_CALIBRATED)
        self.postures = FIT

    def judge(self, side: Side, judgement: Judgement) -> bool:
        """Another judgement on a sensor. Returns whether it is not fit any more."""
        before, self._sensors[side] = self._sensors[side], judgement
        return not before.problem and bool(judgement.problem)

    def of(self, side: Side) -> Judgement:
        """Of this arm's sensor."""
        return self._sensors[side]


def why_overlapping(postures: LeftPostures, site: SiteSettings) -> str:
    """Why stop and start cannot be told apart; empty when they can.

    An arm that is in one as far as it may be must not be in the other.
    """
    least_deg = site.posture_enter_deg + site.posture_leave_deg
    if postures.between_deg > least_deg:
        return ""
    between = f"stop and start posture are only {postures.between_deg:.0f} degrees apart"
    return f"{between}; more than {least_deg:.0f} are needed"
