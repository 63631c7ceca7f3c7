"""Settings as the window sees and changes them: checked as a whole, then written, then used.

A change is tried first by the reader of the files itself, on the content that the user's file would
have. Only what it takes without a word is written; so no limit of a lower layer is ever widened,
and the next start finds what the window showed.
"""

import threading
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final, get_type_hints

from gestureapp.clock import Clock, monotonic
from gestureapp.config import Settings
from gestureapp.errors import ConfigError
from gestureapp.settings_check import (
    PIN_KEY,
    SettingsFinding,
    bears_on_motion,
    check_settings,
    named_values,
    why_out_of_range,
)
from gestureapp.settings_edit import NEW_FILE, as_toml, edited, replace_settings
from gestureapp.settings_file import read_layers
from gestureapp.settings_narrowing import narrowed_words
from gestureapp.settings_origins import SettingsLayers
from gestureapp.settings_source import bytes_if_there
from gestureapp.settings_text import about, allowed, choices
from gestureapp.settings_values import WrongType, converted, plain
from gestureapp.settings_words import shown, unit_of
from gestureapp.setup.lock import Lock, hash_pin, why_no_pin
from gestureapp.setup.settings_changes import (
    LATER,
    changed,
    new_findings,
    told,
    values_of,
    waits,
    with_values,
)
from gestureapp.setup.site_values import LockView, SettingRow

LOCKED: Final = "locked: give the PIN first"
_NOT_KEPT: Final = Path("this run only")
"""The user's layer of a cell that has no files, as a demo."""


@dataclass(frozen=True, slots=True)
class _Trial:
    """What a change would come to: wrong by name, and the rest where nothing is."""

    wrong: Mapping[str, str]
    old: bytes | None = None
    new: bytes = b""
    layers: SettingsLayers | None = None
    settings: Settings | None = None


class SettingsDesk:
    """The settings of a running cell. Any thread; a change takes some 10 ms.

    Args:
        files: The site's file, then the user's, which is the one written to; none in a demo, whose
            changes hold for this run only.
        named: The file named on the command line; what it sets cannot be changed here.
        settings: As the cell was started with them. What differs from the files was given at the
            start by something else, and cannot be changed here either; a demo's can.
        use: Makes the cell use changed settings once nothing may move.
        check: Raises ConfigError when the cell could not use them as a whole.
        tell: Puts a line among the events of the session.
        clock: Monotonic seconds, for the PIN.
        wall_clock: Seconds since the epoch, for the names of backups.

    Raises:
        ConfigError: a file cannot be read, is not UTF-8, is not TOML, or has another schema.
    """

    def __init__(
        self,
        files: Sequence[Path],
        named: Path | None,
        settings: Settings,
        use: Callable[[Settings], None],
        check: Callable[[Settings], None] = lambda settings: None,
        tell: Callable[[str], None] = lambda text: None,
        clock: Clock = monotonic,
        wall_clock: Clock = time.time,
    ) -> None:
        self._files = tuple(files) or (Path("no site file"), _NOT_KEPT)
        self._user = self._files[-1]
        self._memory: dict[Path, bytes] = {} if files else {self._user: NEW_FILE.encode()}
        self._named, self._use, self._check, self._tell = named, use, check, tell
        self._wall_clock = wall_clock
        self._mutex = threading.Lock()
        self._contents = self._all_contents()
        self._layers = self._read()
        self._below = values_of(read_layers(self._files[:-1], None, self._content).settings)
        self._used = self._started = settings
        self._unkept: frozenset[str] = frozenset()
        pin = self._layers.pin
        self._lock = Lock(clock, pin.pin_hash, str(pin.origin))
        self._rows = self._drawn()

    @property
    def lock(self) -> LockView:
        """The PIN as the window shows it."""
        return self._lock.view

    @property
    def findings(self) -> tuple[SettingsFinding, ...]:
        """What is wrong in the files, as last read."""
        return self._layers.findings

    def settings(self) -> tuple[SettingRow, ...]:
        """Every setting with value, meaning, range and origin, in the order of the file."""
        if self._lock.is_open:
            return self._rows
        return tuple(replace(row, is_locked=bears_on_motion(row.name)) for row in self._rows)

    def check_settings(self, changes: Mapping[str, object]) -> Mapping[str, str]:
        """What ``change_settings`` would say to these; nothing is changed, and no file touched."""
        with self._mutex:
            return self._tried(self._real(changes)).wrong

    def change_settings(self, changes: Mapping[str, object]) -> Mapping[str, str]:
        """Change these, write them to the user's file, and use them once nothing may move.

        Args:
            changes: New values by dotted name, as a settings file would hold them; None takes a
                value out of the user's file, so that the layers below hold.

        Returns:
            What is wrong, by name; empty when all were taken. Otherwise nothing at all is changed.
        """
        with self._mutex:
            changes = self._real(changes)
            trial = self._tried(changes) if changes else _Trial({})
            if trial.layers is None or trial.settings is None:
                return trial.wrong
            try:
                self._write(self._user, trial.old, trial.new)
            except ConfigError as error:
                return dict.fromkeys(changes, _in_words(error))
            before, self._layers, self._used = self._used, trial.layers, trial.settings
            self._unkept -= changes.keys()
            self._contents = self._all_contents()
            self._rows = self._drawn()
            for line in told(before, self._used):
                self._tell(line)
            # Under the mutex: what was written last is also what is used last.
            try:
                self._use(self._used)
            except ConfigError as error:
                why = f"written, but used from the next start on only: {error.reason}"
                return dict.fromkeys(changes, why)
        return {}

    def use_sensors(self, changes: Mapping[str, object]) -> Mapping[str, str]:
        """Have other sensors read, and remember them; what cannot be written is used all the same.

        Args:
            changes: Of the tables ``left`` and ``right``, by dotted name.

        Returns:
            Why the next start will not find them, by name; empty when it will.

        Raises:
            ConfigError: the cell cannot use them; nothing is changed then.
        """
        wrong = self.change_settings(changes)
        if not wrong:
            return {}
        with self._mutex:
            used = with_values(self._used, changes)
            self._use(used)
            self._used = used
            kept = values_of(self._layers.settings)
            unkept = {name for name, value in changes.items() if kept[name] != value}
            self._unkept = (self._unkept - changes.keys()) | unkept
            self._rows = self._drawn()
        return wrong if unkept else {}

    def open_lock(self, pin: str) -> None:
        """Give the PIN, which takes some 50 ms; what bears on motion can be changed then."""
        self._lock.open(pin)

    def close_lock(self) -> None:
        """Lock them again."""
        self._lock.close()

    def set_pin(self, pin: str) -> str:
        """Set the PIN, or take it away with an empty one; only while open.

        It goes into the site's file where that can be written, else into the user's. Takes some
        50 ms.

        Returns:
            Why not, or empty.
        """
        if wrong := self.why_not_pin(pin):
            return wrong
        pin_hash = hash_pin(pin) if pin else ""
        with self._mutex:
            if wrong := self._keep_pin(pin_hash or None):
                self._lock.say(wrong)
                return wrong
            self._contents, self._layers = self._all_contents(), self._read()
            self._lock.change(pin_hash, str(self._layers.pin.origin))
        self._tell(f"settings: PIN {'set' if pin else 'taken away'} by the window")
        return ""

    def why_not_pin(self, pin: str) -> str:
        """Why ``set_pin`` would not try to keep this one, told at once; empty when it would."""
        if not self._lock.is_open:
            return "Give the PIN that is set first."
        return why_no_pin(pin) if pin else ""

    def _keep_pin(self, pin_hash: str | None) -> str:
        there = self._layers.pin.origin.file
        places = self._files if there is None else (there,)
        why = ""
        for file in places if pin_hash or there else ():
            if self._memory and file not in self._memory:
                continue
            try:
                old = self._content(file)
                self._write(file, old, edited(file, old, {PIN_KEY: pin_hash}))
            except ConfigError as error:
                why = _in_words(error)
            else:
                return ""
        return why

    def _real(self, changes: Mapping[str, object]) -> dict[str, object]:
        """Without what is as it was, and will be so at the next start."""
        values = {name: plain(value) for name, _, value in named_values(self._used)}
        return {
            name: value
            for name, value in changes.items()
            if value is None
            or name not in values
            or name in self._unkept
            or as_toml(value) != as_toml(values[name])
        }

    def _tried(self, changes: Mapping[str, object]) -> _Trial:
        rows = {row.name: row for row in self.settings()}
        wrong = {
            name: text for name, new in changes.items() if (text := self._why(name, new, rows))
        }
        if wrong:
            return _Trial(wrong)
        try:
            self._refresh()
            old = self._content(self._user)
            new = edited(self._user, old, changes)
            layers = self._read({self._user: new})
        except ConfigError as error:
            return _Trial(dict.fromkeys(changes, _in_words(error)))
        wrong = new_findings(self._layers.findings, layers.findings)
        wrong |= self._not_taken(changes, layers)
        settings = changed(self._used, self._layers.settings, layers.settings, changes)
        wrong |= new_findings(check_settings(self._used), check_settings(settings))
        if not wrong:
            try:
                self._check(settings)
            except ConfigError as error:
                wrong = dict.fromkeys(changes, error.reason)
        return _Trial(wrong) if wrong else _Trial({}, old, new, layers, settings)

    def _why(self, name: str, new: object, rows: Mapping[str, SettingRow]) -> str:
        """What is wrong with one new value by itself; empty when nothing is."""
        if name not in rows:
            return "there is no such setting"
        if rows[name].fixed or rows[name].is_locked:
            return rows[name].fixed or LOCKED
        owner = next(owner for one, owner, _ in named_values(self._used) if one == name)
        key = name.partition(".")[2]
        if new is None or name == "robot.keep_outs":
            return ""
        raw = as_toml(new)
        try:
            value = converted(raw, get_type_hints(owner)[key], self._user.parent)
        except WrongType as wrong:
            return f"{shown(raw)} is not allowed; allowed is {wrong}"
        return why_out_of_range(owner, key, value)

    def _not_taken(self, changes: Mapping[str, object], layers: SettingsLayers) -> dict[str, str]:
        """Boxes that a layer below has cannot be taken away."""
        wanted = changes.get("robot.keep_outs")
        if not isinstance(wanted, list | tuple):
            return {}
        if len(layers.settings.robot.keep_outs) <= len(wanted):
            return {}
        return {"robot.keep_outs": "the boxes of the site's file stay; a later file only adds some"}

    def _refresh(self) -> None:
        """Take over what else was written meanwhile, unless it bears on motion.

        Raises:
            ConfigError: it does, or a file cannot be read.
        """
        contents = self._all_contents()
        if contents == self._contents:
            return
        now = self._read()
        before, after = values_of(self._layers.settings), values_of(now.settings)
        strange = [n for n in after if after[n] != before[n] and bears_on_motion(n)]
        if strange:
            reason = (
                f"{', '.join(strange)} was changed by another program; start the application again "
                "to use that"
            )
            raise ConfigError("settings file", str(self._user), reason)
        self._used = changed(self._used, self._layers.settings, now.settings)
        self._layers, self._contents = now, contents
        self._rows = self._drawn()

    def _all_contents(self) -> tuple[bytes | None, ...]:
        """Of every file: what is the same need not be read into settings again."""
        named = () if self._named is None else (bytes_if_there(self._named),)
        return (*(self._content(file) for file in self._files), *named)

    def _read(self, instead: Mapping[Path, bytes] | None = None) -> SettingsLayers:
        def content(file: Path) -> bytes | None:
            return instead[file] if instead and file in instead else self._content(file)

        return read_layers(self._files, self._named, content)

    def _content(self, file: Path) -> bytes | None:
        return self._memory.get(file) if self._memory else bytes_if_there(file)

    def _write(self, file: Path, old: bytes | None, new: bytes) -> None:
        if self._memory:
            self._memory[file] = new
        else:
            replace_settings(file, old, new, self._wall_clock)

    def _drawn(self) -> tuple[SettingRow, ...]:
        from_files = values_of(self._layers.settings)
        return tuple(
            self._row(name, owner, value, value != from_files[name])
            for name, owner, value in named_values(self._used)
        )

    def _row(self, name: str, owner: type, value: object, is_given: bool) -> SettingRow:
        key = name.partition(".")[2]
        origin = self._layers.origins[name]
        fixed, left = "", narrowed_words(name, self._below[name])
        if origin.is_named:
            fixed = f"set by {origin}; change it there"
        elif is_given and not self._memory and name not in self._unkept:
            fixed = "given when the application was started; it cannot be changed here"
        return SettingRow(
            name=name,
            about=about(owner, key),
            value=plain(value),
            unit=unit_of(key),
            allowed="; here ".join(text for text in (allowed(owner, key), left) if text),
            origin=self._origin_words(name, is_given),
            is_locked=False,
            choices=choices(owner, key),
            fixed=fixed,
        )

    def _origin_words(self, name: str, is_given: bool) -> str:
        if name in self._unkept:
            return str(_NOT_KEPT)
        words = "given at the start" if is_given else str(self._layers.origins[name])
        is_later = waits(name) and values_of(self._used)[name] != values_of(self._started)[name]
        return f"{words}{LATER}" if is_later else words


def _in_words(error: ConfigError) -> str:
    return f"{error.value}: {error.reason}"
