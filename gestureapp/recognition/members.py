"""Several networks of two hidden layers trained at once, each from its own share. Uses torch.

Only the training process imports this. The gradients are written by hand: it saves torch's own
bookkeeping, which takes longer than the passes on these sizes.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from gestureapp.recognition.ensemble import Ensemble, Layer
from gestureapp.recognition.network_batch import AdamSteps, Tensor, import_torch

F32 = NDArray[np.float32]
F64 = NDArray[np.float64]
I64 = NDArray[np.int64]

Progress = Callable[[int, int, float], None]
"""Called with steps done, steps in all, and the mean error of all networks now."""

RISING = 0.15
"""Share of the steps in which their size rises."""
FIRST_SHARE, LAST_SHARE = 1 / 25, 1e-4
"""Of the largest step, at the begin and at the end. Source: Smith and Topin, Super-convergence,
2018, one cycle; cosines between."""
NEW_OUTPUT = 0.1
"""Standard deviation of new weights into the outputs."""


@dataclass(frozen=True, slots=True)
class Layers:
    """Weights of k networks, inputs to outputs.

    Attributes:
        weights: Of each layer, shape (k, from, to).
        biases: Of each layer, shape (k, to).
    """

    weights: Sequence[F64]
    biases: Sequence[F64]

    def repeated(self, k: int) -> "Layers":
        """The first network k times."""
        return Layers(
            [np.repeat(w[:1], k, axis=0) for w in self.weights],
            [np.repeat(b[:1], k, axis=0) for b in self.biases],
        )

    def as_ensemble(self, mean: F64, scale: F64) -> Ensemble:
        """For recognising: all networks with inputs less ``mean``, divided by ``scale``."""
        k = len(self.weights[0])
        layers = tuple(Layer(w, b) for w, b in zip(self.weights, self.biases, strict=True))
        return Ensemble(np.tile(mean, (k, 1)), np.tile(scale, (k, 1)), layers)

    def part(self, first: int, count: int) -> "Layers":
        """``count`` of the networks, from this one on."""
        rows = slice(first, first + count)
        return Layers([w[rows] for w in self.weights], [b[rows] for b in self.biases])


@dataclass(frozen=True, slots=True)
class Steps:
    """How to learn.

    Attributes:
        count: Steps.
        rate: Size of the largest.
        batch: Views in each.
        decay: How much of the weights is taken off, relative to the step.
    """

    count: int
    rate: float
    batch: int
    decay: float


def no_progress(done: int, total: int, loss: float) -> None:
    """Tell nobody."""


def new_layers(sizes: Sequence[int], k: int, rng: np.random.Generator) -> Layers:
    """Networks by chance: of the size that keeps the layers' values about 1."""
    pairs = list(pairwise(sizes))
    weights = [rng.standard_normal((k, a, b)) / math.sqrt(a) for a, b in pairs]
    weights[-1] = NEW_OUTPUT * rng.standard_normal(weights[-1].shape)
    return Layers(weights, [np.zeros((k, b)) for _, b in pairs])


def with_new_outputs(layers: Layers, outputs: int, rng: np.random.Generator) -> Layers:
    """The same networks with outputs by chance."""
    k, hidden, _ = layers.weights[-1].shape
    last = NEW_OUTPUT * rng.standard_normal((k, hidden, outputs))
    return Layers([*layers.weights[:-1], last], [*layers.biases[:-1], np.zeros((k, outputs))])


def with_outputs_of(layers: Layers, columns: Sequence[int]) -> Layers:
    """The same networks with these of their outputs, in this order."""
    chosen = list(columns)
    return Layers(
        [*layers.weights[:-1], layers.weights[-1][:, :, chosen]],
        [*layers.biases[:-1], layers.biases[-1][:, chosen]],
    )


def joined_layers(parts: Sequence[Layers]) -> Layers:
    """All networks of all parts."""
    return Layers(
        [np.concatenate(same) for same in zip(*(p.weights for p in parts), strict=True)],
        [np.concatenate(same) for same in zip(*(p.biases for p in parts), strict=True)],
    )


def learn(
    layers: Layers,
    draw: Callable[[], tuple[F32, I64]],
    steps: Steps,
    progress: Progress,
) -> Layers:
    """Let the networks learn; the result is a copy.

    The error is the cross-entropy, averaged over a batch, in one cycle of Adam's steps with
    decoupled decay. Sources: Kingma and Ba 2015; Loshchilov and Hutter, Decoupled weight decay,
    ICLR 2019.

    Args:
        layers: Where to begin.
        draw: Gives each step's inputs, shape (k, batch, inputs), and outputs, shape (k, batch).
        steps: How.
        progress: Told fifty times; what it raises ends the training.
    """
    torch = import_torch()
    with torch.inference_mode():
        w = [torch.tensor(array, dtype=torch.float32) for array in layers.weights]
        b = [torch.tensor(array[:, None], dtype=torch.float32) for array in layers.biases]
        parts = tuple(w + b)
        adam = AdamSteps(steps.rate)
        report = max(1, steps.count // 50)
        for step in range(steps.count):
            inputs, outputs = draw()
            loss, slopes = _slopes(w, b, torch.from_numpy(inputs), torch.from_numpy(outputs))
            adam.rate = steps.rate * _share(step, steps.count)
            for part in parts:
                part.mul_(1.0 - adam.rate * steps.decay)
            adam(parts, slopes)
            if (step + 1) % report == 0 or step + 1 == steps.count:
                progress(step + 1, steps.count, float(loss))
        return Layers(
            [part.numpy().astype(np.float64) for part in w],
            [part[:, 0].numpy().astype(np.float64) for part in b],
        )


def _slopes(
    w: Sequence[Tensor], b: Sequence[Tensor], x: Tensor, y: Tensor
) -> tuple[Tensor, tuple[Tensor, ...]]:
    """The mean error, and the slopes of each network's error: of all weights, then all biases."""
    torch = import_torch()
    values = [x]
    for weight, bias in zip(w[:-1], b[:-1], strict=True):
        values.append(torch.baddbmm(bias, values[-1], weight).relu_())
    log_p = torch.baddbmm(b[-1], values[-1], w[-1]).log_softmax(dim=2)
    n = y.shape[1]
    loss = -log_p.gather(2, y[:, :, None]).mean()
    back = log_p.exp()
    back.scatter_add_(2, y[:, :, None], torch.full((*y.shape, 1), -1.0))
    back /= n
    of_weights: list[Tensor] = []
    of_biases: list[Tensor] = []
    for number in range(len(w) - 1, -1, -1):
        of_weights.insert(0, torch.bmm(values[number].transpose(1, 2), back))
        of_biases.insert(0, back.sum(dim=1, keepdim=True))
        if number:
            back = torch.bmm(back, w[number].transpose(1, 2)) * (values[number] > 0)
    return loss, (*of_weights, *of_biases)


def _share(step: int, count: int) -> float:
    """Of the largest step, at this one."""
    top = RISING * count - 1.0
    if step < top:
        return _between(FIRST_SHARE, 1.0, step / top)
    return _between(1.0, FIRST_SHARE * LAST_SHARE, (step - top) / max(1.0, count - 1 - top))


def _between(begin: float, end: float, share: float) -> float:
    return end + (begin - end) * 0.5 * (1.0 + math.cos(math.pi * share))
