"""Changing a settings file as a careful person would: comments and order stay, nothing gets lost.

The old file is kept among ten backups beside it. The new one is complete in a file of its own
before it takes the name: after a crash at any moment there is the old file or the new one.
"""

import datetime
import re
import time
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from gestureapp.clock import Clock
from gestureapp.config import SCHEMA_VERSION
from gestureapp.errors import ConfigError, RecordingError
from gestureapp.recognition.files import mode_of, write_atomically
from gestureapp.settings_source import MAX_BYTES, bytes_if_there, parsed, text_of
from gestureapp.settings_values import plain

BACKUP_FOLDER: Final = "backups"
N_BACKUPS: Final = 10
_BOM: Final = b"\xef\xbb\xbf"
NEW_FILE: Final = f"schema = {SCHEMA_VERSION}\n"
"""What a settings file begins with."""


def edited(file: Path, old: bytes | None, changes: Mapping[str, object]) -> bytes:
    """The content of a settings file with these changes in it. Pure.

    Args:
        file: Its name, for messages.
        old: Its content; None when it is not there.
        changes: By dotted name; as in ``Settings`` or as in the file. None takes the key out.

    Raises:
        ConfigError: it is damaged, or made such that the change cannot be put into it.
    """
    text = NEW_FILE if old is None else text_of(file, old)
    wanted = parsed(file, text)  # the reader's own parser decides whether the file is damaged
    values = {name: as_toml(value) for name, value in changes.items()}
    # Not before it is needed: no start waits for it.
    from gestureapp.settings_document import UnfitLayout, with_values

    try:
        new = with_values(text, values)
    except UnfitLayout as error:
        raise _not_changed(file) from error
    if "\r\n" in text:
        new = new.replace("\r\n", "\n").replace("\n", "\r\n")
    for name, value in values.items():
        _put_plain(wanted, name, value)
    if _meaning(new) != _without_empty(wanted):
        raise _not_changed(file)
    mark = _BOM if old is not None and old.startswith(_BOM) else b""
    return mark + _content(file, new)


def _content(file: Path, text: str) -> bytes:
    """What the reader of settings files takes, and no other."""
    try:
        content = text.encode()
    except UnicodeEncodeError as error:
        reason = "a text with half a character in it cannot be written; type it anew"
        raise ConfigError("settings file", str(file), reason) from error
    if len(content) > MAX_BYTES - len(_BOM):
        reason = f"would become larger than {MAX_BYTES} bytes; take comments out of it first"
        raise ConfigError("settings file", str(file), reason)
    return content


def replace_settings(
    file: Path, old: bytes | None, new: bytes, wall_clock: Clock = time.time
) -> None:
    """Put new content in the place of what was read before, and keep that as a backup.

    Raises:
        ConfigError: the file is no longer what was read, or cannot be written. It is as it was.
    """
    if new == old:
        return
    target = file.resolve()  # behind a link the file itself is replaced, not the link
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        if old is not None:
            _keep(target, old, wall_clock())
        if bytes_if_there(target) != old:
            reason = "was changed by another program meanwhile; nothing was written, try again"
            raise ConfigError("settings file", str(file), reason)
        write_atomically(target, new)
    except RecordingError as error:
        reason = str(error).removeprefix(f"{error.path}: ")
        raise ConfigError("settings file", str(error.path), reason) from error
    except OSError as error:
        where = f" ({error.filename})" if error.filename else ""
        reason = f"cannot be written: {error.strerror or error}{where}; check the permissions"
        raise ConfigError("settings file", str(file), reason) from error


def _keep(file: Path, content: bytes, wall_s: float) -> None:
    """Put the content among the backups; the oldest beyond ten go."""
    folder = file.parent / BACKUP_FOLDER
    folder.mkdir(exist_ok=True)
    now = datetime.datetime.fromtimestamp(wall_s, datetime.UTC)
    stamp = f"{now:%Y%m%dT%H%M%S}.{now.microsecond:06d}Z"
    write_atomically(folder / f"{file.stem}-{stamp}{file.suffix}", content, mode_of(file))
    ours = re.compile(rf"{re.escape(file.stem)}-\d{{8}}T\d{{6}}\.\d{{6}}Z{re.escape(file.suffix)}")
    kept = sorted(path for path in folder.iterdir() if ours.fullmatch(path.name))
    for oldest in kept[:-N_BACKUPS]:
        oldest.unlink(missing_ok=True)


def as_toml(value: object) -> Any:  # noqa: ANN401 - TOML
    """A value in TOML's types; None stays None."""
    if value is None:
        return None
    value = plain(value)
    if isinstance(value, Mapping):
        return {key: as_toml(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [as_toml(item) for item in value]
    return value


def _put_plain(wanted: dict[str, Any], name: str, value: Any) -> None:  # noqa: ANN401 - TOML
    table, _, key = name.partition(".")
    if value is not None:
        wanted.setdefault(table, {})[key] = value
    elif table in wanted:
        wanted[table].pop(key, None)


def _meaning(text: str) -> dict[str, Any] | None:
    try:
        return _without_empty(tomllib.loads(text))
    except ValueError:
        return None


def _without_empty(tables: dict[str, Any]) -> dict[str, Any]:
    return {name: table for name, table in tables.items() if table != {}}


def _not_changed(file: Path) -> ConfigError:
    reason = "its tables are laid out in a way that this cannot be put into; use an editor"
    return ConfigError("settings file", str(file), reason)
