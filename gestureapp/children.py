"""How the application starts itself as a child process: from source and from the frozen program."""

import os
import sys


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
