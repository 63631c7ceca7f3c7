"""Presses the window from another thread, as events of Qt's own queue: to measure a press."""

from PySide6.QtCore import QCoreApplication, QEvent, QMetaObject, QPointF, Qt
from PySide6.QtGui import QMouseEvent

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

    def press_stop(self) -> float:
        """Press and release STOP. Returns when the press was posted, monotonic seconds."""
        place = QPointF(20.0, 20.0)
        posted_s = monotonic()
        for kind in (QEvent.Type.MouseButtonPress, QEvent.Type.MouseButtonRelease):
            left, none = Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier
            event = QMouseEvent(kind, place, place, left, left, none)
            QCoreApplication.postEvent(self._button, event)
        return posted_s

    def close(self) -> None:
        """Close the window."""
        QMetaObject.invokeMethod(self._window, "close", Qt.ConnectionType.QueuedConnection)
