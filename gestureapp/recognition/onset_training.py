"""Training of the onset-aligned networks: the shared base model, made a person's own. Uses torch.

Each member of the ensemble begins as the base, which knows how people in general move. Where the
takes are of the console's own gestures, half of the members keep the base's outputs, and half get
new ones; where they are of others, all get new ones. The networks of the cross-validation are
trained together with the model's, and say which thresholds keep the promise.
"""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from gestureapp.errors import NotEnoughTakes
from gestureapp.recognition.base import Base
from gestureapp.recognition.calibration import (
    Calibration,
    calibrate,
    questions_of,
)
from gestureapp.recognition.decision import EARLY, EARLY_OF_OTHERS, LAST, Decision
from gestureapp.recognition.ensemble import Ensemble
from gestureapp.recognition.folds import Division
from gestureapp.recognition.members import (
    Layers,
    Progress,
    Steps,
    joined_layers,
    learn,
    with_new_outputs,
    with_outputs_of,
)
from gestureapp.recognition.movement import ONSET_G
from gestureapp.recognition.movement_batch import Streams, follow_all, moments_at
from gestureapp.recognition.onset_views import (
    ONSET_FACTOR,
    Variation,
    Views,
    gesture_views,
    joined,
    negative_views,
    personal_onsets_g,
    streams_of,
)
from gestureapp.recognition.patterns import ordered_labels
from gestureapp.recognition.presets import MIN_TAKES
from gestureapp.recognition.takes import TakeSet
from gestureapp.recognition.window import inputs_of

F32 = NDArray[np.float32]
F64 = NDArray[np.float64]
I64 = NDArray[np.int64]
Mask = NDArray[np.bool_]

NEW = Steps(count=400, rate=2e-3, batch=128, decay=1e-3)
KEPT = Steps(count=200, rate=1e-3, batch=128, decay=1e-3)
KEPT_FEW = Steps(count=100, rate=1e-3, batch=128, decay=1e-3)
"""With fewer than ``MIN_TAKES`` of a gesture: the base is moved only a little."""
MEMBERS_NEW, MEMBERS_KEPT = 4, 2
"""All with new outputs; or so many of each sort. With people left out, five new ones did as well at
recognising as three, and gave a third fewer wrong answers. With few takes, half of the members are
the base itself: from one take of each gesture 0.1 % were then heard as another one and 99.3 %
recognised, without 0.8 and 98.2 % (10 simulated people)."""
VARIATION = Variation(tilt_deg=4.0, gain=0.04, offset_g=0.02, vigour=0.10)
VARIED = 6
"""Varied copies of each view: about as many views are then there as are shown."""
VIEWS_OF_GESTURE = 120
"""Views of each copy of a gesture's takes, together; at least 4 of each take."""
PER_NEGATIVE = 4
NEGATIVE_KNOWN, NEGATIVE_OTHER = 1 / 9, 1 / 33
"""Share of the non-gestures in what is shown, with the console's own gestures and with others."""
NEGATIVE_UNTAUGHT = 0.4
"""More by this, times the share of the console's gestures that were not taught: without, a turn
about Z that was never taught was heard as Y, 40 of 40; with it none of 30."""
RULE = (
    "cross-entropy in one cycle of Adam's steps with decoupled decay, from the shared base model, "
    "on views of varied, damaged and cut copies of the takes and of non-gestures"
)


@dataclass(frozen=True, slots=True)
class OnsetOutcome:
    """What a training gave: for the model, then for each fold of its cross-validation.

    Attributes:
        labels: The gestures, in the order of the outputs; one more output is "none of them".
        ensembles: The networks.
        onsets_g: Deviation that is a movement of this person.
        calibration: Thresholds and temperature, for all.
        steps: Steps done.
        rate: Size of the largest.
        loss: Mean error at the end.
    """

    labels: tuple[str, ...]
    ensembles: Sequence[Ensemble]
    onsets_g: Sequence[float]
    calibration: Calibration
    steps: int
    rate: float
    loss: float

    def decisions(self) -> list[Decision]:
        """How sure is sure enough, for each ensemble."""
        found = self.calibration
        return [Decision(found.early, found.last, onset_g) for onset_g in self.onsets_g]


def refuse_few(takes: TakeSet, base: Base) -> None:
    """One take of each of the console's gestures is enough, and five of others.

    Raises:
        NotEnoughTakes: says of which gesture there are too few.
    """
    labels = ordered_labels(takes)
    least = 1 if base.knows(labels) else MIN_TAKES
    counts = Counter(takes.labels)
    few = [f"{counts[label]} of {label}" for label in labels if counts[label] < least]
    if few:
        reason = f"only {', '.join(few)}; at least {least} of each gesture are needed"
        raise NotEnoughTakes(takes.source, f"{reason}, 30 are better")
    if len(labels) < 2:
        raise NotEnoughTakes(takes.source, "takes of at least two gestures are needed")


def learn_onset(
    takes: TakeSet, division: Division | None, base: Base, seed: int, progress: Progress
) -> OnsetOutcome:
    """Train from all takes, and from all but each fold.

    Args:
        takes: At least one of each gesture; see ``refuse_few``.
        division: What the networks of the cross-validation do not see; None without.
        base: The shared base model and what is no gesture.
        seed: Of all chance.
        progress: Told about fifty times.

    Raises:
        NotEnoughTakes: a gesture's takes show neither movement nor posture.
    """
    rng = np.random.default_rng([seed, 3])
    labels = ordered_labels(takes)
    column = {label: number for number, label in enumerate(labels)}
    outputs = np.array([column[label] for label in takes.labels])
    shares = [np.ones(len(takes), dtype=np.bool_)]
    if division is not None:
        shares += [division.fold != number for number in range(division.n_folds)]
    streams = streams_of(takes)
    onsets_g = personal_onsets_g(streams, shares)
    fewest = min(Counter(takes.labels).values())
    shown = _shown(takes, streams, outputs, shares, onsets_g, base, labels, seed)
    layers, loss, steps = _learn_members(labels, base, fewest, shown, rng, progress)
    ensembles = [base.ensemble_of(each) for each in layers]
    calibration = Calibration(EARLY if fewest >= MIN_TAKES else EARLY_OF_OTHERS, LAST, 1.0)
    if division is not None and fewest >= MIN_TAKES:
        calibration = _calibrated(streams, outputs, division, ensembles[1:], onsets_g[1:])
    ensembles = [replace(each, temperature=calibration.temperature) for each in ensembles]
    rate = (NEW if fewest >= MIN_TAKES else KEPT_FEW).rate
    return OnsetOutcome(labels, ensembles, onsets_g, calibration, steps, rate, loss)


class _Shown:
    """What the networks of each share are shown: varied views, in the order of chance.

    What is drawn for a share does not depend on takes outside it.
    """

    def __init__(
        self, pools: Sequence[tuple[F32, I64]], none: F32, share_none: float, seed: int
    ) -> None:
        self._pools, self._none, self._share_none = pools, none, share_none
        self._chance = [np.random.default_rng([seed, 7, n]) for n in range(len(pools))]
        self.n_shares = len(pools)

    def draw(self, batch: int, members: int, none_output: int) -> tuple[F32, I64]:
        """A batch for each member of each share: inputs, and outputs."""
        n_none = max(1, round(self._share_none * batch))
        k = self.n_shares * members
        shown = np.empty((k, batch, self._none.shape[1]), dtype=np.float32)
        wanted = np.full((k, batch), none_output)
        for number in range(k):
            inputs, outputs = self._pools[number // members]
            rng = self._chance[number // members]
            rows = rng.integers(0, len(inputs), batch - n_none)
            shown[number, n_none:], wanted[number, n_none:] = inputs[rows], outputs[rows]
            shown[number, :n_none] = self._none[rng.integers(0, len(self._none), n_none)]
        return shown, wanted


def _shown(
    takes: TakeSet,
    streams: Streams,
    outputs: I64,
    shares: Sequence[Mask],
    onsets_g: Sequence[float],
    base: Base,
    labels: Sequence[str],
    seed: int,
) -> _Shown:
    per_copy = max(4, VIEWS_OF_GESTURE // int(np.bincount(outputs).min()))
    views = {
        onset_g: gesture_views(
            streams, onset_g, per_copy, np.random.default_rng([seed, 4, round(1e4 * onset_g)])
        )
        for onset_g in set(onsets_g)
    }
    pools = []
    for number, (share, onset_g) in enumerate(zip(shares, onsets_g, strict=True)):
        rng = np.random.default_rng([seed, 5, number])
        part = views[onset_g].select(share[views[onset_g].take])
        _refuse_unmoved(takes, part.take, is_fold=number > 0)
        pools.append((_varied(part, base, rng), np.tile(outputs[part.take], VARIED)))
    rng = np.random.default_rng([seed, 6])
    level_g = ONSET_G * ONSET_FACTOR ** rng.uniform(0.0, 1.0, len(base.negatives))
    none = negative_views(streams_of(base.negatives), level_g, PER_NEGATIVE, rng)
    share_none = NEGATIVE_KNOWN if base.knows(labels) else NEGATIVE_OTHER
    if (untaught := base.untaught(labels)) is not None:
        none = joined([none, gesture_views(streams_of(untaught), ONSET_G, 1, rng)])
        share_none += NEGATIVE_UNTAUGHT * (1.0 - len(labels) / len(base.labels))
    return _Shown(pools, _varied(none, base, rng), share_none, seed)


def _refuse_unmoved(takes: TakeSet, shown: I64, is_fold: bool) -> None:
    """The model needs to see each gesture, and a network of the cross-validation any.

    Args:
        takes: All.
        shown: Numbers of those with a moment to learn from.
        is_fold: Whether a network of the cross-validation is meant.
    """
    seen = {takes.labels[row] for row in np.unique(shown).tolist()}
    unmoved = [label for label in ordered_labels(takes) if label not in seen]
    if unmoved and not (is_fold and seen):
        raise NotEnoughTakes(
            takes.source,
            f"no movement was found in the takes of {', '.join(unmoved)}: record them again; takes "
            "from a file must be in g, at the right 'rate_hz', and go on after the activation",
        )


def _varied(views: Views, base: Base, rng: np.random.Generator) -> F32:
    """The network's inputs of all views, ``VARIED`` times."""
    copies = [VARIATION.vary(views.moment, rng) for _ in range(VARIED)]
    return np.concatenate([base.scaled(inputs_of(moment)) for moment in copies])


def _learn_members(
    labels: tuple[str, ...],
    base: Base,
    fewest: int,
    shown: _Shown,
    rng: np.random.Generator,
    progress: Progress,
) -> tuple[list[Layers], float, int]:
    """All members of all shares; the last error, and the steps that were done."""
    groups: list[tuple[Layers, Steps, int]] = []
    learned: list[list[Layers]] = []
    known, few = base.knows(labels), fewest < MIN_TAKES
    if known:
        kept = with_outputs_of(base.layers, base.columns(labels))
        if few and base.untaught(labels) is None:
            learned.append([kept.repeated(MEMBERS_KEPT)] * shown.n_shares)
        groups.append((kept, KEPT_FEW if few else KEPT, MEMBERS_KEPT))
    if not few:
        groups.append((base.layers, NEW, MEMBERS_KEPT if known else MEMBERS_NEW))
    total, done, loss = sum(steps.count for _, steps, _ in groups), 0, 0.0
    for first, steps, members in groups:
        k = shown.n_shares * members
        begin = first.repeated(k)
        if steps is NEW:
            begin = with_new_outputs(begin, len(labels) + 1, rng)

        def tell(now: int, _: int, error: float, before: int = done) -> None:
            nonlocal loss
            loss = error
            progress(before + now, total, error)

        draw = partial(shown.draw, steps.batch, members, len(labels))
        found = learn(begin, draw, steps, tell)
        done += steps.count
        learned.append([found.part(n * members, members) for n in range(shown.n_shares)])
    return [joined_layers(parts) for parts in zip(*learned, strict=True)], loss, done


def _calibrated(
    streams: Streams,
    outputs: I64,
    division: Division,
    blind: Sequence[Ensemble],
    onsets_g: Sequence[float],
) -> Calibration:
    """Ask about each take the networks that have not seen its fold."""
    takes, sums = [], []
    for number, (ensemble, onset_g) in enumerate(zip(blind, onsets_g, strict=True)):
        rows = np.flatnonzero(division.fold == number)
        part = Streams(streams.times_s[rows], streams.accel_g[rows], streams.n_samples[rows])
        followed = follow_all(part, onset_g)
        asked = questions_of(followed)
        inputs = inputs_of(moments_at(followed, asked.take, asked.sample))
        takes.append(rows[asked.take])
        sums.append(ensemble.sums(inputs))
    return calibrate(np.concatenate(takes), np.concatenate(sums, axis=1), outputs)
