"""The cell's story: one line for a person for everything that happened, newest last."""

from collections import deque

from gestureapp.cell.events import Say
from gestureapp.cell.records import Json, Record, Recorder, Topic
from gestureapp.cell.snapshot import EventLine
from gestureapp.clock import Clock

KEPT_LINES = 50
REPEATED_S = 1.0
"""The same alarm again within this is an answer to the first, and is shown once."""


class Story:
    """Keeps the newest lines and records all of them. Owned by the control thread.

    Args:
        record: Takes every line.
        wall_clock: Seconds since the epoch.
    """

    def __init__(self, record: Recorder, wall_clock: Clock) -> None:
        self._record, self._wall_clock = record, wall_clock
        self._lines: deque[EventLine] = deque(maxlen=KEPT_LINES)

    @property
    def lines(self) -> tuple[EventLine, ...]:
        """Oldest first."""
        return tuple(self._lines)

    def say(self, said: Say, now_s: float) -> None:
        """Add a line."""
        if not self._is_repeated(said, now_s):
            self._lines.append(EventLine(now_s, self._wall_clock(), said.text, said.is_alarm))
        fields: dict[str, Json] = {"text": said.text, "is_alarm": said.is_alarm}
        self._record(Record(Topic.EVENT, now_s, fields))

    def _is_repeated(self, said: Say, now_s: float) -> bool:
        if not self._lines or not said.is_alarm:
            return False
        last = self._lines[-1]
        return last.text == said.text and now_s - last.t_s < REPEATED_S
