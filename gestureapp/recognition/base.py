"""The shared base model and what is no gesture: where every person's training begins."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import gestureapp
from gestureapp.errors import ModelInvalid
from gestureapp.recognition.ensemble import Ensemble
from gestureapp.recognition.members import Layers
from gestureapp.recognition.model_file import load_model
from gestureapp.recognition.takes import TakeSet, load_takes

F32 = NDArray[np.float32]
F64 = NDArray[np.float64]

FOLDER = Path(gestureapp.__file__).resolve().parent.parent / "resources" / "models"
BASE, NEGATIVES = FOLDER / "base.json", FOLDER / "negatives.npz"
GESTURES = FOLDER / "gestures.npz"


@dataclass(frozen=True, slots=True)
class Base:
    """The base model, and what is no gesture.

    Attributes:
        labels: The gestures that the base knows; one more output is "none of them".
        ensemble: Its network, one member.
        negatives: Takes of what is no gesture; their labels say what it is.
        gestures: Some takes of every gesture, by people of the base.
    """

    labels: tuple[str, ...]
    ensemble: Ensemble
    negatives: TakeSet
    gestures: TakeSet

    @property
    def layers(self) -> Layers:
        """Its weights."""
        layers = self.ensemble.layers
        return Layers([layer.weights for layer in layers], [layer.bias for layer in layers])

    def knows(self, labels: Sequence[str]) -> bool:
        """Whether all of these are gestures of the base."""
        return set(labels) <= set(self.labels)

    def untaught(self, labels: Sequence[str]) -> TakeSet | None:
        """Takes of the gestures that are not among these, to learn that they are none of them.

        None when all are; and with gestures of other names, as any of them may be one of these.
        """
        if not self.knows(labels) or set(labels) == set(self.labels):
            return None
        rows = [i for i, label in enumerate(self.gestures.labels) if label not in labels]
        return self.gestures.select(rows)

    def columns(self, labels: Sequence[str]) -> list[int]:
        """The base's outputs for these gestures, and for "none of them"."""
        return [*(self.labels.index(label) for label in labels), len(self.labels)]

    def scaled(self, inputs: F64) -> F32:
        """Inputs as the networks take them."""
        found: F32 = ((inputs - self.ensemble.mean[0]) / self.ensemble.scale[0]).astype(np.float32)
        return found

    def ensemble_of(self, layers: Layers) -> Ensemble:
        """Members that were trained from this base, for recognising."""
        return layers.as_ensemble(self.ensemble.mean[0], self.ensemble.scale[0])


def load_base() -> Base:
    """The files that come with the application.

    Raises:
        ModelInvalid: the base model cannot be read, or is none.
        RecordingInvalid: the takes that come with it cannot be read.
    """
    model = load_model(BASE)
    if not isinstance(model.network, Ensemble):
        raise ModelInvalid(BASE, "is no base model; install the application again")
    return Base(model.labels, model.network, load_takes(NEGATIVES), load_takes(GESTURES))
