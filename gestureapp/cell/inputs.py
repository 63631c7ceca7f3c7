"""What comes to the control thread, and what it needs of the guardian. Values only."""

from dataclasses import dataclass
from typing import Protocol

from gestureapp.cell import events as e
from gestureapp.cell.ear import ModelInUse
from gestureapp.robot import messages as m
from gestureapp.sensing.values import Sample, SensorEvent, Side


class GuardianPort(Protocol):
    """What the control thread needs of the link to the guardian."""

    def send(self, message: m.ToGuardian) -> None:
        """Say something; never blocks for long, never raises."""


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
class TrainingHeld:
    """The training is open, or closed again; while it is open nothing can be armed."""

    is_open: bool


Input = (
    SampleCame | SensorTold | GuardianSaid | ServoAsked | ModelChosen | TrainingHeld
    | e.Say | e.Event
)  # fmt: skip
