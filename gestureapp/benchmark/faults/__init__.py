"""Faults tried on the real application: how soon the robot is held, and whether all is told.

The emulators, the application and its guardian are processes of their own; the times are those of
the emulated controller's log. ``scenarios`` has the faults, for the tests as for the benchmark.
"""

import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from gestureapp.benchmark.faults.rig import Rig
from gestureapp.benchmark.faults.scenario import Outcome, Scenario, try_fault
from gestureapp.benchmark.faults.scenarios import SCENARIOS
from gestureapp.benchmark.faults.table import FaultReport, FaultRow
from gestureapp.errors import ConfigError, WorkerError


def run_faults(runs: int, names: Sequence[str], program: Sequence[str]) -> FaultReport:
    """Try each fault so many times.

    Args:
        runs: Of each.
        names: Of the faults; all when empty.
        program: The command that runs the application with its window.

    Raises:
        GestureAppError: there is no such fault, or the emulators could not be started.
    """
    chosen = _chosen(names)
    rows = []
    with (
        tempfile.TemporaryDirectory() as folder,
        Rig(Path(folder), program) as rig,
    ):
        for scenario in chosen:
            outcomes = []
            for run in range(runs):
                _show(f"{scenario.name}: {run + 1} of {runs}")
                outcomes.append(_tried(rig, scenario))
            rows.append(FaultRow(scenario, outcomes))
        _show("")
        n_surprises = rig.n_surprises
    return FaultReport(rows, n_surprises)


def _tried(rig: Rig, scenario: Scenario) -> Outcome:
    """One trial; what could not be tried is told as a problem, and the next one begins anew."""
    try:
        return try_fault(rig, scenario)
    except WorkerError as error:
        rig.beside.close()
        rig.end_application()
        return Outcome(None, None, "", (f"could not be tried: {error}",))


def _chosen(names: Sequence[str]) -> list[Scenario]:
    known = {scenario.name: scenario for scenario in SCENARIOS}
    for name in names:
        if name not in known:
            raise ConfigError("--fault", name, f"is none of {', '.join(known)}")
    return [known[name] for name in names] or list(SCENARIOS)


def _show(text: str) -> None:
    if sys.stderr.isatty():
        sys.stderr.write(f"\r{text:60}\r")
