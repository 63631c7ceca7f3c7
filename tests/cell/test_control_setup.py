"""Setting up beside the cell, with the clock in hand: what holds at once, what waits for rest."""

from dataclasses import replace

import pytest

from gestureapp.cell import events as e
from gestureapp.cell.controls import SETUP_OPEN
from gestureapp.cell.fitness import FIT, Judgement
from gestureapp.cell.inputs import (
    ArmingHeld,
    CalibrationChosen,
    PosturesChosen,
    SensorChosen,
    SensorJudged,
    SensorTold,
    SettingsChosen,
)
from gestureapp.cell.records import Topic
from gestureapp.cell.snapshot import CellState
from gestureapp.config import SensorSettings
from gestureapp.robot import messages as m
from gestureapp.robot.values import Caps, Pose, Position, Posture, StopReason
from gestureapp.sensing.calibration import Calibration
from gestureapp.sensing.posture import BUILT_IN, LeftPostures
from gestureapp.sensing.values import ArmPosture, Identity, Side

S = CellState


def changed(desk, **robot):
    settings = desk.control.adjusted.settings
    return replace(settings, robot=replace(settings.robot, **robot))


def begin_stop_test(desk) -> None:
    desk.press(ArmingHeld(SETUP_OPEN))
    desk.press(e.StopTestPressed(desk.now_s, "X+"))


def told(desk) -> list[dict]:
    return [record.fields["changes"] for record in desk.of(Topic.SETTINGS)]


def test_other_settings_are_recorded_by_name_and_used_by_another_guardian(desk):
    desk.ready()
    old = desk.guardian
    desk.press(SettingsChosen(changed(desk, speed_mm_s=50.0, yaw_deg=90)))
    assert desk.run(4.0, S.READY)
    assert old.is_dismissed
    assert desk.guardian is not old
    assert desk.started_with[-1].robot.speed_mm_s == 50.0
    assert told(desk) == [{"robot.speed_mm_s": 50.0, "robot.yaw_deg": 90}]


def test_between_two_guardians_nothing_can_be_armed(desk):
    desk.ready()
    desk.press(SettingsChosen(changed(desk, speed_mm_s=50.0)))
    assert "robot_link" in {b.id for b in desk.control.state.blockers}
    desk.press(e.ArmPressed(desk.now_s))
    assert not desk.control.state.is_arming


def test_settings_that_are_the_same_disturb_nobody(desk):
    desk.ready()
    desk.press(SettingsChosen(changed(desk)))
    desk.run(0.5)
    assert len(desk.guardians) == 1
    assert told(desk) == []


def test_sensors_person_and_simulation_are_not_changed_by_settings(desk):
    desk.ready()
    before = desk.control.adjusted.settings
    other = replace(changed(desk, speed_mm_s=50.0), is_simulation=True)
    other = replace(other, left=SensorSettings("/dev/x"), person=replace(other.person, name="Ben"))
    desk.press(SettingsChosen(other))
    after = desk.control.adjusted.settings
    assert (after.left, after.person, after.is_simulation) == (before.left, before.person, False)


def test_all_that_was_chosen_while_armed_is_taken_once_disarmed(desk):
    desk.armed()
    spare = SensorSettings("/dev/spare", "adxl330", "spare")
    desk.press(SensorChosen(Side.RIGHT, spare))
    desk.press(SettingsChosen(changed(desk, speed_mm_s=50.0)))
    desk.press(PosturesChosen(LeftPostures(start=(0.0, 1.0, 0.0)), FIT))
    desk.run(0.3)
    assert desk.state is S.ARMED
    assert (desk.readers[Side.RIGHT].used, desk.control.adjusted.postures) == ([], BUILT_IN)
    desk.press(e.DisarmPressed(desk.now_s))
    desk.run(0.1)
    assert desk.readers[Side.RIGHT].used == [spare]
    assert desk.control.adjusted.postures.start == (0.0, 1.0, 0.0)
    assert desk.control.adjusted.settings.robot.speed_mm_s == 50.0
    assert {"right.port", "right.protocol", "right.name"} <= set(told(desk)[-1])


def test_a_posture_shown_before_the_change_counts_no_more(desk):
    desk.ready()
    desk.press(PosturesChosen(LeftPostures(start=(0.0, 1.0, 0.0)), FIT))
    assert desk.control.state.posture is ArmPosture.NEITHER
    assert "left_stop" in {b.id for b in desk.control.state.blockers}
    assert desk.run(2.0, S.READY)


def test_a_calibration_goes_to_its_reader_and_into_the_record(desk):
    own = Calibration((0.1, 0.0, 0.0))
    desk.press(CalibrationChosen(Side.LEFT, own))
    assert desk.readers[Side.LEFT].calibrations == [own]
    assert told(desk)[-1]["left.calibration"]["offset_g"] == [0.1, 0.0, 0.0]


@pytest.mark.parametrize("problem", ["not level", "out of date"])
def test_a_sensor_found_unfit_while_moving_stops_the_robot(desk, problem: str):
    desk.moving()
    desk.press(SensorJudged(Side.LEFT, Judgement(problem)))
    assert desk.run(1.0, S.STOPPED)
    desk.press(SensorJudged(Side.LEFT, Judgement(problem)))
    assert desk.state is S.STOPPED, "once is enough"


def test_an_open_setup_disarms_once_and_lets_a_stop_test_go_on(desk):
    desk.armed()
    desk.press(ArmingHeld(SETUP_OPEN))
    assert desk.state is S.NOT_READY
    desk.run(0.5)
    begin_stop_test(desk)
    assert desk.run(2.0, S.MOVING)
    desk.press(ArmingHeld(SETUP_OPEN))
    assert desk.state is S.MOVING
    desk.press(ArmingHeld("training is open"))
    assert desk.run(1.0, S.STOPPED)


def test_a_stop_test_proposes_short_and_slow_the_way_the_operator_faces(desk):
    desk.ready()
    desk.press(SettingsChosen(changed(desk, yaw_deg=90)))
    assert desk.run(4.0, S.READY)
    begin_stop_test(desk)
    assert desk.run(2.0, S.MOVING)
    (proposed,) = desk.guardian.of(m.Propose)
    assert (proposed.direction.axis, proposed.direction.sign) == (1, 1)
    assert proposed.caps == Caps(20.0, 10.0)


def test_a_stop_is_measured_from_the_press_with_the_place_between_two_reads(desk):
    desk.ready()
    begin_stop_test(desk)
    assert desk.run(2.0, S.MOVING)
    pressed_s = desk.now_s

    def read(t_s: float, x_mm: float) -> None:
        place = Position(Pose(x_mm, 0.0, 300.0, 180.0, 0.0, 0.0), Posture(1), 0)
        desk.press_guardian(m.PoseReport(t_s, place))

    read(pressed_s - 0.02, 805.0)
    desk.press_guardian(m.StopAsked(StopReason.STOP_PRESSED, "STOP was pressed", pressed_s + 0.001))
    desk.press(e.StopPressed(pressed_s))
    read(pressed_s + 0.06, 809.0)
    stood = Pose(809.5, 0.0, 300.0, 180.0, 0.0, 0.0)
    desk.press_guardian(m.StopConfirmed(StopReason.STOP_PRESSED, 0.119, stood))
    desk.control.tick(desk.now_s)
    result = desk.control.picture.stop_test
    assert result.took_s == pytest.approx(0.12)
    assert result.ran_on_mm == pytest.approx(3.5)
    assert (result.phase, result.label) == ("done", "X+")
    assert result.text == "Stood 120 ms after STOP was pressed, 3.5 mm farther on."


def test_a_stop_for_another_reason_is_not_measured(desk):
    desk.ready()
    begin_stop_test(desk)
    assert desk.run(2.0, S.MOVING)
    desk.press(e.StopPressed(desk.now_s, "the window was closed"))
    assert desk.run(1.0, S.STOPPED)
    desk.run(0.02)
    result = desk.control.picture.stop_test
    assert (result.phase, result.is_measured) == ("done", False)
    assert "the window was closed" in result.text


def test_the_phases_of_a_stop_test_are_shown_in_their_order(desk):
    desk.ready()
    begin_stop_test(desk)
    phases = []
    for _ in range(300):
        desk.run(0.01)
        result = desk.control.picture.stop_test
        if not phases or phases[-1] != result.phase:
            phases.append(result.phase)
        if desk.state is S.MOVING:
            desk.press(e.StopPressed(desk.now_s))
    assert phases == ["arming", "moving", "stopping", "done"]


def test_the_connection_is_shown_with_banner_position_and_alarms(desk):
    desk.ready()
    desk.press_guardian(m.StatusReport(desk.now_s, 0xC0, 0x50, (4107,)))
    desk.control.tick(desk.now_s + 0.01)
    robot = desk.control.picture.robot
    assert robot.alarms == (4107,)
    assert robot.banner == "127.0.0.1:80"
    assert robot.position is not None
    assert robot.position.tool == 0
    desk.press_guardian(m.LinkReport(False, "connection refused"))
    desk.control.tick(desk.now_s + 0.02)
    assert desk.control.picture.robot.banner == ""


def test_what_limits_nothing_leaves_the_guardian_where_it_is(desk):
    desk.ready()
    old = desk.guardian
    site = replace(desk.control.adjusted.settings.site, stop_seen_s=0.3, calibration_days=90)
    desk.press(SettingsChosen(replace(desk.control.adjusted.settings, site=site)))
    assert desk.run(4.0, S.READY)
    assert desk.guardian is old
    assert told(desk)[-1] == {"site.stop_seen_s": 0.3, "site.calibration_days": 90}


def test_other_angles_are_too_wide_for_the_same_postures(desk):
    near = LeftPostures(start=(-0.95, 0.0, 0.31))
    desk.ready()
    desk.press(PosturesChosen(near, FIT))
    assert desk.run(4.0, S.READY)
    site = replace(
        desk.control.adjusted.settings.site, posture_enter_deg=36.0, posture_leave_deg=40.0
    )
    desk.press(SettingsChosen(replace(desk.control.adjusted.settings, site=site)))
    desk.run(1.0)
    assert "postures" in {b.id for b in desk.control.state.blockers}


def test_another_robot_has_no_stop_test_yet(desk):
    desk.ready()
    begin_stop_test(desk)
    assert desk.run(2.0, S.MOVING)
    desk.press(e.StopPressed(desk.now_s))
    assert desk.run(1.0, S.STOPPED)
    desk.run(0.1)
    assert desk.control.picture.stop_test is not None
    desk.press(SettingsChosen(changed(desk, port=81)))
    desk.run(0.1)
    assert desk.control.picture.stop_test is None


@pytest.mark.parametrize("is_moving", [False, True])
def test_another_sensor_that_answers_is_nobody_one_may_arm_with(desk, is_moving: bool):
    if is_moving:
        desk.moving()
    else:
        desk.ready()
    desk.press(SensorTold(desk.now_s, Side.LEFT, Identity("stranger")))
    desk.run(0.3)
    if is_moving:
        assert desk.run(1.0, S.STOPPED)
    assert "left_unfit" in {b.id for b in desk.control.state.blockers}
    desk.press(SensorJudged(Side.LEFT, FIT))
    desk.run(0.3)
    assert "left_unfit" not in {b.id for b in desk.control.state.blockers}
