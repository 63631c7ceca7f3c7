"""The ``binary`` protocol: our own frames, COBS between zero bytes, with a CRC-16. Pure.

A frame is ``COBS(version, kind, body, CRC-16) 00``. The CRC has the polynomial 0x1021, begins with
0xFFFF, and is sent low byte first; it covers version, kind and body. All numbers are little-endian.
``docs/sensors.md`` has the bytes of an example.
"""

import binascii
import re
import struct

from gestureapp.sensing.counter import RunningNumber
from gestureapp.sensing.lines import FIRST_BYTES, LineSplitter
from gestureapp.sensing.values import Battery, DecoderEvent, Frame, Garbage, Identity, Repeated

VERSION = 1
SAMPLE = 1
IDENTITY = 2

COUNTS_PER_G = 2000.0
"""A count is 0.5 mg."""

LIMIT_G = 16.0
"""What the scale is for. Its ends, 16.4 g, lie beyond: a sensor that knows that its reading cannot
be right, with a converter at its rail, sends them."""

NAME_BYTES_MAX = 20
BATTERY_UNKNOWN = 255

_CRC_BEGIN = 0xFFFF
_HEAD_BYTES = 2
_CRC_BYTES = 2
_SAMPLE = struct.Struct("<H3hB")
_ZERO = re.compile(rb"\x00")


class BinaryDecoder:
    """Decodes one connection. Owned by its reader; holds at most one frame.

    Whatever happens between two zero bytes costs what stands between them: a flipped byte loses one
    frame, or two when it was the zero between them. Kinds of frames that are not known are passed
    over, so that a sensor may send more than this program reads. So is the rest of a frame at the
    very beginning of a connection.
    """

    def __init__(self) -> None:
        self._splitter = LineSplitter(_ZERO, "frame")
        self._number = RunningNumber()
        self._identity = ""
        self._percent: int | None = None
        self._is_first = True

    def feed(self, data: bytes) -> list[DecoderEvent]:
        """Take bytes as they came; the frames, gaps and garbage that they complete."""
        events: list[DecoderEvent] = []
        for piece in self._splitter.feed(data):
            if isinstance(piece, Garbage):
                events.append(piece)
            elif piece:
                found = self._frame(piece)
                is_cut = self._is_first and any(type(event) is Garbage for event in found)
                events += [] if is_cut else found
            self._is_first = False
        return events

    def end(self) -> list[DecoderEvent]:
        """The stream has ended: a frame without its end is garbage."""
        rest = self._splitter.end()
        if not rest or self._is_first:
            return []
        return _garbage(rest, "the stream ended inside this frame")

    def _frame(self, coded: bytes) -> list[DecoderEvent]:
        packet = _uncobs(coded)
        if packet is None:
            return _garbage(coded, "expected a COBS frame: a count in it points beyond its end")
        if len(packet) < _HEAD_BYTES + _CRC_BYTES:
            return _garbage(coded, f"a frame of {len(packet)} bytes is too short")
        content, sent = packet[:-_CRC_BYTES], int.from_bytes(packet[-_CRC_BYTES:], "little")
        crc = binascii.crc_hqx(content, _CRC_BEGIN)
        if crc != sent:
            return _garbage(coded, f"CRC {sent:04x} in a frame that has {crc:04x}")
        version, kind, body = content[0], content[1], content[_HEAD_BYTES:]
        if version != VERSION:
            return _garbage(coded, f"version {version} of this protocol, known is {VERSION}")
        if kind == SAMPLE:
            return self._sample(coded, body)
        return self._named(coded, body) if kind == IDENTITY else []

    def _sample(self, coded: bytes, body: bytes) -> list[DecoderEvent]:
        if len(body) != _SAMPLE.size:
            return _garbage(coded, f"a sample of {len(body)} bytes, expected {_SAMPLE.size}")
        number, x, y, z, percent = _SAMPLE.unpack(body)
        if percent > 100 and percent != BATTERY_UNKNOWN:
            return _garbage(coded, f"battery {percent} %, expected 0 to 100 or {BATTERY_UNKNOWN}")
        if self._number.is_repeat(number):
            reason = f"running number {number} came twice"
            return [Repeated(len(coded), coded[:FIRST_BYTES], reason)]
        events: list[DecoderEvent] = []
        if percent not in (BATTERY_UNKNOWN, self._percent):
            self._percent = percent
            events.append(Battery(float(percent)))
        gap = self._number.follow(number)
        if gap is not None:
            events.append(gap)
        return [*events, Frame(number, (float(x), float(y), float(z)))]

    def _named(self, coded: bytes, body: bytes) -> list[DecoderEvent]:
        """What the sensor calls itself; sent every second, told when it is new."""
        name = body.decode("utf-8", "replace").strip()
        if not (
            name and len(body) <= NAME_BYTES_MAX and name.isprintable() and "\ufffd" not in name
        ):
            return _garbage(coded, f"a name is 1 to {NAME_BYTES_MAX} bytes of printable UTF-8")
        if name == self._identity:
            return []
        self._identity = name
        return [Identity(name)]


def binary_to_g(raw: tuple[float, float, float]) -> tuple[float, float, float]:
    """Counts of 0.5 mg to g."""
    x, y, z = raw
    return (x / COUNTS_PER_G, y / COUNTS_PER_G, z / COUNTS_PER_G)


def _uncobs(coded: bytes) -> bytes | None:
    """Take the byte stuffing out of what stood between two zero bytes; None when it is broken.

    Source: S. Cheshire, M. Baker, Consistent Overhead Byte Stuffing, IEEE/ACM Transactions on
    Networking 7 (2), 1999: each count says how far the next zero is. Its count of 255, which stands
    for 254 bytes without a zero, cannot be in a frame of ours: it is too short.
    """
    packet = bytearray()
    at = 0
    while at < len(coded):
        count = coded[at]
        block = coded[at + 1 : at + count]
        if len(block) != count - 1:
            return None
        packet += block
        at += count
        if at < len(coded):
            packet.append(0)
    return bytes(packet)


def _garbage(coded: bytes, reason: str) -> list[DecoderEvent]:
    return [Garbage(len(coded), coded[:FIRST_BYTES], reason)]
