"""Whose turn it is on the robot's line: what may be sent, which answer is awaited. Pure.

At most one request is in flight. Bytes and the time come in, bytes and events go out; the end of
the stream is an input like any other. Nothing here raises on what the wire brings.
"""

from dataclasses import dataclass
from enum import Enum

from gestureapp.robot import nx100
from gestureapp.robot.gate import Permit
from gestureapp.robot.nx100 import Answer, Failure, Request, Unreadable


class Phase(Enum):
    """Where the exchange stands."""

    CLOSED = "closed"
    OPENING = "opening"
    IDLE = "idle"
    HEADER_SENT = "header sent"
    DATA_SENT = "data sent"


@dataclass(frozen=True, slots=True)
class Opened:
    """The controller took the session."""

    banner: str


@dataclass(frozen=True, slots=True)
class Answered:
    """The controller answered, good or bad. ``took_s`` from the first byte of the request."""

    request: Request
    answer: Answer
    took_s: float


@dataclass(frozen=True, slots=True)
class LinkBroken:
    """The line cannot be trusted any more: drop the socket. ``request`` was in flight, or None."""

    request: Request | None
    reason: str


ExchangeEvent = Opened | Answered | LinkBroken

OPENING_LIMIT_S = 1.5
"""A controller that answers in 0.5 s must still be reached, or it could never be told to hold."""

ANSWER_LIMIT_S = {"RSTATS": 0.3, "RPOSC": 0.3, "RALARM": 0.3, "IMOV": 0.5, "HOLD": 0.8, "SVON": 3}
"""Reads are short so that a stop never waits long behind one. HOLD is longer: dropping a slow line
in the middle of it would mean never holding. SVON on may come late: vendor SDKs wait up to 10 s.
"""

HARMLESS = frozenset({nx100.HOLD_ON, nx100.SERVO_OFF})
"""Requests with data that only ever stop: a stop does not take them back."""


class Exchange:
    """One session with the controller. Owned by the supervisor.

    Attributes:
        phase: Where it stands.
        request: The one in flight, or None.
    """

    def __init__(self) -> None:
        self.phase = Phase.CLOSED
        self.request: Request | None = None
        self._lines = nx100.LineSplitter()
        self._since_s = 0.0
        self._deadline_s = float("inf")

    @property
    def can_send(self) -> bool:
        """A request may be sent now."""
        return self.phase is Phase.IDLE

    @property
    def is_open(self) -> bool:
        """The controller has taken the session."""
        return self.phase in (Phase.IDLE, Phase.HEADER_SENT, Phase.DATA_SENT)

    @property
    def deadline_s(self) -> float:
        """When ``check`` will find the awaited line overdue; infinite while none is awaited."""
        return self._deadline_s

    def connected(self, now_s: float) -> bytes:
        """The socket is connected: the bytes that open the session."""
        self._lines = nx100.LineSplitter()
        self._await(Phase.OPENING, None, now_s, OPENING_LIMIT_S)
        return nx100.CONNECT

    def send(self, permit: Permit, now_s: float, *, is_stopping: bool = False) -> bytes:
        """Start a request that the gate let through: the bytes of its header.

        Args:
            permit: From the gate.
            now_s: Monotonic clock.
            is_stopping: A stop is under way: a read may take as long as a HOLD, or a slow
                controller could never confirm the stop.

        Raises:
            RuntimeError: a request is in flight or the session is not open; a bug of the caller.
        """
        if not self.can_send:
            raise RuntimeError(f"{permit.request} asked for while {self.phase.value}")
        limit_s = ANSWER_LIMIT_S.get(permit.request.name, 0.3)
        if is_stopping:
            limit_s = max(limit_s, ANSWER_LIMIT_S["HOLD"])
        self._await(Phase.HEADER_SENT, permit.request, now_s, limit_s)
        return permit.request.header

    def receive(self, data: bytes, now_s: float) -> tuple[list[ExchangeEvent], bytes]:
        """Take bytes from the controller: what they mean, and the bytes to send in turn."""
        events: list[ExchangeEvent] = []
        out = b""
        if self.phase is Phase.CLOSED:
            return events, out
        for raw in self._lines.feed(data):
            event, more = self._hear(raw, out, now_s)
            out += more
            if event is not None:
                events.append(event)
            if isinstance(event, LinkBroken):
                return events, b""
        if self._lines.is_overlong:
            events.append(self._break(f"no line end in {len(self._lines.rest)} bytes"))
            return events, b""
        return events, out

    def withdraw(self) -> LinkBroken | None:
        """Take back a request whose data has not gone out yet: the session ends with it.

        The controller awaits data now; ending the session is the only way not to send any.
        Reads, stops and the supervised input, which move nothing, are not taken back.
        """
        request = self.request
        if self.phase is not Phase.HEADER_SENT or request is None or request.data is None:
            return None
        if request in HARMLESS or request.name in ("RPOSC", "IOWRITE"):
            return None
        return self._break(f"{request.name} was taken back before its data went out")

    def end(self, reason: str) -> list[ExchangeEvent]:
        """The stream has ended, or could not be opened."""
        if self.phase is Phase.CLOSED:
            return []
        return [self._break(reason)]

    def check(self, now_s: float) -> list[ExchangeEvent]:
        """Has the awaited line been missing for too long?"""
        if now_s < self._deadline_s:
            return []
        awaited = "CONNECT" if self.request is None else str(self.request)
        return [self._break(f"no answer to {awaited} within {now_s - self._since_s:.2f} s")]

    def _hear(self, raw: bytes, unsent: bytes, now_s: float) -> tuple[ExchangeEvent | None, bytes]:
        if len(raw) > nx100.MAX_LINE:
            return self._break(f"a line of {len(raw)} bytes"), b""
        line = raw.decode("ascii", "backslashreplace")
        if unsent:
            return self._break(f"the controller said {_short(line)} before it had the data"), b""
        return self._line(line, now_s)

    def _line(self, line: str, now_s: float) -> tuple[ExchangeEvent | None, bytes]:
        match self.phase:
            case Phase.OPENING:
                return self._opening(line), b""
            case Phase.HEADER_SENT:
                return self._header_answer(line, now_s)
            case Phase.DATA_SENT:
                return self._data_answer(line, now_s), b""
        return self._break(f"the controller said {_short(line)} without being asked"), b""

    def _opening(self, line: str) -> ExchangeEvent:
        if not nx100.is_banner(line):
            return self._break(f"the controller did not take the session: {_short(line)}")
        self._idle()
        return Opened(line)

    def _header_answer(self, line: str, now_s: float) -> tuple[ExchangeEvent | None, bytes]:
        request = self.request
        assert request is not None
        if line == f"OK: {request.name}":
            limit_s = self._deadline_s - self._since_s
            self.phase = Phase.DATA_SENT
            self._deadline_s = now_s + limit_s
            return None, request.payload
        failure = nx100.parse_failure(line)
        if failure is not None and line.startswith("ERROR"):
            return self._answered(failure, now_s), b""
        if failure is not None:
            return self._break(f"the controller refused {request.name}: {_short(line)}"), b""
        return self._break(f"{request.name} was answered by {_short(line)} instead of OK"), b""

    def _data_answer(self, line: str, now_s: float) -> ExchangeEvent:
        request = self.request
        assert request is not None
        answer = nx100.parse_answer(request, line)
        if isinstance(answer, Unreadable):
            return self._break(
                f"{request.name} was answered by {_short(line)}, expected {answer.expected}"
            )
        if isinstance(answer, Failure) and line.startswith("NG"):
            return self._break(f"the controller refused {request.name}: {_short(line)}")
        return self._answered(answer, now_s)

    def _answered(self, answer: Answer, now_s: float) -> ExchangeEvent:
        request = self.request
        assert request is not None
        event = Answered(request, answer, now_s - self._since_s)
        self._idle()
        return event

    def _await(self, phase: Phase, request: Request | None, now_s: float, limit_s: float) -> None:
        self.phase = phase
        self.request = request
        self._since_s = now_s
        self._deadline_s = now_s + limit_s

    def _idle(self) -> None:
        self.phase = Phase.IDLE
        self.request = None
        self._deadline_s = float("inf")

    def _break(self, reason: str) -> LinkBroken:
        event = LinkBroken(self.request, reason)
        self.phase = Phase.CLOSED
        self.request = None
        self._deadline_s = float("inf")
        return event


def _short(line: str) -> str:
    return repr(line if len(line) <= 60 else line[:60] + "…")
