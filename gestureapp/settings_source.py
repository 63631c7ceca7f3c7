"""A settings file's bytes as text, and its text as TOML; what is wrong there names the line."""

import re
import tomllib
from pathlib import Path
from typing import Any, Final

from gestureapp.errors import ConfigError

MAX_BYTES: Final = 100_000
"""A settings file has some thousand bytes; more is a file taken by mistake."""
_LINE_IN_MESSAGE: Final = re.compile(r"\(at line (\d+), column \d+\)")
_AT_END: Final = "(at end of document)"


def is_there(file: Path) -> bool:
    """Whether there is something of this name; so it counts when its folder may not be read."""
    try:
        return file.exists()
    except OSError:  # reading it says so
        return True


def read_bytes(file: Path) -> bytes:
    """What is in a settings file.

    Raises:
        ConfigError: it is not there, cannot be read, or is no settings file.
    """
    if is_there(file) and not file.is_file():
        reason = "not a file; give the name of a .toml file"
        raise ConfigError("settings file", str(file), reason)
    try:
        with file.open("rb") as stream:
            data = stream.read(MAX_BYTES + 1)
    except OSError as error:
        reason = f"cannot be read: {error.strerror or error}; check the name and the permissions"
        raise ConfigError("settings file", str(file), reason) from error
    if len(data) > MAX_BYTES:
        reason = f"larger than {MAX_BYTES} bytes; this is no settings file"
        raise ConfigError("settings file", str(file), reason)
    return data


def bytes_if_there(file: Path) -> bytes | None:
    """What is in a settings file; None when it is not there.

    Raises:
        ConfigError: it cannot be read, or is no settings file.
    """
    return read_bytes(file) if is_there(file) else None


def text_of(file: Path, data: bytes) -> str:
    """The text in those bytes, without a byte order mark.

    Raises:
        ConfigError: it is not UTF-8.
    """
    try:
        # A byte order mark is what Windows' editor puts in front.
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = error.object.count(b"\n", 0, error.start) + 1
        reason = f"line {line}: not UTF-8; save the file in that encoding"
        raise ConfigError("settings file", str(file), reason) from error


def parsed(file: Path, text: str) -> dict[str, Any]:
    """The tables in that text.

    Raises:
        ConfigError: it is not TOML.
    """
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
