"""Small kept files: one JSON object with format, schema and a digest over its content.

A file of this kind is either exactly what was written or damaged: a changed digit in a calibration
would still be valid JSON, so the content is held against its digest.
"""

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Final

from gestureapp.errors import RecordingError
from gestureapp.recognition.fields import object_in
from gestureapp.recognition.files import write_atomically

LARGEST_FILE: Final = 100_000
"""Bytes; ours take less than 2 kB."""


def write_kept(path: Path, kind: str, schema: int, content: Mapping[str, object]) -> None:
    """Write a file, folder and all; a file there that cannot be read is kept under another name.

    Args:
        path: The file.
        kind: What it is, ``gestureapp sensor``.
        schema: Version of the content's layout.
        content: Numbers, texts, lists and objects; all numbers finite.

    Raises:
        DiskFull: no room is left there; the old file is as it was.
        RecordingError: it cannot be written; the old file is as it was.
    """
    whole = {
        "format": kind,
        "schema": schema,
        "content": content,
        "sha256": _digest(content),
    }
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        if path.exists() and not _is_readable(path, kind, schema):
            path.rename(_aside(path))
    except OSError as error:
        reason = f"cannot be written: {error.strerror or error}; choose another folder"
        raise RecordingError(path, f"{reason} with --data-dir") from error
    write_atomically(path, json.dumps(whole, indent=1, allow_nan=False).encode())


def read_kept(path: Path, kind: str, schema: int) -> Mapping[str, object] | None:
    """The content of a file; None where there is none. The file is never touched.

    Raises:
        ValueError: it is damaged, of another kind or from a newer version, or cannot be read; the
            text is the reason without the file's name.
    """
    try:
        if path.stat().st_size > LARGEST_FILE:
            raise ValueError("is too large to be one of ours")
        raw = path.read_bytes()
    except FileNotFoundError:
        return None
    except OSError as error:
        raise ValueError(f"cannot be read: {error.strerror or error}") from error
    return _content_in(raw, kind, schema)


def _content_in(raw: bytes, kind: str, schema: int) -> Mapping[str, object]:
    try:
        whole = json.loads(raw)
    except (ValueError, RecursionError) as error:
        raise ValueError("is damaged") from error
    if not isinstance(whole, dict) or whole.get("format") != kind:
        raise ValueError(f"is no file of kind '{kind}'")
    version = whole.get("schema")
    if type(version) is int and version > schema:
        raise ValueError(f"is from a newer version (schema {version}, this one reads {schema})")
    if type(version) is not int or version < 1:
        raise ValueError("is damaged: its version is missing")
    content = object_in(whole, "content")
    try:
        is_whole = whole.get("sha256") == _digest(content)
    except RecursionError:
        is_whole = False
    if not is_whole:
        raise ValueError("is damaged: what it says is not what was written")
    return content


def _digest(content: Mapping[str, object]) -> str:
    plain = json.dumps(content, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(plain.encode()).hexdigest()


def _is_readable(path: Path, kind: str, schema: int) -> bool:
    try:
        read_kept(path, kind, schema)
    except ValueError:
        return False
    return True


def _aside(path: Path) -> Path:
    number = 1
    while (aside := path.with_name(f"{path.stem}.damaged-{number}{path.suffix}")).exists():
        number += 1
    return aside
