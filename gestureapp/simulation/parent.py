"""How an emulator's process learns that it is to end: signals, and its parent's end of stdin.

A pipe that the parent holds open closes with the parent, however that ends, kill -9 included; so no
child outlives it. A thread reads it because not every system can select on a pipe.
"""

import contextlib
import os
import signal
import threading
from collections.abc import Callable
from types import FrameType

from gestureapp.worker import Worker

_STDIN = 0


def on_stdin_end(act: Callable[[], None]) -> Worker:
    """Start a thread that calls ``act`` once standard input has ended.

    Returns:
        The thread; it cannot be stopped, it ends with the process.
    """

    def run(_: threading.Event) -> None:
        with contextlib.suppress(OSError):  # a closed or missing stdin has ended, too
            while os.read(_STDIN, 4096):
                pass
        act()

    worker = Worker("stdin watch", run)
    worker.start()
    return worker


def on_end_signals(act: Callable[[], None]) -> None:
    """Call ``act`` on SIGTERM and SIGINT. Main thread only; ``act`` must be short."""

    def act_on(_: int, __: FrameType | None) -> None:
        act()

    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, act_on)
