"""What gestures are recognised with: the model in use, and the recogniser that hears with it."""

from dataclasses import dataclass, replace
from pathlib import Path

from gestureapp.cell import events as e
from gestureapp.cell.records import Record, Recorder, Topic, fields_of
from gestureapp.errors import ModelError
from gestureapp.gestures import LABELS
from gestureapp.recognition.calibration import promise_of
from gestureapp.recognition.kinds import recogniser_for
from gestureapp.recognition.model_file import Model, load_model
from gestureapp.recognition.values import Recogniser, Recognition
from gestureapp.sensing.values import Sample

NO_MODEL = "no model"


@dataclass(frozen=True, slots=True)
class ModelInUse:
    """A model, opened.

    Attributes:
        recogniser: Hears with it; None when it cannot be used.
        words: Whose it is and how well it does, for the window.
        problem: Why nothing may be armed with it; empty when it may.
        remedy: What to do about that.
        person: Whose arms it is for; empty when that is for the settings to say.
    """

    recogniser: Recogniser | None
    words: str = NO_MODEL
    problem: str = ""
    remedy: str = "train a model, or choose another file"
    person: str = ""


def open_model(path: Path | None, problem: str = "", person: str = "") -> ModelInUse:
    """Open a model; what is wrong with it stands in the value.

    Args:
        path: Of its file; None when there is none.
        problem: Why it is out of date, or why there is none; empty when nothing is known.
        person: Whose arms it is for; empty when the model says so itself.
    """
    if path is None:
        why = problem or f"no model is set for {person or 'this person'}"
        return ModelInUse(None, problem=why, person=person)
    try:
        model = load_model(path)
        unknown = sorted(set(model.labels) - set(LABELS))
        if unknown:
            unfit = f"{path.name} knows gestures the robot does not: {unknown}"
            return ModelInUse(None, path.name, unfit)
        recogniser = recogniser_for(model)
    except (ModelError, ValueError) as error:
        return ModelInUse(None, problem=str(error))
    words = describe_model(model, path.stem)
    return ModelInUse(recogniser, words, problem, "train again", person or model.person)


def describe_model(model: Model, name: str = "") -> str:
    """Whose it is and how it did: ``Ana, 12 gestures, tried live: 93 % of 60``.

    Args:
        model: The model.
        name: Said of a model that is nobody's.
    """
    live = "not tried live"
    if model.live is not None:
        share = 100.0 * model.live.recognised / model.live.n
        live = f"tried live: {share:.0f} % of {model.live.n}"
    parts = [model.person or name, f"{len(model.labels)} gestures", live]
    if (promise := promise_of(model)) is not None:
        parts.append(promise[0].value)
    return ", ".join(parts)


class Ear:
    """Hears gestures with the model in use. Owned by the control thread.

    Args:
        model: The model at first.
        record: Takes every answer.

    Attributes:
        model: The one in use.
        recognition: The last answer, or None.
    """

    def __init__(self, model: ModelInUse, record: Recorder) -> None:
        self.model = model
        self.recognition: Recognition | None = None
        self._record = record
        self._next: ModelInUse | None = None
        self._activation_s: float | None = None

    def choose(self, model: ModelInUse) -> None:
        """Another model, taken when nothing may move."""
        self._next = model

    def take_choice(self) -> ModelInUse | None:
        """Change to the model that was chosen. Only while nothing may move.

        Returns:
            The model that is in use from now on; None when none was chosen.
        """
        chosen, self._next = self._next, None
        if chosen is not None:
            self.model, self.recognition = chosen, None
        return chosen

    def activate(self, activation_id: int, t_s: float) -> None:
        """The left arm has started."""
        self._activation_s = t_s
        if self.model.recogniser is not None:
            self.model.recogniser.activate(activation_id, t_s)

    def cancel(self) -> None:
        """No answer is wanted any more."""
        if self.model.recogniser is not None:
            self.model.recogniser.cancel()

    def feed(self, sample: Sample, now_s: float) -> e.Decided | None:
        """A sample of the right arm; what it decides."""
        recogniser = self.model.recogniser
        answer = recogniser.feed(sample.t_s, sample.accel_g) if recogniser is not None else None
        return self._decided(answer, now_s)

    def check(self, now_s: float) -> e.Decided | None:
        """Give up on samples that did not come in time."""
        recogniser = self.model.recogniser
        answer = recogniser.check(now_s) if recogniser is not None else None
        return self._decided(answer, now_s)

    def _decided(self, answer: Recognition | None, now_s: float) -> e.Decided | None:
        if answer is None:
            return None
        answer = replace(answer, decided_s=now_s, activation_s=self._activation_s)
        self.recognition = answer
        outputs = {c.label: c.confidence for c in answer.outputs}
        fields = {**fields_of(answer), "outputs": outputs}
        self._record(Record(Topic.RECOGNITION, now_s, fields))
        text = answer.reason if answer.label is None else f"recognised {answer.label}"
        return e.Decided(now_s, answer.activation_id, answer.label, text)
