"""The setup's page: the way to it, its steps, and what it locks."""

from dataclasses import replace

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QAbstractButton, QApplication, QComboBox, QLabel, QPushButton

from gestureapp.cell.snapshot import Blocker, CellState
from gestureapp.sensing.values import LinkState, Side
from gestureapp.setup.values import CalibrationView, Position, Remedy
from tests.ui.setup_bench import SetupRoom, card, six
from ui.labels import ElidedLabel

SIZES = [(1280, 720), (1366, 768), (1920, 1080)]
STEPS = ("Sensors", "Calibrate", "Robot", "Settings", "People")
OWN = ("Sensors", "Calibrate")
LONG = "the calibration is 203 days old, 180 are allowed"


@pytest.fixture
def room(qtbot, cell):
    room = SetupRoom(cell)
    qtbot.addWidget(room.window)
    yield room
    room.window.close()


def test_arming_is_locked_for_as_long_as_the_setup_is_open(room):
    room.press("navSetup")
    assert room.setup.is_open
    assert room.widget("setupPage").isVisible()
    room.press("navSetup")
    assert room.setup.calls == ["setup open"], "it is open already"
    room.press("navOperate")
    assert room.setup.calls == ["setup open", "setup closed"]


def test_the_strip_says_that_arming_is_locked(room):
    room.enter()
    lock = Blocker("setup", "setup is open", "go back to Operate")
    room.cell.shown = replace(room.cell.shown, blockers=(lock,), state=CellState.NOT_READY)
    room.look()
    assert room.text("stripLine").startswith("Setup is open: arming is locked")


@pytest.mark.parametrize("state", CellState)
def test_the_setup_opens_only_while_the_robot_is_at_rest(room, state):
    room.cell.shown = replace(room.cell.shown, state=state)
    room.look()
    is_at_rest = state not in (CellState.ACTIVATED, CellState.MOVING, CellState.STOPPING)
    entry = room.button("navSetup")
    assert (entry.note == "") is is_at_rest
    QTest.mouseClick(entry, Qt.MouseButton.LeftButton)
    assert room.setup.is_open is is_at_rest


def test_a_step_says_what_is_wrong_with_it(room):
    room.enter()
    assert "2 of 2 receiving" in room.button("setupStepSensors").accessibleName()
    room.show(left=card(Side.LEFT, LinkState.NO_DATA, problem="not calibrated"))
    assert "1 of 2 receiving" in room.button("setupStepSensors").accessibleName()
    assert "left: not calibrated" in room.button("setupStepCalibrate").accessibleName()


def test_trouble_is_said_across_the_window(room):
    room.enter()
    room.show(trouble="The sensors' records cannot be written: the disk is full")
    assert "disk is full" in room.text("pageNotice")
    room.press("navOperate")
    assert room.text("pageNotice") == ""


def worst(room: SetupRoom) -> None:
    """As much to say as there may be."""
    advice = ("Switch the sensor on; its lamp blinks.", "Pair it.", "Join the group dialout.")
    problem = {"problem": LONG, "remedy": "calibrate it: six positions, a minute"}
    act = Remedy.CALIBRATE
    room.show(
        left=card(
            Side.LEFT,
            LinkState.WRONG_DATA,
            name="BWT901CL " * 9,
            advice=advice,
            bad_bytes="55 51 " * 16,
        ),
        right=card(Side.RIGHT, act=act, **problem),
        calibration=CalibrationView(
            Side.RIGHT, True, "Turn it onto its left edge, and let go", six(2), Position.X_UP
        ),
    )


@pytest.mark.parametrize("size", SIZES, ids=str)
def test_both_steps_fit_without_clipping(qtbot, cell, operator, size):
    room = SetupRoom(cell, operator)
    qtbot.addWidget(room.window)
    room.enter()
    room.window.resize(*size)
    qtbot.waitUntil(lambda: (room.window.width(), room.window.height()) == size)
    worst(room)
    for step in OWN:
        room.press(f"setupStep{step}")
        worst(room)
        area = room.widget("workArea")
        assert area.widget().width() <= area.viewport().width(), step
        assert area.widget().height() <= area.viewport().height(), step
        for each in room.window.findChildren(QPushButton):
            wide = max(each.fontMetrics().horizontalAdvance(t) for t in each.text().split("\n"))
            assert not each.isVisible() or each.width() >= wide, each.objectName()
        for label in room.widget("setupPage").findChildren(QLabel):
            if label.isVisible() and label.objectName() and not label.wordWrap():
                wide = label.fontMetrics().horizontalAdvance(label.text())
                elides = isinstance(label, ElidedLabel)
                assert elides or label.width() >= wide, label.objectName()
            elif label.isVisible() and label.hasHeightForWidth():
                high = label.heightForWidth(label.width())
                assert label.height() >= high, (label.objectName(), label.text())
    room.window.close()


def test_every_widget_has_a_name_for_tests_and_for_people(room):
    room.enter()
    kinds = (QAbstractButton, QComboBox)
    for step in STEPS:
        room.press(f"setupStep{step}")
        page = room.widget("setupPage")
        for each in [found for kind in kinds for found in page.findChildren(kind)]:
            if each.isVisible() and not each.objectName().startswith("qt_"):
                assert each.objectName(), (step, each)
                assert each.accessibleName(), (step, each.objectName())
    names = [each.objectName() for each in room.window.findChildren(QAbstractButton)]
    own = [name for name in names if name and not name.startswith("qt_")]
    assert len(own) == len(set(own))


def test_space_presses_nothing_after_a_step_has_changed(room):
    room.enter()
    for step in STEPS:
        room.press(f"setupStep{step}")
        room.setup.calls.clear()
        QTest.keyClick(QApplication.focusWidget() or room.window, Qt.Key.Key_Space)
        room.look()
        assert room.setup.calls == []
        assert not isinstance(QApplication.focusWidget(), QAbstractButton)


def test_every_button_of_a_step_is_reached_and_pressed_by_keyboard(room):
    room.enter()
    room.window.activateWindow()
    assert QTest.qWaitForWindowActive(room.window, 5000)
    reached = []
    for _ in range(40):
        QTest.keyClick(QApplication.focusWidget() or room.window, Qt.Key.Key_Tab)
        reached.append(QApplication.focusWidget().objectName())
    inside = ["leftPort", "leftProtocol", "leftTestLink", "rightPort", "rightTestLink"]
    foot = ["findSensors", "assignByShaking", "swapSensors"]
    places = [reached.index(name) for name in [*inside, *foot]]
    assert places == sorted(places), "in the order they are read"
    room.button("swapSensors").setFocus(Qt.FocusReason.TabFocusReason)
    QTest.keyClick(room.button("swapSensors"), Qt.Key.Key_Space)
    assert room.setup.calls == ["swap_sensors"]
