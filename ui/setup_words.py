"""Setting up in words: how far each step is, figures with their units. Pure; no widget."""

import math
from dataclasses import replace
from datetime import datetime
from enum import Enum

from gestureapp.cell.snapshot import Snapshot
from gestureapp.sensing.values import LinkState, Side, StreamHealth
from gestureapp.setup.fit import mg_words
from gestureapp.setup.snapshot import SetupSnapshot
from gestureapp.setup.values import (
    CalibrationView,
    Check,
    LevelView,
    LinkTestView,
    Outcome,
    PortChoice,
    Position,
    PosturesView,
    SensorCard,
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
    problem = next((f"{card.worn}: {card.problem}" for card in cards if card.problem), "")
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
    """What is wrong with the person's postures; empty when nothing is."""
    if math.isnan(postures.margin_deg) or postures.margin_deg >= postures.least_margin_deg:
        return postures.problem
    return (
        f"postures too close: margin {postures.margin_deg:.0f}\u00b0, "
        f"{postures.least_margin_deg:.0f}\u00b0 needed"
    )


def link_level(card: SensorCard) -> Level:
    """How much a sensor's stream wants a person."""
    return Level.OK if card.health.is_ok else Level.ATTENTION


def link_word(card: SensorCard) -> str:
    """The state of a sensor, and what is wrong with a stream that is received."""
    if card.health.link is LinkState.RECEIVING and not card.health.is_ok:
        return "receiving, not as it should"
    return card.health.link.value


def card_title(card: SensorCard) -> str:
    """What a sensor is for and where it is worn."""
    return f"{card.worn.capitalize()} arm: {ARM_WORK[card.side]}"


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
    charge = "not sent" if battery is None else f"{battery:.0f} %"
    return (
        f"{health.rate_hz:.0f} Hz" if is_coming else "\u2013",
        ms_text(health.jitter_s) if is_coming else "\u2013",
        ms_text(health.worst_gap_s) if health.worst_gap_s > 0 else "\u2013",
        count_text(health.n_lost),
        count_text(health.n_bad),
        charge if is_coming else "\u2013",
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


RESIDUALS = (("Before", "Off 1 g before"), ("After", "after"), ("Worst", "at worst"))
"""Distances from 1 g: end of the objectName, and the caption."""


def residual_texts(view: CalibrationView) -> tuple[str, ...]:
    """How far from 1 g the positions read, as named in ``RESIDUALS``."""
    return tuple(_mg_text(mg) for mg in (view.before_mg, view.after_mg, view.worst_mg))


def position_words(position: Position) -> str:
    """Which axis points where: ``Z up``."""
    axis, way = position.value.split("-")
    return f"{axis.upper()} {way}"


def calibrate_sentence(card: SensorCard, view: CalibrationView, level: LevelView) -> str:
    """What to do now with this sensor, in one sentence."""
    if view.is_on:
        return view.sentence
    if level.outcome.check is Check.RUNNING:
        return "Leave the sensor level and still."
    if not card.health.is_alive:
        return f"No data from the {card.worn} arm's sensor: see Sensors first."
    if view.outcome.check is not Check.NOT_RUN:
        return view.verdict or view.sentence
    if card.problem:
        return f"{card.problem[0].upper()}{card.problem[1:]}."
    return f"The {card.worn} arm's sensor is calibrated."


def level_words(level: LevelView) -> Outcome:
    """A level check's end; its figures where it says nothing itself."""
    found = level.outcome
    if found.text or math.isnan(level.off_deg) or found.check in (Check.NOT_RUN, Check.RUNNING):
        return found
    figures = f"{level.off_deg:.1f}\u00b0 from level, {_mg_text(level.off_mg)} from 1 g"
    return replace(found, text=figures)


POSTURE_FIGURES = (
    ("Between", "Between the two"),
    ("Margin", "Margin left"),
    ("Least", "Needed at least"),
)
"""Figures of the postures: end of the objectName, and the caption."""


def posture_texts(view: PosturesView) -> tuple[str, ...]:
    """The figures of the postures, as named in ``POSTURE_FIGURES``."""
    figures = (view.between_deg, view.margin_deg, view.least_margin_deg)
    return tuple("\u2013" if math.isnan(deg) else f"{deg:.0f}\u00b0" for deg in figures)


def postures_sentence(view: PosturesView, is_left_alive: bool) -> str:
    """What to do now for the postures, in one sentence."""
    if view.is_on:
        return view.sentence
    if not view.person:
        return "Choose a person first: see People."
    if view.problem and not view.wall_s and view.outcome.check is Check.NOT_RUN:
        return view.sentence
    if not is_left_alive:
        return f"No data from the {view.arm} arm's sensor: see Sensors first."
    if view.sentence:
        return view.sentence
    if view.wall_s:
        return f"The postures of {view.person} are recorded."
    return f"{view.person} uses the built-in postures."


def postures_kept(view: PosturesView) -> str:
    """When the postures that are used were recorded."""
    if view.problem and not view.wall_s:
        return "Nothing can be armed with them."
    if not view.wall_s:
        return "The built-in postures are used."
    return f"Recorded {datetime.fromtimestamp(view.wall_s):%Y-%m-%d %H:%M}."


def posture_level(view: PosturesView) -> Level:
    """How much the postures want a person."""
    if view.is_on:
        return Level.BUSY
    is_bad = posture_problem(view) or view.outcome.check is Check.FAILED
    return Level.ATTENTION if is_bad else Level.OK


def sensor_task(card: SensorCard, under_way: CalibrationView) -> tuple[Level, str]:
    """How the calibration of a sensor stands: its mark, and in words."""
    if under_way.is_on and under_way.side is card.side:
        return Level.BUSY, "being calibrated"
    if card.problem:
        return Level.ATTENTION, card.problem
    return Level.OK, card.calibration


def _mg_text(mg: float) -> str:
    return "\u2013" if math.isnan(mg) else mg_words(mg)
