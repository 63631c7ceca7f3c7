"""What the emulated NX100 heard, said and did, with times: the truth for tests and benchmarks."""

import json
import threading
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from typing import TextIO

from gestureapp.errors import RecordingError
from gestureapp.robot.values import Pose

KEPT_EVENTS = 100_000
"""In memory, the newest; the file has all."""


class What(Enum):
    """Kind of a log event."""

    OPEN = "open"
    CLOSE = "close"
    IN = "in"
    OUT = "out"
    REQUEST = "request"
    BAD = "bad"
    MOTION_START = "motion_start"
    MOTION_END = "motion_end"
    FAULT = "fault"


@dataclass(frozen=True, slots=True)
class LogEvent:
    """One thing that happened.

    Attributes:
        t_s: Monotonic: right after the bytes were read or written, when the last byte of a request
            arrived, or exactly when the motion began or ended.
        what: Its kind.
        connection: Running number from 1; 0 when it belongs to none.
        data: Bytes that came or went.
        name: Command of a request; why a motion ended or a connection was closed; kind of a fault.
        text: Operands of a request; the line that was refused.
        is_odd: A request's size does not fit its data.
        pose: Where a motion began or ended, robot frame.
    """

    t_s: float
    what: What
    connection: int = 0
    data: bytes = b""
    name: str = ""
    text: str = ""
    is_odd: bool = False
    pose: Pose | None = None

    @property
    def line(self) -> str:
        """The event as it stands in the file, without its line end."""
        fields: dict[str, object] = {"t_s": self.t_s, "event": self.what.value}
        if self.what in (What.IN, What.OUT):
            fields |= {"event": "bytes", "direction": self.what.value}
            fields |= {"connection": self.connection, "text": self.data.decode("latin-1")}
        elif self.what is What.REQUEST:
            fields |= {"connection": self.connection, "request": self.name, "data": self.text}
            fields |= {"is_odd": self.is_odd}
        elif self.pose is not None:
            fields |= {"reason": self.name, "pose": [*_rounded(self.pose)]}
        else:
            fields |= {"connection": self.connection, "name": self.name, "text": self.text}
        return json.dumps(fields)


class EventLog:
    """Collects events from the emulator's loop; anyone may read it from any thread.

    Args:
        file: Where JSON lines are written as well; None for nowhere.

    Raises:
        RecordingError: the file cannot be written.
    """

    def __init__(self, file: Path | None = None) -> None:
        self._changed = threading.Condition()
        self._events: deque[LogEvent] = deque(maxlen=KEPT_EVENTS)
        self._file: TextIO | None = None
        if file is not None:
            try:
                self._file = file.open("w", encoding="ascii")
            except OSError as error:
                raise RecordingError(file, f"cannot be written: {error.strerror}") from error

    def add(self, event: LogEvent) -> None:
        """Append an event and wake who waits for it."""
        with self._changed:
            self._events.append(event)
            if self._file is not None:
                self._file.write(event.line + "\n")
            self._changed.notify_all()

    def events(self, *what: What) -> list[LogEvent]:
        """Give the events of these kinds, or all, oldest first."""
        with self._changed:
            return [event for event in self._events if not what or event.what in what]

    def requests(self, name: str | None = None) -> list[LogEvent]:
        """Give the complete requests, of one command or of all."""
        return [e for e in self.events(What.REQUEST) if name is None or e.name == name]

    def wait_for(self, is_it: Callable[[LogEvent], bool], limit_s: float = 5.0) -> LogEvent | None:
        """Wait until an event is such as asked for; give the first, or None at the limit."""

        def found() -> LogEvent | None:
            return next((event for event in self._events if is_it(event)), None)

        with self._changed:
            return self._changed.wait_for(found, limit_s)

    def flush(self) -> None:
        """Bring what was added to the file. Called by the loop when it has nothing to do."""
        with self._changed:
            if self._file is not None:
                self._file.flush()

    def close(self) -> None:
        """Close the file; events in memory stay. Idempotent."""
        with self._changed:
            if self._file is not None:
                self._file.close()
                self._file = None


def _rounded(pose: Pose) -> tuple[float, ...]:
    return tuple(round(part, 6) for part in (*pose.position_mm, *pose.rotation_deg))
