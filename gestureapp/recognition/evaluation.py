"""How well a model does: the real recogniser, fed sample by sample with every take. Pure."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gestureapp.errors import ModelMismatch
from gestureapp.recognition.model_file import Model
from gestureapp.recognition.paper import SILENT_AFTER_S, PaperRecogniser
from gestureapp.recognition.takes import TakeSet
from gestureapp.recognition.values import Recogniser, Recognition

RATE_UNKNOWN_HZ = 100.0
"""Taken for takes of unknown rate: the paper's."""

Percentages = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Evaluation:
    """What a recogniser made of a set of takes.

    Attributes:
        labels: The model's gestures, then others that occur in the takes.
        confusion: Counts, shape (labels, labels + 1), read-only: rows what was done, columns what
            was heard, the last one "not recognised".
        decision_ms: Median and 95th percentile of the time from the activation to the answer (to
            the receipt of the last sample needed; the pass itself takes some 20 us); 0 without
            takes.
    """

    labels: tuple[str, ...]
    confusion: NDArray[np.int64]
    decision_ms: tuple[float, float]

    def __post_init__(self) -> None:
        self.confusion.setflags(write=False)

    @property
    def n(self) -> int:
        """Number of takes."""
        return int(self.confusion.sum())

    @property
    def recognised(self) -> float:
        """Share of all takes heard as what was done; 0 to 1."""
        return self._share(int(np.trace(self.confusion)))

    @property
    def rejected(self) -> float:
        """Share of all takes not recognised; 0 to 1."""
        return self._share(int(self.confusion[:, -1].sum()))

    @property
    def wrong(self) -> float:
        """Share of all takes heard as another gesture; 0 to 1."""
        heard = int(self.confusion[:, :-1].sum()) - int(np.trace(self.confusion))
        return self._share(heard)

    def per_gesture(self) -> dict[str, Percentages]:
        """Recognised, wrong and rejected share, 0 to 1, of each gesture in the takes."""
        shares: dict[str, Percentages] = {}
        for row, label in enumerate(self.labels):
            counts = self.confusion[row]
            total = int(counts.sum())
            if total:
                right, rejected = int(counts[row]), int(counts[-1])
                wrong = total - right - rejected
                shares[label] = (right / total, wrong / total, rejected / total)
        return shares

    def as_json(self) -> dict[str, object]:
        """The same as plain values for ``json.dumps``."""
        return {
            "n": self.n,
            "labels": list(self.labels),
            "confusion": self.confusion.tolist(),
            "recognised": self.recognised,
            "wrong": self.wrong,
            "rejected": self.rejected,
            "per_gesture": {
                label: {"recognised": share[0], "wrong": share[1], "rejected": share[2]}
                for label, share in self.per_gesture().items()
            },
            "decision_ms": {"median": self.decision_ms[0], "p95": self.decision_ms[1]},
        }

    def as_table(self) -> str:
        """A text table like the paper's Table I, in per cent; the last row is the mean."""
        shares = self.per_gesture()
        width = max([len("Gesture"), *(len(label) for label in shares)])
        lines = [f"{'Gesture':<{width}}  recognised  wrong  rejected"]
        rows = list(shares.items())
        if rows:
            mean = np.mean([share for _, share in rows], axis=0).tolist()
            rows.append(("Mean", (mean[0], mean[1], mean[2])))
        for label, (right, wrong, rejected) in rows:
            lines.append(
                f"{label:<{width}}  {100 * right:10.1f}  {100 * wrong:5.1f}  {100 * rejected:8.1f}"
            )
        return "\n".join(lines)

    def _share(self, count: int) -> float:
        return count / self.n if self.n else 0.0


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
    rate_hz = takes.rate_hz or RATE_UNKNOWN_HZ
    answers = [
        follow(PaperRecogniser(model), takes.accel_g(i), int(takes.activation[i]), rate_hz, i)
        for i in range(len(takes))
    ]
    return _count(model.labels, takes, answers, rate_hz)


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
    end_s = max(len(accel_g) / rate_hz, activation / rate_hz + 2.0 * SILENT_AFTER_S)
    answer = recogniser.check(end_s)
    if answer is not None:
        return answer
    now_s = activation / rate_hz
    return Recognition(activation_id, None, "the take ended", (), now_s, now_s, end_s)


def _count(
    known: tuple[str, ...], takes: TakeSet, answers: Sequence[Recognition], rate_hz: float
) -> Evaluation:
    labels = known + tuple(sorted(set(takes.labels) - set(known)))
    column = {label: k for k, label in enumerate(labels)}
    confusion = np.zeros((len(labels), len(labels) + 1), dtype=np.int64)
    for done, answer in zip(takes.labels, answers, strict=True):
        heard = len(labels) if answer.label is None else column[answer.label]
        confusion[column[done], heard] += 1
    took_ms = [
        1000.0 * (answer.decided_s - int(activation) / rate_hz)
        for answer, activation in zip(answers, takes.activation, strict=True)
    ]
    median, p95 = np.percentile(took_ms, [50, 95]).tolist() if took_ms else (0.0, 0.0)
    return Evaluation(labels, confusion, (median, p95))
