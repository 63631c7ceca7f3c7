"""Setting up in words: how far each step is, figures with their units. Pure; no widget."""

import math
from enum import Enum

from gestureapp.cell.snapshot import Snapshot
from gestureapp.sensing.values import LinkState, Side, StreamHealth
from gestureapp.setup.values import (
    Check,
    LinkTestView,
    PortChoice,
    PosturesView,
    SensorCard,
    SetupSnapshot,
)
from ui.marks import Level
from ui.step_state import StepState

ARM_WORK = {Side.LEFT: "start and stop", Side.RIGHT: "gestures"}
"""What each arm is for."""


class SetupStep(Enum):
    """One step of setting up; the value is the word on its button."""

    SENSORS = "Sensors"
    CALIBRATE = "Calibrate"
    ROBOT = "Robot"
    SETTINGS = "Settings"
    PEOPLE = "People"


def setup_states(setup: SetupSnapshot, cell: Snapshot) -> dict[SetupStep, StepState]:
    """How far every step is, in their order."""
    return {
        SetupStep.SENSORS: _sensors_state(setup),
        SetupStep.CALIBRATE: _calibrate_state(setup),
        SetupStep.ROBOT: _robot_state(setup),
        SetupStep.SETTINGS: _settings_state(setup),
        SetupStep.PEOPLE: _people_state(setup, cell),
    }


def _sensors_state(setup: SetupSnapshot) -> StepState:
    n_arms = setup.left.health.is_ok + setup.right.health.is_ok
    return StepState(n_arms, 2, f"{n_arms} of 2 receiving", is_problem=n_arms < 2)


def _calibrate_state(setup: SetupSnapshot) -> StepState:
    cards = (setup.left, setup.right)
    n_fine = sum(not card.problem for card in cards)
    problem = next((f"{card.side.value}: {card.problem}" for card in cards if card.problem), "")
    if not problem:
        problem = posture_problem(setup.postures)
    return StepState(
        n_fine + (not posture_problem(setup.postures)),
        3,
        problem or "ready",
        is_problem=bool(problem),
    )


def _robot_state(setup: SetupSnapshot) -> StepState:
    robot = setup.robot
    if not robot.address:
        return StepState(0, 1, "no address", is_problem=True)
    if not robot.is_connected:
        return StepState(0, 1, "not connected", is_problem=True)
    is_tested = robot.stop_test.check is Check.PASSED
    return StepState(int(is_tested), 1, "stop tested" if is_tested else "stop not tested")


def _settings_state(setup: SetupSnapshot) -> StepState:
    n_wrong = len(setup.findings)
    if n_wrong:
        text = "1 thing is wrong" if n_wrong == 1 else f"{n_wrong} things are wrong"
        return StepState(0, 1, text, is_problem=True)
    return StepState(1, 1, "in order")


def _people_state(setup: SetupSnapshot, cell: Snapshot) -> StepState:
    person = setup.postures.person or cell.person
    return StepState(1, 1, person) if person else StepState(0, 1, "nobody chosen")


def posture_problem(postures: PosturesView) -> str:
    """What is wrong with the left arm's postures; empty when nothing is."""
    if math.isnan(postures.margin_deg) or postures.margin_deg >= postures.least_margin_deg:
        return ""
    return f"postures only {postures.margin_deg:.0f}\u00b0 apart"


def link_level(card: SensorCard) -> Level:
    """How much a sensor's stream wants a person."""
    return Level.OK if card.health.is_ok else Level.ATTENTION


def link_word(card: SensorCard) -> str:
    """The state of a sensor, and what is wrong with a stream that is received."""
    if card.health.link is LinkState.RECEIVING and not card.health.is_ok:
        return "receiving, not as it should"
    return card.health.link.value


FIGURES = (
    ("Rate", "Rate"),
    ("Jitter", "Jitter"),
    ("WorstGap", "Worst gap"),
    ("Lost", "Lost"),
    ("Bad", "Unreadable"),
    ("Battery", "Battery"),
)
"""Figures of a stream: end of the objectName, and the caption."""


def figure_texts(health: StreamHealth) -> tuple[str, ...]:
    """The figures of a stream, as named in ``FIGURES``; a dash for what is not known."""
    is_coming, battery = health.rate_hz > 0, health.battery_percent
    unknown = "not sent" if is_coming else "\u2013"
    return (
        f"{health.rate_hz:.0f} Hz" if is_coming else "\u2013",
        ms_text(health.jitter_s) if is_coming else "\u2013",
        ms_text(health.worst_gap_s) if health.worst_gap_s > 0 else "\u2013",
        count_text(health.n_lost),
        count_text(health.n_bad),
        unknown if battery is None else f"{battery:.0f} %",
    )


def ms_text(span_s: float) -> str:
    """A short time in ms; a dash when it is not known."""
    if not math.isfinite(span_s):
        return "\u2013"
    ms = span_s * 1e3
    return f"{ms:.1f} ms" if ms < 10 else f"{ms:.0f} ms"


def count_text(n: int) -> str:
    """How many, in at most six letters."""
    return str(n) if n < 100_000 else f"{n / 1e6:.1f} M"


def port_text(port: PortChoice) -> str:
    """A port as a list shows it: its name, where it is, and why it cannot be opened."""
    where = "" if port.name == port.url else f"  ({port.url})"
    trouble = f": {port.trouble}" if port.trouble else ""
    return f"{port.name}{where}{trouble}"


LINK_FIGURES = (
    ("Rate", "Rate"),
    ("Jitter", "Jitter"),
    ("WorstGap", "Worst gap"),
    ("Lost", "Lost"),
    ("Bad", "Unreadable"),
    ("LowestTrip", "Carries a trip level of"),
    ("SetTrip", "Trip level set"),
)
"""Figures of a link test: end of the objectName, and the caption."""


def link_figure_texts(test: LinkTestView) -> tuple[str, ...]:
    """The figures of a link test, as named in ``LINK_FIGURES``."""
    lowest = ms_text(test.lowest_trip_s)
    return (
        f"{test.rate_hz:.1f} Hz",
        ms_text(test.jitter_s),
        ms_text(test.worst_gap_s),
        count_text(test.n_lost),
        count_text(test.n_bad),
        lowest if lowest == "\u2013" else f"{lowest} or more",
        ms_text(test.set_trip_s),
    )
