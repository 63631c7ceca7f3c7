"""Guided training in words: how far each step is, what stands against it. Pure; no widget."""

from enum import Enum

from gestureapp.cell.snapshot import Snapshot
from gestureapp.gestures import Kind, gesture
from gestureapp.guided.values import (
    GestureProgress,
    GuidedSnapshot,
    Pace,
    Phase,
    Quality,
    TrainingView,
)
from gestureapp.recording.take_values import Take, Verdict
from gestureapp.sensing.values import ArmPosture, StreamHealth
from ui.step_state import StepState

_SEEN = (Quality.FAIR, Quality.GOOD)
_TELLING = (Phase.WAITING, Phase.TAKING, Phase.PAUSED, Phase.SENSOR_LOST)
_SHORT = 14
"""Letters of ``looks like RZ+``."""
_RUNNING = (Phase.COUNT_IN, Phase.WAITING, Phase.TAKING, Phase.SENSOR_LOST)


class Step(Enum):
    """One step of the training; the value is the word on its button."""

    PERSON = "Person"
    SENSORS = "Sensors"
    RECORD = "Record"
    CHECK = "Check"
    TRAIN = "Train"
    TRY = "Try"


def step_states(
    guided: GuidedSnapshot, training: TrainingView, cell: Snapshot
) -> dict[Step, StepState]:
    """How far every step is, in their order."""
    if not guided.person:
        return _states_of_nobody(cell)
    n_good = sum(min(each.good, each.wanted) for each in guided.progress)
    n_wanted = sum(each.wanted for each in guided.progress)
    n_alike = sum(each.quality in _SEEN for each in guided.progress)
    n_sets = len(guided.progress)
    trying = guided.trying
    return {
        Step.PERSON: StepState(1, 1, guided.person),
        Step.SENSORS: _sensors_state(cell),
        Step.RECORD: StepState(n_good, n_wanted, f"{n_good} of {n_wanted}"),
        Step.CHECK: StepState(n_alike, n_sets, f"{n_alike} of {n_sets} alike"),
        Step.TRAIN: _train_state(training),
        Step.TRY: StepState(
            trying.n_done,
            trying.n_planned,
            f"{trying.n_done} of {trying.n_planned}" if trying.n_planned else "not tried",
        ),
    }


def _states_of_nobody(cell: Snapshot) -> dict[Step, StepState]:
    closed = StepState(0, 0, "", "choose a person first")
    person = StepState(0, 1, "not chosen")
    return dict.fromkeys(Step, closed) | {
        Step.PERSON: person,
        Step.SENSORS: _sensors_state(cell),
    }


def _sensors_state(cell: Snapshot) -> StepState:
    n_arms = cell.left.is_ok + cell.right.is_ok
    return StepState(n_arms, 2, f"{n_arms} of 2")


def _train_state(training: TrainingView) -> StepState:
    if training.result is None:
        return StepState(0, 1, "no model")
    if training.out_of_date:
        return StepState(0, 1, "out of date")
    return StepState(1, 1, "trained")


def is_running(phase: Phase) -> bool:
    """A batch is under way and not paused."""
    return phase in _RUNNING


def take_count(snapshot: GuidedSnapshot) -> str:
    """Which take comes, or is being made, of the gesture at hand: ``take 14 of 30``."""
    own = progress_of(snapshot, snapshot.label)
    if own is None:
        return ""
    if own.good >= own.wanted:
        return f"{own.good} of {own.wanted}: done"
    return f"take {own.good + 1} of {own.wanted}"


def progress_of(snapshot: GuidedSnapshot, label: str) -> GestureProgress | None:
    """How far one gesture is; None for one that is not in the set."""
    return next((each for each in snapshot.progress if each.label == label), None)


def instruction(label: str) -> str:
    """What the right arm does, with how the hand is held: ``push forward, hand level``."""
    words = gesture(label).words
    return words if gesture(label).kind is Kind.POSTURE else f"{words}, hand level"


def continue_text(snapshot: GuidedSnapshot) -> str:
    """How far a person is: ``132 of 360 takes. Next Z- push down: 12 of 30.``."""
    n_good = sum(min(each.good, each.wanted) for each in snapshot.progress)
    n_wanted = sum(each.wanted for each in snapshot.progress)
    whole = f"{n_good} of {n_wanted} takes."
    own = progress_of(snapshot, snapshot.suggested)
    if own is None:
        return f"{whole} All gestures are recorded."
    words = gesture(own.label).words
    return f"{whole} Next {own.label} {words}: {own.good} of {own.wanted}."


def quality_sign(quality: Quality) -> str:
    """Stands beside the ring, where words have no room."""
    return {
        Quality.NONE: "",
        Quality.FEW: "",
        Quality.POOR: "!",
        Quality.FAIR: "\u223c",
        Quality.GOOD: "\u2713",
    }[quality]


def verdict_sign(take: Take) -> str:
    """Tick, warning or cross; a dash when a person took it out."""
    if take.is_excluded:
        return "\u2013"
    if take.judgement.is_good:
        return "\u2713"
    return "!" if take.judgement.verdict is Verdict.UNLIKE else "\u2717"


def take_text(take: Take) -> str:
    """A take in words: its verdict, or that it was taken out."""
    return "excluded" if take.is_excluded else take.judgement.words


def short_take_text(take: Take) -> str:
    """The same in at most two short lines, for a small picture."""
    text = take_text(take)
    return text if len(text) <= _SHORT else take.judgement.verdict.value


def last_verdict(snapshot: GuidedSnapshot) -> str:
    """What became of the batch's last take, with its sign; empty before the first."""
    if not snapshot.batch or snapshot.phase not in _TELLING:
        return ""
    take = snapshot.batch[-1]
    return f"{verdict_sign(take)}  {take_text(take)}"


def pace_text(pace: Pace) -> str:
    """The pace with what begins a take."""
    if pace is Pace.HANDS_FREE:
        return "Hands-free: the left arm begins each take"
    return "Rhythm: a beat begins each take"


def arm_text(health: StreamHealth) -> str:
    """A sensor's state and what to do about it."""
    if health.is_ok:
        return (
            f"{health.rate_hz:.0f} samples a second, longest gap {health.worst_gap_s * 1e3:.0f} ms"
        )
    return health.reason or "wait a moment"


def level_text(tilt_deg: float, is_level: bool, *, is_wanted: bool = True) -> str:
    """How the right hand is held; a posture that is rolled or pitched wants no level hand."""
    if tilt_deg != tilt_deg:
        return "no data"
    if not is_wanted and not is_level:
        return f"{tilt_deg:.0f}\u00b0 from level"
    return "level" if is_level else f"{tilt_deg:.0f}\u00b0 off, hold it level"


def posture_text(posture: ArmPosture, was_stop_seen: bool) -> str:
    """What the left arm says, and whether it has said stop."""
    now = {
        ArmPosture.STOP: "stop posture",
        ArmPosture.START: "start posture",
        ArmPosture.NEITHER: "in between",
    }[posture]
    if posture is ArmPosture.STOP or was_stop_seen:
        return f"Left arm now: {now}. The stop posture was seen."
    return f"Left arm now: {now}. Bring it to the stop posture."
