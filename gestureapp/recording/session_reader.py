"""Reads a session file, whole or cut off, ours or not; a bad one gives one clear line.

The structure is read at once (record heads and chunk times, some bytes for each second of a
session); the messages are decoded while they are iterated over, one chunk in memory at a time.
"""

import struct
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from types import MappingProxyType
from typing import BinaryIO, Final

import zstandard
from mcap.exceptions import McapError
from mcap.records import Channel, Chunk, Message
from mcap.stream_reader import CRCValidationError, breakup_chunk

from gestureapp.cell.records import Record, Topic
from gestureapp.errors import RecordingIncomplete, RecordingInvalid
from gestureapp.recording.mcap_layout import ChunkPlace, Layout, read_layout
from gestureapp.recording.schemas import FORMAT_VERSION, PROFILE, decode_record

NS_PER_S: Final = 1_000_000_000
_MAX_CHUNK_BYTES: Final = 256 * 1024 * 1024
"""Ours have 1 MiB before compression; a damaged length must not ask for all the memory."""
_CHUNK_ERRORS: Final = (
    McapError,
    CRCValidationError,
    zstandard.ZstdError,
    struct.error,
    ValueError,
    MemoryError,
)
"""What mcap raises on a damaged chunk."""
_TOPICS: Final = {topic.value: topic for topic in Topic}


@dataclass(frozen=True, slots=True)
class SessionRecord:
    """A record as it was put, with the wall time it happened at, in seconds since the epoch."""

    record: Record
    wall_s: float


@dataclass(frozen=True, slots=True)
class Damage:
    """A stretch inside the file that could not be read.

    Attributes:
        start_wall_s: Where it begins, seconds since the epoch.
        end_wall_s: Where it ends.
        text: One line for a person.
    """

    start_wall_s: float
    end_wall_s: float
    text: str


OnDamage = Callable[[Damage], None]


@dataclass(frozen=True, slots=True)
class SessionFile:
    """A session on the disk. Nothing is kept open between calls; any thread.

    Attributes:
        path: Where it is.
        metadata: What the file says of the session: format, application_version, start_wall,
            start_wall_ns, start_monotonic_s and what the recorder was given.
        chunks: Where the complete chunks are, in the order of the file.
        incomplete: What is missing at the end, or None for a file that was closed properly.
    """

    path: Path
    metadata: Mapping[str, str]
    chunks: tuple[ChunkPlace, ...]
    incomplete: RecordingIncomplete | None
    _topics: Mapping[int, Topic]

    @property
    def start_wall_s(self) -> float:
        """Wall time of the earliest message, seconds since the epoch; 0 without any."""
        return min((chunk.start_ns for chunk in self.chunks), default=0) / NS_PER_S

    @property
    def end_wall_s(self) -> float:
        """Wall time of the latest message, seconds since the epoch; 0 without any."""
        return max((chunk.end_ns for chunk in self.chunks), default=0) / NS_PER_S

    def records(
        self, topics: Collection[Topic] | None = None, on_damage: OnDamage | None = None
    ) -> Iterator[SessionRecord]:
        """All records in the order they were written.

        Args:
            topics: Only these; all when None.
            on_damage: Told of every chunk that cannot be read and is passed over.

        Raises:
            RecordingInvalid: the file has gone or can no longer be read.
        """
        channels = dict(self._topics)
        try:
            with self.path.open("rb") as stream:
                for place in self.chunks:
                    messages = _messages(stream, place, channels, on_damage)
                    yield from _decoded(messages, channels, topics)
        except OSError as error:
            raise _unreadable(self.path, error) from error

    def damage(self) -> tuple[Damage, ...]:
        """Read every chunk against its checksum; the stretches that cannot be read."""
        found: list[Damage] = []
        for _ in self.records(topics=(), on_damage=found.append):
            pass
        return tuple(found)


def read_session(path: Path) -> SessionFile:
    """Read the structure of a session file.

    A file without its end is no error: every complete chunk is there, and ``incomplete`` says what
    is not.

    Raises:
        RecordingInvalid: it cannot be opened, is empty, is no session of this application, is from
            a newer version, or ends before its metadata.
    """
    if path.exists() and not path.is_file():
        raise RecordingInvalid(path, "not a file; choose a .mcap file of this application")
    try:
        with path.open("rb") as stream:
            layout = read_layout(stream, path.stat().st_size)
    except OSError as error:
        raise _unreadable(path, error) from error
    reason = _why_not_ours(layout)
    if reason:
        raise RecordingInvalid(path, reason)
    channels = {
        channel_id: _TOPICS[name] for channel_id, name in layout.channels.items() if name in _TOPICS
    }
    return SessionFile(
        path=path,
        metadata=MappingProxyType(dict(layout.metadata or {})),
        chunks=layout.chunks,
        incomplete=_incomplete(path, layout),
        _topics=MappingProxyType(channels),
    )


def _unreadable(path: Path, error: OSError) -> RecordingInvalid:
    reason = error.strerror or type(error).__name__
    return RecordingInvalid(path, f"cannot be read: {reason}; check the name and the permissions")


def _why_not_ours(layout: Layout) -> str:
    """Why the file cannot be read as a session, in one line; empty when it can."""
    if layout.n_bytes == 0:
        return "the file is empty; nothing was recorded"
    if not layout.has_magic:
        return "not a session file (no MCAP header); choose a .mcap file of this application"
    if layout.profile is None:
        return "the file ends inside its header; nothing was recorded"
    if layout.profile != PROFILE:
        return "an MCAP file of another application; choose a session of this one"
    if layout.metadata is None:
        return "the file ends before its description of the session; nothing was recorded"
    version = layout.metadata.get("format", "")
    if version != str(FORMAT_VERSION):
        return (
            f"has format {version[:20]!r} and this version reads {FORMAT_VERSION}; "
            f"open it with the application that wrote it, or a newer one"
        )
    return ""


def _incomplete(path: Path, layout: Layout) -> RecordingIncomplete | None:
    if layout.is_finished:
        return None
    if not layout.chunks:
        return RecordingIncomplete(path, "the end is missing and no chunk is complete: no records")
    start_ns = min(chunk.start_ns for chunk in layout.chunks)
    end_ns = max(chunk.end_ns for chunk in layout.chunks)
    if layout.cut_chunk_end_ns is not None:
        lost = f"the last {max(0, layout.cut_chunk_end_ns - end_ns) / NS_PER_S:.1f} s are missing"
    elif layout.n_cut_bytes:
        lost = f"{layout.n_cut_bytes} bytes at the end cannot be read"
    else:
        lost = "it was not closed, so about the last second may be missing"
    return RecordingIncomplete(
        path, f"readable from {_day(start_ns)} to {_day(end_ns)} UTC; {lost}"
    )


def _day(wall_ns: int) -> str:
    try:
        return datetime.fromtimestamp(wall_ns / NS_PER_S, UTC).strftime("%H:%M:%S")
    except (OverflowError, ValueError, OSError):
        return "an impossible time"


def _messages(
    stream: BinaryIO, place: ChunkPlace, channels: dict[int, Topic], on_damage: OnDamage | None
) -> list[Message]:
    """The messages of one chunk; its channels are added to ``channels``."""
    reason = ""
    try:
        records = breakup_chunk(_chunk(stream, place), validate_crc=True)
    except _CHUNK_ERRORS as error:
        reason, records = f"{type(error).__name__}", []
    messages = []
    for record in records:
        if isinstance(record, Channel) and record.topic in _TOPICS:
            channels[record.id] = _TOPICS[record.topic]
        elif isinstance(record, Message):
            messages.append(record)
    if not reason and messages and not channels:
        reason = "the names of its topics were in another damaged chunk"
    if reason and on_damage is not None:
        on_damage(_damage(place, reason))
    return messages


def _chunk(stream: BinaryIO, place: ChunkPlace) -> Chunk:
    stream.seek(place.offset)
    chunk = place.parse(stream.read(place.length))
    if chunk.uncompressed_size > _MAX_CHUNK_BYTES:
        raise ValueError("a chunk of impossible size")
    return chunk


def _damage(place: ChunkPlace, reason: str) -> Damage:
    span = f"{_day(place.start_ns)} to {_day(place.end_ns)} UTC"
    text = f"{span}: the chunk at byte {place.offset} is damaged and was passed over ({reason})"
    return Damage(place.start_ns / NS_PER_S, place.end_ns / NS_PER_S, text)


def _decoded(
    messages: list[Message], channels: Mapping[int, Topic], wanted: Collection[Topic] | None
) -> Iterator[SessionRecord]:
    for message in messages:
        topic = channels.get(message.channel_id)
        if topic is None or (wanted is not None and topic not in wanted):
            continue
        record = decode_record(topic, message.data)
        if record is not None:
            yield SessionRecord(record, message.log_time / NS_PER_S)
