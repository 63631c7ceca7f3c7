"""The ``witmotion`` protocol: frames of 11 bytes, ``55 51`` and an acceleration. Pure.

Source: the makers' data sheets (BWT61CL v20-0630, 6.1; WT901 v20-0702, 5.1), frame by frame.
"""

import struct

from gestureapp.sensing.lines import FIRST_BYTES
from gestureapp.sensing.values import DecoderEvent, Frame, Garbage

LIMIT_G = 16.0
"""The widest range that these sensors can be set to, and the only one the frame's scale fits."""

COUNTS_PER_G = 32768 / 16
"""2048: the data sheet gives an axis as the number / 32768 x 16 g."""

FRAME_BYTES = 11
HEADER = 0x55
ACCELERATION = 0x51
KINDS = range(0x50, 0x60)
"""Second bytes of this family: 50 time, 51 acceleration, 52 rate, 53 angle ... 5F register."""

EXPECTED = "frames of 11 bytes: 55 51, x, y, z, temperature, checksum"

_AXES = struct.Struct("<3h")


class WitmotionDecoder:
    """Decodes one connection. Owned by its reader; holds less than ``FRAME_BYTES`` + 32 bytes.

    There is no running number, and the checksum has 8 bits only. So a frame that follows bytes
    which were none is taken only once the byte after it is a header, too: that costs one frame's
    time after a fault and keeps wrong values out. Frames in a row are taken as they end.

    After a fault it looks for a header byte by byte, in the bytes of the wrong frame as well: a
    flipped byte loses one frame, and with it once in some 60,000 times the one behind it. The rest
    of a frame at the very beginning of a connection is no fault and passed over.
    """

    def __init__(self) -> None:
        self._pending = bytearray()
        self._skipped = bytearray()
        self._why = ""
        self._is_in_step = False
        self._is_begin = True

    def feed(self, data: bytes) -> list[DecoderEvent]:
        """Take bytes as they came; the frames and the garbage that they complete."""
        events: list[DecoderEvent] = []
        self._pending += data
        start = 0
        while (used := self._next(start, events)) > 0:
            start += used
        del self._pending[:start]
        return events

    def end(self) -> list[DecoderEvent]:
        """The stream has ended: a frame without its end is garbage."""
        if self._pending:
            self._skipped += self._pending
            self._why = self._why or "the stream ended inside this frame"
            self._pending.clear()
        events: list[DecoderEvent] = []
        self._tell_skipped(events)
        return events

    def _next(self, start: int, events: list[DecoderEvent]) -> int:
        """Use up one frame, or one byte that begins none; 0 when more bytes are needed."""
        frame = self._pending[start : start + FRAME_BYTES]
        if not _may_begin_frame(frame):
            return self._skip(frame[0], events)
        if len(frame) < FRAME_BYTES:
            return 0
        total = sum(frame[:-1]) & 0xFF
        if total != frame[-1]:
            self._why = (
                self._why or f"checksum {frame[-1]:02x} in a frame that adds up to {total:02x}"
            )
            return self._skip(frame[0], events)
        if not self._is_in_step:
            after = start + FRAME_BYTES
            if after == len(self._pending):
                return 0
            if self._pending[after] != HEADER:
                return self._skip(frame[0], events)
        self._tell_skipped(events)
        self._is_in_step = True
        if frame[1] == ACCELERATION:
            x, y, z = _AXES.unpack_from(frame, 2)
            events.append(Frame(None, (float(x), float(y), float(z))))
        return FRAME_BYTES

    def _skip(self, byte: int, events: list[DecoderEvent]) -> int:
        self._is_in_step = False
        self._skipped.append(byte)
        if len(self._skipped) == FIRST_BYTES:
            self._tell_skipped(events)
        return 1

    def _tell_skipped(self, events: list[DecoderEvent]) -> None:
        """Tell what was skipped, unless it is the rest of the frame in which we began."""
        skipped = bytes(self._skipped)
        is_rest = self._is_begin and len(skipped) < FRAME_BYTES
        if skipped and not is_rest:
            reason = self._why or f"expected {EXPECTED}"
            events.append(Garbage(len(skipped), skipped[:FIRST_BYTES], reason))
        self._skipped.clear()
        self._why = ""
        self._is_begin = False


def witmotion_to_g(raw: tuple[float, float, float]) -> tuple[float, float, float]:
    """Counts to g: +/-32768 are +/-16 g."""
    x, y, z = raw
    return (x / COUNTS_PER_G, y / COUNTS_PER_G, z / COUNTS_PER_G)


def _may_begin_frame(data: bytearray) -> bool:
    """Whether what stands there can be the beginning of a frame; yes for nothing at all."""
    return not data or (data[0] == HEADER and (len(data) < 2 or data[1] in KINDS))
