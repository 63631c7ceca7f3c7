"""The running number of a sensor's frames: what was lost, what is old news. Pure."""

from gestureapp.sensing.values import CounterGap, CounterJump

MAX_MISSED = 6000
"""A minute at 100 Hz. A larger jump is no loss."""

WRAP_REACH = 64
"""A quarter of the narrowest counter: how far behind a wrap a number may lie and still be one.

Small, because a restarted sensor begins at 0 as well: whatever is mistaken costs at most 63 lost.
"""

_WIDTHS_BITS = (8, 16, 32)


class RunningNumber:
    """Follows one sensor's running number from frame to frame. Owned by one decoder.

    The width of the counter is not known: the narrowest of 8, 16 and 32 bits that has room for all
    numbers seen is taken. A number below the last one is a wrap when it lies within ``WRAP_REACH``
    behind the end of that width. One that begins again near 0 is a sensor that has started anew, or
    a counter of an odd width: both lose nothing. Anywhere else it is a jump.
    """

    def __init__(self) -> None:
        self._last: int | None = None
        self._highest = 0

    def follow(self, number: int) -> CounterGap | CounterJump | None:
        """Take the number of the newest frame; what is between it and the last one, if anything."""
        last, self._last = self._last, number
        self._highest = max(self._highest, number)
        if last is None:
            return None
        missed = number - last - 1 if number > last else self._missed_over_wrap(last, number)
        if missed is None or missed > MAX_MISSED:
            return CounterJump(last, number)
        return CounterGap(missed) if missed else None

    def is_repeat(self, number: int) -> bool:
        """Whether the frame before had this number too."""
        return number == self._last

    def _missed_over_wrap(self, last: int, number: int) -> int | None:
        """Frames missing from one number to a lower one; 0 for a restart, None for a jump."""
        width = next((bits for bits in _WIDTHS_BITS if self._highest < 1 << bits), None)
        step = WRAP_REACH + 1 if width is None else (1 << width) + number - last
        if step <= WRAP_REACH:
            return step - 1
        return 0 if number < WRAP_REACH else None
