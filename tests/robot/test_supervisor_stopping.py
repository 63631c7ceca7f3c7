"""The stop path: every reason, first on the wire, repeated, read back, escalated, released."""

import pytest

from gestureapp.robot import messages as m
from gestureapp.robot.stopping import ESCALATE_S, REPEAT_S, UNCONFIRMED_S
from gestureapp.robot.values import StopReason

ORDINARY = [reason for reason in StopReason if reason.is_latched]


def holds(cell, since_s=0.0):
    return [t_s for t_s, text in cell.robot.requests if text == "HOLD 1" and t_s >= since_s]


@pytest.mark.parametrize("reason", ORDINARY)
def test_every_stop_but_the_left_arms_is_latched_and_left_only_by_arming(cell, reason):
    cell.move()
    cell.stop(reason, "because")
    assert cell.supervisor.latch is reason
    assert not cell.supervisor.is_armed
    cell.until(lambda: cell.heard(m.StopConfirmed))
    (asked,) = cell.heard(m.StopAsked)
    assert (asked.reason, asked.text) == (reason, "because")
    assert cell.heard(m.Disarmed) == [m.Disarmed()]
    assert not cell.robot.is_running

    cell.posture = "start"
    cell.run(0.5)
    cell.propose()
    cell.run(0.5)
    assert cell.heard(m.CommandRefused)[-1].refusal.reason == "latched"
    assert cell.robot.is_held

    cell.posture = "stop"
    cell.run(0.1)
    cell.arm()
    assert cell.supervisor.latch is None
    assert not cell.robot.is_held
    assert len(cell.payloads()) == 1
    cell.move()
    assert len(cell.payloads()) == 2


def test_the_reason_of_a_stop_is_told_before_the_permission_is_lost(cell):
    cell.move()
    cell.stop(StopReason.STOP_PRESSED)

    words = [type(x) for _, x in cell.told if isinstance(x, m.StopAsked | m.Disarmed)]
    assert words == [m.StopAsked, m.Disarmed]


def test_the_left_arms_own_stop_keeps_the_permission_and_releases_the_hold(cell):
    cell.move()
    cell.posture = "neither"
    cell.until(lambda: cell.heard(m.StopConfirmed))
    assert cell.heard(m.StopAsked)[0].reason is StopReason.LEFT_ARM
    assert cell.supervisor.is_armed
    assert cell.supervisor.latch is None
    cell.run(1.0)
    assert cell.robot.is_held  # released only when that arm is in stop
    assert cell.heard(m.HoldReleased) == []

    cell.posture = "stop"
    took_s = cell.until(lambda: cell.heard(m.HoldReleased))
    assert not cell.robot.is_held
    assert took_s < 0.2
    before = cell.asked()
    assert before[before.index("HOLD 0") - 1] == "RPOSC 1,0"
    cell.run(0.5)
    cell.forget()
    cell.move()
    assert len(cell.payloads()) == 1


def test_a_stop_goes_out_after_at_most_one_outstanding_answer(cell):
    cell.robot.answer_s = 0.05
    cell.move()
    for _ in range(7):
        cell.step()
    cell.forget()
    cell.stop(StopReason.STOP_PRESSED)
    cell.until(lambda: holds(cell))

    assert len(cell.asked()) <= 2  # what was in flight, then HOLD
    assert cell.asked()[-1] == "HOLD 1"


def test_a_stop_goes_before_a_command_that_waits(cell):
    cell.robot.answer_s = 0.05
    cell.arm()
    cell.posture = "start"
    cell.run(0.1)
    cell.until(lambda: not cell.supervisor._exchange.can_send)
    cell.propose()
    cell.stop(StopReason.STOP_PRESSED)
    cell.until(lambda: cell.heard(m.StopConfirmed))

    assert cell.moves() == []
    assert cell.heard(m.CommandRefused) == []


@pytest.mark.parametrize("reason", [StopReason.STOP_PRESSED, StopReason.LEFT_ARM])
def test_a_stop_takes_back_a_move_whose_data_has_not_gone_out(cell, reason):
    cell.robot.answer_s = 0.02
    cell.arm()
    cell.posture = "start"
    cell.run(0.1)
    cell.propose()
    cell.until(cell.moves)
    assert cell.payloads() == []
    cell.stop(reason)
    stopped_s = cell.now_s
    cell.until(lambda: cell.heard(m.StopConfirmed))

    assert cell.payloads() == []
    assert cell.drops == ["IMOV was taken back before its data went out"]
    assert cell.asked(stopped_s)[0] == "HOLD 1"
    assert cell.supervisor.is_armed is (reason is StopReason.LEFT_ARM)


def test_an_ok_that_comes_after_silence_does_not_let_the_move_out(cell):
    cell.arm()
    cell.robot.answer_s = 0.02
    cell.posture = "start"
    cell.run(0.1)
    cell.propose()
    cell.until(cell.moves)
    cell.now_s += 0.2  # the guardian was held up; nothing was heard of the left arm
    cell.supervisor.robot_bytes(b"OK: IMOV\r\n", cell.now_s)
    cell.collect()

    assert cell.payloads() == []
    assert cell.supervisor.latch is StopReason.COMPUTER_STALLED


def test_hold_is_repeated_until_standstill_is_read_back(cell):
    cell.robot.slows_s = 0.55
    cell.move()
    cell.stop(StopReason.STOP_PRESSED)
    asked_s = cell.now_s
    took_s = cell.until(lambda: cell.heard(m.StopConfirmed))

    sent = holds(cell)
    assert [round((t - asked_s) / REPEAT_S) for t in sent] == [0, 1, 2]
    assert "SVON 0" not in cell.asked()
    (confirmed,) = cell.heard(m.StopConfirmed)
    assert confirmed.reason is StopReason.STOP_PRESSED
    assert 0.55 < confirmed.took_s <= took_s + 0.01
    assert confirmed.pose.x_mm == pytest.approx(cell.robot.pose.x_mm, abs=0.001)
    cell.run(1.0)
    assert holds(cell) == sent


def test_servo_power_is_cut_when_the_hold_does_not_stop_the_robot(cell):
    cell.move()
    cell.robot.ignores.add("HOLD 1")
    cell.stop(StopReason.STOP_PRESSED)
    asked_s = cell.now_s
    cell.until(lambda: cell.heard(m.StopConfirmed))

    off = [t_s for t_s, text in cell.robot.requests if text == "SVON 0"]
    assert ESCALATE_S <= off[0] - asked_s < ESCALATE_S + 0.1
    assert len(holds(cell)) >= 3
    assert not cell.robot.is_running


def test_a_stop_that_is_never_confirmed_is_told_once_and_goes_on(cell):
    cell.move()
    cell.robot.ignores |= {"HOLD", "SVON"}
    cell.stop(StopReason.STOP_PRESSED)
    took_s = cell.until(lambda: cell.heard(m.StopUnconfirmed))
    assert UNCONFIRMED_S <= took_s < UNCONFIRMED_S + 0.02
    cell.run(1.5)

    (told,) = cell.heard(m.StopUnconfirmed)
    assert told.reason is StopReason.STOP_PRESSED
    assert told.text == "no standstill read back for 1.0 s"
    assert cell.asked().count("HOLD 1") >= 8
    assert cell.asked().count("SVON 0") >= 4
    assert cell.heard(m.StopConfirmed) == []
    assert cell.supervisor.is_stopping


@pytest.mark.parametrize("answer_s", [0.15, 0.3, 0.5])
def test_slow_answers_delay_the_read_back_but_do_not_starve_it(cell, answer_s):
    cell.move()
    cell.robot.answer_s = answer_s
    cell.stop(StopReason.STOP_PRESSED)
    cell.until(lambda: cell.heard(m.StopConfirmed), limit_s=15)

    assert not cell.robot.is_running


@pytest.mark.parametrize("answer_s", [0.15, 0.3, 0.5])
def test_slow_answers_do_not_starve_the_escalation(cell, answer_s):
    cell.move()
    cell.robot.answer_s = answer_s
    cell.robot.ignores.add("HOLD")
    cell.stop(StopReason.STOP_PRESSED)
    cell.until(lambda: "SVON 0" in cell.asked(), limit_s=10)


def test_a_robot_that_refuses_hold_is_told_of_and_seen_to_stand_by_itself(cell):
    cell.move()
    cell.robot.refuses["HOLD"] = 2100
    cell.robot.refuses["SVON"] = 2100
    cell.stop(StopReason.STOP_PRESSED)
    cell.until(lambda: cell.heard(m.StopUnconfirmed))
    assert cell.heard(m.StopUnconfirmed)[0].text == (
        "no standstill read back for 1.0 s (command remote not set (2100))"
    )
    cell.until(lambda: cell.heard(m.StopConfirmed), limit_s=10)

    assert not cell.robot.is_running
    assert [n.text for n in cell.heard(m.Notice)] == [
        "the robot refused HOLD 1: command remote not set (2100)",
        "the robot refused SVON 0: command remote not set (2100)",
    ]


def test_a_standing_robot_that_refuses_hold_must_be_seen_standing_for_a_while(cell):
    cell.robot.refuses["HOLD"] = 2100
    cell.stop(StopReason.STOP_PRESSED)
    took_s = cell.until(lambda: cell.heard(m.StopConfirmed))

    assert 0.3 <= took_s < 0.5
    assert not cell.robot.is_held


def test_a_move_that_begins_after_a_refused_hold_is_not_taken_for_a_standstill(cell):
    cell.arm()
    cell.robot.start_s = 0.2
    cell.robot.refuses["HOLD"] = 2100
    cell.posture = "start"
    cell.run(0.1)
    cell.propose()
    cell.until(lambda: cell.heard(m.CommandAccepted))
    cell.stop(StopReason.STOP_PRESSED)
    cell.until(lambda: cell.robot.is_running)
    cell.run(0.45)
    assert cell.heard(m.StopConfirmed) == []
    cell.until(lambda: "SVON 0" in cell.asked())


# STOP at every odd moment.


def test_stop_while_disarmed_holds_and_is_released_by_arming_only(cell):
    cell.stop(StopReason.STOP_PRESSED)
    cell.until(lambda: cell.heard(m.StopConfirmed))
    cell.run(1.0)
    assert cell.robot.is_held
    cell.arm()
    assert not cell.robot.is_held


def test_stop_without_a_robot_is_kept_until_there_is_one(new_cell):
    cell = new_cell(is_connected=False)
    cell.stop(StopReason.STOP_PRESSED)
    cell.run(1.2)
    assert len(cell.heard(m.StopUnconfirmed)) == 1
    cell.is_reachable = True
    cell.until(lambda: cell.heard(m.StopConfirmed))

    assert cell.asked()[0] == "HOLD 1"


@pytest.mark.parametrize("step", range(14))
def test_stop_at_every_step_of_arming_leaves_the_robot_held_and_disarmed(cell, step):
    cell.robot.answer_s = 0.01
    cell.stop(StopReason.STOP_PRESSED)
    cell.until(lambda: cell.heard(m.StopConfirmed))
    cell.run(0.3)
    cell.say(m.Arm())
    for _ in range(step):
        cell.step()
    armed = cell.supervisor.is_armed
    cell.stop(StopReason.STOP_PRESSED, "again")
    cell.run(1.0)

    assert cell.robot.is_held
    assert not cell.supervisor.is_armed
    assert cell.supervisor.latch is StopReason.STOP_PRESSED
    assert cell.heard(m.Armed) == [m.Armed()] * armed
    given_up = [r.refusal for r in cell.heard(m.ArmRefused)]
    assert [r.text for r in given_up] == ([] if armed else ["again"])


@pytest.mark.parametrize("is_data_sent", [False, True])
def test_stop_while_servo_on_is_outstanding_goes_out_next(new_cell, new_robot, is_data_sent):
    cell = new_cell(robot=new_robot(data_2=0))
    cell.robot.answer_s = 0.1
    cell.run(0.5)
    cell.say(m.ServoOn())
    first = b"1\r" if is_data_sent else b"HOSTCTRL_REQUEST SVON 2\r\n"
    cell.until(lambda: cell.wire[-1][1] == first)
    cell.stop(StopReason.STOP_PRESSED)
    cell.until(lambda: holds(cell))

    assert (("SVON 1") in cell.asked()) is is_data_sent
    assert bool(cell.drops) is not is_data_sent
