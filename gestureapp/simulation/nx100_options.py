"""How the emulated NX100's server behaves: segments, delays, faults. Values only."""

from dataclasses import dataclass, field
from enum import Enum
from pathlib import Path

from gestureapp.simulation.nx100_values import ControllerOptions


class Segments(Enum):
    """How answers are cut into TCP segments."""

    SEPARATE = "separate"
    """Time between ``OK:`` and the answer, as clients need that read once per line."""
    COALESCED = "coalesced"
    """All that is due in one segment."""
    BYTEWISE = "bytewise"
    LATE_LF = "late-lf"
    """The LF of a CR LF comes later, in a segment with what follows."""


class Second(Enum):
    """What happens to a connection while another one is open."""

    ACCEPT = "accept"
    REFUSE = "refuse"
    """Reset as soon as it is there."""
    IGNORE = "ignore"
    """It gets its turn when the other one is closed."""


class FaultKind(Enum):
    """What is wrong with the controller or the line to it."""

    NONE = "none"
    SILENT = "silent"
    NG = "ng"
    ERROR = "error"
    SLOW = "slow"
    PIECES = "pieces"
    GARBAGE = "garbage"
    DROP = "drop"
    """Once: every connection is reset."""
    REFUSE = "refuse"
    """Nobody listens; what is open stays open."""


_LOSES_COMMANDS = frozenset({FaultKind.SILENT, FaultKind.NG, FaultKind.ERROR})


@dataclass(frozen=True, slots=True)
class Fault:
    """A fault and its parameters.

    Attributes:
        kind: What is wrong.
        delay_s: SLOW: how late everything is sent.
        code: ERROR: what every command is answered with.
        piece_bytes: PIECES: size of a piece.
        gap_s: PIECES: time between pieces.
        executes: Whether commands take effect all the same; None: not for SILENT, NG and ERROR.
    """

    kind: FaultKind = FaultKind.NONE
    delay_s: float = 0.5
    code: int = 2060
    piece_bytes: int = 3
    gap_s: float = 0.02
    executes: bool | None = None

    @property
    def is_executed(self) -> bool:
        """Whether commands take effect."""
        return self.kind not in _LOSES_COMMANDS if self.executes is None else self.executes


@dataclass(frozen=True, slots=True)
class ScriptedFault:
    """A fault that begins by itself, so many seconds after the start."""

    at_s: float
    fault: Fault


@dataclass(frozen=True, slots=True)
class Nx100Options:
    """The emulator's settings.

    Attributes:
        host: Address to listen on.
        port: TCP port; 0 picks a free one.
        control_port: Of the virtual pendant; 0 picks a free one, None for none.
        controller: The emulated cell.
        segments: How answers are cut.
        answer_delay_s: From the last byte of a request to its answer.
        separation_s: SEPARATE: between ``OK:`` and an answer that nothing has to come before.
        late_lf_s: LATE_LF: how late.
        byte_gap_s: BYTEWISE: between two bytes.
        close_delay_s: From the last answer to closing, so that a slow client can read it.
        is_strict: Refuse odd sizes and spellings.
        second: What a second connection meets.
        idle_close_s: A connection silent for so long is closed; None never. A YRC1000 has 30 s, the
            NX100's time is not known.
        version: In the banner.
        script: Faults that begin by themselves.
        log_file: JSON lines of every byte, request and motion; None for none.
    """

    host: str = "127.0.0.1"
    port: int = 0
    control_port: int | None = None
    controller: ControllerOptions = field(default_factory=ControllerOptions)
    segments: Segments = Segments.SEPARATE
    answer_delay_s: float = 0.0
    separation_s: float = 0.02
    late_lf_s: float = 0.02
    byte_gap_s: float = 0.001
    close_delay_s: float = 0.3
    is_strict: bool = False
    second: Second = Second.ACCEPT
    idle_close_s: float | None = None
    version: str = "1.07"
    script: tuple[ScriptedFault, ...] = ()
    log_file: Path | None = None
