"""The control thread's work on a clock in hand: a whole gesture, bad streams, a lost guardian."""

from dataclasses import replace

import pytest

from gestureapp.cell import events as e
from gestureapp.cell.arms import POSTURE_FORGOTTEN_S
from gestureapp.cell.control import TICK_S
from gestureapp.cell.guardian_keeper import SILENT_TICKS
from gestureapp.cell.inputs import GuardianSaid, SensorTold, ServoAsked
from gestureapp.cell.machine import DECISION_LIMIT_S
from gestureapp.cell.records import Topic
from gestureapp.cell.snapshot import CellState
from gestureapp.config import DriveMode
from gestureapp.robot import messages as m
from gestureapp.robot.values import Direction, StopReason
from gestureapp.sensing.values import (
    ArmPosture,
    Connected,
    Disconnected,
    Garbage,
    Impossible,
    LinkState,
    Side,
)

S = CellState


def states(desk) -> list[str]:
    return [str(record.fields["state"]) for record in desk.of(Topic.STATE)]


def lines(desk) -> list[str]:
    desk.control.tick(desk.now_s)
    return [line.text for line in desk.control.picture.events]


def test_a_gesture_goes_from_arming_to_the_move_and_back(desk):
    desk.moving()
    desk.run(0.5)
    desk.left.take(ArmPosture.STOP, desk.now_s)
    assert desk.run(1.5, S.ARMED)
    words = ["READY", "ARMED", "ACTIVATED", "MOVING", "STOPPING", "ARMED"]
    assert [
        w for w, last in zip(states(desk), [None, *states(desk)], strict=False) if w != last
    ] == (words)
    (proposal,) = desk.guardian.of(m.Propose)
    assert proposal.direction == Direction(axis=0, sign=+1, is_rotation=False)
    (stop,) = desk.guardian.of(m.Stop)
    assert stop.reason is StopReason.LEFT_ARM


def test_the_decision_leaves_within_the_papers_response_time(desk):
    desk.moving()
    (activated,) = [r for r in desk.of(Topic.STATE) if r.fields["state"] == "ACTIVATED"][:1]
    (proposal,) = desk.guardian.of(m.Propose)
    assert 0.0 <= proposal.t_s - activated.t_s <= 0.160


def test_the_picture_shows_what_was_recognised_and_commanded(desk):
    desk.moving().run(0.02)
    picture = desk.control.picture
    assert picture.recognition is not None
    assert picture.recognition.label == "X+"
    assert picture.direction == Direction(0, +1, False)
    assert picture.robot.increment is not None
    assert (picture.robot.limited_by, picture.robot.speed) == ("the field", "100.0 mm/s")
    assert picture.sentence == "Recognised X+. Move the left arm out of the start posture to stop."


def test_the_end_of_the_increment_leaves_the_cell_armed_but_the_arm_must_come_back_first(desk):
    desk.moving()
    desk.guardian.end_move()
    assert desk.run(0.1, S.ARMED)
    desk.left.take(ArmPosture.NEITHER, desk.now_s)
    desk.run(1.0)
    desk.left.take(ArmPosture.START, desk.now_s)
    desk.run(1.0)
    assert desk.state is S.ARMED
    assert len(desk.guardian.of(m.Propose)) == 1
    desk.left.take(ArmPosture.STOP, desk.now_s)
    desk.run(1.0)
    desk.gesture("X+")
    assert desk.run(2.0, S.MOVING)


def test_an_arm_that_rises_without_a_gesture_moves_nothing(desk):
    desk.armed()
    desk.left.take(ArmPosture.START, desk.now_s)
    assert desk.run(1.0, S.ACTIVATED)
    assert desk.run(DECISION_LIMIT_S, S.ARMED)
    assert desk.guardian.of(m.Propose) == []
    assert "no movement of the right arm" in lines(desk)


def test_what_the_gate_refuses_is_told_and_nothing_moves(desk):
    desk.armed()
    desk.guardian.refuses = "the tool stands on the edge of its field"
    desk.gesture()
    desk.run(2.0)
    assert desk.state is S.ARMED
    assert "not moved: the tool stands on the edge of its field" in lines(desk)


def test_in_start_stop_mode_the_arm_may_leave_start_and_stop_ends_the_move(make_desk):
    desk = make_desk(drive_mode=DriveMode.START_STOP).moving()
    desk.left.take(ArmPosture.NEITHER, desk.now_s)
    desk.run(1.0)
    assert desk.state is S.MOVING
    desk.left.take(ArmPosture.STOP, desk.now_s)
    assert desk.run(1.0, S.ARMED) or desk.state is S.STOPPING


# Streams.


def frozen():
    kept = []

    def freeze(sample):
        kept.append(sample.accel_g)
        return replace(sample, accel_g=kept[0])

    return freeze


@pytest.mark.parametrize("side", list(Side))
def test_a_silent_sensor_stops_the_move_within_the_trip_level(desk, side):
    desk.moving()
    before_s = desk.now_s
    desk.changes[side] = lambda _: None
    assert desk.run(1.0, S.STOPPING)
    assert desk.now_s - before_s <= desk.settings.site.trip_level_s + 2 * TICK_S
    assert f"{side.value} sensor: no data" in desk.control.state.note
    assert desk.run(1.0, S.STOPPED)


def test_a_process_kept_from_running_while_the_robot_moves_is_told_as_such(desk):
    desk.moving()
    desk.now_s += 0.3
    assert desk.run(0.05, S.STOPPING)
    assert "application stood still for 31" in desk.control.state.note
    assert "sensor" not in desk.control.state.note


def test_a_guardian_that_saw_only_the_sensor_silent_is_told_that_we_stood_still(desk):
    desk.moving()
    desk.now_s += 0.3
    reason = StopReason.LEFT_SILENT
    asked = m.StopAsked(reason, "left sensor silent for 101 ms", desk.now_s)
    desk.control.handle(GuardianSaid(asked), desk.now_s)
    assert "application stood still for 30" in desk.control.state.note
    assert "sensor" not in desk.control.state.note


def test_a_process_kept_from_running_while_nothing_can_move_stops_nothing(desk):
    desk.ready()
    desk.now_s += 0.3
    desk.run(0.5)
    assert desk.state is not S.STOPPING
    assert desk.run(2.0, S.READY)


@pytest.mark.parametrize("side", list(Side))
def test_a_frozen_sensor_stops_the_move_and_is_called_frozen(desk, side):
    desk.moving()
    desk.changes[side] = frozen()
    assert desk.run(1.0, S.STOPPED)
    assert f"{side.value} sensor: frozen on one value" in desk.control.state.note


@pytest.mark.parametrize("side", list(Side))
def test_a_sensor_at_20_hz_stops_the_move_and_its_rate_is_told(desk, side):
    desk.moving()
    desk.rates_hz[side] = 20.0
    assert desk.run(2.0, S.STOPPED)
    note = desk.control.state.note
    assert note.startswith(f"{side.value} sensor: ")
    assert "Hz measured, 70 to 230 Hz wanted" in note


@pytest.mark.parametrize("side", list(Side))
@pytest.mark.parametrize(
    ("garbage", "words"),
    [
        (Garbage(12, b"\xff\x00", "a line of numbers was expected"), "unreadable data"),
        (Impossible(0, b"40,40,40", "40.0 g is beyond 16 g"), "impossible values"),
    ],
)
def test_garbage_and_impossible_values_stop_the_move_by_their_name(desk, side, garbage, words):
    desk.moving()

    def spoil(sample):
        desk.control.handle(SensorTold(sample.t_s, side, garbage), sample.t_s)

    desk.changes[side] = spoil
    assert desk.run(1.0, S.STOPPED)
    assert f"{side.value} sensor: {words}" in desk.control.state.note


@pytest.mark.parametrize("side", list(Side))
def test_an_unplugged_sensor_stops_the_move_at_once_with_the_ports_words(desk, side):
    desk.moving()
    reason = "/dev/rfcomm0 is gone: plug the receiver in"
    desk.changes[side] = lambda _: None
    desk.control.handle(SensorTold(desk.now_s, side, Disconnected(reason)), desk.now_s)
    assert desk.run(0.1, S.STOPPING)
    assert reason in desk.control.state.note


def test_a_site_may_go_on_without_the_right_sensor(make_desk):
    desk = make_desk(stop_on_right_lost=False).moving()
    desk.changes[Side.RIGHT] = lambda _: None
    desk.run(1.0)
    assert desk.state is S.MOVING


@pytest.mark.parametrize("side", list(Side))
def test_a_sensor_lost_while_collecting_stops_before_anything_is_proposed(desk, side):
    desk.armed()
    desk.gesture()
    assert desk.run(2.0, S.ACTIVATED)
    desk.changes[Side.RIGHT] = lambda _: None
    desk.changes[side] = lambda _: None
    assert desk.run(1.0, S.STOPPED)
    assert desk.guardian.of(m.Propose) == []


def test_samples_that_come_late_in_one_burst_are_used_as_they_came(desk):
    """A radio's burst is one arrival: the three samples of a decision may share their time."""
    desk.armed()
    desk.gesture()
    held = []

    def hold(sample):
        held.append(sample)

    assert desk.run(2.0, S.ACTIVATED)
    desk.changes[Side.RIGHT] = hold
    desk.run(0.04)
    del desk.changes[Side.RIGHT]
    desk.run(0.2)
    (decided, *_) = desk.of(Topic.RECOGNITION)
    assert decided.fields["window_end_s"] > held[-1].t_s


def test_a_sensor_that_comes_back_needs_its_rate_measured_before_arming(desk):
    desk.armed()
    desk.changes[Side.LEFT] = lambda _: None
    desk.control.handle(SensorTold(desk.now_s, Side.LEFT, Disconnected("gone")), desk.now_s)
    assert desk.run(1.0, S.STOPPED)
    del desk.changes[Side.LEFT]
    desk.control.handle(SensorTold(desk.now_s, Side.LEFT, Connected("test")), desk.now_s)
    desk.run(0.5)
    blockers = {blocker.id: blocker.text for blocker in desk.control.picture.blockers}
    assert blockers["left_sensor"] == "left sensor: rate not known yet"
    desk.run(2.5)
    assert desk.control.picture.blockers == ()
    assert desk.control.picture.can_arm


def test_a_left_arm_not_heard_for_long_is_in_no_posture(desk):
    desk.ready()
    desk.changes[Side.LEFT] = lambda _: None
    desk.run(POSTURE_FORGOTTEN_S + 0.1)
    assert desk.control.picture.posture is ArmPosture.NEITHER
    assert desk.control.picture.left.link is LinkState.NO_DATA


def test_the_heartbeat_carries_the_time_of_the_newest_left_sample_that_counts(desk):
    desk.armed()
    silent_s = desk.now_s
    desk.changes[Side.LEFT] = frozen()
    desk.run(0.05)
    beat = desk.guardian.beats[-1]
    assert silent_s - 0.011 <= beat.left_s <= silent_s + 0.011
    assert beat.control_s == beat.gui_s == pytest.approx(desk.now_s, abs=TICK_S)
    assert (beat.is_left_stop, beat.is_left_start) == (True, False)


def test_the_guardians_own_stop_of_a_silent_left_sensor_is_told_with_its_cause(desk):
    desk.moving()
    desk.changes[Side.LEFT] = frozen()
    desk.run(0.095)
    assert desk.run(0.03, S.STOPPING)
    desk.guardian.stop(StopReason.LEFT_SILENT, "left sensor silent for 101 ms, limit 100 ms")
    desk.guardian.say(
        m.StopAsked(StopReason.LEFT_SILENT, "left sensor silent for 101 ms", desk.now_s)
    )
    desk.run(0.05)
    assert "frozen on one value" in desk.control.state.note


# The guardian.


def test_a_lost_guardian_is_replaced_and_the_first_word_to_the_new_one_is_stop(desk):
    desk.moving()
    desk.press(e.GuardianGone(desk.now_s, "the guardian process has ended"))
    assert desk.state is S.STOPPING
    assert not desk.control.picture.robot.is_connected or desk.run(0.02) is False
    desk.run(0.02)
    assert len(desk.guardians) == 2
    assert desk.guardian.heard[0] == m.Stop(
        StopReason.CELL_FAULT, "the guardian process has ended", desk.guardian.heard[0].asked_s
    )
    assert desk.run(1.0, S.STOPPED)
    desk.left.take(ArmPosture.STOP, desk.now_s)
    desk.run(1.5)
    desk.press(e.ArmPressed(desk.now_s))
    assert desk.run(0.5, S.ARMED)


def test_a_guardian_that_hangs_while_the_robot_moves_is_replaced(desk):
    desk.moving()
    desk.guardian.is_mute = True
    assert desk.run(SILENT_TICKS * TICK_S + 0.1, S.STOPPING)
    desk.run(0.05)
    assert len(desk.guardians) == 2
    assert isinstance(desk.guardian.heard[0], m.Stop)
    assert any("silent" in line for line in lines(desk))


def test_a_guardian_that_hangs_at_a_stop_is_replaced(desk):
    desk.moving()
    desk.guardian.is_mute = True
    desk.press(e.StopPressed(desk.now_s))
    desk.run(SILENT_TICKS * TICK_S + 0.2)
    assert len(desk.guardians) == 2
    assert desk.guardian.of(m.Stop) == desk.guardian.heard[:1]
    assert desk.run(1.0, S.STOPPED)


def test_a_stop_that_stays_unconfirmed_is_no_reason_to_replace_the_guardian(desk):
    desk.moving()
    desk.guardian.confirms = False
    desk.press(e.StopPressed(desk.now_s))
    desk.run(1.0)
    desk.guardian.say(m.StopUnconfirmed(StopReason.STOP_PRESSED, "no standstill read back"))
    desk.run(SILENT_TICKS * TICK_S + 1.0)
    assert len(desk.guardians) == 1
    assert desk.control.picture.is_stop_unconfirmed


def test_a_stall_of_our_own_is_not_taken_for_a_silent_guardian(desk):
    desk.moving()
    desk.now_s += 10 * SILENT_TICKS * TICK_S
    desk.control.tick(desk.now_s)
    assert len(desk.guardians) == 1


def test_a_guardian_that_cannot_be_started_is_tried_again_and_told_once(desk):
    desk.trouble = "the guardian cannot be started: no memory; start again"
    desk.run(2.0)
    assert lines(desk).count(desk.trouble) == 1
    assert desk.control.picture.robot.text == desk.trouble
    assert desk.trouble in str(desk.control.picture.blockers)
    desk.trouble = ""
    desk.ready()
    assert len(desk.guardians) == 1


def test_stop_pressed_while_there_is_no_guardian_is_owed_to_the_next(desk):
    desk.armed()
    desk.trouble = "the guardian cannot be started"
    desk.press(e.GuardianGone(desk.now_s, "the guardian process has ended"))
    desk.run(0.5)
    desk.press(e.StopPressed(desk.now_s))
    desk.trouble = ""
    desk.run(0.5)
    assert isinstance(desk.guardian.heard[0], m.Stop)
    assert desk.guardian.heard[0].reason is StopReason.STOP_PRESSED


def test_servo_power_is_asked_of_the_guardian(desk):
    desk.ready()
    desk.control.handle(ServoAsked(is_on=True), desk.now_s)
    desk.control.handle(ServoAsked(is_on=False), desk.now_s)
    assert desk.guardian.of(m.ServoOn) == [m.ServoOn()]
    assert desk.guardian.of(m.ServoOff) == [m.ServoOff()]


def test_a_stop_for_an_alarm_stands_in_the_record_with_its_reason(desk):
    desk.moving()
    desk.guardian.stop(StopReason.ROBOT_ALARM, "the robot has an alarm")
    assert desk.run(1.0, S.STOPPED)
    stopping = [
        r.fields["sentence"] for r in desk.of(Topic.STATE) if r.fields["state"] == "STOPPING"
    ]
    assert stopping[-1].startswith("The robot has an alarm.")
    assert desk.control.state.stop_reason is StopReason.ROBOT_ALARM


def test_it_says_when_nothing_may_move(desk):
    assert desk.control.at_rest.is_set()
    desk.armed()
    assert not desk.control.at_rest.is_set()
    desk.press(e.DisarmPressed(desk.now_s))
    assert desk.control.at_rest.is_set()
