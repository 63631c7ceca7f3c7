"""Values of settings as a person types them, and back. Pure; no widget."""

import re
from collections.abc import Iterable, Mapping
from dataclasses import fields, replace
from enum import Enum
from typing import Any

from gestureapp.config import KeepOutSettings, RobotSettings
from gestureapp.setup.site_values import SettingRow

NEEDS_PIN = "Locked: needs the PIN."
ON, OFF = "on", "off"
"""The words of a setting that is one or the other."""
_APART = re.compile(r"[,;\s]+")
_BOX = re.compile(r"(?P<name>.+?)\s*:\s*(?P<low>[^:]+?)\s+to\s+(?P<high>[^:]+)")
BOX_FORM = "name: x, y, z to x, y, z"
"""One box to keep out of, on a line of its own; the lowest corner, then the highest, in mm."""

_CAPTIONS: Mapping[str, str] = {
    "robot.host": "Address",
    "robot.ext_radius_mm": "Outer sphere",
    "robot.int_radius_mm": "Inner sphere",
    "robot.margin_mm": "Margin to the boundary",
    "robot.floor_mm": "Floor",
    "robot.ceiling_mm": "Ceiling",
    "robot.column_radius_mm": "Robot's column, radius",
    "robot.column_top_mm": "Robot's column, top",
    "robot.keep_outs": "Boxes to keep out of",
    "robot.speed_mm_s": "Speed of a translation",
    "robot.speed_deg_s": "Speed of a rotation",
    "robot.rx_range_deg": "Range of Rx",
    "robot.ry_range_deg": "Range of Ry",
    "robot.rz_range_deg": "Range of Rz",
    "robot.margin_deg": "Margin of the angles",
    "robot.yaw_deg": "Operator faces",
    "robot.tool_mm": "Tool point from the flange",
    "site.trip_level_s": "Watchdog's trip level",
    "site.control_limit_s": "Control thread's limit",
    "site.gui_limit_s": "Window's limit",
    "site.stop_on_right_lost": "Stop if right is lost",
    "site.rate_min_hz": "Slowest stream",
    "site.rate_max_hz": "Fastest stream",
    "site.posture_enter_deg": "Posture taken within",
    "site.posture_leave_deg": "Posture left beyond",
    "site.posture_debounce": "Samples for a posture",
    "site.stop_seen_s": "Stop posture seen for",
    "site.calibration_days": "Calibration holds",
    "site.level_check_hours": "Level check holds",
    "training.n_takes": "Takes of each gesture",
}
"""Where the name in the file would read as an abbreviation."""
_CHOICE_WORDS: Mapping[str, Mapping[str, str]] = {
    "site.drive_mode": {"hold_to_run": "hold to run", "start_stop": "start and stop"},
}
"""What a choice is called here; a settings file has its short form."""
_DOTTED = re.compile(r"\b(?:left|right|site|robot|joints|person|training)\.[a-z]\w*")
_ENDINGS = re.compile(r"_(mm_s|deg_s|mm|deg|hz|s|g)$")


class Kind(Enum):
    """What a setting is set with."""

    TEXT = "text"
    NUMBER = "number"
    NUMBERS = "numbers"
    TOGGLE = "on or off"
    CHOICE = "choice"
    BOXES = "boxes"


class NotReadable(ValueError):
    """What was typed is of another kind than the setting; the text says what is wanted."""


def kind_of(row: SettingRow) -> Kind:
    """What this setting is set with."""
    if isinstance(row.value, bool):
        return Kind.TOGGLE
    if row.choices:
        return Kind.CHOICE
    if row.name.endswith("keep_outs"):
        return Kind.BOXES
    if isinstance(row.value, int | float):
        return Kind.NUMBER
    return Kind.NUMBERS if isinstance(row.value, list | tuple) else Kind.TEXT


def caption_of(name: str) -> str:
    """A setting's name as a person reads it, without its table and its unit."""
    if name in _CAPTIONS:
        return _CAPTIONS[name]
    words = _ENDINGS.sub("", name.rpartition(".")[2]).replace("_", " ")
    return words[:1].upper() + words[1:]


def in_words(text: str) -> str:
    """A message without the names that only a settings file has."""
    text = _DOTTED.sub(lambda name: f"\u201c{caption_of(name[0])}\u201d", text)
    for words in _CHOICE_WORDS.values():
        for raw, said in words.items():
            text = text.replace(raw, said)
    return text


def choice_texts(row: SettingRow) -> list[str]:
    """What a setting may be, as it is called here."""
    words = _CHOICE_WORDS.get(row.name, {})
    return [words.get(choice, choice) for choice in row.choices]


def value_text(row: SettingRow) -> str:
    """The setting's value as it is typed; ``typed_value`` gives it back."""
    match kind_of(row):
        case Kind.TOGGLE:
            return ON if row.value else OFF
        case Kind.NUMBER:
            return _number_text(row.value)
        case Kind.NUMBERS:
            return ", ".join(_number_text(each) for each in _items(row.value))
        case Kind.BOXES:
            return "\n".join(_box_text(_as_table(each)) for each in _items(row.value))
        case _:
            text = "" if row.value is None else str(row.value)
            return _CHOICE_WORDS.get(row.name, {}).get(text, text)


def typed_value(row: SettingRow, text: str) -> object:
    """What was typed, as a settings file would hold it.

    Raises:
        NotReadable: it is of another kind than the setting.
    """
    match kind_of(row):
        case Kind.TOGGLE:
            return text == ON
        case Kind.NUMBER:
            return _number(text, is_whole=isinstance(row.value, int))
        case Kind.NUMBERS:
            return _numbers(text, len(_items(row.value)))
        case Kind.BOXES:
            return [_box(line) for line in text.splitlines() if line.strip()]
        case Kind.CHOICE:
            words = _CHOICE_WORDS.get(row.name, {})
            return next((raw for raw, said in words.items() if said == text), text)
        case _:
            return text.strip()


def why_not_text(row: SettingRow) -> str:
    """Why a setting cannot be changed now, as a sentence; empty when it can."""
    if row.fixed:
        return f"{row.fixed[:1].upper()}{row.fixed[1:].rstrip('.')}."
    return NEEDS_PIN if row.is_locked else ""


def matches(row: SettingRow, wanted: str) -> bool:
    """Whether a setting is among those looked for: each word stands in its name or meaning."""
    text = f"{row.name} {caption_of(row.name)} {row.about} {row.origin}".casefold()
    return all(word in text for word in wanted.casefold().split())


def edited_robot(rows: Iterable[SettingRow], changes: Mapping[str, object]) -> RobotSettings:
    """The robot's settings as they would be, for a picture.

    Args:
        rows: All settings; those of other tables are passed over.
        changes: New values that can be used, by dotted name.
    """
    known = {field.name for field in fields(RobotSettings)}
    values: dict[str, Any] = {}
    for row in rows:
        table, _, name = row.name.partition(".")
        if table == "robot" and name in known:
            value = changes.get(row.name, row.value)
            values[name] = _frozen(name, value)
    return replace(RobotSettings(), **values)


def _frozen(name: str, value: object) -> object:
    if name == "keep_outs":
        return tuple(_as_keep_out(_as_table(each)) for each in _items(value))
    return tuple(value) if isinstance(value, list) else value


def _items(value: object) -> list[object]:
    return list(value) if isinstance(value, list | tuple) else []


def _as_table(box: object) -> Mapping[str, Any]:
    if isinstance(box, KeepOutSettings):
        return {"name": box.name, "low_mm": box.low_mm, "high_mm": box.high_mm}
    return box if isinstance(box, dict) else {"name": "", "low_mm": (), "high_mm": ()}


def _as_keep_out(box: Mapping[str, Any]) -> KeepOutSettings:
    return KeepOutSettings(box["name"], tuple(box["low_mm"]), tuple(box["high_mm"]))


def _box_text(box: Mapping[str, Any]) -> str:
    low, high = (", ".join(map(_number_text, box[key])) for key in ("low_mm", "high_mm"))
    return f"{box['name']}: {low} to {high}"


def _box(line: str) -> dict[str, object]:
    parts = _BOX.fullmatch(line.strip())
    if parts is None:
        raise NotReadable(f"{line.strip()!r} is no box; write one on each line, {BOX_FORM}")
    low, high = (_numbers(parts[corner], 3) for corner in ("low", "high"))
    return {"name": parts["name"], "low_mm": low, "high_mm": high}


def _number_text(value: object) -> str:
    return f"{value:.10g}" if isinstance(value, float) else str(value)


def _number(text: str, *, is_whole: bool) -> int | float:
    plain = text.strip().replace(",", ".")
    try:
        return int(plain) if is_whole else float(plain)
    except ValueError:
        wanted = "a whole number" if is_whole else "a number"
        raise NotReadable(f"{text.strip()!r} is not allowed; enter {wanted}") from None


def _numbers(text: str, n: int) -> list[float]:
    try:
        numbers = [float(each) for each in _APART.split(text.strip()) if each]
    except ValueError:
        numbers = []
    if len(numbers) != n:
        wanted = f"{n} numbers with commas between them"
        raise NotReadable(f"{text.strip()!r} is not allowed; enter {wanted}")
    return numbers
