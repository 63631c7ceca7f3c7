"""How well both presets do on takes they have not seen: simulated people, or takes from a file."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from gestureapp.benchmark.report import machine
from gestureapp.errors import ModelError
from gestureapp.recognition.evaluation import Evaluation
from gestureapp.recognition.folds import FoldBy
from gestureapp.recognition.hearing import evaluate
from gestureapp.recognition.patterns import REST_G
from gestureapp.recognition.presets import Preset
from gestureapp.recognition.takes import TakeSet, load_takes
from gestureapp.recognition.training import train
from gestureapp.simulation.takes import make_takes

F64 = NDArray[np.float64]

SEED = 7
TRAINED_ON, TESTED_ON = 30, 100
ONSET_G = 0.2
"""A hand that departs this far from a level rest has begun to move."""
SHARES = ("recognised", "wrong", "rejected")


@dataclass(frozen=True, slots=True)
class Outcome:
    """Shares in per cent, one row a person or a whole: recognised, wrong, rejected."""

    name: str
    shares: F64

    def as_json(self) -> dict[str, object]:
        """Plain values: mean, spread and every person."""
        found: dict[str, object] = {"name": self.name, "n": len(self.shares)}
        for column, name in enumerate(SHARES):
            values = self.shares[:, column]
            found[name] = {
                "mean": float(values.mean()),
                "standard_deviation": _spread(values),
                "least": float(values.min()),
                "most": float(values.max()),
                "each": values.tolist(),
            }
        return found

    def as_row(self) -> str:
        """A row of the table: mean, and with several people their spread."""
        cells = [self._cell(column) for column in range(len(SHARES))]
        return f"| {self.name} | {' | '.join(cells)} |"

    def _cell(self, column: int) -> str:
        values = self.shares[:, column]
        if len(values) == 1:
            return f"{values[0]:.1f}"
        sign = "+" if self.name.startswith("difference") else ""
        low, high = f"{values.min():{sign}.1f}", f"{values.max():{sign}.1f}"
        return f"{values.mean():{sign}.1f} ± {_spread(values):.1f} ({low} to {high})"


@dataclass(frozen=True, slots=True)
class RecognitionReport:
    """Outcomes of presets side by side, and how they came about."""

    title: str
    outcomes: Sequence[Outcome]
    notes: Sequence[str]

    def as_json(self) -> dict[str, object]:
        """Plain values, with the machine."""
        outcomes = [outcome.as_json() for outcome in self.outcomes]
        return {
            "title": self.title,
            "machine": machine(),
            "outcomes": outcomes,
            "notes": list(self.notes),
        }

    def as_table(self) -> str:
        """A Markdown table in per cent."""
        head = ["| % | recognised | wrong | not recognised |", "|---|---|---|---|"]
        rows = [outcome.as_row() for outcome in self.outcomes]
        notes = [f"\n{note}" for note in self.notes]
        return "\n".join([f"{self.title} ({machine()})", "", *head, *rows, *notes])


def measure_people(n_people: int, seed: int = SEED) -> RecognitionReport:
    """Train both presets for simulated people on one day, and test them on fresh takes of another.

    Args:
        n_people: How many; each trains alone, with takes of one session.
        seed: Who they are.
    """
    first = make_takes(n_people, TRAINED_ON, seed, session=1)
    second = make_takes(n_people, TESTED_ON, seed, session=2)
    fresh: dict[Preset, list[Evaluation]] = {preset: [] for preset in Preset}
    blind: list[Evaluation] = []
    for name in dict.fromkeys(first.user):
        takes, others = _of_user(first, name), _of_user(second, name)
        for preset in Preset:
            is_validated = preset is Preset.DEFAULT
            model = train(takes, preset, seed, is_validated=is_validated)
            fresh[preset].append(evaluate(model, others))
            if model.cross_validation is not None:
                blind.append(model.cross_validation.evaluation)
    paper, default = (_shares(fresh[preset]) for preset in (Preset.PAPER, Preset.DEFAULT))
    better = int(np.sum(default[:, 0] > paper[:, 0]))
    return RecognitionReport(
        f"{n_people} simulated people, {TRAINED_ON} takes of each gesture to train",
        [
            Outcome("`paper`, another day", paper),
            Outcome("`default`, another day", default),
            Outcome("difference of the two, paired", default - paper),
            Outcome("`default`, cross-validated on the day of training", _shares(blind)),
        ],
        [
            f"mean ± standard deviation over people (least to most); {TESTED_ON} fresh takes of "
            "each gesture on another day",
            f"`default` recognises more for {better} of {n_people} people",
        ],
    )


def measure_takes(path: Path, gestures: Sequence[str] = ()) -> RecognitionReport:
    """Cross-validate both presets on takes from a file, by repetition and by person.

    Args:
        path: An NPZ file of takes; ``user`` and ``repetition`` decide which splits there are.
        gestures: Only these; all when empty.

    Raises:
        RecordingInvalid: the file cannot be read.
        NotEnoughTakes: too few are left of a gesture.
        ModelError: the takes name neither repetition nor person.
    """
    takes = load_takes(path)
    if gestures:
        takes = takes.select([i for i, label in enumerate(takes.labels) if label in gestures])
    outcomes: list[Outcome] = []
    for words, varied in (("activation", takes), ("onset", at_onset(takes))):
        for split, parts in _splits(varied):
            for preset in Preset:
                found = [_blind(part, preset, by) for part, by in parts]
                summed = _summed(found)
                name = f"`{preset.value}`, {split}, from the {words}"
                outcomes.append(Outcome(name, _shares([summed])))
    if not outcomes:
        raise ModelError(
            path, "the takes name neither 'repetition' nor 'user': nothing to split by"
        )
    n = len(takes)
    return RecognitionReport(
        f"{n} takes of {', '.join(dict.fromkeys(takes.labels))} from {path.name}",
        outcomes,
        [
            *takes.remarks,
            "cross-validated: every take is heard by a network that has not seen it",
            f"from the onset: the window begins where the hand departs {ONSET_G} g from rest",
        ],
    )


def at_onset(takes: TakeSet) -> TakeSet:
    """The same takes with the activation moved to where the right arm begins to move.

    Where it never does, the activation stays.
    """
    moved = takes.activation.copy()
    for i in range(len(takes)):
        away = np.linalg.norm(takes.accel_g(i)[moved[i] :] - REST_G, axis=1) > ONSET_G
        if away.any():
            moved[i] += int(np.argmax(away))
    return replace(takes, activation=moved)


def _splits(takes: TakeSet) -> Iterator[tuple[str, list[tuple[TakeSet, FoldBy]]]]:
    users = list(dict.fromkeys(takes.user))
    if len(set(takes.repetition)) > 1:
        if len(users) > 1:
            alone = [(_of_user(takes, user), FoldBy.REPETITION) for user in users]
            yield "each person alone, by repetition", alone
        yield "all together, by repetition", [(takes, FoldBy.REPETITION)]
    if len(users) > 1:
        yield "one person left out", [(takes, FoldBy.USER)]


def _blind(takes: TakeSet, preset: Preset, by: FoldBy) -> Evaluation:
    found = train(takes, preset, SEED, folds=by).cross_validation
    assert found is not None
    return found.evaluation


def _summed(found: Sequence[Evaluation]) -> Evaluation:
    """The counts of evaluations of the same gestures together."""
    confusion = np.sum([evaluation.confusion for evaluation in found], axis=0)
    return Evaluation(found[0].labels, confusion, found[0].decision_ms)


def _of_user(takes: TakeSet, user: str) -> TakeSet:
    return takes.select([i for i, name in enumerate(takes.user) if name == user])


def _shares(found: Sequence[Evaluation]) -> F64:
    return 100.0 * np.array([(e.recognised, e.wrong, e.rejected) for e in found])


def _spread(values: F64) -> float:
    return float(values.std(ddof=1)) if len(values) > 1 else 0.0
