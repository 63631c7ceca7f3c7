"""Many small networks trained at once: same takes, different starts, each with its own share.

Only the training process imports this: it needs torch. One pass costs little more for fifty
networks than for one, so the folds of a cross-validation and several starts come in one training.
"""

from contextlib import AbstractContextManager
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from gestureapp.recognition.network import Network

F64 = NDArray[np.float64]
Tensor = Any
"""torch has no part in the static types here: it is imported late, by this process only."""

HIDDEN = 10
"""Hidden neurons. Source: paper, IV.C."""
_FIRST_WEIGHTS = 0.5
"""First weights are even between minus and plus this: the sigmoids start where they are steep."""


class Stepper(Protocol):
    """A learning rule: turns gradients into steps of the weights, in place."""

    def __call__(self, weights: tuple[Tensor, ...], slopes: tuple[Tensor, ...]) -> None:
        """Change the weights, given the slopes of the error."""


class NetworkBatch:
    """k three-layer sigmoid networks over the same n takes, in buffers that are allocated once.

    The error of a network is half the squared error of its outputs, summed over the outputs and
    averaged over the takes it learns from. Owned by one thread.

    Args:
        first: Weights into the hidden layer, shape (k, inputs + 1, hidden), the bias last.
        second: Weights into the outputs, shape (k, hidden + 1, outputs), the bias last.
        targets: Shape (n, outputs).
        share: True where a network learns from a take; shape (k, n), one at least in each row.
    """

    def __init__(self, first: F64, second: F64, targets: F64, share: NDArray[np.bool_]) -> None:
        torch = self._torch = import_torch()
        k, n_inputs, hidden = first.shape
        n, outputs = targets.shape
        self.first = _tensor(first.transpose(0, 2, 1).reshape(k * hidden, n_inputs))
        self.second = _tensor(second.transpose(0, 2, 1))
        self._shape = (k, hidden, n_inputs)
        self._targets = _tensor(targets.T)[None]
        weight = share / share.sum(axis=1, keepdims=True)
        self._weight = _tensor(weight[:, None, :])
        self._x = torch.ones((n_inputs, n))
        self._h = torch.ones((k, hidden + 1, n))
        self._z, self._slope_h = torch.empty((k, hidden, n)), torch.empty((k, hidden, n))
        self._y, self._d, self._slope_y = (torch.empty((k, outputs, n)) for _ in range(3))
        self._d_h = torch.empty((k, hidden, n))
        self._slopes = torch.empty_like(self.first), torch.empty_like(self.second)

    def show(self, inputs: F64 | None = None) -> None:
        """Show all takes, shape (n, inputs), to all networks; None: those of the last time."""
        if inputs is not None:
            self._x[:-1] = _tensor(inputs.T)
        k, hidden, _ = self._shape
        self._torch.mm(self.first, self._x, out=self._z.view(k * hidden, -1))
        self._torch.sigmoid(self._z, out=self._z)
        self._h[:, :-1] = self._z
        self._torch.bmm(self.second, self._h, out=self._y).sigmoid_()

    def losses(self, share: NDArray[np.bool_]) -> F64:
        """Each network's error over its share, shape (k, n), of what was shown last."""
        weight = _tensor(share / np.maximum(share.sum(axis=1, keepdims=True), 1))
        squared = (self._y - self._targets).square_().sum(dim=1)
        return np.asarray((squared * weight).sum(dim=1).numpy() / 2.0, dtype=np.float64)

    def learn(self, step: Stepper) -> None:
        """One step against the gradient over what was shown last."""
        torch = self._torch
        h, y, d = self._h[:, :-1], self._y, self._d
        torch.sub(y, self._targets, out=d)
        d.mul_(self._weight)
        torch.addcmul(y, y, y, value=-1, out=self._slope_y)
        d.mul_(self._slope_y)
        torch.bmm(self.second[:, :, :-1].transpose(1, 2), d, out=self._d_h)
        torch.addcmul(h, h, h, value=-1, out=self._slope_h)
        self._d_h.mul_(self._slope_h)
        k, hidden, _ = self._shape
        torch.mm(self._d_h.view(k * hidden, -1), self._x.T, out=self._slopes[0])
        torch.bmm(d, self._h.transpose(1, 2), out=self._slopes[1])
        step((self.first, self.second), self._slopes)

    def copy_weights(self) -> tuple[F64, F64]:
        """All weights now: (k, hidden, inputs + 1) and (k, outputs, hidden + 1), the bias last."""
        first = self.first.view(self._shape).numpy().astype(np.float64)
        return first, self.second.numpy().astype(np.float64)


class PlainSteps:
    """Steps of one size against the gradient: back-propagation without momentum."""

    def __init__(self, rate: float) -> None:
        self._rate = rate

    def __call__(self, weights: tuple[Tensor, ...], slopes: tuple[Tensor, ...]) -> None:
        """Take the step."""
        for w, slope in zip(weights, slopes, strict=True):
            w.sub_(slope, alpha=self._rate)


class AdamSteps:
    """Adam with its usual constants. Source: Kingma and Ba, Adam, ICLR 2015, algorithm 1.

    Attributes:
        rate: Size of the steps; may be changed between them.
    """

    def __init__(self, rate: float) -> None:
        self.rate, self._n = rate, 0
        self._means: list[Tensor] = []
        self._squares: list[Tensor] = []

    def __call__(self, weights: tuple[Tensor, ...], slopes: tuple[Tensor, ...]) -> None:
        """Take the step."""
        if not self._n:
            self._means = [slope * 0.0 for slope in slopes]
            self._squares = [slope * 0.0 for slope in slopes]
        self._n += 1
        size = self.rate / (1.0 - 0.9**self._n)
        even = (1.0 - 0.999**self._n) ** 0.5
        for w, slope, mean, square in zip(weights, slopes, self._means, self._squares, strict=True):
            mean.lerp_(slope, 0.1)
            square.mul_(0.999).addcmul_(slope, slope, value=0.001)
            w.addcdiv_(mean, square.sqrt().div_(even).add_(1e-8), value=-size)


def first_weights(seed: int, starts: int, inputs: int, outputs: int) -> tuple[F64, F64]:
    """Where networks start: (starts, inputs + 1, hidden) and (starts, hidden + 1, outputs)."""
    rng = np.random.default_rng([seed, 0])
    first = rng.uniform(-_FIRST_WEIGHTS, _FIRST_WEIGHTS, (starts, inputs + 1, HIDDEN))
    second = rng.uniform(-_FIRST_WEIGHTS, _FIRST_WEIGHTS, (starts, HIDDEN + 1, outputs))
    return first, second


def network_of(first: F64, second: F64, offset: F64, scale: float) -> Network:
    """One network from weights as they are trained, for inputs as the recogniser gives them.

    Args:
        first: Shape (hidden, inputs + 1), the bias last.
        second: Shape (outputs, hidden + 1), the bias last.
        offset: What was taken from the inputs before training, shape (inputs,).
        scale: What they were divided by after that.
    """
    hidden = first[:, :-1] / scale
    return Network(hidden, first[:, -1] - hidden @ offset, second[:, :-1], second[:, -1])


def by_hand() -> AbstractContextManager[None]:
    """Keeps torch from its own bookkeeping of gradients: they are written by hand here."""
    context: AbstractContextManager[None] = import_torch().inference_mode()
    return context


def import_torch() -> Tensor:
    """Torch, imported when it is first needed, on one thread: two are slower on these sizes."""
    import torch

    if torch.get_num_threads() != 1:
        torch.set_num_threads(1)
    return torch


def _tensor(values: F64) -> Tensor:
    return import_torch().tensor(np.ascontiguousarray(values), dtype=import_torch().float32)
