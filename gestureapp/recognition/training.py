"""Training of models, in a process of its own: it uses torch.

Every preset trains the folds of the cross-validation together with the model. ``default`` stands in
``onset_training``. The others write the gradients of the paper's 9-10-12 sigmoid network by hand,
over all takes at once; the window of a take is its first three samples from the activation, at the
take's own rate: such a model trained from takes of 50 Hz is for a sensor of 50 Hz.
"""

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime

import numpy as np
from numpy.typing import NDArray

from gestureapp import __version__
from gestureapp.clock import Clock, monotonic
from gestureapp.errors import RecordingInvalid
from gestureapp.recognition.base import load_base
from gestureapp.recognition.decision import Decision
from gestureapp.recognition.ensemble import Ensemble
from gestureapp.recognition.folds import Division, FoldBy, divide
from gestureapp.recognition.hearing import count_answers, hear
from gestureapp.recognition.model_file import (
    INPUT_PAPER,
    CrossValidation,
    Model,
    TrainingRecord,
)
from gestureapp.recognition.model_weights import KIND_ONSET, KIND_PAPER, WINDOW_SAMPLES
from gestureapp.recognition.network import Network
from gestureapp.recognition.network_batch import (
    AdamSteps,
    NetworkBatch,
    PlainSteps,
    by_hand,
    first_weights,
    network_of,
)
from gestureapp.recognition.onset_training import RULE, learn_onset, refuse_few
from gestureapp.recognition.patterns import REST_G, Patterns, patterns_of, whole_takes
from gestureapp.recognition.presets import Preset
from gestureapp.recognition.takes import TakeSet
from gestureapp.recognition.values import NO_GESTURE
from gestureapp.recognition.window import INPUT_ONSET

F64 = NDArray[np.float64]
Mask = NDArray[np.bool_]
Progress = Callable[[int, int, float], None]
"""Called with passes done, passes in all, and the error now (half the squared error of a take)."""

PAPER_CYCLES = 100_000
PAPER_RATE = 0.25
"""Source of both: paper, table II."""
PAPER_RULE = (
    "full-batch backpropagation: each cycle is one pass over all takes and one step of the weights "
    "against the gradient of half the squared error, summed over the outputs and averaged over the "
    "takes; no momentum; float32"
)
PAPER_REPORTS = 100
SMALL_CYCLES = 1_000
SMALL_RATE = 0.1
SMALL_STARTS = 3
CHECK_EVERY = 20
EARLIEST_STOP = 500
"""Varied takes are not learned by heart so soon: an earlier least error is chance. With five takes
of a gesture, where one is held out, stopping there lost one per cent and some people far more."""
SCALE_G = 0.4
"""Inputs are divided by it, after a level hand at rest was taken off: they are about 1 in size."""
HELD_OUT = 5
"""One take in five of each gesture, chosen by the seed, says when to stop."""
SMALL_RULE = (
    "full-batch gradients of half the squared error, averaged over the takes, steps by Adam; in "
    "every pass each take is shifted in time, tilted and made with another vigour by chance; three "
    "starts, each once without a fifth of the takes: where its error on those was least, after "
    f"{EARLIEST_STOP} passes or more, the same start, trained with all takes, is stopped; the "
    "start whose two networks err least is kept"
)
NINE = 3 * WINDOW_SAMPLES


@dataclass(frozen=True, slots=True)
class _Outcome:
    """Of one network: how many passes made it, and its error (with ``small`` on held-out takes)."""

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
    folds: FoldBy | None = None,
    is_validated: bool = True,
) -> Model:
    """Train a model from all takes, and networks like it from all but a fold. Blocks for seconds.

    A seed gives the same weights on one machine. Labels may be any: those of the gesture set stand
    first and in its order, others follow by name. Takes without three samples after the activation
    are left out. One thread of torch.

    Args:
        takes: At least ``MIN_TAKES`` of each gesture that occurs, and two gestures. The preset
            ``default`` does with one take of each where they are all of the gesture set; with one,
            there is no cross-validation.
        preset: The recipe.
        seed: Of the first weights, the choice of held-out takes and all other chance.
        progress: Called fifty times or more, in this thread; what it raises ends the training.
        clock: For the duration in the record.
        takes_from: Where the takes came from, for the record.
        folds: What stays together in the cross-validation; None lets ``divide`` choose.
        is_validated: Also train and hear the networks of the cross-validation.

    Raises:
        NotEnoughTakes: says of which gesture there are too few.
        ModelInvalid: the shared base model cannot be used.
        RecordingInvalid: a gesture is called ``none``, or the base's takes of what is no gesture
            cannot be used.
        ValueError: the takes cannot be divided by ``folds``.
    """
    begun_s = clock()
    if NO_GESTURE in takes.labels:
        raise RecordingInvalid(
            takes.source,
            f"holds takes of a gesture called {NO_GESTURE!r}, which stands for no gesture at all: "
            "rename it, or leave them out",
        )
    learn = _train_onset if preset is Preset.DEFAULT else _train_paper
    found = learn(takes, preset, seed, progress, folds, is_validated)
    record = replace(found.record, takes_from=takes_from, rate_hz=takes.rate_hz)
    people = set(takes.user)
    model = Model(
        kind=KIND_ONSET if preset is Preset.DEFAULT else KIND_PAPER,
        labels=found.labels,
        network=found.networks[0],
        person=people.pop() if len(people) == 1 else "",
        training=record,
        takes_fingerprint=takes.fingerprint(),
        app_version=__version__,
        created=datetime.now(UTC).isoformat(timespec="seconds"),
        input_words=INPUT_ONSET if preset is Preset.DEFAULT else INPUT_PAPER,
        decision=found.decisions[0],
    )
    if found.division is not None:
        model = replace(model, cross_validation=_cross_validate(model, found))
    return replace(model, training=replace(record, duration_s=round(clock() - begun_s, 3)))


@dataclass(frozen=True, slots=True)
class _Trained:
    """Networks and thresholds: the model's, then those of each fold of the cross-validation."""

    labels: tuple[str, ...]
    whole: TakeSet
    division: Division | None
    networks: Sequence[Network | Ensemble]
    decisions: Sequence[Decision | None]
    record: TrainingRecord


def _train_onset(
    takes: TakeSet,
    preset: Preset,
    seed: int,
    progress: Progress,
    folds: FoldBy | None,
    is_validated: bool,
) -> _Trained:
    base, whole = load_base(), takes.select(whole_takes(takes))
    refuse_few(whole, base)
    can_divide = min(Counter(whole.labels).values()) > 1
    division = divide(whole, folds) if is_validated and can_divide else None
    found = learn_onset(whole, division, base, seed, progress)
    record = TrainingRecord(
        preset=preset.value,
        rule=RULE,
        cycles=found.steps,
        learning_rate=found.rate,
        seed=seed,
        n_takes=len(whole),
        loss=found.loss,
        duration_s=0.0,
    )
    return _Trained(found.labels, whole, division, found.ensembles, found.decisions(), record)


def _train_paper(
    takes: TakeSet,
    preset: Preset,
    seed: int,
    progress: Progress,
    folds: FoldBy | None,
    is_validated: bool,
) -> _Trained:
    patterns = patterns_of(takes)
    whole = takes.select(patterns.rows.tolist())
    division = divide(whole, folds) if is_validated else None
    shares = [np.ones(len(whole), dtype=np.bool_)]
    if division is not None:
        shares += [division.fold != number for number in range(division.n_folds)]
    learn = _learn_as_paper if preset is Preset.PAPER else _learn_small
    with by_hand():
        outcomes = learn(patterns, np.array(shares), seed, progress)
    record = _record(preset, seed, outcomes[0], len(whole))
    networks = [outcome.network for outcome in outcomes]
    return _Trained(patterns.labels, whole, division, networks, [None] * len(networks), record)


def _record(preset: Preset, seed: int, outcome: _Outcome, n_takes: int) -> TrainingRecord:
    is_paper = preset is Preset.PAPER
    return TrainingRecord(
        preset=preset.value,
        rule=PAPER_RULE if is_paper else SMALL_RULE,
        cycles=outcome.cycles,
        learning_rate=PAPER_RATE if is_paper else SMALL_RATE,
        seed=seed,
        n_takes=n_takes,
        loss=outcome.loss,
        duration_s=0.0,
    )


def _cross_validate(model: Model, found: _Trained) -> CrossValidation:
    """Have every take heard by the network that has not seen its fold."""
    assert found.division is not None
    blind = [
        replace(model, network=network, decision=decision)
        for network, decision in zip(found.networks[1:], found.decisions[1:], strict=True)
    ]
    fold = found.division.fold.tolist()
    answers = [hear(blind[number], found.whole, row) for row, number in enumerate(fold)]
    evaluation = count_answers(model.labels, found.whole, answers)
    return CrossValidation(evaluation, found.division.words)


def _learn_as_paper(
    patterns: Patterns, shares: Mask, seed: int, progress: Progress
) -> list[_Outcome]:
    """``PAPER_RULE``, every cycle of it, for each share of the takes."""
    inputs = patterns.inputs_g() + np.tile(REST_G, WINDOW_SAMPLES)
    first, second = first_weights(seed, 1, NINE, len(patterns.labels))
    k = len(shares)
    batch = NetworkBatch(
        np.repeat(first, k, axis=0), np.repeat(second, k, axis=0), patterns.targets, shares
    )
    steps = PlainSteps(PAPER_RATE)
    report = max(1, PAPER_CYCLES // PAPER_REPORTS)
    batch.show(inputs)
    for cycle in range(1, PAPER_CYCLES + 1):
        batch.learn(steps)
        batch.show()
        if cycle % report == 0:
            progress(cycle, PAPER_CYCLES, float(batch.losses(shares)[0]))
    losses = batch.losses(shares)
    return [
        _Outcome(network_of(w1, w2, np.zeros(NINE), 1.0), PAPER_CYCLES, loss)
        for w1, w2, loss in zip(*batch.copy_weights(), losses.tolist(), strict=True)
    ]


def _learn_small(patterns: Patterns, shares: Mask, seed: int, progress: Progress) -> list[_Outcome]:
    """``SMALL_RULE``. The networks stand in the order share, start, without or with all takes."""
    rng = np.random.default_rng([seed, 2])
    held = np.array([_held_out(patterns.targets, share, seed) for share in shares])
    k = len(shares)
    learned = np.stack([shares & ~held, shares], axis=1)[:, None].repeat(SMALL_STARTS, axis=1)
    looked = np.repeat(held, 2 * SMALL_STARTS, axis=0)
    first, second = first_weights(seed, SMALL_STARTS, NINE, len(patterns.labels))
    batch = NetworkBatch(
        np.tile(first.repeat(2, axis=0), (k, 1, 1)),
        np.tile(second.repeat(2, axis=0), (k, 1, 1)),
        patterns.targets,
        learned.reshape(-1, learned.shape[-1]),
    )
    steps, clean = AdamSteps(SMALL_RATE), patterns.inputs_g() / SCALE_G
    kept: list[tuple[F64, F64]] = []
    losses: list[F64] = []
    for cycle in range(1, SMALL_CYCLES + 1):
        batch.show(patterns.vary(rng) / SCALE_G)
        batch.learn(steps)
        if cycle % CHECK_EVERY == 0:
            batch.show(clean)
            kept.append(batch.copy_weights())
            losses.append(batch.losses(looked).reshape(k, SMALL_STARTS, 2))
            progress(cycle, SMALL_CYCLES, float(losses[-1][0, :, 0].min()))
    return [_stopped(np.array(losses)[:, number], kept, number) for number in range(k)]


def _stopped(losses: F64, kept: list[tuple[F64, F64]], number: int) -> _Outcome:
    """The network of a share where the one without the held-out takes had its least error there.

    Of the starts the one with the least error of both its networks: the one with all takes, too,
    can be lost on a gesture (one in some twenty trainings: an output that never rises).

    Args:
        losses: On the held-out takes, of each check, start and network, shape (checks, starts, 2).
        kept: The weights of all networks at each check.
        number: Of the share.
    """
    earliest = min(EARLIEST_STOP // CHECK_EVERY, len(losses)) - 1
    checks = earliest + losses[earliest:, :, 0].argmin(axis=0)
    at_check = losses[checks, np.arange(SMALL_STARTS)]
    start = int(at_check.sum(axis=1).argmin())
    check = int(checks[start])
    row = (number * SMALL_STARTS + start) * 2 + 1
    first, second = kept[check]
    network = network_of(first[row], second[row], np.tile(REST_G, WINDOW_SAMPLES), SCALE_G)
    return _Outcome(network, (check + 1) * CHECK_EVERY, float(at_check[start, 0]))


def _held_out(targets: F64, share: Mask, seed: int) -> Mask:
    """Which takes of a share say when to stop: one in five of each gesture, chosen by the seed."""
    rng = np.random.default_rng([seed, 1])
    held = np.zeros(len(targets), dtype=np.bool_)
    for column in range(targets.shape[1]):
        rows = rng.permutation(np.flatnonzero((targets[:, column] > 0) & share))
        held[rows[: max(1, len(rows) // HELD_OUT)]] = len(rows) > 1
    return held
