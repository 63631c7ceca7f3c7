"""How the application starts itself as a child process: from source and from the frozen program."""

import contextlib
import os
import subprocess
import sys

POLITE = 10
"""Nice value of a child that works beside the cell."""


def child_command(*arguments: str) -> list[str]:
    """The command line that runs this application with other arguments, without any window."""
    if getattr(sys, "frozen", False):
        return [sys.executable, *arguments]
    return [sys.executable, "-m", "gestureapp", *arguments]


def program_command(*arguments: str) -> list[str]:
    """The command line that starts this very program again, window and all."""
    if getattr(sys, "frozen", False):
        return [sys.executable, *arguments]
    return [sys.executable, sys.argv[0], *arguments]


def child_environment() -> dict[str, str]:
    """The environment for children: one thread for numerics, and modules found as we found them.

    Two OpenBLAS threads beside other work made small matrix products up to 15 times slower.
    """
    paths = [path or os.getcwd() for path in sys.path]
    one = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}
    return {**os.environ, **one, "PYTHONPATH": os.pathsep.join(paths)}


def start_beside(command: list[str], *, is_spoken_with: bool = False) -> subprocess.Popen[bytes]:
    """Start a child that works when the cell leaves it the processor.

    Args:
        command: What to start.
        is_spoken_with: Its standard input and output are pipes; else its output is dropped.
    """
    flags = getattr(subprocess, "BELOW_NORMAL_PRIORITY_CLASS", 0)
    child = subprocess.Popen(
        command,
        env=child_environment(),
        stdin=subprocess.PIPE if is_spoken_with else None,
        stdout=subprocess.PIPE if is_spoken_with else subprocess.DEVNULL,
        creationflags=flags,
    )
    if hasattr(os, "setpriority"):
        with contextlib.suppress(ProcessLookupError):  # it has ended already
            os.setpriority(os.PRIO_PROCESS, child.pid, POLITE)
    return child
