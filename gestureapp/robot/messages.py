"""What the application and the guardian say to each other: one JSON object a line. Pure.

A line is ``{"is": "Beat", ...}`` with the fields of the dataclass of that name. What cannot be read
is a value (``None``), never an exception.
"""

import dataclasses
import json
import math
import types
import typing
from dataclasses import dataclass, field
from enum import Enum
from typing import Any

from gestureapp.robot.address import is_loopback
from gestureapp.robot.gate import Limits
from gestureapp.robot.leftover import KeptMoves
from gestureapp.robot.values import (
    Caps,
    Direction,
    Pose,
    PoseIncrement,
    Position,
    Refusal,
    StopReason,
)


@dataclass(frozen=True, slots=True)
class Start:
    """First line on the guardian's standard input: all it needs, for good.

    Attributes:
        token: What a connection must say first.
        host: The controller's address; empty when there is none.
        port: Its TCP port.
        limits: Of everything that may move.
        log: File for the guardian's own log; empty for none.
        is_simulation: The controller is an emulator on this machine, and nothing else.
        kept: What a guardian before has learned of this controller.

    Raises:
        ValueError: a simulation is given a robot's address outside this machine.
    """

    token: str
    host: str
    port: int
    limits: Limits
    log: str
    is_simulation: bool = False
    kept: KeptMoves = field(default_factory=KeptMoves)

    def __post_init__(self) -> None:
        if self.is_simulation and self.host and not is_loopback(self.host):
            raise ValueError(f"{self.host} is not this machine: no simulation opens it")


@dataclass(frozen=True, slots=True)
class Listening:
    """The guardian's only line on standard output: where it listens."""

    port: int


class Role(Enum):
    """Who speaks on a connection."""

    CONTROL = "control"
    WINDOW = "window"
    LIFELINE = "lifeline"
    """Says nothing; its end tells that the application is gone."""


@dataclass(frozen=True, slots=True)
class Hello:
    """First line of a connection."""

    token: str
    role: Role


@dataclass(frozen=True, slots=True)
class Beat:
    """The heartbeat of the control thread. All times monotonic seconds.

    Attributes:
        left_s: Receive time of the newest left sample that counts.
        is_left_start: The left arm holds the start posture.
        is_left_stop: The left arm holds the stop posture.
        control_s: When the control thread last ran.
        gui_s: When the window's timer last ran.
    """

    left_s: float
    is_left_start: bool
    is_left_stop: bool
    control_s: float
    gui_s: float


@dataclass(frozen=True, slots=True)
class Arm:
    """The operator gives permission."""


@dataclass(frozen=True, slots=True)
class Disarm:
    """The operator takes it back."""


@dataclass(frozen=True, slots=True)
class Propose:
    """One increment, for one activation; with caps it is a stop test's."""

    activation_id: int
    direction: Direction
    t_s: float
    caps: Caps | None = None


@dataclass(frozen=True, slots=True)
class Stop:
    """Stop. ``asked_s`` is when the person or the cell asked."""

    reason: StopReason
    text: str
    asked_s: float


@dataclass(frozen=True, slots=True)
class ServoOn:
    """The operator asks for servo power."""


@dataclass(frozen=True, slots=True)
class ServoOff:
    """The operator asks for servo power to be switched off, at standstill."""


@dataclass(frozen=True, slots=True)
class Bye:
    """The application ends in order: disarmed and standing, no stop is needed."""


@dataclass(frozen=True, slots=True)
class LinkReport:
    """The line to the controller is open, or why not, and what to do where that is known."""

    is_open: bool
    text: str
    remedy: str = ""


@dataclass(frozen=True, slots=True)
class StatusReport:
    """RSTATS, as read at ``t_s``; ``alarms`` are the codes of RALARM while there are any."""

    t_s: float
    data_1: int
    data_2: int
    alarms: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class PoseReport:
    """RPOSC, as read at ``t_s``."""

    t_s: float
    position: Position


@dataclass(frozen=True, slots=True)
class Armed:
    """The guardian has taken the permission; any latch is gone."""


@dataclass(frozen=True, slots=True)
class ArmRefused:
    """It has not."""

    refusal: Refusal


@dataclass(frozen=True, slots=True)
class Disarmed:
    """The permission is gone."""


@dataclass(frozen=True, slots=True)
class CommandSent:
    """The gate let a move through; this is what went out, not what was wanted."""

    activation_id: int
    t_s: float
    start: Pose
    increment: PoseIncrement
    limited_by: str
    speed: float
    is_rotation: bool


@dataclass(frozen=True, slots=True)
class CommandAccepted:
    """The controller has accepted it (it has not finished it)."""

    activation_id: int
    t_s: float


@dataclass(frozen=True, slots=True)
class CommandRefused:
    """The gate or the controller said no; nothing moves."""

    activation_id: int
    refusal: Refusal


@dataclass(frozen=True, slots=True)
class MotionEnded:
    """The increment has come to its end, read back."""

    activation_id: int
    pose: Pose


@dataclass(frozen=True, slots=True)
class StopAsked:
    """A stop is under way. ``t_s`` is when the guardian took it up."""

    reason: StopReason
    text: str
    t_s: float


@dataclass(frozen=True, slots=True)
class StopConfirmed:
    """The robot stands: read back ``took_s`` after the stop was taken up."""

    reason: StopReason
    took_s: float
    pose: Pose


@dataclass(frozen=True, slots=True)
class StopUnconfirmed:
    """The robot has not confirmed the stop in time; it is being repeated."""

    reason: StopReason
    text: str


@dataclass(frozen=True, slots=True)
class HoldReleased:
    """The robot can take the next increment."""


@dataclass(frozen=True, slots=True)
class Hindrances:
    """All that stands against arming and no status shows; told when it changes."""

    refusals: tuple[Refusal, ...]


@dataclass(frozen=True, slots=True)
class Notice:
    """One line for the cell's story."""

    text: str


@dataclass(frozen=True, slots=True)
class Alive:
    """The guardian runs; said when it has nothing else to say."""


ToGuardian = Hello | Beat | Arm | Disarm | Propose | Stop | ServoOn | ServoOff | Bye
FromGuardian = (
    LinkReport | StatusReport | PoseReport | Armed | ArmRefused | Disarmed | CommandSent
    | CommandAccepted | CommandRefused | MotionEnded | StopAsked | StopConfirmed | StopUnconfirmed
    | HoldReleased | Hindrances | Notice | Alive
)  # fmt: skip
Message = Start | Listening | ToGuardian | FromGuardian

_CLASSES: dict[str, type] = {cls.__name__: cls for cls in typing.get_args(Message)}
_HINTS: dict[type, dict[str, Any]] = {}


def encode(message: Message) -> bytes:
    """One line, ended by LF."""
    fields = dataclasses.asdict(message)
    return json.dumps({"is": type(message).__name__, **fields}, default=_plain).encode() + b"\n"


def decode(line: bytes) -> Message | None:
    """The message of a line, or None when it is none."""
    try:
        fields = json.loads(line)
        cls = _CLASSES[fields.pop("is")]
        message = _build(cls, fields)
    except (ValueError, TypeError, KeyError, AttributeError, OverflowError, RecursionError):
        return None
    return typing.cast("Message", message)


def _plain(value: object) -> object:
    if isinstance(value, Enum):
        return value.value
    raise TypeError(type(value).__name__)


def _build(kind: Any, value: Any) -> Any:  # noqa: ANN401  the edge: anything may come
    if isinstance(kind, type) and dataclasses.is_dataclass(kind):
        hints = _HINTS.get(kind) or _HINTS.setdefault(kind, typing.get_type_hints(kind))
        if set(value) != set(hints):
            raise ValueError(f"fields of {kind}")
        return kind(**{name: _build(hints[name], value[name]) for name in hints})
    if isinstance(kind, type) and issubclass(kind, Enum):
        return kind(value)
    if isinstance(kind, types.UnionType):  # of one kind and None: what may be absent
        return None if value is None else _build(typing.get_args(kind)[0], value)
    if typing.get_origin(kind) is tuple:
        return _build_tuple(typing.get_args(kind), value)
    return _build_plain(kind, value)


def _build_tuple(kinds: tuple[Any, ...], values: list[Any]) -> tuple[Any, ...]:
    if not isinstance(values, list):
        raise ValueError("a list is needed")
    if len(kinds) == 2 and kinds[1] is Ellipsis:
        return tuple(_build(kinds[0], value) for value in values)
    return tuple(_build(kind, value) for kind, value in zip(kinds, values, strict=True))


def _build_plain(kind: type, value: Any) -> Any:  # noqa: ANN401  as above
    if kind is float and type(value) in (int, float):
        if math.isnan(value):
            raise ValueError("not a number")
        return float(value)
    if type(value) is not kind:
        raise ValueError(f"{kind.__name__} is needed")
    return value
