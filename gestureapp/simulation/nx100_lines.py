"""The NX100's requests as lines: bytes of one connection in, requests out. Pure; never raises.

A line ends at CR; one LF after it belongs to it, whenever it arrives. Source: DX200 Ethernet
manual p. 15.
"""

from dataclasses import dataclass
from enum import Enum

CR, LF = b"\r", b"\n"
LINE_MAX_BYTES = 4096
"""Longer than any documented request; a line that has not ended by then is refused."""
SIZE_MAX = 4096
KEEP_ALIVE_MAX = 32_767
"""Source: DX200 Ethernet manual p. 14. A client with 50000 exists: only the strict form refuses."""
UNLIMITED = -1


class Refused(Enum):
    """Why a connection is answered NG. The texts are ours: the manual says "HTTP-like"."""

    CONNECT = "400 Bad Connect"
    HEADER = "400 Bad Request"
    COMMAND = "501 Not Implemented"
    SIZE = "413 Wrong Data Size"
    TOO_LONG = "414 Line Too Long"


@dataclass(frozen=True, slots=True)
class Connected:
    """A start line. ``keep_alive``: commands to come, -1 without limit, None for one."""

    keep_alive: int | None


@dataclass(frozen=True, slots=True)
class Header:
    """A good header; its data follows if ``size`` is not 0."""

    name: str
    size: int


@dataclass(frozen=True, slots=True)
class Request:
    """A complete request.

    Attributes:
        name: Command, ``IMOV``.
        data: Between header and the data's CR, without line ends.
        size: As the header said.
        is_odd: The size is farther from the data than any known client's.
    """

    name: str
    data: str
    size: int
    is_odd: bool = False


@dataclass(frozen=True, slots=True)
class Bad:
    """A line that ends the session."""

    refused: Refused
    line: str


LineEvent = Connected | Header | Request | Bad


class RequestReader:
    """Reads one connection's bytes. Owned by its conversation.

    Args:
        names: Commands that are known.
        is_strict: Refuse what the manual does not allow but controllers are said to take.
    """

    def __init__(self, names: frozenset[str], is_strict: bool = False) -> None:
        self._names = names
        self._is_strict = is_strict
        self._bytes = bytearray()
        self._is_connected = False
        self._header: Header | None = None
        self._is_over = False
        self._skips_lf = False

    def receive(self, data: bytes) -> list[LineEvent]:
        """Take bytes as they came; any split of the same bytes gives the same events."""
        events: list[LineEvent] = []
        if not self._is_over:
            self._bytes += data
        while not self._is_over:
            if self._skips_lf and self._bytes:
                self._skips_lf = False
                if self._bytes.startswith(LF):
                    del self._bytes[:1]
            end = self._bytes.find(CR)
            if end > LINE_MAX_BYTES or (end < 0 and len(self._bytes) > LINE_MAX_BYTES):
                self._add(events, Bad(Refused.TOO_LONG, _text(self._bytes[:64])))
                break
            if end < 0:
                break
            line = _text(self._bytes[:end])
            del self._bytes[: end + 1]
            self._skips_lf = True
            for event in self._read(line):
                self._add(events, event)
        return events

    def _add(self, events: list[LineEvent], event: LineEvent) -> None:
        events.append(event)
        if isinstance(event, Bad):
            self._is_over = True
            self._bytes.clear()

    def _read(self, line: str) -> list[LineEvent]:
        if self._header is not None:
            return [self._data(self._header, line)]
        if not line.strip("\n "):  # an empty buffer after the OK of a command without data
            return []
        if not self._is_connected:
            return [self._start(line)]
        return self._request(line)

    def _start(self, line: str) -> LineEvent:
        words = line.strip(" \n").split(" ")
        if words[:2] != ["CONNECT", "Robot_access"] or len(words) > 3:
            return Bad(Refused.CONNECT, line)
        if len(words) == 2:
            self._is_connected = True
            return Connected(None)
        key, _, number = words[2].partition(":")
        keep_alive = _whole(number)
        spellings = ("Keep-Alive",) if self._is_strict else ("Keep-Alive", "KeepAlive")
        if key not in spellings or keep_alive is None or not self._may_keep_alive(keep_alive):
            return Bad(Refused.CONNECT, line)
        self._is_connected = True
        return Connected(keep_alive)

    def _may_keep_alive(self, n: int) -> bool:
        if self._is_strict:
            return n == UNLIMITED or 2 <= n <= KEEP_ALIVE_MAX
        return n == UNLIMITED or n >= 1

    def _request(self, line: str) -> list[LineEvent]:
        words = line.strip(" \n").split(" ")
        size = _whole(words[2]) if len(words) == 3 else None
        if words[0] != "HOSTCTRL_REQUEST" or size is None or not 0 <= size <= SIZE_MAX:
            return [Bad(Refused.HEADER, line)]
        if words[1] not in self._names:
            return [Bad(Refused.COMMAND, line)]
        header = Header(words[1], size)
        if size == 0:
            return [header, Request(header.name, "", 0)]
        self._header = header
        return [header]

    def _data(self, header: Header, line: str) -> LineEvent:
        self._header = None
        is_odd = not header.size - 2 <= len(line) <= header.size
        if self._is_strict and len(line) not in (header.size - 1, header.size - 2):
            return Bad(Refused.SIZE, line)
        return Request(header.name, line.strip(" \n"), header.size, is_odd)


def _text(data: bytes | bytearray) -> str:
    return data.decode("latin-1")


def _whole(text: str) -> int | None:
    digits = text.removeprefix("-")
    if not (digits.isascii() and digits.isdigit()) or len(digits) > 9:
        return None
    return int(text)
