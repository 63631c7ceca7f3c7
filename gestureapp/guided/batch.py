"""One batch of takes: a count-in, then takes by rhythm or by the left arm, until enough are good.

Pure: the time and the left arm's postures come in, moments to take come out. A take holds the
samples from ``BEFORE_S`` before to ``AFTER_S`` after its *activation*. Hands-free that is the
moment at which the left arm is seen in its start posture, exactly as in operation. By rhythm it is
the beat itself: a person who follows a beat aims the onset of the movement at it, and hits it
within some tens of milliseconds either way, as the two arms do.
"""

import math
from typing import Final

from gestureapp.config import BEAT_RANGE_S
from gestureapp.guided.values import Pace, Phase
from gestureapp.recording.take_values import AFTER_S
from gestureapp.sensing.values import ArmPosture, Side

COUNT_IN_S: Final = 3.0
"""3, 2, 1: one second each."""
SETTLE_S: Final = 0.08
"""A take is cut so long after its end: the radio's last samples are there by then."""
LATE_S: Final = 0.05
"""A beat that comes later than this is missed; the next one comes at its own time."""


class Batch:
    """A batch under way. Owned by one thread; knows no clock.

    Args:
        pace: What begins a take.
        beat_s: Time between two beats; brought into the range allowed.
        size: Good takes that end the batch.
        now_s: The count-in begins now.
        posture: The left arm's now.

    Attributes:
        pace: As given.
        beat_s: As used.
        size: As given.
        phase: Where it stands; IDLE when it is over.
        activation_s: Of the take in progress or the last one; minus infinity before.
        next_beat_s: When the next beat is due; infinite without one.
        lost: Which sensor is missing, or None.
        is_left_rested: The left arm has been in the stop posture since the last start.
        n_missed: Beats that came too late to be shown.
    """

    def __init__(
        self, pace: Pace, beat_s: float, size: int, now_s: float, posture: ArmPosture
    ) -> None:
        self.pace = pace
        self.beat_s = min(max(beat_s, BEAT_RANGE_S[0]), BEAT_RANGE_S[1])
        self.size = size
        self.phase = Phase.COUNT_IN
        self.activation_s = -math.inf
        self.next_beat_s = math.inf
        self.lost: Side | None = None
        self.is_left_rested = posture is ArmPosture.STOP
        self.n_missed = 0
        self._go_s = now_s
        self._count_in(now_s)

    @property
    def is_over(self) -> bool:
        """Nothing more is taken."""
        return self.phase is Phase.IDLE

    def count_in(self, now_s: float) -> int:
        """3, 2, 1 while counting in, else 0."""
        if self.phase is not Phase.COUNT_IN:
            return 0
        return min(3, max(1, math.ceil(self._go_s - now_s)))

    def left(self, t_s: float, posture: ArmPosture) -> None:
        """The left arm's posture has changed, by the sample received at ``t_s``."""
        if posture is ArmPosture.STOP:
            self.is_left_rested = True
        elif posture is ArmPosture.START and self.is_left_rested:
            self.is_left_rested = False
            if self.phase is Phase.WAITING and self.pace is Pace.HANDS_FREE:
                self._begin(t_s)

    def tick(self, now_s: float, lost: Side | None) -> float | None:
        """Let time pass.

        Args:
            now_s: Monotonic; after every posture up to now was told.
            lost: A sensor that is needed and silent, or None.

        Returns:
            The activation of a take that is complete and to be judged now, or None.
        """
        if self.phase in (Phase.IDLE, Phase.PAUSED):
            return None
        if lost is not None:
            self._lose(lost)
            return None
        if self.phase is Phase.SENSOR_LOST:
            self._count_in(now_s)
        if self.phase is Phase.COUNT_IN and now_s >= self._go_s:
            self.phase = Phase.WAITING
        if self.phase is Phase.WAITING:
            self._beat(now_s)
        if self.phase is Phase.TAKING and now_s >= self.activation_s + AFTER_S + SETTLE_S:
            self.phase = Phase.WAITING
            return self.activation_s
        return None

    def judged(self, n_good: int) -> None:
        """So many takes of this batch are good now; enough of them end it."""
        if n_good >= self.size:
            self.end()

    def pause(self) -> None:
        """Hold it; a take in progress is dropped."""
        if not self.is_over:
            self.phase = Phase.PAUSED
            self.next_beat_s = math.inf

    def go_on(self, now_s: float) -> None:
        """Count in again after a pause."""
        if self.phase is Phase.PAUSED:
            self._count_in(now_s)

    def end(self) -> None:
        """No take more; one in progress is dropped."""
        self.phase = Phase.IDLE
        self.next_beat_s = math.inf

    def _count_in(self, now_s: float) -> None:
        self.phase = Phase.COUNT_IN
        self.lost = None
        self._go_s = now_s + COUNT_IN_S
        self.next_beat_s = self._go_s if self.pace is Pace.RHYTHM else math.inf

    def _begin(self, activation_s: float) -> None:
        self.phase = Phase.TAKING
        self.activation_s = activation_s

    def _beat(self, now_s: float) -> None:
        """Begin a take with the beat that is due; those that were missed are passed over."""
        while self.next_beat_s < now_s - LATE_S:
            self.next_beat_s += self.beat_s
            self.n_missed += 1
        if self.next_beat_s <= now_s:
            self._begin(self.next_beat_s)
            self.next_beat_s += self.beat_s

    def _lose(self, lost: Side) -> None:
        self.phase = Phase.SENSOR_LOST
        self.lost = lost
        self.next_beat_s = math.inf
        if lost is Side.LEFT:
            self.is_left_rested = False
