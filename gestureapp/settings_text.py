"""Settings as the TOML a person edits: every value with its meaning, unit and range. Pure."""

import inspect
import json
import re
import textwrap
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from pathlib import Path
from typing import Final

from gestureapp.config import SCHEMA_VERSION, YAWS_DEG, KeepOutSettings, RobotSettings, Settings
from gestureapp.robot.nx100 import NETWORK_INPUTS
from gestureapp.settings_check import RANGES
from gestureapp.settings_words import unit_of

_ATTRIBUTE: Final = re.compile(r"^    (\w+): ", re.MULTILINE)
_COMMENT_COLUMNS: Final = 96
_ALLOWED: Final[Mapping[tuple[type, str], str]] = {
    (RobotSettings, "yaw_deg"): f"{', '.join(map(str, YAWS_DEG[:-1]))} or {YAWS_DEG[-1]}",
    (RobotSettings, "host"): "an IP address, or empty for none",
    (RobotSettings, "supervision_input"): (
        f"0, or a multiple of 10, {NETWORK_INPUTS[0]} to {NETWORK_INPUTS[-1]}"
    ),
}
"""Where a range does not say it all."""


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
            lines += ["", *comment_on_table(type(values)), f"[{table.name}]"]
            for setting in fields(values):
                lines += comment_on_key(type(values), setting.name)
                lines.append(f"{setting.name} = {toml(getattr(values, setting.name))}")
    return "\n".join(lines) + "\n"


def about(owner: type, name: str) -> str:
    """What a setting means, in one paragraph; empty when docstrings are stripped."""
    return _descriptions(owner).get(name, "")


def allowed(owner: type, name: str) -> str:
    """What a setting may be, in words, without the unit; empty when anything goes."""
    if words := _ALLOWED.get((owner, name)):
        return words
    if found := choices(owner, name):
        return " or ".join(found)
    return str(RANGES.get((owner, name), ""))


def choices(owner: type, name: str) -> tuple[str, ...]:
    """The words that a setting may be; empty where it is none of a few words."""
    default = next(field.default for field in fields(owner) if field.name == name)
    return tuple(member.value for member in type(default)) if isinstance(default, Enum) else ()


def _comment_on(owner: type, name: str) -> str:
    """What a setting means, its unit, range and choices, in one paragraph."""
    parts = [about(owner, name)]
    unit, within = unit_of(name), RANGES.get((owner, name))
    if within is not None:
        parts.append(f"Allowed: {within}{f' {unit}' if unit else ''}.")
    elif unit:
        parts.append(f"In {unit}.")
    if found := choices(owner, name):
        parts.append(f"One of: {', '.join(toml(word) for word in found)}.")
    return " ".join(part for part in parts if part)


def comment_on_table(owner: type) -> list[str]:
    """The comment lines that stand above a table."""
    return list(_comment(_summary(owner)))


def comment_on_key(owner: type, name: str) -> list[str]:
    """The comment lines that stand above a setting."""
    return list(_comment(_comment_on(owner, name)))


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


def toml(value: object) -> str:
    """A setting as it stands behind the equals sign."""
    match value:
        case bool():
            return str(value).lower()
        case int() | float():
            return repr(value)
        case KeepOutSettings():
            pairs = (f"{f.name} = {toml(getattr(value, f.name))}" for f in fields(value))
            return f"{{ {', '.join(pairs)} }}"
        case tuple():
            return f"[{', '.join(toml(item) for item in value)}]"
        case Enum():
            return toml(value.value)
        case None:
            return '""'
        case str() | Path():
            # JSON's escapes are TOML's, but for DEL, which TOML wants escaped.
            return json.dumps(str(value), ensure_ascii=False).replace("\x7f", "\\u007f")
        case _:
            raise TypeError(f"a setting of type {type(value).__name__} has no form in TOML")
