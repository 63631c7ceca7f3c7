"""What the cell knows of the robot, from what the guardian tells. Pure."""

from collections.abc import Iterator
from dataclasses import replace

from gestureapp.cell import events as e
from gestureapp.cell.records import Json
from gestureapp.cell.snapshot import RobotView
from gestureapp.config import YAWS_DEG, RobotSettings
from gestureapp.gestures import Kind, gesture
from gestureapp.robot import messages as m
from gestureapp.robot.values import (
    Direction,
    Pose,
    PoseIncrement,
    Position,
    Refusal,
    RobotStatus,
    StopReason,
)
from gestureapp.sensing.values import StreamHealth

_X, _Y, _Z = range(3)
_QUARTERS = {0: (1, 0), 90: (0, 1), 180: (-1, 0), -90: (0, -1)}
"""Cosine and sine of each yaw."""
_NO_ADDRESS = "no robot address is set"


class RobotMemory:
    """The robot as last heard. Owned by the control thread.

    Attributes:
        is_open: The controller has taken the session.
        text: The line's own words.
        remedy: What to do about it, where the guardian knows; else empty.
        status: Last RSTATS, or None.
        status_s: When it was read.
        position: Last RPOSC, or None.
        pose_s: When it was read.
        hindrances: What stands against arming and no status shows.
    """

    def __init__(self, robot: RobotSettings) -> None:
        address = f"{robot.host}:{robot.port}" if robot.host else ""
        self.is_open = False
        self.text = "not connected yet" if address else _NO_ADDRESS
        self.remedy = ""
        self.status: RobotStatus | None = None
        self.status_s = float("-inf")
        self.position: Position | None = None
        self.pose_s = float("-inf")
        self.hindrances: tuple[Refusal, ...] = ()
        self._address = address
        self._supervision = "off"
        if robot.supervision_input:
            self._supervision = f"on, #{robot.supervision_input}, {robot.supervision_hz:g} Hz"
        self._alarms: tuple[int, ...] = ()
        self._is_moving = False
        self._increment: PoseIncrement | None = None
        self._start: Pose | None = None
        self._limited_by = ""
        self._speed = ""

    def note(self, message: m.FromGuardian) -> None:
        """Take what the guardian tells about the robot."""
        match message:
            case m.LinkReport():
                self.is_open = message.is_open
                self.text = message.text if self._address else _NO_ADDRESS
                self.remedy = message.remedy
                if not message.is_open:
                    self.status, self._is_moving = None, False
            case m.StatusReport():
                self.status = RobotStatus(message.data_1, message.data_2)
                self.status_s, self._alarms = message.t_s, message.alarms
            case m.Hindrances():
                self.hindrances = message.refusals
            case m.PoseReport():
                self.position, self.pose_s = message.position, message.t_s
            case m.CommandSent():
                self._increment, self._start = message.increment, message.start
                self._limited_by = message.limited_by
                unit = "deg/s" if message.is_rotation else "mm/s"
                self._speed = f"{message.speed:.1f} {unit}"
            case m.CommandAccepted():
                self._is_moving = True
            case m.CommandRefused() | m.MotionEnded() | m.StopConfirmed():
                self._is_moving = False

    def view(self, now_s: float) -> RobotView:
        """For the window."""
        alarms = f", alarm {', '.join(map(str, self._alarms))}" if self._alarms else ""
        where = self._address if self.is_open else self.text
        return RobotView(
            is_connected=self.is_open,
            text=f"{where}{alarms}",
            status=self.status,
            pose=self.position.pose if self.position else None,
            pose_age_s=now_s - self.pose_s,
            is_moving=self._is_moving,
            increment=self._increment,
            start=self._start,
            limited_by=self._limited_by,
            speed=self._speed,
            supervision=self._supervision,
            is_supervision_working=not any(h.reason == "supervision" for h in self.hindrances),
            alarms=self._alarms,
            position=self.position,
            banner=self.text if self.is_open else "",
        )


def events_of(message: m.FromGuardian, t_s: float) -> Iterator[e.Event]:
    """What a message of the guardian means to the cell machine."""
    match message:
        case m.Armed():
            yield e.ArmTaken(t_s)
        case m.ArmRefused():
            yield e.ArmDenied(t_s, message.refusal.text)
        case m.Disarmed():
            yield e.PermissionLost(t_s)
        case m.CommandAccepted():
            yield e.MoveAccepted(t_s, message.activation_id)
        case m.CommandRefused():
            yield e.MoveRefused(t_s, message.activation_id, message.refusal.text)
        case m.MotionEnded():
            yield e.MoveEnded(t_s, message.activation_id)
        case m.StopAsked():
            yield e.StopTaken(t_s, message.reason, message.text)
        case m.StopConfirmed():
            yield e.StopDone(t_s, message.reason)
        case m.StopUnconfirmed():
            yield e.StopOpen(t_s, message.text)


def with_cause(event: e.Event, stall: str, left: StreamHealth) -> e.Event:
    """The guardian knows only that the left sensor is silent; we know why.

    Args:
        event: Of the guardian.
        stall: How long we have stood still ourselves; empty when we have not.
        left: How the left stream is.
    """
    if not isinstance(event, e.StopTaken) or event.reason is not StopReason.LEFT_SILENT:
        return event
    if stall:
        return replace(event, reason=StopReason.APPLICATION_STALLED, text=stall)
    return event if left.is_ok else replace(event, text=f"left sensor: {left.reason}")


def direction_of(label: str, yaw_deg: int = 0) -> Direction:
    """What a gesture asks of the robot, in its own frame.

    The operator's axes are turned about the common Z by ``yaw_deg``: at 90 the operator faces the
    robot's +Y, so that the operator's X+ is the robot's Y+ and Y+, to the left, its X-. Rotations
    go the same way, as their axes do; Z stays.

    Args:
        label: Of the gesture.
        yaw_deg: Which way the operator faces: 0, 90, 180 or -90.

    Raises:
        KeyError: no gesture has this label.
        ValueError: the yaw is no quarter turn.
    """
    found = gesture(label)
    is_rotation = found.kind is Kind.POSTURE
    if yaw_deg not in YAWS_DEG:
        raise ValueError(f"robot.yaw_deg = {yaw_deg}: must be one of {YAWS_DEG}")
    if found.axis == _Z:
        return Direction(found.axis, found.sign, is_rotation)
    cosine, sine = _QUARTERS[yaw_deg]
    x, y = (found.sign, 0) if found.axis == _X else (0, found.sign)
    turned_x, turned_y = cosine * x - sine * y, sine * x + cosine * y
    axis, sign = (_X, turned_x) if turned_x else (_Y, turned_y)
    return Direction(axis, sign, is_rotation)


def robot_fields(message: m.StatusReport | m.PoseReport) -> dict[str, Json]:
    """What the robot answered, as the record's topic has it."""
    if isinstance(message, m.StatusReport):
        return {"data_1": message.data_1, "data_2": message.data_2}
    position = message.position
    names = ("x_mm", "y_mm", "z_mm", "rx_deg", "ry_deg", "rz_deg")
    fields: dict[str, Json] = {name: getattr(position.pose, name) for name in names}
    return {**fields, "type": position.posture.bits, "tool": position.tool}
