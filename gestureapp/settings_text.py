"""Settings as the TOML a person edits: every value with its meaning, unit and range. Pure."""

import inspect
import json
import re
import textwrap
from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from enum import Enum
from pathlib import Path
from typing import Final

from gestureapp.config import SCHEMA_VERSION, KeepOutSettings, Settings
from gestureapp.settings_check import RANGES, unit_of

_ATTRIBUTE: Final = re.compile(r"^    (\w+): ", re.MULTILINE)
_COMMENT_COLUMNS: Final = 96


def default_settings_text() -> str:
    """The built-in settings as a commented settings file; reading it gives them back."""
    return settings_text(Settings())


def settings_text(settings: Settings) -> str:
    """These settings as a commented settings file; reading it gives them back.

    Comments come from the settings classes' own descriptions, ranges from the checked table.
    """
    lines = [
        "# What is wrong in site, robot or joints stops the start; elsewhere it is reported only.",
        "# Layers: built-in, the site's file, the user's; a later one only narrows motion limits.",
        f"schema = {SCHEMA_VERSION}",
    ]
    for table in fields(settings):
        values = getattr(settings, table.name)
        if is_dataclass(values) and not isinstance(values, type):
            lines += ["", *_comment(_summary(type(values))), f"[{table.name}]"]
            for setting in fields(values):
                lines += _comment(_about(type(values), setting.name))
                lines.append(f"{setting.name} = {_toml(getattr(values, setting.name))}")
    return "\n".join(lines) + "\n"


def _about(owner: type, name: str) -> str:
    """What a setting means, its unit, range and choices, in one paragraph."""
    parts = [_descriptions(owner).get(name, "")]
    unit, allowed = unit_of(name), RANGES.get((owner, name))
    if allowed is not None:
        parts.append(f"Allowed: {allowed}{f' {unit}' if unit else ''}.")
    elif unit:
        parts.append(f"In {unit}.")
    parts += [
        f"One of: {', '.join(_toml(member) for member in type(field.default))}."
        for field in fields(owner)
        if field.name == name and isinstance(field.default, Enum)
    ]
    return " ".join(part for part in parts if part)


def _summary(owner: type) -> str:
    return (inspect.getdoc(owner) or "").split("\n", 1)[0]


def _descriptions(owner: type) -> dict[str, str]:
    """What a class's docstring says of its attributes; empty when docstrings are stripped."""
    _, _, attributes = (inspect.getdoc(owner) or "").partition("Attributes:\n")
    found = _ATTRIBUTE.split(attributes)[1:]
    return {
        name: " ".join(text.split()).replace("``", "")
        for name, text in zip(found[::2], found[1::2], strict=True)
    }


def _comment(text: str) -> Iterator[str]:
    for line in textwrap.wrap(text, _COMMENT_COLUMNS):
        yield f"# {line}"


def _toml(value: object) -> str:
    match value:
        case bool():
            return str(value).lower()
        case int() | float():
            return repr(value)
        case KeepOutSettings():
            pairs = (f"{f.name} = {_toml(getattr(value, f.name))}" for f in fields(value))
            return f"{{ {', '.join(pairs)} }}"
        case tuple():
            return f"[{', '.join(_toml(item) for item in value)}]"
        case Enum():
            return _toml(value.value)
        case None:
            return '""'
        case str() | Path():
            # JSON's escapes are TOML's, but for DEL, which TOML wants escaped.
            return json.dumps(str(value), ensure_ascii=False).replace("\x7f", "\\u007f")
        case _:
            raise TypeError(f"a setting of type {type(value).__name__} has no form in TOML")
