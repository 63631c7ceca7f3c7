"""The supervised input: its edges in normal operation, and their end when something is amiss."""

from dataclasses import replace
from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gestureapp.robot import messages as m
from gestureapp.robot.values import StopReason

LADDER_S = 0.5
"""What a site might set its timer to at 5 Hz."""
ON, OFF = "IOWRITE 22010,8,1", "IOWRITE 22010,8,0"


@pytest.fixture(scope="module")
def supervised(new_cell, new_robot, limits):
    def cell(robot=None, **change):
        wanted = replace(limits, **{"supervision_input": 22010, **change})
        made = new_cell(limits=wanted, robot=robot or new_robot())
        made.run(0.6)
        return made

    return cell


def edges_s(cell):
    """When the controller saw the input change."""
    writes = [(t_s, text) for t_s, text in cell.robot.requests if text in (ON, OFF)]
    return [t for (_, a), (t, b) in pairwise(writes) if a != b]


def longest_gap_s(cell):
    times_s = [*edges_s(cell), cell.now_s]
    return max(b - a for a, b in pairwise(times_s))


def test_nothing_is_written_unless_the_site_names_an_input(cell):
    cell.move()
    cell.run(1.0)

    assert not [text for text in cell.asked() if text.startswith("IOWRITE")]
    assert cell.heard(m.Hindrances) == []


@pytest.mark.parametrize("rate_hz", [2.0, 5.0, 10.0])
def test_the_input_changes_at_its_rate_between_the_two_values(supervised, rate_hz):
    cell = supervised(supervision_input=22040, supervision_hz=rate_hz)
    cell.forget()
    cell.run(4.0)

    writes = [text for text in cell.asked() if text.startswith("IOWRITE")]
    assert set(writes) == {"IOWRITE 22040,8,0", "IOWRITE 22040,8,1"}
    assert all(a != b for a, b in pairwise(writes))
    assert 3.7 * rate_hz <= len(writes) <= 4.0 * rate_hz + 1


@pytest.mark.parametrize("answer_s", [0.0, 0.005, 0.025])
@settings(max_examples=25, deadline=None)
@given(st.lists(st.tuples(st.integers(0, 60), st.integers(0, 60)), min_size=2, max_size=4))
def test_the_ladders_timer_does_not_run_out_whatever_the_moments(
    supervised, new_robot, answer_s, moments
):
    """Idle, arming, deciding, moving, stopping, releasing; a command takes up to 50 ms."""
    cell = supervised(new_robot(answer_s=answer_s, slows_s=0.2))
    cell.arm()
    for before, during in moments:
        cell.posture = "stop"
        cell.run(before * 0.005)
        cell.until(lambda: not cell.robot.is_held or not cell.supervisor.is_armed)
        cell.run(0.3)
        cell.forget_told()
        cell.move()
        cell.run(during * 0.005)
        cell.posture = "neither"
        cell.until(lambda: cell.heard(m.StopConfirmed))
    cell.stop(StopReason.STOP_PRESSED)
    cell.until(lambda: not cell.supervisor.is_stopping)
    cell.run(0.3)

    assert longest_gap_s(cell) < LADDER_S
    assert cell.drops == []


@pytest.mark.parametrize("moment_s", [0.005 * i for i in range(0, 60, 3)])
def test_the_ladders_timer_stands_a_stop_where_each_command_takes_100_ms(
    supervised, new_robot, moment_s
):
    cell = supervised(new_robot(answer_s=0.05))
    cell.arm()
    cell.run(moment_s)
    cell.stop(StopReason.STOP_PRESSED)
    cell.until(lambda: not cell.supervisor.is_stopping)
    cell.run(0.3)

    assert longest_gap_s(cell) < LADDER_S


def test_the_line_is_kept_free_while_a_gesture_is_decided(supervised):
    cell = supervised()
    cell.arm()
    cell.until(lambda: cell.asked()[-1] in (ON, OFF))
    cell.run(0.15)
    cell.forget()
    cell.posture = "start"
    cell.run(0.28)

    writes_s = [t_s for t_s, text in cell.robot.requests if text in (ON, OFF)]
    assert len(writes_s) == 1
    assert writes_s[0] - (cell.now_s - 0.28) <= 0.04


@pytest.mark.parametrize("what", ["control_s", "gui_s"])
def test_a_silent_application_lets_the_timer_run_out(supervised, what):
    cell = supervised()
    setattr(cell, what, 5.0)
    cell.run(0.1)
    cell.forget()
    cell.run(1.0)
    assert not {ON, OFF} & set(cell.asked())

    setattr(cell, what, 0.0)
    cell.run(0.5)
    assert {ON, OFF} <= set(cell.asked())


def test_a_silent_left_sensor_is_the_stop_paths_business(supervised):
    cell = supervised()
    cell.left_s = 5.0
    cell.forget()
    cell.run(1.0)

    assert {ON, OFF} <= set(cell.asked())


def test_a_stop_that_is_not_confirmed_lets_the_timer_run_out(supervised):
    cell = supervised()
    cell.move()
    cell.robot.ignores |= {"HOLD", "SVON"}
    cell.stop(StopReason.STOP_PRESSED)
    cell.until(lambda: cell.heard(m.StopUnconfirmed))
    cell.forget()
    cell.run(1.5)

    assert not {ON, OFF} & set(cell.asked())


def test_hold_goes_before_a_toggle_that_is_overdue(supervised, new_robot):
    cell = supervised(new_robot(answer_s=0.025))
    cell.move()
    cell.until(lambda: cell.now_s - edges_s(cell)[-1] > 0.1)
    begin_s = cell.now_s
    cell.stop(StopReason.STOP_PRESSED)
    cell.until(lambda: cell.heard(m.StopConfirmed))

    asked = cell.asked(begin_s)
    assert asked.index("HOLD 1") <= 1  # one answer may have been outstanding
    assert cell.drops == []


def test_a_stop_while_a_toggle_is_outstanding_keeps_the_session(supervised, new_robot):
    cell = supervised(new_robot(answer_s=0.02))
    cell.move()
    cell.until(lambda: cell.wire[-1][1].startswith(b"HOSTCTRL_REQUEST IOWRITE"))
    cell.stop(StopReason.STOP_PRESSED)
    cell.until(lambda: cell.heard(m.StopConfirmed))

    assert cell.drops == []


def test_missed_toggles_are_not_caught_up(supervised):
    cell = supervised()
    cell.gui_s = 5.0
    cell.run(3.0)
    cell.forget()
    cell.gui_s = 0.0
    cell.run(0.5)

    assert 2 <= sum(text in (ON, OFF) for text in cell.asked()) <= 3


def test_a_controller_that_refuses_is_told_once_and_nothing_can_be_armed(supervised, new_robot):
    robot = new_robot()
    robot.refuses["IOWRITE"] = 2110
    cell = supervised(robot)
    cell.run(1.5)
    cell.say(m.Arm())
    cell.run(0.1)

    assert len(cell.heard(m.Notice)) == 1
    (refused,) = cell.heard(m.ArmRefused)
    assert refused.refusal.reason == "supervision"
    assert "(2110)" in refused.refusal.text
    assert cell.heard(m.Hindrances)[-1].refusals == (refused.refusal,)
    robot.refuses.clear()
    cell.run(0.5)
    assert cell.heard(m.Hindrances)[-1].refusals == ()
    cell.arm()


def test_a_controller_that_ends_the_session_over_a_toggle_can_still_be_read_and_held(
    supervised, new_robot
):
    robot = new_robot()
    robot.raw["IOWRITE"] = b"NG: 501 Not Implemented\r\n"
    cell = supervised(robot)
    cell.run(4.0)

    assert len(cell.drops) == 1
    assert "NG: 501" in cell.heard(m.Hindrances)[-1].refusals[0].text
    cell.run(4.0)
    assert len(cell.drops) == 2
    cell.stop(StopReason.STOP_PRESSED)
    cell.until(lambda: cell.heard(m.StopConfirmed))


def test_a_refusal_while_armed_stops_and_disarms(supervised):
    cell = supervised()
    cell.move()
    cell.robot.refuses["IOWRITE"] = 2110
    cell.until(lambda: cell.heard(m.StopConfirmed))

    assert cell.heard(m.StopAsked)[0].reason is StopReason.ROBOT_CHANGED
    assert not cell.supervisor.is_armed


def test_a_robot_held_by_the_ladder_is_held_by_command_before_the_ladder_lets_go(
    supervised, new_robot
):
    """Or a controller that resumes would run the rest of a move that a dead application left."""
    cell = supervised(new_robot(data_2=0x44))
    asked = cell.asked()
    assert asked.index("HOLD 1") < asked.index(ON)
