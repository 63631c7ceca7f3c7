"""New samples of one arm for whatever measures it."""

import numpy as np
from numpy.typing import NDArray

from gestureapp.sensing.store import SampleStore

F64 = NDArray[np.float64]


class Feed:
    """Hands on what a stream's store gets from now on. Owned by one thread.

    Args:
        store: Of the stream.
    """

    def __init__(self, store: SampleStore) -> None:
        self._store, self._count = store, store.count
        self._from_s = float("-inf")

    def skip_until(self, t_s: float) -> None:
        """Pass over what was received up to then: it was corrected otherwise."""
        self._from_s = t_s

    def rows(self) -> F64:
        """What has come since the last call: rows of receive time, x, y, z in g."""
        rows, self._count = self._store.since(self._count)
        return rows[rows[:, 0] > self._from_s]
