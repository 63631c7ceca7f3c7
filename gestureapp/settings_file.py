"""Settings from TOML files in layers: built-in < site file < user file < the file named by hand.

What is wrong is reported with its file and line. Where it bears on motion, nothing is started: a
limit that was asked for must not be missing unseen. Elsewhere the layer below holds. A file that is
no TOML at all stops the start, too.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import fields, is_dataclass, replace
from pathlib import Path
from typing import Any, Final, get_type_hints

from gestureapp.config import SCHEMA_VERSION, KeepOutSettings, Settings
from gestureapp.errors import ConfigError, SettingsRefused
from gestureapp.settings_check import (
    LOCK_TABLE,
    MARGINS,
    MAX_KEEP_OUTS,
    PIN_KEY,
    SettingsFinding,
    bad_pairs,
    bears_on_motion,
    check_settings,
    keep_out_label,
    named_values,
    why_not_below,
    why_out_of_range,
)
from gestureapp.settings_lines import lines_of
from gestureapp.settings_narrowing import FREE_OF_BUILT_IN, why_wider
from gestureapp.settings_origins import BUILT_IN, Origin, PinEntry, SettingsLayers
from gestureapp.settings_source import bytes_if_there, parsed, read_bytes, text_of
from gestureapp.settings_text import default_settings_text, settings_text
from gestureapp.settings_values import (
    BOX,
    WrongType,
    converted,
    did_you_mean,
    keep_out_of,
    plain,
    short,
)
from gestureapp.settings_words import shown

__all__ = [
    "SettingsFinding",
    "check_settings",
    "default_settings_text",
    "load_settings",
    "read_layers",
    "read_settings",
    "settings_text",
]

SCHEMA_KEY: Final = "schema"
_KEEP_OUTS: Final = "robot.keep_outs"
DAMAGED_PIN: Final = "damaged"
"""Stands for what is no hash."""
_CORRECT: Final = "correct it, or take it out"


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
    layers = read_layers(files, named)
    return layers.settings, list(layers.findings)


def read_layers(
    files: Sequence[Path],
    named: Path | None = None,
    read: Callable[[Path], bytes | None] = bytes_if_there,
) -> SettingsLayers:
    """Read the layers as ``read_settings`` does, and say where every value comes from.

    Args:
        files: As for ``read_settings``.
        named: As for ``read_settings``.
        read: What is in a file, None where there is none; another than the disk's to try a change
            before it is written.

    Raises:
        ConfigError: a file cannot be read, is not UTF-8, is not TOML, or has another schema.
    """
    settings = Settings()
    layers = SettingsLayers(settings, origins={n: BUILT_IN for n, _, _ in named_values(settings)})
    for index, file in enumerate(files):
        if (data := read(file)) is not None:
            layers = _laid_over(_Layer(Origin(file), data, layers, is_narrowed=index > 0))
    if named is not None:
        top, data = Origin(named, is_named=True), read_bytes(named)
        layers = _laid_over(_Layer(top, data, layers, is_narrowed=True))
    return layers


def _laid_over(layer: "_Layer") -> SettingsLayers:
    settings = layer.merged()
    found = sorted(layer.found, key=lambda finding: finding.line or 0)
    below = layer.below
    return SettingsLayers(
        settings, (*below.findings, *found), {**below.origins, **layer.origins()}, layer.pin
    )


class _Layer:
    """One file being laid over the settings below it.

    Attributes:
        below: What the layers below gave.
        found: What is wrong in this one.
        pin: The site's, theirs before its own.
    """

    def __init__(
        self, place: Origin, data: bytes, below: SettingsLayers, is_narrowed: bool
    ) -> None:
        assert place.file is not None
        self.found: list[SettingsFinding] = []
        self.below = below
        self.pin = below.pin
        self._place = place
        self._file = place.file
        self._below = below.settings
        self._is_narrowed = is_narrowed
        self._text = text_of(self._file, data)
        self._document = parsed(self._file, self._text)
        self._lines: Mapping[str, int] | None = None
        self._own: set[str] = set()

    def merged(self) -> Settings:
        """The settings below with what is right in this file."""
        self._check_schema()
        below = {name: value for name, _, value in named_values(self._below)}
        accepted = dict(self._accepted(below))
        values = below | accepted
        for low, high in bad_pairs(values):
            self._report_pair(values, low, high)
        self._own = set(accepted)
        while bad := bad_pairs(values):  # a margin that is taken back may be too much for another
            for low, high in bad:
                values |= {name: below[name] for name in _with_margin(low, high)}
                self._own -= set(_with_margin(low, high))
        tables = {}
        for table in _table_names():
            start = f"{table}."
            own = {name[len(start) :]: v for name, v in values.items() if name.startswith(start)}
            tables[table] = replace(getattr(self._below, table), **own)
        return replace(self._below, **tables)

    def origins(self) -> Mapping[str, Origin]:
        """Of the values that this file gave; after ``merged``."""
        return {name: replace(self._place, line=self._line(name)) for name in self._own}

    def _check_schema(self) -> None:
        version = self._document.get(SCHEMA_KEY)
        if version is None:
            text = f"missing; write {SCHEMA_KEY} = {SCHEMA_VERSION} at the top (taken as that)"
            self.found.append(SettingsFinding(SCHEMA_KEY, text, self._file, 1))
        elif isinstance(version, bool) or version != SCHEMA_VERSION:
            where = f"{self._file}, line {self._line(SCHEMA_KEY)}"
            reason = f"{where}: this application reads schema {SCHEMA_VERSION}; update one of them"
            raise ConfigError(SCHEMA_KEY, short(version), reason)

    def _accepted(self, below: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
        known = [SCHEMA_KEY, *_table_names(), LOCK_TABLE]
        for key, table in self._document.items():
            if key == SCHEMA_KEY:
                continue
            if key not in known:
                self._report_unknown(key, key, known)
            elif not isinstance(table, dict):
                self._report(key, "must be a table", f"write [{key}] on a line of its own")
                if key == LOCK_TABLE:
                    self._take_pin({PIN_KEY.partition(".")[2]: table})
            elif key == LOCK_TABLE:
                self._take_pin(table)
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
                value = converted(raw, hints[key], self._file.parent)
            except WrongType as wrong:
                text = f"{shown(raw)} is not allowed; allowed is {wrong}"
            else:
                text = why_out_of_range(owner, key, value)
                if not text and self._is_narrowed and not self._is_free(name):
                    text = why_wider(name, value, below[name])
                if not text:
                    yield name, value
                    continue
            self._report(name, text, _instead(name, below))

    def _is_free(self, name: str) -> bool:
        """Whether no layer below has said anything of a setting that is the site's to narrow."""
        return name in FREE_OF_BUILT_IN and self.below.origins[name] == BUILT_IN

    def _take_pin(self, table: Mapping[str, Any]) -> None:
        for key, raw in table.items():
            name = f"{LOCK_TABLE}.{key}"
            if name != PIN_KEY:
                self._report_unknown(name, key, [PIN_KEY.partition(".")[2]])
            elif self._place.is_named or self.below.pin.pin_hash:
                whose = "the site's or the user's file" if self._place.is_named else "the site's"
                self._report(name, f"has no effect here: the PIN is that of {whose}", "take it out")
            else:
                # What is no hash counts as a PIN that nobody knows, not as none.
                text = raw if isinstance(raw, str) and raw else DAMAGED_PIN
                self.pin = PinEntry(text, replace(self._place, line=self._line(name)))

    def _keep_outs(
        self, raw: object, below: tuple[KeepOutSettings, ...]
    ) -> tuple[KeepOutSettings, ...]:
        """Those below and those of this file that are right."""
        boxes = list(below)
        if not isinstance(raw, list | dict):
            text = f"{shown(raw)} is not allowed; allowed is a list, [{BOX}, …]"
            self._report(_KEEP_OUTS, text, "correct it")
            return below
        for i, item in enumerate(raw if isinstance(raw, list) else [raw]):
            box, key, text = keep_out_of(item)
            if box is not None and box not in boxes:
                boxes.append(box)
                if len(boxes) == MAX_KEEP_OUTS + 1:
                    key, text = "", f"too many; allowed are {MAX_KEEP_OUTS} of all layers together"
            if text:
                label = keep_out_label(i, item.get("name") if isinstance(item, dict) else None)
                text = f"{label}{f', {key}' if key else ''}: {text}"
                place = f"{_KEEP_OUTS}.{i}"
                places = (f"{place}.{key}", place, f"{_KEEP_OUTS}.{key}")
                self._report(_KEEP_OUTS, text, "correct it", places)
        return tuple(boxes[:MAX_KEEP_OUTS])

    def _report_pair(self, values: Mapping[str, Any], low: str, high: str) -> None:
        names = _with_margin(low, high)
        if {finding.setting for finding in self.found} & set(names):
            return  # one of them is not used anyway
        here = next((name for name in names if name in self._line_table()), low)
        below = {name: value for name, _, value in named_values(self._below)}
        text = f"{'' if here == low else f'{low} = '}{why_not_below(values, low, high)}"
        self._report(here, text, _instead(here, below))

    def _report_unknown(self, name: str, key: str, known: Sequence[str]) -> None:
        end = _CORRECT if bears_on_motion(name) else "it is left out"
        self._report(name, f"unknown{did_you_mean(key, known)}", end)

    def _report(self, name: str, cause: str, remedy: str, places: Sequence[str] = ()) -> None:
        """Note a finding; its line is that of the first of these places with one, or its own."""
        lines = (self._line(place) for place in (*places, name))
        line = next((line for line in lines if line is not None), None)
        text = f"{cause}; {remedy}"
        self.found.append(SettingsFinding(short(name), text, self._file, line, cause))

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


def _with_margin(low: str, high: str) -> tuple[str, ...]:
    """The names of a pair, and of the margin that must fit between if there is one."""
    return (low, high, MARGINS[low]) if low in MARGINS else (low, high)


def _instead(name: str, below: Mapping[str, Any]) -> str:
    """What is used instead of a wrong value, or would be without it."""
    used = f"{shown(plain(below[name]))} is used"
    return f"{_CORRECT}: then {used}" if bears_on_motion(name) else used
