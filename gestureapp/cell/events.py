"""What goes into the cell machine and what comes out of it. Values only; times are monotonic."""

from dataclasses import dataclass

from gestureapp.cell.snapshot import Blocker
from gestureapp.robot.values import StopReason
from gestureapp.sensing.values import ArmPosture, Side


@dataclass(frozen=True, slots=True)
class Ticked:
    """Time has passed; these things stand against arming now."""

    t_s: float
    blockers: tuple[Blocker, ...]


@dataclass(frozen=True, slots=True)
class LeftPosture:
    """The left arm's posture has changed."""

    t_s: float
    posture: ArmPosture


@dataclass(frozen=True, slots=True)
class StreamLost:
    """A sensor's stream is not usable any more."""

    t_s: float
    side: Side
    text: str


@dataclass(frozen=True, slots=True)
class ArmPressed:
    """The operator has held the arm button long enough."""

    t_s: float


@dataclass(frozen=True, slots=True)
class DisarmPressed:
    """The operator takes the permission back."""

    t_s: float


STOP_WORDS = "STOP was pressed"
"""Why, when nothing else is said."""


@dataclass(frozen=True, slots=True)
class StopPressed:
    """STOP, by the operator or for another reason from outside the cell.

    The window has told the guardian already; this is the cell's own knowledge of it.
    """

    t_s: float
    text: str = STOP_WORDS


@dataclass(frozen=True, slots=True)
class StopTestPressed:
    """The operator holds the stop test's button: arm, then one short and slow increment."""

    t_s: float
    label: str


@dataclass(frozen=True, slots=True)
class StopTestReleased:
    """The operator has let it go."""

    t_s: float


@dataclass(frozen=True, slots=True)
class Decided:
    """The recogniser has answered; ``label`` is None for "not recognised"."""

    t_s: float
    activation_id: int
    label: str | None
    text: str


@dataclass(frozen=True, slots=True)
class ArmTaken:
    """The guardian has taken the permission."""

    t_s: float


@dataclass(frozen=True, slots=True)
class ArmDenied:
    """The guardian has not."""

    t_s: float
    text: str


@dataclass(frozen=True, slots=True)
class PermissionLost:
    """The guardian has taken the permission away."""

    t_s: float


@dataclass(frozen=True, slots=True)
class MoveAccepted:
    """The controller has accepted the increment of this activation."""

    t_s: float
    activation_id: int


@dataclass(frozen=True, slots=True)
class MoveRefused:
    """The gate or the controller has refused it."""

    t_s: float
    activation_id: int
    text: str


@dataclass(frozen=True, slots=True)
class MoveEnded:
    """The increment has come to its end, read back."""

    t_s: float
    activation_id: int


@dataclass(frozen=True, slots=True)
class StopTaken:
    """The guardian is stopping the robot, whoever asked for it."""

    t_s: float
    reason: StopReason
    text: str


@dataclass(frozen=True, slots=True)
class StopDone:
    """The robot stands, read back."""

    t_s: float
    reason: StopReason


@dataclass(frozen=True, slots=True)
class StopOpen:
    """The robot has not confirmed the stop in time."""

    t_s: float
    text: str


@dataclass(frozen=True, slots=True)
class GuardianGone:
    """The guardian process has ended; another one is being started and will hold first."""

    t_s: float
    text: str


@dataclass(frozen=True, slots=True)
class Faulted:
    """Something in the cell itself has failed: a thread, a child process."""

    t_s: float
    text: str


@dataclass(frozen=True, slots=True)
class Stalled:
    """The application did not run for longer than the left sensor may be silent."""

    t_s: float
    text: str


Event = (
    Ticked | LeftPosture | StreamLost | ArmPressed | DisarmPressed | StopPressed | Decided
    | ArmTaken | ArmDenied | PermissionLost | MoveAccepted | MoveRefused | MoveEnded | StopTaken |
    StopDone | StopOpen | GuardianGone | Faulted | Stalled | StopTestPressed | StopTestReleased
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class BeginCollecting:
    """Ask the recogniser: the left arm has started at this time."""

    activation_id: int
    t_s: float


@dataclass(frozen=True, slots=True)
class EndCollecting:
    """No answer is wanted any more."""


@dataclass(frozen=True, slots=True)
class SendProposal:
    """Propose the one increment of this activation; that of a stop test is short and slow."""

    activation_id: int
    label: str
    t_s: float
    is_test: bool = False


@dataclass(frozen=True, slots=True)
class SendStop:
    """Have the robot stopped."""

    reason: StopReason
    text: str


@dataclass(frozen=True, slots=True)
class SendArm:
    """Ask the guardian to take the permission."""


@dataclass(frozen=True, slots=True)
class SendDisarm:
    """Have the guardian give it up."""


@dataclass(frozen=True, slots=True)
class Say:
    """One line of the cell's story."""

    text: str
    is_alarm: bool = False


Effect = BeginCollecting | EndCollecting | SendProposal | SendStop | SendArm | SendDisarm | Say
