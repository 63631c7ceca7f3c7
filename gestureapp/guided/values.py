"""What guided training shows: frozen values between its thread and the window."""

from dataclasses import dataclass, field
from enum import Enum

from gestureapp.recognition.evaluation import Evaluation
from gestureapp.recording.take_values import Take
from gestureapp.sensing.values import ArmPosture


class Pace(Enum):
    """What begins a take."""

    HANDS_FREE = "hands-free"
    """The left arm's start posture, as in operation."""
    RHYTHM = "rhythm"
    """A beat with sound and flash."""


class Phase(Enum):
    """Where the recording stands."""

    CLOSED = "closed"
    """No person is chosen."""
    IDLE = "idle"
    COUNT_IN = "count-in"
    WAITING = "waiting"
    """For the beat, or for the left arm."""
    TAKING = "taking"
    """From the activation until its last sample."""
    PAUSED = "paused"
    SENSOR_LOST = "sensor lost"
    """It goes on by itself with a new count-in when the sensors send again."""


class Quality(Enum):
    """How alike the good takes of a gesture are."""

    NONE = "no takes yet"
    FEW = "too few to say"
    POOR = "takes differ much"
    FAIR = "takes differ"
    GOOD = "takes are alike"


@dataclass(frozen=True, slots=True)
class GestureProgress:
    """How far the recording of one gesture is; ``good`` of ``wanted`` takes count."""

    label: str
    good: int
    wanted: int
    quality: Quality


@dataclass(frozen=True, slots=True)
class Live:
    """What trying a model without the robot came to.

    Attributes:
        evaluation: Of the gestures tried so far, rows what was asked.
        is_over: Every gesture was asked for as often as planned.
    """

    evaluation: Evaluation
    is_over: bool


@dataclass(frozen=True, slots=True)
class Trying:
    """The live test, at one moment.

    Attributes:
        is_on: Gestures are asked for.
        asked: What to do now, or empty.
        heard: What was heard last: a gesture, or ``not recognised``; empty before.
        was_right: Whether that was what was asked.
        reason: Why nothing was recognised.
        n_done: Gestures tried.
        n_planned: Gestures to be tried.
        live: The matrix so far, or None before the first.
        text: What to do, or what is missing.
        answered: What had been asked for when ``heard`` was heard.
    """

    is_on: bool = False
    asked: str = ""
    heard: str = ""
    was_right: bool = False
    reason: str = ""
    n_done: int = 0
    n_planned: int = 0
    live: Live | None = None
    text: str = ""
    answered: str = ""


@dataclass(frozen=True, slots=True)
class Heard:
    """The last activation that could become a take, at one moment.

    Attributes:
        number: Grows with every activation; 0 before the first.
        is_tried: It came while a model was tried; else in operation.
        label: The gesture it would be a take of; empty when it can be none.
        can_keep: Its samples are there, and it has not been kept yet.
        text: What came of the wish to keep it, or why it cannot be kept; one line.
    """

    number: int = 0
    is_tried: bool = False
    label: str = ""
    can_keep: bool = False
    text: str = ""


@dataclass(frozen=True, slots=True)
class GuidedSnapshot:
    """Guided training at one moment.

    Attributes:
        t_s: When it was taken, monotonic clock.
        person: Whose takes; empty while closed.
        phase: Where the recording stands.
        pace: What begins a take.
        beat_s: Time between two beats.
        label: The gesture that is, or would be, recorded.
        suggested: What to record next; empty when all is done.
        count_in: 3, 2, 1 while counting in; else 0.
        activation_s: Of the take in progress or the last one, monotonic; minus infinity before.
        next_beat_s: When the next beat is due, monotonic; infinite without one.
        n_in_batch: Good takes of this batch.
        batch_size: Good takes that a batch ends with.
        batch: The takes of this batch, oldest first.
        progress: Of every gesture, in the set's order.
        sentence: What to do now, or why it does not go on.
        trouble: Takes cannot be kept, with cause and remedy; empty when they can.
        undo: What Undo would take back, in words; empty when nothing.
        redo: What Redo would do again.
        tilt_deg: How far the right hand is from level now; NaN without samples.
        is_level: That is little enough.
        posture: What the left arm says.
        version: Grows with every change of the takes: ask for them again.
        trying: The live test.
        heard: The last activation, which ``keep_heard`` makes a take of.
    """

    t_s: float = 0.0
    person: str = ""
    phase: Phase = Phase.CLOSED
    pace: Pace = Pace.HANDS_FREE
    beat_s: float = 1.5
    label: str = ""
    suggested: str = ""
    count_in: int = 0
    activation_s: float = float("-inf")
    next_beat_s: float = float("inf")
    n_in_batch: int = 0
    batch_size: int = 10
    batch: tuple[Take, ...] = ()
    progress: tuple[GestureProgress, ...] = ()
    sentence: str = ""
    trouble: str = ""
    undo: str = ""
    redo: str = ""
    tilt_deg: float = float("nan")
    is_level: bool = False
    posture: ArmPosture = ArmPosture.NEITHER
    version: int = 0
    trying: Trying = field(default_factory=Trying)
    heard: Heard = field(default_factory=Heard)


class TrainingPhase(Enum):
    """Where a training stands."""

    IDLE = "idle"
    RUNNING = "running"
    DONE = "done"
    CANCELLED = "cancelled"
    FAILED = "failed"


@dataclass(frozen=True, slots=True)
class TrainingResult:
    """What a training came to.

    Attributes:
        words: First for a person: a judgement, then what to record more of.
        evaluation: Cross-validated: every take was heard by a network that had not seen it.
        folds: How it was cut, in words: ``by session: 3 sessions``.
        facts: The technical part: name and value, in the order to show.
        duration_s: From the press to the written model, the start of the process included.
        promise: Whether at most 1 in 200 answers is wrong, and on what that rests; empty for models
            that promise nothing.
    """

    words: tuple[str, ...]
    evaluation: Evaluation
    folds: str
    facts: tuple[tuple[str, str], ...]
    duration_s: float
    promise: str = ""


@dataclass(frozen=True, slots=True)
class TrainingView:
    """A training at one moment.

    Attributes:
        phase: Where it stands.
        done: Share done, 0 to 1.
        remaining_s: Estimated; NaN while unknown.
        losses: Passes done and the loss then, oldest first.
        text: What is going on, or why it failed and what to do; one line.
        result: Of the person's model, kept with it; None when there is none.
        out_of_date: Why the model does not fit the takes any more; empty when it does.
    """

    phase: TrainingPhase = TrainingPhase.IDLE
    done: float = 0.0
    remaining_s: float = float("nan")
    losses: tuple[tuple[int, float], ...] = ()
    text: str = ""
    result: TrainingResult | None = None
    out_of_date: str = ""
