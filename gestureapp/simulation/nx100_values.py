"""What the emulated NX100 is told and tells: codes, bits, options, moves, motion. Values only."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum, IntEnum, IntFlag

from gestureapp.robot.hp6 import NO_FLIP
from gestureapp.robot.values import Pose, PoseIncrement, Posture


class Code(IntEnum):
    """What a command is answered with. Source: interpreter codes of Yaskawa's HSES dissector."""

    OK = 0
    OPERAND_COUNT = 1011
    OPERAND_VALUE = 1012
    OPERAND_LENGTH = 1013
    MOVING = 2010
    PENDANT_HOLD = 2020
    EXTERNAL_HOLD = 2040
    COMMAND_HOLD = 2050
    ALARM = 2060
    SERVO_OFF = 2070
    MODE = 2080
    NOT_REMOTE = 2100
    NO_ACCESS = 2110
    NOT_LOADABLE = 2120
    USER_FRAME = 3350
    DATA_RANGE = 5200


class Hold(IntFlag):
    """Who holds the robot: the bits of RSTATS Data-2. Source: data transmission manual p. 76."""

    NONE = 0
    PENDANT = 0x02
    EXTERNAL = 0x04
    COMMAND = 0x08


class Mode(Enum):
    """Position of the pendant's key, as RSTATS Data-1 shows it."""

    TEACH = 0x20
    PLAY = 0x40


class Cycle(Enum):
    """How a job would go on, as RSTATS Data-1 shows it."""

    STEP = 0x01
    ONE = 0x02
    AUTO = 0x04


class EndReason(Enum):
    """Why a move ended."""

    DONE = "done"
    HOLD = "hold"
    SERVO_OFF = "servo off"
    ALARM = "alarm"
    MODE = "mode"


RUNNING, REMOTE = 0x08, 0x80
"""RSTATS Data-1."""
ALARM_BIT, ERROR_BIT, SERVO_BIT = 0x10, 0x20, 0x40
"""RSTATS Data-2."""
LIMIT_ALARM = 4416
"""Pulse limit. From memory of the DX100's list; the NX100's was not available."""
CONTACTS = range(22010, 23288)
"""Network inputs, the only ones that can be written. Source: an NX100 client's notes."""
READABLE = (
    *(range(first, first + 2560) for first in (10, 10010, 20010, 30010, 50010, 80010)),
    CONTACTS,
    range(32010, 33288),
    range(70010, 80000),
    range(82010, 82208),
)
"""Contacts that can be read. First numbers from clients' notes, mostly on later controllers; the
ends are ours. A read of 50010 was recorded on an NX100."""
MAX_ALARMS = 4
START_POSE = Pose(800.0, 0.0, 300.0, 180.0, 0.0, 0.0)
"""In front of the robot, the tool pointing down."""
JOINT_RANGES_DEG = (
    (-170.0, 170.0),
    (-90.0, 155.0),
    (-100.0, 120.0),
    (-180.0, 180.0),
    (-135.0, 135.0),
    (-360.0, 360.0),
)
"""The published ranges; U is our own, as it is published against the horizontal only."""


@dataclass(frozen=True, slots=True)
class ControllerOptions:
    """What the emulated cell is like.

    Attributes:
        start_pose: Tool pose at power-on, robot frame.
        start_posture: How the arm holds it.
        start_delay_s: From accepting a move to the running bit.
        accel_mm_s2: Acceleration of the tool point, both ways.
        accel_deg_s2: Acceleration of the wrist, both ways.
        max_speed_mm_s: What the arm can do when the command limits the rotation only.
        max_speed_deg_s: What the wrist can do when the command limits the tool point only.
        joint_ranges_deg: Lowest and highest S, L, U, R, B, T; leaving one is an alarm.
        tool: Number of the tool selected.
        tool_mm: Tool centre point seen from the flange, for all tools.
        resumes_after_hold: Releasing a hold goes on with the rest of the move. Documented nowhere.
        allows_mode_switch: MODE is taken over the network (a setting of the controller).
        servo_on_delay_s: How long SVON 1 takes.
        user_frames: Taught user frames by number 1 to 24, as poses in the robot frame.
        ladder_s: Ladder timer on the first network input: external hold when it does not change for
            so long after its first change; None when there is no such ladder.
    """

    start_pose: Pose = START_POSE
    start_posture: Posture = NO_FLIP
    start_delay_s: float = 0.004
    accel_mm_s2: float = 1000.0
    accel_deg_s2: float = 400.0
    max_speed_mm_s: float = 1500.0
    max_speed_deg_s: float = 180.0
    joint_ranges_deg: tuple[tuple[float, float], ...] = JOINT_RANGES_DEG
    tool: int = 0
    tool_mm: tuple[float, float, float] = (0.0, 0.0, 0.0)
    resumes_after_hold: bool = False
    allows_mode_switch: bool = False
    servo_on_delay_s: float = 0.0
    user_frames: Mapping[int, Pose] = field(default_factory=dict)
    ladder_s: float | None = None


@dataclass(frozen=True, slots=True)
class Move:
    """IMOV's operands that matter. Class 0 bounds the tool point, mm/s; 1 the turning, deg/s."""

    speed_class: int
    speed: float
    frame: int
    increment: PoseIncrement


@dataclass(frozen=True, slots=True)
class MotionStarted:
    """The running bit rose."""

    t_s: float
    pose: Pose


@dataclass(frozen=True, slots=True)
class MotionEnded:
    """The running bit fell: the robot stands."""

    t_s: float
    pose: Pose
    reason: EndReason


MotionEvent = MotionStarted | MotionEnded
