"""The virtual operator follows prompts: what a person sees in, orders to both arms out. Pure."""

import random
from dataclasses import dataclass, field

from gestureapp.gestures import LABELS
from gestureapp.sensing.values import Side
from gestureapp.simulation.operator_plan import OperatorPlan, Order, Tempo

CLUMSY_SHARE = 1.0 / 15.0
"""So many takes are done wrong on purpose: late, not at all, or as another gesture, by turns of
chance. Only while recording; a trial is done as well as can be."""
CLUMSY_LATE_S = 0.35
"""A late one begins so much after the activation; nobody's habit spreads as far."""
LOWERED_AFTER_S = 0.7
"""The left arm goes back so long after the activation."""
REACTION_S = 0.3
"""A prompt is followed so long after it has come: simple reactions to what is seen take 0.2 to
0.3 s."""
BRISK = Tempo(until_s=0.5, back_s=0.6, stop_held_s=0.3)
"""With both arms: the hand is back before the left arm is lowered and raised again."""
BEAT_BACK_S = 0.6
BEAT_REST_S = 0.55
"""On a beat the hand is back so long before the next one: a held turn begins about then."""


@dataclass(frozen=True, slots=True)
class Prompt:
    """What a person is asked to do, as it stands on the screen.

    Attributes:
        label: The gesture; empty when nothing is asked for.
        is_waiting: A gesture with both arms may begin now.
        beat_s: The next beat, monotonic; infinite when the left arm gives the time.
        every_s: From beat to beat.
        number: How many have been asked for before, where that is shown.
        is_trial: Whether it is a trial of the model, not a recording.
    """

    label: str = ""
    is_waiting: bool = False
    beat_s: float = float("inf")
    every_s: float = float("inf")
    number: int = 0
    is_trial: bool = False


NOTHING = Prompt()


@dataclass(slots=True)
class PromptFollower:
    """Does what is asked with the person's own timing. Owned by the plan's thread.

    Attributes:
        plan: What both arms were told.
        rng: Chance in which takes are clumsy, and how.
        slip: How the present take is done wrong, in words; empty when it is not.
    """

    plan: OperatorPlan
    rng: random.Random = field(default_factory=random.Random)
    slip: str = ""
    _is_left_up: bool = False
    _beat_s: float = float("-inf")
    _seen: tuple[str, int] = ("", 0)
    _since_s: float = float("-inf")

    def orders(self, prompt: Prompt, now_s: float) -> list[Order]:
        """What to tell the arms now; call it some ten times a second or more often.

        Args:
            prompt: What stands on the screen; ``NOTHING`` lets the arms go to rest.
            now_s: Monotonic time.

        Raises:
            KeyError: no gesture has the label that is asked for.
        """
        if (prompt.label, prompt.number) != self._seen:
            self._seen, self._since_s = (prompt.label, prompt.number), now_s
        lowered_s = self.plan.activation_s + LOWERED_AFTER_S
        if self._is_left_up and (not prompt.label or now_s >= lowered_s):
            self._is_left_up = False
            return self.plan.left_stop(now_s)
        if not prompt.label:
            return []
        if prompt.beat_s < float("inf"):
            return self._on_beat(prompt, now_s)
        if self._is_left_up or not prompt.is_waiting or now_s < self._since_s + REACTION_S:
            return []
        return self._with_both(prompt, now_s)

    def _with_both(self, prompt: Prompt, now_s: float) -> list[Order]:
        self._is_left_up = True
        label, late_s = self._slipped(prompt)
        return self._without_still(self.plan.gesture(label, now_s, BRISK, late_s))

    def _on_beat(self, prompt: Prompt, now_s: float) -> list[Order]:
        if prompt.beat_s == self._beat_s or now_s < prompt.beat_s - self.plan.lead_s(prompt.label):
            return []
        self._beat_s = prompt.beat_s
        label, late_s = self._slipped(prompt)
        until_s = min(1.0, max(0.3, prompt.every_s - BEAT_BACK_S - BEAT_REST_S))
        tempo = Tempo(until_s, BEAT_BACK_S)
        return self._without_still(self.plan.on_beat(label, prompt.beat_s, tempo, late_s))

    def _slipped(self, prompt: Prompt) -> tuple[str, float]:
        """The gesture that is really made, and how much too late."""
        self.slip = ""
        if prompt.is_trial or self.rng.random() >= CLUMSY_SHARE:
            return prompt.label, 0.0
        self.slip = self.rng.choice(("late", "not at all", "another gesture"))
        if self.slip == "late":
            return prompt.label, CLUMSY_LATE_S
        if self.slip == "another gesture":
            return self.rng.choice([other for other in LABELS if other != prompt.label]), 0.0
        return prompt.label, 0.0

    def _without_still(self, orders: list[Order]) -> list[Order]:
        """Without the right arm's part when that arm does not move at all."""
        if self.slip != "not at all":
            return orders
        return [order for order in orders if order.side is Side.LEFT]
