"""What a training came to, in the words of the person whose arms it is. Pure.

The limits are shares of takes that were heard by networks that had not seen them:

* good: at least 90 % recognised and at most 3 % heard as another gesture. The paper's own figure is
  92 %, and a wrong gesture moves the robot where nobody wanted it, so that counts more.
* usable: at least 80 % recognised and at most 8 % heard as another gesture.
* everything below is called not reliable yet.
"""

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from enum import Enum

import numpy as np

from gestureapp.recognition.calibration import promise_of
from gestureapp.recognition.ensemble import Ensemble
from gestureapp.recognition.evaluation import Evaluation
from gestureapp.recognition.model_file import Model
from gestureapp.recognition.presets import MIN_TAKES

GOOD_RECOGNISED, GOOD_WRONG = 0.90, 0.03
USABLE_RECOGNISED, USABLE_WRONG = 0.80, 0.08
FEW_TAKES = 20
"""With fewer takes of a gesture its figures move by many per cent from one training to the next."""
OFTEN_CONFUSED = 0.08
"""Of two gestures' takes together, this share heard as the other one is worth a word."""
OFTEN_REJECTED = 0.20
MOST_HINTS = 3
MOST_NAMED = 4
MORE = "ten more"


class Level(Enum):
    """How far a model can be relied on."""

    GOOD = "Good."
    USABLE = "Usable."
    POOR = "Not reliable yet."


@dataclass(frozen=True, slots=True)
class _Hint:
    """Something to do about it; ``weight`` is how many takes it would save."""

    weight: float
    text: str


def level_of(evaluation: Evaluation) -> Level:
    """How far it can be relied on; the limits stand above."""
    recognised, wrong = evaluation.recognised, evaluation.wrong
    if recognised >= GOOD_RECOGNISED and wrong <= GOOD_WRONG:
        return Level.GOOD
    if recognised >= USABLE_RECOGNISED and wrong <= USABLE_WRONG:
        return Level.USABLE
    return Level.POOR


def words_of(evaluation: Evaluation) -> tuple[str, ...]:
    """A judgement, then what to record more of, the most useful first; one sentence each."""
    n = evaluation.n
    if not n:
        return ("Nothing was heard: there are no takes.",)
    summary = (
        f"{level_of(evaluation).value} Of {n} takes {_share(evaluation.recognised)} are recognised,"
        f" {_share(evaluation.wrong)} heard as another gesture,"
        f" {_share(evaluation.rejected)} not recognised."
    )
    hints = sorted(_hints(evaluation), key=lambda hint: -hint.weight)[:MOST_HINTS]
    return summary, *(hint.text for hint in hints), *_few(evaluation)


def promise_words(model: Model) -> str:
    """Whether at most 1 in 200 answers is wrong, and on what that rests; empty for other kinds."""
    found = promise_of(model)
    return f"{found[0].value.capitalize()}; {found[1]}." if found is not None else ""


def missing_words(labels: Iterable[str]) -> str:
    """What is missing for a training from takes with these labels; empty when nothing is."""
    counts = Counter(labels)
    if len(counts) < 2:
        return f"at least two gestures with {MIN_TAKES} good takes each are needed: record more"
    few = [f"{label} has {n}" for label, n in counts.items() if n < MIN_TAKES]
    if not few:
        return ""
    if len(few) > MOST_NAMED:
        few[MOST_NAMED:] = [f"{len(few) - MOST_NAMED} others have too few"]
    return (
        f"{', '.join(few)} good takes: at least {MIN_TAKES} of a gesture are needed; "
        "record more, or exclude those that are there"
    )


def facts_of(model: Model) -> tuple[tuple[str, str], ...]:
    """The technical part: name and value, in the order to show."""
    record, validation = model.training, model.cross_validation
    facts = [
        ("preset", record.preset),
        ("network", _network_words(model)),
        ("takes", str(record.n_takes)),
        ("from", record.takes_from),
        ("passes", f"{record.cycles:,}"),
        ("learning rate", f"{record.learning_rate:g}"),
        ("error at the end", f"{record.loss:.4f}"),
        ("seed", str(record.seed)),
        ("trained in", f"{record.duration_s:.1f} s"),
        ("trained at", model.created),
        ("rule", record.rule),
        ("fingerprint of the takes", model.takes_fingerprint),
        ("application", model.app_version),
    ]
    if validation is not None:
        median, p95 = validation.evaluation.decision_ms
        answer = f"{median:.0f} ms after the activation, 95 % within {p95:.0f} ms"
        facts[4:4] = [("cross-validated", validation.folds), ("answer", answer)]
    return tuple((name, value) for name, value in facts if value)


def _network_words(model: Model) -> str:
    layers = "-".join(map(str, model.shape))
    if isinstance(model.network, Ensemble):
        return f"{layers}, rectified, softmax, mean of {model.network.members}"
    return f"{layers}, sigmoid"


def _hints(evaluation: Evaluation) -> Iterable[_Hint]:
    labels, confusion = evaluation.labels, evaluation.confusion
    done = confusion.sum(axis=1)
    for a in range(len(labels)):
        for b in range(a + 1, len(labels)):
            mixed, both = int(confusion[a, b] + confusion[b, a]), int(done[a] + done[b])
            if both and mixed / both >= OFTEN_CONFUSED:
                pair = f"{labels[a]} and {labels[b]}"
                yield _Hint(2.0 * mixed, f"{pair} are often confused: record {MORE} of each.")
    for row, (label, (_, _, rejected)) in _rows(evaluation):
        if rejected >= OFTEN_REJECTED:
            text = (
                f"{label} is often not recognised: record {MORE}, "
                "and begin both arms at the same time."
            )
            yield _Hint(rejected * float(done[row]), text)


def _few(evaluation: Evaluation) -> tuple[str, ...]:
    done = evaluation.confusion.sum(axis=1)
    few = [label for label, n in zip(evaluation.labels, done, strict=True) if 0 < n < FEW_TAKES]
    if not few:
        return ()
    if np.all(done < FEW_TAKES):
        return (f"With fewer than {FEW_TAKES} takes of a gesture these figures are rough.",)
    verb = "has" if len(few) == 1 else "have"
    return (f"{', '.join(few)} {verb} fewer than {FEW_TAKES} takes: the figures are rough there.",)


def _rows(evaluation: Evaluation) -> Iterable[tuple[int, tuple[str, tuple[float, float, float]]]]:
    shares = evaluation.per_gesture()
    for row, label in enumerate(evaluation.labels):
        if label in shares:
            yield row, (label, shares[label])


def _share(value: float) -> str:
    return f"{100.0 * value:.0f} %"
