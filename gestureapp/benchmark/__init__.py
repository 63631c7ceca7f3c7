"""The figures of the README, measured on this machine: ``gestureapp benchmark``.

Nothing here is a test: figures are printed, never judged.
"""

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from gestureapp.benchmark.report import Report
from gestureapp.children import program_command
from gestureapp.errors import ConfigError
from gestureapp.window_port import OpenWindow

if TYPE_CHECKING:
    from gestureapp.benchmark.contest import ContestReport
    from gestureapp.benchmark.faults.table import FaultReport


def measure(what: str, seconds: float, open_window: OpenWindow | None) -> Report:
    """Measure one of the figures.

    Args:
        what: ``latency``, ``stop``, ``training``, ``hearing`` or ``startup``.
        seconds: How long each case runs at least; training and hearing take what they take.
        open_window: Opens the window that is drawn meanwhile; not needed for those two.

    Raises:
        GestureAppError: the cell could not be started, there is no such figure, or no window.
    """
    if what == "training":
        from gestureapp.benchmark.training import measure_training

        return measure_training()
    if what == "hearing":
        from gestureapp.benchmark.hearing import measure_hearing

        return measure_hearing()
    if open_window is None:
        raise ConfigError("benchmark", what, "needs the window: run it as gestureapp")
    if what == "latency":
        from gestureapp.benchmark.latency import measure_latency

        return measure_latency(seconds, open_window)
    if what == "stop":
        from gestureapp.benchmark.stop import measure_stop

        return measure_stop(seconds, open_window)
    if what == "startup":
        from gestureapp.benchmark.startup import measure_startup

        return measure_startup()
    raise ConfigError("benchmark", what, "is no figure")


def measure_faults(
    runs: int, names: Sequence[str], open_window: OpenWindow | None
) -> "FaultReport":
    """Try faults on the application in a process of its own, and measure what comes of them.

    Args:
        runs: Of each fault.
        names: Of the faults; all when empty.
        open_window: Only tells that this program has a window.

    Raises:
        GestureAppError: there is no such fault, no window, another system than Linux, or the
            emulators could not be started.
    """
    if open_window is None:
        raise ConfigError("benchmark", "faults", "needs the window: run it as gestureapp")
    if not sys.platform.startswith("linux"):
        raise ConfigError("benchmark", "faults", "stops processes as only Linux lets it")
    from gestureapp.benchmark.faults import run_faults

    return run_faults(runs, names, program_command())


def measure_recognition(
    n_people: int, takes: Path | None, gestures: Sequence[str]
) -> "ContestReport":
    """What the recognisers, ours, the paper's and outside peers, make of unseen takes.

    Args:
        n_people: Simulated ones, when there is no file.
        takes: File of takes to cross-validate with, or None.
        gestures: Of the file's, only these; all when empty.

    Raises:
        GestureAppError: the file cannot be used.
    """
    from gestureapp.benchmark.contest import measure_file, measure_simulated

    return measure_simulated(n_people) if takes is None else measure_file(takes, gestures)
