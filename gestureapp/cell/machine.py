"""The cell machine: (state, event) -> (state, effects). Pure.

Everything that may move the robot comes out of here, and every input is recorded with its time, so
that a session replayed through it gives the same decisions.

The way of a move: ARMED -> the left arm takes the start posture -> ACTIVATED -> the recogniser
names a gesture -> proposed to the guardian -> accepted by the controller -> MOVING -> the end is
reached, or STOPPING -> standstill read back -> ARMED after the left arm's own stop, STOPPED after
any other.
"""

from dataclasses import dataclass, replace

from gestureapp.cell.events import (
    ArmDenied,
    ArmPressed,
    ArmTaken,
    BeginCollecting,
    Decided,
    DisarmPressed,
    Effect,
    EndCollecting,
    Event,
    Faulted,
    GuardianGone,
    LeftPosture,
    MoveAccepted,
    MoveEnded,
    MoveRefused,
    PermissionLost,
    Say,
    SendArm,
    SendDisarm,
    SendProposal,
    SendStop,
    Stalled,
    StopDone,
    StopOpen,
    StopPressed,
    StopTaken,
    StreamLost,
    Ticked,
)
from gestureapp.cell.snapshot import Blocker, CellState
from gestureapp.config import DriveMode
from gestureapp.robot.values import StopReason
from gestureapp.sensing.values import ArmPosture, Side

DECISION_LIMIT_S = 2.5
"""An activation without outcome is given up after this; the recogniser answers before: it waits up
to 1.5 s for a movement, then has half a second at most to decide."""
PROPOSAL_LIMIT_S = 1.0
"""The guardian answers a proposal at once; without an answer for so long something is broken."""
ARMING_LIMIT_S = 3.0
"""The guardian gives or refuses permission within 2 s; without an answer arming is given up."""


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

_PERMITTED = (CellState.ARMED, CellState.ACTIVATED, CellState.MOVING)


def step(s: MachineState, event: Event, rules: Rules) -> Step:
    """What an event does: the next state, and what has to be done about it."""
    match event:
        case Ticked():
            return _ticked(s, event)
        case LeftPosture():
            return _left_posture(s, event, rules)
        case StreamLost():
            return _stream_lost(s, event, rules)
        case Decided():
            return _decided(s, event)
        case ArmPressed() | DisarmPressed() | StopPressed():
            return _pressed(s, event, rules)
        case ArmTaken() | ArmDenied() | PermissionLost():
            return _permission(s, event)
        case MoveAccepted() | MoveRefused() | MoveEnded():
            return _move(s, event)
        case StopTaken() | StopDone() | StopOpen():
            return _stop(s, event)
        case GuardianGone() | Faulted() | Stalled():
            return _failed(s, event)


def _ticked(s: MachineState, event: Ticked) -> Step:
    s = replace(s, blockers=event.blockers)
    if s.arming_since_s is not None and event.t_s - s.arming_since_s > ARMING_LIMIT_S:
        s = _arm_denied(s, "the guardian has not answered")
        return s, (SendDisarm(), Say(s.note))
    if s.state is CellState.NOT_READY and not s.blockers:
        return _enter(s, CellState.READY, event.t_s, ""), ()
    if s.state is CellState.READY and s.blockers:
        return _enter(s, CellState.NOT_READY, event.t_s, s.note), ()
    if s.state is CellState.ACTIVATED:
        return _waited(s, event.t_s)
    return s, ()


def _waited(s: MachineState, t_s: float) -> Step:
    if s.proposed_s is not None:
        if t_s - s.proposed_s > PROPOSAL_LIMIT_S:
            return _ask_stop(s, t_s, StopReason.CELL_FAULT, "no answer to a proposal")
    elif t_s - s.since_s > DECISION_LIMIT_S:
        return _give_up(s, t_s, "no decision in time")
    return s, ()


def _left_posture(s: MachineState, event: LeftPosture, rules: Rules) -> Step:
    is_stop = event.posture is ArmPosture.STOP
    stop_since_s = (event.t_s if s.stop_since_s is None else s.stop_since_s) if is_stop else None
    is_rested = s.is_left_rested or is_stop
    s = replace(s, posture=event.posture, stop_since_s=stop_since_s, is_left_rested=is_rested)
    if s.state is CellState.ARMED and event.posture is ArmPosture.START and s.is_left_rested:
        activation_id = s.activation_id + 1
        s = replace(s, activation_id=activation_id, is_left_rested=False, proposed_s=None)
        s = _enter(s, CellState.ACTIVATED, event.t_s, "")
        return s, (BeginCollecting(activation_id, event.t_s),)
    if s.state in (CellState.ACTIVATED, CellState.MOVING) and _ends_move(event.posture, rules):
        if s.state is CellState.MOVING or s.is_proposed:
            return _ask_stop(s, event.t_s, StopReason.LEFT_ARM, "the left arm stopped it")
        return _give_up(s, event.t_s, "the left arm went back before a gesture was recognised")
    return s, ()


def _ends_move(posture: ArmPosture, rules: Rules) -> bool:
    if rules.drive_mode is DriveMode.HOLD_TO_RUN:
        return posture is not ArmPosture.START
    return posture is ArmPosture.STOP


def _stream_lost(s: MachineState, event: StreamLost, rules: Rules) -> Step:
    if s.state not in _PERMITTED:
        return s, ()
    if event.side is Side.LEFT:
        return _ask_stop(s, event.t_s, StopReason.LEFT_SILENT, event.text)
    if s.state is CellState.MOVING and not rules.stop_on_right_lost:
        return s, ()
    return _ask_stop(s, event.t_s, StopReason.RIGHT_LOST, event.text)


def _decided(s: MachineState, event: Decided) -> Step:
    is_awaited = (
        s.state is CellState.ACTIVATED
        and event.activation_id == s.activation_id
        and not s.is_proposed
    )
    if not is_awaited:
        return s, ()
    if event.label is None:
        return _give_up(s, event.t_s, event.text)
    proposal = SendProposal(event.activation_id, event.label, event.t_s)
    return replace(s, proposed_s=event.t_s, note=event.text), (proposal, Say(event.text))


def _pressed(
    s: MachineState, event: ArmPressed | DisarmPressed | StopPressed, rules: Rules
) -> Step:
    match event:
        case StopPressed() if not rules.has_robot:
            return s, (Say(f"{event.text}; there is no robot to stop"),)
        case StopPressed():
            return _ask_stop(s, event.t_s, StopReason.STOP_PRESSED, event.text)
        case ArmPressed() if s.can_arm:
            return replace(s, arming_since_s=event.t_s), (SendArm(),)
        case ArmPressed() if s.blockers:
            return s, (Say(f"not armed: {s.blockers[0].text}"),)
        case DisarmPressed():
            return _disarm(s, event.t_s)
    return s, ()


def _disarm(s: MachineState, t_s: float) -> Step:
    if s.state in (CellState.MOVING, CellState.ACTIVATED, CellState.STOPPING):
        return _ask_stop(s, t_s, StopReason.DISARMED, "disarmed by the operator")
    if s.is_arming and s.state is CellState.STOPPED:
        return replace(s, arming_since_s=None), (SendDisarm(),)
    if s.is_arming or s.state is CellState.ARMED:
        s = replace(s, arming_since_s=None, has_permission=False)
        s = _enter(s, CellState.NOT_READY, t_s, "disarmed")
        return s, (SendDisarm(), Say("disarmed"))
    return s, ()


def _permission(s: MachineState, event: ArmTaken | ArmDenied | PermissionLost) -> Step:
    match event:
        case ArmTaken() if s.is_arming and s.is_at_rest and not s.blockers:
            s = replace(s, arming_since_s=None, has_permission=True, stop_reason=None)
            return _enter(s, CellState.ARMED, event.t_s, ""), (Say("armed"),)
        case ArmTaken() if s.is_arming and s.is_at_rest:
            s = _arm_denied(s, s.blockers[0].text)
            return s, (SendDisarm(), Say(s.note))
        case ArmTaken():
            return s, (SendDisarm(),)
        case ArmDenied() if s.is_arming:
            s = _arm_denied(s, event.text)
            return s, (Say(s.note),)
        case PermissionLost():
            return _permission_lost(replace(s, has_permission=False), event.t_s)
    return s, ()


def _permission_lost(s: MachineState, t_s: float) -> Step:
    if s.state is CellState.ARMED:
        return _enter(s, CellState.NOT_READY, t_s, "disarmed by the guardian"), ()
    if s.state in _PERMITTED:
        text = "the guardian took the permission away"
        return _ask_stop(s, t_s, StopReason.CELL_FAULT, text)
    return s, ()


def _arm_denied(s: MachineState, text: str) -> MachineState:
    return replace(s, arming_since_s=None, note=f"not armed: {text}")


def _move(s: MachineState, event: MoveAccepted | MoveRefused | MoveEnded) -> Step:
    if event.activation_id != s.activation_id:
        return s, ()
    match event:
        case MoveAccepted() if _is_proposed(s):
            return _enter(s, CellState.MOVING, event.t_s, s.note), ()
        case MoveRefused() if _is_proposed(s):
            return _give_up(s, event.t_s, f"not moved: {event.text}")
        case MoveEnded() if s.state is CellState.MOVING or _is_proposed(s):
            note = "the end of the increment is reached"
            return _enter(s, CellState.ARMED, event.t_s, note), (Say(note),)
    return s, ()


def _is_proposed(s: MachineState) -> bool:
    return s.state is CellState.ACTIVATED and s.is_proposed


def _stop(s: MachineState, event: StopTaken | StopDone | StopOpen) -> Step:
    match event:
        case StopTaken():
            effects = (EndCollecting(),) if s.state is CellState.ACTIVATED else ()
            said = Say(event.text, is_alarm=event.reason.is_latched)
            # The left arm's own stop, told late, takes nobody out of a stop that is latched.
            if not event.reason.is_latched and (s.is_at_rest or _is_latched_stop(s)):
                return s, (said,)
            s = _enter_stopping(s, event.reason, event.t_s, event.text)
            return s, (*effects, said)
        case StopDone() if s.state is CellState.STOPPING:
            s = replace(s, is_stop_unconfirmed=False)
            reason = s.stop_reason or event.reason
            is_armed = s.has_permission and not reason.is_latched
            after = CellState.ARMED if is_armed else CellState.STOPPED
            return _enter(s, after, event.t_s, s.note), (Say("the robot stands, read back"),)
        case StopOpen() if s.state is CellState.STOPPING:
            said = Say(f"the robot has not confirmed the stop: {event.text}", is_alarm=True)
            return replace(s, is_stop_unconfirmed=True), (said,)
    return s, ()


def _failed(s: MachineState, event: GuardianGone | Faulted | Stalled) -> Step:
    if isinstance(event, Stalled):
        if s.state not in _PERMITTED:
            return s, ()
        return _ask_stop(s, event.t_s, StopReason.APPLICATION_STALLED, event.text)
    said = Say(event.text, is_alarm=True)
    if s.state in (*_PERMITTED, CellState.STOPPING) or isinstance(event, GuardianGone):
        s, effects = _ask_stop(s, event.t_s, StopReason.CELL_FAULT, event.text)
        return s, (*effects, said)
    return replace(s, note=event.text), (said,)


def _ask_stop(s: MachineState, t_s: float, reason: StopReason, text: str) -> Step:
    """Have the robot stopped; a latched reason is never replaced by the left arm's own."""
    effects: tuple[Effect, ...] = (SendStop(reason, text),)
    if s.state is CellState.ACTIVATED:
        effects = (EndCollecting(), *effects)
    if _is_latched_stop(s):
        return s, effects
    return _enter_stopping(s, reason, t_s, text), effects


def _enter_stopping(s: MachineState, reason: StopReason, t_s: float, text: str) -> MachineState:
    # Another reason for a stop that is already overdue does not make it less so.
    is_unconfirmed = s.state is CellState.STOPPING and s.is_stop_unconfirmed
    s = replace(s, arming_since_s=None, stop_reason=reason, is_stop_unconfirmed=is_unconfirmed)
    return _enter(s, CellState.STOPPING, t_s, text)


def _is_latched_stop(s: MachineState) -> bool:
    is_latched = s.stop_reason is not None and s.stop_reason.is_latched
    return s.state is CellState.STOPPING and is_latched


def _give_up(s: MachineState, t_s: float, note: str) -> Step:
    """End an activation from which nothing has moved."""
    s = replace(s, proposed_s=None)
    return _enter(s, CellState.ARMED, t_s, note), (EndCollecting(), Say(note))


def _enter(s: MachineState, state: CellState, t_s: float, note: str) -> MachineState:
    return replace(s, state=state, since_s=t_s, note=note)
