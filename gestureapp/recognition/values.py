"""What a recogniser takes and gives."""

import math
from dataclasses import dataclass
from typing import Final, Protocol

NO_GESTURE: Final = "none"
"""The candidate that stands for "nothing I know"; where there is one, it is the last output."""
SILENT_AFTER_S: Final = 0.25
"""Without the right arm's samples for so long after the activation it is silent."""
SILENT: Final = "right arm silent"
NO_MOVEMENT: Final = "no movement of the right arm"
_HAIR: Final = 1e-9
"""0.29 times 100 is 28.999…"""
NOT_A_NUMBER: Final = "a reading of the right arm is not a number"


def two_digits(confidence: float) -> str:
    """``0.49``: rounded down, so that what is under a threshold does not read as at it."""
    return f"{math.floor(confidence * 100 + _HAIR) / 100:.2f}"


@dataclass(frozen=True, slots=True)
class Candidate:
    """A gesture and how sure the recogniser is of it, 0 to 1."""

    label: str
    confidence: float

    @property
    def words(self) -> str:
        """``X+ 0.49``."""
        return f"{self.label} {two_digits(self.confidence)}"


@dataclass(frozen=True, slots=True)
class Recognition:
    """What was made of one activation.

    Attributes:
        activation_id: Which activation it answers.
        label: The gesture, or None for "not recognised".
        reason: Empty with a label; else why nothing was recognised, in words.
        outputs: All candidates in the order of the model's labels, then ``NO_GESTURE`` where the
            network has an output for it; empty when no network was asked.
        window_start_s: Receive time of the first sample used.
        window_end_s: Receive time of the last sample used.
        decided_s: When the answer was there, monotonic clock.
        onset_s: When the right arm's own movement began; None for a posture, and where the
            recogniser does not look for it.
        thresholds: The confidence that an answer needed, 0 to 1: one, or that for an answer at
            once and then that at the end of the time; empty when unknown.
        activation_s: When the left arm started; None when whoever asked has not said it.
    """

    activation_id: int
    label: str | None
    reason: str
    outputs: tuple[Candidate, ...]
    window_start_s: float
    window_end_s: float
    decided_s: float
    onset_s: float | None = None
    thresholds: tuple[float, ...] = ()
    activation_s: float | None = None

    @property
    def best(self) -> tuple[Candidate, ...]:
        """The two most likely candidates, likeliest first."""
        return tuple(sorted(self.outputs, key=lambda c: c.confidence, reverse=True)[:2])


class Recogniser(Protocol):
    """Follows the right arm; answers once per activation. Pure: time and samples come in."""

    @property
    def labels(self) -> tuple[str, ...]:
        """The gestures it can tell apart, in the order of its outputs."""

    def activate(self, activation_id: int, t_s: float) -> None:
        """The left arm has started at this time: an answer is wanted."""

    def cancel(self) -> None:
        """No answer is wanted any more."""

    def feed(self, t_s: float, accel_g: tuple[float, float, float]) -> Recognition | None:
        """Take a sample of the right arm; the answer, once it is there.

        Every sample is fed, also while nobody is activated, so that history is at hand.
        """

    def check(self, t_s: float) -> Recognition | None:
        """Give up when the samples needed did not come in time."""
