"""What the onset-aligned recogniser sees of a movement at a moment: cells after the onset.

The grid is in seconds, not in samples, so that one network serves every rate, and samples may be
lost or late. Pure; all readings in g, all times in s. ``inputs_of`` takes one moment or many.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

F64 = NDArray[np.float64]

EDGES_S: F64 = (
    np.array([0, 10, 20, 30, 40, 50, 60, 70, 80, 90, 100, 120, 140, 160, 200, 240, 280, 320])
    / 1000.0
)
"""Edges of the cells after the onset. Fine where a decision falls, coarse where one is late."""
WIDTHS_S: F64 = np.diff(EDGES_S)
N_CELLS = len(WIDTHS_S)
HALF_FULL = 0.5
"""A cell counts when the movement has filled more than this share of it."""
N_INPUTS = 7 * N_CELLS + 23
LONGEST_S = 0.35
"""A longer elapsed time is given to the network as this."""

VELOCITY_S = 0.05
"""The change of velocity is given in g times this."""
SIZE_G, DIRECTION_G, VELOCITY_G, SMALL_G = 0.15, 0.1, 0.05, 0.05
"""Added to sizes before dividing by them, so that noise at rest has no direction."""

INPUT_ONSET = (
    f"{N_INPUTS} numbers of the right arm at a moment: mean specific force less the baseline in "
    f"{N_CELLS} cells of time after the onset, relative to the largest and squeezed by tanh, which "
    "cells are full, change of velocity and its direction, reading now less baseline and its "
    "direction, baseline, reading now, size, whether it is still, how sure the baseline is, time "
    "since the onset"
)

for _table in (EDGES_S, WIDTHS_S):
    _table.setflags(write=False)


@dataclass(frozen=True, slots=True)
class Moment:
    """What is known of a movement at a moment, or at many: the leading shapes are the same.

    Attributes:
        cells_g: Mean reading less baseline in each cell, shape (..., cells, 3); 0 where not full.
        is_full: 1.0 for a cell that counts, else 0.0; shape (..., cells).
        elapsed_s: Since the onset; 0 when nothing moves. Shape (...).
        baseline_g: The reading before the movement: gravity. Shape (..., 3).
        now_g: Mean of the newest readings, shape (..., 3).
        is_still: 1.0 when the arm is still now, else 0.0; shape (...).
        quality: How well the baseline is known, 0 (never seen still) to 1; shape (...).
    """

    cells_g: F64
    is_full: F64
    elapsed_s: F64
    baseline_g: F64
    now_g: F64
    is_still: F64
    quality: F64


def inputs_of(moment: Moment) -> F64:
    """The network's inputs, shape (..., ``N_INPUTS``)."""
    cells, full = moment.cells_g, moment.is_full
    velocity = np.einsum("...kc,...k->...c", cells, full * WIDTHS_S) / VELOCITY_S
    speed = _length(velocity)
    change = moment.now_g - moment.baseline_g
    size = _length(cells).max(axis=-2)
    lead = full.shape[:-1]
    parts = (
        (cells / (size[..., None] + SIZE_G)).reshape(*lead, 3 * N_CELLS),
        np.tanh(cells).reshape(*lead, 3 * N_CELLS),
        full,
        velocity,
        velocity / (speed + VELOCITY_G),
        np.tanh(speed),
        change,
        change / (_length(change) + DIRECTION_G),
        moment.baseline_g,
        moment.now_g,
        np.log(size + SMALL_G),
        moment.is_still[..., None],
        moment.quality[..., None],
        5.0 * np.minimum(np.maximum(moment.elapsed_s, 0.0), LONGEST_S)[..., None],
    )
    return np.concatenate(parts, axis=-1)


def cells_of(times_s: F64, accel_g: F64, onset_s: float, baseline_g: F64) -> tuple[F64, F64]:
    """Mean deviation in each full cell after the onset, linear between samples; for one movement.

    Args:
        times_s: Of the samples, shape (n,), not decreasing; the last one is now.
        accel_g: Shape (n, 3).
        onset_s: Begin of the movement; not before the first sample.
        baseline_g: Shape (3,).

    Returns:
        ``Moment.cells_g`` and ``Moment.is_full``.
    """
    elapsed_s = float(times_s[-1]) - onset_s
    first = max(int(np.searchsorted(times_s, onset_s, "right")) - 1, 0)
    times, accel = times_s[first:], accel_g[first:]
    cells, full = np.zeros((N_CELLS, 3)), np.zeros(N_CELLS)
    if len(times) < 2:
        return cells, full
    steps = np.diff(times)
    integral = np.zeros_like(accel)
    np.cumsum(0.5 * (accel[1:] + accel[:-1]) * steps[:, None], axis=0, out=integral[1:])
    ends = np.minimum(np.maximum(onset_s + np.minimum(EDGES_S, elapsed_s), times[0]), times[-1])
    at = np.minimum(np.searchsorted(times, ends, "right") - 1, len(times) - 2)
    into = ends - times[at]
    bend = into * into / np.maximum(steps[at], 1e-9)
    rise = 0.5 * (accel[at + 1] - accel[at])
    sums = integral[at] + accel[at] * into[:, None] + rise * bend[:, None]
    filled_s = np.minimum(EDGES_S[1:], elapsed_s) - EDGES_S[:-1]
    counts = filled_s > HALF_FULL * WIDTHS_S
    means = np.diff(sums, axis=0) / np.maximum(filled_s, 1e-4)[:, None] - baseline_g
    cells[counts], full[counts] = means[counts], 1.0
    return cells, full


def _length(vectors: F64) -> F64:
    lengths: F64 = np.sqrt(np.einsum("...c,...c->...", vectors, vectors))[..., None]
    return lengths
