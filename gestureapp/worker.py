"""The one way to start a thread: named, stoppable, and its death is reported, not swallowed."""

import logging
import threading
from collections.abc import Callable

from gestureapp.errors import WorkerError

log = logging.getLogger(__name__)


class Worker:
    """A named thread that runs one function until it is told to stop.

    The owner creates, starts and stops it; ``run`` must return soon after ``stopping`` is set.

    Attributes:
        name: Of the thread, as it stands in logs.
        stopping: Set once the worker is to end; wait on it instead of sleeping.
        error: What ended the thread, or None.
    """

    def __init__(
        self,
        name: str,
        run: Callable[[threading.Event], None],
        on_error: Callable[[WorkerError], None] | None = None,
    ) -> None:
        self.name = name
        self.stopping = threading.Event()
        self.error: WorkerError | None = None
        self._run = run
        self._on_error = on_error
        self._thread = threading.Thread(target=self._main, name=name, daemon=True)

    def start(self) -> None:
        """Start the thread. Once only."""
        self._thread.start()

    def stop(self, wait_s: float = 2.0) -> bool:
        """Ask the thread to end and wait for it; idempotent. Returns whether it has ended."""
        self.stopping.set()
        if self._thread.is_alive() and self._thread is not threading.current_thread():
            self._thread.join(wait_s)
        return not self._thread.is_alive()

    @property
    def is_alive(self) -> bool:
        """Whether the thread runs."""
        return self._thread.is_alive()

    def _main(self) -> None:
        try:
            self._run(self.stopping)
        except Exception as error:  # the top of a thread: log it, keep it, report it
            log.exception("%s ended by an error", self.name)
            self.error = WorkerError(self.name, f"{type(error).__name__}: {error}")
            if self._on_error is not None:
                self._on_error(self.error)
