"""Values into words: what the window writes for a stream, the robot, a move. Pure; no widget."""

from dataclasses import dataclass
from datetime import datetime

from gestureapp.cell.snapshot import SETUP_BLOCKER, CellState, EventLine, RobotView, Snapshot
from gestureapp.recognition.values import Recognition
from gestureapp.robot.values import Direction, Pose, PoseIncrement
from gestureapp.sensing.values import LinkState, StreamHealth
from ui.marks import Level

AXES = "XYZ"
_DIRECTION_WORDS = {
    (0, 1): "forward",
    (0, -1): "back",
    (1, 1): "left",
    (1, -1): "right",
    (2, 1): "up",
    (2, -1): "down",
}
_LOCKS = ("lock", SETUP_BLOCKER)
"""Blockers that say which page locks arming."""
_OLD_POSE_S = 1.0
"""The robot is asked many times a second; a position older than this is said to be old."""
_LATE_SHARE = 0.5
"""From this share of the trip level on, the age of the last sample is shown instead of the rate."""
_AT_END = 0.5
"""A move that came this near to its end, in mm or degrees, has ended there."""


@dataclass(frozen=True, slots=True)
class Chip:
    """One place of the status strip: how much it wants a person, the word, and why."""

    level: Level
    text: str
    reason: str = ""


def state_level(state: CellState) -> Level:
    """The mark beside the state's word."""
    return {
        CellState.NOT_READY: Level.ATTENTION,
        CellState.READY: Level.OK,
        CellState.STOPPED: Level.ALARM,
    }.get(state, Level.BUSY)


def stream_chip(health: StreamHealth, trip_level_s: float) -> Chip:
    """A sensor in a word and a number."""
    reason = health.reason
    if health.link is not LinkState.RECEIVING:
        text = {
            LinkState.NOT_CONNECTED: "not connected",
            LinkState.NO_DATA: "no data",
            LinkState.WRONG_DATA: "wrong data",
        }[health.link]
        return Chip(Level.ATTENTION, text, reason or text)
    if not health.is_alive:
        return Chip(Level.ATTENTION, f"silent {_age(health.age_s)}", reason or "no sample comes")
    if not health.is_valid:
        return Chip(Level.ATTENTION, "wrong data", reason or "what comes cannot be used")
    if not health.is_freq_ok:
        return Chip(Level.ATTENTION, f"rate {health.rate_hz:.0f} Hz", reason or "wrong rate")
    if health.age_s > _LATE_SHARE * trip_level_s:
        return Chip(Level.ATTENTION, f"late {_age(health.age_s)}", reason)
    return Chip(Level.OK, f"OK  {health.rate_hz:.0f} Hz", reason)


def robot_chip(robot: RobotView) -> Chip:
    """The robot in a word."""
    if not robot.is_connected:
        return Chip(Level.ATTENTION, "not connected", robot.text or "no connection")
    status = robot.status
    if status is None:
        return Chip(Level.ATTENTION, "no answer yet", robot.text)
    for is_so, level, text in (
        (status.has_alarm, Level.ALARM, "alarm"),
        (status.has_error, Level.ATTENTION, "error"),
        (status.is_held, Level.ATTENTION, "hold"),
        (not status.is_remote, Level.ATTENTION, "not in remote"),
        (not status.is_servo_on, Level.ATTENTION, "servo off"),
        (robot.pose is not None and robot.pose_age_s > _OLD_POSE_S, Level.ATTENTION, "silent"),
        (robot.is_moving, Level.BUSY, "moving"),
        (status.is_running, Level.BUSY, "running"),
    ):
        if is_so:
            return Chip(level, text, "" if level is Level.BUSY else f"{text} ({robot.text})")
    return Chip(Level.OK, "OK  servo on")


def supervision_chip(robot: RobotView) -> Chip:
    """Whether a ladder on the controller is told that the application is well."""
    what = f"controller supervision: {robot.supervision}"
    if robot.supervision == "off":
        return Chip(Level.OFF, "off", what)
    if not (robot.is_connected and robot.is_supervision_working):
        return Chip(Level.ATTENTION, "not working", f"{what}; not working")
    return Chip(Level.OK, robot.supervision, what)


def mode_chip(is_simulation: bool) -> Chip:
    """LIVE or SIMULATION: whether a real robot can be reached."""
    return Chip(Level.BUSY, "SIMULATION") if is_simulation else Chip(Level.OK, "LIVE")


def strip_line(snapshot: Snapshot) -> str:
    """What is wrong with the devices, in plain text; the session's particulars when nothing is.

    What locks arming stands before either.
    """
    line = _devices_line(snapshot)
    lock = next((each.text for each in snapshot.blockers if each.id in _LOCKS), "")
    return f"{lock[0].upper()}{lock[1:]}: arming is locked   |   {line}" if lock else line


def _devices_line(snapshot: Snapshot) -> str:
    left = stream_chip(snapshot.left, snapshot.trip_level_s).reason
    right = stream_chip(snapshot.right, snapshot.trip_level_s).reason
    robot = robot_chip(snapshot.robot).reason
    recording = "" if snapshot.recording.is_on else snapshot.recording.text
    named = (("Left arm", left), ("Right arm", right), ("Robot", robot), ("", recording))
    reasons = [f"{name}: {reason}" if name else reason for name, reason in named if reason]
    if reasons:
        return "   |   ".join(reasons)
    facts = (
        ("Robot", snapshot.robot.text),
        ("Model", snapshot.model),
        ("", snapshot.recording.text),
    )
    return "   |   ".join(f"{name}: {fact}" if name else fact for name, fact in facts if fact)


def direction_text(direction: Direction) -> str:
    """A direction in the robot's axes and in words."""
    sign = "+" if direction.sign > 0 else "-"
    if direction.is_rotation:
        return f"turn about {AXES[direction.axis]}, {sign}"
    return (
        f"along {AXES[direction.axis]}{sign} ({_DIRECTION_WORDS[direction.axis, direction.sign]})"
    )


def increment_text(increment: PoseIncrement) -> tuple[str, str]:
    """The direction and the distance of a move."""
    is_rotation = increment.is_rotation
    parts = increment.rotation_deg if is_rotation else increment.translation_mm
    axis = max(range(3), key=lambda i: abs(parts[i]))
    sign = 1 if parts[axis] >= 0 else -1
    distance = f"{amount(increment):.1f}{_unit(increment)}"
    return direction_text(Direction(axis, sign, is_rotation)), distance


def outcome_text(increment: PoseIncrement, done: float, limited_by: str) -> tuple[str, str]:
    """What became of a move that is over, as caption and text.

    Args:
        increment: The move.
        done: How much of it was made, 0 to 1.
        limited_by: What would have ended it, in words, or empty.
    """
    whole, unit = amount(increment), _unit(increment)
    way = f"{whole:.0f}{unit}"
    if whole * (1.0 - done) <= _AT_END:
        end = f": {limited_by}" if limited_by else ""
        return "Ended at", f"{whole:.1f}{unit}{end}"
    would = f"; would have ended at: {limited_by}" if limited_by else ""
    if whole * done < _AT_END:
        return "Not made", f"0{unit} of {way}{would}"
    return "Stopped", f"after {whole * done:.0f}{unit} of {way}{would}"


def amount(increment: PoseIncrement) -> float:
    """How far a move goes: mm, or degrees when it is a rotation."""
    parts = increment.rotation_deg if increment.is_rotation else increment.translation_mm
    return float(sum(part * part for part in parts) ** 0.5)


def end_of(start: Pose, increment: PoseIncrement) -> Pose:
    """Where a move ends."""
    moved = zip(start.position_mm, increment.translation_mm, strict=True)
    turned = zip(start.rotation_deg, increment.rotation_deg, strict=True)
    return Pose(*(a + b for a, b in moved), *(a + b for a, b in turned))


def progress(start: Pose, increment: PoseIncrement, pose: Pose) -> float:
    """How much of a move is done, 0 to 1, from the position read back.

    Angles are compared around the full turn, as the controller may read 180 as -180.
    """
    whole = amount(increment)
    if whole <= 0:
        return 0.0
    if increment.is_rotation:
        wanted = increment.rotation_deg
        pairs = zip(pose.rotation_deg, start.rotation_deg, wanted, strict=True)
        done = sum(_turn(now - then) * part for now, then, part in pairs)
    else:
        wanted = increment.translation_mm
        pairs = zip(pose.position_mm, start.position_mm, wanted, strict=True)
        done = sum((now - then) * part for now, then, part in pairs)
    return min(1.0, max(0.0, done / whole**2))


def near(pose: Pose, start: Pose) -> Pose:
    """The same pose with angles that go on from ``start``, beyond the half turn if need be."""
    pairs = zip(pose.rotation_deg, start.rotation_deg, strict=True)
    return Pose(*pose.position_mm, *(then + _turn(now - then) for now, then in pairs))


def pose_text(pose: Pose, is_rotation: bool) -> str:
    """The half of a pose that a move changes, with unit and fixed digits."""
    if is_rotation:
        return "Rx {:.1f}°  Ry {:.1f}°  Rz {:.1f}°".format(*pose.rotation_deg)
    return "X {:.1f}  Y {:.1f}  Z {:.1f} mm".format(*pose.position_mm)


def pose_age_text(robot: RobotView) -> str:
    """What stands where the position is missing or old; empty when it is fresh."""
    if robot.pose is None:
        return "no position"
    if robot.pose_age_s > _OLD_POSE_S:
        return f"position is {robot.pose_age_s:.1f} s old"
    return ""


def decision_text(recognition: Recognition) -> str:
    """How long the decision took: from the onset where it is known, else from the activation."""
    begun_s, what = recognition.window_start_s, "first sample"
    if recognition.onset_s is not None:
        begun_s, what = recognition.onset_s, "onset"
    elif recognition.activation_s is not None:
        begun_s, what = recognition.activation_s, "activation"
    return f"decided {(recognition.decided_s - begun_s) * 1000:.0f} ms after the {what}"


def needed_text(certainty: float, thresholds: tuple[float, ...]) -> str:
    """What the certainty of an answer had to reach, to stand behind it; empty when unknown."""
    if not thresholds:
        return ""
    if len(thresholds) == 1:
        return f", needed {thresholds[0]:.2f}"
    at_once, in_the_end = max(thresholds), min(thresholds)
    if certainty >= at_once:
        return f", needed {at_once:.2f} at once"
    return f", needed {in_the_end:.2f} in the end"


def not_recognised_text(recognition: Recognition) -> str:
    """Why nothing was recognised, with the two best where the reason does not name them."""
    best = ", ".join(c.words.replace(" ", "\u00a0") for c in recognition.best)
    reason = recognition.reason or "no clear gesture"
    return f"{reason} ({best})" if best and not reason.endswith(")") else reason


def time_text(event: EventLine) -> str:
    """The wall time of an event, to the millisecond."""
    when = datetime.fromtimestamp(event.wall_s)
    return f"{when:%H:%M:%S}.{when.microsecond // 1000:03d}"


def _age(age_s: float) -> str:
    if age_s == float("inf"):
        return "from the start"
    return f"{age_s * 1000:.0f} ms" if age_s < 1 else f"{min(age_s, 9999):.1f} s"


def _unit(increment: PoseIncrement) -> str:
    return "°" if increment.is_rotation else " mm"


def _turn(angle_deg: float) -> float:
    return (angle_deg + 180.0) % 360.0 - 180.0
