"""The paper's recogniser: three samples from the activation, one output or nothing. Pure."""

import math
from collections import deque

import numpy as np
from numpy.typing import NDArray

from gestureapp.recognition.model_file import Model
from gestureapp.recognition.model_weights import KIND_PAPER, WINDOW_SAMPLES
from gestureapp.recognition.values import (
    NO_MOVEMENT,
    NOT_A_NUMBER,
    SILENT,
    SILENT_AFTER_S,
    Candidate,
    Recognition,
)

THRESHOLD = 0.5
"""An output at or above this has detected its gesture. Source: paper, IV.C."""
REST_G = 0.15
"""All three samples nearer than this to (0, 0, 1) g: a resting hand, not a gesture.

Measured with the preset ``paper`` on simulated people, 30 takes of each gesture to train and
12 x 100 of another day: share recognised, and share of activations with a resting hand that were
heard as a gesture. Eight ordinary people with sensors that nobody has calibrated (gain error up
to 10 %):

    level      none   0.06   0.08   0.10   0.12   0.15   0.20 g
    recognised 76.6   76.4   76.3   76.0   75.5   74.7   72.2 %
    wrong      6.7    6.5    6.5    6.4    6.2    5.6    5.3 %
    at rest    12.1   10.2   9.3    8.3    6.6    4.3    0.5 %

Four practised people with calibrated sensors: recognised 99.98 % up to 0.15 g and 99.92 % at 0.20;
heard at rest 47.6 % without the guard, 8.5 % at 0.06, 0.3 % at 0.08 and none from 0.10 on. So
0.15 g costs an ordinary person 1.8 of 100 gestures, which were barely begun, a practised one none.
"""
HISTORY = 64
"""Samples kept, so that those received after the activation's time but before its call count."""

Accel = tuple[float, float, float]


class PaperRecogniser:
    """Answers an activation from the first three samples received at or after it.

    Owned by the control thread, or by an evaluation; knows no clock.

    Args:
        model: Of kind ``paper`` with nine inputs.

    Raises:
        ValueError: the model is not for this recogniser.
    """

    def __init__(self, model: Model) -> None:
        if model.kind != KIND_PAPER or model.shape[0] != 3 * WINDOW_SAMPLES:
            raise ValueError(f"a model of kind {model.kind!r} is not for the paper's recogniser")
        self._model = model
        self._history: deque[tuple[float, Accel]] = deque(maxlen=HISTORY)
        self._activation: tuple[int, float] | None = None
        self._window: list[tuple[float, Accel]] = []

    @property
    def labels(self) -> tuple[str, ...]:
        """The gestures it can tell apart, in the order of its outputs."""
        return self._model.labels

    def activate(self, activation_id: int, t_s: float) -> None:
        """The left arm has started at this time; a request still open is dropped."""
        self._activation = (activation_id, t_s)
        late = [sample for sample in self._history if sample[0] >= t_s]
        self._window = late[:WINDOW_SAMPLES]

    def cancel(self) -> None:
        """No answer is wanted any more."""
        self._activation = None
        self._window = []

    def feed(self, t_s: float, accel_g: Accel) -> Recognition | None:
        """Take a sample of the right arm; the answer with the third one since the activation."""
        sample = (t_s, accel_g)
        self._history.append(sample)
        if self._activation is None:
            return None
        if t_s >= self._activation[1] and len(self._window) < WINDOW_SAMPLES:
            self._window.append(sample)
        return self.check(t_s)

    def check(self, t_s: float) -> Recognition | None:
        """Answer if the three samples are there; give up when they did not come in time."""
        if self._activation is None:
            return None
        deadline_s = self._activation[1] + SILENT_AFTER_S
        if len(self._window) == WINDOW_SAMPLES and self._window[-1][0] <= deadline_s:
            return self._decide(t_s)
        if t_s > deadline_s:
            return self._answer(t_s, None, SILENT, ())
        return None

    def _decide(self, t_s: float) -> Recognition:
        accel = np.array([accel_g for _, accel_g in self._window], dtype=np.float64)
        if not np.all(np.isfinite(accel)):
            return self._answer(t_s, None, NOT_A_NUMBER, ())
        values = self._model.network.outputs(accel.reshape(-1)).tolist()
        outputs = tuple(map(Candidate, self.labels, values))
        if is_at_rest(accel):
            return self._answer(t_s, None, NO_MOVEMENT, outputs)
        return self._answer(t_s, *judge(outputs), outputs)

    def _answer(
        self, t_s: float, label: str | None, reason: str, outputs: tuple[Candidate, ...]
    ) -> Recognition:
        activation_id, activation_s = self._activation or (0, math.nan)
        start_s = self._window[0][0] if self._window else activation_s
        end_s = self._window[-1][0] if self._window else activation_s
        self.cancel()
        return Recognition(
            activation_id, label, reason, outputs, start_s, end_s, t_s, thresholds=(THRESHOLD,)
        )


def judge(outputs: tuple[Candidate, ...]) -> tuple[str | None, str]:
    """Label and reason from a network's outputs: recognised when exactly one reaches the threshold.

    Source: paper, IV.C; two at once it leaves open, and here nothing is recognised then.
    """
    detected = [c for c in outputs if c.confidence >= THRESHOLD]
    if len(detected) == 1:
        return detected[0].label, ""
    best = sorted(outputs, key=lambda c: c.confidence, reverse=True)[:2]
    named = ", ".join(c.words for c in best)
    if detected:
        return None, f"two candidates ({named})"
    return None, f"no clear gesture ({named})"


def is_at_rest(accel_g: NDArray[np.float64]) -> bool:
    """Whether every sample, shape (n, 3), is within ``REST_G`` of a level resting hand."""
    away = accel_g - np.array([0.0, 0.0, 1.0])
    return bool(np.all(np.einsum("ij,ij->i", away, away) < REST_G**2))
