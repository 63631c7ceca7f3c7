"""What the cell tells the record: one value per thing that happened, in the order it happened."""

import dataclasses
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import Enum

Json = str | int | float | bool | None | list["Json"] | Mapping[str, "Json"]


class Topic(Enum):
    """Where a record stands in the session file. All times in fields are monotonic seconds."""

    LEFT_ACCEL = "/left/accel"
    """seq, ax_g, ay_g, az_g, counter (or null)."""
    RIGHT_ACCEL = "/right/accel"
    """As the left."""
    GARBAGE = "/sensor/garbage"
    """side, n_bytes, first_bytes (hex), reason."""
    INPUT = "/cell/input"
    """type and fields of an event that went into the cell machine: enough to replay it."""
    STATE = "/cell/state"
    """state, sentence, activation_id."""
    RECOGNITION = "/recognition"
    """activation_id, label (or null), reason, outputs {label: confidence}, window_start_s,
    window_end_s, decided_s, onset_s (or null), thresholds, activation_s."""
    COMMAND = "/robot/command"
    """type and fields of what was asked of, let through or refused by the guardian."""
    ROBOT = "/robot/state"
    """data_1, data_2, x_mm … rz_deg as the robot answered; any may be null."""
    SETTINGS = "/cell/settings"
    """changes {dotted name: value}: settings, calibrations and postures that hold from now on."""
    EVENT = "/events"
    """text, is_alarm: the cell's story for a person."""

    @property
    def is_plot_data(self) -> bool:
        """May be dropped when the disk stalls; everything else is kept."""
        return self in (Topic.LEFT_ACCEL, Topic.RIGHT_ACCEL)


@dataclass(frozen=True, slots=True)
class Record:
    """One thing that happened. ``t_s`` monotonic; ``fields`` as the topic says."""

    topic: Topic
    t_s: float
    fields: Mapping[str, Json]


Recorder = Callable[[Record], None]
"""Takes a record at once and never blocks; called from any thread."""


def fields_of(value: object) -> dict[str, Json]:
    """A dataclass as fields for a record: its class name as ``type``, enums by value."""
    return {"type": type(value).__name__, **{n: plain(v) for n, v in _pairs(value)}}


def plain(value: object) -> Json:
    """Any value that crosses the cell, in the words of JSON."""
    if isinstance(value, Enum):
        return plain(value.value)
    if value is None or isinstance(value, str | int | float | bool):
        return value
    if dataclasses.is_dataclass(value):
        return {name: plain(field) for name, field in _pairs(value)}
    if isinstance(value, tuple | list):
        return [plain(item) for item in value]
    return str(value)


def _pairs(value: object) -> list[tuple[str, object]]:
    names = [field.name for field in dataclasses.fields(value)]  # type: ignore[arg-type]
    return [(name, getattr(value, name)) for name in names]
