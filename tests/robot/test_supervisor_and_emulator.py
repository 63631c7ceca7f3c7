"""The supervisor against the emulated controller in manual time: its ladder, and moves it keeps."""

from dataclasses import replace

import pytest

from gestureapp.robot import messages as m
from gestureapp.robot.values import Direction, StopReason
from gestureapp.simulation.nx100_values import EndReason, Hold, MotionEnded, MotionStarted

LADDER_S = 0.5
BRAKING_S = 0.1
"""From 100 mm/s at 1000 mm/s^2."""


@pytest.fixture
def supervised(new_cell, new_emulated, limits):
    def cell(**options):
        robot = new_emulated(ladder_s=LADDER_S, **options)
        made = new_cell(limits=replace(limits, supervision_input=22010), robot=robot)
        made.run(0.6)
        return made

    return cell


def ends(cell):
    return [event for event in cell.robot.events if isinstance(event, MotionEnded)]


def starts(cell):
    return [event for event in cell.robot.events if isinstance(event, MotionStarted)]


def last_edge_s(cell):
    return max(t_s for t_s, text in cell.robot.requests if text.startswith("IOWRITE"))


def nobody_is_there(cell, seconds):
    """Neither application nor guardian runs: only the controller's time goes on."""
    cell.robot.advance(cell.now_s + seconds)
    cell.now_s += seconds


def someone_comes_back(cell, limits, new_cell):
    """A new guardian of a new application meets the same controller."""
    after = new_cell(limits=limits, robot=cell.robot, is_connected=False)
    after.now_s = cell.now_s
    after.is_reachable = True
    after.forget()
    after.run(1.0)
    return after


def recover_and_arm(cell):
    """What the window's blockers lead a person to."""
    cell.told[:] = [item for item in cell.told if isinstance(item[1], m.Hindrances)]
    kept = cell.heard(m.Hindrances)
    if kept and kept[-1].refusals:
        cell.say(m.ServoOff())
        cell.until(lambda: not cell.heard(m.Hindrances)[-1].refusals)
        cell.say(m.ServoOn())
        cell.run(0.5)
    cell.arm()
    cell.run(0.3)


def test_the_ladder_never_acts_while_all_is_well(supervised):
    cell = supervised()
    for _ in range(5):
        cell.forget_told()
        cell.move()
        cell.posture = "stop"
        cell.until(lambda: cell.heard(m.HoldReleased))
        cell.run(0.3)

    assert Hold.EXTERNAL not in cell.robot.controller.holds
    assert [event.reason for event in ends(cell)] == [EndReason.HOLD] * 5
    assert cell.heard(m.StopAsked)[-1].reason is StopReason.LEFT_ARM


def test_with_guardian_and_application_gone_the_ladder_stops_the_robot_in_its_time(supervised):
    cell = supervised()
    cell.move()
    asked = len(cell.robot.requests)
    nobody_is_there(cell, 3.0)

    assert len(cell.robot.requests) == asked
    (end,) = ends(cell)
    assert end.reason is EndReason.HOLD
    assert end.t_s <= last_edge_s(cell) + LADDER_S + BRAKING_S + 1e-6
    assert cell.robot.controller.holds == Hold.EXTERNAL


@pytest.mark.parametrize("resumes_after_hold", [False, True])
def test_the_way_back_from_the_ladders_hold_moves_nothing(
    supervised, new_cell, limits, resumes_after_hold
):
    cell = supervised(resumes_after_hold=resumes_after_hold)
    cell.move()
    nobody_is_there(cell, 3.0)
    limits = replace(limits, supervision_input=22010)
    after = someone_comes_back(cell, limits, new_cell)

    assert after.robot.controller.holds == Hold.COMMAND
    assert len(starts(after)) == 1
    if resumes_after_hold:
        after.say(m.Arm())
        after.until(lambda: after.heard(m.StopAsked))
        after.until(lambda: not after.supervisor.is_stopping)
        assert len(starts(after)) == 2
    recover_and_arm(after)
    after.move()
    after.until(lambda: after.heard(m.MotionEnded))


def test_the_ladders_hold_while_armed_is_a_latched_stop(supervised):
    cell = supervised()
    cell.arm()
    cell.robot.controller.set_hold(Hold.EXTERNAL, True, cell.now_s)
    cell.until(lambda: cell.heard(m.StopConfirmed))

    assert cell.supervisor.latch is StopReason.ROBOT_CHANGED


@pytest.mark.parametrize("resumes", [False, True])
@pytest.mark.parametrize("reason", [StopReason.LEFT_ARM, StopReason.STOP_PRESSED])
def test_twenty_times_stop_recover_move(new_cell, new_emulated, resumes, reason):
    cell = new_cell(robot=new_emulated(resumes_after_hold=resumes))
    for i in range(20):
        cell.forget_told()
        cell.move(direction=Direction(0, -1 if i % 2 else 1, is_rotation=False))
        cell.stop(reason)
        cell.posture = "stop"
        cell.until(lambda: not cell.supervisor.is_stopping)
        cell.run(0.5)
        if resumes and i == 0 and reason is StopReason.STOP_PRESSED:
            cell.say(m.Arm())  # nobody knows yet; the robot goes on for a moment
            cell.run(1.0)
        cell.until(lambda: not cell.supervisor.is_stopping)
        recover_and_arm(cell)

    reasons = [x.message.reason for x in cell.story if is_stop(x)]
    assert reasons.count(reason) == 20
    assert reasons.count(StopReason.UNEXPECTED_MOTION) == int(resumes)
    assert len(starts(cell)) == 20 + int(resumes)
    n_off = sum(text == "SVON 0" for _, text in cell.robot.requests)
    assert n_off == (20 if resumes else 0)


def is_stop(item):
    return isinstance(getattr(item, "message", None), m.StopAsked)


@pytest.mark.parametrize("discard", ["servo", "teach", "alarm"])
def test_the_emulated_controller_forgets_the_rest_of_a_move(new_emulated, new_cell, discard):
    cell = new_cell(robot=new_emulated(resumes_after_hold=True))
    cell.move()
    cell.stop(StopReason.STOP_PRESSED)
    cell.until(lambda: not cell.supervisor.is_stopping)
    controller = cell.robot.controller
    if discard == "servo":
        controller.set_servo(False, cell.now_s)
        controller.set_servo(True, cell.now_s)
    elif discard == "teach":
        controller.set_mode(type(controller.mode).TEACH, cell.now_s)
        controller.set_mode(type(controller.mode).PLAY, cell.now_s)
    else:
        controller.raise_alarm(4100, 0, cell.now_s)
        controller.reset(cell.now_s)
        controller.set_servo(True, cell.now_s)
    controller.set_hold(Hold.COMMAND, False, cell.now_s)
    nobody_is_there(cell, 2.0)

    assert len(starts(cell)) == 1
