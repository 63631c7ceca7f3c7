"""One connection's conversation with the emulated NX100: bytes and time in, bytes out. Pure.

The order of what goes out is that of what came in, however late a part of it is.
"""

import math
import random
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

from gestureapp.simulation.nx100_commands import NAMES, READS, Answer, refusal
from gestureapp.simulation.nx100_lines import (
    UNLIMITED,
    Bad,
    Connected,
    Header,
    LineEvent,
    Request,
    RequestReader,
)
from gestureapp.simulation.nx100_options import Fault, FaultKind, Nx100Options, Segments

WAITING_MAX = 1000
"""Answers a client may leave unread before it is given up."""

Execute = Callable[[Request, float], Answer]


@dataclass(frozen=True, slots=True)
class _Reply:
    """Sent as soon as its time has come; made then, so that reads are fresh."""

    at_s: float
    make: Callable[[float], bytes]


@dataclass(frozen=True, slots=True)
class _Chunk:
    at_s: float
    data: bytes


class Conversation:
    """What is said on one connection. Owned by the server's loop.

    Attributes:
        is_closing: The last answer is on its way or out; nothing is read any more.
        is_refused: Closing because of NG: the client sees the end as soon as it has the NG.
    """

    def __init__(self, options: Nx100Options, execute: Execute, now_s: float) -> None:
        self.is_closing = False
        self.is_refused = False
        self._options = options
        self._execute = execute
        self._reader = RequestReader(NAMES, options.is_strict)
        self._replies: deque[_Reply] = deque()
        self._chunks: deque[_Chunk] = deque()
        self._budget = UNLIMITED
        self._unsent_ok = b""
        self._n_heard = 0
        self._ok_at_n = 0
        self._close_s = math.inf
        self._heard_s = now_s
        self._noise = random.Random(0)

    def receive(self, data: bytes, now_s: float, fault: Fault) -> list[LineEvent]:
        """Take bytes; what they ask for is done now, what is to be said waits for `take`.

        Returns:
            What was read, for the log.
        """
        self._heard_s = now_s
        self._n_heard += 1
        events: list[LineEvent] = []
        if self.is_closing:
            return events
        for event in self._reader.receive(data):
            events.append(event)
            self._meet(event, now_s, fault)
            if self.is_closing or len(self._replies) > WAITING_MAX:
                self.is_closing = True
                break
        self._say_ok(now_s)
        return events

    def take(self, now_s: float, fault: Fault) -> list[bytes]:
        """Give the segments that are due, each to be sent by itself."""
        while self._replies and self._replies[0].at_s <= now_s:
            self._cut(self._replies.popleft().make(now_s), now_s, fault)
        due = []
        while self._chunks and self._chunks[0].at_s <= now_s:
            due.append(self._chunks.popleft().data)
        if self.is_closing and self.is_drained and self._close_s == math.inf:
            self._close_s = now_s + self._options.close_delay_s
        if self._options.segments in (Segments.COALESCED, Segments.LATE_LF) and due:
            return [b"".join(due)]
        return due

    @property
    def is_drained(self) -> bool:
        """Whether everything has been said."""
        return not self._replies and not self._chunks

    @property
    def next_s(self) -> float:
        """When `take` or `is_over` has news; infinity when never without more bytes."""
        reply_s = self._replies[0].at_s if self._replies else math.inf
        chunk_s = self._chunks[0].at_s if self._chunks else math.inf
        return min(reply_s, chunk_s, self._close_s, self._idle_s)

    def is_over(self, now_s: float) -> bool:
        """Whether the controller closes the connection now."""
        return now_s >= min(self._close_s, self._idle_s)

    @property
    def _idle_s(self) -> float:
        limit_s = self._options.idle_close_s
        return math.inf if limit_s is None or not self.is_drained else self._heard_s + limit_s

    def _meet(self, event: LineEvent, now_s: float, fault: Fault) -> None:
        if isinstance(event, Request):
            self._answer(event, now_s, fault)
        elif fault.kind is FaultKind.SILENT:
            return
        elif isinstance(event, Bad):
            self._say_ok(now_s)
            self._refuse(event.refused.value, now_s)
        elif fault.kind is FaultKind.NG:
            self._refuse("503 Service Unavailable", now_s)
        elif isinstance(event, Connected):
            self._greet(event, now_s)
        else:
            self._accept(event, now_s)

    def _greet(self, event: Connected, now_s: float) -> None:
        """The tail was recorded on a DX100, its prefix on an NX100."""
        self._budget = 1 if event.keep_alive is None else event.keep_alive
        kept = "" if event.keep_alive is None else f" Keep-Alive:{event.keep_alive}"
        banner = f"OK: NX Information Server( {self._options.version}){kept}.\r\n"
        self._say(banner.encode("ascii"), now_s)

    def _accept(self, header: Header, now_s: float) -> None:
        ok = f"OK: {header.name}\r\n".encode("ascii")
        if self._options.segments is Segments.COALESCED:
            self._unsent_ok += ok
        else:
            self._say(ok, now_s)
            self._ok_at_n = self._n_heard

    def _say_ok(self, now_s: float) -> None:
        if self._unsent_ok:
            self._say(self._unsent_ok, now_s)
            self._unsent_ok = b""

    def _answer(self, request: Request, now_s: float, fault: Fault) -> None:
        if fault.kind in (FaultKind.SILENT, FaultKind.NG):
            if fault.is_executed:
                self._execute(request, now_s)
            return
        ok, self._unsent_ok = self._unsent_ok, b""
        at_s = now_s + self._answer_delay_s()
        if fault.kind is FaultKind.ERROR:
            if fault.is_executed:
                self._execute(request, now_s)
            self._say(ok + refusal(request.name, fault.code).wire, at_s)
        elif request.name in READS:
            self._reply(at_s, lambda t_s: ok + self._execute(request, t_s).wire)
        else:
            answer = self._execute(request, now_s)
            self._say(ok + answer.wire, at_s + answer.delay_s)
        self._count()

    def _answer_delay_s(self) -> float:
        """Give the delay; longer in SEPARATE mode if nobody had to wait for the OK to come here."""
        options = self._options
        if options.segments is Segments.SEPARATE and self._ok_at_n == self._n_heard:
            return max(options.separation_s, options.answer_delay_s)
        return options.answer_delay_s

    def _count(self) -> None:
        if self._budget > 0:
            self._budget -= 1
            self.is_closing = self._budget == 0

    def _refuse(self, text: str, now_s: float) -> None:
        self._say(f"NG: {text}\r\n".encode("ascii"), now_s)
        self.is_closing = self.is_refused = True

    def _say(self, data: bytes, at_s: float) -> None:
        self._reply(at_s, lambda _: data)

    def _reply(self, at_s: float, make: Callable[[float], bytes]) -> None:
        latest_s = self._replies[-1].at_s if self._replies else at_s
        self._replies.append(_Reply(max(at_s, latest_s), make))

    def _cut(self, data: bytes, now_s: float, fault: Fault) -> None:
        """Queue what was made as the chunks that the segment mode or the fault wants."""
        if fault.kind is FaultKind.SILENT:
            return
        if fault.kind is FaultKind.GARBAGE:
            data = self._noise.randbytes(self._noise.randint(1, 64))
        at_s = now_s + (fault.delay_s if fault.kind is FaultKind.SLOW else 0.0)
        options = self._options
        if fault.kind is FaultKind.PIECES:
            self._spread(_pieces(data, fault.piece_bytes), at_s, fault.gap_s, fault.gap_s)
        elif options.segments is Segments.BYTEWISE:
            self._spread(_pieces(data, 1), at_s, options.byte_gap_s, options.byte_gap_s)
        elif options.segments is Segments.LATE_LF and data.endswith(b"\r\n"):
            self._spread([data[:-1], data[-1:]], at_s, options.late_lf_s)
        else:
            self._spread([data], at_s)

    def _spread(
        self, pieces: list[bytes], at_s: float, gap_s: float = 0.0, lead_s: float = 0.0
    ) -> None:
        if self._chunks:
            at_s = max(at_s, self._chunks[-1].at_s + lead_s)
        for i, piece in enumerate(pieces):
            self._chunks.append(_Chunk(at_s + i * gap_s, piece))


def _pieces(data: bytes, size: int) -> list[bytes]:
    return [data[i : i + size] for i in range(0, len(data), max(1, size))]
