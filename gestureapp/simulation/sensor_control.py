"""The control language of the sensor emulator: one JSON object in, one out. Pure.

    {"do":"perform","label":"X+","at_s":T}      right arm; at_s is monotonic time, now if left out;
                 "hold_s":H, "back_s":B         also: hold the end so long, go back in that time
    {"do":"rest","at_s":T}                      right arm returns to rest; left arm to stop
    {"do":"take","posture":"start"|"stop","at_s":T}                      left arm
    {"do":"lie","position":"z-up","askew_deg":D,"at_s":T}   laid on a table: x, y or z, up or down
    {"do":"fault","kind":"none"|"silent"|"frozen"|"garbage"|"truncated"|"spike"|"slow"|"unplugged"
                         |"stall"|"jump", "seconds":S, "counts_on":bool, "spike_g":G,
                         "rate_hz":R, "jump":n, "burst":bool}
    {"do":"log","count":k}                      the last k lines written
    {"do":"state"}

An answer has ``"ok": true`` and what was asked, or ``"ok": false`` and ``"error"`` in words.
"""

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from gestureapp.gestures import LABELS
from gestureapp.sensing.values import ArmPosture, Side
from gestureapp.simulation.laid import LYING
from gestureapp.simulation.sensor_model import (
    JUMP,
    RATE_HZ,
    SLOW_HZ,
    SPIKE_G,
    ArmAction,
    Fault,
    FaultKind,
    SensorModel,
    Verb,
)
from gestureapp.simulation.sensor_wire import Accel

Answer = dict[str, object]

AHEAD_MAX_S = 60.0
"""An action is scheduled this far ahead at most; more is taken for a mistaken clock."""

BACK_MIN_S = 0.2
"""No hand is back sooner."""

RATE_MAX_HZ = 2000.0


@dataclass(frozen=True, slots=True)
class SentLine:
    """A line whose last byte the operating system has taken.

    Attributes:
        sent_s: Monotonic time right before the send: nobody can have received it earlier.
        counter: Its running number.
        accel_g: What it says.
    """

    sent_s: float
    counter: int
    accel_g: Accel


@dataclass(frozen=True, slots=True)
class StreamRecord:
    """How the stream went so far.

    Attributes:
        lines: The last lines written, oldest first.
        has_client: Somebody is connected now.
        n_sent: Lines written.
        n_dropped: Lines not written because the client did not read.
        n_overruns: Ticks missed by this process and never made up.
    """

    lines: tuple[SentLine, ...] = ()
    has_client: bool = False
    n_sent: int = 0
    n_dropped: int = 0
    n_overruns: int = 0


class _CommandError(Exception):
    """The command cannot be done; the text says why."""


def answer_command(model: SensorModel, line: bytes, now_s: float, record: StreamRecord) -> Answer:
    """Do what one line asks.

    Args:
        model: The sensor.
        line: The command without its line end; anything may stand in it.
        now_s: Monotonic time.
        record: How the stream went.

    Returns:
        The answer; JSON can write it.
    """
    try:
        command = _parse(line)
        word = _word(command, "do")
        if word not in _VERBS:
            raise _CommandError(f"unknown word {word!r}: one of {', '.join(_VERBS)}")
        answer = _VERBS[word](model, command, now_s, record)
    except _CommandError as refusal:
        return {"ok": False, "error": str(refusal)}
    return {"ok": True, **answer}


def _parse(line: bytes) -> Mapping[str, object]:
    try:
        command = json.loads(line)
    except (ValueError, RecursionError):
        raise _CommandError("not JSON: one object on one line is expected") from None
    if not isinstance(command, dict):
        raise _CommandError("not a JSON object")
    return command


def _perform(model: SensorModel, command: Mapping[str, object], now_s: float, _: object) -> Answer:
    if model.side is not Side.RIGHT:
        raise _CommandError("gestures belong to the right arm; the left arm takes start and stop")
    label = _word(command, "label")
    if label not in LABELS:
        raise _CommandError(f"no gesture {label!r}: one of {', '.join(LABELS)}")
    hold_s = _number(command, "hold_s", None, 0.0, AHEAD_MAX_S)
    back_s = _number(command, "back_s", None, BACK_MIN_S, AHEAD_MAX_S)
    return _schedule(model, ArmAction(Verb.PERFORM, label, hold_s, back_s), command, now_s)


def _rest(model: SensorModel, command: Mapping[str, object], now_s: float, _: object) -> Answer:
    left = model.side is Side.LEFT
    action = ArmAction(Verb.TAKE, ArmPosture.STOP.value) if left else ArmAction(Verb.REST)
    return _schedule(model, action, command, now_s)


def _take(model: SensorModel, command: Mapping[str, object], now_s: float, _: object) -> Answer:
    if model.side is not Side.LEFT:
        raise _CommandError("start and stop belong to the left arm; the right arm makes gestures")
    posture = _word(command, "posture")
    if posture not in (ArmPosture.START.value, ArmPosture.STOP.value):
        raise _CommandError(f"no posture {posture!r}: start or stop")
    return _schedule(model, ArmAction(Verb.TAKE, posture), command, now_s)


def _lie(model: SensorModel, command: Mapping[str, object], now_s: float, _: object) -> Answer:
    position = _word(command, "position")
    if position not in LYING:
        raise _CommandError(f"no position {position!r}: one of {', '.join(LYING)}")
    askew_deg = _real(command, "askew_deg", 0.0, -45.0, 45.0)
    return _schedule(model, ArmAction(Verb.LIE, position, askew_deg=askew_deg), command, now_s)


def _fault(model: SensorModel, command: Mapping[str, object], now_s: float, _: object) -> Answer:
    word = _word(command, "kind")
    try:
        kind = FaultKind(word)
    except ValueError:
        known = ", ".join(kind.value for kind in FaultKind)
        raise _CommandError(f"no fault {word!r}: one of {known}") from None
    seconds = _number(command, "seconds", None, 0.0, 3600.0)
    if kind is FaultKind.STALL and seconds is None:
        raise _CommandError("a stall needs its seconds")
    model.set_fault(
        Fault(
            kind,
            seconds,
            _yes(command, "counts_on", True),
            _real(command, "spike_g", SPIKE_G, -1e6, 1e6),
            _real(command, "rate_hz", SLOW_HZ, 0.1, RATE_MAX_HZ),
            int(_real(command, "jump", JUMP, -1e5, 1e5)),
            _yes(command, "burst", False),
        ),
        now_s,
    )
    return {"fault": kind.value}


def _state(
    model: SensorModel, _: Mapping[str, object], now_s: float, record: StreamRecord
) -> Answer:
    doing = model.doing
    return {
        "t_s": now_s,
        "side": model.side.value,
        "protocol": model.protocol,
        "rate_hz": 1.0 / model.period_s,
        "fault": model.fault.kind.value,
        "doing": None if doing is None else f"{doing.verb.value} {doing.what}".strip(),
        "scheduled_s": model.scheduled_s,
        "has_client": record.has_client,
        "n_sent": record.n_sent,
        "n_dropped": record.n_dropped,
        "n_overruns": record.n_overruns,
    }


def _log(_: object, command: Mapping[str, object], __: float, record: StreamRecord) -> Answer:
    count = int(_real(command, "count", RATE_HZ, 1, 1e6))
    lines = record.lines[-count:]
    return {
        "log": [
            {"sent_s": line.sent_s, "n": line.counter, "accel_g": list(line.accel_g)}
            for line in lines
        ]
    }


_VERBS: dict[str, Callable[[SensorModel, Mapping[str, object], float, StreamRecord], Answer]] = {
    "perform": _perform,
    "rest": _rest,
    "take": _take,
    "lie": _lie,
    "fault": _fault,
    "log": _log,
    "state": _state,
}


def _schedule(
    model: SensorModel, action: ArmAction, command: Mapping[str, object], now_s: float
) -> Answer:
    at_s = _number(command, "at_s", now_s, -1e9, now_s + AHEAD_MAX_S)
    return {"at_s": model.schedule(action, now_s if at_s is None else at_s, now_s)}


def _word(command: Mapping[str, object], key: str) -> str:
    value = command.get(key)
    if not isinstance(value, str):
        raise _CommandError(f"{key!r} is missing or not a text")
    return value


def _yes(command: Mapping[str, object], key: str, default: bool) -> bool:
    value = command.get(key, default)
    if not isinstance(value, bool):
        raise _CommandError(f"{key!r} is not true or false")
    return value


def _real(
    command: Mapping[str, object], key: str, default: float, low: float, high: float
) -> float:
    value = _number(command, key, default, low, high)
    return default if value is None else value


def _number(
    command: Mapping[str, object], key: str, default: float | None, low: float, high: float
) -> float | None:
    value = command.get(key)
    if value is None:
        return default
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise _CommandError(f"{key!r} is not a number")
    if not low <= value <= high:
        raise _CommandError(f"{key!r} = {value} is not between {low:g} and {high:g}")
    return float(value)
