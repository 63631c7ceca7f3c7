"""Bytes in, frames out: what all line protocols share. Pure: no port, no clock, no thread."""

from collections.abc import Callable
from typing import Protocol

from gestureapp.sensing.counter import RunningNumber
from gestureapp.sensing.lines import FIRST_BYTES, LineSplitter
from gestureapp.sensing.values import DecoderEvent, Frame, Garbage, Repeated

LineParser = Callable[[bytes], Frame | None]
"""One line without its end -> the frame in it, or None when it is none."""


class Decoder(Protocol):
    """Turns one connection's bytes into events. Never raises on input."""

    def feed(self, data: bytes) -> list[DecoderEvent]:
        """Take bytes as they came; any split of the stream gives the same events in the end."""

    def end(self) -> list[DecoderEvent]:
        """The stream has ended; what was not finished is garbage."""


class LineDecoder:
    """Decodes a protocol of one line a frame. One object per connection, owned by its reader.

    Beginning in the middle: one cannot see whether the first line of a connection is whole. If it
    cannot be parsed it is passed over, as this is no fault of the sensor. If it carries a running
    number, a cut can only have hit that number: the frame is taken, with the number left out.
    Without one, ``0.98`` may have lost its beginning (``8``) or be the wrong axis: passed over.

    Args:
        parse: Reads one line.
        expected: What a line should look like, for the reason of ``Garbage``.
    """

    def __init__(self, parse: LineParser, expected: str) -> None:
        self._parse = parse
        self._expected = expected
        self._splitter = LineSplitter()
        self._number = RunningNumber()
        self._is_first_line = True

    def feed(self, data: bytes) -> list[DecoderEvent]:
        """Take bytes as they came; the frames, gaps and garbage that they complete."""
        events: list[DecoderEvent] = []
        for line in self._splitter.feed(data):
            if isinstance(line, Garbage):
                events.append(line)
            elif self._is_first_line:
                events += self._first_line(line)
            elif line:
                events += self._line(line)
            self._is_first_line = False
        return events

    def end(self) -> list[DecoderEvent]:
        """The stream has ended: a line without its end is garbage, as numbers may be cut short."""
        rest = self._splitter.end()
        if not rest or self._is_first_line:
            return []
        return [Garbage(len(rest), rest[:FIRST_BYTES], "the stream ended inside this line")]

    def _first_line(self, line: bytes) -> list[DecoderEvent]:
        frame = self._parse(line)
        if frame is None or frame.counter is None:
            return []
        return [Frame(None, frame.raw)]

    def _line(self, line: bytes) -> list[DecoderEvent]:
        frame = self._parse(line)
        if frame is None:
            return [Garbage(len(line), line[:FIRST_BYTES], f"expected {self._expected}")]
        if frame.counter is None:
            return [frame]
        if self._number.is_repeat(frame.counter):
            reason = f"running number {frame.counter} came twice"
            return [Repeated(len(line), line[:FIRST_BYTES], reason)]
        gap = self._number.follow(frame.counter)
        return [frame] if gap is None else [gap, frame]
