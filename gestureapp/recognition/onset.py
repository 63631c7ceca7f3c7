"""The onset-aligned recogniser: follows a movement from its onset, answers when sure. Pure."""

import math
from dataclasses import dataclass

from gestureapp.recognition.decision import judge_early, judge_last
from gestureapp.recognition.ensemble import Ensemble
from gestureapp.recognition.model_file import Model
from gestureapp.recognition.model_weights import KIND_ONSET
from gestureapp.recognition.movement import NOW_S, Follower
from gestureapp.recognition.values import (
    NO_GESTURE,
    NO_MOVEMENT,
    NOT_A_NUMBER,
    SILENT,
    SILENT_AFTER_S,
    Candidate,
    Recognition,
)
from gestureapp.recognition.window import N_INPUTS, inputs_of

MIN_ELAPSED_S = 0.038
"""The network is not asked sooner after an onset: before, a bump and a push are the same. Asked
from 15 ms on, 16 of 100 simulated non-gestures were heard as gestures; from 38 ms on 2."""
OLDEST_S = 0.45
"""A movement that began longer ago is not asked about: the cells do not reach so far."""
GIVE_UP_S = 1.5
"""Without an onset for so long after the activation: no movement."""
STALE_S = 0.08
"""The last question counts at the end of the budget when it was asked less than this before."""
MOST_G = 100.0
"""No accelerometer worn on an arm reads more."""
JUST_S = 1e-9

MOVING_BEFORE = "the right arm was moving before the activation"
NOT_CLEAR = "no clear gesture"

Accel = tuple[float, float, float]


@dataclass(slots=True)
class _Request:
    """An activation that waits for its answer.

    Attributes:
        activation_id: Of the activation.
        activation_s: Its time.
        begin_s: The budget runs from here; NaN before there is something to decide.
        outputs: Of the last question; empty before the first.
        asked_s: When that was.
        onset_s: The movement's onset then; None for a posture.
    """

    activation_id: int
    activation_s: float
    begin_s: float = math.nan
    outputs: tuple[Candidate, ...] = ()
    asked_s: float = -math.inf
    onset_s: float | None = None


class OnsetRecogniser:
    """Answers an activation from the right arm's movement since its onset, or from its posture.

    Owned by the control thread, or by an evaluation; knows no clock. It looks at the times of the
    samples only. The follower runs all the time: an onset before the activation is known.

    Args:
        model: Of kind ``onset``.

    Raises:
        ValueError: the model is not for this recogniser.
    """

    def __init__(self, model: Model) -> None:
        decision, network = model.decision, model.network
        if model.kind != KIND_ONSET or decision is None or not isinstance(network, Ensemble):
            raise ValueError(f"a model of kind {model.kind!r} is not for the onset recogniser")
        if model.shape[0] != N_INPUTS or model.shape[-1] != len(model.labels) + 1:
            raise ValueError(f"a network of shape {model.shape} is not for the onset recogniser")
        if NO_GESTURE in model.labels:
            raise ValueError(f"a gesture must not be called {NO_GESTURE!r}")
        self._labels, self._network, self._decision = model.labels, network, decision
        self._names = (*model.labels, NO_GESTURE)
        self._follower = Follower(decision.onset_g)
        self._request: _Request | None = None

    @property
    def labels(self) -> tuple[str, ...]:
        """The gestures it can tell apart, in the order of its outputs."""
        return self._labels

    def activate(self, activation_id: int, t_s: float) -> None:
        """The left arm has started at this time; a request still open is dropped."""
        self._request = _Request(activation_id, t_s)

    def cancel(self) -> None:
        """No answer is wanted any more."""
        self._request = None

    def feed(self, t_s: float, accel_g: Accel) -> Recognition | None:
        """Take a sample of the right arm; the answer, once it is sure or the budget is over."""
        request = self._request
        if not math.isfinite(t_s):
            return None
        is_asked = request is not None and t_s >= request.activation_s - JUST_S
        if not all(abs(value) <= MOST_G for value in accel_g):
            return self._answer(request, t_s, None, NOT_A_NUMBER) if request and is_asked else None
        self._follower.feed(t_s, accel_g)
        if request is None or not is_asked:
            return None
        return self._follow(request, self._follower.newest_s)

    def check(self, t_s: float) -> Recognition | None:
        """Answer when the budget is over and no sample tells; give up on a silent arm."""
        request = self._request
        if request is None:
            return None
        if t_s > request.begin_s + self._decision.budget_s + JUST_S:
            return self._last(request, t_s)
        heard_s = max(request.activation_s, self._follower.newest_s)
        if t_s > heard_s + SILENT_AFTER_S:
            return self._answer(request, t_s, None, SILENT)
        return None

    def _follow(self, request: _Request, t_s: float) -> Recognition | None:
        follower = self._follower
        elapsed_s = t_s - follower.onset_s if follower.is_moving else 0.0
        is_moving = follower.is_moving and elapsed_s <= OLDEST_S
        if math.isnan(request.begin_s):
            if is_moving:
                request.begin_s = max(follower.onset_s, request.activation_s)
            elif follower.is_posture:
                request.begin_s = t_s
            elif t_s > request.activation_s + GIVE_UP_S:
                why = MOVING_BEFORE if follower.is_moving else NO_MOVEMENT
                return self._answer(request, t_s, None, why)
            else:
                return None
        end_s = request.begin_s + self._decision.budget_s + JUST_S
        if t_s <= end_s and ((is_moving and elapsed_s >= MIN_ELAPSED_S) or follower.is_posture):
            label = self._ask(request, t_s)
            if label is not None:
                return self._answer(request, t_s, label, "")
        # The answer does not wait for a sample that is due after the budget.
        return self._last(request, t_s) if t_s + follower.step_s > end_s else None

    def _ask(self, request: _Request, t_s: float) -> str | None:
        """The gesture that is sure already, or None."""
        values = self._network.outputs(inputs_of(self._follower.moment())).tolist()
        request.outputs = tuple(map(Candidate, self._names, values))
        request.asked_s = t_s
        request.onset_s = self._follower.onset_s if self._follower.is_moving else None
        return judge_early(request.outputs, self._decision)

    def _last(self, request: _Request, t_s: float) -> Recognition:
        end_s = request.begin_s + self._decision.budget_s
        if self._follower.newest_s < end_s - STALE_S:
            return self._answer(request, t_s, None, SILENT)
        if request.asked_s < end_s - STALE_S:
            return self._answer(request, t_s, None, NOT_CLEAR)
        return self._answer(request, t_s, *judge_last(request.outputs, self._decision))

    def _answer(self, request: _Request, t_s: float, label: str | None, reason: str) -> Recognition:
        self._request = None
        start_s = end_s = request.activation_s
        if request.outputs:
            end_s = request.asked_s
            start_s = request.onset_s if request.onset_s is not None else end_s - NOW_S
        return Recognition(
            request.activation_id,
            label,
            reason,
            request.outputs,
            start_s,
            end_s,
            t_s,
            onset_s=request.onset_s,
            thresholds=(self._decision.early, self._decision.last),
        )
