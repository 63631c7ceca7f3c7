"""The one clock: monotonic seconds, the same in every process of this machine."""

from collections.abc import Callable

from gestureapp.robot import clock

Clock = Callable[[], float]
"""Gives monotonic seconds. Passed in, so that tests can hold the time in their hand."""

monotonic: Clock = clock.monotonic
"""Read with care: wall time is for people and files only, never for deadlines."""
