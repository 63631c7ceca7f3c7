"""Trying a model without the robot: gestures are asked for, and what is heard is counted.

Pure: time, the left arm's postures and the right arm's samples come in. Any recogniser fits: it is
activated by the left arm and fed with every sample, exactly as in operation.
"""

import random
from collections.abc import Sequence
from typing import Final

from gestureapp.gestures import gesture
from gestureapp.guided.arms import News
from gestureapp.guided.values import Live, Trying
from gestureapp.recognition.evaluation import tally
from gestureapp.recognition.values import Recogniser, Recognition
from gestureapp.sensing.values import ArmPosture, Side

PATIENCE_S: Final = 8.0
"""Without an activation for so long the gesture is asked for again."""
SHOWN_S: Final = 1.5
"""What was heard stands so long before the next gesture is asked for."""
NOT_RECOGNISED: Final = "not recognised"


class LiveTest:
    """One test of a model. Owned by one thread; knows no clock.

    Args:
        recogniser: Fresh, with the model.
        labels: What to ask for.
        per_gesture: How often each.
        now_s: It begins now.
        posture: The left arm's now.
        chance: Decides the order.

    Attributes:
        view: What there is to show.
        activation_s: Of the last gesture that was answered, monotonic clock.
    """

    def __init__(
        self,
        recogniser: Recogniser,
        labels: Sequence[str],
        per_gesture: int,
        now_s: float,
        posture: ArmPosture,
        chance: random.Random,
    ) -> None:
        self._recogniser = recogniser
        self._labels = tuple(labels)
        self._open = _shuffled(self._labels, max(1, per_gesture), chance)
        self._n_planned = len(self._open)
        self._answers: list[tuple[str, str | None]] = []
        self._took_ms: list[float] = []
        self._is_left_rested = posture is ArmPosture.STOP
        self._activation_s: float | None = None
        self._last: Recognition | None = None
        self._lost: Side | None = None
        self._asked = ""
        self._ask_s = now_s
        self._asked_s = now_s
        self._is_again = False
        self._is_on = True
        self._live: Live | None = None
        self.view = Trying()
        self.activation_s = now_s
        self._draw()

    @property
    def is_over(self) -> bool:
        """Every gesture was asked for as often as planned."""
        return not self._open

    def stop(self) -> None:
        """End it; what was counted is kept."""
        self._is_on = False
        self._asked = ""
        self._recogniser.cancel()
        self._draw()

    def step(self, now_s: float, news: News, lost: Side | None) -> None:
        """Let time pass.

        Args:
            now_s: Monotonic.
            news: What came since the last step.
            lost: A sensor that is silent, or None.
        """
        if not self._is_on:
            return
        for t_s, posture in news.postures:
            self._left(t_s, posture)
        for t_s, x, y, z in news.right:
            self._heard(self._recogniser.feed(t_s, (x, y, z)))
        self._heard(self._recogniser.check(now_s))
        self._lose(lost, now_s)
        if lost is None:
            self._ask(now_s)
        self._draw()

    def _left(self, t_s: float, posture: ArmPosture) -> None:
        if posture is ArmPosture.STOP:
            self._is_left_rested = True
        elif posture is ArmPosture.START and self._is_left_rested:
            self._is_left_rested = False
            if self._asked and self._activation_s is None:
                self._activation_s = t_s
                self._recogniser.activate(len(self._answers), t_s)

    def _heard(self, answer: Recognition | None) -> None:
        if answer is None or self._activation_s is None:
            return
        self._answers.append((self._asked, answer.label))
        self._took_ms.append(1000.0 * (answer.decided_s - self._activation_s))
        self._last, self.activation_s = answer, self._activation_s
        self._open.pop(0)
        self._asked, self._activation_s, self._is_again = "", None, False
        self._ask_s = answer.decided_s + SHOWN_S
        self._live = Live(tally(self._labels, self._answers, self._took_ms), self.is_over)
        self._is_on = not self.is_over

    def _lose(self, lost: Side | None, now_s: float) -> None:
        """A gesture that was asked for is asked for anew when the sensors are back."""
        self._lost = lost
        if lost is not None:
            self._recogniser.cancel()
            self._asked, self._activation_s = "", None
            self._ask_s = now_s

    def _ask(self, now_s: float) -> None:
        if not self._is_on:
            return
        if self._asked:
            if self._activation_s is None and now_s - self._asked_s > PATIENCE_S:
                self._asked_s, self._is_again = now_s, True
        elif now_s >= self._ask_s and self._is_left_rested:
            self._asked, self._asked_s = self._open[0], now_s

    def _draw(self) -> None:
        last = self._last
        heard = "" if last is None else last.label or NOT_RECOGNISED
        self.view = Trying(
            is_on=self._is_on,
            asked=self._asked,
            heard=heard,
            was_right=last is not None and last.label == self._answers[-1][0],
            reason="" if last is None else last.reason,
            n_done=len(self._answers),
            n_planned=self._n_planned,
            live=self._live,
            text=self._text(heard),
            answered=self._answers[-1][0] if self._answers else "",
        )

    def _text(self, heard: str) -> str:
        n = len(self._answers)
        if not self._is_on:
            return f"{'All' if self.is_over else 'Ended:'} {n} of {self._n_planned} gestures tried."
        if self._lost is not None:
            side = self._lost.value.capitalize()
            return f"{side} sensor lost; {n} tried. It goes on by itself when the sensor is back."
        if self._asked:
            again = f"No activation within {PATIENCE_S:g} s. " if self._is_again else ""
            return f"{again}{self._asked}: {gesture(self._asked).words}."
        if not self._is_left_rested:
            return "Bring the left arm to the stop posture."
        return f"{self._answers[-1][0]}: heard {heard}." if n else "Get ready."


def _shuffled(labels: Sequence[str], times: int, chance: random.Random) -> list[str]:
    """Every label so often, in random order."""
    order = [label for label in labels for _ in range(times)]
    chance.shuffle(order)
    return order
