"""The virtual operator: each button and each key moves the arms as it says."""

from dataclasses import replace

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QKeySequence, QShortcut
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QLabel, QPushButton, QWidget

from gestureapp.gestures import LABELS
from gestureapp.guided.values import GuidedSnapshot, Pace, Phase, Trying
from gestureapp.simulation.prompts import NOTHING, Prompt
from ui.main_window import MainWindow
from ui.prompts import prompt_of
from ui.virtual_operator import GESTURE_KEYS, HOW, VirtualOperatorPanel

BUTTONS = {
    "leftStart": "left_start",
    "leftStop": "left_stop",
    "rightRest": "right_rest",
    "silenceLeft": "silence_left",
    "restoreSensors": "restore_sensors",
    **{f"gesture_{label}": label for label in LABELS},
}


def test_each_button_does_one_thing(qtbot, window, operator):
    for name, done in BUTTONS.items():
        operator.done.clear()
        qtbot.mouseClick(window.findChild(QPushButton, name), Qt.MouseButton.LeftButton)
        assert operator.done == [done]


def test_keys_do_what_the_buttons_do(qtbot, window, operator):
    window.activateWindow()
    assert QTest.qWaitForWindowActive(window, 5000)
    plain, control = Qt.KeyboardModifier.NoModifier, Qt.KeyboardModifier.ControlModifier
    for key, modifier, done in (
        (Qt.Key.Key_S, plain, "left_start"),
        (Qt.Key.Key_A, plain, "left_stop"),
        (Qt.Key.Key_D, plain, "right_rest"),
        (Qt.Key.Key_F, plain, "silence_left"),
        (Qt.Key.Key_G, plain, "restore_sensors"),
        (Qt.Key.Key_Up, plain, "X+"),
        (Qt.Key.Key_Down, plain, "X-"),
        (Qt.Key.Key_Left, plain, "Y+"),
        (Qt.Key.Key_Right, plain, "Y-"),
        (Qt.Key.Key_PageUp, plain, "Z+"),
        (Qt.Key.Key_PageDown, plain, "Z-"),
        (Qt.Key.Key_Right, control, "RX+"),
        (Qt.Key.Key_Left, control, "RX-"),
        (Qt.Key.Key_Up, control, "RY+"),
        (Qt.Key.Key_Down, control, "RY-"),
        (Qt.Key.Key_PageUp, control, "RZ+"),
        (Qt.Key.Key_PageDown, control, "RZ-"),
    ):
        operator.done.clear()
        qtbot.keyClick(window, key, modifier)
        assert operator.done == [done]


def test_no_key_is_taken_twice_and_none_of_the_reserved_ones(window):
    taken = [shortcut.key() for shortcut in window.findChildren(QShortcut)]
    words = [key.toString() for key in taken]
    assert len(words) == len(set(words)) == len(BUTTONS) + 1
    assert "T" in words
    reserved = {QKeySequence(key).toString() for key in ("Esc", "Pause", "Space", "Return")}
    assert reserved.isdisjoint(words)


def test_every_gesture_has_a_key():
    assert set(GESTURE_KEYS) == set(LABELS)


def test_the_panel_says_how_a_gesture_is_made_and_what_the_arms_do(qtbot, window, operator):
    assert window.findChild(QLabel, "virtualOperatorHow").text() == HOW
    operator.left_start()
    window.poll()
    assert window.findChild(QLabel, "virtualOperatorDoing").text() == "last asked: left_start"


@pytest.fixture
def panel(qtbot, operator) -> VirtualOperatorPanel:
    panel = VirtualOperatorPanel(operator)
    qtbot.addWidget(panel)
    return panel


def press(panel: VirtualOperatorPanel, name: str) -> None:
    panel.findChild(QPushButton, name).click()


ASKING = GuidedSnapshot(phase=Phase.WAITING, label="RZ+")


def test_the_arms_follow_the_prompts_only_while_the_button_is_down(panel, operator):
    panel.refresh(ASKING)
    assert operator.done == []
    press(panel, "followPrompts")
    panel.refresh(ASKING)
    panel.refresh(None)
    press(panel, "followPrompts")
    panel.refresh(ASKING)
    assert operator.done == ["follow RZ+", "follow nothing", "follow nothing"]


def test_moving_an_arm_by_hand_ends_the_following(panel, operator):
    press(panel, "followPrompts")
    press(panel, "leftStop")
    assert not panel.is_following
    assert operator.done == ["follow nothing", "left_stop"]


def test_a_sensor_that_falls_silent_ends_no_following(panel):
    press(panel, "followPrompts")
    press(panel, "silenceLeft")
    press(panel, "restoreSensors")
    assert panel.is_following


def test_a_person_is_asked_for_what_the_screen_shows():
    assert prompt_of(ASKING) == Prompt("RZ+", True)
    assert prompt_of(replace(ASKING, phase=Phase.TAKING)) == Prompt("RZ+")
    beat = replace(ASKING, pace=Pace.RHYTHM, next_beat_s=9.0, beat_s=2.0, phase=Phase.COUNT_IN)
    assert prompt_of(beat) == Prompt("RZ+", False, 9.0, 2.0)
    for phase in (Phase.CLOSED, Phase.IDLE, Phase.PAUSED, Phase.SENSOR_LOST):
        assert prompt_of(replace(ASKING, phase=phase)) == NOTHING
    trying = Trying(is_on=True, asked="Y-", n_done=4)
    assert prompt_of(GuidedSnapshot(trying=trying)) == Prompt("Y-", True, number=4, is_trial=True)


def test_there_is_no_panel_without_a_virtual_operator(qtbot, cell):
    window = MainWindow(cell)
    qtbot.addWidget(window)
    assert window.findChild(QWidget, "virtualOperatorPanel") is None
    window.close()
