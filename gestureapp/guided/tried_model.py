"""The model of a live test: opened at its begin, told its live figure at the end."""

from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

from gestureapp.cell.ear import open_model
from gestureapp.errors import ModelError, RecordingError
from gestureapp.recognition.evaluation import Evaluation
from gestureapp.recognition.model_file import LiveFigure, load_model, save_model
from gestureapp.recognition.values import Recogniser

NO_MODEL_YET = "There is no model yet: train one first."
CHANGED = "The model was trained anew while it was tried: the figure is not kept. Try again."


class TriedModel:
    """A model file that is tried.

    Args:
        path: Where it is, or would be.

    Attributes:
        recogniser: Fresh; None when the model cannot be used.
        problem: Why it cannot; one line.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self.recogniser: Recogniser | None = None
        self.problem = NO_MODEL_YET
        if not path.exists():
            return
        try:
            self._created = load_model(path).created
        except ModelError as error:
            self.problem = str(error)
            return
        model = open_model(path)
        self.recogniser, self.problem = model.recogniser, model.problem

    def keep(self, evaluation: Evaluation, wall_s: float) -> str:
        """Write the live figure into the model file, atomically; why it could not be, or empty.

        Args:
            evaluation: Of the whole test, at least one gesture.
            wall_s: Now, seconds since the epoch.
        """
        when = datetime.fromtimestamp(wall_s, UTC).isoformat(timespec="seconds")
        try:
            model = load_model(self._path)
            if model.created != self._created:
                return CHANGED
            save_model(self._path, replace(model, live=LiveFigure.of(evaluation, when)))
        except (ModelError, RecordingError) as error:
            return f"The figure could not be kept with the model: {error}"
        return ""
