"""The last activation, with its samples, until a person says that it was right. Pure.

In operation it is what the cell recognised; while a model is tried it is what was asked for, which
the person says was done. A take is cut from the right arm's samples as soon as its last is there.
"""

from typing import Final

from gestureapp.guided.arms import Arms
from gestureapp.guided.values import Heard
from gestureapp.recognition.values import Recognition
from gestureapp.recording.take_values import AFTER_S, F64

SETTLED_S: Final = 0.05
"""Samples come up to this much later than they were taken."""
TOO_LATE: Final = "There are newer gestures: only the last one can be kept."
NO_SAMPLES: Final = "The right sensor sent nothing then: it cannot be kept."


class LastHeard:
    """Holds one activation. Owned by the guided thread; knows no clock.

    Attributes:
        view: What there is to show.
        person: Whose arms it was; empty when the model in use is nobody's.
        activation_s: When it was, monotonic clock.
    """

    def __init__(self) -> None:
        self.view = Heard()
        self.person = ""
        self.activation_s = 0.0
        self._number = 0
        self._samples: tuple[F64, F64] | None = None
        self._seen: Recognition | None = None

    def tried(self, label: str, activation_s: float, person: str) -> None:
        """Another gesture was asked of this person, and something was heard."""
        self._begin(label, activation_s, is_tried=True, person=person)

    def operated(self, answer: Recognition | None, person: str) -> None:
        """The cell's last answer; only a new one counts, and only one with a gesture.

        Args:
            answer: As the cell's picture has it.
            person: Whose arms the model in use is for.
        """
        if answer is None or answer is self._seen:
            return
        self._seen = answer
        if answer.activation_s is not None:
            self._begin(answer.label or "", answer.activation_s, is_tried=False, person=person)

    def step(self, now_s: float, arms: Arms) -> None:
        """Cut the take as soon as its last sample is there."""
        is_due = now_s >= self.activation_s + AFTER_S + SETTLED_S
        if not self.view.label or self._samples is not None or not is_due:
            return
        self._samples = arms.cut(self.activation_s)
        has_samples = len(self._samples[0]) > 0
        self._tell("" if has_samples else NO_SAMPLES, can_keep=has_samples)

    def samples(self, number: int) -> tuple[F64, F64] | None:
        """Times from the activation (k,) and (k, 3) in g; None when it cannot be kept (any more).

        Args:
            number: Of the activation that the person has seen.
        """
        if number != self.view.number:
            self._tell(TOO_LATE, can_keep=self.view.can_keep)
            return None
        return self._samples if self.view.can_keep else None

    def kept(self, text: str) -> None:
        """It is a take now: in words, what it is worth."""
        self._tell(text, can_keep=False)

    def refused(self, text: str) -> None:
        """It could not be kept: in words, why; the person may try again."""
        self._tell(text, can_keep=True)

    def _begin(self, label: str, activation_s: float, *, is_tried: bool, person: str) -> None:
        self._number += 1
        self.person, self.activation_s, self._samples = person, activation_s, None
        self.view = Heard(self._number, is_tried, label)

    def _tell(self, text: str, *, can_keep: bool) -> None:
        view = self.view
        self.view = Heard(view.number, view.is_tried, view.label, can_keep, text)
