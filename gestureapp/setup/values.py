"""What setting up hands to the window: pictures of sensors, calibration, robot and people."""

from dataclasses import dataclass, field
from enum import Enum

from gestureapp.sensing.values import Side, StreamHealth


class Check(Enum):
    """How a test ended; the value is the word on the screen."""

    NOT_RUN = "not run"
    RUNNING = "running"
    PASSED = "passed"
    FAILED = "failed"


@dataclass(frozen=True, slots=True)
class Outcome:
    """One test's end.

    Attributes:
        check: Which.
        text: What was found, with figures; why it failed and the remedy.
        wall_s: When it ended, seconds since the epoch; 0 before that.
    """

    check: Check = Check.NOT_RUN
    text: str = ""
    wall_s: float = 0.0


@dataclass(frozen=True, slots=True)
class PortChoice:
    """A port of this machine that a sensor may be on.

    Attributes:
        url: What stands in the settings when it is chosen.
        name: What a person calls it: a Bluetooth name, a USB product; never only a number.
        sensor_id: What is behind it, as far as the system tells: it stays the same when the port's
            number changes. Empty when the system does not know.
        is_bluetooth: A Bluetooth serial port.
        trouble: Why it cannot be opened now, in words; empty when it can, or nobody has tried.
    """

    url: str
    name: str
    sensor_id: str = ""
    is_bluetooth: bool = False
    trouble: str = ""


class Remedy(Enum):
    """What a window can do about a problem at one press; the value is the word on the button."""

    NONE = ""
    CALIBRATE = "Go to Calibrate"
    SWAP = "Swap sensors"
    TEST_LINK = "Test link"
    FIND = "Find sensors"


@dataclass(frozen=True, slots=True)
class SensorCard:
    """One arm's sensor.

    Attributes:
        side: Which arm.
        port: As in the settings; empty when none is chosen.
        protocol: As in the settings.
        sensor_id: What the calibration is kept under.
        name: What a person calls the sensor.
        health: Of its stream, with rate, jitter, worst gap, lost and bad frames, battery.
        advice: What to try, in order of likelihood, while no data come; empty when they do.
        bad_bytes: The newest bytes that were no frame, as a person can read them; empty when none.
        calibration: How it was calibrated and when, in words; or that it was not.
        level: The last level check, in words.
        link: The last link test of this port and protocol, in words; or that there was none.
        problem: Why it must not be armed with: not calibrated, out of date, not level, swapped,
            link too slow for the trip level. Empty when nothing is against it.
        remedy: What to do about that.
        act: The button that does it; ``NONE`` when no button can.
        arm: On which arm it is worn, if not on the side's own: a left-handed person wears them the
            other way round.
    """

    side: Side
    port: str
    protocol: str
    sensor_id: str
    name: str
    health: StreamHealth
    advice: tuple[str, ...] = ()
    bad_bytes: str = ""
    calibration: str = "not calibrated"
    level: str = ""
    link: str = ""
    problem: str = ""
    remedy: str = ""
    act: Remedy = Remedy.NONE
    arm: str = ""

    @property
    def worn(self) -> str:
        """Where it is worn, in a word: the side's own arm, but for a left-handed person."""
        return self.arm or self.side.value


@dataclass(frozen=True, slots=True)
class FoundSensor:
    """Something that sends, found by trying the ports.

    Attributes:
        port: Where.
        protocol: What it speaks, or empty when bytes came that nobody can read.
        rate_hz: How fast, roughly.
        text: In words, for a list.
    """

    port: PortChoice
    protocol: str
    rate_hz: float
    text: str


@dataclass(frozen=True, slots=True)
class FindingView:
    """Looking for sensors on all ports.

    Attributes:
        is_on: It is under way.
        sentence: What is going on, or what came of it.
        found: So far.
    """

    is_on: bool = False
    sentence: str = ""
    found: tuple[FoundSensor, ...] = ()


@dataclass(frozen=True, slots=True)
class ShakeView:
    """Assigning by shaking.

    Attributes:
        is_on: It is under way.
        sentence: ``Shake the sensor on your LEFT arm``, or what came of it.
        left_shake: How strongly what is now the left sensor moves, 0 to 1.
        right_shake: The same for the right one.
    """

    is_on: bool = False
    sentence: str = ""
    left_shake: float = 0.0
    right_shake: float = 0.0


@dataclass(frozen=True, slots=True)
class LinkTestView:
    """The link test of one sensor.

    Attributes:
        side: Whose; None before the first.
        outcome: Passed when the link carries the trip level that is set, failed when it does not.
        elapsed_s: So far, of ``total_s``.
        total_s: How long it takes.
        rate_hz: Measured.
        jitter_s: Standard deviation of the times between two arrivals.
        worst_gap_s: Longest time between two arrivals.
        n_lost: Frames missing by the running number.
        n_bad: Unreadable ones.
        histogram: Times between arrivals: upper end of the class in s, and how many.
        lowest_trip_s: The lowest trip level this link can carry; NaN before the end.
        set_trip_s: The one that is set.
    """

    side: Side | None = None
    outcome: Outcome = field(default_factory=Outcome)
    elapsed_s: float = 0.0
    total_s: float = 30.0
    rate_hz: float = 0.0
    jitter_s: float = 0.0
    worst_gap_s: float = 0.0
    n_lost: int = 0
    n_bad: int = 0
    histogram: tuple[tuple[float, int], ...] = ()
    lowest_trip_s: float = float("nan")
    set_trip_s: float = 0.0


class Position(Enum):
    """The six positions of the calibration, by the axis that points up; value: drawing's name."""

    Z_UP = "z-up"
    Z_DOWN = "z-down"
    X_UP = "x-up"
    X_DOWN = "x-down"
    Y_UP = "y-up"
    Y_DOWN = "y-down"


class PositionState(Enum):
    """Where a position stands; the value is the word on the screen."""

    MISSING = "missing"
    HOLD_STILL = "hold still"
    DONE = "done"


@dataclass(frozen=True, slots=True)
class PositionView:
    """One position of the calibration. ``progress`` is 0 to 1, of the time to be held still."""

    position: Position
    state: PositionState = PositionState.MISSING
    progress: float = 0.0


@dataclass(frozen=True, slots=True)
class CalibrationView:
    """The calibration of one sensor.

    Attributes:
        side: Whose; None when none is under way or done.
        is_on: It is under way; its sensor cannot be armed with meanwhile.
        sentence: What to do now ("Lay the sensor on its back and let go"), or why it began anew.
        positions: All six.
        wanted: The position to take now; any other that is missing is taken, too.
        before_mg: Distance from 1 g, root of the mean square over the positions, as it came.
        after_mg: The same after the calibration; NaN before the end. Worst of the positions in
            ``worst_mg``.
        worst_mg: See above.
        verdict: In words: good, not flat, noisy, a position taken twice.
        outcome: Passed: it is kept. Failed: it is not, and why.
    """

    side: Side | None = None
    is_on: bool = False
    sentence: str = ""
    positions: tuple[PositionView, ...] = ()
    wanted: Position | None = None
    before_mg: float = float("nan")
    after_mg: float = float("nan")
    worst_mg: float = float("nan")
    verdict: str = ""
    outcome: Outcome = field(default_factory=Outcome)


@dataclass(frozen=True, slots=True)
class LevelView:
    """The level check of one sensor, 2 s on something level.

    Attributes:
        side: Whose; None before the first.
        outcome: Passed, or failed because of what.
        progress: 0 to 1.
        off_deg: How far from level it read.
        off_mg: How far from 1 g.
    """

    side: Side | None = None
    outcome: Outcome = field(default_factory=Outcome)
    progress: float = 0.0
    off_deg: float = float("nan")
    off_mg: float = float("nan")


@dataclass(frozen=True, slots=True)
class PosturesView:
    """The person's postures of the arm that starts and stops.

    Attributes:
        person: Whose; empty when nobody is chosen.
        is_on: Recording is under way.
        sentence: What to do now, or what came of it.
        progress: 0 to 1, of the posture being recorded.
        is_stop_done: The stop posture is recorded.
        is_start_done: The start posture is.
        between_deg: Angle between the two; NaN before both are.
        margin_deg: What is left of it when both are left as far as the settings allow.
        least_margin_deg: Less cannot be armed with.
        outcome: Passed: kept. Failed: why not.
        wall_s: When they were recorded; 0 when the built-in ones are used.
        arm: On which arm that is: ``left``, or ``right`` of a left-handed person.
        problem: Why they must not be armed with; empty when they may.
        remedy: What to do about that.
    """

    person: str = ""
    is_on: bool = False
    sentence: str = ""
    progress: float = 0.0
    is_stop_done: bool = False
    is_start_done: bool = False
    between_deg: float = float("nan")
    margin_deg: float = float("nan")
    least_margin_deg: float = 5.0
    outcome: Outcome = field(default_factory=Outcome)
    wall_s: float = 0.0
    arm: str = "left"
    problem: str = ""
    remedy: str = ""
