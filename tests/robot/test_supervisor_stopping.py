"""The stop path: every reason, first on the wire, repeated, read back, escalated, released."""

from dataclasses import replace

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
    assert cell.supervisor.latch is StopReason.LEFT_SILENT


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


# Reasons of the guardian's own.


@pytest.mark.parametrize(
    ("what", "limit_s", "reason"),
    [
        ("left_s", 0.125, StopReason.LEFT_SILENT),
        ("control_s", 0.25, StopReason.CONTROL_STALE),
        ("gui_s", 0.5, StopReason.WINDOW_STALE),
    ],
)
def test_every_watchdog_trips_just_over_its_limit_and_not_on_it(cell, what, limit_s, reason):
    cell.arm()
    cell.beats = False
    cell.until(lambda: cell.supervisor._exchange.can_send)
    cell.now_s = 128.0
    cell.beat(**{what: 128.0 - limit_s})
    assert cell.heard(m.StopAsked) == []

    cell.beat(**{what: 128.0 - limit_s - 1e-6})
    (stop,) = cell.heard(m.StopAsked)
    assert stop.reason is reason
    assert stop.text == f"{reason.value} for {limit_s * 1000:.0f} ms, limit {limit_s * 1000:.0f} ms"


@pytest.mark.parametrize("what", ["left_s", "control_s", "gui_s"])
@pytest.mark.parametrize("ahead_s", [0.06, 10.0, float("inf")])
def test_a_beat_from_the_future_is_as_bad_as_an_old_one(cell, what, ahead_s):
    cell.move()
    cell.beat(**{what: cell.now_s + ahead_s})

    assert cell.heard(m.StopAsked)[0].reason.value.endswith(("silent", "frozen"))
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
    assert cell.supervisor.latch is StopReason.LEFT_SILENT
    assert cell.robot.is_held


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
        StopReason.LEFT_SILENT,
    ]
    assert cell.heard(m.StopConfirmed)[0].reason is StopReason.LEFT_SILENT
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


# Releasing a hold.


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
