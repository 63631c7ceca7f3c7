"""Bytes in, lines out: cuts a stream at its line ends, whatever pieces it comes in. Pure."""

import re

from gestureapp.sensing.values import Garbage

MAX_LINE_BYTES = 128
"""The longest line of any protocol here is about 80 bytes; more without an end is no line."""

FIRST_BYTES = 32
"""How many of the dropped bytes ``Garbage`` keeps."""

LINE_END = re.compile(rb"[\r\n]")


class LineSplitter:
    """Cuts a stream into lines; holds at most ``MAX_LINE_BYTES`` between two calls.

    CR and LF each end a line, so CRLF leaves an empty line behind, which is given too: it tells
    that a line has ended. The result depends on the bytes only, never on how they were split into
    calls. Owned by one decoder.

    Args:
        end: One byte that ends a line.
        unit: What lies between two ends, in words.
    """

    def __init__(self, end: re.Pattern[bytes] = LINE_END, unit: str = "line") -> None:
        self._end = end
        self._unit = unit
        self._pending = bytearray()
        self._is_overlong = False

    def feed(self, data: bytes) -> list[bytes | Garbage]:
        """Take bytes; give the lines that they end, without their ends, and what was too long.

        A line that reaches ``MAX_LINE_BYTES`` is dropped piece by piece as it comes, so that an
        endless one is told about although it never ends.
        """
        lines: list[bytes | Garbage] = []
        first, *rest = self._end.split(data)
        self._take(first, lines)
        for piece in rest:
            lines.append(self._end_line())
            self._take(piece, lines)
        return lines

    def end(self) -> bytes:
        """The stream has ended: give, and forget, what stands there without a line end."""
        rest = bytes(self._pending)
        self._pending.clear()
        self._is_overlong = False
        return rest

    def _take(self, piece: bytes, lines: list[bytes | Garbage]) -> None:
        self._pending += piece
        start = 0
        while len(self._pending) - start >= MAX_LINE_BYTES:
            first = bytes(self._pending[start : start + FIRST_BYTES])
            reason = f"expected a {self._unit} end within {MAX_LINE_BYTES} bytes"
            lines.append(Garbage(MAX_LINE_BYTES, first, reason))
            start += MAX_LINE_BYTES
            self._is_overlong = True
        del self._pending[:start]

    def _end_line(self) -> bytes | Garbage:
        line = bytes(self._pending)
        is_rest = self._is_overlong and bool(line)
        self._pending.clear()
        self._is_overlong = False
        if is_rest:
            reason = f"the rest of a {self._unit} that was too long"
            return Garbage(len(line), line[:FIRST_BYTES], reason)
        return line


def readable_bytes(data: bytes) -> str:
    """Bytes as a person can read them: text as text, everything else in hexadecimal."""
    text = b" ".join(data.split())
    if text and all(0x20 <= byte < 0x7F for byte in text):
        return text.decode("ascii")
    return data.hex(" ")
