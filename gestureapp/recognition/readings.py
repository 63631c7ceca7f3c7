"""Whether the numbers of a file of takes can be an arm's readings in g. Pure."""

import numpy as np
from numpy.typing import NDArray

F64 = NDArray[np.float64]
I64 = NDArray[np.int64]

LARGEST_G = 100.0
"""No hand moves so, and no sensor for hands reads so far."""
MIDDLE_MOST_G = 5.0
"""Half of a take's readings are never beyond it: most of the time a hand is near 1 g."""
MS2_MOST = 15.0
"""Up to here the middle reading is about 9.81, and not another unit."""


def find_fault_of_readings(samples: F64, offsets: I64) -> str:
    """What is wrong with samples in words, with the remedy; empty when nothing is.

    Args:
        samples: Shape (n, 3), finite, as they stand in the file.
        offsets: Shape (m + 1,), where each take begins.
    """
    if not len(samples):
        return ""
    largest = np.abs(samples).max(axis=1)
    size = np.linalg.norm(np.clip(samples, -1e9, 1e9), axis=1)
    middle = float(np.median(size))
    if MIDDLE_MOST_G <= middle <= MS2_MOST:
        return (
            f"'samples' read {middle:.1f} in the middle, where a hand reads about 1 g: they look "
            "like m/s2; divide them by 9.80665"
        )
    if middle > MS2_MOST:
        return (
            f"'samples' read {middle:.3g} in the middle, where a hand reads about 1 g: they are "
            "not in g; divide them by what the sensor reads for 1 g"
        )
    if np.any(largest > LARGEST_G):
        row = int(np.argmax(largest > LARGEST_G))
        take = int(np.searchsorted(offsets, row, side="right")) - 1
        return (
            f"'samples' holds {largest[row]:.3g} at row {row} (take {take}): beyond "
            f"{LARGEST_G:g} g is no reading; leave that take out"
        )
    return ""
