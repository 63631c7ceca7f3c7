"""Fewer points for the same picture: the lowest and the highest of each stretch of time. Pure."""

import numpy as np
from numpy.typing import NDArray


def decimate(rows: NDArray[np.float64], span_s: float, n_points: int) -> NDArray[np.float64]:
    """Reduce samples to about one point per pixel, keeping every peak.

    The stretches are cut on a fixed grid of the clock, not from the newest sample, so that the same
    samples give the same points in every frame and a scrolling curve does not shimmer.

    Args:
        rows: Samples, shape (n, 1 + k): time in s, then k values. Oldest first.
        span_s: The time that the picture shows, > 0.
        n_points: How many points it has room for, >= 2.

    Returns:
        Shape (m, 1 + k), m at most about ``n_points``; the rows themselves when they are few.

    Raises:
        ValueError: ``span_s`` or ``n_points`` leaves no room.
    """
    if span_s <= 0 or n_points < 2:
        raise ValueError(f"no room: {n_points} points for {span_s} s")
    if len(rows) <= n_points:
        return rows
    stretch_s = 2 * span_s / n_points
    stretches = np.floor(rows[:, 0] / stretch_s)
    starts = np.concatenate(([0], np.flatnonzero(np.diff(stretches)) + 1))
    points = np.empty((2 * len(starts), rows.shape[1]))
    points[0::2, 0] = stretches[starts] * stretch_s
    points[1::2, 0] = points[0::2, 0] + stretch_s / 2
    points[0::2, 1:] = np.minimum.reduceat(rows[:, 1:], starts, axis=0)
    points[1::2, 1:] = np.maximum.reduceat(rows[:, 1:], starts, axis=0)
    return points
