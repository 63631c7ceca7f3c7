"""Releasing a hold: for the left arm, for arming, and a robot that goes on by itself."""

from dataclasses import replace

import pytest

from gestureapp.robot import messages as m
from gestureapp.robot import nx100
from gestureapp.robot.values import StopReason


def stopped_by_the_left_arm(cell):
    cell.move()
    cell.posture = "neither"
    cell.until(lambda: cell.heard(m.StopConfirmed))


def test_a_robot_that_resumes_when_released_for_the_left_arm_is_held_again(cell):
    cell.robot.resumes = True
    stopped_by_the_left_arm(cell)
    cell.posture = "stop"
    cell.until(lambda: len(cell.heard(m.StopConfirmed)) == 2)

    assert cell.heard(m.StopAsked)[-1].reason is StopReason.UNEXPECTED_MOTION
    assert cell.supervisor.latch is StopReason.UNEXPECTED_MOTION
    assert cell.robot.is_held
    assert not cell.robot.is_running


@pytest.mark.parametrize("start_s", [0.0, 0.05, 0.3])
def test_a_robot_that_resumes_when_released_for_arming_is_held_again(cell, start_s):
    cell.robot.resumes = True
    cell.move()
    cell.stop(StopReason.STOP_PRESSED)
    cell.until(lambda: cell.heard(m.StopConfirmed))
    unit, speed, left = cell.robot.rest
    cell.posture = "stop"
    cell.run(0.1)
    cell.say(m.Arm())
    cell.until(lambda: not cell.robot.is_held)
    if start_s:
        cell.robot.move, cell.robot.since_s = (unit, speed, left), cell.now_s + start_s
    cell.until(lambda: len(cell.heard(m.StopConfirmed)) == 2)

    assert cell.heard(m.StopAsked)[-1].reason is StopReason.UNEXPECTED_MOTION
    assert not cell.supervisor.is_armed
    assert cell.robot.is_held


def test_a_robot_released_just_before_disarming_is_still_watched(cell):
    cell.robot.answer_s = 0.02
    cell.robot.resumes = True
    stopped_by_the_left_arm(cell)
    cell.posture = "stop"
    cell.until(lambda: cell.wire[-1][1] == b"0\r")
    cell.say(m.Disarm())
    cell.until(lambda: len(cell.heard(m.StopConfirmed)) == 2)

    assert cell.heard(m.StopAsked)[-1].reason is StopReason.UNEXPECTED_MOTION
    assert cell.robot.is_held


def test_disarming_ends_a_release_that_has_not_gone_out(cell):
    cell.robot.answer_s = 0.02
    stopped_by_the_left_arm(cell)
    cell.posture = "stop"
    cell.until(lambda: cell.supervisor._release.is_active)
    cell.say(m.Disarm())
    cell.run(1.0)

    assert "HOLD 0" not in cell.asked()
    assert cell.robot.is_held


def test_a_release_that_is_refused_is_tried_again_without_starving_the_reads(cell):
    stopped_by_the_left_arm(cell)
    cell.robot.refuses["HOLD 0"] = 2100
    cell.forget()
    cell.posture = "stop"
    cell.run(2.0)

    assert 3 <= cell.asked().count("HOLD 0") <= 5
    assert cell.asked().count("RSTATS") >= 6
    assert len(cell.heard(m.Notice)) == 1
    cell.robot.refuses.clear()
    cell.until(lambda: cell.heard(m.HoldReleased))


def test_a_hold_that_stays_on_is_not_told_as_released(cell):
    stopped_by_the_left_arm(cell)
    cell.robot.ignores.add("HOLD 0")
    cell.posture = "stop"
    cell.run(1.0)

    assert cell.asked().count("HOLD 0") == 2
    assert cell.heard(m.HoldReleased) == []


def test_arming_is_given_up_when_the_hold_cannot_be_released(cell):
    cell.stop(StopReason.STOP_PRESSED)
    cell.until(lambda: cell.heard(m.StopConfirmed))
    cell.run(0.3)
    cell.robot.refuses["HOLD 0"] = 2100
    cell.say(m.Arm())
    took_s = cell.until(lambda: cell.heard(m.ArmRefused))

    assert cell.heard(m.ArmRefused)[0].refusal.reason == "held"
    assert 1.9 < took_s < 2.1
    assert cell.supervisor.latch is StopReason.STOP_PRESSED


@pytest.mark.parametrize("how", ["cut", "disarm"])
def test_arming_that_cannot_go_on_is_refused_at_once(cell, how):
    cell.stop(StopReason.STOP_PRESSED)
    cell.until(lambda: cell.heard(m.StopConfirmed))
    cell.run(0.3)
    cell.robot.refuses["HOLD 0"] = 2100
    cell.say(m.Arm())
    cell.run(0.2)
    if how == "cut":
        cell.cut("cable")
    else:
        cell.say(m.Disarm())

    assert cell.heard(m.ArmRefused)[0].refusal.reason == "given_up"
    cell.run(0.5)
    assert len(cell.heard(m.ArmRefused)) == 1
    assert not cell.supervisor.is_armed


def test_a_link_lost_while_a_hold_is_released_for_arming_is_a_stop(cell):
    cell.stop(StopReason.STOP_PRESSED)
    cell.until(lambda: cell.heard(m.StopConfirmed))
    cell.run(0.3)
    cell.robot.answer_s = 0.02
    cell.say(m.Arm())
    cell.until(lambda: b"0\r" in [item[1] for item in cell.wire])
    cell.forget()
    cell.cut()
    cell.until(lambda: cell.heard(m.StopConfirmed))

    assert cell.asked()[0] == "HOLD 1"
    assert cell.robot.is_held
    assert cell.supervisor.latch is StopReason.STOP_PRESSED


def test_a_limit_of_the_site_holds_for_the_left_arms_end_too(new_cell, limits):
    cell = new_cell(limits=replace(limits, is_hold_to_run=True))
    cell.move()
    cell.beat(is_left_start=False, is_left_stop=False)

    assert cell.heard(m.StopAsked)[0].reason is StopReason.LEFT_ARM
    assert cell.supervisor.is_armed


def test_a_stop_during_a_release_makes_it_begin_again(cell):
    cell.robot.answer_s = 0.02
    stopped_by_the_left_arm(cell)
    cell.posture = "stop"
    cell.until(lambda: cell.supervisor._release.next_request(1) == nx100.HOLD_OFF)
    cell.stop(StopReason.LEFT_ARM)
    cell.until(lambda: len(cell.heard(m.StopConfirmed)) == 2)
    begin_s = cell.now_s
    cell.until(lambda: cell.heard(m.HoldReleased))

    asked = cell.asked(begin_s)
    assert asked[: asked.index("HOLD 0")][-1:] == ["RPOSC 1,0"]
