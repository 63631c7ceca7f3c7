"""The stop test's own steps of the cell machine: one slow, short increment, to be stopped. Pure.

The way: pressed -> armed, with the left arm at rest in the stop posture -> after a moment one
increment is proposed, with caps that the gate only ever narrows -> STOP, or the button let go, or
the end. Whatever ends it, the permission is gone afterwards. Everything else that stops a move
stops this one, too.
"""

from dataclasses import replace

from gestureapp.cell.events import (
    Effect,
    MoveEnded,
    MoveRefused,
    Say,
    SendArm,
    SendDisarm,
    SendProposal,
    StopTestPressed,
)
from gestureapp.cell.machine_state import MachineState, Step, ask_stop, enter
from gestureapp.cell.snapshot import SETUP_BLOCKER, STOP_TEST_IGNORES, Blocker, CellState
from gestureapp.gestures import LABELS, Kind, gesture
from gestureapp.robot.values import StopReason
from gestureapp.sensing.values import ArmPosture

TEST_LEAD_S = 0.5
"""Between the arming and the move: the permission is seen before anything moves, and the robot's
position is read more often by then."""
ARM_LEFT = "the left arm left the stop posture"


SETUP_CLOSED = Blocker("setup_closed", "the setup is not open", "open Setup, step Robot")


def find_test_blocker(s: MachineState) -> Blocker | None:
    """What stands against a stop test; it needs no model, and Setup to be open."""
    if not is_setup_open(s):
        return SETUP_CLOSED
    return next((b for b in s.blockers if b.id not in STOP_TEST_IGNORES), None)


def is_setup_open(s: MachineState) -> bool:
    """Setup stands against ordinary arming, and only then a stop test can be."""
    return any(b.id == SETUP_BLOCKER for b in s.blockers)


def leave_setup_in_test(s: MachineState, t_s: float) -> Step:
    """Whoever leaves the setup leaves the test."""
    return _end(s, t_s, SETUP_CLOSED.text)


def begin_test(s: MachineState, event: StopTestPressed) -> Step:
    """Ask for the permission, unless something stands against it."""
    if event.label not in LABELS or gesture(event.label).kind is not Kind.MOVEMENT:
        return s, (Say(f"no stop test: {event.label!r} is no movement"),)
    if not s.is_at_rest or s.is_arming:
        return s, (Say("no stop test: the cell is not at rest"),)
    if (blocker := find_test_blocker(s)) is not None:
        return s, (Say(f"no stop test: {blocker.text}"),)
    if s.posture is not ArmPosture.STOP:
        return s, (Say(f"no stop test: {ARM_LEFT}"),)
    s = replace(s, arming_since_s=event.t_s, test=event.label)
    return s, (SendArm(), Say(f"stop test along {event.label}"))


def arm_test_taken(s: MachineState, t_s: float) -> Step:
    """The guardian has taken the permission for a test."""
    blocker = find_test_blocker(s)
    if blocker is not None or s.posture is not ArmPosture.STOP:
        return _disarmed(s, t_s, blocker.text if blocker is not None else ARM_LEFT)
    s = replace(s, arming_since_s=None, has_permission=True, stop_reason=None)
    return enter(s, CellState.ARMED, t_s, ""), (Say("armed for the stop test"),)


def propose_test(s: MachineState, t_s: float) -> Step:
    """The one increment, a moment after the arming."""
    if t_s - s.since_s < TEST_LEAD_S:
        return s, ()
    activation_id = s.activation_id + 1
    s = replace(s, activation_id=activation_id, proposed_s=t_s)
    s = enter(s, CellState.ACTIVATED, t_s, f"stop test along {s.test}")
    return s, (SendProposal(activation_id, s.test, t_s, is_test=True),)


def left_posture_in_test(s: MachineState, t_s: float) -> Step:
    """The left arm rests for the whole test, or it ends."""
    return (s, ()) if s.posture is ArmPosture.STOP else _end(s, t_s, ARM_LEFT)


def release_test(s: MachineState, t_s: float) -> Step:
    """The button was let go."""
    return _end(s, t_s, "the button of the stop test was let go") if s.test else (s, ())


def move_in_test(s: MachineState, event: MoveRefused | MoveEnded) -> Step:
    """The increment was refused, or came to its end without a stop."""
    is_proposed = s.state is CellState.ACTIVATED and s.is_proposed
    match event:
        case MoveRefused() if is_proposed:
            return _disarmed(s, event.t_s, f"not moved: {event.text}")
        case MoveEnded() if is_proposed or s.state is CellState.MOVING:
            return _disarmed(s, event.t_s, "the end was reached, STOP was not pressed")
    return s, ()


def _end(s: MachineState, t_s: float, why: str) -> Step:
    if s.state in (CellState.ACTIVATED, CellState.MOVING):
        return ask_stop(s, t_s, StopReason.STOP_TEST, why)
    if s.state is CellState.ARMED or s.is_arming:
        return _disarmed(s, t_s, why)
    return s, ()


def _disarmed(s: MachineState, t_s: float, why: str) -> Step:
    """At rest without the permission; a latched stop of before stays one."""
    note = f"stop test: {why}"
    after = CellState.STOPPED if s.state is CellState.STOPPED else CellState.NOT_READY
    s = replace(s, arming_since_s=None, has_permission=False, proposed_s=None)
    effects: tuple[Effect, ...] = (SendDisarm(), Say(note))
    return enter(s, after, t_s, note), effects
