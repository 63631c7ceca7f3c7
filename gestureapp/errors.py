"""Every exception of the application.

What the wire or time brings (rubbish, gaps, silence, a refused step) is a value, not an exception.
Exceptions are for "this call could not do what you asked". The tree:

    GestureAppError
      ConfigError(field, value, reason)
      SettingsRefused(findings)
      SensorError(sensor)            SensorNotFound, SensorBusy, SensorDisconnected
      RobotError                     GuardianLost, RobotInUse
      RecordingError(path)           RecordingInvalid, RecordingIncomplete, DiskFull
      ModelError(path)               ModelInvalid, ModelMismatch, NotEnoughTakes
      WorkerError(worker)            wraps what killed a thread

The text of each is one line that names the thing, the cause and the remedy; that of SettingsRefused
has one for every finding.
"""

from collections.abc import Sequence
from pathlib import Path


class GestureAppError(Exception):
    """Base of all; ``str()`` of it may be shown to a person as it is."""


class ConfigError(GestureAppError):
    """A setting cannot be used.

    Attributes:
        field: Dotted name of the setting, ``robot.host``.
        value: What was found there.
        reason: What is wrong with it, and what would be right.
    """

    def __init__(self, field: str, value: object, reason: str) -> None:
        super().__init__(f"{field} = {value!r}: {reason}")
        self.field = field
        self.value = value
        self.reason = reason


class SettingsRefused(GestureAppError):
    """Settings that bear on motion are wrong: without them the robot would go where it must not.

    Attributes:
        findings: Everything that is wrong with the settings, a line each.
    """

    def __init__(self, findings: Sequence[str]) -> None:
        end = "not started: settings that bear on motion are wrong; correct the lines above"
        super().__init__("\n".join([*findings, end] if len(findings) > 1 else findings))
        self.findings = tuple(findings)


class SensorError(GestureAppError):
    """A sensor's port could not be used.

    Attributes:
        sensor: ``left`` or ``right``.
        reason: Cause and remedy in one line, without the sensor's name.
    """

    def __init__(self, sensor: str, reason: str) -> None:
        super().__init__(f"{sensor} sensor: {reason}")
        self.sensor = sensor
        self.reason = reason


class SensorNotFound(SensorError):
    """The port does not exist, or nobody answers there."""


class SensorBusy(SensorError):
    """Another program has the port."""


class SensorDisconnected(SensorError):
    """The port was open and is gone."""


class RobotError(GestureAppError):
    """The robot's end of the chain could not do what was asked."""


class GuardianLost(RobotError):
    """The guardian process is gone or could not be started."""


class RobotInUse(RobotError):
    """Another application has the robot; a second window's STOP would reach nothing."""


class RecordingError(GestureAppError):
    """A session or take file could not be used. Attribute ``path``."""

    def __init__(self, path: Path, reason: str) -> None:
        super().__init__(f"{path}: {reason}")
        self.path = path


class RecordingInvalid(RecordingError):
    """The file is not one of ours, or is damaged beyond reading."""


class RecordingIncomplete(RecordingError):
    """The end of the file is missing; what stands before it can be read."""


class DiskFull(RecordingError):
    """No room is left where the file is."""


class ModelError(GestureAppError):
    """A model cannot be made or used. Attribute ``path``."""

    def __init__(self, path: Path, reason: str) -> None:
        super().__init__(f"{path}: {reason}")
        self.path = path


class ModelInvalid(ModelError):
    """The file is not a model, is damaged, or is from a newer version."""


class ModelMismatch(ModelError):
    """The model is for other gestures, another person or other takes."""


class NotEnoughTakes(ModelError):
    """There are too few takes to train from."""


class WorkerError(GestureAppError):
    """A thread or child process ended by an error. Attribute ``worker``: its name."""

    def __init__(self, worker: str, reason: str) -> None:
        super().__init__(f"{worker}: {reason}")
        self.worker = worker
