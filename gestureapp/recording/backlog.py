"""The bounded queue between the cell and the disk: plot data goes first when there is no room."""

import threading
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass

from gestureapp.cell.records import Record

PLOT_MARK = 4_000
"""Records waiting above which plot data is dropped: 8 to 20 s of a running cell."""
LIMIT = 40_000
"""Records waiting at most: two minutes of a running cell, some 25 MB."""

Entry = tuple[int, Record]
"""A record with its place in the order of arrival."""


@dataclass(frozen=True, slots=True)
class Dropped:
    """What did not reach the disk, since the start.

    Attributes:
        n_plot: Samples, wanted for plots only.
        n_decisions: Everything else; 0 unless the disk was gone for minutes.
    """

    n_plot: int = 0
    n_decisions: int = 0

    @property
    def n_all(self) -> int:
        """Both together."""
        return self.n_plot + self.n_decisions


class Backlog:
    """Records that wait for the disk.

    Any thread puts; the recorder's thread takes. The lock is held for a few appends only, never
    while anything is written, so that ``put`` costs its caller about a microsecond.
    """

    def __init__(self, plot_mark: int = PLOT_MARK, limit: int = LIMIT) -> None:
        if not 0 < plot_mark <= limit:
            raise ValueError(f"plot_mark {plot_mark} must lie between 1 and the limit {limit}")
        self._plot_mark = plot_mark
        self._limit = limit
        self._lock = threading.Lock()
        self._plots: deque[Entry] = deque()
        self._decisions: deque[Entry] = deque()
        self._seq = 0
        self._n_plot_dropped = 0
        self._n_decisions_dropped = 0

    def __len__(self) -> int:
        return len(self._plots) + len(self._decisions)

    @property
    def dropped(self) -> Dropped:
        """What was dropped since the start."""
        with self._lock:
            return Dropped(self._n_plot_dropped, self._n_decisions_dropped)

    def put(self, record: Record) -> None:
        """Take a record.

        Plot data is dropped and counted above the mark. At the limit a decision takes the place of
        the oldest plot data, and where there is none that of the oldest decision: the newest ones
        say why the robot stands where it stands.
        """
        is_plot = record.topic.is_plot_data
        with self._lock:
            if is_plot and len(self) >= self._plot_mark:
                self._n_plot_dropped += 1
                return
            self._seq += 1
            (self._plots if is_plot else self._decisions).append((self._seq, record))
            self._trim()

    def take(self, n_max: int) -> list[Entry]:
        """Take out at most ``n_max`` records, oldest first."""
        taken: list[Entry] = []
        with self._lock:
            while len(taken) < n_max and len(self):
                taken.append(self._older_queue().popleft())
        return taken

    def restore(self, entries: Sequence[Entry]) -> None:
        """Put back in front what was taken and could not be written."""
        with self._lock:
            for entry in reversed(entries):
                queue = self._plots if entry[1].topic.is_plot_data else self._decisions
                queue.appendleft(entry)
            self._trim()

    def count_dropped(self, record: Record) -> None:
        """Count a record that was given up elsewhere."""
        with self._lock:
            self._count(record)

    def _older_queue(self) -> deque[Entry]:
        if not self._plots or not self._decisions:
            return self._plots or self._decisions
        return self._plots if self._plots[0][0] < self._decisions[0][0] else self._decisions

    def _trim(self) -> None:
        while len(self) > self._limit:
            self._count((self._plots or self._decisions).popleft()[1])

    def _count(self, record: Record) -> None:
        if record.topic.is_plot_data:
            self._n_plot_dropped += 1
        else:
            self._n_decisions_dropped += 1
