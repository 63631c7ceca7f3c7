"""The guardian's process: started by the application, with a spare one that waits for its turn.

A Python process needs some 200 ms before it answers; a robot that lost its guardian while it moves
should not wait for that. So a second process is kept, which has imported everything and waits for
its ``Start`` line. It has no socket and knows no robot; when the application ends, so does it.
"""

import contextlib
import subprocess
import threading

from gestureapp.children import child_command, child_environment
from gestureapp.errors import GuardianLost

ENDS_WITHIN_S = 1.0


class SpareGuardian:
    """Keeps one process ready. Any thread."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._process: subprocess.Popen[bytes] | None = None
        self._is_closed = False

    def take(self) -> subprocess.Popen[bytes]:
        """The one that waits, or a new one.

        Raises:
            GuardianLost: none can be started.
        """
        with self._lock:
            process, self._process = self._process, None
        if process is not None and process.poll() is None:
            return process
        return _start_process()

    def prepare(self) -> None:
        """Have one wait. Without one the next guardian is started when it is needed."""
        with self._lock, contextlib.suppress(GuardianLost):
            if self._process is None and not self._is_closed:
                self._process = _start_process()

    def close(self) -> None:
        """End the one that waits. Idempotent."""
        with self._lock:
            self._is_closed = True
            process, self._process = self._process, None
        if process is None:
            return
        close_pipes(process)  # it ends when nobody can tell it to start any more
        try:
            process.wait(ENDS_WITHIN_S)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


def close_pipes(process: subprocess.Popen[bytes]) -> None:
    """Close our ends of its standard input and output."""
    for pipe in (process.stdin, process.stdout):
        if pipe is not None:
            with contextlib.suppress(OSError):
                pipe.close()


def _start_process() -> subprocess.Popen[bytes]:
    try:
        return subprocess.Popen(
            child_command("guardian"),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            start_new_session=True,
            env=child_environment(),
        )
    except OSError as error:
        raise GuardianLost(f"the guardian cannot be started: {error}; start again") from error
