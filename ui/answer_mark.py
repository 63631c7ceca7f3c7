"""A large sign for what came of a gesture: tick, cross or dash. Drawn, not loaded."""

from enum import Enum

from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QSizePolicy, QWidget

from ui.theme import colours_of


class Answer(Enum):
    """What came of it."""

    NONE = "nothing yet"
    RIGHT = "right"
    WRONG = "wrong"
    NOT_RECOGNISED = "not recognised"


_LINES: dict[Answer, tuple[tuple[tuple[float, float], ...], ...]] = {
    Answer.NONE: (),
    Answer.RIGHT: (((0.1, 0.55), (0.38, 0.82), (0.9, 0.18)),),
    Answer.WRONG: (((0.15, 0.15), (0.85, 0.85)), ((0.85, 0.15), (0.15, 0.85))),
    Answer.NOT_RECOGNISED: (((0.15, 0.5), (0.85, 0.5)),),
}


class AnswerMark(QWidget):
    """One sign.

    Attributes:
        answer: What is drawn.
    """

    def __init__(self, size_px: int, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.answer = Answer.NONE
        self._size_px = size_px
        self.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)
        self.setAccessibleName(self.answer.value)

    def show_answer(self, answer: Answer) -> None:
        """Draw another one."""
        if answer is not self.answer:
            self.answer = answer
            self.setAccessibleName(answer.value)
            self.update()

    def sizeHint(self) -> QSize:
        """A square."""
        return QSize(self._size_px, self._size_px)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the sign; amber where it went wrong."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        colours = colours_of(self.palette())
        colour = colours.attention if self.answer is Answer.WRONG else colours.text
        width = self._size_px / 8
        painter.setPen(QPen(QColor(colour), width, c=Qt.PenCapStyle.RoundCap))
        area = QRectF(self.rect()).adjusted(width, width, -width, -width)
        for line in _LINES[self.answer]:
            points = [
                QPointF(area.left() + x * area.width(), area.top() + y * area.height())
                for x, y in line
            ]
            painter.drawPolyline(QPolygonF(points))
        painter.end()
