"""What the cell tells the record: one value per thing that happened, in the order it happened."""

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
    window_end_s, decided_s."""
    COMMAND = "/robot/command"
    """type and fields of what was asked of, let through or refused by the guardian."""
    ROBOT = "/robot/state"
    """data_1, data_2, x_mm … rz_deg as the robot answered; any may be null."""
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
