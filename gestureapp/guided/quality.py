"""How alike the good takes of a gesture are. Pure."""

from collections.abc import Iterable

from gestureapp.guided.order import count_good
from gestureapp.guided.values import Quality
from gestureapp.recording.take_values import Take


def quality_of(takes: Iterable[Take]) -> dict[str, Quality]:
    """The quality mark of every gesture."""
    good = count_good(takes)
    return {label: Quality.FEW if n else Quality.NONE for label, n in good.items()}
