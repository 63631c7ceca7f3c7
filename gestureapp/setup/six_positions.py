"""The six positions of a calibration, taken one after the other from what the sensor reads. Pure.

Which position it lies in is told by the axis that points up, so any order will do. Nothing has to
be pressed: a position is taken when the sensor has lain still for ``HOLD_S``.
"""

import math
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from gestureapp.recording.sensor_records import SensorRecord
from gestureapp.sensing.values import Side
from gestureapp.setup.fit import UP, Fit, fit_calibration, words_of
from gestureapp.setup.stillness import Still, Stillness
from gestureapp.setup.stuck import AxisSpans, clipped_axis, shaky_position
from gestureapp.setup.values import (
    CalibrationView,
    Check,
    Outcome,
    Position,
    PositionState,
    PositionView,
)

F64 = NDArray[np.float64]

HOLD_S: Final = 1.5
STILL_WITHIN_G: Final = 0.03
"""An ADXL330 behind a 10-bit converter lies within 0.02 g of its mean; a hand does not."""
TILT_LIMIT_DEG: Final = 20.0
"""A sensor with 0.3 g of offset reads 17 degrees when it lies well."""
MAGNITUDE_G: Final = (0.5, 1.6)
"""Outside, no sensor that could be calibrated reads gravity."""
NOISE_LIMIT_G: Final = 0.012
"""Four times what an ADXL330 has in 50 Hz."""
UNMOVED_S: Final = 20.0
"""Lying as it lay for this long, one asks whether it is the sensor that is frozen."""
LOST_S: Final = 0.5
"""A movement after so much stillness is told; before that, somebody is still turning it."""
RESTLESS_S: Final = 8.0
"""Never still for this long, though it points one way: noise, or a table that shakes."""

_LAY: Final = {
    Position.Z_UP: "Lay the sensor flat, its Z arrow up, and let go",
    Position.Z_DOWN: "Turn it over, its Z arrow down, and let go",
    Position.X_UP: "Stand it up, its X arrow up, and let go",
    Position.X_DOWN: "Stand it on its other end, its X arrow down, and let go",
    Position.Y_UP: "Lay it on its side, its Y arrow up, and let go",
    Position.Y_DOWN: "Lay it on its other side, its Y arrow down, and let go",
}


class SixPositions:
    """Asks for the six positions, takes them, and fits the calibration. Owned by one thread.

    The rows are of the nominal scale: as the protocol gives them, without any calibration.

    Args:
        side: Whose sensor it is.
    """

    def __init__(self, side: Side) -> None:
        self._stillness = Stillness(HOLD_S, STILL_WITHIN_G)
        self._taken: dict[Position, Still] = {}
        self._doubted: set[Position] = set()
        self._spans = AxisSpans()
        self._told = ""
        self._is_refused = False
        self._lain: Position | None = None
        self._lain_s = math.nan
        self._restless_s = math.nan
        self._now_s = math.nan
        self._fit: Fit | None = None
        self._view = CalibrationView(side=side, is_on=True)
        self._view = self._shown()

    @property
    def view(self) -> CalibrationView:
        """What the window shows; the outcome's date is the caller's to set."""
        return self._view

    @property
    def fit(self) -> Fit | None:
        """What came of it; None before the end."""
        return self._fit

    def record(self, before: SensorRecord, wall_s: float) -> SensorRecord:
        """What is to be kept after it has passed: this calibration, and no level check yet.

        Args:
            before: What was kept of the sensor.
            wall_s: Now, seconds since the epoch.

        Raises:
            ValueError: it has not passed.
        """
        if self._fit is None or not self._fit.is_good:
            raise ValueError("no calibration came of it")
        fit = self._fit
        return replace(
            before,
            calibration=fit.calibration,
            calibrated_wall_s=wall_s,
            before_mg=fit.before_mg,
            after_mg=fit.after_mg,
            worst_mg=fit.worst_mg,
            verdict=fit.verdict,
            level=None,
        )

    def step(self, now_s: float, rows: F64) -> None:
        """Take new samples.

        Args:
            now_s: Monotonic clock.
            rows: Shape (n, 4): t_s, x, y, z in g of the nominal scale, oldest first; may be empty,
                and may begin with samples that were handed in before.
        """
        if not self._view.is_on:
            return
        self._now_s = now_s
        self._spans.take(rows)
        still = self._stillness.step(now_s, rows)
        if still is not None:
            self._take(still)
        self._tell(still)
        self._doubt()
        if len(self._taken) == len(Position):
            self._finish()
        else:
            self._view = self._shown()

    def _take(self, still: Still) -> None:
        """Take a position, or say why not."""
        position, problem = self._read(still)
        self._is_refused = bool(problem)
        if position is None or problem:
            self._told = problem
            return
        if position is self._lain:
            return
        is_new = position not in self._taken
        self._told = f"{words_of(position)} {'is done' if is_new else 'was taken already'}."
        self._taken.setdefault(position, still)
        self._lain, self._lain_s = position, self._now_s

    def _read(self, still: Still) -> tuple[Position | None, str]:
        """Which position it is, and what is wrong with it in words."""
        if still.is_frozen:
            return None, "The readings do not change at all: the sensor is frozen. Restart it."
        low, high = MAGNITUDE_G
        position, off_deg = nearest(still)
        is_odd = not low <= still.magnitude_g <= high or off_deg > TILT_LIMIT_DEG
        if is_odd and (axis := self._spans.dead_axis):
            text = f"Axis {axis} has not moved while the sensor was turned"
            return None, f"{text}: it seems to be dead. Use another sensor."
        if not low <= still.magnitude_g <= high:
            text = f"The sensor reads {still.magnitude_g:.2f} g where 1 g is: wrong protocol, or"
            return None, f"{text} an axis is dead."
        if off_deg > TILT_LIMIT_DEG:
            text = f"It lies {off_deg:.0f} degrees askew ({words_of(position)} is nearest)"
            return None, f"{text}: lay a flat side on a level table."
        if max(still.noise_g) > NOISE_LIMIT_G:
            return position, _noisy(max(still.noise_g))
        return position, ""

    def _tell(self, still: Still | None) -> None:
        """What is to be said about movement, noise, and a sensor that lies where it lay."""
        stillness = self._stillness
        if math.isnan(self._restless_s) or still is not None or stillness.is_silent:
            self._restless_s = self._now_s
        if stillness.moved_after_s > 0.0:
            has_lost = self._lain is None and stillness.moved_after_s > LOST_S
            self._told = "It moved: once more." if has_lost else self._told
            self._lain, self._is_refused = None, False
        if self._now_s - self._restless_s > RESTLESS_S:
            self._told = _restless(stillness.noise_g)
        if stillness.sways:
            self._told = "It sways as if it were worn or held: lay it down and let go."
        lain_s = self._now_s - self._lain_s
        if self._lain is not None and lain_s > UNMOVED_S:
            self._told = (
                f"It has lain like this for {lain_s:.0f} s. If you have turned it, it does not "
                "feel that: restart the sensor, or use another."
            )

    def _doubt(self) -> None:
        """Ask once more for a position that seems to have been none: as on an arm. Only once."""
        shaky = shaky_position(self._taken)
        if shaky is not None and shaky not in self._doubted:
            self._doubted.add(shaky)
            del self._taken[shaky]
            self._lain = None
            self._told = f"With {words_of(shaky)} it was not as still as otherwise: once more."

    def _finish(self) -> None:
        taken = self._taken
        means = np.array([still.mean_g for still in taken.values()])
        fit = fit_calibration(means, tuple(taken))
        if fit.is_good and (axis := clipped_axis(taken)):
            text = f"Refused: axis {axis} ends before 1 g, its reading is cut off. Use another"
            fit = replace(fit, is_good=False, verdict=f"{text} range or sensor.")
        self._fit = fit
        text = f"{fit.verdict} It was {fit.before_mg:.0f} mg off before."
        self._view = replace(
            self._shown(),
            is_on=False,
            sentence="Calibrated." if fit.is_good else "Not kept: the calibration as it was stays.",
            wanted=None,
            before_mg=fit.before_mg,
            after_mg=fit.after_mg,
            worst_mg=fit.worst_mg,
            verdict=fit.verdict,
            outcome=Outcome(Check.PASSED if fit.is_good else Check.FAILED, text),
        )

    def _shown(self) -> CalibrationView:
        wanted = next((position for position in Position if position not in self._taken), None)
        lying = self._lying()
        positions = tuple(self._position(position, lying) for position in Position)
        sentence = self._sentence(wanted, lying)
        outcome = Outcome(Check.RUNNING, sentence)
        return replace(
            self._view, sentence=sentence, positions=positions, wanted=wanted, outcome=outcome
        )

    def _lying(self) -> Position | None:
        """The missing position that it seems to lie in now; None for none, or one not taken."""
        so_far = self._stillness.so_far
        if so_far is None or self._is_refused or self._stillness.sways:
            return None
        position, off_deg = nearest(so_far)
        is_taken = position in self._taken or off_deg > TILT_LIMIT_DEG
        return None if is_taken or so_far.magnitude_g < MAGNITUDE_G[0] else position

    def _position(self, position: Position, lying: Position | None) -> PositionView:
        if position in self._taken:
            return PositionView(position, PositionState.DONE, 1.0)
        if position is lying:
            return PositionView(position, PositionState.HOLD_STILL, self._stillness.progress)
        return PositionView(position)

    def _sentence(self, wanted: Position | None, lying: Position | None) -> str:
        if self._stillness.is_silent:
            return "No samples come from the sensor: switch it on, or see Sensors."
        if wanted is None:
            return self._told
        if lying is not None:
            return f"{words_of(lying)}: do not touch it or the table."
        return " ".join(filter(None, (self._told, f"{_LAY[wanted]}.")))


def _restless(noise_g: float) -> str:
    if noise_g > NOISE_LIMIT_G:
        return _noisy(noise_g)
    return f"Not still for {RESTLESS_S:.0f} s: let go of it. Does the table shake?"


def _noisy(noise_g: float) -> str:
    figures = f"{noise_g * 1000:.0f} mg, {NOISE_LIMIT_G * 1000:.0f} are allowed"
    return f"Noisy: {figures}. Does the table shake? Check battery and wiring."


def nearest(still: Still) -> tuple[Position, float]:
    """The position whose axis is nearest to what was read, and the angle between them, degrees."""
    mean = still.mean_g
    cosines = {
        position: sum(a * b for a, b in zip(mean, up, strict=True)) for position, up in UP.items()
    }
    best = max(cosines, key=lambda position: cosines[position])
    cosine = cosines[best] / max(still.magnitude_g, 1e-9)
    return best, math.degrees(math.acos(max(-1.0, min(1.0, cosine))))
