"""The application's heartbeat as the guardian keeps it, and what follows from it. Pure."""

from enum import Enum

from gestureapp.robot.gate import AHEAD_S, Limits
from gestureapp.robot.messages import Beat
from gestureapp.robot.watchdog import Cause, find_left_end, find_stale, find_stall, next_look_s

DECIDING_S = 0.3
"""A decision follows the left arm's start within 160 ms; the line is kept free meanwhile."""
UNDECIDED_S = 0.03
"""No recogniser has its samples before this."""


class Patience(Enum):
    """After how many periods the supervised input is toggled, by what the line is wanted for."""

    BRIEF = 0.25
    """The left arm has just started: soon the line will be kept free."""
    USUAL = 1.0
    LONG = 1.5
    """A stop, a release or a decision is under way."""


class Beats:
    """Owned by the supervisor.

    Attributes:
        newest: The last one, or None.
    """

    def __init__(self, limits: Limits) -> None:
        self.newest: Beat | None = None
        self._limits = limits
        self._start_seen_s = float("-inf")
        self._watched_s = float("inf")
        self._stalled_s = 0.0

    @property
    def left_s(self) -> float:
        """Receive time of the newest left sample that counts."""
        return self.newest.left_s if self.newest else float("-inf")

    @property
    def is_left_start(self) -> bool:
        """The left arm holds the start posture."""
        return self.newest is not None and self.newest.is_left_start

    @property
    def is_left_stop(self) -> bool:
        """The left arm holds the stop posture."""
        return self.newest is not None and self.newest.is_left_stop

    def take(self, beat: Beat, now_s: float) -> None:
        """Another one has come."""
        if beat.is_left_start and not self.is_left_start:
            self._start_seen_s = now_s
        self.newest = beat

    def watched(self, now_s: float) -> None:
        """The clocks are looked at now; one that long was not looked at stood still."""
        self._stalled_s, self._watched_s = now_s - self._watched_s, now_s

    def is_deciding(self, now_s: float) -> bool:
        """The left arm has started so lately that a move may be asked for at any moment."""
        return now_s - self._start_seen_s < DECIDING_S

    def is_application_fresh(self, now_s: float) -> bool:
        """Control thread and window have run within their limits."""
        beat, limits = self.newest, self._limits
        if beat is None:
            return False
        ages = (
            (now_s - beat.control_s, limits.control_limit_s),
            (now_s - beat.gui_s, limits.gui_limit_s),
        )
        return all(-AHEAD_S <= age_s <= limit_s for age_s, limit_s in ages)

    def patience(self, now_s: float, *, is_busy: bool) -> Patience:
        """How long the next toggle of the supervised input may wait.

        Args:
            now_s: Monotonic clock.
            is_busy: A stop or a release is under way.
        """
        if is_busy:
            return Patience.LONG
        if not self.is_deciding(now_s):
            return Patience.USUAL
        is_undecided = now_s - self._start_seen_s < UNDECIDED_S
        return Patience.BRIEF if is_undecided else Patience.LONG

    def find_stale(self, now_s: float) -> Cause | None:
        """What is too old; nothing before the first."""
        if self.newest is None:
            return None
        stall = find_stall(self._stalled_s, self._limits)
        return stall or find_stale(self.newest, self._limits, now_s)

    def find_left_end(self, *, is_test: bool) -> Cause | None:
        """Whether the left arm ends a move, or a stop test's."""
        if self.newest is None:
            return None
        return find_left_end(self.newest, self._limits, is_test=is_test)

    def next_look_s(self, now_s: float, *, may_move: bool) -> float:
        """When to look at the clocks again, if nothing new comes."""
        return next_look_s(self.newest, self._limits, now_s, may_move=may_move)
