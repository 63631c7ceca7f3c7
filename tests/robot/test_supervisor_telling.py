"""Servo power, alarms, refusals and how often the supervisor wants to look."""

from dataclasses import replace

from gestureapp.robot import messages as m
from gestureapp.robot import nx100
from gestureapp.robot.values import StopReason

# Servo power.


def test_servo_power_comes_on_when_disarmed_and_standing(new_cell, new_robot):
    cell = new_cell(robot=new_robot(data_2=0))
    cell.say(m.ServoOn())
    cell.run(0.3)

    assert cell.asked().count("SVON 1") == 1
    assert cell.heard(m.StatusReport)[-1].data_2 == 0x40


def test_servo_power_is_refused_while_armed_or_stopping(cell):
    cell.robot.slows_s = 0.2
    cell.move()
    cell.say(m.ServoOn())
    cell.stop(StopReason.STOP_PRESSED)
    cell.say(m.ServoOn())
    cell.until(lambda: cell.heard(m.StopConfirmed))
    cell.run(1.0)

    assert "SVON 1" not in cell.asked()
    texts = {notice.text for notice in cell.heard(m.Notice)}
    assert texts == {
        "servo power was not switched on: servo power is switched only while disarmed and standing"
    }


def test_servo_power_asked_for_without_a_link_does_not_come_on_later(new_cell):
    cell = new_cell(is_connected=False)
    cell.say(m.ServoOn())
    cell.is_reachable = True
    cell.run(1.0)

    assert "SVON 1" not in cell.asked()
    assert cell.heard(m.Notice)[0].text.endswith("the robot does not answer")


def test_servo_power_that_waited_when_the_link_broke_does_not_come_on_later(cell):
    cell.robot.answer_s = 0.05
    cell.until(lambda: not cell.supervisor._exchange.can_send)
    cell.say(m.ServoOn())
    cell.cut()
    cell.run(1.0)

    assert "SVON 1" not in cell.asked()


def test_a_refused_servo_on_is_told_in_words(cell):
    cell.robot.refuses["SVON"] = 3450
    cell.say(m.ServoOn())
    cell.run(0.1)

    assert cell.heard(m.Notice) == [
        m.Notice("the robot refused SVON 1: servo power cannot be turned on (3450)")
    ]


# What the controller says of itself.


def test_alarms_are_asked_for_once_and_told(cell):
    cell.robot.data_2 |= 0x10
    cell.run(1.0)
    assert cell.asked().count("RALARM") == 1
    assert cell.heard(m.StatusReport)[-1].alarms == (4416,)

    cell.robot.data_2 &= ~0x10
    cell.run(0.5)
    assert cell.heard(m.StatusReport)[-1].alarms == ()


def test_a_read_that_is_refused_again_and_again_is_told_once(cell):
    cell.robot.refuses["RPOSC"] = 3350
    cell.run(2.0)
    assert len(cell.heard(m.Notice)) == 1
    cell.robot.refuses.clear()
    cell.run(0.5)
    cell.robot.refuses["RPOSC"] = 3350
    cell.run(1.0)

    assert [notice.text for notice in cell.heard(m.Notice)] == [
        "the robot refused RPOSC 1,0: user frame not taught (3350)"
    ] * 2


def test_other_messages_of_the_protocol_do_nothing(cell):
    before = len(cell.told)
    cell.say(m.Bye())
    cell.say(m.Hello("x", m.Role.CONTROL))

    assert len(cell.told) == before
    assert not cell.supervisor.may_move


def test_the_next_look_is_soon_when_something_may_move_and_never_after_a_deadline(cell):
    idle_s = cell.supervisor.next_due_s(cell.now_s) - cell.now_s
    cell.arm()
    armed_s = cell.supervisor.next_due_s(cell.now_s) - cell.now_s
    cell.robot.is_mute = True
    cell.run(0.3)
    deadline_s = cell.supervisor._exchange.deadline_s

    assert 0 < armed_s < idle_s <= 0.02
    assert cell.supervisor.next_due_s(deadline_s - 0.001) == deadline_s


def test_start_stop_mode_goes_on_while_the_left_arm_is_nowhere(new_cell, limits):
    cell = new_cell(limits=replace(limits, is_hold_to_run=False))
    cell.move()
    cell.posture = "neither"
    cell.run(0.5)
    assert cell.heard(m.StopAsked) == []

    cell.posture = "stop"
    cell.step()
    assert cell.heard(m.StopAsked)[0].reason is StopReason.LEFT_ARM
    assert nx100.HOLD_ON.header in cell.headers()[-2:]
