"""The application under test as a process of its own, that can be killed and stopped."""

import os
import re
import signal
from collections.abc import Sequence
from pathlib import Path

from gestureapp.clock import monotonic
from gestureapp.errors import WorkerError
from gestureapp.simulation.child import EmulatorProcess
from gestureapp.simulation.control_link import ControlLink

READY_WITHIN_S = 20.0
ANSWER_WITHIN_S = 5.0
"""A process that was stopped and goes on answers after what has piled up."""
COMMAND = "fault-subject"
"""The hidden command of the program."""


class Application:
    """One process of the application with its command port. Owned by one thread.

    Args:
        program: The command that runs the application with its window.
        config: Its settings file.
        folder: For its sessions and the guardian's log.

    Raises:
        WorkerError: it does not start.
    """

    def __init__(self, program: Sequence[str], config: Path, folder: Path) -> None:
        self._child = EmulatorProcess("application", [*program, COMMAND, str(config), str(folder)])
        self._link: ControlLink | None = None
        try:
            self._child.wait_ready(monotonic() + READY_WITHIN_S)
        except WorkerError:
            self._child.close()
            raise
        self._link = ControlLink("application", "127.0.0.1", self._child.port, ANSWER_WITHIN_S)

    @property
    def pid(self) -> int:
        """Its process id."""
        return self._child.pid

    @property
    def guardian_pid(self) -> int:
        """Of the guardian in use; the spare one was started later.

        Raises:
            WorkerError: it has none.
        """
        found = children_of(self.pid, b"guardian")
        if not found:
            raise WorkerError("application", "has no guardian; start it again")
        return min(found)

    def ask(self, what: str, **fields: object) -> dict[str, object]:
        """Ask its command port.

        Raises:
            WorkerError: it does not answer.
        """
        if self._link is None:
            raise WorkerError("application", "is not started")
        return self._link.ask({"do": what, **fields})

    def signal(self, number: signal.Signals) -> float:
        """Send a signal. Returns when, monotonic seconds."""
        at_s = monotonic()
        os.kill(self.pid, number)
        return at_s

    def limit_files(self, n_bytes: int | None) -> None:
        """Let no file of it grow beyond so many bytes, as a full disk does; None lifts it."""
        import resource  # there is none on Windows

        _, hard = resource.prlimit(self.pid, resource.RLIMIT_FSIZE)
        soft = hard if n_bytes is None else n_bytes
        resource.prlimit(self.pid, resource.RLIMIT_FSIZE, (soft, hard))

    def wait_ended(self, limit_s: float) -> bool:
        """Wait until the process and what it has started have ended."""
        return self._child.wait_ended(limit_s)

    def close(self) -> None:
        """End it in order, or by force when that takes too long. Idempotent."""
        if self._link is not None:
            self._link.close()
        self._child.close(3.0)


def children_of(pid: int, word: bytes) -> list[int]:
    """Process ids of a process's children with this word in their command; Linux."""
    found = []
    for status in Path("/proc").glob("[0-9]*/status"):
        try:
            text = status.read_text()
            command = (status.parent / "cmdline").read_bytes()
        except OSError:
            continue  # it has ended meanwhile
        is_child = re.search(rf"^PPid:\t{pid}$", text, re.MULTILINE)
        if is_child and word in command and "\nState:\tZ" not in text:
            found.append(int(status.parent.name))
    return found
