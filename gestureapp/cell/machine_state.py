"""What the cell machine remembers, and the ways between states that its parts share. Pure."""

from dataclasses import dataclass, replace

from gestureapp.cell.events import Effect, EndCollecting, SendStop
from gestureapp.cell.snapshot import Blocker, CellState
from gestureapp.config import DriveMode, Settings
from gestureapp.robot.values import StopReason
from gestureapp.sensing.values import ArmPosture


@dataclass(frozen=True, slots=True)
class Rules:
    """What the site decides about the machine.

    Attributes:
        drive_mode: What ends a move.
        stop_on_right_lost: Whether losing the right sensor stops a running move.
        has_robot: An address is set; without one nothing can be armed, and nothing moves.
    """

    drive_mode: DriveMode = DriveMode.HOLD_TO_RUN
    stop_on_right_lost: bool = True
    has_robot: bool = True


def rules_of(settings: Settings) -> Rules:
    """What these settings decide."""
    site = settings.site
    return Rules(site.drive_mode, site.stop_on_right_lost, bool(settings.robot.host))


@dataclass(frozen=True, slots=True)
class MachineState:
    """All the machine remembers.

    Attributes:
        state: The one word.
        since_s: When it was entered.
        activation_id: Of the newest activation.
        posture: What the left arm says.
        stop_since_s: Since when the left arm is in the stop posture; None when it is not.
        is_left_rested: The left arm was seen in stop since the last activation.
        blockers: What stands against arming.
        arming_since_s: When permission was asked for; None once the guardian has answered.
        has_permission: The guardian has taken the operator's permission and not lost it.
        proposed_s: When a proposal went out for the present activation; None when none has.
        stop_reason: Of the last stop.
        note: Why it is in this state, for a person.
        is_stop_unconfirmed: The robot has not confirmed a stop in time.
        test: Which way a stop test goes, from its arming to its end; empty when none is under way.
    """

    state: CellState = CellState.NOT_READY
    since_s: float = 0.0
    activation_id: int = 0
    posture: ArmPosture = ArmPosture.NEITHER
    stop_since_s: float | None = None
    is_left_rested: bool = False
    blockers: tuple[Blocker, ...] = ()
    arming_since_s: float | None = None
    has_permission: bool = False
    proposed_s: float | None = None
    stop_reason: StopReason | None = None
    note: str = ""
    is_stop_unconfirmed: bool = False
    test: str = ""

    @property
    def is_proposed(self) -> bool:
        """A proposal is out for the present activation."""
        return self.proposed_s is not None

    @property
    def is_at_rest(self) -> bool:
        """Nothing may move, and arming is what comes next."""
        return self.state in (CellState.NOT_READY, CellState.READY, CellState.STOPPED)

    @property
    def is_arming(self) -> bool:
        """Permission was asked for; the guardian has not answered."""
        return self.arming_since_s is not None

    @property
    def can_arm(self) -> bool:
        """Arming would be taken now."""
        return (
            self.state in (CellState.READY, CellState.STOPPED)
            and not self.blockers
            and not self.is_arming
        )


Step = tuple[MachineState, tuple[Effect, ...]]

PERMITTED = (CellState.ARMED, CellState.ACTIVATED, CellState.MOVING)
"""Something may move."""


def ask_stop(s: MachineState, t_s: float, reason: StopReason, text: str) -> Step:
    """Have the robot stopped; a latched reason is never replaced by the left arm's own."""
    effects: tuple[Effect, ...] = (SendStop(reason, text),)
    if s.state is CellState.ACTIVATED:
        effects = (EndCollecting(), *effects)
    if is_latched_stop(s):
        return s, effects
    return enter_stopping(s, reason, t_s, text), effects


def enter_stopping(s: MachineState, reason: StopReason, t_s: float, text: str) -> MachineState:
    """The state in which the robot is being stopped for this reason."""
    # Another reason for a stop that is already overdue does not make it less so.
    is_unconfirmed = s.state is CellState.STOPPING and s.is_stop_unconfirmed
    s = replace(s, arming_since_s=None, stop_reason=reason, is_stop_unconfirmed=is_unconfirmed)
    return enter(s, CellState.STOPPING, t_s, text)


def is_latched_stop(s: MachineState) -> bool:
    """A stop is under way that only arming again leaves."""
    is_latched = s.stop_reason is not None and s.stop_reason.is_latched
    return s.state is CellState.STOPPING and is_latched


def enter(s: MachineState, state: CellState, t_s: float, note: str) -> MachineState:
    """Another state, entered at this time, and why."""
    return replace(s, state=state, since_s=t_s, note=note)
