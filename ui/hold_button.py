"""A button that acts only after it was held: for what must not happen by a brush of the hand."""

from PySide6.QtCore import QEvent, QRectF, QSize, Qt, QTimer, Signal
from PySide6.QtGui import (
    QColor,
    QFocusEvent,
    QHideEvent,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
)
from PySide6.QtWidgets import QPushButton, QStyle, QStyleOptionButton, QWidget

from gestureapp.clock import Clock, monotonic
from ui.theme import colours_of

HOLD_S = 1.0
"""Long enough not to happen by a brush of the hand, short enough not to be a nuisance."""
_TICK_MS = 20
_LONGEST_STEP_S = 0.1
"""A stalled window must not count the stall as holding: the release may still wait in the queue."""
_KEYS = (Qt.Key.Key_Space, Qt.Key.Key_Return, Qt.Key.Key_Enter)


class HoldButton(QPushButton):
    """Filled by holding it for a second, with the mouse or with Space or Enter.

    Letting go, leaving it with the pointer, losing the focus or being disabled empties it again.

    Attributes:
        progress: How far it is filled, 0 to 1.
        is_held: It was held long enough and has not been let go since.

    Signals:
        held: It was held long enough; once per hold.
        let_go: What was held long enough is held no longer, however that came; once per ``held``.
    """

    held = Signal()
    let_go = Signal()

    def __init__(self, text: str, clock: Clock = monotonic, parent: QWidget | None = None) -> None:
        super().__init__(text, parent)
        self.progress = 0.0
        self.is_held = False
        self._clock = clock
        self._last_s = 0.0
        self._timer = QTimer(self, interval=_TICK_MS)
        self._timer.setTimerType(Qt.TimerType.PreciseTimer)
        self._timer.timeout.connect(self._advance)
        self.setAutoDefault(False)

    def sizeHint(self) -> QSize:
        """Larger than a usual button: it is the one that is looked for."""
        hint = super().sizeHint()
        return QSize(hint.width() + 40, max(hint.height(), 56))

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Begin to fill."""
        super().mousePressEvent(event)
        if self.isDown():
            self._begin()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Empty when the pointer leaves."""
        super().mouseMoveEvent(event)
        if not self.rect().contains(event.position().toPoint()):
            self._cancel()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Empty."""
        super().mouseReleaseEvent(event)
        self._cancel()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Begin to fill with the first press; the keyboard's repeats are not presses."""
        if event.key() not in _KEYS:
            super().keyPressEvent(event)
        elif not event.isAutoRepeat():
            self._begin()

    def keyReleaseEvent(self, event: QKeyEvent) -> None:
        """Empty at the true release."""
        if event.key() not in _KEYS:
            super().keyReleaseEvent(event)
        elif not event.isAutoRepeat():
            self._cancel()

    def focusOutEvent(self, event: QFocusEvent) -> None:
        """Empty."""
        self._cancel()
        super().focusOutEvent(event)

    def hideEvent(self, event: QHideEvent) -> None:
        """Empty."""
        self._cancel()
        super().hideEvent(event)

    def changeEvent(self, event: QEvent) -> None:
        """Empty when it is disabled."""
        super().changeEvent(event)
        if event.type() is QEvent.Type.EnabledChange and not self.isEnabled():
            self._cancel()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the button, the filling and the text over it."""
        option = QStyleOptionButton()
        self.initStyleOption(option)
        option.text = ""
        painter = QPainter(self)
        self.style().drawControl(QStyle.ControlElement.CE_PushButton, option, painter, self)
        colours = colours_of(self.palette())
        inner = QRectF(self.rect()).adjusted(3, 3, -3, -3)
        filling = 1.0 if self.is_held else self.progress
        if filling > 0:
            filled = QRectF(inner)
            filled.setWidth(inner.width() * filling)
            tint = QColor(colours.info)
            tint.setAlpha(150)
            painter.fillRect(filled, tint)
        if self.isEnabled():
            painter.setPen(QPen(QColor(colours.info), 2))
            painter.drawRect(inner)
        painter.setPen(self.palette().buttonText().color())
        painter.drawText(self.rect(), Qt.AlignmentFlag.AlignCenter, self.text())
        painter.end()

    def _begin(self) -> None:
        if not self._timer.isActive() and not self.is_held:
            self._last_s = self._clock()
            self._timer.start()

    def _cancel(self) -> None:
        self._timer.stop()
        if self.progress:
            self.progress = 0.0
            self.update()
        if self.is_held:
            self.is_held = False
            self.update()
            self.let_go.emit()

    def _advance(self) -> None:
        if not self.isEnabled():
            self._cancel()
            return
        now_s = self._clock()
        step_s = min(now_s - self._last_s, _LONGEST_STEP_S)
        self._last_s = now_s
        self.progress = min(1.0, self.progress + step_s / HOLD_S)
        self.update()
        if self.progress >= 1.0:
            self._timer.stop()
            self.progress = 0.0
            self.is_held = True
            self.held.emit()
