"""What the cell knows of the robot, from what the guardian tells. Pure."""

from collections.abc import Iterator

from gestureapp.cell import events as e
from gestureapp.cell.records import Json
from gestureapp.cell.snapshot import RobotView
from gestureapp.config import RobotSettings
from gestureapp.gestures import Kind, gesture
from gestureapp.robot import messages as m
from gestureapp.robot.values import Direction, Pose, PoseIncrement, Position, Refusal, RobotStatus

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


def direction_of(label: str) -> Direction:
    """What a gesture asks of the robot.

    Raises:
        KeyError: no gesture has this label.
    """
    found = gesture(label)
    return Direction(found.axis, found.sign, found.kind is Kind.POSTURE)


def robot_fields(message: m.StatusReport | m.PoseReport) -> dict[str, Json]:
    """What the robot answered, as the record's topic has it."""
    if isinstance(message, m.StatusReport):
        return {"data_1": message.data_1, "data_2": message.data_2}
    position = message.position
    names = ("x_mm", "y_mm", "z_mm", "rx_deg", "ry_deg", "rz_deg")
    fields: dict[str, Json] = {name: getattr(position.pose, name) for name in names}
    return {**fields, "type": position.posture.bits, "tool": position.tool}
