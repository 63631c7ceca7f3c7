"""Settings from TOML files in layers: built-in < site file < user file < the file named by hand.

A wrong value never stops the application: it is reported with its file and line, and the layer
below holds. A file that is no TOML at all does stop it, in one line.
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
from gestureapp.errors import ConfigError
from gestureapp.settings_check import (
    SettingsFinding,
    bad_pairs,
    check_settings,
    named_values,
    shown,
    why_not_below,
    why_out_of_range,
    why_wider,
)
from gestureapp.settings_text import default_settings_text, settings_text

__all__ = [
    "SettingsFinding",
    "check_settings",
    "default_settings_text",
    "load_settings",
    "settings_text",
]

SCHEMA_KEY: Final = "schema"
_KEEP_OUTS: Final = "robot.keep_outs"
_MAX_BYTES: Final = 100_000
"""A settings file has some thousand bytes; more is a file taken by mistake."""
_MAX_STATEMENT_LINES: Final = 50
_LINE_IN_MESSAGE: Final = re.compile(r"\(at line (\d+), column \d+\)")
_AT_END: Final = "(at end of document)"


class _WrongType(Exception):
    """A value is of another kind than its setting; the text says what is allowed."""


def load_settings(
    files: Sequence[Path], named: Path | None = None
) -> tuple[Settings, list[SettingsFinding]]:
    """Read the layers, lowest first, and say what was wrong in them.

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
        found += layer.found
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
            values |= {low: below[low], high: below[high]}
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
                self._report(key, f"unknown{_did_you_mean(key, known)}; it is left out")
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
                self._report(name, f"unknown{_did_you_mean(key, list(hints))}; it is left out")
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
            self._report(name, f"{text}; {shown(_plain(below[name]))} is used")

    def _keep_outs(
        self, raw: object, below: tuple[KeepOutSettings, ...]
    ) -> tuple[KeepOutSettings, ...]:
        """Those below and those of this file.

        Raises:
            ConfigError: one is wrong. Left out, the robot would go where somebody forbade it.
        """
        boxes = list(below)
        for i, item in enumerate(raw if isinstance(raw, list) else [raw]):
            try:
                box = _keep_out(item, self._file.parent)
            except _WrongType as wrong:
                text = f"{shown(item)} is not allowed; allowed is {wrong}"
            else:
                boxes += [box] if box not in boxes else []
                text = why_out_of_range(RobotSettings, "keep_outs", tuple(boxes))
            if text:
                line = self._line(f"{_KEEP_OUTS}.{i}") or self._line(_KEEP_OUTS)
                where = self._file if line is None else f"{self._file}, line {line}"
                raise ConfigError(_KEEP_OUTS, "as given", f"{where}: {text}")
        return tuple(boxes)

    def _report_pair(self, values: Mapping[str, Any], low: str, high: str) -> None:
        here = low if low in self._line_table() else high
        below = {name: value for name, _, value in named_values(self._below)}
        kept = f"{shown(below[low])} and {shown(below[high])} are used"
        self._report(here, f"{low} = {why_not_below(values, low, high)}; {kept}")

    def _report(self, name: str, text: str) -> None:
        self.found.append(SettingsFinding(_short(name), text, self._file, self._line(name)))

    def _line(self, name: str) -> int | None:
        return self._line_table().get(name)

    def _line_table(self) -> Mapping[str, int]:
        if self._lines is None:
            self._lines = _lines_of(self._text)
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


def _keep_out(raw: object, folder: Path) -> KeepOutSettings:
    hints = get_type_hints(KeepOutSettings)
    if not isinstance(raw, dict) or set(raw) != set(hints):
        raise _WrongType('name = "…", low_mm = [x, y, z] and high_mm = [x, y, z]')
    return KeepOutSettings(**{key: _converted(raw[key], hints[key], folder) for key in hints})


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


def _lines_of(text: str) -> Mapping[str, int]:
    """The line of every key, by dotted name, from 1.

    The parser gives no lines, but any statement of a valid file is a valid file by itself: lines
    are added until they parse, and the keys found there stand on the first of them. After a
    statement of absurd length the table just ends.
    """
    lines: dict[str, int] = {}
    table: tuple[str, ...] = ()
    n_of: dict[tuple[str, ...], int] = {}
    statement, start = "", 1
    for number, line in enumerate(text.split("\n"), 1):
        if not statement:
            start = number
        statement += line + "\n"
        try:
            found = tomllib.loads(statement)
        except ValueError:
            if number - start >= _MAX_STATEMENT_LINES:
                return lines
            continue
        paths = list(_paths(found))
        if statement.lstrip().startswith("["):
            table = paths[0] if paths else ()
            if statement.lstrip().startswith("[["):
                n_of[table] = n_of.get(table, -1) + 1
                table = (*table, str(n_of[table]))
            paths = [()]
        statement = ""
        for path in paths:
            _note(lines, (*table, *path), start)
    return lines


def _note(lines: dict[str, int], path: Sequence[str], line: int) -> None:
    for n in range(1, len(path) + 1):
        lines.setdefault(".".join(path[:n]), line)


def _paths(found: Mapping[str, Any]) -> Iterator[tuple[str, ...]]:
    """The dotted paths to everything in a parsed statement."""
    for key, value in found.items():
        inner = value[-1] if isinstance(value, list) and value else value
        if isinstance(inner, dict) and inner:
            for path in _paths(inner):
                yield (key, *path)
        else:
            yield (key,)
