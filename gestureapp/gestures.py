"""The gesture set: what the right arm can say, and which robot component each gesture means.

Axes everywhere: +X forward, +Y left, +Z up, right-handed, seen by the person who wears the sensors.
"""

from dataclasses import dataclass
from enum import Enum


class Kind(Enum):
    """How a gesture shows in the acceleration: while the arm moves, or while it is held."""

    MOVEMENT = "movement"
    POSTURE = "posture"


@dataclass(frozen=True, slots=True)
class Gesture:
    """One of the twelve things the right arm can say.

    Attributes:
        label: Stable id, as in files and on the wire: ``X+`` to ``RZ-``.
        words: What the person does, for the screen.
        kind: Movement (robot translation) or posture (robot rotation).
        axis: 0, 1 or 2 for X, Y, Z; the axis moved along or turned about.
        sign: +1 or -1.
    """

    label: str
    words: str
    kind: Kind
    axis: int
    sign: int


GESTURES: tuple[Gesture, ...] = (
    Gesture("X+", "push forward", Kind.MOVEMENT, 0, +1),
    Gesture("X-", "pull back", Kind.MOVEMENT, 0, -1),
    Gesture("Y+", "move left", Kind.MOVEMENT, 1, +1),
    Gesture("Y-", "move right", Kind.MOVEMENT, 1, -1),
    Gesture("Z+", "lift up", Kind.MOVEMENT, 2, +1),
    Gesture("Z-", "push down", Kind.MOVEMENT, 2, -1),
    Gesture("RX+", "roll right and hold", Kind.POSTURE, 0, +1),
    Gesture("RX-", "roll left and hold", Kind.POSTURE, 0, -1),
    Gesture("RY+", "tip up and hold", Kind.POSTURE, 1, +1),
    Gesture("RY-", "tip down and hold", Kind.POSTURE, 1, -1),
    Gesture("RZ+", "turn left and hold", Kind.POSTURE, 2, +1),
    Gesture("RZ-", "turn right and hold", Kind.POSTURE, 2, -1),
)
"""In the order of the paper's Table I; the network's outputs have the same order."""

LABELS: tuple[str, ...] = tuple(gesture.label for gesture in GESTURES)

_BY_LABEL = {gesture.label: gesture for gesture in GESTURES}


def gesture(label: str) -> Gesture:
    """Return the gesture with this label.

    Raises:
        KeyError: no gesture has this label.
    """
    return _BY_LABEL[label]


def is_held(label: str) -> bool:
    """Whether gravity shows the gesture, so that it is held when the activation comes: RX and RY.

    A turn about Z leaves the reading as it is; it shows while it is made, as movements do.

    Raises:
        KeyError: no gesture has this label.
    """
    wanted = gesture(label)
    return wanted.kind is Kind.POSTURE and wanted.axis != 2
