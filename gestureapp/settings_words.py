"""How a setting's value and unit stand in a line for a person. Pure."""

from collections.abc import Mapping
from enum import Enum
from typing import Final

from gestureapp.config import KeepOutSettings

_SHOWN_CHARS: Final = 60

UNITS: Final[Mapping[str, str]] = {
    "_mm_s": "mm/s",
    "_deg_s": "deg/s",
    "_mm": "mm",
    "_deg": "deg",
    "_hz": "Hz",
    "_days": "days",
    "_hours": "hours",
    "_s": "s",
    "_g": "g",
}
"""By the end of a setting's name, longest first."""


def unit_of(name: str) -> str:
    """The unit in a setting's name; empty where it has none."""
    return next((unit for ending, unit in UNITS.items() if name.endswith(ending)), "")


def shown(value: object) -> str:
    """A value as it may stand in a line: short, and without line breaks."""
    if isinstance(value, tuple | list):
        items = ["[…]" if isinstance(item, list) else shown(item) for item in value[:5]]
        return f"[{_joined(items)}]"
    if isinstance(value, dict):
        return "a table"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, Enum):
        value = value.value
    text = written(value.name if isinstance(value, KeepOutSettings) else value)
    return text if len(text) <= _SHOWN_CHARS else f"{text[: _SHOWN_CHARS - 3]}…"


def written(value: object) -> str:
    """``repr`` of a value, but for numbers so long that Python writes them nowhere."""
    try:
        return repr(value)
    except ValueError:
        return "a number of thousands of digits"


def _joined(items: list[str]) -> str:
    """As many whole items as fit, four at most, and whether there are more."""
    kept = items[:4]
    while len(kept) > 1 and len(", ".join(kept)) > _SHOWN_CHARS:
        kept.pop()
    return ", ".join(kept) + ", …" * (len(kept) < len(items))


def unit_text(name: str) -> str:
    """The unit as it follows a number; empty where there is none."""
    unit = unit_of(name)
    return f" {unit}" if unit else ""
