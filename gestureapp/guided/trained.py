"""A person's model beside the takes that count now: what it came to, and whether it still fits."""

from collections.abc import Callable, Sequence
from datetime import datetime
from pathlib import Path
from typing import Final

import numpy as np

from gestureapp.errors import ModelError, RecordingError
from gestureapp.guided.trained_words import facts_of, promise_words, words_of
from gestureapp.guided.values import GuidedSnapshot, TrainingResult
from gestureapp.recognition.evaluation import tally
from gestureapp.recognition.model_file import Model, load_model
from gestureapp.recognition.takes import RATE_UNKNOWN_HZ, TakeSet
from gestureapp.recording.people import model_path
from gestureapp.recording.take_store import TakeStore, to_take_set
from gestureapp.recording.take_values import Take

TAKES_CHANGED: Final = "the takes have changed since the model was trained"
GESTURES_CHANGED: Final = "the gestures have changed since the model was trained"

Stamp = tuple[int, int]
"""When a file was written, and its size; (0, 0) without a file."""


def set_of(takes: Sequence[Take], person: str) -> TakeSet:
    """The takes that count, at the rate at which they came."""
    counting = [take for take in takes if take.counts]
    return to_take_set(counting, person, _rate_hz(counting))


def find_out_of_date(model: Model, takes: Sequence[Take], person: str) -> str:
    """Why a model does not fit the takes any more; empty when it does.

    Takes that were confirmed since are no reason: the model was right about them, or nearly so,
    and is as good as before. The next training learns from them.
    """
    counting = set_of(takes, person)
    if counting.fingerprint() == model.takes_fingerprint:
        return ""
    older = set_of([take for take in takes if not _is_confirmed_since(take, model)], person)
    if older.fingerprint() == model.takes_fingerprint:
        return ""
    return GESTURES_CHANGED if set(counting.labels) != set(model.labels) else TAKES_CHANGED


def result_of(model: Model) -> TrainingResult:
    """What the training of a model came to, from its file."""
    validation = model.cross_validation
    evaluation = tally(model.labels, ()) if validation is None else validation.evaluation
    return TrainingResult(
        words=("This model was not cross-validated.",)
        if validation is None
        else words_of(evaluation),
        evaluation=evaluation,
        folds="" if validation is None else validation.folds,
        facts=facts_of(model),
        duration_s=model.training.duration_s,
        promise=promise_words(model),
    )


def find_own_model(data: Path, person: str) -> tuple[Path, str] | None:
    """The model that a person has trained here, and why it is out of date; None without one.

    Nobody else may have the person's takes open.
    """
    try:
        path = model_path(data, person)
    except RecordingError:
        return None
    if not path.exists():
        return None
    try:
        store = TakeStore(data, person)
    except RecordingError as error:
        return path, f"the takes of the model cannot be read: {error}"
    try:
        out_of_date = find_out_of_date(load_model(path), store.takes(), store.person)
        return path, store.damage or out_of_date
    except ModelError:
        return path, ""  # who opens it will say what is wrong with it
    finally:
        store.close()


class KnownModel:
    """What is known of the open person's model; looked at again when something has changed.

    Owned by the trainer's thread.

    Attributes:
        path: Of its file, or None while nobody is chosen.
        result: What its training came to; None when there is no model, or an unreadable one.
        out_of_date: Why it does not fit the takes; empty when it does, or when there is none.
        trouble: Why the file cannot be read; empty when it can.
        is_other_person: The last look was the first one at this person.
    """

    def __init__(self) -> None:
        self.path: Path | None = None
        self.result: TrainingResult | None = None
        self.out_of_date = ""
        self.trouble = ""
        self.is_other_person = False
        self._model: Model | None = None
        self._person = ""
        self._version = -1
        self._stamp: Stamp = (0, 0)

    def look(
        self, data: Path, picture: GuidedSnapshot, takes: Callable[[], tuple[Take, ...]]
    ) -> bool:
        """Look at the takes and the file. Returns whether anything has changed."""
        self.is_other_person = picture.person != self._person
        self.path = model_path(data, picture.person) if picture.person else None
        stamp = _stamp_of(self.path)
        is_same_file = stamp == self._stamp and not self.is_other_person
        if is_same_file and picture.version == self._version:
            return False
        self._person, self._version, self._stamp = picture.person, picture.version, stamp
        before = (self.out_of_date, self.trouble)
        if not is_same_file:
            self._read()
        self.out_of_date = ""
        if self._model is not None:
            self.out_of_date = find_out_of_date(self._model, takes(), picture.person)
        return not is_same_file or before != (self.out_of_date, self.trouble)

    def _read(self) -> None:
        self._model, self.result, self.trouble = None, None, ""
        if self.path is None or self._stamp == (0, 0):
            return
        try:
            self._model = load_model(self.path)
        except ModelError as error:
            self.trouble = str(error)
        else:
            self.result = result_of(self._model)


def _is_confirmed_since(take: Take, model: Model) -> bool:
    try:
        made_s = datetime.fromisoformat(model.created).timestamp()
    except ValueError:
        return False
    return take.is_confirmed and take.wall_s >= made_s


def _rate_hz(takes: Sequence[Take]) -> float:
    """The nearest whole number of samples a second: the middle of all the times between two."""
    steps = [np.diff(take.times_s) for take in takes]
    middle_s = float(np.median(np.concatenate(steps))) if steps else 0.0
    return float(max(1, round(1.0 / middle_s))) if middle_s > 0.0 else RATE_UNKNOWN_HZ


def _stamp_of(path: Path | None) -> Stamp:
    try:
        found = path.stat() if path is not None else None
    except OSError:
        found = None
    return (found.st_mtime_ns, found.st_size) if found is not None else (0, 0)
