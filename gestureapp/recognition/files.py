"""Files that are either the old one or the new one, whole."""

import errno
import os
import stat
import tempfile
from pathlib import Path
from typing import Final

from gestureapp.errors import DiskFull, RecordingError

NEW_FILE_MODE: Final = 0o644


def write_atomically(path: Path, content: bytes, mode: int | None = None) -> None:
    """Replace a file by new content; after a crash at any moment it is the old one or the new one.

    Args:
        path: Which; its folder has to be there.
        content: All of it.
        mode: Its permissions; those of the file that is there when None.

    Raises:
        DiskFull: no room is left there; the old file is untouched.
        RecordingError: the folder is missing or may not be written; the old file is untouched.
    """
    temporary: Path | None = None
    try:
        with tempfile.NamedTemporaryFile(
            dir=path.parent, prefix=f".{path.name}.", delete=False
        ) as file:
            temporary = Path(file.name)
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        temporary.chmod(mode_of(path) if mode is None else mode)
        temporary.replace(path)
        temporary = None
    except OSError as error:
        if error.errno == errno.ENOSPC:
            raise DiskFull(path, "no room is left on the disk; free some and save again") from error
        raise RecordingError(path, f"cannot be written: {error.strerror or error}") from error
    finally:
        if temporary is not None:
            temporary.unlink(missing_ok=True)


def mode_of(path: Path) -> int:
    """A file's permissions; those of a new file when there is none."""
    try:
        return stat.S_IMODE(path.stat().st_mode)
    except FileNotFoundError:
        return NEW_FILE_MODE
