"""Settings from TOML files in layers: built-in < site file < user file < the file named by hand.

What is wrong is reported with its file and line. Where it bears on motion, nothing is started: a
limit that was asked for must not be missing unseen. Elsewhere the layer below holds. A file that is
no TOML at all stops the start, too.
"""

import difflib
import math
import re
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import fields, is_dataclass, replace
from enum import Enum
from pathlib import Path
from types import UnionType
from typing import Any, Final, get_args, get_origin, get_type_hints

from gestureapp.config import SCHEMA_VERSION, KeepOutSettings, RobotSettings, Settings
from gestureapp.errors import ConfigError, SettingsRefused
from gestureapp.settings_check import (
    MARGINS,
    MAX_KEEP_OUTS,
    RANGES,
    SettingsFinding,
    bad_pairs,
    bears_on_motion,
    check_settings,
    keep_out_label,
    named_values,
    shown,
    why_not_below,
    why_out_of_range,
    why_wider,
    wrong_in_keep_out,
)
from gestureapp.settings_lines import lines_of
from gestureapp.settings_text import default_settings_text, settings_text

__all__ = [
    "SettingsFinding",
    "check_settings",
    "default_settings_text",
    "load_settings",
    "read_settings",
    "settings_text",
]

SCHEMA_KEY: Final = "schema"
_KEEP_OUTS: Final = "robot.keep_outs"
_BOX: Final = '{ name = "…", low_mm = [x, y, z], high_mm = [x, y, z] }'
_CORRECT: Final = "correct it, or take it out"
_MAX_BYTES: Final = 100_000
"""A settings file has some thousand bytes; more is a file taken by mistake."""
_LINE_IN_MESSAGE: Final = re.compile(r"\(at line (\d+), column \d+\)")
_AT_END: Final = "(at end of document)"


class _WrongType(Exception):
    """A value is of another kind than its setting; the text says what is allowed."""


def load_settings(
    files: Sequence[Path], named: Path | None = None
) -> tuple[Settings, list[SettingsFinding]]:
    """Read the layers, lowest first, and say what was wrong in them that does not bear on motion.

    Args:
        files: As for ``read_settings``.
        named: As for ``read_settings``.

    Raises:
        ConfigError: a file cannot be read, is not UTF-8, is not TOML, or has another schema.
        SettingsRefused: something that bears on motion is wrong.
    """
    settings, found = read_settings(files, named)
    if any(finding.is_refused for finding in found):
        raise SettingsRefused([str(finding) for finding in found])
    return settings, found


def read_settings(
    files: Sequence[Path], named: Path | None = None
) -> tuple[Settings, list[SettingsFinding]]:
    """Read the layers, lowest first, and say what was wrong in them, whatever it bears on.

    Args:
        files: The site's file, then the user's. One that does not exist is a layer without
            settings. Motion limits of the first may be anything in their range, those of the later
            ones only narrower.
        named: A file somebody asked for by name: the top layer, and it has to be there.

    Returns:
        Settings without any finding, and the findings of all files in their order.

    Raises:
        ConfigError: a file cannot be read, is not UTF-8, is not TOML, or has another schema.
    """
    settings, found = Settings(), []
    layers = [(file, index > 0) for index, file in enumerate(files) if _is_there(file)]
    if named is not None:
        layers.append((named, True))
    for file, is_narrowed in layers:
        layer = _Layer(file, settings, is_narrowed)
        settings = layer.merged()
        found += sorted(layer.found, key=lambda finding: finding.line or 0)
    return settings, found


class _Layer:
    """One file being laid over the settings below it. Attribute ``found``: what is wrong in it."""

    def __init__(self, file: Path, below: Settings, is_narrowed: bool) -> None:
        self.found: list[SettingsFinding] = []
        self._file = file
        self._below = below
        self._is_narrowed = is_narrowed
        text = _read(file)
        self._document = _parse(file, text)
        self._text = text
        self._lines: Mapping[str, int] | None = None

    def merged(self) -> Settings:
        """The settings below with what is right in this file."""
        self._check_schema()
        below = {name: value for name, _, value in named_values(self._below)}
        values = below | dict(self._accepted(below))
        for low, high in bad_pairs(values):
            self._report_pair(values, low, high)
        while bad := bad_pairs(values):  # a margin that is taken back may be too much for another
            for low, high in bad:
                values |= {name: below[name] for name in _with_margin(low, high)}
        tables = {}
        for table in _table_names():
            start = f"{table}."
            own = {name[len(start) :]: v for name, v in values.items() if name.startswith(start)}
            tables[table] = replace(getattr(self._below, table), **own)
        return replace(self._below, **tables)

    def _check_schema(self) -> None:
        version = self._document.get(SCHEMA_KEY)
        if version is None:
            text = f"missing; write {SCHEMA_KEY} = {SCHEMA_VERSION} at the top (taken as that)"
            self.found.append(SettingsFinding(SCHEMA_KEY, text, self._file, 1))
        elif isinstance(version, bool) or version != SCHEMA_VERSION:
            where = f"{self._file}, line {self._line(SCHEMA_KEY)}"
            reason = f"{where}: this application reads schema {SCHEMA_VERSION}; update one of them"
            raise ConfigError(SCHEMA_KEY, _short(version), reason)

    def _accepted(self, below: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
        known = [SCHEMA_KEY, *_table_names()]
        for key, table in self._document.items():
            if key == SCHEMA_KEY:
                continue
            if key not in known:
                self._report_unknown(key, key, known)
            elif not isinstance(table, dict):
                self._report(key, f"must be a table; write [{key}] on a line of its own")
            else:
                yield from self._accepted_of_table(key, table, below)

    def _accepted_of_table(
        self, table: str, items: Mapping[str, Any], below: Mapping[str, Any]
    ) -> Iterator[tuple[str, Any]]:
        owner = type(getattr(self._below, table))
        hints = get_type_hints(owner)
        for key, raw in items.items():
            name = f"{table}.{key}"
            if key not in hints:
                self._report_unknown(name, key, list(hints))
                continue
            if name == _KEEP_OUTS:
                yield name, self._keep_outs(raw, below[name])
                continue
            try:
                value = _converted(raw, hints[key], self._file.parent)
            except _WrongType as wrong:
                text = f"{shown(raw)} is not allowed; allowed is {wrong}"
            else:
                text = why_out_of_range(owner, key, value)
                if not text and self._is_narrowed:
                    text = why_wider(name, value, below[name])
                if not text:
                    yield name, value
                    continue
            self._report(name, f"{text}; {_instead(name, below)}")

    def _keep_outs(
        self, raw: object, below: tuple[KeepOutSettings, ...]
    ) -> tuple[KeepOutSettings, ...]:
        """Those below and those of this file that are right."""
        boxes = list(below)
        if not isinstance(raw, list | dict):
            text = f"{shown(raw)} is not allowed; allowed is a list, [{_BOX}, …]"
            self._report(_KEEP_OUTS, f"{text}; correct it")
            return below
        for i, item in enumerate(raw if isinstance(raw, list) else [raw]):
            box, key, text = _keep_out(item)
            if box is not None and box not in boxes:
                boxes.append(box)
                if len(boxes) == MAX_KEEP_OUTS + 1:
                    key, text = "", f"too many; allowed are {MAX_KEEP_OUTS} of all layers together"
            if text:
                label = keep_out_label(i, item.get("name") if isinstance(item, dict) else None)
                text = f"{label}{f', {key}' if key else ''}: {text}; correct it"
                place = f"{_KEEP_OUTS}.{i}"
                self._report(_KEEP_OUTS, text, (f"{place}.{key}", place, f"{_KEEP_OUTS}.{key}"))
        return tuple(boxes[:MAX_KEEP_OUTS])

    def _report_pair(self, values: Mapping[str, Any], low: str, high: str) -> None:
        names = _with_margin(low, high)
        if {finding.setting for finding in self.found} & set(names):
            return  # one of them is not used anyway
        here = next((name for name in names if name in self._line_table()), low)
        below = {name: value for name, _, value in named_values(self._below)}
        text = f"{'' if here == low else f'{low} = '}{why_not_below(values, low, high)}"
        self._report(here, f"{text}; {_instead(here, below)}")

    def _report_unknown(self, name: str, key: str, known: Sequence[str]) -> None:
        end = _CORRECT if bears_on_motion(name) else "it is left out"
        self._report(name, f"unknown{_did_you_mean(key, known)}; {end}")

    def _report(self, name: str, text: str, places: Sequence[str] = ()) -> None:
        """Note a finding; its line is that of the first of these places with one, or its own."""
        lines = (self._line(place) for place in (*places, name))
        line = next((line for line in lines if line is not None), None)
        self.found.append(SettingsFinding(_short(name), text, self._file, line))

    def _line(self, name: str) -> int | None:
        return self._line_table().get(name)

    def _line_table(self) -> Mapping[str, int]:
        if self._lines is None:
            self._lines = lines_of(self._text)
        return self._lines


def _table_names() -> list[str]:
    return [field.name for field in fields(Settings) if is_dataclass(_hint_of(field.name))]


def _hint_of(name: str) -> object:
    return get_type_hints(Settings)[name]


def _is_there(file: Path) -> bool:
    try:
        return file.exists()
    except OSError:  # its folder may not be looked into: reading it says so
        return True


def _read(file: Path) -> str:
    if _is_there(file) and not file.is_file():
        reason = "not a file; give the name of a .toml file"
        raise ConfigError("settings file", str(file), reason)
    try:
        with file.open("rb") as stream:
            data = stream.read(_MAX_BYTES + 1)
    except OSError as error:
        reason = f"cannot be read: {error.strerror or error}; check the name and the permissions"
        raise ConfigError("settings file", str(file), reason) from error
    if len(data) > _MAX_BYTES:
        reason = f"larger than {_MAX_BYTES} bytes; this is no settings file"
        raise ConfigError("settings file", str(file), reason)
    try:
        # A byte order mark is what Windows' editor puts in front.
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = error.object.count(b"\n", 0, error.start) + 1
        reason = f"line {line}: not UTF-8; save the file in that encoding"
        raise ConfigError("settings file", str(file), reason) from error


def _parse(file: Path, text: str) -> dict[str, Any]:
    try:
        return tomllib.loads(text)
    except RecursionError as error:
        reason = "nested too deeply; tables and lists of numbers are enough"
        raise ConfigError("settings file", str(file), reason) from error
    except ValueError as error:  # TOMLDecodeError is one; numbers with too many digits another
        message = str(error).splitlines()[0]
        at = _LINE_IN_MESSAGE.search(message)
        line = int(at[1]) if at else text.rstrip("\n").count("\n") + 1 if _AT_END in message else 1
        cause = _LINE_IN_MESSAGE.sub("", message).replace(_AT_END, "").strip()
        reason = f"line {line}: not TOML: {cause}; correct that line"
        raise ConfigError("settings file", str(file), reason) from error


def _converted(raw: Any, hint: Any, folder: Path) -> Any:  # noqa: ANN401 - TOML in, settings out
    """A TOML value as its setting's type.

    Raises:
        _WrongType: it is of another kind.
    """
    if get_origin(hint) is tuple:
        kinds = get_args(hint)
        if not isinstance(raw, list) or len(raw) != len(kinds):
            raise _WrongType(f"a list of {len(kinds)} numbers, [{', '.join(['1.0'] * len(kinds))}]")
        return tuple(_converted(item, kind, folder) for item, kind in zip(raw, kinds, strict=True))
    if isinstance(hint, UnionType):
        return _file_path(raw, folder)
    if issubclass(hint, Enum):
        return _member(raw, hint)
    if hint is float:
        return _number(raw)
    if type(raw) is not hint:
        raise _WrongType(_KIND_WORDS[hint])
    return raw


_KIND_WORDS: Final[Mapping[type, str]] = {
    int: "a whole number",
    bool: "true or false",
    str: 'a text in quotes, "…"',
}


def _keep_out(raw: object) -> tuple[KeepOutSettings | None, str, str]:
    """A box, or None, the key that is wrong in it (empty for the whole) and what is wrong."""
    if not isinstance(raw, dict):
        return None, "", f"{shown(raw)} is not allowed; allowed is {_BOX}"
    hints = get_type_hints(KeepOutSettings)
    for key in raw:
        if key not in hints:
            return None, _short(key), f"unknown{_did_you_mean(key, list(hints))}; a box is {_BOX}"
    values: dict[str, Any] = {}
    for key, hint in hints.items():
        if key not in raw:
            return None, key, f"missing; a box is {_BOX}"
        try:
            values[key] = _converted(raw[key], hint, Path())
        except _WrongType:
            allowed = _KIND_WORDS[str] if hint is str else "a list of 3 numbers, mm: [x, y, z]"
            return None, key, f"{shown(raw[key])} is not allowed; allowed is {allowed}"
    box = KeepOutSettings(**values)
    key, text = wrong_in_keep_out(box, RANGES[RobotSettings, "keep_outs"])
    return None if text else box, key, text


def _number(raw: object) -> float:
    if isinstance(raw, bool) or not isinstance(raw, int | float):
        raise _WrongType("a number")
    try:
        number = float(raw)
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        raise _WrongType("a finite number")
    return number


def _member(raw: object, kind: type[Enum]) -> Enum:
    for member in kind:
        if member.value == raw:
            return member
    raise _WrongType(" or ".join(f'"{member.value}"' for member in kind))


def _file_path(raw: object, folder: Path) -> Path | None:
    """A file's name, beside the settings file unless it is absolute; empty for none."""
    if not isinstance(raw, str) or "\0" in raw:
        raise _WrongType('the name of a file in quotes, or "" for none')
    return folder / Path(raw) if raw else None


def _with_margin(low: str, high: str) -> tuple[str, ...]:
    """The names of a pair, and of the margin that must fit between if there is one."""
    return (low, high, MARGINS[low]) if low in MARGINS else (low, high)


def _instead(name: str, below: Mapping[str, Any]) -> str:
    """What is used instead of a wrong value, or would be without it."""
    used = f"{shown(_plain(below[name]))} is used"
    return f"{_CORRECT}: then {used}" if bears_on_motion(name) else used


def _plain(value: object) -> object:
    """A setting as it would stand in the file."""
    if isinstance(value, Enum):
        return value.value
    return "" if value is None else str(value) if isinstance(value, Path) else value


def _did_you_mean(key: str, known: Sequence[str]) -> str:
    near = difflib.get_close_matches(key[:60], known, n=1)
    return f" (did you mean {near[0]}?)" if near else ""


def _short(value: object) -> str:
    text = value if isinstance(value, str) and value.isprintable() else repr(value)
    return text if len(text) <= 60 else f"{text[:57]}…"
