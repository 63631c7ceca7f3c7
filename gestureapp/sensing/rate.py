"""Rate, jitter and worst gap of a stream over sliding spans, cheap per sample. Pure."""

import math
from collections import deque

RATE_SPAN_S = 2.0
"""Long enough that the bursts of a radio even out, short enough to see a change."""

GAP_SPAN_S = 60.0
"""The worst of a minute tells whether the trip level can be held."""

_MAX_TIMES = 4096
"""2 kHz over the span; a faster stream is far outside any site's limits anyway."""


class RateMeter:
    """Counts what came within the last ``RATE_SPAN_S``. Amortised O(1). Owned by one thread.

    What a radio gives in one burst, received at one time, is one arrival.
    """

    def __init__(self) -> None:
        self._times: deque[float] = deque()
        self._n_arrivals = 0  # different times in the deque
        self._sum_squares_s2 = 0.0  # of the times between them
        self._first_s: float | None = None

    def restart(self) -> None:
        """Measure from the next sample on, as after a new connection."""
        self._times.clear()
        self._n_arrivals = 0
        self._sum_squares_s2 = 0.0
        self._first_s = None

    def add(self, t_s: float) -> None:
        """A sample was received at ``t_s``; times must not decrease."""
        if self._first_s is None:
            self._first_s = t_s
        if not self._times or t_s > self._times[-1]:
            self._n_arrivals += 1
        if self._times:
            self._sum_squares_s2 += (t_s - self._times[-1]) ** 2
        self._times.append(t_s)
        self._forget(t_s)

    def is_measured(self, now_s: float) -> bool:
        """Whether a full span has passed since the first sample."""
        return self._first_s is not None and now_s - self._first_s >= RATE_SPAN_S

    def rate_hz(self, now_s: float) -> float:
        """Samples per second over the last span; 0 until a full span has passed."""
        if not self.is_measured(now_s):
            return 0.0
        self._forget(now_s)
        return len(self._times) / RATE_SPAN_S

    def jitter_s(self, now_s: float) -> float:
        """Standard deviation of the times between arrivals of the last span; 0 while unknown."""
        if not self.is_measured(now_s):
            return 0.0
        self._forget(now_s)
        n = self._n_arrivals - 1
        if n < 2:
            return 0.0
        mean_s = (self._times[-1] - self._times[0]) / n
        return math.sqrt(max(0.0, self._sum_squares_s2 / n - mean_s**2))

    def _forget(self, now_s: float) -> None:
        times = self._times
        while times and (times[0] <= now_s - RATE_SPAN_S or len(times) > _MAX_TIMES):
            gone_s = times.popleft()
            if not times or times[0] > gone_s:
                self._n_arrivals -= 1
            if times:
                self._sum_squares_s2 -= (times[0] - gone_s) ** 2
        if len(times) < 2:
            self._sum_squares_s2 = 0.0  # rounding does not pile up


class WorstGap:
    """The longest time between neighbours that ended within ``GAP_SPAN_S``. Owned by one thread.

    Keeps only gaps that can still become the worst, largest first: amortised O(1) per sample.
    """

    def __init__(self) -> None:
        self._last_s: float | None = None
        self._gaps: deque[tuple[float, float]] = deque()

    def add(self, t_s: float) -> None:
        """A sample was received at ``t_s``; times must not decrease."""
        last_s, self._last_s = self._last_s, t_s
        if last_s is None or t_s <= last_s:
            return
        gap_s = t_s - last_s
        while self._gaps and self._gaps[-1][1] <= gap_s:
            self._gaps.pop()
        self._gaps.append((t_s, gap_s))
        self._forget(t_s)

    def worst_s(self, now_s: float) -> float:
        """The longest gap of the span before ``now_s``; 0 when there is none."""
        self._forget(now_s)
        return self._gaps[0][1] if self._gaps else 0.0

    def _forget(self, now_s: float) -> None:
        while self._gaps and self._gaps[0][0] <= now_s - GAP_SPAN_S:
            self._gaps.popleft()
