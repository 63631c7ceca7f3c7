"""What comes to the control thread, and what it needs of the guardian. Values only."""

from dataclasses import dataclass
from typing import Protocol

from gestureapp.cell import events as e
from gestureapp.cell.ear import ModelInUse
from gestureapp.cell.fitness import Judgement
from gestureapp.config import SensorSettings, Settings
from gestureapp.robot import messages as m
from gestureapp.sensing.calibration import Calibration
from gestureapp.sensing.posture import LeftPostures
from gestureapp.sensing.values import Sample, SensorEvent, Side


class ReaderPort(Protocol):
    """What the control thread needs of a sensor's reader. No call waits."""

    def use(self, settings: SensorSettings) -> None:
        """Read from this port, with this protocol, from now on."""

    def set_calibration(self, calibration: Calibration) -> None:
        """Take this sensor's own errors out of every sample from now on."""


class GuardianPort(Protocol):
    """What the control thread needs of the link to the guardian."""

    def send(self, message: m.ToGuardian) -> None:
        """Say something; never blocks for long, never raises."""

    def dismiss(self) -> None:
        """Let it go while nothing may move: it ends by itself. Does not wait for it."""


@dataclass(frozen=True, slots=True)
class SampleCame:
    """A calibrated sample of one side."""

    side: Side
    sample: Sample


@dataclass(frozen=True, slots=True)
class SensorTold:
    """Whatever else a reader tells."""

    t_s: float
    side: Side
    event: SensorEvent


@dataclass(frozen=True, slots=True)
class GuardianSaid:
    """A message of the guardian."""

    message: m.FromGuardian


@dataclass(frozen=True, slots=True)
class ServoAsked:
    """The operator wants servo power on, or off."""

    is_on: bool


@dataclass(frozen=True, slots=True)
class ModelChosen:
    """Another model is to be used, as soon as nothing may move."""

    model: ModelInUse


@dataclass(frozen=True, slots=True)
class ArmingHeld:
    """Something is open beside which nothing can be armed; an empty reason lets arm again."""

    why: str


@dataclass(frozen=True, slots=True)
class SensorChosen:
    """A sensor is to be read from elsewhere, as soon as nothing may move."""

    side: Side
    settings: SensorSettings


@dataclass(frozen=True, slots=True)
class CalibrationChosen:
    """A sensor's own errors, for the samples from now on."""

    side: Side
    calibration: Calibration


@dataclass(frozen=True, slots=True)
class SensorJudged:
    """Whether a sensor may be armed with."""

    side: Side
    judgement: Judgement


@dataclass(frozen=True, slots=True)
class PosturesChosen:
    """Other postures of the left arm, as soon as nothing may move."""

    postures: LeftPostures
    judgement: Judgement


@dataclass(frozen=True, slots=True)
class SettingsChosen:
    """Other settings of site, robot and joints, as soon as nothing may move."""

    settings: Settings


SetupInput = (
    ArmingHeld | SensorChosen | CalibrationChosen | SensorJudged | PosturesChosen | SettingsChosen
)
Input = (
    SampleCame | SensorTold | GuardianSaid | ServoAsked | ModelChosen | SetupInput
    | e.Say | e.Event
)  # fmt: skip
