"""The paper's network: one hidden layer of sigmoid neurons, sigmoid outputs. Pure, numpy only."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

F64 = NDArray[np.float64]

_SATURATED = 60.0
"""Beyond this a sigmoid is 0 or 1 to the last bit that matters; exp of more may overflow."""


@dataclass(frozen=True, slots=True)
class Network:
    """Weights of a three-layer network; copied and read-only. Any thread.

    Attributes:
        hidden: Shape (hidden, inputs).
        hidden_bias: Shape (hidden,).
        output: Shape (outputs, hidden).
        output_bias: Shape (outputs,).

    Raises:
        ValueError: the shapes do not fit each other, or a weight is not finite.
    """

    hidden: F64
    hidden_bias: F64
    output: F64
    output_bias: F64

    def __post_init__(self) -> None:
        for name in ("hidden", "hidden_bias", "output", "output_bias"):
            weights = np.array(getattr(self, name), dtype=np.float64)
            if not np.all(np.isfinite(weights)):
                raise ValueError(f"the weights '{name}' hold a number that is not finite")
            weights.setflags(write=False)
            object.__setattr__(self, name, weights)
        if self.hidden.ndim != 2 or self.output.ndim != 2 or not self.hidden.size:
            raise ValueError("the weights of both layers must be tables")
        hidden, outputs = self.hidden.shape[0], self.output.shape[0]
        if (
            self.output.shape[1] != hidden
            or self.hidden_bias.shape != (hidden,)
            or self.output_bias.shape != (outputs,)
        ):
            raise ValueError("the shapes of the weights do not fit each other")

    @property
    def shape(self) -> tuple[int, int, int]:
        """Number of inputs, hidden neurons and outputs."""
        return self.hidden.shape[1], self.hidden.shape[0], self.output.shape[0]

    def outputs(self, inputs: F64) -> F64:
        """Outputs between 0 and 1 for one pattern, or for many.

        Args:
            inputs: Shape (inputs,) or (n, inputs), in g.

        Returns:
            Shape (outputs,) or (n, outputs). A pattern with a NaN gives NaN.

        Source: paper, equation 5, with F the logistic function.
        """
        hidden = _sigmoid(inputs @ self.hidden.T + self.hidden_bias)
        return _sigmoid(hidden @ self.output.T + self.output_bias)


def _sigmoid(z: F64) -> F64:
    values: F64 = 1.0 / (1.0 + np.exp(-np.minimum(np.maximum(z, -_SATURATED), _SATURATED)))
    return values
