"""Model files: a trained network with what made it, as readable JSON."""

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import NoReturn

import numpy as np

from gestureapp.errors import ModelInvalid
from gestureapp.recognition.decision import Decision
from gestureapp.recognition.ensemble import Ensemble
from gestureapp.recognition.evaluation import Evaluation
from gestureapp.recognition.fields import (
    LARGEST_COUNT,
    count_in,
    labels_in,
    number_in,
    object_in,
    table_in,
    text_in,
)
from gestureapp.recognition.files import write_atomically
from gestureapp.recognition.model_weights import (
    decision_in,
    decision_of,
    network_in,
    weights_of,
)
from gestureapp.recognition.network import Network

FORMAT = "gestureapp model"
SCHEMA = 1
INPUT_PAPER = (
    "specific force in g of the first three samples at or after the activation: "
    "x, y, z of the first, then of the second, then of the third"
)
LARGEST_FILE = 16_000_000
"""Bytes; a model takes some 10 kB, of kind ``onset`` some 500 kB."""


@dataclass(frozen=True, slots=True)
class TrainingRecord:
    """What made a model.

    Attributes:
        preset: Name of the recipe.
        rule: The learning rule in words.
        cycles: Passes over the takes.
        learning_rate: Step size.
        seed: Of the first weights (and of the held-out takes).
        n_takes: How many takes it has learned from, held-out ones included.
        loss: Final error: half the squared error summed over the outputs, averaged over the takes.
        duration_s: How long it took.
        takes_from: Where the takes came from, in words.
        rate_hz: Sample rate of the takes; None when unknown. A network of kind ``paper`` is for
            sensors of this rate.
    """

    preset: str
    rule: str
    cycles: int
    learning_rate: float
    seed: int
    n_takes: int
    loss: float
    duration_s: float
    takes_from: str = ""
    rate_hz: float | None = None


@dataclass(frozen=True, slots=True)
class CrossValidation:
    """How well networks trained as the model's did on takes that they had not seen.

    Attributes:
        evaluation: Of all takes, each heard by a network that was trained without it.
        folds: How the takes were divided, in words: ``by session: 3 sessions``.
    """

    evaluation: Evaluation
    folds: str


@dataclass(frozen=True, slots=True)
class LiveFigure:
    """How a model did when it was tried without the robot. Counts of gestures asked for.

    Attributes:
        n: Gestures asked for; the sum of the three others.
        recognised: Heard as what was asked.
        wrong: Heard as another gesture.
        rejected: Not recognised.
        when: Wall time, ISO 8601 with zone; for people only.
    """

    n: int
    recognised: int
    wrong: int
    rejected: int
    when: str

    def __post_init__(self) -> None:
        counts = (self.recognised, self.wrong, self.rejected)
        if min(counts) < 0 or self.n < 1 or sum(counts) != self.n:
            raise ValueError(f"'live': {counts} do not add up to {self.n} gestures")

    @classmethod
    def of(cls, evaluation: Evaluation, when: str) -> "LiveFigure":
        """From the table of a live test of at least one gesture."""
        confusion, n = evaluation.confusion, evaluation.n
        recognised, rejected = int(confusion.trace()), int(confusion[:, -1].sum())
        return cls(n, recognised, n - recognised - rejected, rejected, when)


@dataclass(frozen=True, slots=True)
class Model:
    """A trained network, for one person and one gesture set.

    Attributes:
        kind: Which recogniser it is for: ``paper`` or ``onset``.
        labels: The gestures, in the order of the outputs. A network of kind ``onset`` has one
            output more, the last: "none of them".
        network: The weights.
        person: Whose takes it was trained from; empty when unknown or several.
        training: What made it.
        takes_fingerprint: ``TakeSet.fingerprint()`` of those takes.
        app_version: Version of the application that made it.
        created: Wall time, ISO 8601 with zone; for people only.
        input_words: What the inputs are.
        cross_validation: How networks like this one did on unseen takes, or None when not known.
        live: How it did when it was tried, or None before.
        decision: How sure is sure enough; with kind ``onset`` only.
    """

    kind: str
    labels: tuple[str, ...]
    network: Network | Ensemble
    person: str
    training: TrainingRecord
    takes_fingerprint: str
    app_version: str
    created: str
    input_words: str = INPUT_PAPER
    cross_validation: CrossValidation | None = None
    live: LiveFigure | None = None
    decision: Decision | None = None

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of inputs, of each hidden layer's neurons, and of outputs."""
        return self.network.shape


def save_model(path: Path, model: Model) -> None:
    """Write a model file, atomically.

    Raises:
        DiskFull: no room is left there.
        RecordingError: it cannot be written there.
    """
    network = model.network
    content: dict[str, object] = {
        "format": FORMAT,
        "schema": SCHEMA,
        "kind": model.kind,
        "person": model.person,
        "labels": list(model.labels),
        "shape": list(network.shape),
        "input": model.input_words,
        "training": asdict(model.training),
        "takes_fingerprint": model.takes_fingerprint,
        "app_version": model.app_version,
        "created": model.created,
        "weights": weights_of(network),
    }
    if model.decision is not None:
        content["decision"] = decision_of(model.decision)
    if model.cross_validation is not None:
        content["cross_validation"] = _plain(model.cross_validation)
    if model.live is not None:
        content["live"] = asdict(model.live)
    text = json.dumps(content, indent=1, ensure_ascii=False, allow_nan=False)
    write_atomically(path, text.encode() + b"\n")


def load_model(path: Path) -> Model:
    """Read a model file.

    Raises:
        ModelInvalid: it cannot be read, is no model, is damaged, or is from a newer version.
    """
    content = _read_object(path)
    if content.get("format") != FORMAT:
        raise ModelInvalid(path, "is not a model of this application")
    schema = content.get("schema")
    if not isinstance(schema, int) or schema < 1:
        raise ModelInvalid(path, f"has no usable schema version (found {schema!r})")
    if schema > SCHEMA:
        raise ModelInvalid(
            path,
            f"is from a newer version (schema {schema}, this one reads up to {SCHEMA}); update",
        )
    try:
        return _model(content)
    except ValueError as error:
        raise ModelInvalid(path, f"is damaged: {error}; train it again") from error


def with_live(path: Path, live: LiveFigure) -> Model:
    """Keep with a model file how the model did when it was tried; atomically.

    Raises:
        ModelInvalid: the file cannot be read, or is damaged.
        DiskFull: no room is left there; the old file is untouched.
        RecordingError: it cannot be written; the old file is untouched.
    """
    model = replace(load_model(path), live=live)
    save_model(path, model)
    return model


def _plain(validation: CrossValidation) -> dict[str, object]:
    evaluation = validation.evaluation
    median, p95 = evaluation.decision_ms
    return {
        "folds": validation.folds,
        "labels": list(evaluation.labels),
        "confusion": evaluation.confusion.tolist(),
        "decision_ms": {"median": median, "p95": p95},
    }


def _read_object(path: Path) -> Mapping[str, object]:
    try:
        if path.stat().st_size > LARGEST_FILE:
            raise ModelInvalid(path, "is far too large for a model")
        content = json.loads(path.read_bytes().decode("utf-8"), parse_constant=_refuse_constant)
    except OSError as error:
        raise ModelInvalid(path, f"cannot be read: {error.strerror or error}") from error
    except (ValueError, RecursionError) as error:
        cause = (str(error) or type(error).__name__).splitlines()[0]
        raise ModelInvalid(path, f"is not a readable model file: {cause}") from error
    if not isinstance(content, dict):
        raise ModelInvalid(path, "is not a model of this application")
    return content


def _model(content: Mapping[str, object]) -> Model:
    kind, labels = text_in(content, "kind"), labels_in(content.get("labels"))
    network = network_in(content, kind, len(labels))
    return Model(
        kind=kind,
        labels=labels,
        network=network,
        person=text_in(content, "person"),
        training=_training(object_in(content, "training")),
        takes_fingerprint=text_in(content, "takes_fingerprint"),
        app_version=text_in(content, "app_version"),
        created=text_in(content, "created"),
        input_words=text_in(content, "input"),
        cross_validation=_cross_validation(content),
        live=_live(content),
        decision=decision_in(content, kind),
    )


def _training(record: Mapping[str, object]) -> TrainingRecord:
    return TrainingRecord(
        preset=text_in(record, "preset"),
        rule=text_in(record, "rule"),
        cycles=int(number_in(record, "cycles")),
        learning_rate=number_in(record, "learning_rate"),
        seed=int(number_in(record, "seed")),
        n_takes=int(number_in(record, "n_takes")),
        loss=number_in(record, "loss"),
        duration_s=number_in(record, "duration_s"),
        takes_from=text_in(record, "takes_from"),
        rate_hz=None if record.get("rate_hz") is None else number_in(record, "rate_hz"),
    )


def _cross_validation(content: Mapping[str, object]) -> CrossValidation | None:
    """Absent in files of older versions."""
    if content.get("cross_validation") is None:
        return None
    found = object_in(content, "cross_validation")
    labels, times = labels_in(found.get("labels")), object_in(found, "decision_ms")
    counts = table_in(found, "confusion", 2)
    if counts.shape != (len(labels), len(labels) + 1):
        raise ValueError(f"'confusion' has shape {counts.shape} for {len(labels)} labels")
    if np.any(counts < 0) or np.any(counts != np.floor(counts)) or np.any(counts > LARGEST_COUNT):
        raise ValueError("'confusion' must hold counts")
    took_ms = (number_in(times, "median"), number_in(times, "p95"))
    evaluation = Evaluation(labels, counts.astype(np.int64), took_ms)
    return CrossValidation(evaluation, text_in(found, "folds"))


def _live(content: Mapping[str, object]) -> LiveFigure | None:
    """Absent in files of older versions, and before the model was tried."""
    if content.get("live") is None:
        return None
    found = object_in(content, "live")
    n, recognised, wrong, rejected = (
        count_in(found, name) for name in ("n", "recognised", "wrong", "rejected")
    )
    return LiveFigure(n, recognised, wrong, rejected, text_in(found, "when"))


def _refuse_constant(name: str) -> NoReturn:
    raise ValueError(f"it holds {name}")
