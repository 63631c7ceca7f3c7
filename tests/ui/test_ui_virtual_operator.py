"""The virtual operator: each button and each key moves the arms as it says."""

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeySequence, QShortcut
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QLabel, QPushButton, QWidget

from gestureapp.gestures import LABELS
from ui.main_window import MainWindow
from ui.virtual_operator import GESTURE_KEYS, HOW

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
    assert len(words) == len(set(words)) == len(BUTTONS)
    reserved = {QKeySequence(key).toString() for key in ("Esc", "Pause", "Space", "Return")}
    assert reserved.isdisjoint(words)


def test_every_gesture_has_a_key():
    assert set(GESTURE_KEYS) == set(LABELS)


def test_the_panel_says_how_a_gesture_is_made_and_what_the_arms_do(qtbot, window, operator):
    assert window.findChild(QLabel, "virtualOperatorHow").text() == HOW
    operator.left_start()
    window.poll()
    assert window.findChild(QLabel, "virtualOperatorDoing").text() == "last asked: left_start"


def test_there_is_no_panel_without_a_virtual_operator(qtbot, cell):
    window = MainWindow(cell)
    qtbot.addWidget(window)
    assert window.findChild(QWidget, "virtualOperatorPanel") is None
    window.close()
