"""Shapes that say the same as a colour: dash, ring, dot, triangle, square. Drawn, not loaded."""

from enum import Enum

from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QSizePolicy, QWidget

from ui.theme import Colours, colours_of


class Level(Enum):
    """How much something wants a person."""

    OFF = "off"
    """Grey dash: nothing there, and nothing wanted."""
    OK = "ok"
    """Grey ring: as it should be."""
    BUSY = "busy"
    """Blue dot: under way."""
    ATTENTION = "attention"
    """Amber triangle."""
    ALARM = "alarm"
    """Red square."""


def level_colour(level: Level, colours: Colours) -> QColor:
    """The colour that goes with a level; grey unless something wants a person."""
    return QColor(
        {
            Level.OFF: colours.muted,
            Level.OK: colours.muted,
            Level.BUSY: colours.info,
            Level.ATTENTION: colours.attention,
            Level.ALARM: colours.alarm,
        }[level]
    )


class Mark(QWidget):
    """One shape beside a word. Owned by the widget that shows the word.

    Attributes:
        level: What is drawn.
    """

    def __init__(self, size_px: int = 16, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.level = Level.OFF
        self._size_px = size_px
        self.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)

    def show_level(self, level: Level) -> None:
        """Draw another level."""
        if level is not self.level:
            self.level = level
            self.update()

    def sizeHint(self) -> QSize:
        """A square."""
        return QSize(self._size_px, self._size_px)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the shape."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        inset = self._size_px * 0.1
        area = QRectF(self.rect()).adjusted(inset, inset, -inset, -inset)
        paint_mark(painter, area, self.level, colours_of(self.palette()))
        painter.end()


def paint_mark(painter: QPainter, area: QRectF, level: Level, colours: Colours) -> None:
    """Draw a level's shape into a square area, in its colour."""
    _SHAPES[level](painter, area, level_colour(level, colours))


def _stroke(colour: QColor, area: QRectF) -> QPen:
    return QPen(colour, max(1.5, area.width() / 7), c=Qt.PenCapStyle.RoundCap)


def _dash(painter: QPainter, area: QRectF, colour: QColor) -> None:
    painter.setPen(_stroke(colour, area))
    middle = area.center().y()
    painter.drawLine(QPointF(area.left(), middle), QPointF(area.right(), middle))


def _ring(painter: QPainter, area: QRectF, colour: QColor) -> None:
    pen = _stroke(colour, area)
    painter.setPen(pen)
    half = pen.widthF() / 2
    painter.drawEllipse(area.adjusted(half, half, -half, -half))


def _dot(painter: QPainter, area: QRectF, colour: QColor) -> None:
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(colour)
    painter.drawEllipse(area)


def _triangle(painter: QPainter, area: QRectF, colour: QColor) -> None:
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(colour)
    top = QPointF(area.center().x(), area.top())
    painter.drawPolygon(QPolygonF([top, area.bottomRight(), area.bottomLeft()]))


def _square(painter: QPainter, area: QRectF, colour: QColor) -> None:
    painter.fillRect(area, colour)


_SHAPES = {
    Level.OFF: _dash,
    Level.OK: _ring,
    Level.BUSY: _dot,
    Level.ATTENTION: _triangle,
    Level.ALARM: _square,
}
