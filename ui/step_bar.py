"""The steps of a page across its top, each with how far it is."""

from collections.abc import Callable, Mapping, Sequence
from enum import Enum
from typing import TypeVar

from PySide6.QtCore import QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QFont, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QAbstractButton, QButtonGroup, QHBoxLayout, QSizePolicy, QWidget

from ui.marks import Level, paint_mark
from ui.step_state import StepState
from ui.theme import SMALL_PX, colours_of

_Step = TypeVar("_Step", bound=Enum)
_HEIGHT_PX = 46
_NUMBER_PX = 24
_MARK_PX = 20


class StepButton(QAbstractButton):
    """Number, tick or triangle, the step's word, and below it how far it is. GUI thread only."""

    def __init__(self, name: str, word: str, number: int, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._number = number
        self._state = StepState(0, 0, "")
        self.setObjectName(name)
        self.setText(word)
        self.setAccessibleName(word)
        self.setCheckable(True)
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)

    @property
    def state(self) -> StepState:
        """How far it is, as shown."""
        return self._state

    def show_state(self, state: StepState) -> None:
        """Show how far it is; one with a barrier cannot be pressed and says why."""
        if state == self._state:
            return
        self._state = state
        self.setEnabled(not state.barrier)
        words = f"{self.text()}: {state.barrier or state.text}"
        self.setAccessibleName(words)
        self.setToolTip(words)
        self.update()

    def sizeHint(self) -> QSize:
        """Number, word and progress."""
        return QSize(140, _HEIGHT_PX)

    def minimumSizeHint(self) -> QSize:
        """The progress is elided below this."""
        return QSize(110, _HEIGHT_PX)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw ground, number, word and progress."""
        painter = QPainter(self)
        colours = colours_of(self.palette())
        area = QRectF(self.rect()).adjusted(0.5, 0.5, -0.5, -0.5)
        painter.fillRect(area, QColor(colours.base if self.isChecked() else colours.panel))
        painter.setPen(QPen(QColor(colours.line), 1))
        painter.drawRect(area)
        if self.isChecked():
            bar = QRectF(0, self.height() - 4, self.width(), 4)
            painter.fillRect(bar, QColor(colours.info))
        if self.hasFocus():
            painter.setPen(QPen(QColor(colours.info), 1, Qt.PenStyle.DotLine))
            painter.drawRect(area.adjusted(2, 2, -2, -2))
        self._draw_number(painter)
        left = _NUMBER_PX + 18
        room = QRectF(left, 4, self.width() - left - 4, self.height() - 10)
        colour = QColor(colours.text if self.isEnabled() else colours.muted)
        painter.setPen(colour)
        painter.setFont(self._font(16, is_bold=True))
        top = QRectF(room.left(), room.top(), room.width(), room.height() * 0.55)
        painter.drawText(top, Qt.AlignmentFlag.AlignVCenter, self.text())
        painter.setFont(self._font(SMALL_PX))
        painter.setPen(QColor(colours.muted))
        words = painter.fontMetrics().elidedText(
            self._state.text, Qt.TextElideMode.ElideRight, int(room.width())
        )
        below = QRectF(room.left(), top.bottom(), room.width(), room.height() * 0.45)
        painter.drawText(below, Qt.AlignmentFlag.AlignVCenter, words)
        painter.end()

    def _draw_number(self, painter: QPainter) -> None:
        colours = colours_of(self.palette())
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        if self._state.is_problem:
            top = (self.height() - _MARK_PX) / 2 - 1
            paint_mark(painter, QRectF(12, top, _MARK_PX, _MARK_PX), Level.ATTENTION, colours)
            painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)
            return
        disc = QRectF(10, (self.height() - _NUMBER_PX) / 2 - 1, _NUMBER_PX, _NUMBER_PX)
        is_done = self._state.is_done
        colour = QColor(colours.text if is_done else colours.muted)
        painter.setPen(QPen(colour, 1.6))
        painter.drawEllipse(disc)
        painter.setFont(self._font(15 if is_done else 13, is_bold=True))
        painter.drawText(
            disc, Qt.AlignmentFlag.AlignCenter, "\u2713" if is_done else str(self._number)
        )
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)

    def _font(self, size_px: int, is_bold: bool = False) -> QFont:
        font = QFont(self.font())
        font.setPixelSize(size_px)
        font.setBold(is_bold)
        return font


class StepBar(QWidget):
    """All steps, always in sight; the first is the one to begin with. GUI thread only.

    Args:
        name: Its objectName.
        steps: In their order; the value of each is its word.
        prefix: Of the buttons' objectNames, before the word.
        parent: Qt's.

    Signals:
        chosen: A person wants to go to this step.
    """

    chosen = Signal(Enum)

    def __init__(
        self, name: str, steps: Sequence[Enum], prefix: str, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.setObjectName(name)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(4)
        group = QButtonGroup(self)
        self._buttons: dict[Enum, StepButton] = {}
        for number, step in enumerate(steps, start=1):
            button = StepButton(f"{prefix}{step.value}", step.value, number)
            button.clicked.connect(self._chooser(step))
            group.addButton(button)
            layout.addWidget(button)
            self._buttons[step] = button
        self.show_step(steps[0])

    def show_step(self, step: Enum) -> None:
        """Mark the step in sight."""
        self._buttons[step].setChecked(True)

    def show_states(self, states: Mapping[_Step, StepState]) -> None:
        """Show how far each step is."""
        for step, state in states.items():
            self._buttons[step].show_state(state)

    def _chooser(self, step: Enum) -> Callable[[], None]:
        return lambda: self.chosen.emit(step)
