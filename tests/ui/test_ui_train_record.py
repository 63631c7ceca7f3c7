"""Recording as a person sees it: prompt, count-in, beat, takes with verdicts, and the buttons."""

import shutil
from dataclasses import replace
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QAction, QColor
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QDoubleSpinBox, QLabel, QSpinBox

from gestureapp.cell.snapshot import CellState
from gestureapp.gestures import GESTURES
from gestureapp.guided.values import Pace, Phase
from gestureapp.recording.people import model_path
from gestureapp.sensing.values import Side
from tests.ui.sitting import Room
from ui.gesture_list import GestureRow
from ui.prompt_view import PromptView
from ui.record_step import RecordStep
from ui.take_strip import TakeStrip
from ui.theme import colours_of

DEMO_MODEL = Path(__file__).parents[2] / "resources" / "demo" / "model.json"
CONTROL = Qt.KeyboardModifier.ControlModifier
SHIFT = Qt.KeyboardModifier.ShiftModifier


@pytest.fixture
def room(qtbot, cell, operator, tmp_path):
    room = Room(cell, operator, tmp_path)
    qtbot.addWidget(room.window)
    room.record()
    yield room
    room.window.close()
    room.bench.desk.close()


def row(room: Room, label: str) -> GestureRow:
    return room.window.findChild(GestureRow, f"record_{label}")


def strip(room: Room) -> TakeStrip:
    return room.window.findChild(TakeStrip)


def prompt(room: Room) -> PromptView:
    return room.window.findChild(PromptView)


def signs(room: Room) -> list[str]:
    return [picture.accessibleName().rpartition(": ")[2] for picture in strip(room).pictures]


def test_the_first_gesture_is_chosen_and_told_in_large_words(room):
    assert row(room, "X+").isChecked()
    assert (room.text("promptWords_0"), room.text("promptWords_1")) == ("push", "forward")
    assert room.text("promptHow") == "X+   hand level"
    assert room.text("takeLabel") == "take 1 of 30"
    assert prompt(room).drawing.label == "X+"
    assert room.window.findChild(QLabel, "promptWords_0").fontMetrics().capHeight() >= 30


def test_every_gesture_can_be_chosen_and_is_told(room):
    for each in GESTURES:
        room.press(f"record_{each.label}")
        assert room.bench.picture.label == each.label
        assert prompt(room).drawing.label == each.label
        told = f"{room.text('promptWords_0')} {room.text('promptWords_1')}"
        assert told == each.words


def test_enter_begins_with_a_count_in(room):
    room.key(Qt.Key.Key_Return)
    assert room.bench.picture.phase is Phase.COUNT_IN
    assert prompt(room).count == "3"
    assert room.widget("countIn").isVisible()
    room.run(1.0)
    assert prompt(room).count == "2"
    room.run(2.1)
    assert prompt(room).count == ""
    assert not room.widget("countIn").isVisible()


def test_a_batch_fills_the_ring_and_shows_each_take_with_its_verdict(room):
    room.press("startBatch")
    room.run_until(lambda picture: len(picture.batch) == 3)
    assert len(strip(room).pictures) == 3
    n_good = row(room, "X+").progress.good
    assert n_good == signs(room).count("good") > 0
    assert room.text("takeLabel") == f"take {n_good + 1} of 30"
    room.run_until(lambda picture: picture.phase is Phase.IDLE)
    assert row(room, "X+").progress.good == 10
    assert room.button("stepRecord").state.text == "10 of 360"


def test_the_verdict_on_the_last_take_stands_under_the_drawing(room):
    band = room.widget("lastVerdict")
    room.press("startBatch")
    room.run_until(lambda picture: picture.n_in_batch == 1)
    assert band.text == "\u2713  good"
    assert band.isVisible()
    room.bench.is_idle = True
    room.press("pauseBatch")
    room.press("endBatch")
    assert not band.isVisible()


def test_a_take_without_a_movement_is_told_and_does_not_count(room):
    room.press("paceRhythm")
    room.bench.is_idle = True
    room.press("startBatch")
    room.run_until(lambda picture: len(picture.batch) == 1)
    assert "no movement" in room.widget("lastVerdict").text
    assert signs(room) == ["no movement"]
    assert row(room, "X+").progress.good == 0
    assert room.text("takeLabel") == "take 1 of 30"


def test_the_frame_is_lit_at_each_beat(room):
    room.press("paceRhythm")
    room.press("startBatch")
    room.run_until(lambda picture: picture.phase is Phase.TAKING)
    assert prompt(room).is_lit
    room.run(0.3)
    assert not prompt(room).is_lit


def test_redo_last_by_key_takes_the_last_take_back_and_undo_and_redo_follow(room):
    room.press("startBatch")
    room.run_until(lambda picture: picture.n_in_batch == 2)
    room.press("pauseBatch")
    assert row(room, "X+").progress.good == 2
    room.key(Qt.Key.Key_R)
    assert row(room, "X+").progress.good == 1
    room.key(Qt.Key.Key_Z, CONTROL)
    assert row(room, "X+").progress.good == 2
    room.key(Qt.Key.Key_Z, CONTROL | SHIFT)
    assert row(room, "X+").progress.good == 1
    room.press("undoTake")
    room.press("redoTake")
    assert row(room, "X+").progress.good == 1


def test_undo_and_redo_say_what_they_would_do(room):
    assert not room.button("undoTake").isEnabled()
    room.press("startBatch")
    room.run_until(lambda picture: picture.n_in_batch == 1)
    assert room.bench.picture.undo in room.button("undoTake").toolTip()
    assert room.button("undoTake").isEnabled()
    assert not room.button("redoTake").isEnabled()


def test_pause_and_go_on(room):
    room.press("startBatch")
    room.run_until(lambda picture: picture.phase is Phase.WAITING)
    room.press("pauseBatch")
    assert room.bench.picture.phase is Phase.PAUSED
    assert room.button("pauseBatch").text() == "Go on"
    room.key(Qt.Key.Key_Enter)
    assert room.bench.picture.phase is Phase.COUNT_IN
    room.press("pauseBatch")
    room.press("pauseBatch")
    assert room.bench.picture.phase is Phase.COUNT_IN
    room.press("endBatch")
    assert room.bench.picture.phase is Phase.IDLE
    assert not room.button("endBatch").isEnabled()


def test_the_marked_take_is_excluded_and_taken_in_again(room):
    room.press("startBatch")
    room.run_until(lambda picture: picture.n_in_batch == 2)
    room.press("pauseBatch")
    room.press("take_0")
    room.press("excludeTake")
    assert signs(room)[0] == "excluded"
    assert row(room, "X+").progress.good == 1
    assert room.button("excludeTake").text() == "Take in"
    room.press("excludeTake")
    assert row(room, "X+").progress.good == 2


def test_the_marked_take_is_moved_to_another_gesture(room):
    room.press("startBatch")
    room.run_until(lambda picture: picture.n_in_batch == 1)
    room.press("pauseBatch")
    taken = strip(room).chosen
    room.window.findChild(QAction, "moveTo_Z-").trigger()
    room.run(0.01)
    moved = [take.label for take in room.controls.takes() if take.id == taken.id]
    assert moved == ["Z-"]


def test_nothing_is_marked_before_the_first_take(room):
    assert strip(room).chosen is None
    assert not room.button("excludeTake").isEnabled()
    assert not room.button("moveTake").isEnabled()
    assert not room.button("redoLast").isEnabled()


def test_a_lost_sensor_is_told_across_the_window_until_it_is_back(room):
    room.press("startBatch")
    room.run_until(lambda picture: picture.n_in_batch == 1)
    bar = room.window.findChild(QLabel, "pageNotice")
    assert not bar.isVisible()
    room.bench.lose(Side.RIGHT)
    room.run_until(lambda picture: picture.phase is Phase.SENSOR_LOST)
    assert bar.isVisible()
    assert "Right sensor lost" in bar.text()
    assert "1 good take is kept" in bar.text()
    room.bench.restore(Side.RIGHT)
    room.run_until(lambda picture: picture.phase is Phase.COUNT_IN)
    assert not bar.isVisible()


@pytest.mark.parametrize("by_key", [False, True])
def test_stop_goes_out_first_then_holds_the_batch_and_is_told(room, by_key):
    order: list[str] = []
    stop, pause = room.cell.stop, room.controls.pause
    room.cell.stop = lambda *why: (order.append("stop"), stop(*why))
    room.controls.pause = lambda: (order.append("pause"), pause())
    room.press("startBatch")
    room.run_until(lambda picture: picture.phase is Phase.WAITING)
    if by_key:
        room.key(Qt.Key.Key_Escape)
    else:
        QTest.mousePress(room.button("stopButton"), Qt.MouseButton.LeftButton)
        room.run(0.01)
    assert order == ["stop", "pause"]
    assert room.bench.picture.phase is Phase.PAUSED
    bar = room.window.findChild(QLabel, "stoppedNotice")
    assert not bar.isVisible()
    words = "STOP was pressed. The robot stands. Clear what stands against arming, then hold Arm."
    room.cell.shown = replace(room.cell.shown, state=CellState.STOPPED, sentence=words)
    room.look()
    assert bar.isVisible()
    assert bar.text() == words
    room.press("navOperate")
    assert not bar.isVisible()


def test_stop_goes_out_where_no_batch_is_under_way(room):
    room.key(Qt.Key.Key_Escape)
    assert "stop" in room.cell.calls
    assert room.bench.picture.phase is Phase.IDLE


def test_stop_ends_a_live_test(room, tmp_path):
    shutil.copy(DEMO_MODEL, model_path(tmp_path, room.bench.picture.person))
    room.controls.start_trying()
    room.run_until(lambda picture: picture.trying.is_on)

    room.key(Qt.Key.Key_Escape)
    room.run(0.05)

    assert "stop" in room.cell.calls
    assert not room.bench.picture.trying.is_on


def test_without_a_left_sensor_takes_go_by_the_beat(qtbot, cell, operator, tmp_path):
    room = Room(cell, operator, tmp_path)
    qtbot.addWidget(room.window)
    room.bench.lose(Side.LEFT)
    room.run(1.0)
    room.record()
    room.run(0.05)
    assert room.bench.picture.pace is Pace.RHYTHM
    assert room.button("paceRhythm").isChecked()
    room.window.close()
    room.bench.desk.close()


def test_the_pace_follows_the_left_sensor_whenever_the_step_is_entered(room):
    room.press("stepSensors")
    room.run(2.5)
    room.press("sensorsNext")
    room.run(0.05)
    assert room.button("paceHandsFree").isChecked()
    room.press("stepSensors")
    room.bench.lose(Side.LEFT)
    room.run(1.0)
    assert "by the beat" in room.text("sensorsTold")
    room.press("sensorsNext")
    room.run(0.05)
    assert room.button("paceRhythm").isChecked()
    room.press("navOperate")
    room.bench.restore(Side.LEFT)
    room.run(2.5)
    room.press("navTrain")
    room.run(0.05)
    assert room.button("paceHandsFree").isChecked()


def test_a_pace_chosen_by_hand_stays(room):
    room.press("paceRhythm")
    room.press("stepSensors")
    room.press("stepRecord")
    room.run(0.05)
    assert room.bench.picture.pace is Pace.RHYTHM
    room.press("paceHandsFree")
    room.press("stepSensors")
    room.bench.lose(Side.LEFT)
    room.run(1.0)
    room.press("stepRecord")
    room.run(0.05)
    assert room.bench.picture.pace is Pace.HANDS_FREE


def test_the_pace_of_a_batch_on_hold_stays(room):
    room.run(0.05)
    assert room.bench.picture.pace is Pace.RHYTHM  # the left sensor's rate was not known yet
    room.press("startBatch")
    room.run_until(lambda picture: picture.phase is Phase.WAITING)
    for phase, pace in ((Phase.PAUSED, Pace.RHYTHM), (Phase.IDLE, Pace.HANDS_FREE)):
        room.press("stepSensors")
        room.run(1.0)
        room.press("stepRecord")
        room.run(0.05)
        assert (room.bench.picture.phase, room.bench.picture.pace) == (phase, pace)
        if phase is Phase.PAUSED:
            room.press("endBatch")


def test_beat_and_number_of_takes_are_set_by_hand(room):
    room.press("paceRhythm")
    room.run(0.05)
    beat = room.window.findChild(QDoubleSpinBox, "beatTime")
    wanted = room.window.findChild(QSpinBox, "takesWanted")
    beat.setValue(2.0)
    beat.editingFinished.emit()
    wanted.setValue(12)
    wanted.editingFinished.emit()
    room.run(0.05)
    assert room.bench.picture.beat_s == 2.0
    assert room.text("takeLabel") == "take 1 of 12"

    room.press("paceHandsFree")
    room.run(0.05)
    beat.editingFinished.emit()  # the field loses the focus as it is shut
    room.run(0.05)
    assert room.bench.picture.pace is Pace.HANDS_FREE


def test_the_level_of_the_hand_is_told_except_while_it_moves(room):
    level = room.widget("recordLevel")
    assert level.text == "Right hand: level"
    room.press("startBatch")
    room.run_until(lambda picture: picture.phase is Phase.TAKING)
    assert level.text == "Right hand: moving"


@pytest.mark.parametrize("gesture", GESTURES, ids=lambda gesture: gesture.label)
def test_a_level_hand_is_demanded_only_where_the_gesture_begins_with_one(room, gesture):
    room.press(f"record_{gesture.label}")
    tilted = replace(room.bench.picture, tilt_deg=27.0, is_level=False)
    step = room.window.findChild(RecordStep)
    step.show_snapshot(tilted, room.cell.shown)
    is_posture = gesture.label.startswith(("RX", "RY"))
    words = "27\u00b0 from level" if is_posture else "27\u00b0 off, hold it level"
    level = room.widget("recordLevel")
    assert level.text == f"Right hand: {words}"
    attention = QColor(colours_of(level.palette()).attention).rgb()
    image = level.grab().toImage()
    points = ((x, y) for x in range(image.width()) for y in range(image.height()))
    assert any(image.pixel(x, y) == attention for x, y in points) is not is_posture


def test_when_all_takes_of_a_gesture_are_there_the_next_one_is_suggested(room):
    room.controls.set_wanted(5)
    room.run(0.05)
    room.press("startBatch")
    room.run_until(lambda picture: picture.phase is Phase.IDLE)
    assert row(room, "X+").progress.good == 5
    assert room.bench.picture.label == room.bench.picture.suggested != "X+"
    room.press("record_X+")
    assert room.text("takeLabel") == "5 of 5: done"
    assert row(room, room.bench.picture.suggested).is_next
