"""What single steps of the machine do beyond the table of states and events."""

from dataclasses import replace

import pytest

from gestureapp.cell import events as e
from gestureapp.cell.machine import ARMING_LIMIT_S, DECISION_LIMIT_S, PROPOSAL_LIMIT_S, step
from gestureapp.cell.machine_state import MachineState, Rules
from gestureapp.cell.snapshot import Blocker, CellState
from gestureapp.cell.stop_test_steps import TEST_LEAD_S
from gestureapp.config import DriveMode
from gestureapp.recognition.decision import BUDGET_MOST_S
from gestureapp.recognition.onset import GIVE_UP_S
from gestureapp.robot.values import StopReason
from gestureapp.sensing.values import ArmPosture
from tests.cell.test_machine_table import BLOCKER, EVENTS, ID, NOW_S, SETUP, STATES

S = CellState


@pytest.mark.parametrize("event", EVENTS)
@pytest.mark.parametrize("state", STATES)
def test_no_event_leads_from_a_stop_test_to_armed(state: str, event: str):
    before = STATES[state]
    after, _ = step(before, EVENTS[event], Rules())
    if before.test and after.state is S.ARMED:
        assert (event, after.test) == ("arm taken", "X+") or before.state is S.ARMED
    if after.is_at_rest and not after.is_arming:
        assert not after.test
    if before.test and after.is_at_rest:
        assert not after.has_permission


def test_a_stop_test_arms_for_itself_only_and_moves_a_moment_later():
    state, effects = step(STATES["test, arming"], EVENTS["arm taken"], Rules())
    assert (state.test, state.has_permission) == ("X+", True)
    assert effects == (e.Say("armed for the stop test"),)
    waiting, effects = step(state, e.Ticked(NOW_S + TEST_LEAD_S - 0.01, (SETUP,)), Rules())
    assert (waiting.state, effects) == (S.ARMED, ())
    moving, effects = step(waiting, e.Ticked(NOW_S + TEST_LEAD_S, (SETUP,)), Rules())
    assert effects == (e.SendProposal(ID + 1, "X+", NOW_S + TEST_LEAD_S, is_test=True),)
    again, effects = step(moving, e.Ticked(NOW_S + TEST_LEAD_S + 0.01, (SETUP,)), Rules())
    assert (again, effects) == (moving, ())


def test_a_stop_test_needs_no_model_but_an_open_setup():
    no_model = Blocker("model", "text", "remedy")
    blocked = replace(STATES["ready for a test"], blockers=(SETUP, no_model))
    assert step(blocked, EVENTS["test"], Rules())[1][0] == e.SendArm()
    closed = replace(blocked, blockers=(no_model,))
    assert step(closed, EVENTS["test"], Rules()) == (
        closed,
        (e.Say("no stop test: the setup is not open"),),
    )


@pytest.mark.parametrize("name", ["lock", "left_unfit", "left_stop", "robot_pose", "postures"])
def test_everything_else_stands_against_a_stop_test_also_as_it_arms(name: str):
    blocker = Blocker(name, "text", "remedy")
    blocked = replace(STATES["ready for a test"], blockers=(SETUP, blocker))
    assert step(blocked, EVENTS["test"], Rules()) == (blocked, (e.Say("no stop test: text"),))
    arming = replace(STATES["test, arming"], blockers=(SETUP, blocker))
    state, effects = step(arming, EVENTS["arm taken"], Rules())
    assert not state.has_permission
    assert effects[0] == e.SendDisarm()


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
