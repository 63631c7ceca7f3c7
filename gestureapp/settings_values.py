"""Values between the forms of TOML and of the settings classes. Pure."""

import difflib
import math
from collections.abc import Mapping, Sequence
from dataclasses import fields
from enum import Enum
from pathlib import Path
from types import UnionType
from typing import Any, Final, get_args, get_origin, get_type_hints

from gestureapp.config import KeepOutSettings, RobotSettings
from gestureapp.settings_check import RANGES, wrong_in_keep_out
from gestureapp.settings_words import shown, written

BOX: Final = '{ name = "…", low_mm = [x, y, z], high_mm = [x, y, z] }'
"""How a box to keep out of is written."""


class WrongType(Exception):
    """A value is of another kind than its setting; the text says what is allowed."""


def plain(value: object) -> object:
    """A setting as it would stand in a settings file; lists as tuples, boxes as mappings."""
    match value:
        case Enum():
            return value.value
        case None:
            return ""
        case Path():
            return str(value)
        case KeepOutSettings():
            return {field.name: plain(getattr(value, field.name)) for field in fields(value)}
        case tuple():
            return tuple(plain(item) for item in value)
    return value


def converted(raw: Any, hint: Any, folder: Path) -> Any:  # noqa: ANN401 - TOML in, settings out
    """A TOML value as its setting's type.

    Raises:
        WrongType: it is of another kind.
    """
    if get_origin(hint) is tuple:
        kinds = get_args(hint)
        if not isinstance(raw, list) or len(raw) != len(kinds):
            raise WrongType(f"a list of {len(kinds)} numbers, [{', '.join(['1.0'] * len(kinds))}]")
        return tuple(converted(item, kind, folder) for item, kind in zip(raw, kinds, strict=True))
    if isinstance(hint, UnionType):
        return _file_path(raw, folder)
    if issubclass(hint, Enum):
        return _member(raw, hint)
    if hint is float:
        return _number(raw)
    if type(raw) is not hint:
        raise WrongType(_KIND_WORDS[hint])
    if isinstance(raw, str) and not is_unicode(raw):
        raise WrongType("a text of whole characters")
    return raw


def is_unicode(text: str) -> bool:
    """Whether every character of it is whole; one that is not can be written to no file."""
    return text.encode(errors="ignore").decode() == text


_KIND_WORDS: Final[Mapping[type, str]] = {
    int: "a whole number",
    bool: "true or false",
    str: 'a text in quotes, "…"',
}


def keep_out_of(raw: object) -> tuple[KeepOutSettings | None, str, str]:
    """A box, or None, the key that is wrong in it (empty for the whole) and what is wrong."""
    if not isinstance(raw, dict):
        return None, "", f"{shown(raw)} is not allowed; allowed is {BOX}"
    hints = get_type_hints(KeepOutSettings)
    for key in raw:
        if key not in hints:
            return None, short(key), f"unknown{did_you_mean(key, list(hints))}; a box is {BOX}"
    values: dict[str, Any] = {}
    for key, hint in hints.items():
        if key not in raw:
            return None, key, f"missing; a box is {BOX}"
        try:
            values[key] = converted(raw[key], hint, Path())
        except WrongType:
            allowed = _KIND_WORDS[str] if hint is str else "a list of 3 numbers, mm: [x, y, z]"
            return None, key, f"{shown(raw[key])} is not allowed; allowed is {allowed}"
    box = KeepOutSettings(**values)
    key, text = wrong_in_keep_out(box, RANGES[RobotSettings, "keep_outs"])
    return None if text else box, key, text


def _number(raw: object) -> float:
    if isinstance(raw, bool) or not isinstance(raw, int | float):
        raise WrongType("a number")
    try:
        number = float(raw)
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        raise WrongType("a finite number")
    return number


def _member(raw: object, kind: type[Enum]) -> Enum:
    for member in kind:
        if member.value == raw:
            return member
    raise WrongType(" or ".join(f'"{member.value}"' for member in kind))


def _file_path(raw: object, folder: Path) -> Path | None:
    """A file's name, beside the settings file unless it is absolute; empty for none."""
    if not isinstance(raw, str) or "\0" in raw or not is_unicode(raw):
        raise WrongType('the name of a file in quotes, or "" for none')
    return folder / Path(raw) if raw else None


def did_you_mean(key: str, known: Sequence[str]) -> str:
    """The nearest of the known names in parentheses; empty when none is near."""
    near = difflib.get_close_matches(key[:60], known, n=1)
    return f" (did you mean {near[0]}?)" if near else ""


def short(value: object) -> str:
    """A name or value as it may stand in a line: printable, at most 60 characters."""
    text = value if isinstance(value, str) and value.isprintable() else written(value)
    return text if len(text) <= 60 else f"{text[:57]}…"
