"""One emulator as a child process: started, heard until it is ready, ended with its parent."""

import contextlib
import os
import re
import subprocess
import threading
from collections import deque
from collections.abc import Sequence

from gestureapp.children import child_environment
from gestureapp.clock import Clock, monotonic
from gestureapp.errors import WorkerError
from gestureapp.worker import Worker

LINES_KEPT = 20

EXIT_WITHIN_S = 1.0
"""A child that has closed its output ends within this, or is said to have closed its output."""

_READY = re.compile(r"^(listening|control) on (\S+):(\d+)$")


class EmulatorProcess:
    """A child that prints ``listening on HOST:PORT`` when it is ready.

    Its standard input is a pipe that stays open as long as this process lives; the child ends with
    it. Owned by one thread.

    Attributes:
        name: For a person.
        port: Where it listens; 0 before it is ready.
        control_port: Where its control lines go; 0 when there is none.
    """

    def __init__(self, name: str, command: Sequence[str]) -> None:
        """Start the process.

        Raises:
            WorkerError: it cannot be started.
        """
        self.name = name
        self.port = 0
        self.control_port = 0
        self._is_closing = False
        self._heard = threading.Event()
        self._ended = threading.Event()
        self._last_lines: deque[str] = deque(maxlen=LINES_KEPT)
        try:
            self._process = subprocess.Popen(
                command,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                env=child_environment(),
                # Ctrl-C in the terminal is for the application, which ends its children in order.
                start_new_session=os.name == "posix",
                creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
            )
        except OSError as error:
            raise WorkerError(name, f"cannot be started ({error})") from error
        self._reader = Worker(f"{name} output", self._read)
        self._reader.start()

    def wait_ready(self, deadline_s: float, clock: Clock = monotonic) -> None:
        """Wait until it listens.

        Args:
            deadline_s: Monotonic time.
            clock: Monotonic seconds.

        Raises:
            WorkerError: it ended, or was not ready in time.
        """
        self._heard.wait(max(0.0, deadline_s - clock()))
        if self.port == 0:
            reason = self.problem or "is not ready in time; the machine may be too busy, try again"
            raise WorkerError(self.name, reason)

    def wait_ended(self, limit_s: float) -> bool:
        """Wait until the process has ended. Returns whether that was within the limit."""
        return self._ended.wait(limit_s)

    @property
    def pid(self) -> int:
        """The process's id."""
        return self._process.pid

    @property
    def problem(self) -> str:
        """Empty while it runs or after ``close``; else how it ended and what it said last."""
        if self._is_closing or not self._ended.is_set():
            return ""
        code = self._process.poll()
        how = "closed its output" if code is None else f"ended with code {code}"
        last = next((line for line in reversed(self._last_lines) if line), "no word")
        return f"{how} ({last}); start the demo again"

    def ask_to_end(self) -> None:
        """Close its standard input. Idempotent."""
        self._is_closing = True
        if self._process.stdin is not None:
            with contextlib.suppress(OSError):
                self._process.stdin.close()

    def close(self, wait_s: float = 1.0) -> None:
        """End it: ask, wait, terminate, wait, kill. Idempotent."""
        self.ask_to_end()
        for force in (self._process.terminate, self._process.kill):
            try:
                self._process.wait(wait_s)
                break
            except subprocess.TimeoutExpired:
                force()
        self._process.wait()
        self._reader.stop()
        if self._process.stdout is not None:
            self._process.stdout.close()

    def _read(self, _: threading.Event) -> None:
        """Hear the child to its end, so that its pipe never fills."""
        if self._process.stdout is None:
            return
        try:
            for raw in self._process.stdout:
                self._hear(raw.decode("utf-8", "replace").rstrip())
        finally:
            with contextlib.suppress(subprocess.TimeoutExpired):
                self._process.wait(EXIT_WITHIN_S)  # its exit code follows the end of its output
            self._ended.set()
            self._heard.set()

    def _hear(self, line: str) -> None:
        self._last_lines.append(line)
        match = _READY.match(line)
        if match is None:
            return
        word, _, port = match.groups()
        if word == "control":
            self.control_port = int(port)
        else:
            self.port = int(port)
            self._heard.set()
