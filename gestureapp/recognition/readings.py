"""Whether the numbers of a file of takes can be an arm's readings in g, at a usable rate. Pure."""

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
PEAK_MOST_G = 6.0
"""Half of a person's gestures stay below it: the strongest of five people went to 3.4 g in the
middle, without gravity, a simulated one to 1.1 g, which are 11 m/s2."""
SLOWEST_HZ, FASTEST_HZ = 20.0, 2000.0
"""A gesture is told within 160 ms: three samples at the least. Nothing faster was ever tried, and a
hand is no faster."""


def find_fault(samples: F64, offsets: I64, rate_hz: float | None) -> str:
    """What is wrong with a file in words, with the remedy; empty when nothing is.

    Args:
        samples: Shape (n, 3), finite, as they stand in the file.
        offsets: Shape (m + 1,), where each take begins.
        rate_hz: Sample rate; None when unknown.
    """
    return _fault_of_readings(samples, offsets) or _fault_of_rate(rate_hz)


def find_doubts(samples: F64, offsets: I64) -> tuple[str, ...]:
    """What a person should look at in samples without a fault, in words."""
    if not len(samples):
        return ()
    peak_g = np.maximum.reduceat(np.linalg.norm(samples, axis=1), offsets[:-1])
    if (middle_g := float(np.median(peak_g))) <= PEAK_MOST_G:
        return ()
    words = f"half of the takes go beyond {middle_g:.1f} g, which hands hardly do: if the samples"
    return (f"{words} are in m/s2, divide them by 9.80665",)


def _fault_of_rate(rate_hz: float | None) -> str:
    if rate_hz is None or SLOWEST_HZ <= rate_hz <= FASTEST_HZ:
        return ""
    if rate_hz < SLOWEST_HZ:
        remedy = "correct it, or record again: so few samples do not show a gesture"
    else:
        remedy = "correct it, or leave out samples until it is within"
    return f"'rate_hz' is {rate_hz:g}, outside {SLOWEST_HZ:g} to {FASTEST_HZ:g} Hz: {remedy}"


def _fault_of_readings(samples: F64, offsets: I64) -> str:
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
