"""Everything the window shows, frozen, at one moment. The whole seam between engine and window."""

import math
from dataclasses import dataclass
from enum import Enum

from gestureapp.recognition.values import Recognition
from gestureapp.robot.values import Direction, Pose, PoseIncrement, Position, RobotStatus
from gestureapp.sensing.values import ArmPosture, StreamHealth


class CellState(Enum):
    """The states of the cell; the value is the word on the screen."""

    NOT_READY = "NOT READY"
    READY = "READY"
    ARMED = "ARMED"
    ACTIVATED = "ACTIVATED"
    MOVING = "MOVING"
    STOPPING = "STOPPING"
    STOPPED = "STOPPED"


@dataclass(frozen=True, slots=True)
class Blocker:
    """One thing that stands against arming.

    Attributes:
        id: Stable word, ``left_sensor``.
        text: What is wrong, with the measured value.
        remedy: What to do about it.
    """

    id: str
    text: str
    remedy: str


MODEL_BLOCKER, SETUP_BLOCKER = "model", "setup"
STOP_TEST_IGNORES = frozenset({MODEL_BLOCKER, SETUP_BLOCKER})
"""What does not stand against a stop test: it needs no gesture, and begins beside an open setup."""


@dataclass(frozen=True, slots=True)
class EventLine:
    """One line of the cell's story for a person. ``t_s`` monotonic, ``wall_s`` since the epoch."""

    t_s: float
    wall_s: float
    text: str
    is_alarm: bool = False


@dataclass(frozen=True, slots=True)
class RecordingView:
    """Whether the session is recorded.

    Attributes:
        is_on: It is, and the disk keeps up.
        file: Name of its file, or empty.
        text: Where it is, or why it is not and what to do; one line.
    """

    is_on: bool = False
    file: str = ""
    text: str = "not recorded"


@dataclass(frozen=True, slots=True)
class RobotView:
    """The robot as last heard.

    Attributes:
        is_connected: The exchange with the controller is open.
        text: One line on the link: address, or why there is none.
        status: Last RSTATS, or None.
        pose: Last RPOSC, or None.
        pose_age_s: How old that is; infinite before the first.
        is_moving: A move that it has accepted has not been read back as ended.
        increment: The move under way or the last one, or None.
        start: Where that move began, or None.
        limited_by: What ends it, in words.
        speed: Its speed with unit, ``100.0 mm/s``.
        supervision: Controller-side supervision in words: ``off``, ``on, #22010, 5 Hz``.
        is_supervision_working: The controller takes the toggles; also true where it is off.
        alarms: Codes of RALARM while there are any.
        position: Last RPOSC with the arm's posture and the tool's number, or None.
        banner: What the controller said as the line was opened; empty while it is not.
    """

    is_connected: bool
    text: str
    status: RobotStatus | None = None
    pose: Pose | None = None
    pose_age_s: float = float("inf")
    is_moving: bool = False
    increment: PoseIncrement | None = None
    start: Pose | None = None
    limited_by: str = ""
    speed: str = ""
    supervision: str = "off"
    is_supervision_working: bool = True
    alarms: tuple[int, ...] = ()
    position: Position | None = None
    banner: str = ""


@dataclass(frozen=True, slots=True)
class StopTestResult:
    """Where a stop test is, and what it has measured.

    Attributes:
        phase: ``arming``, ``moving``, ``stopping`` or ``done``.
        label: Which way, as the operator sees it: ``X+``.
        took_s: From the press of STOP to the standstill read back; NaN before and without one.
        ran_on_mm: Distance from the press to that standstill; NaN before and without one.
        text: What to do now, or what came of it.
        wall_s: When it was done, seconds since the epoch; 0 before.
    """

    phase: str
    label: str = ""
    took_s: float = float("nan")
    ran_on_mm: float = float("nan")
    text: str = ""
    wall_s: float = 0.0

    @property
    def is_measured(self) -> bool:
        """STOP was pressed while it moved, and the standstill was read back."""
        return not math.isnan(self.took_s)


@dataclass(frozen=True, slots=True)
class Snapshot:
    """The cell at one moment.

    Attributes:
        t_s: When it was taken, monotonic clock.
        state: The one word.
        sentence: What to do next, or why it stopped.
        blockers: What stands against arming; empty when ready.
        can_arm: Arming would be taken now.
        is_stop_unconfirmed: The robot has not confirmed a stop in time: the red bar and the sound.
        left: Health of the left stream.
        right: Health of the right stream.
        posture: What the left arm says.
        trip_level_s: The watchdog's limit on ``left.age_s``.
        recognition: The last one, or None.
        direction: What the last recognised gesture asks of the robot, or None.
        robot: The robot as last heard.
        events: The last lines, newest last.
        is_simulation: No real robot can be reached.
        recording: Whether the session is recorded, and where.
        person: Whose arms.
        model: Which model, in words.
        stop_test: The last or present one, or None.
    """

    t_s: float
    state: CellState
    sentence: str
    blockers: tuple[Blocker, ...]
    can_arm: bool
    is_stop_unconfirmed: bool
    left: StreamHealth
    right: StreamHealth
    posture: ArmPosture
    trip_level_s: float
    recognition: Recognition | None
    direction: Direction | None
    robot: RobotView
    events: tuple[EventLine, ...]
    is_simulation: bool
    recording: RecordingView
    person: str
    model: str
    stop_test: StopTestResult | None = None
