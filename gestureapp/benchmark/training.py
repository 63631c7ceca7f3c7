"""Both presets: how long they take, and what they recognise of fresh takes, as Table I."""

import json
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from gestureapp.benchmark.report import Report, Row
from gestureapp.children import child_command, child_environment
from gestureapp.clock import monotonic
from gestureapp.errors import WorkerError
from gestureapp.gestures import LABELS
from gestureapp.recognition.takes import save_takes
from gestureapp.simulation.takes import make_takes

PEOPLE = 4
SEED = 7
TRAINED_ON, TESTED_ON = 30, 100
COLUMNS = ("recognised", "wrong", "rejected")

Shares = dict[str, dict[str, float]]
"""By gesture, then by column; 0 to 1."""


def measure_training() -> Report:
    """Train for four ordinary people and one trained operator; test each on another day.

    Raises:
        WorkerError: a child failed.
    """
    rows: list[Row] = []
    columns: list[tuple[str, Shares]] = []
    operator: Shares = {}
    with tempfile.TemporaryDirectory() as name:
        for preset, aim in (("paper", "40 s"), ("default", "8 s")):
            times: list[float] = []
            people = [
                _one(Path(name), times, preset, SEED + index, practised=False)
                for index in range(PEOPLE)
            ]
            operator = _one(Path(name), times, preset, SEED, practised=True)
            columns.append((f"{PEOPLE} ordinary people, `{preset}`", _mean(people)))
            words = f"{preset} preset with its cross-validation, {12 * TRAINED_ON} takes"
            rows.append(Row(f"{words}, whole process", "s", tuple(times), aim))
    columns.append(("a trained operator, `default`", operator))
    return Report("Training", rows, [_table(columns)])


def _one(folder: Path, times: list[float], preset: str, seed: int, *, practised: bool) -> Shares:
    first, second, model = folder / "1.npz", folder / "2.npz", folder / "model.json"
    save_takes(first, make_takes(1, TRAINED_ON, seed, session=1, practised=practised))
    save_takes(second, make_takes(1, TESTED_ON, seed, session=2, practised=practised))
    begun_s = monotonic()
    _run("train", str(first), "-o", str(model), "--preset", preset)
    times.append(monotonic() - begun_s)
    found: Shares = json.loads(_run("evaluate", str(model), str(second), "--json"))["per_gesture"]
    return found


def _run(*arguments: str) -> str:
    done = subprocess.run(
        child_command(*arguments), env=child_environment(), capture_output=True, text=True
    )
    if done.returncode:
        raise WorkerError(arguments[0], done.stderr.strip() or f"ended with {done.returncode}")
    return done.stdout


def _mean(people: list[Shares]) -> Shares:
    return {
        label: {c: float(np.mean([person[label][c] for person in people])) for c in COLUMNS}
        for label in LABELS
    }


def _table(columns: list[tuple[str, Shares]]) -> str:
    lines = [
        f"{TESTED_ON} fresh takes of each gesture on another day, %: recognised / wrong / rejected",
        "",
        f"| gesture | {' | '.join(name for name, _ in columns)} |",
        f"|{'---|' * (1 + len(columns))}",
    ]
    for label in LABELS:
        cells = [_triple([shares[label][c] for c in COLUMNS]) for _, shares in columns]
        lines.append(f"| {label} | {' | '.join(cells)} |")
    means = [
        _triple([float(np.mean([shares[label][c] for label in LABELS])) for c in COLUMNS])
        for _, shares in columns
    ]
    return "\n".join([*lines, f"| **Mean** | {' | '.join(f'**{mean}**' for mean in means)} |"])


def _triple(shares: list[float]) -> str:
    return " / ".join(f"{100 * share:.1f}" for share in shares)
