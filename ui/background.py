"""What takes longer than a frame, done beside the window; its answer comes back to the window."""

import queue
from collections import deque
from collections.abc import Callable
from typing import Any, TypeVar

from PySide6.QtCore import QObject, QTimer

from gestureapp.errors import WorkerError
from gestureapp.worker import Worker

_LOOK_MS = 10
_T = TypeVar("_T")


class Background(QObject):
    """Does one thing after another, each in a thread that ends with it. GUI thread only.

    Args:
        name: Of the threads, as it stands in logs.
    """

    def __init__(self, name: str, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._name = name
        self._waiting: deque[tuple[Callable[[], Any], Callable[[Any], None]]] = deque()
        self._then: Callable[[Any], None] | None = None
        self._failed: Callable[[str], None] = lambda text: None
        self._answers: queue.SimpleQueue[tuple[object, WorkerError | None]] = queue.SimpleQueue()
        self._timer = QTimer(self, interval=_LOOK_MS)
        self._timer.timeout.connect(self._look)

    @property
    def is_busy(self) -> bool:
        """Something is under way or waits for its turn."""
        return self._then is not None or bool(self._waiting)

    def on_error(self, failed: Callable[[str], None]) -> None:
        """What is called in the GUI thread when something raised; its own answer never comes."""
        self._failed = failed

    def run(self, work: Callable[[], _T], then: Callable[[_T], None]) -> None:
        """Do this when its turn comes, and hand its answer over in the GUI thread."""
        self._waiting.append((work, then))
        self._begin()

    def _begin(self) -> None:
        if self._then is not None or not self._waiting:
            return
        work, self._then = self._waiting.popleft()
        answers = self._answers
        worker = Worker(
            self._name,
            lambda stopping: answers.put((work(), None)),
            lambda error: answers.put((None, error)),
        )
        self._timer.start()
        worker.start()

    def _look(self) -> None:
        try:
            answer, error = self._answers.get_nowait()
        except queue.Empty:
            return
        then, self._then = self._then, None
        if not self._waiting:
            self._timer.stop()
        if error is not None:
            self._failed(str(error))
        elif then is not None:
            then(answer)
        self._begin()
