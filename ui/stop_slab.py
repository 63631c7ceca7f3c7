"""The STOP slab and its keys: the way from a finger to the cell with nothing in between."""

from collections.abc import Callable

from PySide6.QtCore import QEvent, QObject, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QFont, QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import (
    QAbstractButton,
    QApplication,
    QLabel,
    QSizePolicy,
    QVBoxLayout,
    QWidget,
)

from ui.theme import SMALL_PX, sized

WHAT_IT_IS = "Not an emergency stop. Use the red button on the pendant or fence."
"""Always under the slab. The one place where these words belong."""
_PRESSES = (QEvent.Type.MouseButtonPress, QEvent.Type.MouseButtonDblClick)
STOP_KEYS = (Qt.Key.Key_Escape, Qt.Key.Key_Pause)

# Dark, square and without yellow: it must not be taken for the red button of the hardware circuit.
_REST, _DOWN, _RIM = QColor("#7d1510"), QColor("#4f0b08"), QColor("#ffffff")


class StopButton(QAbstractButton):
    """A rectangular slab that stops on press, with any mouse button, always enabled.

    It takes no focus, so that no key but the documented ones presses it by chance.

    Signals:
        pressed: The stop is wanted, now.
    """

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("stopButton")
        self.setText("STOP")
        self.setAccessibleName("STOP the robot")
        self.setAccessibleDescription(f"Acts on press. Keys: Esc, Pause. {WHAT_IT_IS}")
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)

    def sizeHint(self) -> QSize:
        """Wide enough for the word in letters that can be read across the cell."""
        return QSize(200, 300)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Stop, whichever button it was."""
        if event.button() is Qt.MouseButton.LeftButton:
            super().mousePressEvent(event)
        else:
            self.pressed.emit()
            event.accept()

    def changeEvent(self, event: QEvent) -> None:
        """Stay enabled, whatever is done to the window around it."""
        if event.type() is QEvent.Type.EnabledChange and not self.isEnabled():
            self.setEnabled(True)
        super().changeEvent(event)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw slab, rim and word."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.fillRect(self.rect(), _DOWN if self.isDown() else _REST)
        rim = QRectF(self.rect()).adjusted(7, 7, -7, -7)
        painter.setPen(QPen(_RIM, 4, j=Qt.PenJoinStyle.MiterJoin))
        painter.drawRect(rim)
        font = QFont(self.font())
        font.setBold(True)
        font.setPixelSize(max(24, int(self.width() * 0.26)))
        painter.setFont(font)
        painter.drawText(self.rect(), Qt.AlignmentFlag.AlignCenter, self.text())
        font.setPixelSize(SMALL_PX + 2)
        font.setBold(False)
        painter.setFont(font)
        keys = rim.adjusted(0, 0, 0, -14)
        painter.drawText(
            keys, Qt.AlignmentFlag.AlignHCenter | Qt.AlignmentFlag.AlignBottom, "Esc or Pause"
        )
        painter.end()


class StopSlab(QWidget):
    """The slab with the line under it that says what it is not.

    Attributes:
        button: The slab itself.
    """

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.button = StopButton()
        note = QLabel(WHAT_IT_IS)
        note.setObjectName("stopNote")
        note.setWordWrap(True)
        note.setAlignment(Qt.AlignmentFlag.AlignHCenter)
        sized(note, SMALL_PX + 1)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.button, 1)
        layout.addWidget(note)


class StopKeys(QObject):
    """Makes Esc and Pause stop from anywhere in the application, dialogs and menus included.

    A filter on the application, because a shortcut is silent while a modal dialog is open. The keys
    go no further, so that nothing can take them away. Neither can an open list or menu take away a
    press on the slab, which else would only close it. Owned by the window.

    Args:
        stop: Stops.
        slab: A press over it stops.
        parent: Qt's.
    """

    def __init__(self, stop: Callable[[], None], slab: QWidget, parent: QObject) -> None:
        super().__init__(parent)
        self._stop, self._slab = stop, slab

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Take the two keys, and a press over the slab, out of the stream of events."""
        if event.type() in _PRESSES and isinstance(event, QMouseEvent):
            return self._press(event)
        if event.type() is not QEvent.Type.KeyPress or not isinstance(event, QKeyEvent):
            return False
        if event.key() not in STOP_KEYS:
            return False
        if not event.isAutoRepeat():
            self._stop()
        return True

    def _press(self, event: QMouseEvent) -> bool:
        if QApplication.activePopupWidget() is None or not self._slab.isVisible():
            return False
        at = self._slab.mapFromGlobal(event.globalPosition().toPoint())
        if not self._slab.rect().contains(at):
            return False
        self._stop()
        while (popup := QApplication.activePopupWidget()) is not None and popup.close():
            pass
        return True
