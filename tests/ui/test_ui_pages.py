"""The rail and its pages: where one can go, and what stays wherever one is."""

from dataclasses import replace

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QShortcut
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QAbstractButton, QApplication, QLabel, QLineEdit, QPushButton, QWidget

from gestureapp.cell.snapshot import Blocker, CellState
from tests.ui.sitting import NoTrainer, Room
from ui.main_window import MainWindow
from ui.nav_rail import NavButton
from ui.train_words import Step

SIZES = [(1280, 720), (1366, 768), (1920, 1080)]
STEPS = tuple(f"step{step.value}" for step in Step)
LOCK = Blocker("lock", "training is open", "finish that first")


@pytest.fixture
def room(qtbot, cell, operator, tmp_path):
    room = Room(cell, operator, tmp_path)
    qtbot.addWidget(room.window)
    yield room
    room.window.close()
    room.bench.desk.close()


def test_there_is_no_way_to_the_training_where_there_is_none(window):
    assert window.findChild(NavButton, "navOperate").isChecked()
    assert window.findChild(NavButton, "navTrain") is None


def test_the_training_locks_arming_for_as_long_as_it_is_open(room):
    room.press("navTrain")
    assert room.widget("trainPage").isVisible()
    assert not room.widget("operatePage").isVisible()
    assert room.cell.calls == ["training is open"]
    room.press("navTrain")
    assert room.cell.calls == ["training is open"], "it is open already"
    room.press("navOperate")
    assert room.widget("operatePage").isVisible()
    assert room.cell.calls == ["training is open", "arming free"]


def test_the_strip_says_that_arming_is_locked(room):
    room.press("navTrain")
    room.cell.shown = replace(room.cell.shown, blockers=(LOCK,), state=CellState.NOT_READY)
    room.look()
    assert room.text("stripLine").startswith("Training is open: arming is locked")


@pytest.mark.parametrize("state", CellState)
def test_the_training_opens_only_while_the_robot_is_at_rest(room, state):
    room.cell.shown = replace(room.cell.shown, state=state)
    room.look()
    entry = room.button("navTrain")
    is_at_rest = state not in (CellState.ACTIVATED, CellState.MOVING, CellState.STOPPING)
    assert entry.isEnabled() is is_at_rest
    assert (entry.note == "") is is_at_rest
    QTest.mouseClick(entry, Qt.MouseButton.LeftButton)
    assert room.cell.calls == (["training is open"] if is_at_rest else [])


def test_steps_that_need_a_person_say_so(room):
    room.press("navTrain")
    for name in STEPS[2:]:
        assert not room.button(name).isEnabled()
        assert "choose a person first" in room.button(name).accessibleName()


def test_the_entry_says_why_it_is_closed(room):
    robot = replace(room.cell.shown.robot, is_moving=True)
    room.cell.shown = replace(room.cell.shown, robot=robot)
    room.look()
    assert room.button("navTrain").note == "not while the robot moves"
    assert "not while the robot moves" in room.button("navTrain").accessibleName()
    room.cell.shown = replace(room.cell.shown, is_stop_unconfirmed=True)
    room.look()
    assert room.button("navTrain").note == "not before the stop is confirmed"


def test_stop_stays_where_it_is_and_stops_on_every_page(room):
    stop = room.widget("stopButton")
    before = stop.mapTo(room.window, stop.rect().topLeft()), stop.size()
    for place in ("navTrain", "navOperate"):
        room.press(place)
        assert (stop.mapTo(room.window, stop.rect().topLeft()), stop.size()) == before
        room.cell.calls.clear()
        QTest.mousePress(stop, Qt.MouseButton.LeftButton)
        room.key(Qt.Key.Key_Escape)
        room.key(Qt.Key.Key_Pause)
        assert room.cell.calls == ["stop", "stop", "stop"]


def test_a_page_out_of_sight_is_not_drawn(room):
    room.press("navTrain")
    before = room.text("sentenceLabel")
    room.cell.shown = replace(room.cell.shown, sentence="something else")
    room.look()
    assert room.text("sentenceLabel") == before
    room.press("navOperate")
    assert room.text("sentenceLabel") == "something else"


def test_the_virtual_operator_is_on_both_pages(room, operator):
    for place in ("navTrain", "navOperate"):
        room.press(place)
        room.press("leftStop")
    assert operator.done == ["left_stop", "left_stop"]


def test_a_name_is_typed_without_moving_an_arm(room, operator):
    room.press("navTrain")
    room.window.activateWindow()
    assert QTest.qWaitForWindowActive(room.window, 5000)
    field = room.window.findChild(QLineEdit, "newPersonName")
    field.setFocus()
    QTest.keyClicks(field, "sad fog rat")
    assert field.text().endswith("sad fog rat")
    assert operator.done == []


def test_no_key_has_two_meanings_at_once(room):
    room.record()
    for step in STEPS:
        room.press(step)
        shortcuts = room.window.findChildren(QShortcut)
        words = [each.key().toString() for each in shortcuts if each.parent().isVisible()]
        assert len(words) == len(set(words)), step
        assert {"Space", "Esc", "Pause"}.isdisjoint(words)
        assert ({"Return", "R", "Ctrl+Z"} <= set(words)) is (step == "stepRecord")


def test_keys_of_the_recording_sleep_on_the_other_pages(room):
    room.record()
    room.press("navOperate")
    room.key(Qt.Key.Key_Return)
    assert room.bench.picture.batch_size == 10
    assert room.bench.picture.count_in == 0


@pytest.mark.parametrize("size", SIZES, ids=str)
def test_every_step_fits_without_clipping(qtbot, room, size):
    room.record()
    room.window.resize(*size)
    qtbot.waitUntil(lambda: (room.window.width(), room.window.height()) == size)
    for step in STEPS:
        room.press(step)
        QApplication.processEvents()
        area = room.widget("workArea")
        assert area.widget().width() <= area.viewport().width(), step
        assert area.widget().height() <= area.viewport().height(), step
        for each in room.window.findChildren(QPushButton):
            lines = each.text().split("\n")
            widest = max(each.fontMetrics().horizontalAdvance(line) for line in lines)
            assert not each.isVisible() or each.width() >= widest, each.objectName()
        for label in room.widget("trainPage").findChildren(QLabel):
            if label.isVisible() and not label.wordWrap():
                wide = label.fontMetrics().horizontalAdvance(label.text())
                assert label.width() >= wide, label.objectName()


def test_every_widget_of_the_training_has_a_name_for_tests_and_for_people(room):
    room.record()
    for step in STEPS:
        room.press(step)
        parts = [room.widget(name) for name in ("newPersonName", "peopleList", "beatTime")]
        for each in [*room.window.findChildren(QAbstractButton), *parts]:
            is_own = bool(each.objectName()) and not each.objectName().startswith("qt_")
            assert not (is_own and each.isVisible()) or each.accessibleName(), each.objectName()
    names = [each.objectName() for each in room.window.findChildren(QAbstractButton)]
    own = [name for name in names if name and not name.startswith("qt_")]
    assert len(own) == len(set(own))


def test_space_presses_nothing_after_a_page_or_step_has_changed(room, operator):
    room.record()
    for place in ("navOperate", "navTrain", *STEPS):
        room.press(place)
        before = room.window.findChild(NavButton, "navTrain").isChecked(), list(room.cell.calls)
        room.key(Qt.Key.Key_Space)
        room.run(0.05)
        assert (room.button("navTrain").isChecked(), list(room.cell.calls)) == before
        assert not isinstance(QApplication.focusWidget(), QAbstractButton)
    assert operator.done == []


def test_going_away_puts_a_batch_on_hold(room):
    room.record()
    room.press("startBatch")
    room.run(1.0)
    room.press("navOperate")
    room.run(5.0)
    assert room.bench.picture.sentence.startswith("Paused")
    room.press("navTrain")
    assert room.button("pauseBatch").text() == "Go on"


def test_a_window_without_a_virtual_operator_has_a_training_too(qtbot, cell, room):
    window = MainWindow(cell, None, lambda: 0.0, room.controls, NoTrainer())
    qtbot.addWidget(window)
    assert window.findChild(QWidget, "navTrain") is not None
    window.close()
