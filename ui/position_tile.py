"""One position of the calibration: its drawing, its words, and how far it is."""

from PySide6.QtCore import QRectF, QSize, Qt
from PySide6.QtGui import QColor, QFont, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QSizePolicy, QWidget

from gestureapp.setup.values import Position, PositionState, PositionView
from ui.line_drawing import LineDrawing
from ui.progress_ring import paint_ring
from ui.setup_words import position_words
from ui.theme import LARGE_PX, Colours, colours_of

_RING_PX = 44
_WORDS_PX = 104
_USUAL_PX = 150
"""Of this height and below letters and ring are as given; in a higher tile they grow with it."""
_LARGEST = 1.8


class PositionTile(QWidget):
    """Dashed frame: missing; broad frame: hold still; plain frame with a tick: done; none: idle.

    GUI thread only.

    Attributes:
        view: What is shown; None while nothing is under way or has just ended.
        is_wanted: It is the one to take now.
    """

    def __init__(self, position: Position, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName(f"position_{position.value}")
        self._position = position
        self.view: PositionView | None = None
        self.is_wanted = False
        self._drawing = LineDrawing(position.value)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self._name()

    def show_view(self, view: PositionView | None, is_wanted: bool) -> None:
        """Show another moment of this position."""
        if (view, is_wanted) == (self.view, self.is_wanted):
            return
        self.view, self.is_wanted = view, is_wanted
        self._name()
        self.update()

    def sizeHint(self) -> QSize:
        """Drawing and words beside each other."""
        return QSize(240, 140)

    def minimumSizeHint(self) -> QSize:
        """A small drawing."""
        return QSize(180, 84)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw frame, drawing, words and ring."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        colours = colours_of(self.palette())
        frame = QRectF(self.rect()).adjusted(3, 3, -3, -3)
        painter.setPen(self._pen(colours))
        painter.setBrush(QColor(colours.base))
        painter.drawRect(frame)
        state = None if self.view is None else self.view.state
        is_quiet = state in (None, PositionState.MISSING) and not self.is_wanted
        colour = QColor(colours.muted if is_quiet else colours.text)
        grown = min(_LARGEST, max(1.0, self.height() / _USUAL_PX))
        wide = _WORDS_PX * grown
        words = QRectF(frame.right() - wide, frame.top(), wide - 4, frame.height())
        drawing = QRectF(frame.left(), frame.top(), words.left() - frame.left(), frame.height())
        self._drawing.paint(painter, drawing.adjusted(8, 8, -4, -8), colour)
        self._draw_words(painter, words, colour, grown)
        if self.view is not None:
            ring = QRectF(0, 0, _RING_PX * grown, _RING_PX * grown)
            ring.moveCenter(words.center())
            ring.moveBottom(words.bottom() - 10)
            paint_ring(painter, ring, self.view.state, self.view.progress, colours)
        painter.end()

    def _draw_words(self, painter: QPainter, words: QRectF, colour: QColor, grown: float) -> None:
        font = QFont(self.font())
        font.setPixelSize(round((LARGE_PX + 4) * grown))
        font.setBold(True)
        painter.setFont(font)
        painter.setPen(colour)
        line = QRectF(words.left(), words.top() + 6, words.width(), 26 * grown)
        painter.drawText(line, Qt.AlignmentFlag.AlignCenter, position_words(self._position))
        if self.view is None:
            return
        font.setPixelSize(round(LARGE_PX * grown))
        font.setBold(self.view.state is PositionState.HOLD_STILL)
        painter.setFont(font)
        line.translate(0, 24 * grown)
        painter.drawText(line, Qt.AlignmentFlag.AlignCenter, self.view.state.value)

    def _pen(self, colours: Colours) -> QPen:
        join = Qt.PenJoinStyle.MiterJoin
        if self.view is None:
            return QPen(QColor(colours.line), 1, j=join)
        if self.view.state is PositionState.HOLD_STILL:
            return QPen(QColor(colours.info), 5, j=join)
        if self.view.state is PositionState.DONE:
            return QPen(QColor(colours.text), 1.5, j=join)
        colour = colours.info if self.is_wanted else colours.muted
        width = 3 if self.is_wanted else 1.5
        return QPen(QColor(colour), width, Qt.PenStyle.DashLine, j=join)

    def _name(self) -> None:
        wanted = ", wanted now" if self.is_wanted else ""
        state = "" if self.view is None else f": {self.view.state.value}{wanted}"
        self.setAccessibleName(f"{position_words(self._position)}{state}")
