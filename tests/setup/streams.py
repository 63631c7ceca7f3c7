"""Streams for the tests of setting up."""

import numpy as np
from numpy.typing import NDArray

from gestureapp.sensing.values import LinkState, Side, StreamHealth


def health_of(
    link: LinkState = LinkState.RECEIVING, reason: str = "", **changes: object
) -> StreamHealth:
    """The health of the left stream in one of the four states."""
    is_fine = link is LinkState.RECEIVING
    known: dict[str, object] = {
        "side": Side.LEFT,
        "link": link,
        "is_alive": is_fine,
        "is_valid": is_fine,
        "is_freq_ok": is_fine,
        "reason": reason,
        "age_s": 0.005,
        "rate_hz": 100.0,
        "worst_gap_s": 0.02,
        "n_samples": 100,
        "n_bad": 0,
        "n_lost": 0,
    }
    return StreamHealth(**known | changes)  # type: ignore[arg-type]


def rows_of(times_s: NDArray[np.float64], shake_g: float = 0.0, seed: int = 1) -> NDArray:
    """Samples of an arm that is shaken so strongly along X, with a still arm's noise."""
    rng = np.random.default_rng(seed)
    rows = np.zeros((len(times_s), 4))
    rows[:, 0] = times_s
    rows[:, 1:] = rng.normal((0.0, 0.0, 1.0), 0.01, (len(times_s), 3))
    rows[:, 1] += shake_g * np.sqrt(2.0) * np.sin(2 * np.pi * 4.0 * times_s)
    return rows
