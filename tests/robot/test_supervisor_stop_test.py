"""The guardian's mind and a stop test: one short move, the left arm at rest, nobody armed after."""

import pytest

from gestureapp.robot import messages as m
from gestureapp.robot.values import Caps, Direction, StopReason

CAPS = Caps(20.0, 10.0)


def begin_move(cell) -> None:
    cell.arm()
    cell.run(0.3)
    cell.say(m.Propose(1, Direction(0, 1, is_rotation=False), cell.now_s, CAPS))
    cell.until(lambda: cell.heard(m.CommandAccepted))
    cell.run(0.1)


def test_it_goes_its_way_with_the_left_arm_in_stop_and_leaves_nobody_armed(cell):
    begin_move(cell)
    cell.until(lambda: cell.heard(m.MotionEnded))
    cell.run(0.3)
    (sent,) = cell.heard(m.CommandSent)
    assert (sent.increment.dx_mm, sent.speed) == (20.0, 10.0)
    assert cell.heard(m.Disarmed) == [m.Disarmed()]
    assert cell.heard(m.StopAsked) == []
    assert not cell.supervisor.is_armed
    assert len(cell.moves()) == 1


@pytest.mark.parametrize("posture", ["start", "neither"])
def test_a_left_arm_that_leaves_the_stop_posture_stops_it_latched(cell, posture):
    begin_move(cell)
    cell.posture = posture
    cell.until(lambda: cell.heard(m.StopConfirmed))
    (asked,) = cell.heard(m.StopAsked)
    assert (asked.reason, asked.text) == (
        StopReason.STOP_TEST,
        "the left arm left the stop posture",
    )
    assert not cell.supervisor.is_armed
    assert cell.supervisor.latch is StopReason.STOP_TEST


def test_stop_goes_the_usual_way(cell):
    begin_move(cell)
    cell.stop(StopReason.STOP_PRESSED)
    cell.until(lambda: cell.heard(m.StopConfirmed))
    assert cell.supervisor.latch is StopReason.STOP_PRESSED
    assert not cell.supervisor.is_armed


@pytest.mark.parametrize(
    ("age", "reason"),
    [
        ("left_s", StopReason.LEFT_SILENT),
        ("control_s", StopReason.APPLICATION_STALLED),
        ("gui_s", StopReason.WINDOW_STALE),
    ],
)
def test_every_watchdog_holds_for_it(cell, age, reason):
    begin_move(cell)
    setattr(cell, age, 1.0)
    cell.until(lambda: cell.heard(m.StopAsked))
    assert cell.heard(m.StopAsked)[0].reason is reason
    assert not cell.supervisor.is_armed


def test_a_second_one_needs_arming_again(cell):
    begin_move(cell)
    cell.until(lambda: cell.heard(m.MotionEnded))
    cell.say(m.Propose(2, Direction(0, 1, is_rotation=False), cell.now_s, CAPS))
    assert cell.heard(m.CommandRefused)[-1].refusal.reason == "not_armed"
    assert len(cell.moves()) == 1
