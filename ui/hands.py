"""Presses the window from another thread, as events of Qt's own queue: to measure a press."""

from collections.abc import Callable

from PySide6.QtCore import QCoreApplication, QEvent, QMetaObject, QObject, QPointF, Qt, Signal
from PySide6.QtGui import QKeyEvent, QMouseEvent
from PySide6.QtWidgets import QMessageBox

from gestureapp.clock import monotonic
from ui.main_window import MainWindow
from ui.stop_slab import StopButton


class Hands:
    """Posts what a mouse would. Any thread: Qt's event queue takes events from all."""

    def __init__(self, window: MainWindow) -> None:
        self._window = window
        button = window.findChild(StopButton, "stopButton")
        if not isinstance(button, StopButton):
            raise LookupError("the window has no STOP")
        self._button = button
        self._dialog: QMessageBox | None = None
        self._calls = _Calls()
        self._calls.moveToThread(window.thread())

    def press_stop(self) -> float:
        """Press and release STOP. Returns when the press was posted, monotonic seconds."""
        place = QPointF(20.0, 20.0)
        posted_s = monotonic()
        for kind in (QEvent.Type.MouseButtonPress, QEvent.Type.MouseButtonRelease):
            left, none = Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier
            event = QMouseEvent(kind, place, place, left, left, none)
            QCoreApplication.postEvent(self._button, event)
        return posted_s

    def press_stop_key(self) -> float:
        """Press Esc where a person's keyboard would go. Returns when it was posted."""
        dialog = self._dialog
        target = (self._window if dialog is None else dialog).windowHandle()
        posted_s = monotonic()
        none = Qt.KeyboardModifier.NoModifier
        for kind in (QEvent.Type.KeyPress, QEvent.Type.KeyRelease):
            QCoreApplication.postEvent(target, QKeyEvent(kind, Qt.Key.Key_Escape, none))
        return posted_s

    def open_dialog(self, text: str) -> None:
        """Open a modal dialog with its own event loop before the window."""
        self.call(lambda: self._show_dialog(text))

    def close_dialog(self) -> None:
        """Close it; nothing when there is none."""
        self.call(lambda: self._dialog.accept() if self._dialog is not None else None)

    def call(self, work: Callable[[], None]) -> None:
        """Have the window's thread do this, between two events."""
        self._calls.wanted.emit(work)

    def close(self) -> None:
        """Close the window."""
        QMetaObject.invokeMethod(self._window, "close", Qt.ConnectionType.QueuedConnection)

    def _show_dialog(self, text: str) -> None:
        dialog = QMessageBox(QMessageBox.Icon.Information, "", text, parent=self._window)
        self._dialog = dialog
        dialog.exec()
        self._dialog = None
        dialog.deleteLater()


class _Calls(QObject):
    """Carries work into the window's thread."""

    wanted = Signal(object)

    def __init__(self) -> None:
        super().__init__()
        self.wanted.connect(self._do, Qt.ConnectionType.QueuedConnection)

    def _do(self, work: Callable[[], None]) -> None:
        work()
