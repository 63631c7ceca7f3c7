"""The level check: 2 s on something level, and a small correction of what the sensor reads. Pure.

It needs a surface that is level: what it cannot tell from a sensor that has changed is a table that
leans. So it corrects little, and always from the calibration of the six positions: checks day after
day do not add up.
"""

import math
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from gestureapp.recording.sensor_records import LevelRecord, SensorRecord
from gestureapp.sensing.calibration import Calibration, Vector
from gestureapp.sensing.values import Side
from gestureapp.setup.stillness import Still, Stillness
from gestureapp.setup.values import Check, LevelView, Outcome

F64 = NDArray[np.float64]

HOLD_S: Final = 2.0
STILL_WITHIN_G: Final = 0.03
LIMIT_DEG: Final = 3.0
"""A table that leans more is seen to lean; 10 K move a zeroed ADXL330 by 0.6 degrees an axis."""
LIMIT_MG: Final = 40.0
"""1 mg/K of offset and 0.015 %/K of gain (data sheet): 20 K make some 25 mg."""
GIVE_UP_S: Final = 20.0
"""It ends by itself: nobody waits for a sensor that is never still."""


class LevelCheck:
    """One level check of one sensor. Owned by one thread.

    Args:
        side: Whose sensor it is.
        record: What is kept of it; what it reads is corrected with ``record.used``.
    """

    def __init__(self, side: Side, record: SensorRecord) -> None:
        self._record = record
        self._stillness = Stillness(HOLD_S, STILL_WITHIN_G)
        self._began_s = math.nan
        self._found: LevelRecord | None = None
        text = "Lay the sensor on something level, its Z arrow up, and let go."
        self._view = LevelView(side=side, outcome=Outcome(Check.RUNNING, text))

    @property
    def view(self) -> LevelView:
        """What the window shows; the outcome's date is the caller's to set."""
        return self._view

    @property
    def is_on(self) -> bool:
        """It is under way."""
        return self._view.outcome.check is Check.RUNNING

    def record(self, wall_s: float) -> SensorRecord:
        """What is to be kept of the sensor now, whether it passed or not.

        Unchanged when nothing was found: the sensor sent nothing, or never lay still.
        """
        if self._found is None:
            return self._record
        return replace(self._record, level=replace(self._found, wall_s=wall_s))

    def step(self, now_s: float, rows: F64) -> None:
        """Take new samples.

        Args:
            now_s: Monotonic clock.
            rows: Shape (n, 4): t_s, x, y, z in g as corrected with ``record.used``, oldest first;
                may be empty, and may begin with samples that were handed in before.
        """
        if not self.is_on:
            return
        if math.isnan(self._began_s):
            self._began_s = now_s
        still = self._stillness.step(now_s, rows)
        if still is not None and not still.is_frozen:
            self._judge(still)
        elif now_s - self._began_s >= GIVE_UP_S:
            self._end(Check.FAILED, self._why_nothing(still))
        else:
            self._view = replace(self._view, progress=self._stillness.progress)

    def _judge(self, still: Still) -> None:
        base = self._record.calibration
        read = base.applied(_nominal(still.mean_g, self._record.used))
        off_deg, off_mg = off_level(read)
        problem = level_problem(off_deg, off_mg)
        used = base if problem else leveled(base, read)
        self._found = LevelRecord(0.0, not problem, off_deg, off_mg, used)
        self._view = replace(self._view, progress=1.0, off_deg=off_deg, off_mg=off_mg)
        if problem:
            self._end(Check.FAILED, problem)
            return
        text = f"Level: {off_deg:.1f} degrees and {off_mg:+.0f} mg off, taken out from now on."
        self._end(Check.PASSED, text)

    def _why_nothing(self, still: Still | None) -> str:
        if self._stillness.is_silent:
            return "No samples came from the sensor: switch it on, or see Sensors; then check anew."
        so_far = still if still is not None else self._stillness.so_far
        if so_far is not None and so_far.is_frozen:
            return "The readings do not change at all: the sensor is frozen. Restart it."
        return "It never lay still for 2 s: lay it down, let go, and check anew."

    def _end(self, check: Check, text: str) -> None:
        self._view = replace(self._view, outcome=Outcome(check, text))


def off_level(read_g: Vector) -> tuple[float, float]:
    """How far a reading is from (0, 0, 1): degrees of direction, and mg of length."""
    magnitude_g = math.hypot(*read_g)
    cosine = read_g[2] / magnitude_g if magnitude_g > 0.0 else -1.0
    return math.degrees(math.acos(max(-1.0, min(1.0, cosine)))), (magnitude_g - 1.0) * 1000.0


def level_problem(off_deg: float, off_mg: float) -> str:
    """Why a level check has not passed, with the remedy; empty when it has."""
    if not off_deg <= LIMIT_DEG:
        return (
            f"{off_deg:.1f} degrees off level, {LIMIT_DEG:g} are allowed: lay it on a level table; "
            "if it lies well, calibrate anew."
        )
    if not abs(off_mg) <= LIMIT_MG:
        return (
            f"{off_mg:+.0f} mg off 1 g, {LIMIT_MG:g} are allowed: hold it still; if it lay still, "
            "calibrate anew."
        )
    return ""


def leveled(base: Calibration, read_g: Vector) -> Calibration:
    """The calibration with which this reading becomes (0, 0, 1).

    The smallest turn that brings it upright (Rodrigues' formula about the axis across both), then
    the scale to 1 g. What lies along the vertical axis of the turn, the heading, is left alone.

    Args:
        base: What the reading was corrected with.
        read_g: Not zero, and not pointing straight down.
    """
    read = np.array(read_g)
    magnitude_g = float(np.linalg.norm(read))
    x, y, z = read / magnitude_g
    # v = u x z, c = u . z;  turn = 1 + [v] + [v]^2 / (1 + c)
    cross = np.array([[0.0, 0.0, -x], [0.0, 0.0, -y], [x, y, 0.0]])
    turn = np.eye(3) + cross + cross @ cross / (1.0 + z)
    rows = (turn / magnitude_g @ np.array(base.matrix)).tolist()
    return Calibration(base.offset_g, (tuple(rows[0]), tuple(rows[1]), tuple(rows[2])))


def _nominal(read_g: Vector, used: Calibration) -> Vector:
    """What the sensor itself said: the calibration taken back."""
    x, y, z = np.linalg.solve(np.array(used.matrix), np.array(read_g)) + np.array(used.offset_g)
    return float(x), float(y), float(z)
