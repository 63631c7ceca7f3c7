"""One session file being written: records in, chunks on the disk. The recorder's thread only."""

import contextlib
import errno
import json
import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import BinaryIO

from mcap.writer import LIBRARY_IDENTIFIER, CompressionType, Writer

from gestureapp import __version__
from gestureapp.cell.records import Record, Topic
from gestureapp.errors import DiskFull, RecordingError
from gestureapp.recording.schemas import (
    FORMAT_VERSION,
    METADATA_NAME,
    PROFILE,
    SCHEMAS,
    encode_record,
    schema_name,
)

NS_PER_S = 1_000_000_000
OpenFile = Callable[[Path], BinaryIO]
"""Opens a new file for writing. Buffered: mcap loses the end of an unbuffered one."""

_U32 = 0xFFFF_FFFF
_U64 = 0xFFFF_FFFF_FFFF_FFFF


@dataclass(frozen=True, slots=True)
class Anchor:
    """The same moment on both clocks: wall time in a file is this plus a monotonic difference.

    Attributes:
        wall_ns: Nanoseconds since the epoch, UTC.
        monotonic_s: Seconds on the monotonic clock.
    """

    wall_ns: int
    monotonic_s: float

    def wall_at_ns(self, t_s: float) -> int:
        """Wall time of a monotonic time, ns since the epoch; 0 where that is no time at all."""
        try:
            return min(max(self.wall_ns + round((t_s - self.monotonic_s) * NS_PER_S), 0), _U64)
        except (ValueError, OverflowError):  # NaN, infinity
            return 0


def monotonic_ns(t_s: float) -> int:
    """A monotonic time in whole ns, as MCAP holds it; 0 where it is no time at all."""
    return Anchor(0, 0.0).wall_at_ns(t_s)


def open_new(path: Path) -> BinaryIO:
    """Open a new buffered file, in a folder that is made when it is missing.

    Raises:
        OSError: the file exists, or cannot be made.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    return path.open("xb")


class McapFile:
    """A session file from its header to its last chunk.

    Attributes:
        path: Where it is.
        n_synced_bytes: Bytes known to be on the disk.
        has_chunk: A chunk with messages is known to be on the disk.
    """

    def __init__(
        self, path: Path, anchor: Anchor, metadata: Mapping[str, str], open_file: OpenFile
    ) -> None:
        """Make the file; its header and metadata are on the disk when this returns.

        Raises:
            OSError: the file cannot be made or written.
        """
        self.path = path
        self.n_synced_bytes = 0
        self.has_chunk = False
        self._anchor = anchor
        self._n_written = 0
        self._stream = open_file(path)
        try:
            self._writer = Writer(self._stream, compression=CompressionType.ZSTD)
            self._writer.start(PROFILE, f"{PROFILE} {__version__}; {LIBRARY_IDENTIFIER}")
            self._writer.add_metadata(METADATA_NAME, {**metadata, **_own_metadata(anchor)})
            self._channels = {topic: self._register(topic) for topic in Topic}
            self.sync()
        except BaseException:
            self.abandon()
            raise

    def write(self, record: Record) -> bool:
        """Add a record to the open chunk; returns whether it could be written as JSON.

        Raises:
            OSError: the chunk was full and the disk did not take it.
        """
        data = encode_record(record)
        if data is None:
            return False
        self._n_written += 1
        self._writer.add_message(
            self._channels[record.topic],
            log_time=self._anchor.wall_at_ns(record.t_s),
            publish_time=monotonic_ns(record.t_s),
            data=data,
            sequence=self._n_written & _U32,
        )
        return True

    def sync(self) -> None:
        """Close the chunk and see it onto the disk.

        Raises:
            OSError: the disk did not take it.
        """
        self._writer.flush()
        os.fsync(self._stream.fileno())
        self.n_synced_bytes = self._stream.tell()
        self.has_chunk = self._n_written > 0

    def finish(self) -> None:
        """Write the last chunk, the index and the end of the file, and close it.

        Raises:
            OSError: the disk did not take it; the file is closed all the same.
        """
        try:
            self._writer.finish()
            self._stream.flush()
            os.fsync(self._stream.fileno())
        except BaseException:
            self.abandon()
            raise
        self._stream.close()

    def abandon(self) -> None:
        """Close after an error. What is on the disk stays; a file without one chunk is removed."""
        # Closing writes what is left over; that fails again, is known, and closes all the same.
        with contextlib.suppress(OSError):
            self._stream.close()
        if not self.has_chunk:
            # On a disk that takes nothing an empty file may stay: no harm, and no one to tell.
            with contextlib.suppress(OSError):
                self.path.unlink(missing_ok=True)

    def _register(self, topic: Topic) -> int:
        schema = json.dumps(SCHEMAS[topic]).encode()
        schema_id = self._writer.register_schema(schema_name(topic), "jsonschema", schema)
        return int(self._writer.register_channel(topic.value, "json", schema_id))


def explain(path: Path, error: OSError) -> RecordingError:
    """Say in one line why a session file could not be written, and what to do about it."""
    folder = path.parent
    match error.errno:
        case errno.ENOSPC | errno.EDQUOT:
            return DiskFull(path, f"no room is left on the disk; free some space for {folder}")
        case errno.EFBIG:
            reason = "the file is larger than this account may write; raise the limit (ulimit -f)"
        case errno.EACCES | errno.EPERM | errno.EROFS:
            reason = f"writing is not permitted; make {folder} writable for this account"
        case errno.ENOENT | errno.ENOTDIR:
            reason = f"the folder cannot be made; check that the disk of {folder} is there"
        case _:
            reason = f"{error.strerror or error}; check the disk of {folder}"
    return RecordingError(path, reason)


def _own_metadata(anchor: Anchor) -> dict[str, str]:
    start = datetime.fromtimestamp(anchor.wall_ns / NS_PER_S, UTC)
    return {
        "format": str(FORMAT_VERSION),
        "application_version": __version__,
        "start_wall": start.isoformat(timespec="milliseconds"),
        "start_wall_ns": str(anchor.wall_ns),
        "start_monotonic_s": repr(anchor.monotonic_s),
    }
