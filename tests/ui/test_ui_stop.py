"""STOP by mouse and key, from everywhere, whatever the state."""

from dataclasses import replace

import pytest
from PySide6.QtCore import QObject, QPoint, Qt, QTimer, Signal
from PySide6.QtTest import QTest
from PySide6.QtWidgets import (
    QApplication,
    QComboBox,
    QDialog,
    QLineEdit,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from gestureapp.cell.snapshot import CellState
from ui.stop_slab import WHAT_IT_IS, StopButton


def stop_button(window) -> StopButton:
    button = window.findChild(StopButton, "stopButton")
    assert button is not None
    return button


def test_stop_acts_on_press_not_on_release(qtbot, window, cell):
    qtbot.mousePress(stop_button(window), Qt.MouseButton.LeftButton)
    assert cell.calls == ["stop"]
    qtbot.mouseRelease(stop_button(window), Qt.MouseButton.LeftButton)
    assert cell.calls == ["stop"]


def test_an_open_list_does_not_take_the_press_away(qtbot, window, cell):
    combo = QComboBox(window)
    combo.addItems(["one", "two"])
    combo.show()
    combo.showPopup()
    popup = QApplication.activePopupWidget()
    assert popup is not None
    slab = stop_button(window)
    beside = popup.mapFromGlobal(slab.mapToGlobal(slab.rect().topLeft()) - QPoint(20, -40))
    over = popup.mapFromGlobal(slab.mapToGlobal(slab.rect().center()))
    QTest.mousePress(popup, Qt.MouseButton.LeftButton, pos=beside)
    assert cell.calls == []
    combo.showPopup()
    QTest.mousePress(popup, Qt.MouseButton.LeftButton, pos=over)
    assert cell.calls == ["stop"]
    assert QApplication.activePopupWidget() is None
    assert combo.currentText() == "one"


@pytest.mark.parametrize("button", [Qt.MouseButton.RightButton, Qt.MouseButton.MiddleButton])
def test_stop_takes_any_mouse_button(qtbot, window, cell, button):
    qtbot.mousePress(stop_button(window), button)
    assert cell.calls == ["stop"]


def test_stop_is_visible_and_enabled_in_every_state(window, cell):
    for state in CellState:
        cell.shown = replace(cell.shown, state=state, can_arm=False)
        window.poll()
        assert stop_button(window).isVisible()
        assert stop_button(window).isEnabled()


def test_stop_cannot_be_disabled(window):
    stop_button(window).setEnabled(False)
    assert stop_button(window).isEnabled()


@pytest.mark.parametrize("size", [(900, 500), (1366, 768), (1920, 1080)])
def test_stop_takes_a_sixth_of_the_width_and_stays_in_sight(qtbot, window, size):
    window.resize(*size)
    qtbot.waitUntil(lambda: window.width() == size[0])
    QApplication.processEvents()
    slab = stop_button(window)
    assert slab.width() * 6 >= window.width()
    corner = slab.mapTo(window, slab.rect().bottomRight())
    assert window.rect().contains(corner)
    assert slab.visibleRegion().boundingRect() == slab.rect()


def test_what_stop_is_not_stands_under_it_in_every_state(window):
    note = window.findChild(QWidget, "stopNote")
    assert note.isVisible()
    assert note.text() == WHAT_IT_IS
    slab = stop_button(window)
    assert (
        note.mapTo(window, note.rect().topLeft()).y()
        > slab.mapTo(window, slab.rect().bottomLeft()).y()
    )


@pytest.mark.parametrize("key", [Qt.Key.Key_Escape, Qt.Key.Key_Pause])
def test_keys_stop_whatever_has_the_focus(qtbot, window, cell, key):
    for child in window.findChildren(QPushButton):
        cell.calls.clear()
        qtbot.keyClick(child, key)
        assert cell.calls == ["stop"], child.objectName()


@pytest.mark.parametrize("key", [Qt.Key.Key_Escape, Qt.Key.Key_Pause])
def test_keys_stop_once_when_they_come_through_the_window_system(qtbot, window, cell, key):
    qtbot.keyClick(window.windowHandle(), key)
    assert cell.calls == ["stop"]


def test_keys_stop_from_a_modal_dialog_with_a_text_field(qtbot, window, cell):
    dialog = QDialog(window)
    field = QLineEdit()
    QVBoxLayout(dialog).addWidget(field)
    seen: list[list[str]] = []

    def press() -> None:
        qtbot.keyClick(field, Qt.Key.Key_Escape)
        seen.append(list(cell.calls))
        dialog.accept()

    QTimer.singleShot(0, press)
    dialog.exec()
    assert seen == [["stop"]]


def test_space_does_not_stop(qtbot, window, cell):
    qtbot.keyClick(window, Qt.Key.Key_Space)
    assert "stop" not in cell.calls


class Emitter(QObject):
    fired = Signal(bool)


def test_some_thousands_of_signal_emits_are_survived(window, cell):
    # One release of the Qt binding lost a reference at each emit and aborted after some 570.
    emitter = Emitter()
    heard: list[bool] = []
    emitter.fired.connect(heard.append)
    for _ in range(5000):
        emitter.fired.emit(True)
        stop_button(window).pressed.emit()
    assert len(heard) == 5000
    assert cell.calls == ["stop"] * 5000
