"""Things every test of the recording needs: times in the hand, disks that fail, records."""

import errno
import io
import threading
from collections.abc import Callable
from pathlib import Path
from typing import BinaryIO

import pytest

from gestureapp.cell.records import Record, Topic


class HeldClock:
    """A clock that stands until it is moved."""

    def __init__(self, now_s: float = 1000.0) -> None:
        self.now_s = now_s

    def __call__(self) -> float:
        return self.now_s

    def move(self, span_s: float) -> None:
        self.now_s += span_s


class Disk:
    """Opens real files whose writes can be made to fail or to wait.

    Attributes:
        error: The errno every write fails with; 0 when the disk works.
        room: Bytes it takes before it is full; None for any number.
        gate: Writes wait for it; set when the disk is quick.
        is_waiting: Set while a write waits.
    """

    def __init__(self) -> None:
        self.error = 0
        self.room: int | None = None
        self.gate = threading.Event()
        self.gate.set()
        self.is_waiting = threading.Event()

    def open(self, path: Path) -> BinaryIO:
        path.parent.mkdir(parents=True, exist_ok=True)
        return io.BufferedWriter(_DiskFile(self, path))

    def take(self, n_bytes: int) -> int:
        """How many of the bytes are taken; raises as a write would."""
        if not self.gate.is_set():
            self.is_waiting.set()
            assert self.gate.wait(20.0), "nobody let the disk go on"
            self.is_waiting.clear()
        if self.error:
            raise OSError(self.error, "as the test asked")
        if self.room is None:
            return n_bytes
        if self.room == 0:
            raise OSError(errno.ENOSPC, "No space left on device")
        taken = min(self.room, n_bytes)
        self.room -= taken
        return taken


class _DiskFile(io.FileIO):
    def __init__(self, disk: Disk, path: Path) -> None:
        super().__init__(path, "xb")
        self._disk = disk

    def write(self, data) -> int:
        n_taken = self._disk.take(len(data))
        return super().write(memoryview(data)[:n_taken])


@pytest.fixture
def clock() -> HeldClock:
    return HeldClock()


@pytest.fixture
def disk():
    disk = Disk()
    yield disk
    disk.gate.set()


@pytest.fixture(scope="session")
def left() -> Callable[[int, float], Record]:
    """Makes a sample of the left arm: plot data."""

    def make(seq: int, t_s: float) -> Record:
        fields = {"seq": seq, "ax_g": 0.01 * seq, "ay_g": -0.5, "az_g": 1.0, "counter": None}
        return Record(Topic.LEFT_ACCEL, t_s, fields)

    return make


@pytest.fixture(scope="session")
def decision() -> Callable[[int, float], Record]:
    """Makes a record that must not be lost."""

    def make(number: int, t_s: float) -> Record:
        fields = {"state": "ARMED", "sentence": "", "activation_id": number}
        return Record(Topic.STATE, t_s, fields)

    return make


@pytest.fixture
def wait_for() -> Callable[[Callable[[], bool]], None]:
    """Waits until something is so; fails after a limit. An event nobody sets paces the asking."""

    def wait(condition: Callable[[], bool], limit_s: float = 20.0) -> None:
        pace = threading.Event()
        for _ in range(int(limit_s / 0.005)):
            if condition():
                return
            pace.wait(0.005)
        pytest.fail("it did not become so in time")

    return wait
