"""The supervisor: permission, one activation, one increment, how a move ends, refusals."""

from dataclasses import replace

import pytest

from gestureapp.robot import messages as m
from gestureapp.robot.obstacles import KeepOut
from gestureapp.robot.values import Direction, Pose, Position, Posture, StopReason


def test_a_connected_robot_is_read_and_told_of(cell):
    assert cell.heard(m.LinkReport)[0].is_open
    assert cell.heard(m.StatusReport)[-1].data_1 == 0xC2
    here = Position(Pose(800.0, 0.0, 300.0, -180.0, 0.0, 0.0), Posture(1), 0)
    assert cell.heard(m.PoseReport)[-1].position == here
    assert cell.supervisor.is_link_open
    assert not cell.supervisor.may_move
    assert cell.moves() == []


def test_a_new_application_is_told_what_is_known(cell):
    cell.forget()
    cell.supervisor.greeted(cell.now_s)
    cell.collect()

    (link,), (status,) = cell.heard(m.LinkReport), cell.heard(m.StatusReport)
    assert (link.is_open, status.data_2) == (True, 0x40)


def test_a_new_application_hears_why_there_is_no_robot(new_cell):
    cell = new_cell(is_connected=False)
    cell.supervisor.greeted(cell.now_s)
    for _ in range(3):
        cell.cut("refused")

    assert cell.heard(m.LinkReport) == [
        m.LinkReport(False, "not connected yet"),
        m.LinkReport(False, "refused"),
    ]


def test_arming_is_taken_with_everything_in_order(cell):
    cell.say(m.Arm())

    assert cell.supervisor.is_armed
    assert cell.heard(m.Armed) == [m.Armed()]
    assert cell.supervisor.may_move


@pytest.mark.parametrize(
    ("data_1", "data_2", "reason"),
    [
        (0xC2, 0x50, "alarm"),
        (0xC2, 0x60, "error"),
        (0xA2, 0x40, "teach"),
        (0x42, 0x40, "not_remote"),
        (0x82, 0x40, "not_play"),
        (0xC2, 0x00, "servo_off"),
        (0xC2, 0x42, "held"),
        (0xC2, 0x44, "held"),
        (0xCA, 0x40, "running"),
    ],
)
def test_arming_is_refused_by_what_the_controller_says(new_cell, new_robot, data_1, data_2, reason):
    cell = new_cell(robot=new_robot(data_1=data_1, data_2=data_2))
    cell.say(m.Arm())

    (refused,) = cell.heard(m.ArmRefused)
    assert refused.refusal.reason == reason
    assert not cell.supervisor.is_armed


@pytest.mark.parametrize("posture", ["start", "neither"])
def test_arming_needs_the_left_arm_in_stop(cell, posture):
    cell.posture = posture
    cell.step()
    cell.say(m.Arm())

    assert cell.heard(m.ArmRefused)[0].refusal.reason == "left_not_stop"


@pytest.mark.parametrize("age_s", [0.13, float("inf"), -0.06, -5.0])
def test_arming_needs_a_left_sample_of_now(cell, age_s):
    cell.left_s = age_s
    cell.step()
    cell.say(m.Arm())

    assert cell.heard(m.ArmRefused)[0].refusal.reason == "left_silent"


def test_arming_needs_a_heartbeat_and_a_link(new_cell):
    cell = new_cell(is_connected=False)
    cell.beats = False
    cell.say(m.Arm())
    cell.is_reachable = True
    cell.run(0.1)
    cell.say(m.Arm())

    assert [r.refusal.reason for r in cell.heard(m.ArmRefused)] == ["no_link", "left_silent"]


def test_a_move_goes_out_once_and_ends_where_it_was_planned(cell):
    cell.move()
    (sent,) = cell.heard(m.CommandSent)
    assert sent.increment.dx_mm == 341.895
    assert (sent.activation_id, sent.speed, sent.is_rotation) == (1, 100.0, False)
    assert sent.limited_by == "outer sphere"
    assert cell.supervisor.has_commanded

    cell.until(lambda: cell.heard(m.MotionEnded))

    assert cell.heard(m.MotionEnded)[0].pose.x_mm == pytest.approx(1141.895, abs=0.01)
    assert cell.supervisor.is_armed
    assert not cell.supervisor.has_commanded
    assert len(cell.moves()) == len(cell.payloads()) == 1
    assert cell.heard(m.StopAsked) == []


def test_a_turn_across_180_ends_where_it_was_planned(cell):
    cell.move(direction=Direction(0, 1, True))
    cell.until(lambda: cell.heard(m.MotionEnded), limit_s=10)

    assert cell.heard(m.CommandSent)[0].increment.drx_deg == 58.0
    assert cell.heard(m.MotionEnded)[0].pose.rx_deg == pytest.approx(-122.0)


def test_without_the_gates_permission_nothing_goes_out(cell):
    cell.posture = "start"
    cell.step()
    cell.propose()
    cell.run(0.2)

    assert cell.heard(m.CommandRefused)[0].refusal.reason == "not_armed"
    assert cell.moves() == []


def test_a_proposal_while_a_move_is_open_is_refused_and_the_move_goes_on(cell):
    cell.move()
    cell.propose()
    cell.run(0.1)

    assert cell.heard(m.CommandRefused)[0].refusal.reason == "busy"
    assert len(cell.moves()) == 1
    assert cell.robot.is_running


def test_two_proposals_in_one_moment_give_one_move(cell):
    cell.robot.answer_s = 0.02
    cell.arm()
    cell.posture = "start"
    cell.run(0.1)
    cell.propose(activation_id=1)
    cell.propose(activation_id=1)
    cell.propose(activation_id=2)
    cell.run(0.3)

    assert [r.refusal.reason for r in cell.heard(m.CommandRefused)] == ["busy", "busy"]
    assert len(cell.payloads()) == 1


def test_a_used_activation_gives_nothing_after_its_move_has_ended(cell):
    cell.move()
    cell.until(lambda: cell.heard(m.MotionEnded))
    cell.propose(activation_id=1)
    cell.propose(activation_id=0)
    cell.run(0.2)

    assert {r.refusal.reason for r in cell.heard(m.CommandRefused)} == {"activation_used"}
    assert len(cell.moves()) == 1


def test_a_move_the_controller_refused_has_used_its_activation(cell):
    cell.arm()
    cell.robot.refuses["IMOV"] = 2010
    cell.posture = "start"
    cell.run(0.1)
    cell.propose()
    cell.run(0.1)
    (refused,) = cell.heard(m.CommandRefused)
    assert refused.refusal.text == "the robot refused: manipulator moving (2010)"
    assert cell.supervisor.is_armed
    assert not cell.supervisor.has_commanded
    cell.robot.refuses.clear()
    cell.propose(activation_id=1)

    assert cell.heard(m.CommandRefused)[-1].refusal.reason == "activation_used"
    cell.posture = "stop"
    cell.forget()
    cell.move()
    assert len(cell.payloads()) == 1


def test_a_command_waits_for_the_one_answer_and_is_judged_again_before_it_goes(cell):
    cell.robot.answer_s = 0.02
    cell.arm()
    cell.posture = "start"
    cell.until(lambda: not cell.supervisor._exchange.can_send)
    cell.propose()
    assert cell.moves() == []
    cell.posture = "stop"
    cell.run(0.2)

    assert cell.heard(m.CommandRefused)[0].refusal.reason == "left_not_start"
    assert cell.moves() == []


@pytest.mark.parametrize(
    ("x_mm", "told"),
    [(800.0, "keep-out 'post'"), (850.0, "keep-out 'post'"), (950.0, "outside_field")],
)
def test_the_place_that_came_with_the_awaited_answer_decides(new_cell, limits, x_mm, told):
    """The robot was put elsewhere between the proposal and the moment its bytes could leave."""
    post = KeepOut("post", (900.0, -100.0, 200.0), (1000.0, 100.0, 400.0))
    cell = new_cell(limits=replace(limits, field=replace(limits.field, keep_outs=(post,))))
    cell.robot.answer_s = 0.02
    cell.arm()
    cell.posture = "start"
    cell.until(lambda: cell.wire[-1][1] == b"1,0\r" and cell.robot.out)  # RPOSC awaits its answer
    cell.robot.out = [
        (t_s, data.replace(b"800.000", b"%.3f" % x_mm)) for t_s, data in cell.robot.out
    ]
    cell.propose()
    cell.run(0.06)

    if told == "outside_field":
        assert cell.heard(m.CommandRefused)[0].refusal.reason == told
        assert cell.moves() == []
    else:
        sent = cell.heard(m.CommandSent)[0]
        assert (sent.start.x_mm, sent.limited_by) == (x_mm, told)
        assert sent.increment.dx_mm == pytest.approx(900.0 - x_mm - limits.field.margin_mm)


def test_a_decision_that_waited_too_long_is_not_sent(cell):
    cell.robot.answer_s = 0.2
    cell.run(2.0)
    cell.arm()
    cell.posture = "start"
    cell.run(0.6)
    cell.until(lambda: cell.wire[-1][1].startswith(b"HOSTCTRL"))
    cell.propose()
    cell.run(1.0)

    assert cell.heard(m.CommandRefused)
    assert cell.moves() == []


@pytest.mark.parametrize("t_s", [-0.2, 0.2])
def test_a_decision_of_another_time_is_refused(cell, t_s):
    cell.arm()
    cell.posture = "start"
    cell.run(0.1)
    cell.propose(t_s=cell.now_s + t_s)

    assert cell.heard(m.CommandRefused)[0].refusal.reason == "proposal_age"


def test_while_the_cell_decides_the_state_is_not_asked(cell):
    cell.robot.answer_s = 0.02
    cell.arm()
    cell.run(0.2)
    cell.posture = "start"
    cell.step()
    begin_s = cell.now_s
    cell.run(0.25)

    asked = cell.asked(begin_s + 0.05)
    assert "RPOSC 1,0" in asked
    assert "RSTATS" not in asked


def test_a_move_that_never_starts_is_stopped_and_said_so(cell):
    cell.arm()
    cell.robot.ignores.add("IMOV")
    cell.posture = "start"
    cell.run(0.1)
    cell.propose()
    took_s = cell.until(lambda: cell.heard(m.StopAsked))

    (stop,) = cell.heard(m.StopAsked)
    assert stop.reason is StopReason.ROBOT_CHANGED
    assert stop.text == "the robot stands 341.9 mm before the end"
    assert 0.3 <= took_s < 0.7
    assert cell.supervisor.latch is StopReason.ROBOT_CHANGED


@pytest.mark.parametrize("start_s", [0.1, 0.25, 0.29])
def test_a_move_that_starts_late_is_not_taken_for_one_that_never_starts(cell, start_s):
    cell.robot.start_s = start_s
    cell.move()
    cell.until(lambda: cell.heard(m.MotionEnded))

    assert cell.heard(m.StopAsked) == []


def test_a_move_that_ends_short_is_latched(cell):
    cell.robot.stops_after_mm = 100.0
    cell.move()
    cell.until(lambda: cell.heard(m.StopConfirmed))

    assert cell.heard(m.StopAsked)[0].text == "the robot stands 241.9 mm before the end"
    assert cell.supervisor.latch is StopReason.ROBOT_CHANGED
    assert not cell.supervisor.is_armed


def test_a_move_that_takes_too_long_is_stopped(cell):
    cell.move()
    unit, _, left = cell.robot.move
    cell.robot.move = (unit, 1.0, left)
    cell.until(lambda: cell.heard(m.StopAsked), limit_s=12)

    (stop,) = cell.heard(m.StopAsked)
    assert stop.reason is StopReason.CELL_FAULT
    assert stop.text.startswith("the move takes longer than 8.1")


def test_disarming_while_nothing_moves_needs_no_stop(cell):
    cell.arm()
    cell.say(m.Disarm())
    cell.run(0.3)

    assert cell.heard(m.Disarmed) == [m.Disarmed()]
    assert cell.heard(m.StopAsked) == []
    assert not cell.supervisor.may_move


def test_disarming_while_moving_stops_latched(cell):
    cell.move()
    cell.say(m.Disarm())
    cell.until(lambda: cell.heard(m.StopConfirmed))

    assert cell.heard(m.StopAsked)[0].reason is StopReason.DISARMED
    assert cell.supervisor.latch is StopReason.DISARMED
    assert cell.heard(m.Disarmed) == [m.Disarmed()]


def test_disarming_takes_back_a_command_that_still_waits(cell):
    cell.robot.answer_s = 0.05
    cell.arm()
    cell.posture = "start"
    cell.run(0.1)
    cell.until(lambda: not cell.supervisor._exchange.can_send)
    cell.propose()
    cell.say(m.Disarm())
    cell.run(0.5)

    assert cell.moves() == []
    assert cell.heard(m.StopAsked)[0].reason is StopReason.DISARMED
