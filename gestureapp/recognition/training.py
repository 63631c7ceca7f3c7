"""Training of the paper's network: the only module that uses torch, in a process of its own.

Both presets write the gradients of the 9-10-12 sigmoid network by hand, over all takes at once. The
window of a take is its first three samples from the activation, at the take's own rate: a model
trained from takes of 50 Hz is for a sensor of 50 Hz.
"""

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gestureapp import __version__
from gestureapp.clock import Clock, monotonic
from gestureapp.errors import NotEnoughTakes
from gestureapp.gestures import LABELS
from gestureapp.recognition.model_file import (
    KIND_PAPER,
    WINDOW_SAMPLES,
    Model,
    TrainingRecord,
)
from gestureapp.recognition.network import Network
from gestureapp.recognition.presets import MIN_TAKES, Preset
from gestureapp.recognition.takes import TakeSet

F64 = NDArray[np.float64]
Progress = Callable[[int, int, float], None]
"""Called with passes done, passes in all, and the error now (half the squared error of a take)."""

Tensor = Any
"""torch has no part in the static types here: it is imported late, by this process only."""

HIDDEN = 10
"""Hidden neurons. Source: paper, IV.C."""
PAPER_CYCLES = 100_000
PAPER_RATE = 0.25
"""Source of both: paper, table II."""
PAPER_RULE = (
    "full-batch backpropagation: each cycle is one pass over all takes and one step of the weights "
    "against the gradient of half the squared error, summed over the outputs and averaged over the "
    "takes; no momentum; float32"
)
DEFAULT_CYCLES = 2_000
DEFAULT_RATE = 0.02
DEFAULT_RESTARTS = 8
HELD_OUT = 5
"""Every fifth take of each gesture, after shuffling, is held out."""
CHECK_EVERY = 10
DEFAULT_RULE = (
    "full-batch gradients of half the squared error, averaged over the takes, steps by Adam; eight "
    "starts at once, each stopped where its error on the held-out fifth was least, the best kept"
)
_REPORTS = 100
_FIRST_WEIGHTS = 0.5
"""First weights are even between minus and plus this: the sigmoids start where they are steep."""


@dataclass(frozen=True, slots=True)
class _Outcome:
    network: Network
    cycles: int
    loss: float


def no_progress(done: int, total: int, loss: float) -> None:
    """Tell nobody."""


def train(
    takes: TakeSet,
    preset: Preset = Preset.DEFAULT,
    seed: int = 0,
    progress: Progress = no_progress,
    clock: Clock = monotonic,
    takes_from: str = "",
) -> Model:
    """Train a model from takes. Blocks for seconds (default) or half a minute (paper).

    A seed gives the same weights on one machine. Labels may be any: those of the gesture set stand
    first and in its order, others follow by name. One thread of torch.

    Args:
        takes: At least ``MIN_TAKES`` of each gesture that occurs, and two gestures.
        preset: The recipe.
        seed: Of the first weights and of the choice of held-out takes.
        progress: Called about a hundred times, in this thread; what it raises ends the training.
        clock: For the duration in the record.
        takes_from: Where the takes came from, for the record.

    Raises:
        NotEnoughTakes: says of which gesture there are too few.
    """
    begun_s = clock()
    labels = ordered_labels(takes)
    inputs, targets = _patterns(takes, labels)
    learn = _learn_as_paper if preset is Preset.PAPER else _learn_by_default
    outcome = learn(inputs, targets, seed, progress)
    is_paper = preset is Preset.PAPER
    people = set(takes.user)
    return Model(
        kind=KIND_PAPER,
        labels=labels,
        network=outcome.network,
        person=people.pop() if len(people) == 1 else "",
        training=TrainingRecord(
            preset=preset.value,
            rule=PAPER_RULE if is_paper else DEFAULT_RULE,
            cycles=outcome.cycles,
            learning_rate=PAPER_RATE if is_paper else DEFAULT_RATE,
            seed=seed,
            n_takes=len(inputs),
            loss=outcome.loss,
            duration_s=round(clock() - begun_s, 3),
            takes_from=takes_from,
        ),
        takes_fingerprint=takes.fingerprint(),
        app_version=__version__,
        created=datetime.now(UTC).isoformat(timespec="seconds"),
    )


def ordered_labels(takes: TakeSet) -> tuple[str, ...]:
    """The gestures that occur: those of the gesture set in its order, then others by name."""
    found = set(takes.labels)
    return tuple(x for x in LABELS if x in found) + tuple(sorted(found - set(LABELS)))


def _patterns(takes: TakeSet, labels: tuple[str, ...]) -> tuple[F64, F64]:
    """Inputs of shape (n, 9) and targets (n, labels) of the takes that hold a whole window."""
    usable = [
        i
        for i in range(len(takes))
        if len(takes.accel_g(i)) - int(takes.activation[i]) >= WINDOW_SAMPLES
    ]
    counts = Counter(takes.labels[i] for i in usable)
    few = [f"{counts[label]} of {label}" for label in labels if counts[label] < MIN_TAKES]
    if few:
        raise NotEnoughTakes(
            takes.source,
            f"only {', '.join(few)} with three samples after the activation; "
            f"at least {MIN_TAKES} of each gesture are needed, 30 are better",
        )
    if len(labels) < 2:
        raise NotEnoughTakes(takes.source, "takes of at least two gestures are needed")
    starts = [int(takes.activation[i]) for i in usable]
    windows = [
        takes.accel_g(i)[start : start + WINDOW_SAMPLES].reshape(-1)
        for i, start in zip(usable, starts, strict=True)
    ]
    column = {label: k for k, label in enumerate(labels)}
    targets = np.zeros((len(usable), len(labels)))
    targets[np.arange(len(usable)), [column[takes.labels[i]] for i in usable]] = 1.0
    return np.array(windows), targets


def _learn_as_paper(inputs: F64, targets: F64, seed: int, progress: Progress) -> _Outcome:
    """``PAPER_RULE``, every cycle of it, in buffers that are allocated once."""
    torch = _torch()
    n = len(inputs)
    with torch.inference_mode():
        x = torch.tensor(_with_bias(inputs), dtype=torch.float32)
        t = torch.tensor(targets, dtype=torch.float32)
        first, second = (
            torch.tensor(w[0], dtype=torch.float32) for w in _first_weights(x, t, seed, 1)
        )
        h = torch.ones((n, HIDDEN + 1), dtype=torch.float32)
        h_sigmoid = torch.empty((n, HIDDEN), dtype=torch.float32)
        y, d_y, slope = (torch.empty_like(t) for _ in range(3))
        d_h, h_slope = torch.empty_like(h_sigmoid), torch.empty_like(h_sigmoid)
        xt, ht = x.T.contiguous(), h.T
        step = -PAPER_RATE / n
        report = PAPER_CYCLES // _REPORTS
        for cycle in range(1, PAPER_CYCLES + 1):
            torch.mm(x, first, out=h_sigmoid).sigmoid_()
            h[:, :HIDDEN] = h_sigmoid
            torch.mm(h, second, out=y).sigmoid_()
            torch.sub(y, t, out=d_y)
            if cycle % report == 0:
                progress(cycle, PAPER_CYCLES, float(d_y.square().sum()) / (2 * n))
            torch.addcmul(y, y, y, value=-1, out=slope)
            d_y.mul_(slope)
            torch.mm(d_y, second[:HIDDEN].T, out=d_h)
            torch.addcmul(h_sigmoid, h_sigmoid, h_sigmoid, value=-1, out=h_slope)
            d_h.mul_(h_slope)
            second.addmm_(ht, d_y, alpha=step)
            first.addmm_(xt, d_h, alpha=step)
        network = _network(first.numpy(), second.numpy())
    return _Outcome(network, PAPER_CYCLES, _loss(network, inputs, targets))


def _learn_by_default(inputs: F64, targets: F64, seed: int, progress: Progress) -> _Outcome:
    """``DEFAULT_RULE``: a batch of networks, one for each start."""
    torch = _torch()
    held = _held_out(targets, seed)
    with torch.inference_mode():
        x, t = torch.tensor(_with_bias(inputs[~held])), torch.tensor(targets[~held])
        x_held, t_held = torch.tensor(_with_bias(inputs[held])), torch.tensor(targets[held])
        weights = [torch.tensor(w) for w in _first_weights(x, t, seed, DEFAULT_RESTARTS)]
        adam = [_Adam(w) for w in weights]
        best = [w.clone() for w in weights]
        best_loss = torch.full((DEFAULT_RESTARTS,), torch.inf, dtype=torch.float64)
        best_cycle = torch.zeros(DEFAULT_RESTARTS, dtype=torch.int64)
        for cycle in range(DEFAULT_CYCLES + 1):
            if cycle % CHECK_EVERY == 0:
                loss = _losses(weights, x_held, t_held)
                better = loss < best_loss
                best_loss[better], best_cycle[better] = loss[better], cycle
                for kept, now in zip(best, weights, strict=True):
                    kept[better] = now[better]
            if cycle and cycle % (DEFAULT_CYCLES // _REPORTS) == 0:
                progress(cycle, DEFAULT_CYCLES, float(best_loss.min()))
            for w, a, gradient in zip(weights, adam, _gradients(weights, x, t), strict=True):
                w -= a.step(gradient)
        winner = int(best_loss.argmin())
        network = _network(best[0][winner].numpy(), best[1][winner].numpy())
        return _Outcome(
            network, int(best_cycle[winner]), _loss(network, inputs[held], targets[held])
        )


class _Adam:
    """Adam with its usual constants. Source: Kingma and Ba, Adam, ICLR 2015, algorithm 1."""

    def __init__(self, like: Tensor) -> None:
        self._mean, self._square, self._n = like * 0.0, like * 0.0, 0

    def step(self, gradient: Tensor) -> Tensor:
        self._n += 1
        self._mean += (gradient - self._mean) * 0.1
        self._square += (gradient * gradient - self._square) * 0.001
        mean = self._mean / (1.0 - 0.9**self._n)
        square = self._square / (1.0 - 0.999**self._n)
        return DEFAULT_RATE * mean / (square.sqrt() + 1e-8)


def _forward(weights: list[Tensor], x: Tensor) -> tuple[Tensor, Tensor]:
    """Hidden outputs with a leading bias column of ones at the end, and outputs; (k, n, …)."""
    torch = _torch()
    hidden = torch.sigmoid(x @ weights[0])
    ones = torch.ones((*hidden.shape[:2], 1), dtype=hidden.dtype)
    h = torch.cat([hidden, ones], dim=2)
    return h, torch.sigmoid(h @ weights[1])


def _gradients(weights: list[Tensor], x: Tensor, t: Tensor) -> tuple[Tensor, Tensor]:
    h, y = _forward(weights, x)
    d_y = (y - t) * y * (1.0 - y) / len(x)
    hidden = h[:, :, :HIDDEN]
    d_h = (d_y @ weights[1][:, :HIDDEN].transpose(1, 2)) * hidden * (1.0 - hidden)
    return x.T @ d_h, h.transpose(1, 2) @ d_y


def _losses(weights: list[Tensor], x: Tensor, t: Tensor) -> Tensor:
    _, y = _forward(weights, x)
    return (y - t).square().sum(dim=(1, 2)) / (2 * len(x))


def _loss(network: Network, inputs: F64, targets: F64) -> float:
    return float(np.square(network.outputs(inputs) - targets).sum() / (2 * len(inputs)))


def _held_out(targets: F64, seed: int) -> NDArray[np.bool_]:
    """Which takes are held out: a fifth of each gesture, chosen by the seed."""
    rng = np.random.default_rng([seed, 1])
    held = np.zeros(len(targets), dtype=np.bool_)
    for column in range(targets.shape[1]):
        rows = rng.permutation(np.flatnonzero(targets[:, column]))
        held[rows[: len(rows) // HELD_OUT]] = True
    return held


def _with_bias(inputs: F64) -> F64:
    return np.hstack([inputs, np.ones((len(inputs), 1))])


def _first_weights(x: Tensor, t: Tensor, seed: int, starts: int) -> tuple[F64, F64]:
    rng = np.random.default_rng([seed, 0])
    first = rng.uniform(-_FIRST_WEIGHTS, _FIRST_WEIGHTS, (starts, x.shape[1], HIDDEN))
    second = rng.uniform(-_FIRST_WEIGHTS, _FIRST_WEIGHTS, (starts, HIDDEN + 1, t.shape[1]))
    return first, second


def _network(first: F64, second: F64) -> Network:
    """From weights with the bias as last row, as they are trained, to a network."""
    return Network(first[:-1].T, first[-1], second[:-1].T, second[-1])


def _torch() -> Tensor:
    """Torch, imported when it is first needed, on one thread: two are slower on these sizes."""
    import torch

    if torch.get_num_threads() != 1:
        torch.set_num_threads(1)
    return torch
