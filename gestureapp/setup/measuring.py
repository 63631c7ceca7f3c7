"""What measures a sensor or an arm, one thing at a time: link, six positions, level, postures."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Final

from gestureapp.cell.controls import CellControls
from gestureapp.errors import RecordingError
from gestureapp.recording.person_profile import PersonProfile, load_profile, save_profile
from gestureapp.sensing.calibration import NOMINAL
from gestureapp.sensing.values import Side, StreamHealth
from gestureapp.setup.arm_sensor import ArmSensor
from gestureapp.setup.feed import F64, Feed
from gestureapp.setup.level import LevelCheck
from gestureapp.setup.link_test import LinkTest
from gestureapp.setup.postures import PostureRecorder
from gestureapp.setup.shake import Shake
from gestureapp.setup.six_positions import SixPositions
from gestureapp.setup.values import (
    CalibrationView,
    Check,
    LevelView,
    LinkTestView,
    Outcome,
    PosturesView,
    ShakeView,
)

ANOTHER: Final = "Another sensor answers there now; nothing is kept. Begin anew."
SETTLED_S: Final = 0.1
"""Samples that the reader had corrected before another calibration are through by then."""


class Measuring:
    """Drives what is under way; begins one thing by ending the other. Owned by the setup thread.

    Args:
        cell: Whose sensors.
        arms: Each arm's sensor.
        data: The data folder.
        on_shaken: Told once which sensor was shaken, as they are assigned now.
        on_postures: Told once a person's postures have changed.
    """

    def __init__(
        self,
        cell: CellControls,
        arms: dict[Side, ArmSensor],
        data: Path,
        on_shaken: Callable[[Side], None],
        on_postures: Callable[[], None],
    ) -> None:
        self._cell, self._arms, self._data = cell, arms, data
        self._on_shaken, self._on_postures = on_shaken, on_postures
        self._feeds = {Side.LEFT: Feed(cell.left), Side.RIGHT: Feed(cell.right)}
        self._shake: Shake | None = None
        self._link: LinkTest | None = None
        self._positions: SixPositions | None = None
        self._level: LevelCheck | None = None
        self._postures: PostureRecorder | None = None
        self._who = ""
        self.shake, self.link_test = ShakeView(), LinkTestView()
        self.calibration, self.level, self.postures = CalibrationView(), LevelView(), PosturesView()

    @property
    def is_on(self) -> bool:
        """Something is measured: every tick counts."""
        parts = (self._shake, self._link, self._positions, self._level, self._postures)
        return any(part is not None for part in parts)

    def step(self, now_s: float, wall_s: float, health: dict[Side, StreamHealth]) -> None:
        """Hand the new samples to what is under way, and keep what has come of it."""
        rows = {side: feed.rows() for side, feed in self._feeds.items()}
        self._step_shake(now_s, rows)
        self._step_link(now_s, wall_s, rows, health)
        self._step_positions(now_s, wall_s, rows)
        self._step_level(now_s, wall_s, rows)
        self._step_postures(now_s, wall_s, rows)

    def end(self) -> None:
        """End whatever is under way; nothing of it is kept."""
        self.end_shake()
        self.end_link_test()
        self.end_calibration()
        self.end_postures()
        if self._level is not None:
            self._level, self.level = None, LevelView(side=self.level.side)

    # Beginning and ending.

    def begin_shake(self, now_s: float, arm: str = "left") -> None:
        """Ask for the sensor that starts and stops to be shaken, which is worn on this arm."""
        self.end()
        self._shake = Shake(now_s, arm)
        self.shake = self._shake.view

    def refuse_shake(self, why: str) -> None:
        """Say why it cannot be begun."""
        self.shake = ShakeView(sentence=why)

    def end_shake(self) -> None:
        """End it; nothing changes."""
        if self._shake is not None:
            self._shake, self.shake = None, ShakeView()

    def begin_link_test(self, side: Side, now_s: float, health: StreamHealth) -> None:
        """Measure this arm's link."""
        self.end()
        self._link = LinkTest(side, now_s, health, self._cell.settings.site.trip_level_s)
        self._who = self._arms[side].known.id
        self.link_test = self._link.view

    def end_link_test(self) -> None:
        """End it before its time; nothing is kept."""
        if self._link is not None:
            self._link.end()
            self.link_test, self._link = self._link.view, None

    def begin_calibration(self, side: Side, now_s: float) -> None:
        """Ask for the six positions; until the end the samples come as the protocol gives them."""
        self.end()
        self._positions = SixPositions(side)
        self._who = self._arms[side].known.id
        self._arms[side].raw = NOMINAL
        self._feeds[side].skip_until(now_s + SETTLED_S)
        self.calibration = self._positions.view

    def end_calibration(self) -> None:
        """End it before its time; the calibration there was stays."""
        if self._positions is None or self.calibration.side is None:
            return
        self._arms[self.calibration.side].raw = None
        self._positions = None
        self.calibration = replace(
            self.calibration, is_on=False, sentence="Ended; nothing is kept."
        )

    def begin_level_check(self, side: Side) -> None:
        """Check that it reads level where it lies."""
        self.end()
        arm = self._arms[side]
        if not arm.record.is_calibrated:
            text = "Not calibrated: take the six positions first."
            self.level = LevelView(side=side, outcome=Outcome(Check.FAILED, text))
            return
        self._level, self._who = LevelCheck(side, arm.record), arm.known.id
        self.level = self._level.view

    def begin_postures(self, person: str, arm: str = "left") -> None:
        """Record stop, then start posture of the chosen person, who wears the sensor there."""
        self.end()
        if not person:
            text = "Nobody is chosen: choose a person first."
            self.postures = PosturesView(sentence=text, outcome=Outcome(Check.FAILED, text))
            return
        self._postures = PostureRecorder(person, self._cell.settings.site, arm)
        self._who = self._arms[Side.LEFT].known.id
        self.postures = self._postures.view

    def end_postures(self) -> None:
        """End it before its time; what there was stays."""
        if self._postures is not None:
            self._postures = None
            self._on_postures()

    # One tick of each.

    def _step_shake(self, now_s: float, rows: dict[Side, F64]) -> None:
        shake = self._shake
        if shake is None:
            return
        shake.step(now_s, rows[Side.LEFT], rows[Side.RIGHT])
        self.shake = shake.view
        if not shake.view.is_on:
            self._shake = None
            if shake.shaken is not None:
                self._on_shaken(shake.shaken)

    def _step_link(
        self,
        now_s: float,
        wall_s: float,
        rows: dict[Side, F64],
        health: dict[Side, StreamHealth],
    ) -> None:
        test = self._link
        side = self.link_test.side
        if test is None or side is None:
            return
        if self._is_another(side):
            self._link = None
            self.link_test = replace(self.link_test, outcome=Outcome(Check.FAILED, ANOTHER, wall_s))
            return
        test.step(now_s, wall_s, rows[side], health[side])
        self.link_test = test.view
        if test.is_on:
            return
        self._link = None
        if test.view.lowest_trip_s == test.view.lowest_trip_s:  # NaN: no data came
            arm = self._arms[side]
            outcome = self._kept(test.view.outcome, lambda: arm.keep(arm.with_link(test.view)))
            self.link_test = replace(test.view, outcome=outcome)

    def _step_positions(self, now_s: float, wall_s: float, rows: dict[Side, F64]) -> None:
        positions, side = self._positions, self.calibration.side
        if positions is None or side is None:
            return
        if self._is_another(side):
            self.end_calibration()
            self.calibration = replace(
                self.calibration, sentence=ANOTHER, outcome=Outcome(Check.FAILED, ANOTHER, wall_s)
            )
            return
        positions.step(now_s, rows[side])
        self.calibration = positions.view
        if positions.view.is_on:
            return
        self._positions = None
        arm = self._arms[side]
        arm.raw = None
        outcome = replace(positions.view.outcome, wall_s=wall_s)
        if outcome.check is Check.PASSED:
            outcome = self._kept(outcome, lambda: arm.keep(positions.record(arm.record, wall_s)))
        self.calibration = replace(positions.view, outcome=outcome)

    def _step_level(self, now_s: float, wall_s: float, rows: dict[Side, F64]) -> None:
        level, side = self._level, self.level.side
        if level is None or side is None:
            return
        if self._is_another(side):
            self._level = None
            self.level = replace(self.level, outcome=Outcome(Check.FAILED, ANOTHER, wall_s))
            return
        level.step(now_s, rows[side])
        self.level = level.view
        if level.is_on:
            return
        self._level = None
        arm = self._arms[side]
        outcome = replace(level.view.outcome, wall_s=wall_s)
        outcome = self._kept(outcome, lambda: arm.keep(level.record(wall_s)))
        self.level = replace(level.view, outcome=outcome)

    def _step_postures(self, now_s: float, wall_s: float, rows: dict[Side, F64]) -> None:
        recorder = self._postures
        if recorder is None:
            return
        if self._is_another(Side.LEFT):
            self._postures = None
            outcome = Outcome(Check.FAILED, ANOTHER, wall_s)
            self.postures = replace(self.postures, is_on=False, sentence=ANOTHER, outcome=outcome)
            return
        recorder.step(now_s, rows[Side.LEFT])
        self.postures = recorder.view
        if recorder.view.is_on:
            return
        self._postures = None
        outcome = replace(recorder.view.outcome, wall_s=wall_s)
        if recorder.postures is not None:
            outcome = self._kept(outcome, lambda: self._keep_postures(recorder, wall_s))
        self.postures = replace(recorder.view, outcome=outcome, wall_s=wall_s)
        self._on_postures()

    def _is_another(self, side: Side) -> bool:
        """What has been measured so far was measured of another sensor."""
        return self._arms[side].known.id != self._who

    def _keep_postures(self, recorder: PostureRecorder, wall_s: float) -> None:
        person = recorder.view.person
        profile: PersonProfile
        profile, trouble = load_profile(self._data, person)
        kept = replace(profile, postures=recorder.postures, recorded_wall_s=wall_s)
        save_profile(self._data, person, kept)
        if trouble:
            self._cell.tell(
                f"{trouble}: set aside; the postures are new, note the handedness again"
            )

    @staticmethod
    def _kept(outcome: Outcome, keep: Callable[[], None]) -> Outcome:
        try:
            keep()
        except RecordingError as error:
            return replace(outcome, check=Check.FAILED, text=f"failed, not kept: {error}")
        return outcome
