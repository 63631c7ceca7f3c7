"""What setting up shows of the robot, the settings and the people. Frozen."""

from dataclasses import dataclass, field
from enum import Enum

from gestureapp.recording.person_profile import Handedness
from gestureapp.setup.values import Outcome


@dataclass(frozen=True, slots=True)
class RobotRow:
    """One line of the connection test: what was asked, and what the controller said."""

    name: str
    outcome: Outcome


@dataclass(frozen=True, slots=True)
class RobotCard:
    """The robot.

    Attributes:
        address: ``HOST:PORT``; empty when none is set.
        is_connected: The line is open.
        text: One line on it.
        rows: The read-only connection test: address, banner, status bits spelled out, position,
            alarms, tool, whether the tool is inside the field.
        stop_test: The last stop test: press to standstill, distance run on, date.
    """

    address: str = ""
    is_connected: bool = False
    text: str = ""
    rows: tuple[RobotRow, ...] = ()
    stop_test: Outcome = field(default_factory=Outcome)


class StopTestPhase(Enum):
    """Where a stop test is."""

    IDLE = "idle"
    ARMING = "arming"
    MOVING = "moving"
    STOPPING = "stopping"
    DONE = "done"


@dataclass(frozen=True, slots=True)
class StopTestView:
    """The stop test: 20 mm slowly, press STOP.

    Attributes:
        phase: Where it is.
        sentence: What to do now, or what came of it.
        why_not: What stands against beginning one; empty when nothing does.
        took_ms: From the press to standstill read back; NaN before.
        ran_on_mm: Distance from the press to standstill; NaN before.
    """

    phase: StopTestPhase = StopTestPhase.IDLE
    sentence: str = ""
    why_not: str = ""
    took_ms: float = float("nan")
    ran_on_mm: float = float("nan")


@dataclass(frozen=True, slots=True)
class SettingRow:
    """One setting as the window shows it.

    Attributes:
        name: Dotted, ``robot.speed_mm_s``.
        about: What it means, one paragraph.
        value: As it is used; what a settings file would hold.
        unit: Empty when it has none.
        allowed: The range or the choices, in words; empty when anything goes.
        origin: Where the value comes from: ``built-in``, or a file with its line, or ``--config``.
        is_locked: It bears on motion, and the PIN has not been given.
        choices: What it may be, where that is one of a few words; empty where it is not.
        fixed: Why it cannot be changed here, whatever the PIN: a file named on the command line
            sets it, or the demo does. Empty when it can.
    """

    name: str
    about: str
    value: object
    unit: str
    allowed: str
    origin: str
    is_locked: bool
    choices: tuple[str, ...] = ()
    fixed: str = ""


@dataclass(frozen=True, slots=True)
class LockView:
    """The site's PIN before settings that bear on motion.

    Attributes:
        has_pin: One is set.
        is_open: It has been given, or there is none.
        text: What happened last: wrong PIN, wait, opened until.
    """

    has_pin: bool = False
    is_open: bool = True
    text: str = ""


@dataclass(frozen=True, slots=True)
class PersonRow:
    """Somebody who has a folder here.

    Attributes:
        name: Theirs.
        is_chosen: Their model and postures are used.
        handedness: Theirs.
        n_takes: Good takes of all gestures.
        model: Their model in words, or that there is none.
        postures: Their postures in words, or that the built-in ones are used.
        trouble: Why what is kept of them cannot be used; empty when it can.
    """

    name: str
    is_chosen: bool
    handedness: Handedness
    n_takes: int
    model: str
    postures: str
    trouble: str = ""
