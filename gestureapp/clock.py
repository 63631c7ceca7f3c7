"""The one clock: monotonic seconds, the same in every process of this machine."""

import time
from collections.abc import Callable

Clock = Callable[[], float]
"""Gives monotonic seconds. Passed in, so that tests can hold the time in their hand."""

monotonic: Clock = time.monotonic
"""Read with care: wall time is for people and files only, never for deadlines."""
