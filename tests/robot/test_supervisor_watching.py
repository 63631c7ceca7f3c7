"""What the guardian stops by itself: silence, a robot that changes, a line that is lost."""

import pytest

from gestureapp.robot import messages as m
from gestureapp.robot.values import StopReason
from tests.robot.conftest import TICK_S

EXACT_S = 101.0
"""Ages taken from here on are exact in binary."""


def holds(cell, since_s=0.0):
    return [t_s for t_s, text in cell.robot.requests if text == "HOLD 1" and t_s >= since_s]


# Reasons of the guardian's own.


@pytest.mark.parametrize(
    ("what", "limit_s", "reason"),
    [
        ("left_s", 0.125, StopReason.LEFT_SILENT),
        ("control_s", 0.25, StopReason.APPLICATION_STALLED),
        ("gui_s", 0.5, StopReason.WINDOW_STALE),
    ],
)
def test_every_watchdog_trips_just_over_its_limit_and_not_on_it(cell, what, limit_s, reason):
    cell.arm()
    cell.run(EXACT_S - TICK_S - cell.now_s)
    cell.until(lambda: cell.supervisor._exchange.can_send)
    cell.beats = False
    cell.now_s = EXACT_S + 0.0625
    cell.beat(**{what: cell.now_s - limit_s})
    assert cell.heard(m.StopAsked) == []

    cell.beat(**{what: cell.now_s - limit_s - 1e-6})
    (stop,) = cell.heard(m.StopAsked)
    assert stop.reason is reason
    assert stop.text == f"{reason.value} for {limit_s * 1000:.0f} ms, limit {limit_s * 1000:.0f} ms"


@pytest.mark.parametrize("what", ["left_s", "control_s", "gui_s"])
@pytest.mark.parametrize("ahead_s", [0.06, 10.0, float("inf")])
def test_a_beat_from_the_future_is_as_bad_as_an_old_one(cell, what, ahead_s):
    cell.move()
    cell.beat(**{what: cell.now_s + ahead_s})

    assert cell.heard(m.StopAsked)[0].reason.value.endswith(("silent", "frozen", "still"))
    assert cell.supervisor.latch is not None


def test_a_beat_a_little_ahead_of_the_clock_is_taken(cell):
    cell.move()
    cell.beat(left_s=cell.now_s + 0.04)

    assert cell.heard(m.StopAsked) == []


@pytest.mark.parametrize("is_moving", [True, False])
def test_silence_of_the_application_stops_an_armed_cell(cell, is_moving):
    if is_moving:
        cell.move()
    else:
        cell.arm()
    cell.beats = False
    silent_s = cell.until(lambda: cell.heard(m.StopAsked))
    assert 0.12 < silent_s < 0.14

    cell.until(lambda: cell.heard(m.StopConfirmed))
    assert cell.supervisor.latch is StopReason.APPLICATION_STALLED
    assert cell.robot.is_held


def test_a_left_sensor_that_falls_silent_alone_is_told_as_such(cell):
    cell.move()
    cell.beats = False
    left_s = cell.now_s
    while not cell.heard(m.StopAsked):
        cell.beat(left_s=left_s)
        cell.step()

    assert cell.supervisor.latch is StopReason.LEFT_SILENT
    assert 0.12 < cell.now_s - left_s < 0.14


@pytest.mark.parametrize("asleep_s", [0.13, 0.5, 10.0])
def test_a_computer_that_stood_still_while_the_robot_moved_is_a_stop_that_says_so(cell, asleep_s):
    cell.move()
    cell.now_s += asleep_s
    cell.beat()  # fresh as it is, nobody watched the arm meanwhile
    assert cell.supervisor.latch is StopReason.COMPUTER_STALLED
    assert f"stood still for {asleep_s * 1000:.0f}" in cell.heard(m.StopAsked)[0].text

    cell.until(lambda: cell.heard(m.StopConfirmed))
    assert cell.robot.is_held
    cell.posture = "stop"
    cell.arm()
    assert cell.supervisor.is_armed


@pytest.mark.parametrize("asleep_s", [0.5, 10.0])
def test_a_computer_that_slept_over_an_answer_is_not_told_as_a_lost_link(cell, asleep_s):
    cell.move()
    cell.until(lambda: not cell.supervisor._exchange.can_send)
    cell.now_s += asleep_s
    cell.supervisor.tick(cell.now_s)  # the clock is looked at before any byte is read
    cell.collect()
    assert cell.heard(m.StopAsked)[0].reason is StopReason.COMPUTER_STALLED


def test_a_computer_that_stood_still_while_nothing_could_move_is_no_stop(cell):
    cell.run(1.0)
    cell.now_s += 10.0
    cell.beat()
    cell.run(0.5)

    assert cell.heard(m.StopAsked) == []


def test_silence_while_disarmed_stops_nothing(cell):
    cell.beats = False
    cell.run(2.0)

    assert cell.heard(m.StopAsked) == []


def test_silence_during_the_left_arms_own_stop_latches_it(cell):
    cell.robot.slows_s = 0.4
    cell.move()
    cell.posture = "stop"
    cell.step()
    cell.beats = False
    cell.until(lambda: cell.heard(m.StopConfirmed))

    assert [s.reason for s in cell.heard(m.StopAsked)] == [
        StopReason.LEFT_ARM,
        StopReason.APPLICATION_STALLED,
    ]
    assert cell.heard(m.StopConfirmed)[0].reason is StopReason.APPLICATION_STALLED
    assert not cell.supervisor.is_armed
    cell.beats = True
    cell.run(1.0)
    assert cell.robot.is_held


def test_a_latched_reason_is_never_replaced_by_another(cell):
    cell.move()
    for reason in (StopReason.STOP_PRESSED, StopReason.LEFT_ARM, StopReason.LINK_LOST):
        cell.stop(reason)
    cell.until(lambda: cell.heard(m.StopConfirmed))

    assert len(cell.heard(m.StopAsked)) == 1
    assert cell.heard(m.StopConfirmed)[0].reason is StopReason.STOP_PRESSED
    assert cell.supervisor.latch is StopReason.STOP_PRESSED


@pytest.mark.parametrize(
    ("data_1", "data_2", "reason"),
    [
        (0, 0x10, StopReason.ROBOT_ALARM),
        (0, 0x20, StopReason.ROBOT_ALARM),
        (0x20, 0, StopReason.ROBOT_CHANGED),  # teach
        (0x40, 0, StopReason.ROBOT_CHANGED),  # not play
        (0x80, 0, StopReason.ROBOT_CHANGED),  # not remote
        (0, 0x40, StopReason.ROBOT_CHANGED),  # servo off
        (0, 0x02, StopReason.ROBOT_CHANGED),  # pendant
        (0, 0x04, StopReason.ROBOT_CHANGED),  # external
        (0, 0x08, StopReason.ROBOT_CHANGED),  # by command, not ours
    ],
)
def test_a_robot_that_changes_while_moving_is_stopped_and_latched(cell, data_1, data_2, reason):
    cell.move()
    cell.robot.data_1 ^= data_1
    cell.robot.data_2 ^= data_2
    cell.until(lambda: cell.heard(m.StopAsked))

    assert cell.heard(m.StopAsked)[0].reason is reason
    assert cell.supervisor.latch is reason
    cell.until(lambda: holds(cell))


def test_a_robot_that_changes_while_armed_is_latched_and_while_disarmed_is_not(cell):
    cell.arm()
    cell.robot.data_2 |= 0x02
    cell.until(lambda: cell.heard(m.StopAsked))
    assert cell.supervisor.latch is StopReason.ROBOT_CHANGED
    cell.until(lambda: cell.heard(m.StopConfirmed))
    cell.forget()
    cell.robot.data_2 |= 0x10
    cell.run(1.0)

    assert cell.heard(m.StopAsked) == []


@pytest.mark.parametrize("is_armed", [True, False])
def test_a_robot_that_runs_without_a_command_is_held_when_armed(cell, is_armed):
    if is_armed:
        cell.arm()
    cell.robot.data_1 |= 0x08
    cell.run(1.0)

    assert bool(cell.heard(m.StopAsked)) is is_armed
    if is_armed:
        assert cell.supervisor.latch is StopReason.UNEXPECTED_MOTION


@pytest.mark.parametrize(("name", "within_s"), [("RPOSC", 0.1), ("RSTATS", 2.6)])
def test_a_robot_that_refuses_to_be_read_while_moving_is_stopped(cell, name, within_s):
    cell.move()
    cell.robot.refuses[name] = 2060
    took_s = cell.until(lambda: cell.heard(m.StopAsked))

    (stop,) = cell.heard(m.StopAsked)
    assert stop.reason is StopReason.ROBOT_CHANGED
    assert stop.text.startswith(f"the robot refused {name}")
    assert took_s < within_s


def test_a_controller_that_answers_error_to_everything_is_escalated_and_told(cell):
    cell.move()
    for name in ("RSTATS", "RPOSC", "HOLD", "SVON", "RALARM"):
        cell.robot.refuses[name] = 2060
    cell.until(lambda: cell.heard(m.StopUnconfirmed))

    assert {"HOLD 1", "SVON 0"} <= set(cell.asked())
    assert cell.supervisor.is_stopping


# The link.


@pytest.mark.parametrize("is_moving", [True, False])
def test_a_lost_link_latches_an_armed_cell_and_hold_is_first_on_the_new_one(cell, is_moving):
    if is_moving:
        cell.move()
    else:
        cell.arm()
    cell.is_reachable = False
    cell.cut("reset by peer")
    assert cell.supervisor.latch is StopReason.LINK_LOST
    assert not cell.supervisor.is_armed
    assert cell.heard(m.LinkReport)[-1] == m.LinkReport(False, "reset by peer")
    cell.run(0.4)
    cell.forget()
    cell.is_reachable = True
    cell.until(lambda: cell.heard(m.StopConfirmed))

    headers = cell.headers()
    assert headers[0].startswith(b"CONNECT")
    assert headers[1] == b"HOSTCTRL_REQUEST HOLD 2\r\n"
    assert cell.asked()[0] == "HOLD 1"
    assert "SVON 0" not in cell.asked()


def test_a_hold_that_could_only_be_sent_late_has_its_time_before_servo_off(cell):
    cell.robot.slows_s = 0.25
    cell.move()
    cell.is_reachable = False
    cell.cut()
    cell.run(2.0)
    cell.is_reachable = True
    cell.until(lambda: cell.heard(m.StopConfirmed))

    assert "SVON 0" not in cell.asked()
    assert len(cell.heard(m.StopUnconfirmed)) == 1


@pytest.mark.parametrize("how", ["mute", "deaf", "NG", "rubbish", "overlong"])
def test_a_line_that_cannot_be_trusted_is_dropped_and_hold_is_first_on_the_next(cell, how):
    cell.move()
    if how in ("mute", "deaf"):
        setattr(cell.robot, f"is_{how}", True)
    else:
        bad = {"NG": b"NG: no\r\n", "rubbish": b"\xff\x00,,\r", "overlong": b"x" * 600}[how]
        cell.robot.raw = dict.fromkeys(("RSTATS", "RPOSC"), bad)
    cell.until(lambda: cell.drops)
    cell.robot.is_mute = cell.robot.is_deaf = False
    cell.robot.raw = {}
    assert cell.supervisor.latch is StopReason.LINK_LOST
    cell.forget()
    cell.until(lambda: cell.heard(m.StopConfirmed))

    assert cell.asked()[0] == "HOLD 1"
    assert not cell.robot.is_running


def test_a_link_lost_with_the_answer_to_a_move_outstanding_counts_as_moving(cell):
    cell.arm()
    cell.posture = "start"
    cell.run(0.1)
    cell.robot.answer_s = 0.1
    cell.propose()
    cell.until(cell.payloads)
    cell.cut()

    assert cell.supervisor.has_commanded
    assert cell.supervisor.latch is StopReason.LINK_LOST
    cell.until(lambda: cell.heard(m.StopConfirmed))
    assert not cell.supervisor.has_commanded
    assert cell.heard(m.CommandAccepted) == []


def test_a_lost_link_while_disarmed_and_standing_stops_nothing(cell):
    cell.cut()
    cell.run(0.5)

    assert cell.heard(m.StopAsked) == []
    assert cell.supervisor.is_link_open


def test_readings_of_the_old_session_count_for_nothing(cell):
    cell.is_reachable = False
    cell.cut()
    cell.is_reachable = True
    cell.robot.answer_s = 0.05
    cell.until(lambda: cell.supervisor.is_link_open)
    cell.say(m.Arm())

    assert cell.heard(m.ArmRefused)[0].refusal.reason == "status_age"


def test_a_controller_that_never_takes_the_session_is_given_up_each_time(cell):
    cell.cut()
    cell.robot.is_mute = True
    cell.run(4.0)

    assert cell.drops == ["cable", *["no answer to CONNECT within 1.50 s"] * 2]


def test_an_own_withdrawal_with_no_way_back_latches(cell):
    cell.robot.answer_s = 0.02
    cell.arm()
    cell.posture = "start"
    cell.run(0.1)
    cell.propose()
    cell.until(cell.moves)
    cell.is_reachable = False
    cell.posture = "stop"
    cell.step()
    assert cell.supervisor.is_armed
    cell.supervisor.robot_ended("no route", cell.now_s)
    cell.collect()

    assert cell.supervisor.latch is StopReason.LINK_LOST
    assert not cell.supervisor.is_armed
