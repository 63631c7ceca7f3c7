"""How far the recording of every gesture is, and which one to record next. Pure."""

from collections.abc import Iterable, Mapping
from typing import Final

from gestureapp.gestures import LABELS
from gestureapp.guided.values import GestureProgress, Quality
from gestureapp.recording.take_values import Take

BATCH_SIZE: Final = 10
"""Good takes of one gesture in a row; then another one, to spare the arm."""

SUGGESTED: Final = (
    *("X+", "RX+", "Y+", "RY+", "Z+", "RZ+"),
    *("X-", "RX-", "Y-", "RY-", "Z-", "RZ-"),
)
"""A movement, then a posture, and each time another axis: no muscle works twice in a row."""


def count_good(takes: Iterable[Take]) -> dict[str, int]:
    """Takes that count, of every gesture."""
    counts = dict.fromkeys(LABELS, 0)
    for take in takes:
        if take.counts and take.label in counts:
            counts[take.label] += 1
    return counts


def progress(
    good: Mapping[str, int], wanted: int, qualities: Mapping[str, Quality]
) -> tuple[GestureProgress, ...]:
    """How far every gesture is, in the set's order."""
    return tuple(
        GestureProgress(label, good[label], wanted, qualities.get(label, Quality.NONE))
        for label in LABELS
    )


def suggest(good: Mapping[str, int], wanted: int) -> str:
    """What to record next; empty when all is done.

    First a batch of every gesture, then a second one: whoever stops half way has some of each.
    """
    missing = [label for label in SUGGESTED if good[label] < wanted]
    return min(missing, key=lambda label: good[label] // BATCH_SIZE, default="")


def batch_size(good: int, wanted: int) -> int:
    """Good takes of the next batch: ten, or what is missing; beyond what is wanted ten more."""
    missing = wanted - good
    return min(BATCH_SIZE, missing) if missing > 0 else BATCH_SIZE
