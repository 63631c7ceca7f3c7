"""A ring of a stream's newest samples, written by its reader thread, read by anyone."""

import numpy as np
from numpy.typing import NDArray

from gestureapp.sensing.values import Sample


class SampleStore:
    """The newest samples of one stream.

    One thread appends, any thread reads, and nobody waits for anybody: a row is written before the
    count moves, and a reader takes the count first and drops the rows that may have been
    overwritten while it copied.
    """

    def __init__(self, capacity: int = 6000) -> None:
        self._capacity = capacity
        self._rows = np.zeros((capacity, 4), dtype=np.float64)
        self._count = 0

    @property
    def count(self) -> int:
        """Samples appended since the start."""
        return self._count

    def append(self, sample: Sample) -> None:
        """Add the newest sample. Reader thread only."""
        self._rows[self._count % self._capacity] = (sample.t_s, *sample.accel_g)
        self._count += 1

    def tail(self, span_s: float) -> NDArray[np.float64]:
        """The samples of the last ``span_s`` seconds before the newest one.

        Returns:
            A copy of shape (n, 4), oldest first: receive time in s on the monotonic clock, then
            x, y, z in g. Empty before the first sample.
        """
        rows, _ = self.since(0)
        if not len(rows):
            return rows
        first = int(np.searchsorted(rows[:, 0], rows[-1, 0] - span_s))
        return rows[first:]

    def since(self, count: int) -> tuple[NDArray[np.float64], int]:
        """The samples appended after the first ``count``, as far as they are still there.

        Returns:
            Rows as those of ``tail``, and the count to ask with next time.
        """
        before = self._count
        n = max(0, min(before - count, self._capacity))
        rows = self._rows[np.arange(before - n, before) % self._capacity]
        overwritten = self._count - before + 1 - (self._capacity - n)
        return rows[max(0, overwritten) :], before
