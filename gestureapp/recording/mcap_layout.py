"""Where things are in an MCAP file: heads are read, bodies skipped, and a cut end is found.

A record is an opcode byte, a length of eight bytes and that many bytes of body; the file begins
with eight magic bytes and ends with a footer and the same eight.
Source: MCAP format specification, "Records".
"""

import io
import struct
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import BinaryIO, Final

from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Channel, Chunk, Header, Metadata

from gestureapp.recording.schemas import METADATA_NAME

MAGIC: Final = b"\x89MCAP0\r\n"
_HEAD: Final = struct.Struct("<BQ")
_TIMES: Final = struct.Struct("<QQ")
_MAX_SMALL_BYTES: Final = 1024 * 1024
"""Headers, metadata and channels: ours have some thousand bytes."""
_BODY_ERRORS: Final = (McapError, struct.error, ValueError, MemoryError)


@dataclass(frozen=True, slots=True)
class ChunkPlace:
    """A complete chunk in a file.

    Attributes:
        offset: Of its body, in bytes from the start of the file.
        length: Of its body, in bytes.
        start_ns: Wall time of its earliest message, ns since the epoch.
        end_ns: Of its latest.
    """

    offset: int
    length: int
    start_ns: int
    end_ns: int

    def parse(self, body: bytes) -> Chunk:
        """The chunk in these bytes.

        Raises:
            ValueError: the body is shorter or longer than it says.
            struct.error: it is too short for its fixed fields.
        """
        if len(body) != self.length:
            raise ValueError("the file has become shorter")
        stream = ReadDataStream(io.BytesIO(body))
        chunk = Chunk.read(stream)
        if stream.count != self.length:
            raise ValueError("the chunk's own lengths do not fit")
        return chunk


@dataclass(slots=True)
class Layout:
    """What was found in a file.

    Attributes:
        n_bytes: Size of the file.
        has_magic: It begins as an MCAP file does, as far as it goes.
        profile: From the header; None when the file ends before it.
        metadata: Of the session; None when the file ends before it.
        channels: Topic by channel id, where it stands outside a chunk (end of a finished file).
        chunks: The complete chunks.
        is_finished: The footer and the last magic bytes are there.
        n_cut_bytes: Bytes of the record that the end of the file cuts off.
        cut_chunk_end_ns: Where that is a chunk: wall time of its latest message.
    """

    n_bytes: int
    has_magic: bool = False
    profile: str | None = None
    metadata: Mapping[str, str] | None = None
    channels: dict[int, str] = field(default_factory=dict)
    chunks: tuple[ChunkPlace, ...] = ()
    is_finished: bool = False
    n_cut_bytes: int = 0
    cut_chunk_end_ns: int | None = None


def read_layout(stream: BinaryIO, n_bytes: int) -> Layout:
    """Walk over the records of a file of ``n_bytes``; never raises on what it finds there.

    Raises:
        OSError: the disk could not be read.
    """
    layout = Layout(n_bytes)
    stream.seek(0)
    magic = stream.read(len(MAGIC))
    layout.has_magic = bool(magic) and MAGIC.startswith(magic)
    if magic != MAGIC:
        return layout
    chunks: list[ChunkPlace] = []
    at = len(MAGIC)
    while at < n_bytes and not layout.is_finished:
        stream.seek(at)
        head = stream.read(_HEAD.size)
        opcode, length = _HEAD.unpack(head) if len(head) == _HEAD.size else (0, n_bytes)
        body_at = at + _HEAD.size
        if body_at + length > n_bytes:
            _note_cut(layout, stream, opcode, n_bytes - at)
            break
        _note_record(layout, chunks, stream, opcode, length)
        if opcode == Opcode.FOOTER:
            stream.seek(body_at + length)
            layout.is_finished = stream.read(len(MAGIC)) == MAGIC
            break
        at = body_at + length
    layout.chunks = tuple(chunks)
    return layout


def _note_cut(layout: Layout, stream: BinaryIO, opcode: int, n_cut_bytes: int) -> None:
    layout.n_cut_bytes = n_cut_bytes
    times = stream.read(_TIMES.size)
    if opcode == Opcode.CHUNK and len(times) == _TIMES.size:
        layout.cut_chunk_end_ns = _TIMES.unpack(times)[1]


def _note_record(
    layout: Layout, chunks: list[ChunkPlace], stream: BinaryIO, opcode: int, length: int
) -> None:
    """Take what is needed of a complete record; the stream stands at its body."""
    if opcode == Opcode.CHUNK and length >= _TIMES.size:
        offset = stream.tell()
        start_ns, end_ns = _TIMES.unpack(stream.read(_TIMES.size))
        chunks.append(ChunkPlace(offset, length, start_ns, end_ns))
    elif length <= _MAX_SMALL_BYTES and opcode in (
        Opcode.HEADER,
        Opcode.METADATA,
        Opcode.CHANNEL,
    ):
        try:
            _note_small(layout, opcode, ReadDataStream(io.BytesIO(stream.read(length))))
        except _BODY_ERRORS:
            # Damaged: passed over as the reader passes over a damaged chunk. What is missing then
            # (the profile, the metadata) is what the reader tells the person.
            return


def _note_small(layout: Layout, opcode: int, body: ReadDataStream) -> None:
    if opcode == Opcode.HEADER:
        layout.profile = Header.read(body).profile
    elif opcode == Opcode.CHANNEL:
        channel = Channel.read(body)
        layout.channels[channel.id] = channel.topic
    else:
        metadata = Metadata.read(body)
        if metadata.name == METADATA_NAME:
            layout.metadata = dict(metadata.metadata)
