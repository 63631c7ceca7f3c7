"""The cell machine: (state, event) -> (state, effects). Pure.

Everything that may move the robot comes out of here, and every input is recorded with its time, so
that a session replayed through it gives the same decisions.

The way of a move: ARMED -> the left arm takes the start posture -> ACTIVATED -> the recogniser
names a gesture -> proposed to the guardian -> accepted by the controller -> MOVING -> the end is
reached, or STOPPING -> standstill read back -> ARMED after the left arm's own stop, STOPPED after
any other.
"""

from dataclasses import replace

from gestureapp.cell.events import (
    ArmDenied,
    ArmPressed,
    ArmTaken,
    BeginCollecting,
    Decided,
    DisarmPressed,
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
    Stalled,
    StopDone,
    StopOpen,
    StopPressed,
    StopTaken,
    StopTestPressed,
    StopTestReleased,
    StreamLost,
    Ticked,
)
from gestureapp.cell.machine_state import (
    PERMITTED,
    MachineState,
    Rules,
    Step,
    ask_stop,
    enter,
    enter_stopping,
    is_latched_stop,
)
from gestureapp.cell.snapshot import CellState
from gestureapp.cell.stop_test_steps import (
    arm_test_taken,
    begin_test,
    is_setup_open,
    leave_setup_in_test,
    left_posture_in_test,
    move_in_test,
    propose_test,
    release_test,
)
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


def step(s: MachineState, event: Event, rules: Rules) -> Step:
    """What an event does: the next state, and what has to be done about it."""
    s, effects = _step(s, event, rules)
    if s.test and s.is_at_rest and not s.is_arming:  # however a stop test has ended
        s = replace(s, test="")
    return s, effects


def _step(s: MachineState, event: Event, rules: Rules) -> Step:
    match event:
        case Ticked():
            return _ticked(s, event)
        case LeftPosture():
            return _left_posture(s, event, rules)
        case StreamLost():
            return _stream_lost(s, event, rules)
        case Decided():
            return _decided(s, event)
        case (
            ArmPressed() | DisarmPressed() | StopPressed() | StopTestPressed() | StopTestReleased()
        ):
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
    if s.test and not is_setup_open(s):
        return leave_setup_in_test(s, event.t_s)
    if s.state is CellState.NOT_READY and not s.blockers:
        return enter(s, CellState.READY, event.t_s, ""), ()
    if s.state is CellState.READY and s.blockers:
        return enter(s, CellState.NOT_READY, event.t_s, s.note), ()
    if s.state is CellState.ARMED and s.test:
        return propose_test(s, event.t_s)
    if s.state is CellState.ACTIVATED:
        return _waited(s, event.t_s)
    return s, ()


def _waited(s: MachineState, t_s: float) -> Step:
    if s.proposed_s is not None:
        if t_s - s.proposed_s > PROPOSAL_LIMIT_S:
            return ask_stop(s, t_s, StopReason.CELL_FAULT, "no answer to a proposal")
    elif t_s - s.since_s > DECISION_LIMIT_S:
        return _give_up(s, t_s, "no decision in time")
    return s, ()


def _left_posture(s: MachineState, event: LeftPosture, rules: Rules) -> Step:
    is_stop = event.posture is ArmPosture.STOP
    stop_since_s = (event.t_s if s.stop_since_s is None else s.stop_since_s) if is_stop else None
    is_rested = s.is_left_rested or is_stop
    s = replace(s, posture=event.posture, stop_since_s=stop_since_s, is_left_rested=is_rested)
    if s.test:
        return left_posture_in_test(s, event.t_s)
    if s.state is CellState.ARMED and event.posture is ArmPosture.START and s.is_left_rested:
        activation_id = s.activation_id + 1
        s = replace(s, activation_id=activation_id, is_left_rested=False, proposed_s=None)
        s = enter(s, CellState.ACTIVATED, event.t_s, "")
        return s, (BeginCollecting(activation_id, event.t_s),)
    if s.state in (CellState.ACTIVATED, CellState.MOVING) and _ends_move(event.posture, rules):
        if s.state is CellState.MOVING or s.is_proposed:
            return ask_stop(s, event.t_s, StopReason.LEFT_ARM, "the left arm stopped it")
        return _give_up(s, event.t_s, "the left arm went back before a gesture was recognised")
    return s, ()


def _ends_move(posture: ArmPosture, rules: Rules) -> bool:
    if rules.drive_mode is DriveMode.HOLD_TO_RUN:
        return posture is not ArmPosture.START
    return posture is ArmPosture.STOP


def _stream_lost(s: MachineState, event: StreamLost, rules: Rules) -> Step:
    if s.state not in PERMITTED:
        return s, ()
    if event.side is Side.LEFT:
        return ask_stop(s, event.t_s, StopReason.LEFT_SILENT, event.text)
    if s.state is CellState.MOVING and not rules.stop_on_right_lost:
        return s, ()
    return ask_stop(s, event.t_s, StopReason.RIGHT_LOST, event.text)


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
    s: MachineState,
    event: ArmPressed | DisarmPressed | StopPressed | StopTestPressed | StopTestReleased,
    rules: Rules,
) -> Step:
    match event:
        case StopTestPressed():
            return begin_test(s, event)
        case StopTestReleased():
            return release_test(s, event.t_s)
        case StopPressed() if not rules.has_robot:
            return s, (Say(f"{event.text}; there is no robot to stop"),)
        case StopPressed():
            return ask_stop(s, event.t_s, StopReason.STOP_PRESSED, event.text)
        case ArmPressed() if s.can_arm:
            return replace(s, arming_since_s=event.t_s), (SendArm(),)
        case ArmPressed() if s.blockers:
            return s, (Say(f"not armed: {s.blockers[0].text}"),)
        case DisarmPressed():
            return _disarm(s, event.t_s)
    return s, ()


def _disarm(s: MachineState, t_s: float) -> Step:
    if s.state in (CellState.MOVING, CellState.ACTIVATED, CellState.STOPPING):
        return ask_stop(s, t_s, StopReason.DISARMED, "disarmed by the operator")
    if s.is_arming and s.state is CellState.STOPPED:
        return replace(s, arming_since_s=None), (SendDisarm(),)
    if s.is_arming or s.state is CellState.ARMED:
        s = replace(s, arming_since_s=None, has_permission=False)
        s = enter(s, CellState.NOT_READY, t_s, "disarmed")
        return s, (SendDisarm(), Say("disarmed"))
    return s, ()


def _permission(s: MachineState, event: ArmTaken | ArmDenied | PermissionLost) -> Step:
    match event:
        case ArmTaken() if s.is_arming and s.is_at_rest and s.test:
            return arm_test_taken(s, event.t_s)
        case ArmTaken() if s.is_arming and s.is_at_rest and not s.blockers:
            s = replace(s, arming_since_s=None, has_permission=True, stop_reason=None)
            return enter(s, CellState.ARMED, event.t_s, ""), (Say("armed"),)
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
        return enter(s, CellState.NOT_READY, t_s, "disarmed by the guardian"), ()
    if s.state in PERMITTED:
        text = "the guardian took the permission away"
        return ask_stop(s, t_s, StopReason.CELL_FAULT, text)
    return s, ()


def _arm_denied(s: MachineState, text: str) -> MachineState:
    return replace(s, arming_since_s=None, note=f"not armed: {text}")


def _move(s: MachineState, event: MoveAccepted | MoveRefused | MoveEnded) -> Step:
    if event.activation_id != s.activation_id:
        return s, ()
    if s.test and not isinstance(event, MoveAccepted):
        return move_in_test(s, event)
    match event:
        case MoveAccepted() if _is_proposed(s):
            return enter(s, CellState.MOVING, event.t_s, s.note), ()
        case MoveRefused() if _is_proposed(s):
            return _give_up(s, event.t_s, f"not moved: {event.text}")
        case MoveEnded() if s.state is CellState.MOVING or _is_proposed(s):
            note = "the end of the increment is reached"
            return enter(s, CellState.ARMED, event.t_s, note), (Say(note),)
    return s, ()


def _is_proposed(s: MachineState) -> bool:
    return s.state is CellState.ACTIVATED and s.is_proposed


def _stop(s: MachineState, event: StopTaken | StopDone | StopOpen) -> Step:
    match event:
        case StopTaken():
            effects = (EndCollecting(),) if s.state is CellState.ACTIVATED else ()
            said = Say(event.text, is_alarm=event.reason.is_latched)
            # The left arm's own stop, told late, takes nobody out of a stop that is latched.
            if not event.reason.is_latched and (s.is_at_rest or is_latched_stop(s)):
                return s, (said,)
            s = enter_stopping(s, event.reason, event.t_s, event.text)
            return s, (*effects, said)
        case StopDone() if s.state is CellState.STOPPING:
            s = replace(s, is_stop_unconfirmed=False)
            reason = s.stop_reason or event.reason
            is_armed = s.has_permission and not reason.is_latched
            said = Say("the robot stands, read back")
            if s.test and s.has_permission:  # a stop test leaves nobody armed
                s = replace(s, has_permission=False)
                return enter(s, CellState.STOPPED, event.t_s, s.note), (SendDisarm(), said)
            after = CellState.ARMED if is_armed else CellState.STOPPED
            return enter(s, after, event.t_s, s.note), (said,)
        case StopOpen() if s.state is CellState.STOPPING:
            said = Say(f"the robot has not confirmed the stop: {event.text}", is_alarm=True)
            return replace(s, is_stop_unconfirmed=True), (said,)
    return s, ()


def _failed(s: MachineState, event: GuardianGone | Faulted | Stalled) -> Step:
    if isinstance(event, Stalled):
        if s.state not in PERMITTED:
            return s, ()
        return ask_stop(s, event.t_s, StopReason.APPLICATION_STALLED, event.text)
    said = Say(event.text, is_alarm=True)
    if s.state in (*PERMITTED, CellState.STOPPING) or isinstance(event, GuardianGone):
        s, effects = ask_stop(s, event.t_s, StopReason.CELL_FAULT, event.text)
        return s, (*effects, said)
    return replace(s, note=event.text), (said,)


def _give_up(s: MachineState, t_s: float, note: str) -> Step:
    """End an activation from which nothing has moved."""
    s = replace(s, proposed_s=None)
    return enter(s, CellState.ARMED, t_s, note), (EndCollecting(), Say(note))
