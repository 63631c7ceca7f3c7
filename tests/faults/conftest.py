"""Emulators and an application for all faults; what survives a fault is used for the next."""

import sys
import threading
from collections.abc import Iterator

import pytest

from gestureapp.benchmark.faults.rig import Rig


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rig]:
    before = set(threading.enumerate())
    with Rig(tmp_path_factory.mktemp("faults"), [sys.executable, "-m", "ui"]) as running:
        yield running
    assert set(threading.enumerate()) <= before


@pytest.fixture(autouse=True)
def no_thread_left() -> None:
    """The thread that hears the application lives from one test to the next; see ``rig``."""
