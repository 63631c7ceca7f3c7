"""How well a model does: the real recogniser, fed sample by sample with every take. Pure."""

import numpy as np
from numpy.typing import NDArray

from gestureapp.errors import ModelMismatch
from gestureapp.recognition.evaluation import Evaluation, tally
from gestureapp.recognition.kinds import recogniser_for
from gestureapp.recognition.model_file import Model
from gestureapp.recognition.model_weights import KIND_PAPER
from gestureapp.recognition.takes import RATE_UNKNOWN_HZ, TakeSet
from gestureapp.recognition.values import SILENT_AFTER_S, Recogniser, Recognition

TICK_S = 0.01
"""After the end of a take the recogniser is let know so often that time goes on."""
RATE_OFF = 0.1
"""Relative: a sensor's clock is off by far less, another setting of its rate by far more."""


def evaluate(model: Model, takes: TakeSet) -> Evaluation:
    """Feed every take to a fresh recogniser as it would come in, and count the answers.

    Takes of unknown rate are fed at 100 Hz.

    Raises:
        ModelMismatch: there are no takes, or none of a gesture that the model knows.
    """
    known = set(model.labels) & set(takes.labels)
    if not known:
        found = ", ".join(sorted(set(takes.labels))[:6]) or "no takes at all"
        wanted = ", ".join(model.labels)
        reason = f"holds {found}; this model knows {wanted}: rename the labels or train a model"
        raise ModelMismatch(takes.source, reason)
    answers = [hear(model, takes, i) for i in range(len(takes))]
    return count_answers(model.labels, takes, answers)


def find_other_rate(model: Model, takes: TakeSet) -> str:
    """That takes come at another rate than a model can be used at, in words; empty when not."""
    trained_hz, rate_hz = model.training.rate_hz, takes.rate_hz or RATE_UNKNOWN_HZ
    if model.kind != KIND_PAPER or trained_hz is None:
        return ""
    if abs(rate_hz - trained_hz) <= RATE_OFF * trained_hz:
        return ""
    return (
        f"the model was trained at {trained_hz:g} Hz and its kind is for that rate only; these "
        f"takes are at {rate_hz:g} Hz: train one from takes at this rate"
    )


def hear(model: Model, takes: TakeSet, index: int) -> Recognition:
    """What a fresh recogniser with this model makes of one take."""
    rate_hz = takes.rate_hz or RATE_UNKNOWN_HZ
    activation = int(takes.activation[index])
    return follow(recogniser_for(model), takes.accel_g(index), activation, rate_hz, index)


def count_answers(
    labels: tuple[str, ...], takes: TakeSet, answers: list[Recognition]
) -> Evaluation:
    """The table of one answer for each take, in the order of the takes."""
    rate_hz = takes.rate_hz or RATE_UNKNOWN_HZ
    activation_s = (takes.activation / rate_hz).tolist()
    took_ms = [1000.0 * (a.decided_s - t) for a, t in zip(answers, activation_s, strict=True)]
    pairs = zip(takes.labels, [answer.label for answer in answers], strict=True)
    return tally(labels, pairs, took_ms)


def follow(
    recogniser: Recogniser,
    accel_g: NDArray[np.float64],
    activation: int,
    rate_hz: float,
    activation_id: int = 0,
) -> Recognition:
    """Feed one take sample by sample; sample k is received k / rate_hz after the take's beginning.

    Args:
        recogniser: Fresh, or at least not activated.
        accel_g: Shape (k, 3), in g.
        activation: Index of the first sample at or after the activation, which is at its time.
        rate_hz: Sample rate.
        activation_id: Comes back in the answer.
    """
    for index, (x, y, z) in enumerate(accel_g.tolist()):
        if index == activation:
            recogniser.activate(activation_id, index / rate_hz)
        answer = recogniser.feed(index / rate_hz, (x, y, z))
        if answer is not None:
            return answer
    now_s = activation / rate_hz
    end_s = max((len(accel_g) - 1) / rate_hz, now_s)
    for tick in range(1, round(2.0 * SILENT_AFTER_S / TICK_S) + 1):
        answer = recogniser.check(end_s + tick * TICK_S)
        if answer is not None:
            return answer
    return Recognition(activation_id, None, "the take ended", (), now_s, now_s, end_s)
