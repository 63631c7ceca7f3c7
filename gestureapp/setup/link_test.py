"""The link test: how regularly a sensor's data come, and what trip level that can carry. Pure."""

import math
from dataclasses import replace
from itertools import pairwise
from typing import Final

import numpy as np
from numpy.typing import NDArray

from gestureapp.config import SiteSettings
from gestureapp.sensing.values import LinkState, Side, StreamHealth
from gestureapp.settings_check import RANGES
from gestureapp.setup.values import Check, LinkTestView, Outcome

F64 = NDArray[np.float64]

TOTAL_S: Final = 30.0
RESERVE_S: Final = 0.02
"""Above the worst gap seen: half a minute does not show the worst of a shift. Two frames' time."""
TRIP_RANGE: Final = RANGES[SiteSettings, "trip_level_s"]
STEP_S: Final = 0.01
"""A level is rounded up to this; up to ten microseconds more count as nothing."""
CLASSES_S: Final = (0.004, 0.008, 0.012, 0.018, 0.025, 0.035, 0.05, 0.075, 0.1, 0.2, math.inf)
"""Upper ends of the histogram's classes: fine around 100 Hz, coarse where gaps begin to hurt.
None is a multiple of the usual 10 ms: these would fall to either side by chance."""


def lowest_trip_s(worst_gap_s: float) -> float:
    """The lowest trip level that a link carries whose longest time between two arrivals is this."""
    steps = math.ceil((worst_gap_s + RESERVE_S) / STEP_S - 1e-3)
    return max(round(steps * STEP_S, 6), TRIP_RANGE.low)


def carries(lowest_s: float, set_s: float) -> bool:
    """Whether a link with this lowest trip level carries the one that is set."""
    return lowest_s <= set_s + 1e-9


def link_problem(lowest_s: float, set_s: float) -> tuple[str, str]:
    """Why a tested link must not be armed with, and the remedy; empty when it carries the level.

    Args:
        lowest_s: What the link test found; NaN when the link was not tested.
        set_s: The trip level that is set.
    """
    if math.isnan(lowest_s) or carries(lowest_s, set_s):
        return "", ""
    problem = f"link carries {_ms(lowest_s)} at best, trip level is {_ms(set_s)}"
    raised = f"set the trip level to {_ms(lowest_s)} or more, or "
    mend = "mend the link (closer, charged, other radio) and test it again"
    return problem, (raised if lowest_s <= TRIP_RANGE.high else "") + mend


class LinkTest:
    """Follows one stream for ``TOTAL_S``. Owned by one thread.

    Times between *arrivals*: samples of one read came together, and count as one.

    Args:
        side: Whose.
        now_s: When it begins.
        health: Of the stream at that time, for the counters.
        set_trip_s: The trip level that is set.

    Attributes:
        view: For the window.
    """

    def __init__(
        self,
        side: Side,
        now_s: float,
        health: StreamHealth,
        set_trip_s: float,
    ) -> None:
        self._began_s = now_s
        self._n_lost, self._n_bad = health.n_lost, health.n_bad
        self._arrivals: list[float] = [now_s]
        self._n_samples = 0
        self._has_broken = False
        self.view = LinkTestView(
            side=side, outcome=Outcome(Check.RUNNING), total_s=TOTAL_S, set_trip_s=set_trip_s
        )

    @property
    def is_on(self) -> bool:
        """It is under way."""
        return self.view.outcome.check is Check.RUNNING

    def step(self, now_s: float, wall_s: float, rows: F64, health: StreamHealth) -> None:
        """Take the new samples, rows of t, x, y, z, and the stream's counters."""
        if not self.is_on:
            return
        for t_s in rows[:, 0].tolist():
            if t_s > self._arrivals[-1]:
                self._arrivals.append(t_s)
            self._n_samples += t_s >= self._began_s
        self._has_broken |= health.link is LinkState.NOT_CONNECTED
        elapsed_s = min(now_s - self._began_s, TOTAL_S)
        self.view = replace(self._measured(now_s, health), elapsed_s=elapsed_s)
        if now_s - self._began_s >= TOTAL_S:
            self._finish(wall_s)

    def end(self) -> None:
        """End it before its time; nothing was found."""
        if self.is_on:
            self.view = replace(self.view, outcome=Outcome())

    def _measured(self, now_s: float, health: StreamHealth) -> LinkTestView:
        gaps = np.diff(self._arrivals) if len(self._arrivals) > 1 else np.zeros(0)
        ends = [*self._arrivals, max(now_s, self._arrivals[-1])]
        worst_s = max((later - sooner for sooner, later in pairwise(ends)), default=0.0)
        elapsed_s = max(now_s - self._began_s, 1e-9)
        return replace(
            self.view,
            rate_hz=self._n_samples / elapsed_s,
            jitter_s=float(np.std(gaps)) if len(gaps) else 0.0,
            worst_gap_s=worst_s,
            n_lost=health.n_lost - self._n_lost,
            n_bad=health.n_bad - self._n_bad,
            histogram=histogram(gaps),
        )

    def _finish(self, wall_s: float) -> None:
        view = self.view
        if self._n_samples == 0:
            text = "failed because no data came: see what the card advises"
            self._close(Check.FAILED, text, wall_s, math.nan)
            return
        lowest_s = lowest_trip_s(view.worst_gap_s)
        figures = f"worst gap {_ms(view.worst_gap_s)}, {_ms(RESERVE_S)} in reserve"
        if self._has_broken:
            figures += ", the connection broke"
        problem, remedy = link_problem(lowest_s, view.set_trip_s)
        if problem:
            text = f"failed because the {problem} ({figures}): {remedy}"
            self._close(Check.FAILED, text, wall_s, lowest_s)
        else:
            text = f"passed: carries {_ms(lowest_s)} ({figures}); {_ms(view.set_trip_s)} is set"
            self._close(Check.PASSED, text, wall_s, lowest_s)

    def _close(self, check: Check, text: str, wall_s: float, lowest_s: float) -> None:
        self.view = replace(self.view, outcome=Outcome(check, text, wall_s), lowest_trip_s=lowest_s)


def histogram(gaps_s: F64) -> tuple[tuple[float, int], ...]:
    """How many gaps fall into each class: its upper end in s, which belongs to it, and how many."""
    places = np.searchsorted(CLASSES_S, gaps_s, side="left")
    counts = np.bincount(places, minlength=len(CLASSES_S))
    return tuple(zip(CLASSES_S, counts.tolist(), strict=True))


def _ms(span_s: float) -> str:
    return f"{span_s * 1000:.0f} ms"
