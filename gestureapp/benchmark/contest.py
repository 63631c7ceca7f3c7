"""Recognisers side by side on the same unseen takes: the paper's, outside peers, and ours.

Ours and the paper's are the product's own, trained by the product and fed sample by sample.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from gestureapp.benchmark import peers
from gestureapp.benchmark.report import machine
from gestureapp.benchmark.splits import Part, of_person, only, splits_of
from gestureapp.recognition.base import BASE
from gestureapp.recognition.evaluation import Evaluation, tally
from gestureapp.recognition.hearing import hear
from gestureapp.recognition.model_file import Model, load_model
from gestureapp.recognition.presets import Preset
from gestureapp.recognition.takes import RATE_UNKNOWN_HZ, TakeSet, load_takes
from gestureapp.recognition.training import train
from gestureapp.simulation.negatives import make_negatives
from gestureapp.simulation.takes import make_takes

SEED = 8123
TRAINED_ON, TESTED_ON = 30, 10
"""Takes of each gesture: on the first day, and on each of the later ones."""
LATER_DAYS = (2, 3, 4)
FEW_PEOPLE = 5
"""So many are enough to see adaptation and the price of certainty."""
ADAPTED_TO = (1, 3, 5, 10, 30)
SETTINGS = ((0.9, 0.4), (0.95, 0.5), (0.95, 0.6), (0.97, 0.7), (0.98, 0.8), (0.99, 0.9))
OURS, HEARD = "ours", "some gesture"
NEGATIVES = 800

Answer = tuple[str | None, float]
"""What was heard, and when, from the take's begin, in s."""
Hear = Callable[[TakeSet], list[Answer]]
Learn = Callable[[TakeSet], Hear]


@dataclass(frozen=True, slots=True)
class Contest:
    """One table: recognisers on the same takes.

    Attributes:
        title: Whose takes, and how they were divided.
        columns: Each recogniser's name with what it made of the takes. ``decision_ms`` is from the
            onset of the movement (of a posture: from the activation), of answers with a gesture.
    """

    title: str
    columns: Sequence[tuple[str, Evaluation]]

    def as_json(self) -> dict[str, object]:
        """Plain values."""
        columns = {name: evaluation.as_json() for name, evaluation in self.columns}
        return {"title": self.title, "columns": columns}

    def as_table(self) -> str:
        """Markdown; shares in per cent, of a gesture recognised and (wrong)."""
        found = [evaluation for _, evaluation in self.columns]
        head = ["", *(f"{name} (n = {e.n})" for name, e in self.columns)]
        rows = [head, ["---"] * len(head)]
        for name in ("recognised", "wrong", "rejected"):
            rows.append([f"{name}, %", *(f"{100 * getattr(e, name):.2f}" for e in found)])
        for k, name in enumerate(("median", "95th percentile")):
            rows.append([f"decided after, {name}, ms", *(f"{e.decision_ms[k]:.0f}" for e in found)])
        shares = [evaluation.per_gesture() for evaluation in found]
        for label in dict.fromkeys(label for share in shares for label in share):
            rows.append([label, *(_cell(share.get(label)) for share in shares)])
        lines = [f"| {' | '.join(row)} |" for row in rows]
        return "\n".join([f"### {self.title}", "", *lines])


@dataclass(frozen=True, slots=True)
class ContestReport:
    """All tables, and what has to be known about them."""

    contests: Sequence[Contest]
    notes: Sequence[str]

    def as_json(self) -> dict[str, object]:
        """Plain values, with the machine."""
        contests = [contest.as_json() for contest in self.contests]
        return {"machine": machine(), "contests": contests, "notes": list(self.notes)}

    def as_table(self) -> str:
        """Markdown, one table after the other."""
        tables = [contest.as_table() for contest in self.contests]
        return "\n\n".join([machine(), *tables, *self.notes])


def measure_simulated(n_people: int, seed: int = SEED) -> ContestReport:
    """Have everybody hear simulated people, who trained on one day, on three later ones.

    Args:
        n_people: How many; each trains alone. Some 40 s for each, most of it the paper's cycles.
        seed: Who they are.
    """
    first = make_takes(n_people, TRAINED_ON, seed, session=1)
    later = [make_takes(n_people, TESTED_ON, seed, session=day) for day in LATER_DAYS]
    names = list(dict.fromkeys(first.user))
    own = {name: of_person(first, name) for name in names}
    parts = [(own[name], of_person(day, name)) for name in names for day in later]
    few = parts[: FEW_PEOPLE * len(later)]
    columns = [(name, _score(parts, learn)) for name, learn in (*_peers(), (OURS, learn_ours))]
    days = f"{TRAINED_ON} takes of each gesture to train, {len(later)} later days"
    people = f"{n_people} simulated people"
    return ContestReport(
        [
            Contest(f"{people}, {days}", columns),
            Contest(f"{OURS}, by takes of each gesture to train", list(_adapted(few))),
            Contest(f"{OURS}, by certainty needed at once / in the end", list(_by_setting(few))),
            _nongestures(parts[0][0]),
        ],
        _notes(),
    )


def measure_file(path: Path, gestures: Sequence[str] = ()) -> ContestReport:
    """Have everybody hear takes from a file: of the same person by repetition, and of others.

    Args:
        path: An NPZ file of takes; ``user`` and ``repetition`` decide which splits there are.
        gestures: Only these; all when empty.

    Raises:
        RecordingInvalid: the file cannot be read.
        NotEnoughTakes: too few are left of a gesture; says for which person or fold.
        ModelMismatch: one of ``gestures`` is not in the file.
        ModelError: the takes name neither repetition nor person.
    """
    takes = only(load_takes(path), gestures)
    splits, notes = splits_of(takes)
    contests = []
    for split in splits:
        learners = (*_peers(), (OURS, learn_ours))
        columns = [(name, _score(split.parts, learn)) for name, learn in learners]
        contests.append(Contest(f"{path.name}, {split.words}", columns))
    return ContestReport(contests, [*takes.remarks, *notes, *_notes()])


def learn_ours(takes: TakeSet) -> Hear:
    """The product's default, with thresholds from takes of its own that it had not seen."""
    return _hearer(train(takes, seed=SEED))


def learn_paper(takes: TakeSet) -> Hear:
    """The paper's network, three samples from the activation."""
    return _hearer(train(takes, Preset.PAPER, SEED, is_validated=False))


def learn_paper_at_onset(takes: TakeSet) -> Hear:
    """The paper's network, three samples from the onset of the right arm's movement."""
    level_g = peers.onset_level_g(takes)
    listen = learn_paper(at_onset(takes, level_g))
    return lambda others: listen(at_onset(others, level_g))


def at_onset(takes: TakeSet, level_g: float) -> TakeSet:
    """The same takes with the activation moved to where the right arm begins to move."""
    rate_hz = takes.rate_hz or RATE_UNKNOWN_HZ
    index = np.ceil(peers.onsets_s(takes, level_g) * rate_hz - 1e-6).astype(np.int64)
    return replace(takes, activation=np.maximum(index, 0))


def _peers() -> Iterator[tuple[str, Learn]]:
    yield "paper, from activation", learn_paper
    yield "paper, from onset", learn_paper_at_onset
    if not peers.missing_words():
        yield "SVM, 160 ms from onset", lambda takes: _outside(takes, peers.learn_svm)
        yield "1-NN DTW, 160 ms from onset", lambda takes: _outside(takes, peers.learn_nearest)


def _outside(takes: TakeSet, learn: Callable[..., peers.Predict]) -> Hear:
    level_g = peers.onset_level_g(takes)
    predict = learn(peers.windows(takes, peers.onsets_s(takes, level_g)), takes.labels)

    def listen(others: TakeSet) -> list[Answer]:
        begin_s = peers.onsets_s(others, level_g)
        activation_s = others.activation / (others.rate_hz or RATE_UNKNOWN_HZ)
        done_s = np.maximum(begin_s + peers.WINDOW_S, activation_s).tolist()
        return list(zip(predict(peers.windows(others, begin_s)), done_s, strict=True))

    return listen


def _hearer(model: Model) -> Hear:
    def listen(takes: TakeSet) -> list[Answer]:
        answers = [hear(model, takes, i) for i in range(len(takes))]
        return [(answer.label, answer.decided_s) for answer in answers]

    return listen


def _score(parts: Sequence[Part], learn: Learn) -> Evaluation:
    """What a recogniser makes of all parts together; it learns once for the same takes."""
    pairs: list[tuple[str, str | None]] = []
    took_ms: list[float] = []
    learned: tuple[TakeSet, Hear, float] | None = None
    for seen, unseen in parts:
        if learned is None or learned[0] is not seen:
            learned = (seen, learn(seen), peers.onset_level_g(seen))
        answers, level_g = learned[1](unseen), learned[2]
        pairs += zip(unseen.labels, (label for label, _ in answers), strict=True)
        took_ms += [
            1000.0 * (decided_s - begin_s)
            for (label, decided_s), begin_s in zip(
                answers, peers.onsets_s(unseen, level_g), strict=True
            )
            if label is not None
        ]
    labels = tuple(dict.fromkeys(label for seen, _ in parts for label in seen.labels))
    return tally(labels, pairs, took_ms)


def _adapted(parts: Sequence[Part]) -> Iterator[tuple[str, Evaluation]]:
    """Ours after the first takes of each gesture only; from none it is the shared base model."""
    base = _hearer(load_model(BASE))
    yield "0 takes", _score(parts, lambda _: base)
    for count in ADAPTED_TO:
        fewer: dict[int, TakeSet] = {id(seen): _first(seen, count) for seen, _ in parts}
        found = _score([(fewer[id(seen)], unseen) for seen, unseen in parts], _learn_from_few)
        yield f"{count} takes", found


def _learn_from_few(takes: TakeSet) -> Hear:
    """One take of a gesture cannot be divided: without a cross-validation then."""
    is_divisible = len(takes) > len(set(takes.labels))
    return _hearer(train(takes, seed=SEED, is_validated=is_divisible))


def _nongestures(seen: TakeSet) -> Contest:
    """What ours, trained by one person, makes of what is no gesture: all "recognised" is wrong."""
    others = make_negatives(NEGATIVES, SEED)
    answers = learn_ours(seen)(others)
    pairs = zip(others.labels, (label and HEARD for label, _ in answers), strict=True)
    found = tally(tuple(dict.fromkeys(others.labels)), pairs)
    return Contest(f"{OURS}, what is no gesture: heard as one is (wrong)", [(OURS, found)])


def _by_setting(parts: Sequence[Part]) -> Iterator[tuple[str, Evaluation]]:
    """Ours with other thresholds: fewer wrong ones cost answers."""
    models = {id(seen): train(seen, seed=SEED) for seen, _ in parts}
    for early, last in SETTINGS:

        def learn(seen: TakeSet, early: float = early, last: float = last) -> Hear:
            model = models[id(seen)]
            assert model.decision is not None
            decision = replace(model.decision, early=early, last=last)
            return _hearer(replace(model, decision=decision))

        yield f"{early:g} / {last:g}", _score(parts, learn)


def _first(takes: TakeSet, count: int) -> TakeSet:
    """The first so many takes of each gesture."""
    seen: dict[str, int] = {}
    rows = []
    for row, label in enumerate(takes.labels):
        seen[label] = seen.get(label, 0) + 1
        if seen[label] <= count:
            rows.append(row)
    return takes.select(rows)


def _notes() -> list[str]:
    missing = peers.missing_words()
    return [
        "Every take was heard by a recogniser that had not seen it. Times are from the onset of "
        "the movement, of a posture from the activation; of answers with a gesture only.",
        *([missing] if missing else []),
    ]


def _cell(shares: tuple[float, float, float] | None) -> str:
    return "" if shares is None else f"{100 * shares[0]:.1f} ({100 * shares[1]:.1f})"
