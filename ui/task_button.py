"""A large entry of a list of tasks: mark, title, and below it how it stands."""

from PySide6.QtCore import QRectF, QSize, Qt
from PySide6.QtGui import QColor, QFont, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QAbstractButton, QSizePolicy, QWidget

from ui.marks import Level, paint_mark
from ui.theme import LARGE_PX, TEXT_PX, colours_of

_MARK_PX = 18
_LEFT_PX = 42


class TaskButton(QAbstractButton):
    """Chosen like one of several. GUI thread only.

    Args:
        name: objectName.
        title: The task.
        parent: Qt's.
    """

    def __init__(self, name: str, title: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._level, self._state = Level.OFF, ""
        self.setObjectName(name)
        self.setText(title)
        self.setAccessibleName(title)
        self.setCheckable(True)
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Preferred)

    @property
    def state(self) -> str:
        """How the task stands, as shown."""
        return self._state

    def show_title(self, title: str) -> None:
        """Call the task otherwise."""
        if title != self.text():
            self.setText(title)
            self.setAccessibleName(f"{title}: {self._state}" if self._state else title)

    def show_state(self, level: Level, state: str) -> None:
        """Show how the task stands."""
        if (level, state) == (self._level, self._state):
            return
        self._level, self._state = level, state
        self.setAccessibleName(f"{self.text()}: {state}")
        self.update()

    def sizeHint(self) -> QSize:
        """Title and three lines."""
        return QSize(230, 100)

    def minimumSizeHint(self) -> QSize:
        """Title and two lines."""
        return QSize(180, 76)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw ground, mark, title and state."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        colours = colours_of(self.palette())
        area = QRectF(self.rect()).adjusted(0.5, 0.5, -0.5, -0.5)
        painter.fillRect(area, QColor(colours.base if self.isChecked() else colours.panel))
        painter.setPen(QPen(QColor(colours.line), 1))
        painter.drawRect(area)
        if self.isChecked():
            painter.fillRect(QRectF(0, 0, 5, self.height()), QColor(colours.info))
        if self.hasFocus():
            painter.setPen(QPen(QColor(colours.info), 1, Qt.PenStyle.DotLine))
            painter.drawRect(area.adjusted(2, 2, -2, -2))
        paint_mark(painter, QRectF(14, 12, _MARK_PX, _MARK_PX), self._level, colours)
        font = QFont(self.font())
        font.setPixelSize(LARGE_PX)
        font.setBold(True)
        painter.setFont(font)
        painter.setPen(QColor(colours.text if self.isEnabled() else colours.muted))
        room = QRectF(_LEFT_PX, 8, self.width() - _LEFT_PX - 8, 26)
        painter.drawText(room, Qt.AlignmentFlag.AlignVCenter, self.text())
        font.setPixelSize(TEXT_PX)
        font.setBold(False)
        painter.setFont(font)
        below = QRectF(room.left(), room.bottom() + 2, room.width(), self.height() - 40)
        flags = Qt.AlignmentFlag.AlignTop | Qt.TextFlag.TextWordWrap
        painter.drawText(below, flags, self._state)
        painter.end()
