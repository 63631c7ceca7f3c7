"""The NX100's Ethernet server protocol: requests to bytes, bytes to lines, lines to answers. Pure.

One command is a header line, the controller's ``OK: CMD``, then data where the command has some,
then the answer. Data answers end in CR only, everything else in CRLF; the LF may come in a later
segment. Source: vendor's Ethernet server manual for the next controller generation, pages 14 and
15, and the bytes that clients recorded on NX100 controllers.
"""

import math
import re
from dataclasses import dataclass

from gestureapp.robot.values import Pose, PoseIncrement, Position, Posture, RobotStatus

CONNECT = b"CONNECT Robot_access Keep-Alive:-1\r\n"
"""One session for as many commands as we like: opening many exhausts the controller's sockets."""

MAX_LINE = 512
"""Longer than any answer (14 fields of RPOSC with external axes are about 150 bytes)."""

TOOL_MAX = 23
TYPE_BITS = 0x3F

_BANNER = re.compile(r"OK: \S{2} Information Server\b.*")
_CODE = re.compile(r"\((\d{4})\)")
_BARE_CODE = re.compile(r"\d{4}")
_NUMBER = re.compile(r"[+-]?\d+(\.\d*)?|[+-]?\.\d+")


@dataclass(frozen=True, slots=True)
class Request:
    """One command with its data; ``data`` is None where the command has none."""

    name: str
    data: str | None = None

    @property
    def header(self) -> bytes:
        """The header line. Its size counts the data and one CR, as most clients send it."""
        size = 0 if self.data is None else len(self.data) + 1
        return f"HOSTCTRL_REQUEST {self.name} {size}\r\n".encode("ascii")

    @property
    def payload(self) -> bytes:
        """The data with its line end; empty where the command has none."""
        return b"" if self.data is None else f"{self.data}\r".encode("ascii")

    @property
    def is_hold(self) -> bool:
        """The path stop, HOLD 1."""
        return self == HOLD_ON

    def __str__(self) -> str:
        return self.name if self.data is None else f"{self.name} {self.data}"


READ_STATUS = Request("RSTATS")
READ_ALARMS = Request("RALARM")
HOLD_ON = Request("HOLD", "1")
HOLD_OFF = Request("HOLD", "0")
SERVO_ON = Request("SVON", "1")
SERVO_OFF = Request("SVON", "0")


def read_pose(frame: int = 1) -> Request:
    """RPOSC in a frame (1 is the robot's), without external axes."""
    return Request("RPOSC", f"{frame},0")


def move_increment(increment: PoseIncrement, speed: float, frame: int, tool: int) -> Request:
    """IMOV, 17 fields: speed class, speed, frame, six increments, reserved, tool, external axes.

    Args:
        increment: In the given frame.
        speed: mm/s for a pure translation (class 0), deg/s as soon as an angle changes (class 1):
            class 0 gives fast wrist turns with a rotation.
        frame: 0 base, 1 robot, 2 to 25 user 1 to 24.
        tool: 0 to 23.
    """
    speed_class = 1 if increment.is_rotation else 0
    lengths = ",".join(_decimal(v, 3) for v in increment.translation_mm)
    angles = ",".join(_decimal(v, 2) for v in increment.rotation_deg)
    speed_text = _decimal(wire_speed(speed), 1)
    data = f"{speed_class},{speed_text},{frame},{lengths},{angles},0,{tool},0,0,0,0,0,0"
    return Request("IMOV", data)


NETWORK_INPUTS = range(22010, 23288, 10)
"""The first input of each byte that IOWRITE may write; the next byte is 10 higher. Source: an NX100
client's notes, and the data transmission manual's example."""


def write_input(first: int, value: int) -> Request:
    """IOWRITE of one byte of network inputs: start, count of contacts, value.

    Args:
        first: Out of ``NETWORK_INPUTS``; bit 0 of the byte.
        value: 0 to 255.
    """
    return Request("IOWRITE", f"{first},8,{value}")


def wire_speed(speed: float) -> float:
    """The speed as it can be said: one decimal, never above what was let through."""
    return math.floor(speed * 10) / 10


def _decimal(value: float, places: int) -> str:
    return f"{round(value, places) + 0.0:.{places}f}"  # + 0.0 turns -0.0 into 0.0


class LineSplitter:
    """Cuts the controller's byte stream into lines, however it was cut into segments.

    A line ends at CR; an LF at the start of a line belongs to the one before and is dropped.
    """

    def __init__(self) -> None:
        self._rest = b""

    def feed(self, data: bytes) -> list[bytes]:
        """The lines completed by these bytes, without their ends."""
        *lines, self._rest = (self._rest + data).split(b"\r")
        lines = [line.lstrip(b"\n") for line in lines]
        self._rest = self._rest.lstrip(b"\n")
        return lines

    @property
    def is_overlong(self) -> bool:
        """More bytes without a line end than any answer has."""
        return len(self._rest) > MAX_LINE

    @property
    def rest(self) -> bytes:
        """What stands after the last line end."""
        return self._rest


@dataclass(frozen=True, slots=True)
class Done:
    """``0000``: the command was accepted (not: finished)."""


@dataclass(frozen=True, slots=True)
class Alarms:
    """RALARM: pairs of code and data; the first is the error, then up to four alarms. 0 is none."""

    pairs: tuple[tuple[int, int], ...]

    @property
    def codes(self) -> tuple[int, ...]:
        """The codes that are present."""
        return tuple(code for code, _ in self.pairs if code)


@dataclass(frozen=True, slots=True)
class Failure:
    """``ERROR`` or ``NG``: the controller did not do it. ``code`` is None where it gave none."""

    code: int | None
    text: str

    @property
    def words(self) -> str:
        """What the code means, or the controller's own text."""
        known = CODES.get(self.code or 0)
        return f"{known} ({self.code})" if known else self.text


@dataclass(frozen=True, slots=True)
class Unreadable:
    """An answer that is none of the documented forms. ``expected`` says what was awaited."""

    text: str
    expected: str


Answer = Done | RobotStatus | Position | Alarms | Failure | Unreadable

CODES = {
    1010: "command error",
    1011: "wrong number of operands",
    1012: "operand out of range",
    1013: "operand length error",
    2010: "manipulator moving",
    2020: "held by the pendant",
    2030: "held by the playback panel",
    2040: "held externally",
    2050: "held by command",
    2060: "error or alarm present",
    2070: "servo off",
    2080: "wrong mode",
    2100: "command remote not set",
    3010: "servo power must be turned on first",
    3350: "user frame not taught",
    3450: "servo power cannot be turned on",
    5200: "data out of range",
}
"""What a move, a hold or a read may meet. Source: Yaskawa's own HSES dissector lists the same."""


def is_banner(line: str) -> bool:
    """Whether the line opens a session. Only the prefix is the same on all controllers."""
    return _BANNER.fullmatch(line) is not None


def parse_failure(line: str) -> Failure | None:
    """The failure that a line tells of, or None when it is no failure."""
    if line.startswith(("ERROR", "NG")):
        code = _CODE.search(line)
        return Failure(int(code[1]) if code else None, line)
    if _BARE_CODE.fullmatch(line) and line != "0000":
        return Failure(int(line), line)
    return None


def parse_answer(request: Request, line: str) -> Answer:
    """What a line says in answer to a request. Never raises."""
    failure = parse_failure(line)
    if failure is not None:
        return failure
    parse = _PARSERS.get(request.name, _parse_done)
    return parse(line)


def _parse_done(line: str) -> Answer:
    return Done() if line == "0000" else Unreadable(line, "0000")


def _parse_status(line: str) -> Answer:
    numbers = _numbers(line, whole=True)
    if numbers is None or len(numbers) != 2 or not all(0 <= n <= 255 for n in numbers):
        return Unreadable(line, "two bytes")
    return RobotStatus(int(numbers[0]), int(numbers[1]))


def _parse_position(line: str) -> Answer:
    numbers = _numbers(line, whole=False)
    if numbers is None or len(numbers) not in (8, 14) or any(abs(n) > 1e6 for n in numbers[:6]):
        return Unreadable(line, "x,y,z,rx,ry,rz,type,tool")
    posture, tool = numbers[6:8]
    if posture not in range(TYPE_BITS + 1) or tool not in range(TOOL_MAX + 1):
        return Unreadable(line, f"type 0 to {TYPE_BITS} and tool 0 to {TOOL_MAX}")
    return Position(Pose(*numbers[:6]), Posture(int(posture)), int(tool))


def _parse_alarms(line: str) -> Answer:
    numbers = _numbers(line, whole=True)
    if numbers is None or len(numbers) != 10:
        return Unreadable(line, "five pairs of code and data")
    whole = [int(n) for n in numbers]
    return Alarms(tuple(zip(whole[::2], whole[1::2], strict=True)))


_PARSERS = {"RSTATS": _parse_status, "RPOSC": _parse_position, "RALARM": _parse_alarms}


def _numbers(line: str, *, whole: bool) -> list[float] | None:
    fields = [field.strip() for field in line.split(",")]
    if not all(_NUMBER.fullmatch(field) for field in fields):
        return None
    numbers = [float(field) for field in fields]
    if not all(math.isfinite(n) and (not whole or n == int(n)) for n in numbers):
        return None
    return numbers
