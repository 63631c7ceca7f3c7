"""The step Calibrate: six positions, the level check, and the left arm's postures."""

from dataclasses import replace

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QProgressBar

from gestureapp.sensing.values import LinkState, Side
from gestureapp.setup.values import (
    CalibrationView,
    Check,
    LevelView,
    Outcome,
    Position,
    PositionState,
    PosturesView,
    Remedy,
)
from tests.ui.setup_bench import SetupRoom, card, six
from ui.position_tile import PositionTile

UNDER_WAY = CalibrationView(Side.LEFT, True, "Lay it on its edge", six(2), Position.X_UP)
RECORDING = PosturesView("Ana", True, "Hold START", 0.5, is_stop_done=True)


@pytest.fixture
def room(qtbot, cell):
    room = SetupRoom(cell)
    qtbot.addWidget(room.window)
    room.enter("Calibrate")
    yield room
    room.window.close()


def tiles(room: SetupRoom) -> list[str]:
    found = room.window.findChildren(PositionTile)
    assert all(tile.isVisible() for tile in found)
    return [tile.accessibleName() for tile in found]


def test_both_sides_and_the_postures_say_how_they_stand(room):
    room.show(right=card(Side.RIGHT, problem="not calibrated"))
    said = {name: room.button(f"calibrate{name}").state for name in ("_left", "_right", "Postures")}
    assert said["_left"].startswith("calibrated 2026-11-22")
    assert said["_right"] == "not calibrated"
    assert said["Postures"].startswith("Recorded")


def test_calibrating_asks_for_the_side_in_sight(room):
    room.press("calibrate_right")
    room.press("beginCalibration")
    assert room.setup.calls == ["begin_calibration right"]
    assert room.text("calibrateSentence") == "Lay the sensor on its back and let go"


def test_each_position_has_a_word_and_a_mark(room):
    assert tiles(room) == ["Z up", "Z down", "X up", "X down", "Y up", "Y down"]
    room.show(calibration=UNDER_WAY)
    assert tiles(room)[:4] == [
        "Z up: done",
        "Z down: done",
        "X up: hold still, wanted now",
        "X down: missing",
    ]
    tile = room.window.findChild(PositionTile, "position_x-up")
    assert tile.view.state is PositionState.HOLD_STILL
    assert tile.view.progress == pytest.approx(0.4)


def test_the_other_tasks_are_closed_while_one_is_under_way(room):
    room.show(calibration=UNDER_WAY)
    assert not room.button("calibrate_right").isEnabled()
    assert not room.button("calibratePostures").isEnabled()
    assert not room.button("checkLevel").isEnabled()
    room.press("beginCalibration")
    assert room.setup.calls == ["end_calibration"]
    assert room.button("calibrate_right").isEnabled()


def test_what_is_under_way_on_the_other_side_comes_into_sight(room):
    room.show(calibration=replace(UNDER_WAY, side=Side.RIGHT))
    assert room.button("calibrate_right").isChecked()
    assert room.text("calibrateSentence") == "Lay it on its edge"


def test_what_is_left_before_and_after_is_shown_with_the_verdict(room):
    end = Outcome(Check.PASSED, "kept for this sensor")
    done = CalibrationView(
        Side.LEFT, False, "", six(6), None, 84.0, 2.1, 4.4, "Good: within 5 mg.", end
    )
    room.show(calibration=done)
    figures = [room.text(f"calibrate{name}") for name in ("Before", "After", "Worst")]
    assert figures == ["84 mg", "2.1 mg", "4.4 mg"]
    assert room.text("calibrateSentence") == "Good: within 5 mg."
    assert room.text("calibrateOutcome") == "passed: kept for this sensor"
    room.press("calibrate_right")
    assert room.text("calibrateBefore") == "\u2013", "these are the other sensor's"


def test_a_sensor_being_calibrated_is_under_way_and_no_problem(room):
    room.show(left=card(Side.LEFT, problem="it is being calibrated"), calibration=UNDER_WAY)
    assert room.button("calibrate_left").state == "being calibrated"


def test_a_sensor_that_does_not_send_cannot_be_calibrated(room):
    room.show(left=card(Side.LEFT, LinkState.NO_DATA))
    assert room.text("calibrateSentence").startswith("No data from the left arm's sensor")
    for name in ("beginCalibration", "checkLevel"):
        assert not room.button(name).isEnabled()


def test_the_level_check_shows_its_progress_and_its_figures(room):
    room.press("checkLevel")
    assert room.setup.calls == ["begin_level_check left"]
    room.show(level=LevelView(Side.LEFT, Outcome(Check.RUNNING), 0.6))
    assert room.text("calibrateSentence") == "Leave the sensor level and still."
    bar = room.window.findChild(QProgressBar, "levelProgress")
    assert (bar.isVisible(), bar.value()) == (True, 60)
    end = Outcome(Check.FAILED, "Lay it on a level table.")
    room.show(level=LevelView(Side.LEFT, end, 1.0, 3.9, 12.0))
    assert room.text("levelOutcome") == "failed: Lay it on a level table."
    room.show(level=LevelView(Side.LEFT, Outcome(Check.PASSED), 1.0, 0.4, 3.2))
    assert room.text("levelOutcome") == "passed: 0.4\u00b0 from level, 3.2 mg from 1 g"
    assert not bar.isVisible()
    room.press("calibrate_right")
    assert room.text("levelOutcome").startswith("level, 0.4 degrees, today")


def test_postures_are_recorded_one_after_the_other(room):
    room.press("calibratePostures")
    room.press("beginPostures")
    assert room.setup.calls == ["begin_postures"]
    assert room.widget("stopPosture").accessibleName() == "stop posture: hold still"
    room.show(postures=RECORDING)
    assert room.text("posturesSentence") == "Hold START"
    assert room.widget("stopPosture").accessibleName() == "stop posture: done"
    assert room.widget("startPosture").accessibleName() == "start posture: hold still"
    room.press("beginPostures")
    assert room.setup.calls == ["begin_postures", "end_postures"]


def test_a_sentence_is_not_said_twice(room):
    room.press("calibratePostures")
    room.show(postures=replace(RECORDING, outcome=Outcome(Check.RUNNING, "Hold START")))
    assert room.text("posturesOutcome") == "running"


def test_the_margin_is_shown_with_what_is_needed(room):
    room.press("calibratePostures")
    end = Outcome(Check.FAILED, "the margin is too small")
    close = replace(
        RECORDING, is_on=False, is_start_done=True, between_deg=47.0, margin_deg=-3.0, outcome=end
    )
    room.show(postures=close)
    figures = [room.text(f"postures{name}") for name in ("Between", "Margin", "Least")]
    assert figures == ["47\u00b0", "-3\u00b0", "5\u00b0"]
    assert room.text("posturesOutcome") == "failed: the margin is too small"
    assert "margin -3\u00b0, 5\u00b0 needed" in room.button("setupStepCalibrate").accessibleName()


def test_the_built_in_postures_can_be_used_again(room):
    room.press("calibratePostures")
    room.press("forgetPostures")
    assert room.setup.calls == ["forget_postures"]
    room.show(postures=PosturesView("Ana"))
    assert room.text("posturesSentence") == "Ana uses the built-in postures."
    assert not room.button("forgetPostures").isEnabled()


def test_a_damaged_profile_is_said_and_can_be_given_up(room):
    room.press("calibratePostures")
    problem, remedy = "Ana's profile.json is damaged", "record the postures anew"
    said = f"{problem}: {remedy}."
    room.show(postures=PosturesView("Ana", sentence=said, problem=problem, remedy=remedy))
    assert room.text("posturesSentence") == said
    assert room.button("calibratePostures").state == problem
    assert problem in room.button("setupStepCalibrate").accessibleName()
    room.press("forgetPostures")
    assert room.setup.calls == ["forget_postures"]


def test_a_left_handed_person_s_arms_are_called_as_they_are_worn(room):
    room.show(
        left=card(Side.LEFT, LinkState.NO_DATA, arm="right"),
        right=card(Side.RIGHT, arm="left"),
        postures=PosturesView("Ana", arm="right"),
    )
    assert room.button("calibrate_left").text() == "Right arm's sensor"
    room.press("calibratePostures")
    assert (
        room.text("posturesSentence") == "No data from the right arm's sensor: see Sensors first."
    )
    room.press("setupStepSensors")
    assert room.text("leftSensorTitle") == "Right arm: start and stop"
    assert room.text("rightSensorTitle") == "Left arm: gestures"
    assert room.text("rightSetupPlotTitle") == "Left arm in g, 8 s"


def test_postures_need_a_person_and_the_left_sensor(room):
    room.press("calibratePostures")
    room.show(left=card(Side.LEFT, LinkState.NO_DATA))
    assert not room.button("beginPostures").isEnabled()
    assert room.text("posturesSentence").startswith("No data from the left arm")
    room.show(left=card(Side.LEFT), postures=PosturesView())
    assert not room.button("beginPostures").isEnabled()
    assert room.text("posturesSentence") == "Choose a person first: see People."


def test_going_away_ends_what_nobody_would_see(room):
    room.show(calibration=UNDER_WAY)
    room.press("setupStepSensors")
    room.press("setupStepCalibrate")
    room.show(calibration=CalibrationView(), postures=RECORDING)
    room.press("navOperate")
    assert room.setup.calls == ["end_calibration", "end_postures", "setup closed"]


def test_a_problem_of_a_card_leads_to_its_side(room):
    room.press("setupStepSensors")
    room.show(right=card(Side.RIGHT, problem="not calibrated", act=Remedy.CALIBRATE))
    room.press("rightAct")
    assert room.button("calibrate_right").isChecked()
    assert room.text("calibrateSentence") == "Not calibrated."


def test_the_virtual_operator_does_what_is_asked_for_each_thing_once(qtbot, cell, operator):
    room = SetupRoom(cell, operator)
    qtbot.addWidget(room.window)
    room.enter("Calibrate")
    room.press("followPrompts")
    right = replace(UNDER_WAY, side=Side.RIGHT)
    for calibration in (UNDER_WAY, replace(UNDER_WAY, wanted=Position.Y_DOWN), right):
        room.show(calibration=calibration)
        room.look()
    room.show(calibration=CalibrationView())
    room.show(postures=replace(RECORDING, is_stop_done=False))
    room.show(postures=RECORDING)
    room.show(postures=PosturesView("Ana"))
    done = [each for each in operator.done if each != "follow nothing"]
    assert done == [
        "lay left x-up",
        "lay left y-down",
        "left_stop",
        "lay right x-up",
        "right_rest",
        "left_stop",
        "left_start",
    ]
    room.window.close()


def test_a_second_space_does_not_press_the_neighbour(room):
    room.window.activateWindow()
    assert QTest.qWaitForWindowActive(room.window, 5000)
    room.button("checkLevel").setFocus(Qt.FocusReason.TabFocusReason)
    QTest.keyClick(room.button("checkLevel"), Qt.Key.Key_Space)
    room.show(level=LevelView(Side.LEFT, Outcome(Check.RUNNING), 0.1))
    QTest.keyClick(QApplication.focusWidget() or room.window, Qt.Key.Key_Space)
    room.show(level=LevelView(Side.LEFT, Outcome(Check.PASSED), 1.0, 0.4, 3.2))
    assert room.setup.calls == ["begin_level_check left"]
