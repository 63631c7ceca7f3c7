"""The onset-aligned recogniser's networks: several, their probabilities averaged. Pure."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

F64 = NDArray[np.float64]

DIGITS = 5
"""Significant digits of every weight: a file of three members is then some 500 kB."""
NEARLY_ZERO = 1e-12
LARGEST = 1e6
"""Weights of trained networks are far below; with this no sum overflows."""
LEAST_SCALE = 1e-3


@dataclass(frozen=True, slots=True)
class Layer:
    """One layer of every member; rounded to ``DIGITS``, copied and read-only.

    Attributes:
        weights: Shape (members, inputs, outputs).
        bias: Shape (members, outputs).

    Raises:
        ValueError: the shapes do not fit, or a number is not finite.
    """

    weights: F64
    bias: F64

    def __post_init__(self) -> None:
        for name in ("weights", "bias"):
            object.__setattr__(self, name, _rounded(name, getattr(self, name)))
        if self.weights.ndim != 3 or not self.weights.size:
            raise ValueError("the weights of a layer must have three dimensions")
        if self.bias.shape != (self.weights.shape[0], self.weights.shape[2]):
            raise ValueError("the shapes of the weights do not fit each other")


@dataclass(frozen=True, slots=True)
class Ensemble:
    """Networks with rectified hidden layers and a softmax over the outputs. Any thread.

    Rounded when it is made, so that the one that was judged is the one in the file.

    Attributes:
        mean: Taken from the inputs, shape (members, inputs).
        scale: Then they are divided by this, at least ``LEAST_SCALE``, the same shape.
        layers: From the inputs to the outputs.
        temperature: Divides the last sums: above 1 less sure, below 1 surer.

    Raises:
        ValueError: the shapes do not fit each other, or a number cannot be used.
    """

    mean: F64
    scale: F64
    layers: tuple[Layer, ...]
    temperature: float = 1.0

    def __post_init__(self) -> None:
        for name in ("mean", "scale"):
            object.__setattr__(self, name, _rounded(name, getattr(self, name)))
        if not self.layers:
            raise ValueError("there is no layer")
        members, inputs, _ = self.layers[0].weights.shape
        for layer in self.layers:
            if layer.weights.shape[:2] != (members, inputs):
                raise ValueError("the shapes of the weights do not fit each other")
            inputs = layer.weights.shape[2]
        if (
            self.mean.shape != self.layers[0].weights.shape[:2]
            or self.scale.shape != self.mean.shape
        ):
            raise ValueError("'mean' and 'scale' do not fit the weights")
        if np.any(self.scale < LEAST_SCALE):
            raise ValueError(f"'scale' must be at least {LEAST_SCALE:g}")
        if not 0.01 <= self.temperature <= 100.0:
            raise ValueError(f"'temperature' is {self.temperature}, expected 0.01 to 100")

    @property
    def members(self) -> int:
        """How many networks."""
        return int(self.mean.shape[0])

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of inputs, of each hidden layer's neurons, and of outputs."""
        return (self.mean.shape[1], *(layer.weights.shape[2] for layer in self.layers))

    def outputs(self, inputs: F64) -> F64:
        """Probabilities, averaged over the members.

        Args:
            inputs: Shape (inputs,) or (n, inputs).

        Returns:
            Shape (outputs,) or (n, outputs); each row sums to 1.
        """
        sums = self.sums(np.atleast_2d(inputs)) / self.temperature
        powers = np.exp(sums - sums.max(axis=-1, keepdims=True))
        shares: F64 = (powers / powers.sum(axis=-1, keepdims=True)).mean(axis=0)
        return shares[0] if inputs.ndim == 1 else shares

    def sums(self, inputs: F64) -> F64:
        """What each member's softmax is taken of, before the temperature.

        Args:
            inputs: Shape (n, inputs).

        Returns:
            Shape (members, n, outputs).
        """
        values = (inputs - self.mean[:, None]) / self.scale[:, None]
        for layer in self.layers[:-1]:
            values = np.maximum(values @ layer.weights + layer.bias[:, None], 0.0)
        last = self.layers[-1]
        sums: F64 = values @ last.weights + last.bias[:, None]
        return sums


def _rounded(name: str, numbers: F64) -> F64:
    values = np.array(numbers, dtype=np.float64)
    if not np.all(np.isfinite(values)):
        raise ValueError(f"the weights '{name}' hold a number that is not finite")
    if np.any(np.abs(values) > LARGEST):
        raise ValueError(f"the weights '{name}' hold a number beyond {LARGEST:g}")
    size = np.floor(np.log10(np.maximum(np.abs(values), NEARLY_ZERO)))
    power = 10.0 ** (DIGITS - 1 - size)
    rounded: F64 = np.round(values * power) / power
    rounded.setflags(write=False)
    return rounded
