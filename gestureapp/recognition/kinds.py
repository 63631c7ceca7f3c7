"""Which recogniser a model is for."""

from gestureapp.recognition.model_file import Model
from gestureapp.recognition.model_weights import KIND_ONSET
from gestureapp.recognition.onset import OnsetRecogniser
from gestureapp.recognition.paper import PaperRecogniser
from gestureapp.recognition.values import Recogniser


def recogniser_for(model: Model) -> Recogniser:
    """A fresh recogniser that hears with this model.

    Raises:
        ValueError: the model does not fit its kind.
    """
    return OnsetRecogniser(model) if model.kind == KIND_ONSET else PaperRecogniser(model)
