"""The emulated controller's own log, read as it grows: the truth for every figure and fault."""

import json
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True, slots=True)
class Requested:
    """A request that the controller emulator has received. Times: first and last byte."""

    connection: int
    name: str
    data: str
    first_s: float
    last_s: float


class ControllerLog:
    """What ``simulate nx100 --log FILE`` has written so far. One thread.

    Attributes:
        requests: Everything the controller received whole, in order.
        starts_s: When its motions began.
        ends_s: When they ended.
    """

    def __init__(self, file: Path) -> None:
        self.requests: list[Requested] = []
        self.starts_s: list[float] = []
        self.ends_s: list[float] = []
        self._file = file
        self._offset = 0
        self._first_s: dict[int, float] = {}

    def read(self) -> None:
        """Take what has been written since the last time; the end of a line may still come."""
        with self._file.open("rb") as stream:
            stream.seek(self._offset)
            new, end, _ = stream.read().rpartition(b"\n")
        self._offset += len(new) + len(end)
        for line in new.splitlines():
            self._take(json.loads(line))

    @property
    def is_moving(self) -> bool:
        """The newest motion has not ended."""
        return len(self.starts_s) > len(self.ends_s)

    def first(self, name: str, data: str, after_s: float) -> Requested | None:
        """The first request of a kind whose first byte came after a time."""
        found = (
            r for r in self.requests if (r.name, r.data) == (name, data) and r.first_s >= after_s
        )
        return next(found, None)

    def end_after(self, t_s: float) -> float | None:
        """When the first motion ended after a time."""
        return next((end_s for end_s in self.ends_s if end_s >= t_s), None)

    def _take(self, event: dict[str, object]) -> None:
        t_s, connection = float(str(event["t_s"])), int(str(event.get("connection", 0)))
        match event["event"]:
            case "bytes" if event["direction"] == "in" and "HOSTCTRL" in str(event["text"]):
                self._first_s[connection] = t_s
            case "request":
                begun_s = self._first_s.get(connection, t_s)
                name, data = str(event["request"]), str(event["data"] or "")
                self.requests.append(Requested(connection, name, data, begun_s, t_s))
            case "motion_start":
                self.starts_s.append(t_s)
            case "motion_end":
                self.ends_s.append(t_s)
