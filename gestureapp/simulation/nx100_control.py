"""The virtual pendant's language: one JSON line asks, one answers.

    {"do": "servo", "on": true}         {"do": "remote", "on": false}
    {"do": "pendant_hold", "on": true}  {"do": "external_hold", "on": true}
    {"do": "alarm", "code": 4100}       {"do": "error", "code": 2060}
    {"do": "mode", "mode": "teach"}     {"do": "pose", "x": 800, ..., "rz": 0}
    {"do": "fault", "kind": "slow", "ms": 500}     {"do": "state"}

Every answer has "ok"; a refused line has "error" in words. Numbers are mm, degrees, milliseconds.
"""

import json
import math
from collections.abc import Callable, Mapping
from typing import Protocol

from gestureapp.errors import GestureAppError
from gestureapp.robot.values import Pose
from gestureapp.simulation.controller import Controller
from gestureapp.simulation.nx100_options import Fault, FaultKind
from gestureapp.simulation.nx100_values import Hold, Mode

Fields = Mapping[str, object]
MAX_CODE = 9999


class Pendant(Protocol):
    """What can be done by hand at an emulated NX100."""

    @property
    def controller(self) -> Controller:
        """The model."""

    def now_s(self) -> float:
        """The emulator's time."""

    def servo(self, is_on: bool) -> None:
        """Switch servo power."""

    def remote(self, is_on: bool) -> None:
        """Select command remote."""

    def hold(self, who: Hold, is_on: bool) -> None:
        """Hold or release."""

    def alarm(self, code: int, data: int = 0) -> None:
        """Raise an alarm."""

    def error(self, code: int, data: int = 0) -> None:
        """Show an error."""

    def mode(self, mode: Mode) -> None:
        """Turn the key."""

    def place(self, pose: Pose) -> bool:
        """Put the arm elsewhere."""

    def fault(self, fault: Fault) -> None:
        """Let something be wrong."""


class _WrongLineError(Exception):
    """A line that cannot be obeyed; its text is the answer."""


def obey(pendant: Pendant, line: bytes) -> dict[str, object]:
    """Do what a line asks. Never raises on what it says.

    Args:
        pendant: The emulator; called in the emulator's own thread.
        line: JSON object with "do".
    """
    try:
        fields = json.loads(line)
    except (ValueError, RecursionError):
        return _refused("not a line of JSON")
    if not isinstance(fields, dict):
        return _refused('not an object such as {"do": "state"}')
    action = _ACTIONS.get(str(fields.get("do")))
    if action is None:
        return _refused(f'"do" is one of {", ".join(_ACTIONS)}')
    try:
        return {"ok": True} | (action(pendant, fields) or {})
    except _WrongLineError as wrong:
        return _refused(str(wrong))
    except GestureAppError as error:
        return _refused(str(error))


def fault_of(fields: Fields) -> Fault:
    """Read a fault: "kind", and where they apply "ms", "code", "size", "gap_ms", "execute".

    Raises:
        ValueError: in words, what is wrong.
    """
    kinds = {kind.value: kind for kind in FaultKind}
    kind = kinds.get(str(fields.get("kind")))
    if kind is None:
        raise ValueError(f'"kind" is one of {", ".join(kinds)}')
    executes = fields.get("execute")
    if executes is not None and not isinstance(executes, bool):
        raise ValueError('"execute" is true or false')
    try:
        return Fault(
            kind=kind,
            delay_s=_number(fields, "ms", 500.0, 0.0, 60_000.0) / 1000.0,
            code=int(_number(fields, "code", 2060, 0, MAX_CODE)),
            piece_bytes=int(_number(fields, "size", 3, 1, 4096)),
            gap_s=_number(fields, "gap_ms", 20.0, 0.0, 60_000.0) / 1000.0,
            executes=executes,
        )
    except _WrongLineError as wrong:
        raise ValueError(str(wrong)) from wrong


def state(pendant: Pendant) -> dict[str, object]:
    """Give what a person would read off the pendant."""
    controller, now_s = pendant.controller, pendant.now_s()
    pose = controller.pose(now_s)
    return {
        "pose": [*pose.position_mm, *pose.rotation_deg],
        "running": controller.is_running(now_s),
        "status": list(controller.status(now_s)),
        "servo": controller.is_servo_on,
        "remote": controller.is_remote,
        "mode": controller.mode.name.lower(),
        "holds": [hold.name.lower() for hold in Hold if hold in controller.holds and hold.name],
        "alarms": [list(alarm) for alarm in controller.alarms],
        "error": list(controller.error) if controller.error is not None else None,
        "t_s": now_s,
    }


def _servo(pendant: Pendant, fields: Fields) -> None:
    pendant.servo(_is_on(fields))


def _remote(pendant: Pendant, fields: Fields) -> None:
    pendant.remote(_is_on(fields))


def _pendant_hold(pendant: Pendant, fields: Fields) -> None:
    pendant.hold(Hold.PENDANT, _is_on(fields))


def _external_hold(pendant: Pendant, fields: Fields) -> None:
    pendant.hold(Hold.EXTERNAL, _is_on(fields))


def _alarm(pendant: Pendant, fields: Fields) -> None:
    code = int(_number(fields, "code", None, 1, MAX_CODE))
    pendant.alarm(code, int(_number(fields, "data", 0, 0, MAX_CODE)))


def _error(pendant: Pendant, fields: Fields) -> None:
    code = int(_number(fields, "code", None, 1, MAX_CODE))
    pendant.error(code, int(_number(fields, "data", 0, 0, MAX_CODE)))


def _mode(pendant: Pendant, fields: Fields) -> None:
    modes = {mode.name.lower(): mode for mode in Mode}
    mode = modes.get(str(fields.get("mode")))
    if mode is None:
        raise _WrongLineError(f'"mode" is one of {", ".join(modes)}')
    pendant.mode(mode)


def _pose(pendant: Pendant, fields: Fields) -> None:
    now = pendant.controller.pose(pendant.now_s())
    keep = zip(
        ["x", "y", "z", "rx", "ry", "rz"], (*now.position_mm, *now.rotation_deg), strict=True
    )
    x, y, z, rx, ry, rz = (_number(fields, key, value, -1e4, 1e4) for key, value in keep)
    if not pendant.place(Pose(x, y, z, rx, ry, rz)):
        raise _WrongLineError("the robot moves; hold it first")


def _fault(pendant: Pendant, fields: Fields) -> None:
    try:
        fault = fault_of(fields)
    except ValueError as error:
        raise _WrongLineError(str(error)) from error
    pendant.fault(fault)


def _state(pendant: Pendant, fields: Fields) -> dict[str, object]:
    return state(pendant)


_ACTIONS: dict[str, Callable[[Pendant, Fields], dict[str, object] | None]] = {
    "servo": _servo,
    "remote": _remote,
    "pendant_hold": _pendant_hold,
    "external_hold": _external_hold,
    "alarm": _alarm,
    "error": _error,
    "mode": _mode,
    "pose": _pose,
    "fault": _fault,
    "state": _state,
}


def _refused(reason: str) -> dict[str, object]:
    return {"ok": False, "error": reason}


def _is_on(fields: Fields) -> bool:
    value = fields.get("on")
    if not isinstance(value, bool):
        raise _WrongLineError('"on" is true or false')
    return value


def _number(fields: Fields, key: str, default: float | None, low: float, high: float) -> float:
    value = fields.get(key, default)
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise _WrongLineError(f'"{key}" is a number')
    if not low <= value <= high:
        raise _WrongLineError(f'"{key}" is between {low:g} and {high:g}')
    return float(value)
