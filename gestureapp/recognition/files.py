"""Files that are either the old one or the new one, whole."""

import errno
import os
import tempfile
from pathlib import Path

from gestureapp.errors import DiskFull, RecordingError


def write_atomically(path: Path, content: bytes) -> None:
    """Replace a file by new content; after a crash at any moment it is the old one or the new one.

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
        temporary.chmod(0o644)
        temporary.replace(path)
        temporary = None
    except OSError as error:
        if error.errno == errno.ENOSPC:
            raise DiskFull(path, "no room is left on the disk; free some and save again") from error
        raise RecordingError(path, f"cannot be written: {error.strerror or error}") from error
    finally:
        if temporary is not None:
            temporary.unlink(missing_ok=True)
