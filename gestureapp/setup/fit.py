"""Offset, gain and cross-axis of a sensor from what it read in six positions. Pure.

Source: STMicroelectronics AN4508, "Parameters and calibration of a low-g 3-axis accelerometer": a
reading is sensor * truth + offset, twelve numbers, and six positions on its sides are 18 equations
for them. All weighted alike, as there, a side that lies 2 degrees askew puts 14 mg into the offset
and 17 mg into the cross-axis, more than an ADXL330 has of it: measured, 19 mg rms are left in any
direction, 6 mg without any cross-axis. So each equation is weighted by what it is worth (maximum a
posteriori with normal errors): along the axis that points up a tilt counts in the second order,
across it in the first, so those are worth what they agree among each other; and the part's own
cross-axis is known to be small, while the turn of the sensor in its box is not.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from gestureapp.sensing.calibration import NOMINAL, Calibration, Vector
from gestureapp.setup.values import Position

F64 = NDArray[np.float64]

GAIN_LIMIT: Final = 0.2
"""An ADXL330 is within 0.1 of nominal (data sheet rev. A, table 1); twice that is no ADXL330."""
OFFSET_LIMIT_G: Final = 0.3
"""Its zero-g bias: 1.2 to 1.8 V around 1.5 V at 300 mV/g is 1 g; a zeroed one is far below this."""
CROSS_LIMIT: Final = 0.1
"""1 % is the part's own (data sheet); the rest is a sensor that sits askew in its box, 5.7 deg."""
WORST_LIMIT_MG: Final = 20.0
"""More is left in one of the positions: something moved, or the sensor is not linear."""
_WORST_CONDITION: Final = 20.0
"""An axis that answers so little to gravity is dead."""
FLAT_LIMIT_DEG: Final = 4.0
"""A position that fits the five others less than this was not flat."""

_ALONG_G: Final = 0.003
"""Standard deviation of what an axis that points up reads: noise, steps of the converter."""
_ACROSS_G: Final = 0.03
"""Of what the two other axes read, to begin with: a side that lies 1.7 degrees askew."""
_PASSES: Final = 6
"""How often that is found anew from what is left; it has settled by then."""
_SHEAR: Final = 0.01
"""Of the cross-axis that is the part's own, the same both ways. Source: its data sheet, 1 %."""
_TURN: Final = 0.05
"""Of the turn of the part in its box, in radians: 3 degrees."""

UP: Final[Mapping[Position, Vector]] = {
    Position.X_UP: (1.0, 0.0, 0.0),
    Position.X_DOWN: (-1.0, 0.0, 0.0),
    Position.Y_UP: (0.0, 1.0, 0.0),
    Position.Y_DOWN: (0.0, -1.0, 0.0),
    Position.Z_UP: (0.0, 0.0, 1.0),
    Position.Z_DOWN: (0.0, 0.0, -1.0),
}
"""What a perfect sensor reads in each position, in g: the axis that points up reads +1."""


@dataclass(frozen=True, slots=True)
class Fit:
    """What came of it.

    Attributes:
        calibration: The best there is; ``NOMINAL`` where none could be computed.
        before_mg: Distance of the readings from 1 g, root of the mean square over the positions.
        after_mg: The same with the calibration.
        worst_mg: The worst of the positions with the calibration.
        off_deg: Largest angle between a corrected reading and its axis.
        is_good: It may be used.
        verdict: In words, with the figures and, where it is not good, the remedy.
    """

    calibration: Calibration
    before_mg: float
    after_mg: float
    worst_mg: float
    off_deg: float
    is_good: bool
    verdict: str


def fit_calibration(means_g: F64, positions: Sequence[Position]) -> Fit:
    """Fit offset, gain and cross-axis, twelve numbers, by least squares against 1 g.

    The matrix also turns the sensor's axes onto its box's: level is what the box lies on.

    Args:
        means_g: What was read in each position, nominal scale, shape (6, 3), in g.
        positions: Which, in the same order; each of the six once.

    Raises:
        ValueError: not every position is there once, or the shape is another.
    """
    if set(positions) != set(Position) or means_g.shape != (len(UP), 3) or len(positions) != 6:
        raise ValueError("each of the six positions is needed once")
    before_mg = _off_mg(means_g)
    truth = np.array([UP[position] for position in positions])
    solved = _solved(means_g, truth)
    if solved is None:
        text = "Refused: the readings do not tell three axes apart. The sensor is broken."
        return Fit(NOMINAL, _rms(before_mg), math.nan, math.nan, math.nan, False, text)
    matrix, offset_g = solved
    corrected = (means_g - offset_g) @ matrix.T
    after_mg = _off_mg(corrected)
    off_deg = _angles_deg(corrected, truth)
    worst_mg = float(np.abs(after_mg).max())
    problem = _implausible(matrix, offset_g) or _unfit(positions, off_deg, after_mg)
    verdict = problem or _good(worst_mg, float(off_deg.max()))
    return Fit(
        Calibration(
            _vector(offset_g), (_vector(matrix[0]), _vector(matrix[1]), _vector(matrix[2]))
        ),
        _rms(before_mg),
        _rms(after_mg),
        worst_mg,
        float(off_deg.max()),
        not problem,
        verdict,
    )


def _solved(means_g: F64, truth: F64) -> tuple[F64, F64] | None:
    """Matrix and offset; None when the readings do not determine them.

    Unknown are the nine of the sensor's matrix, row by row, and the three of the offset.
    """
    if not np.isfinite(means_g).all():
        return None
    across_g, left = _ACROSS_G, ~truth.astype(bool)
    sensor, offset_g = _weighted(means_g, truth, across_g)
    for _ in range(_PASSES):
        across = (means_g - offset_g - truth @ sensor.T)[left]
        # Twelve of them, and about half as many numbers are free to follow them.
        across_g = float(np.clip(np.sqrt(2.0 * np.mean(across**2)), _ALONG_G, 2.0 * _ACROSS_G))
        sensor, offset_g = _weighted(means_g, truth, across_g)
    if np.linalg.cond(sensor) > _WORST_CONDITION:
        return None
    matrix = np.linalg.inv(sensor).astype(np.float64)
    return matrix, offset_g


def _weighted(means_g: F64, truth: F64, across_g: float) -> tuple[F64, F64]:
    """What the sensor does, matrix and offset, by weighted least squares."""
    weights = np.where(truth.astype(bool), 1.0 / _ALONG_G, 1.0 / across_g)
    equations = np.zeros((len(means_g), 3, 12))
    for axis in range(3):
        equations[:, axis, 3 * axis : 3 * axis + 3] = truth
        equations[:, axis, 9 + axis] = 1.0
    known = _known()
    rows = np.vstack([(equations * weights[:, :, None]).reshape(-1, 12), known])
    right = np.concatenate([(means_g * weights).ravel(), np.zeros(len(known))])
    twelve = np.linalg.lstsq(rows, right, rcond=None)[0]
    return twelve[:9].reshape(3, 3), twelve[9:]


def _known() -> F64:
    """What is known before anything is read: how large shear and turn are, as equations to 0."""
    rows = []
    for a, b in ((0, 1), (0, 2), (1, 2)):
        for sign, spread in ((1.0, _SHEAR), (-1.0, _TURN)):
            row = np.zeros(12)
            row[3 * a + b], row[3 * b + a] = 0.5 / spread, sign * 0.5 / spread
            rows.append(row)
    return np.array(rows)


def _implausible(matrix: F64, offset_g: F64) -> str:
    """What no sensor of this kind has, in words; empty when all is as it may be.

    The inverse of the matrix is what the sensor does: its gain on the diagonal.
    """
    sensor = np.linalg.inv(matrix)
    for axis, name in enumerate("XYZ"):
        gain, offset = float(sensor[axis, axis]), float(offset_g[axis])
        if not abs(gain - 1.0) <= GAIN_LIMIT:
            return (
                f"Refused: axis {name} reads {gain:.2f} g for 1 g, up to {GAIN_LIMIT:.0%} off is "
                "allowed. Is the protocol the right one? If so, the sensor is broken."
            )
        if not abs(offset) <= OFFSET_LIMIT_G:
            return (
                f"Refused: axis {name} reads {offset:+.2f} g where 0 is, up to "
                f"{OFFSET_LIMIT_G:g} g is allowed. Zero the sensor, or use another."
            )
    cross = sensor - np.diag(np.diag(sensor))
    worst = float(np.abs(cross).max())
    if not worst <= CROSS_LIMIT:
        return (
            f"Refused: one axis reads {worst:.0%} of another, up to {CROSS_LIMIT:.0%} is allowed. "
            "The sensor sits askew in its box, or it was not laid flat: begin anew."
        )
    return ""


def _unfit(positions: Sequence[Position], off_deg: F64, after_mg: F64) -> str:
    """Why the positions do not agree with each other, in words; empty when they do."""
    worst = int(off_deg.argmax())
    if off_deg[worst] > FLAT_LIMIT_DEG:
        return (
            f"Not flat: with {words_of(positions[worst])} it lay {off_deg[worst]:.0f} degrees off "
            "what the other positions say. Begin anew on a level table, every side flat on it."
        )
    worst = int(np.abs(after_mg).argmax())
    if abs(after_mg[worst]) > WORST_LIMIT_MG:
        return (
            f"Refused: with {words_of(positions[worst])} {abs(after_mg[worst]):.0f} mg are left, "
            f"{WORST_LIMIT_MG:.0f} are allowed. Begin anew and do not touch the table meanwhile."
        )
    return ""


def mg_words(mg: float) -> str:
    """An acceleration as every line and page shows it: tenths of a mg below 10 mg."""
    return f"{mg:.1f} mg" if abs(mg) < 10 else f"{mg:.0f} mg"


def _good(worst_mg: float, off_deg: float) -> str:
    return f"Good: within {mg_words(worst_mg)}, every side flat to {off_deg:.1f} degrees."


def words_of(position: Position) -> str:
    """``X up``: the axis, and where it points."""
    axis, _, way = position.value.partition("-")
    return f"{axis.upper()} {way}"


def _off_mg(rows_g: F64) -> F64:
    off: F64 = (np.linalg.norm(rows_g, axis=1) - 1.0) * 1000.0
    return off


def _rms(values: F64) -> float:
    return float(np.sqrt(np.mean(values**2)))


def _angles_deg(rows: F64, truth: F64) -> F64:
    cosines = np.sum(rows * truth, axis=1) / np.maximum(np.linalg.norm(rows, axis=1), 1e-9)
    angles: F64 = np.degrees(np.arccos(np.clip(cosines, -1.0, 1.0)))
    return angles


def _vector(values: F64) -> Vector:
    x, y, z = (float(value) for value in values)
    return x, y, z
