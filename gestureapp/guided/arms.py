"""Follows both arms for guided training: postures of the left, samples of the right, who is there.

Owned by one thread, which asks at every tick; reads what the readers keep, disturbs nobody.
"""

import math
from dataclasses import dataclass
from typing import Final, Protocol

import numpy as np

from gestureapp.config import Settings, SiteSettings
from gestureapp.guided.motion import tilt_of
from gestureapp.recognition.values import Recognition
from gestureapp.recording.take_values import AFTER_S, BEFORE_S, F64
from gestureapp.sensing.posture import LeftPostures, PostureDetector
from gestureapp.sensing.store import SampleStore
from gestureapp.sensing.values import ArmPosture, LinkState, Side, StreamHealth

LOST_AFTER_S: Final = 0.3
"""Silent for longer is lost; a shorter gap is a verdict on the take."""
BACK_AFTER_S: Final = 0.3
"""A sensor that sends again for this long is back."""
KEPT_S: Final = 4.0
"""So much of the right arm is kept: a take is cut from it within 1.1 s of its activation."""
TILT_SPAN_S: Final = 0.2
"""The level indicator shows the mean of this."""

Row = tuple[float, float, float, float]


class Health(Protocol):
    """What of a cell's picture matters here."""

    @property
    def left(self) -> StreamHealth:
        """Of the left stream."""

    @property
    def right(self) -> StreamHealth:
        """Of the right stream."""

    @property
    def recognition(self) -> Recognition | None:
        """What was heard last in operation."""

    @property
    def person(self) -> str:
        """Whose arms the model in use is for."""


class SensedCell(Protocol):
    """The part of a running cell that guided training reads; it asks nothing of the robot."""

    @property
    def settings(self) -> Settings:
        """In use now."""

    @property
    def postures(self) -> LeftPostures:
        """Of the left arm, in use now."""

    @property
    def left(self) -> SampleStore:
        """The left arm's newest samples."""

    @property
    def right(self) -> SampleStore:
        """The right arm's newest samples."""

    def snapshot(self) -> Health:
        """The newest picture."""


@dataclass(frozen=True, slots=True)
class News:
    """What came since the last tick.

    Attributes:
        postures: Changes of the left arm's posture with the receive time of their sample.
        right: New samples of the right arm, oldest first: receive time, then x, y, z in g.
        recognition: The cell's last one; it is the same until there is another.
        person: Whose arms the cell's model is for.
    """

    postures: tuple[tuple[float, ArmPosture], ...]
    right: tuple[Row, ...]
    recognition: Recognition | None = None
    person: str = ""


class Arms:
    """Both arms of a cell, followed from now on. Owned by one thread.

    Args:
        cell: Whose sensors.
    """

    def __init__(self, cell: SensedCell) -> None:
        self._cell = cell
        self._judged_by = (cell.settings.site, cell.postures)
        self._detector = _detector(*self._judged_by)
        self._counts = {Side.LEFT: cell.left.count, Side.RIGHT: cell.right.count}
        self._presence = {side: _Presence() for side in Side}
        self._rows = cell.right.tail(BEFORE_S)

    @property
    def posture(self) -> ArmPosture:
        """What the left arm says."""
        return self._detector.posture

    def lost(self, *, with_left: bool) -> Side | None:
        """A sensor that is silent; the left one only where it is needed."""
        if self._presence[Side.RIGHT].is_lost:
            return Side.RIGHT
        return Side.LEFT if with_left and self._presence[Side.LEFT].is_lost else None

    def step(self, now_s: float) -> News:
        """Read what has come."""
        picture = self._cell.snapshot()
        for side, health in ((Side.LEFT, picture.left), (Side.RIGHT, picture.right)):
            self._presence[side].note(now_s, is_there=health.link is LinkState.RECEIVING)
        postures = self._read_left(now_s)
        new = self._read(Side.RIGHT, self._cell.right)
        if len(new):
            rows = np.concatenate([self._rows, new])
            self._rows = rows[np.searchsorted(rows[:, 0], now_s - KEPT_S) :]
        right = tuple(_row(row) for row in new.tolist())
        return News(tuple(postures), right, picture.recognition, picture.person)

    def cut(self, activation_s: float) -> tuple[F64, F64]:
        """The samples of a take: times from its activation (k,), and (k, 3) in g."""
        times_s = self._rows[:, 0] - activation_s
        inside = (times_s >= -BEFORE_S) & (times_s < AFTER_S)
        return times_s[inside], self._rows[inside, 1:]

    def tilt_deg(self, now_s: float) -> float:
        """How far the right hand is from level now; NaN without fresh samples."""
        fresh = self._rows[self._rows[:, 0] > now_s - TILT_SPAN_S, 1:]
        return tilt_of(fresh) if len(fresh) else math.nan

    def _read_left(self, now_s: float) -> list[tuple[float, ArmPosture]]:
        changes: list[tuple[float, ArmPosture]] = []
        if (judged_by := (self._cell.settings.site, self._cell.postures)) != self._judged_by:
            self._judged_by, self._detector = judged_by, _detector(*judged_by)
            changes.append((now_s, ArmPosture.NEITHER))
        for t_s, x, y, z in self._read(Side.LEFT, self._cell.left).tolist():
            before = self._detector.posture
            posture = self._detector.feed((x, y, z))
            if posture is not before:
                changes.append((t_s, posture))
        if self._presence[Side.LEFT].is_lost and self.posture is not ArmPosture.NEITHER:
            self._detector.reset()
            changes.append((now_s, ArmPosture.NEITHER))
        return changes

    def _read(self, side: Side, store: SampleStore) -> F64:
        rows, self._counts[side] = store.since(self._counts[side])
        return rows


class _Presence:
    """Whether a sensor is there, without flutter: it is lost and back only after a while."""

    def __init__(self) -> None:
        self.is_lost = False
        self._since_s: float | None = None

    def note(self, now_s: float, *, is_there: bool) -> None:
        """What its health says now."""
        if is_there is not self.is_lost:
            self._since_s = None
            return
        if self._since_s is None:
            self._since_s = now_s
        limit_s = BACK_AFTER_S if is_there else LOST_AFTER_S
        if now_s - self._since_s >= limit_s:
            self.is_lost = not is_there
            self._since_s = None


def _detector(site: SiteSettings, postures: LeftPostures) -> PostureDetector:
    angles_deg = (site.posture_enter_deg, site.posture_leave_deg)
    return PostureDetector(*angles_deg, site.posture_debounce, postures)


def _row(values: list[float]) -> Row:
    t_s, x, y, z = values
    return t_s, x, y, z
