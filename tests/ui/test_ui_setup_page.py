"""The setup's page: the way to it, its steps, and what it locks."""

from dataclasses import replace

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from gestureapp.cell.snapshot import CellState
from gestureapp.sensing.values import LinkState, Side
from tests.ui.setup_bench import SetupRoom, card


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
    assert "disk is full" in room.text("trainNotice")
    room.press("navOperate")
    assert room.text("trainNotice") == ""
