"""The paper preset: how long it takes, and what it recognises of fresh takes, as Table I."""

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


def measure_training() -> Report:
    """Train for four ordinary people and one trained operator; test each on another day.

    Raises:
        WorkerError: a child failed.
    """
    times: list[float] = []
    results: list[dict[str, dict[str, float]]] = []
    with tempfile.TemporaryDirectory() as name:
        for index in range(PEOPLE):
            results.append(_one(Path(name), times, SEED + index, practised=False))
        operator = _one(Path(name), times, SEED, practised=True)
    row = Row(f"paper preset, {12 * TRAINED_ON} takes, whole process", "s", tuple(times), "40 s")
    return Report("Training", [row], [_table(results, operator)])


def _one(
    folder: Path, times: list[float], seed: int, *, practised: bool
) -> dict[str, dict[str, float]]:
    first, second, model = folder / "1.npz", folder / "2.npz", folder / "model.json"
    save_takes(first, make_takes(1, TRAINED_ON, seed, session=1, practised=practised))
    save_takes(second, make_takes(1, TESTED_ON, seed, session=2, practised=practised))
    begun_s = monotonic()
    _run("train", str(first), "-o", str(model), "--preset", "paper")
    times.append(monotonic() - begun_s)
    found: dict[str, dict[str, float]] = json.loads(
        _run("evaluate", str(model), str(second), "--json")
    )["per_gesture"]
    return found


def _run(*arguments: str) -> str:
    done = subprocess.run(
        child_command(*arguments), env=child_environment(), capture_output=True, text=True
    )
    if done.returncode:
        raise WorkerError(arguments[0], done.stderr.strip() or f"ended with {done.returncode}")
    return done.stdout


def _table(people: list[dict[str, dict[str, float]]], operator: dict[str, dict[str, float]]) -> str:
    columns = ("recognised", "wrong", "rejected")
    lines = [
        f"{TESTED_ON} fresh takes of each gesture on another day, %: recognised / wrong / rejected",
        "",
        f"| gesture | {PEOPLE} ordinary people, mean | a trained operator |",
        "|---|---|---|",
    ]
    ours, theirs = [], []
    for label in LABELS:
        mean = [100 * float(np.mean([p[label][c] for p in people])) for c in columns]
        one = [100 * operator[label][c] for c in columns]
        ours.append(mean)
        theirs.append(one)
        lines.append(f"| {label} | {_triple(mean)} | {_triple(one)} |")
    ends = [np.mean(ours, axis=0).tolist(), np.mean(theirs, axis=0).tolist()]
    lines.append(f"| **Mean** | **{_triple(ends[0])}** | **{_triple(ends[1])}** |")
    return "\n".join(lines)


def _triple(values: list[float]) -> str:
    return " / ".join(f"{value:.1f}" for value in values)
