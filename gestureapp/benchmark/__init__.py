"""The figures of the README, measured on this machine: ``gestureapp benchmark``.

Nothing here is a test: figures are printed, never judged.
"""

from gestureapp.benchmark.report import Report
from gestureapp.errors import ConfigError
from gestureapp.window_port import OpenWindow


def measure(what: str, seconds: float, open_window: OpenWindow | None) -> Report:
    """Measure one of the figures.

    Args:
        what: ``latency``, ``stop``, ``training`` or ``startup``.
        seconds: How long each case runs at least; training takes what it takes.
        open_window: Opens the window that is drawn meanwhile; needed for all but ``training``.

    Raises:
        GestureAppError: the cell could not be started, there is no such figure, or no window.
    """
    if what == "training":
        from gestureapp.benchmark.training import measure_training

        return measure_training()
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
