"""Where each setting's value comes from, and all that reading the layers gave."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from gestureapp.config import Settings
from gestureapp.settings_check import SettingsFinding


@dataclass(frozen=True, slots=True)
class Origin:
    """Where a value comes from; ``str()`` of it is for a person.

    Attributes:
        file: The settings file; None for what is built in.
        line: Its line there, from 1; None when it could not be told.
        is_named: The file was named on the command line.
    """

    file: Path | None = None
    line: int | None = None
    is_named: bool = False

    def __str__(self) -> str:
        if self.file is None:
            return "built-in"
        line = "" if self.line is None else f", line {self.line}"
        return f"{'--config ' if self.is_named else ''}{self.file.name}{line}"


BUILT_IN = Origin()


@dataclass(frozen=True, slots=True)
class PinEntry:
    """The site's PIN as a settings file has it.

    Attributes:
        pin_hash: Never the PIN itself; empty when none is set. Not shown in any text.
        origin: The file and line of it.
    """

    pin_hash: str = field(default="", repr=False)
    origin: Origin = BUILT_IN


@dataclass(frozen=True, slots=True)
class SettingsLayers:
    """What the layers gave.

    Attributes:
        settings: Without any finding.
        findings: What is wrong in the files, in their order.
        origins: Of every value, by dotted name.
        pin: The PIN of the lowest layer that has one.
    """

    settings: Settings
    findings: tuple[SettingsFinding, ...] = ()
    origins: Mapping[str, Origin] = field(default_factory=dict)
    pin: PinEntry = field(default_factory=PinEntry)
