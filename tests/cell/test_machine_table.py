"""Every state of the machine times every event: what follows, written out."""

from dataclasses import dataclass, replace

import pytest

from gestureapp.cell import events as e
from gestureapp.cell.machine import (
    ARMING_LIMIT_S,
    DECISION_LIMIT_S,
    PROPOSAL_LIMIT_S,
    MachineState,
    Rules,
    step,
)
from gestureapp.cell.snapshot import Blocker, CellState
from gestureapp.config import DriveMode
from gestureapp.recognition.decision import BUDGET_MOST_S
from gestureapp.recognition.onset import GIVE_UP_S
from gestureapp.robot.values import StopReason
from gestureapp.sensing.values import ArmPosture, Side

NOW_S = 100.0
"""When the event comes; the state was entered at 99.9."""
ID = 7
BLOCKER = Blocker("servo", "servo power is off", "press Servo on")

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

EVENTS = {
    "tick, ready": e.Ticked(NOW_S, ()),
    "tick, blocked": e.Ticked(NOW_S, (BLOCKER,)),
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
}
"""What holds in every state, unless the state's own row says otherwise."""

ACTIVATED_ROW = {
    "left neither": GIVEN_UP,
    "left stop": GIVEN_UP,
    "late tick": GIVEN_UP,
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
ROWS: dict[str, dict[str, Then]] = {
    "not ready": {"tick, ready": Then(S.READY), "late tick": Then(S.READY)}
    | {"arm": Then(S.NOT_READY, ("Say",))},
    "ready": {"tick, blocked": Then(S.NOT_READY), "arm": Then(S.READY, ("SendArm",))},
    "arming": {
        "tick, blocked": Then(S.NOT_READY),
        "late tick": Then(S.READY, ("SendDisarm", "Say")),
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
        "disarm": Then(S.STOPPED, ("SendDisarm",)),
        "arm taken": Then(S.ARMED, ("Say",)),
        "arm denied": Then(S.STOPPED, ("Say",)),
    },
}


def expected(state: str, event: str) -> Then:
    own = ROWS[state].get(event)
    if own is not None:
        return own
    common = EVERYWHERE.get(event)
    before = STATES[state].state
    if event == "left arm's stop taken" and STATES[state].is_at_rest:
        return Then(before, ("Say",))  # told late: nobody is armed, nothing is left
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


@pytest.mark.parametrize(
    ("posture", "after"),
    [(ArmPosture.NEITHER, S.MOVING), (ArmPosture.STOP, S.STOPPING), (ArmPosture.START, S.MOVING)],
)
def test_in_start_stop_mode_only_the_stop_posture_ends_a_move(
    posture: ArmPosture, after: CellState
):
    rules = Rules(drive_mode=DriveMode.START_STOP)
    state, _ = step(STATES["moving"], e.LeftPosture(NOW_S, posture), rules)
    assert state.state is after


def test_in_start_stop_mode_an_arm_on_its_way_does_not_end_an_activation():
    rules = Rules(drive_mode=DriveMode.START_STOP)
    state, effects = step(STATES["activated"], e.LeftPosture(NOW_S, ArmPosture.NEITHER), rules)
    assert (state.state, effects) == (S.ACTIVATED, ())


def test_a_site_may_go_on_moving_without_the_right_sensor_but_not_activated():
    rules = Rules(stop_on_right_lost=False)
    lost = EVENTS["right lost"]
    assert step(STATES["moving"], lost, rules) == (STATES["moving"], ())
    assert step(STATES["activated"], lost, rules)[0].state is S.STOPPING


def test_a_guardians_own_reason_replaces_the_cells_guess():
    """The guardian takes the permission first and says why after."""
    guessed, _ = step(STATES["moving"], e.PermissionLost(NOW_S), Rules())
    assert guessed.stop_reason is StopReason.CELL_FAULT
    told = e.StopTaken(NOW_S, StopReason.WINDOW_STALE, "window frozen for 510 ms")
    state, _ = step(guessed, told, Rules())
    assert (state.stop_reason, state.note) == (StopReason.WINDOW_STALE, told.text)


def test_the_left_arms_own_stop_never_unlatches_another():
    state, _ = step(STATES["stopping, latched"], EVENTS["left arm's stop taken"], Rules())
    assert state.stop_reason is StopReason.STOP_PRESSED
    state, _ = step(state, EVENTS["left neither"], Rules())
    state, _ = step(state, EVENTS["stop done"], Rules())
    assert state.state is S.STOPPED


def test_a_latched_stop_goes_over_the_left_arms_own():
    state, _ = step(STATES["stopping, left arm"], EVENTS["stop"], Rules())
    state, _ = step(state, EVENTS["stop done"], Rules())
    assert (state.state, state.stop_reason) == (S.STOPPED, StopReason.STOP_PRESSED)


def test_disarming_while_the_left_arm_stops_is_kept_after_standstill():
    state, effects = step(STATES["stopping, left arm"], EVENTS["disarm"], Rules())
    assert effects == (e.SendStop(StopReason.DISARMED, "disarmed by the operator"),)
    state, _ = step(state, EVENTS["stop done"], Rules())
    assert state.state is S.STOPPED


def test_permission_given_while_something_stands_against_it_is_given_back():
    arming = replace(STATES["arming"], blockers=(BLOCKER,))
    state, effects = step(arming, e.ArmTaken(NOW_S), Rules())
    assert (state.state, state.is_arming) == (S.READY, False)
    assert effects == (e.SendDisarm(), e.Say("not armed: servo power is off"))


def test_a_refusal_that_comes_after_a_stop_does_not_hide_why_it_stopped():
    state, _ = step(STATES["arming"], EVENTS["stop"], Rules())
    state, _ = step(state, EVENTS["arm denied"], Rules())
    assert state.note == "STOP was pressed"


def test_arming_without_any_answer_is_given_up_and_can_be_tried_again():
    state, _ = step(STATES["ready"], EVENTS["arm"], Rules())
    state, _ = step(state, e.Ticked(NOW_S + ARMING_LIMIT_S, ()), Rules())
    assert state.is_arming
    state, _ = step(state, e.Ticked(NOW_S + ARMING_LIMIT_S + 0.01, ()), Rules())
    assert (state.can_arm, state.note) == (True, "not armed: the guardian has not answered")


def test_an_unconfirmed_stop_is_marked_until_standstill_is_read_back():
    state, effects = step(STATES["stopping, latched"], EVENTS["stop open"], Rules())
    assert state.is_stop_unconfirmed
    assert effects[-1] == e.Say(
        "the robot has not confirmed the stop: no standstill read back", is_alarm=True
    )
    state, _ = step(state, EVENTS["stop done"], Rules())
    assert not state.is_stop_unconfirmed


def test_an_unconfirmed_stop_stays_so_when_it_gets_another_reason():
    state, _ = step(STATES["stopping, left arm"], EVENTS["stop open"], Rules())
    for event in ("stop", "latched stop taken", "guardian gone"):
        state, _ = step(state, EVENTS[event], Rules())
        assert state.is_stop_unconfirmed


def test_an_activation_given_up_needs_the_stop_posture_before_the_next():
    state, _ = step(STATES["armed"], EVENTS["left start"], Rules())
    state, _ = step(state, e.Decided(NOW_S, ID + 1, None, "no clear gesture"), Rules())
    state, _ = step(state, EVENTS["left start"], Rules())
    assert (state.state, state.activation_id) == (S.ARMED, ID + 1)
    state, _ = step(state, EVENTS["left stop"], Rules())
    state, _ = step(state, EVENTS["left start"], Rules())
    assert (state.state, state.activation_id) == (S.ACTIVATED, ID + 2)


def test_the_stop_posture_counts_from_its_first_sample_even_at_time_zero():
    state, _ = step(MachineState(), e.LeftPosture(0.0, ArmPosture.STOP), Rules())
    state, _ = step(state, e.LeftPosture(5.0, ArmPosture.STOP), Rules())
    assert state.stop_since_s == 0.0


def test_a_proposal_carries_the_label_and_the_time_of_its_decision():
    _, effects = step(STATES["activated"], EVENTS["recognised"], Rules())
    assert effects[0] == e.SendProposal(ID, "X+", NOW_S)


def test_every_stop_of_the_left_sensor_says_what_was_wrong_with_it():
    _, effects = step(STATES["moving"], EVENTS["left lost"], Rules())
    assert effects == (e.SendStop(StopReason.LEFT_SILENT, "left sensor no data"),)


@pytest.mark.parametrize("state", ["not ready", "ready"])
def test_stop_without_any_robot_is_told_and_asks_nobody(state: str):
    rules = Rules(has_robot=False)
    after, effects = step(STATES[state], e.StopPressed(NOW_S), rules)
    assert after == STATES[state]
    assert [type(effect) for effect in effects] == [e.Say]


def test_a_late_decision_leaves_the_proposal_its_whole_time():
    proposed = replace(STATES["activated"], since_s=0.0)
    decided_s = DECISION_LIMIT_S - 0.1
    proposed, _ = step(proposed, e.Decided(decided_s, ID, "X+", "recognised X+"), Rules())

    waiting, effects = step(proposed, e.Ticked(decided_s + PROPOSAL_LIMIT_S, ()), Rules())
    stopping, _ = step(proposed, e.Ticked(decided_s + PROPOSAL_LIMIT_S + 0.01, ()), Rules())

    assert (waiting.state, effects) == (S.ACTIVATED, ())
    assert stopping.state is S.STOPPING


def test_the_recogniser_has_always_answered_before_an_activation_is_given_up():
    assert GIVE_UP_S + BUDGET_MOST_S + 0.1 < DECISION_LIMIT_S
