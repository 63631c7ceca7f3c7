"""The button that has to be held."""

import pytest
from PySide6.QtCore import QEvent, QPoint, QPointF, Qt
from PySide6.QtGui import QFocusEvent, QKeyEvent, QMouseEvent
from PySide6.QtWidgets import QApplication

from ui.hold_button import HoldButton


@pytest.fixture
def button(qtbot, clock):
    button = HoldButton("Hold", clock)
    qtbot.addWidget(button)
    button.show()
    return button


@pytest.fixture
def held(button) -> list[str]:
    heard: list[str] = []
    button.held.connect(lambda: heard.append("held"))
    return heard


def test_holding_with_the_mouse_acts_once(qtbot, button, held):
    qtbot.mousePress(button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: bool(held), timeout=5000)
    assert button.progress == 0.0
    qtbot.mouseRelease(button, Qt.MouseButton.LeftButton)
    assert held == ["held"]


@pytest.mark.parametrize("key", [Qt.Key.Key_Space, Qt.Key.Key_Return, Qt.Key.Key_Enter])
def test_holding_with_the_keyboard_acts_once(qtbot, button, held, key):
    qtbot.keyPress(button, key)
    qtbot.waitUntil(lambda: bool(held), timeout=5000)
    qtbot.keyRelease(button, key)
    assert held == ["held"]


def test_a_keyboard_that_repeats_is_still_one_hold(qtbot, button, held):
    def send(kind: QEvent.Type) -> None:
        none = Qt.KeyboardModifier.NoModifier
        event = QKeyEvent(kind, Qt.Key.Key_Space, none, " ", autorep=True)
        QApplication.sendEvent(button, event)

    qtbot.keyPress(button, Qt.Key.Key_Space)
    qtbot.waitUntil(lambda: button.progress > 0.3, timeout=5000)
    send(QEvent.Type.KeyRelease)
    send(QEvent.Type.KeyPress)
    assert button.progress > 0.3
    qtbot.waitUntil(lambda: bool(held), timeout=5000)
    assert held == ["held"]


def half_filled(qtbot, button) -> None:
    qtbot.mousePress(button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: 0.3 < button.progress < 1.0, timeout=5000)


def test_letting_go_early_empties_it(qtbot, button, held):
    half_filled(qtbot, button)
    qtbot.mouseRelease(button, Qt.MouseButton.LeftButton)
    assert button.progress == 0.0
    assert held == []


def test_leaving_it_with_the_pointer_empties_it(qtbot, button, held):
    half_filled(qtbot, button)
    qtbot.mouseMove(button, QPoint(-20, -20))
    qtbot.waitUntil(lambda: button.progress == 0.0, timeout=5000)
    assert held == []


def test_losing_the_focus_empties_it(qtbot, button, held):
    half_filled(qtbot, button)
    QApplication.sendEvent(button, QEvent(QEvent.Type.Hide))
    button.hide()
    assert button.progress == 0.0
    assert held == []


def test_being_disabled_empties_it(qtbot, button, held):
    half_filled(qtbot, button)
    button.setEnabled(False)
    qtbot.waitUntil(lambda: button.progress == 0.0, timeout=5000)
    assert held == []


def test_a_short_click_does_nothing(qtbot, button, held):
    qtbot.mouseClick(button, Qt.MouseButton.LeftButton)
    assert held == []


def test_a_window_that_stalled_does_not_count_the_stall_as_holding(qtbot, button, held, clock):
    qtbot.mousePress(button, Qt.MouseButton.LeftButton)
    clock.now_s += 30.0
    qtbot.waitUntil(lambda: button.progress > 0.0, timeout=5000)
    assert button.progress < 0.5
    assert held == []


@pytest.fixture
def let_go(button) -> list[str]:
    heard: list[str] = []
    button.let_go.connect(lambda: heard.append("let go"))
    return heard


def hold_down(qtbot, button, held) -> None:
    qtbot.mousePress(button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: bool(held), timeout=5000)
    assert button.is_held


@pytest.mark.parametrize("how", ["release", "leave", "hide", "disable", "focus"])
def test_whatever_ends_the_hold_is_told_once(qtbot, button, held, let_go, how):
    hold_down(qtbot, button, held)
    assert let_go == []
    match how:
        case "release":
            qtbot.mouseRelease(button, Qt.MouseButton.LeftButton)
        case "leave":
            qtbot.mouseMove(button, QPoint(-20, -20))
            event = QMouseEvent(
                QEvent.Type.MouseMove,
                QPointF(-20, -20),
                QPointF(-20, -20),
                Qt.MouseButton.NoButton,
                Qt.MouseButton.LeftButton,
                Qt.KeyboardModifier.NoModifier,
            )
            QApplication.sendEvent(button, event)
        case "hide":
            button.hide()
        case "disable":
            button.setEnabled(False)
        case "focus":
            QApplication.sendEvent(button, QFocusEvent(QEvent.Type.FocusOut))
    assert let_go == ["let go"]
    assert not button.is_held
    qtbot.mouseRelease(button, Qt.MouseButton.LeftButton)
    assert let_go == ["let go"]
    assert held == ["held"]


def test_letting_go_too_early_tells_nothing(qtbot, button, held, let_go):
    half_filled(qtbot, button)
    qtbot.mouseRelease(button, Qt.MouseButton.LeftButton)
    assert (held, let_go) == ([], [])
