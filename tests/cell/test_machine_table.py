"""Every state of the machine times every event: what follows, written out."""

from dataclasses import dataclass, replace

import pytest

from gestureapp.cell import events as e
from gestureapp.cell.machine import (
    ARMING_LIMIT_S,
    DECISION_LIMIT_S,
    step,
)
from gestureapp.cell.machine_state import MachineState, Rules
from gestureapp.cell.snapshot import Blocker, CellState
from gestureapp.robot.values import StopReason
from gestureapp.sensing.values import ArmPosture, Side

NOW_S = 100.0
"""When the event comes; the state was entered at 99.9."""
ID = 7
BLOCKER = Blocker("servo", "servo power is off", "press Servo on")
SETUP = Blocker("setup", "setup is open", "go back to Operate")

S = CellState
BASE = MachineState(since_s=99.9, activation_id=ID, posture=ArmPosture.STOP, stop_since_s=90.0)

ARMED = replace(BASE, has_permission=True)

STATES = {
    "not ready": replace(BASE, state=S.NOT_READY, blockers=(BLOCKER,)),
    "ready": replace(BASE, state=S.READY, is_left_rested=True),
    "arming": replace(BASE, state=S.READY, is_left_rested=True, arming_since_s=99.9),
    "armed": replace(ARMED, state=S.ARMED, is_left_rested=True),
    "armed, not rested": replace(ARMED, state=S.ARMED, posture=ArmPosture.START),
    "activated": replace(ARMED, state=S.ACTIVATED, posture=ArmPosture.START),
    "proposed": replace(ARMED, state=S.ACTIVATED, posture=ArmPosture.START, proposed_s=99.9),
    "moving": replace(ARMED, state=S.MOVING, posture=ArmPosture.START, proposed_s=99.9),
    "stopping, left arm": replace(ARMED, state=S.STOPPING, stop_reason=StopReason.LEFT_ARM),
    "stopping, not permitted": replace(BASE, state=S.STOPPING, stop_reason=StopReason.LEFT_ARM),
    "stopping, latched": replace(BASE, state=S.STOPPING, stop_reason=StopReason.STOP_PRESSED),
    "stopped": replace(BASE, state=S.STOPPED, stop_reason=StopReason.STOP_PRESSED),
    "stopped, blocked": replace(
        BASE, state=S.STOPPED, stop_reason=StopReason.STOP_PRESSED, blockers=(BLOCKER,)
    ),
    "stopped, arming": replace(
        BASE, state=S.STOPPED, stop_reason=StopReason.STOP_PRESSED, arming_since_s=99.9
    ),
}

TEST = replace(BASE, test="X+", blockers=(SETUP,))
TEST_ARMED = replace(TEST, has_permission=True)
STATES |= {
    "ready for a test": replace(BASE, state=S.NOT_READY, blockers=(SETUP,)),
    "test, arming": replace(TEST, state=S.NOT_READY, blockers=(SETUP,), arming_since_s=99.9),
    "test, stopped, arming": replace(
        TEST, state=S.STOPPED, stop_reason=StopReason.STOP_PRESSED, arming_since_s=99.9
    ),
    "test, armed": replace(TEST_ARMED, state=S.ARMED, is_left_rested=True),
    "test, proposed": replace(TEST_ARMED, state=S.ACTIVATED, proposed_s=99.9),
    "test, moving": replace(TEST_ARMED, state=S.MOVING, proposed_s=99.9),
    "test, stopping": replace(TEST, state=S.STOPPING, stop_reason=StopReason.STOP_PRESSED),
    "test, stopping, left arm": replace(
        TEST_ARMED, state=S.STOPPING, stop_reason=StopReason.LEFT_ARM
    ),
}

EVENTS = {
    "tick, ready": e.Ticked(NOW_S, ()),
    "tick, blocked": e.Ticked(NOW_S, (BLOCKER,)),
    "tick, in setup": e.Ticked(NOW_S, (SETUP,)),
    "late tick, in setup": e.Ticked(NOW_S + max(DECISION_LIMIT_S, ARMING_LIMIT_S), (SETUP,)),
    "late tick": e.Ticked(NOW_S + max(DECISION_LIMIT_S, ARMING_LIMIT_S), ()),
    "left start": e.LeftPosture(NOW_S, ArmPosture.START),
    "left neither": e.LeftPosture(NOW_S, ArmPosture.NEITHER),
    "left stop": e.LeftPosture(NOW_S, ArmPosture.STOP),
    "left lost": e.StreamLost(NOW_S, Side.LEFT, "left sensor no data"),
    "right lost": e.StreamLost(NOW_S, Side.RIGHT, "right sensor no data"),
    "arm": e.ArmPressed(NOW_S),
    "disarm": e.DisarmPressed(NOW_S),
    "stop": e.StopPressed(NOW_S),
    "recognised": e.Decided(NOW_S, ID, "X+", "recognised X+"),
    "recognised, other": e.Decided(NOW_S, ID - 1, "X+", "recognised X+"),
    "not recognised": e.Decided(NOW_S, ID, None, "no clear gesture"),
    "arm taken": e.ArmTaken(NOW_S),
    "arm denied": e.ArmDenied(NOW_S, "servo power is off"),
    "permission lost": e.PermissionLost(NOW_S),
    "accepted": e.MoveAccepted(NOW_S, ID),
    "accepted, other": e.MoveAccepted(NOW_S, ID - 1),
    "refused": e.MoveRefused(NOW_S, ID, "too close to the edge"),
    "ended": e.MoveEnded(NOW_S, ID),
    "ended, other": e.MoveEnded(NOW_S, ID - 1),
    "left arm's stop taken": e.StopTaken(NOW_S, StopReason.LEFT_ARM, "the left arm"),
    "latched stop taken": e.StopTaken(NOW_S, StopReason.ROBOT_ALARM, "the robot has an alarm"),
    "stop done": e.StopDone(NOW_S, StopReason.LEFT_ARM),
    "stop open": e.StopOpen(NOW_S, "no standstill read back"),
    "guardian gone": e.GuardianGone(NOW_S, "the guardian has ended"),
    "faulted": e.Faulted(NOW_S, "left reader ended"),
    "stalled": e.Stalled(NOW_S, "application stood still"),
    "test": e.StopTestPressed(NOW_S, "X+"),
    "test that turns": e.StopTestPressed(NOW_S, "RX+"),
    "test released": e.StopTestReleased(NOW_S),
}


@dataclass(frozen=True)
class Then:
    """The state that follows and the kinds of effects, in their order."""

    state: CellState
    effects: tuple[str, ...] = ()


STOP = Then(S.STOPPING, ("SendStop",))
TAKEN = Then(S.STOPPING, ("Say",))
GIVEN_UP = Then(S.ARMED, ("EndCollecting", "Say"))
COLLECTING_STOPPED = Then(S.STOPPING, ("EndCollecting", "SendStop"))

EVERYWHERE = {
    "stop": STOP,
    "left arm's stop taken": TAKEN,
    "latched stop taken": TAKEN,
    "guardian gone": Then(S.STOPPING, ("SendStop", "Say")),
    "arm taken": Then(S.NOT_READY, ("SendDisarm",)),  # the state stays what it is, see below
    "faulted": Then(S.NOT_READY, ("Say",)),
    "test": Then(S.NOT_READY, ("Say",)),
    "test that turns": Then(S.NOT_READY, ("Say",)),
}
"""What holds in every state, unless the state's own row says otherwise."""

ACTIVATED_ROW = {
    "left neither": GIVEN_UP,
    "left stop": GIVEN_UP,
    "late tick": GIVEN_UP,
    "late tick, in setup": GIVEN_UP,
    "not recognised": GIVEN_UP,
    "recognised": Then(S.ACTIVATED, ("SendProposal", "Say")),
    "left lost": COLLECTING_STOPPED,
    "right lost": COLLECTING_STOPPED,
    "stop": COLLECTING_STOPPED,
    "disarm": COLLECTING_STOPPED,
    "permission lost": COLLECTING_STOPPED,
    "guardian gone": Then(S.STOPPING, ("EndCollecting", "SendStop", "Say")),
    "faulted": Then(S.STOPPING, ("EndCollecting", "SendStop", "Say")),
    "stalled": COLLECTING_STOPPED,
    "left arm's stop taken": Then(S.STOPPING, ("EndCollecting", "Say")),
    "latched stop taken": Then(S.STOPPING, ("EndCollecting", "Say")),
}
ARMED_ROW = {
    "left lost": STOP,
    "right lost": STOP,
    "disarm": Then(S.NOT_READY, ("SendDisarm", "Say")),
    "permission lost": Then(S.NOT_READY),
    "stalled": STOP,
    "faulted": Then(S.STOPPING, ("SendStop", "Say")),
}
STOPPING_ROW = {
    "disarm": STOP,
    "stop open": Then(S.STOPPING, ("Say",)),
    "faulted": Then(S.STOPPING, ("SendStop", "Say")),
}
BEGUN = ("SendArm", "Say")
TEST_ENDED = Then(S.NOT_READY, ("SendDisarm", "Say"))
TEST_MOVING_ROW = {
    "left start": STOP,
    "left neither": STOP,
    "left lost": STOP,
    "right lost": STOP,
    "disarm": STOP,
    "permission lost": STOP,
    "stalled": STOP,
    "faulted": Then(S.STOPPING, ("SendStop", "Say")),
    "test released": STOP,
    "tick, ready": STOP,
    "tick, blocked": STOP,
    "late tick": STOP,
    "ended": TEST_ENDED,
}
ROWS: dict[str, dict[str, Then]] = {
    "not ready": {"tick, ready": Then(S.READY), "late tick": Then(S.READY)}
    | {"arm": Then(S.NOT_READY, ("Say",))},
    "ready": {
        "tick, blocked": Then(S.NOT_READY),
        "tick, in setup": Then(S.NOT_READY),
        "late tick, in setup": Then(S.NOT_READY),
        "arm": Then(S.READY, ("SendArm",)),
    },
    "arming": {
        "tick, blocked": Then(S.NOT_READY),
        "tick, in setup": Then(S.NOT_READY),
        "late tick": Then(S.READY, ("SendDisarm", "Say")),
        "late tick, in setup": Then(S.READY, ("SendDisarm", "Say")),
        "disarm": Then(S.NOT_READY, ("SendDisarm", "Say")),
        "arm taken": Then(S.ARMED, ("Say",)),
        "arm denied": Then(S.READY, ("Say",)),
    },
    "armed": ARMED_ROW | {"left start": Then(S.ACTIVATED, ("BeginCollecting",))},
    "armed, not rested": ARMED_ROW,
    "activated": ACTIVATED_ROW,
    "proposed": ACTIVATED_ROW
    | {
        "left neither": COLLECTING_STOPPED,
        "left stop": COLLECTING_STOPPED,
        "late tick": COLLECTING_STOPPED,
        "late tick, in setup": COLLECTING_STOPPED,
        "recognised": Then(S.ACTIVATED),
        "not recognised": Then(S.ACTIVATED),
        "accepted": Then(S.MOVING),
        "refused": GIVEN_UP,
        "ended": Then(S.ARMED, ("Say",)),
    },
    "moving": {
        "left neither": STOP,
        "left stop": STOP,
        "left lost": STOP,
        "right lost": STOP,
        "disarm": STOP,
        "permission lost": STOP,
        "stalled": STOP,
        "ended": Then(S.ARMED, ("Say",)),
        "faulted": Then(S.STOPPING, ("SendStop", "Say")),
    },
    "stopping, left arm": STOPPING_ROW | {"stop done": Then(S.ARMED, ("Say",))},
    "stopping, not permitted": STOPPING_ROW | {"stop done": Then(S.STOPPED, ("Say",))},
    "stopping, latched": STOPPING_ROW | {"stop done": Then(S.STOPPED, ("Say",))},
    "stopped": {"arm": Then(S.STOPPED, ("SendArm",))},
    "stopped, blocked": {"arm": Then(S.STOPPED, ("Say",))},
    "stopped, arming": {
        "late tick": Then(S.STOPPED, ("SendDisarm", "Say")),
        "late tick, in setup": Then(S.STOPPED, ("SendDisarm", "Say")),
        "disarm": Then(S.STOPPED, ("SendDisarm",)),
        "arm taken": Then(S.ARMED, ("Say",)),
        "arm denied": Then(S.STOPPED, ("Say",)),
    },
    "ready for a test": {
        "tick, ready": Then(S.READY),
        "late tick": Then(S.READY),
        "arm": Then(S.NOT_READY, ("Say",)),
        "test": Then(S.NOT_READY, BEGUN),
    },
    "test, arming": {
        "tick, ready": TEST_ENDED,
        "tick, blocked": TEST_ENDED,
        "late tick": TEST_ENDED,
        "late tick, in setup": TEST_ENDED,
        "left start": TEST_ENDED,
        "left neither": TEST_ENDED,
        "arm": Then(S.NOT_READY, ("Say",)),
        "disarm": TEST_ENDED,
        "arm taken": Then(S.ARMED, ("Say",)),
        "arm denied": Then(S.NOT_READY, ("Say",)),
        "test released": TEST_ENDED,
    },
    "test, stopped, arming": {
        "tick, ready": Then(S.STOPPED, ("SendDisarm", "Say")),
        "tick, blocked": Then(S.STOPPED, ("SendDisarm", "Say")),
        "late tick": Then(S.STOPPED, ("SendDisarm", "Say")),
        "late tick, in setup": Then(S.STOPPED, ("SendDisarm", "Say")),
        "left start": Then(S.STOPPED, ("SendDisarm", "Say")),
        "left neither": Then(S.STOPPED, ("SendDisarm", "Say")),
        "disarm": Then(S.STOPPED, ("SendDisarm",)),
        "arm taken": Then(S.ARMED, ("Say",)),
        "arm denied": Then(S.STOPPED, ("Say",)),
        "test released": Then(S.STOPPED, ("SendDisarm", "Say")),
    },
    "test, armed": ARMED_ROW
    | {
        "late tick, in setup": Then(S.ACTIVATED, ("SendProposal",)),
        "tick, ready": TEST_ENDED,
        "tick, blocked": TEST_ENDED,
        "late tick": TEST_ENDED,
        "left start": TEST_ENDED,
        "left neither": TEST_ENDED,
        "test released": TEST_ENDED,
    },
    "test, proposed": {
        event: replace(then, effects=("EndCollecting", *then.effects))
        if then != TEST_ENDED
        else then
        for event, then in TEST_MOVING_ROW.items()
    }
    | {
        "late tick, in setup": COLLECTING_STOPPED,
        "stop": COLLECTING_STOPPED,
        "guardian gone": Then(S.STOPPING, ("EndCollecting", "SendStop", "Say")),
        "left arm's stop taken": Then(S.STOPPING, ("EndCollecting", "Say")),
        "latched stop taken": Then(S.STOPPING, ("EndCollecting", "Say")),
        "accepted": Then(S.MOVING),
        "refused": TEST_ENDED,
    },
    "test, moving": TEST_MOVING_ROW,
    "test, stopping": STOPPING_ROW | {"stop done": Then(S.STOPPED, ("Say",))},
    "test, stopping, left arm": STOPPING_ROW
    | {"stop done": Then(S.STOPPED, ("SendDisarm", "Say"))},
}


def expected(state: str, event: str) -> Then:
    own = ROWS[state].get(event)
    if own is not None:
        return own
    common = EVERYWHERE.get(event)
    before = STATES[state].state
    if event == "left arm's stop taken" and STATES[state].is_at_rest:
        return Then(before, ("Say",))  # told late: nobody is armed, nothing is left
    if event == "arm" and STATES[state].test:
        return Then(before, ("Say",))  # the setup, which is open, stands against it
    if common is None:
        return Then(before)
    return replace(common, state=before) if common.state is S.NOT_READY else common


@pytest.mark.parametrize("event", EVENTS)
@pytest.mark.parametrize("state", STATES)
def test_every_state_does_with_every_event_what_the_table_says(state: str, event: str):
    after, effects = step(STATES[state], EVENTS[event], Rules())
    assert Then(after.state, tuple(type(effect).__name__ for effect in effects)) == expected(
        state, event
    )


def test_the_table_has_every_kind_of_event_and_every_state():
    assert {type(event) for event in EVENTS.values()} == set(e.Event.__args__)  # type: ignore[attr-defined]
    assert {state.state for state in STATES.values()} == set(CellState)
