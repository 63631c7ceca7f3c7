"""Which sensor belongs on which arm: remembered in a small file, and held against what is seen."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from gestureapp.recording.kept_json import read_kept, write_kept
from gestureapp.sensing.values import Side

_KIND: Final = "gestureapp sides"
_SCHEMA: Final = 1
_FILE: Final = "sides.json"

SWAPPED: Final = "the sensors are swapped"
SAME: Final = "both sensors have the same name"
SAME_PORT: Final = "both arms read the same port"
"""One sensor would be read as both: its arm would stop and steer at once."""


@dataclass(frozen=True, slots=True)
class Sides:
    """The sensors as they were assigned last, by their ids; empty where nobody knows.

    Only ids that stay with a sensor are remembered: what it calls itself, a USB serial number, a
    Bluetooth address; never a port's number.
    """

    left: str = ""
    right: str = ""

    def of(self, side: Side) -> str:
        """The sensor of this arm."""
        return self.left if side is Side.LEFT else self.right

    def assigned(self, side: Side, sensor_id: str) -> "Sides":
        """With this sensor on this arm, and on no other one."""
        other = self.right if side is Side.LEFT else self.left
        other = "" if other == sensor_id else other
        return Sides(sensor_id, other) if side is Side.LEFT else Sides(other, sensor_id)

    def swapped(self) -> "Sides":
        """The other way round."""
        return Sides(self.right, self.left)


def find_swapped(sides: Sides, seen: Sides) -> tuple[str, str]:
    """What is wrong with who is seen on which arm, and the remedy; empty when nothing is.

    Args:
        sides: As assigned.
        seen: As seen now; empty where no id that stays is known.
    """
    if seen.left and seen.left == seen.right:
        return SAME, "give each sensor a name of its own, or choose another port"
    left_is_right = bool(seen.left) and seen.left == sides.right != sides.left
    right_is_left = bool(seen.right) and seen.right == sides.left != sides.right
    if left_is_right or right_is_left:
        return SWAPPED, "press Swap, or wear them the other way round"
    return "", ""


def load_sides(data: Path) -> tuple[Sides, str]:
    """As they were assigned last, and what is wrong with the file; nobody's where none is."""
    try:
        content = read_kept(data / _FILE, _KIND, _SCHEMA)
    except ValueError as error:
        return (
            Sides(),
            f"{_FILE} {error}: press Assign by shaking, else who sends first belongs there",
        )
    if content is None:
        return Sides(), ""
    return Sides(_text(content, "left"), _text(content, "right")), ""


def save_sides(data: Path, sides: Sides) -> None:
    """Remember them.

    Raises:
        RecordingError: the file cannot be written.
    """
    content = {"left": sides.left, "right": sides.right}
    write_kept(data / _FILE, _KIND, _SCHEMA, content)


def _text(content: Mapping[str, object], name: str) -> str:
    value = content.get(name)
    return value if isinstance(value, str) else ""
