"""Times between two arrivals as bars; a logarithmic count, as the rare long ones matter."""

import math

from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QFont, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QSizePolicy, QWidget

from ui.setup_words import ms_text
from ui.theme import SMALL_PX, Colours, colours_of

_Bars = tuple[tuple[float, int], ...]
_LABEL_PX = 18
_COUNT_PX = 16
_LEAST_SLOT_PX = 34
"""Narrower, and only every second or third class has its label."""


class GapHistogram(QWidget):
    """One bar a class, its upper end below and how many above; a line at the trip level."""

    def __init__(self, name: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName(name)
        self._bars: _Bars | None = None
        self._trip_s = 0.0
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.show_gaps((), 0.0)

    def sizeHint(self) -> QSize:
        """Room for some fifteen classes."""
        return QSize(600, 200)

    def minimumSizeHint(self) -> QSize:
        """Bars can still be told apart."""
        return QSize(300, 110)

    def show_gaps(self, bars: _Bars, trip_s: float) -> None:
        """Show other counts.

        Args:
            bars: Upper end of each class in s, and how many.
            trip_s: The trip level that is set.
        """
        if (bars, trip_s) == (self._bars, self._trip_s):
            return
        self._bars, self._trip_s = bars, trip_s
        total = sum(count for _, count in bars)
        late = sum(count for end_s, count in bars if trip_s and end_s > trip_s)
        self.setAccessibleName(
            f"Times between two arrivals: {total}, of these {late} longer than {ms_text(trip_s)}"
            if total
            else "Times between two arrivals: none yet"
        )
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw bars, labels and the trip level."""
        painter = QPainter(self)
        colours = colours_of(self.palette())
        painter.fillRect(self.rect(), QColor(colours.base))
        font = QFont(self.font())
        font.setPixelSize(SMALL_PX)
        painter.setFont(font)
        area = QRectF(self.rect()).adjusted(8, _COUNT_PX + 4, -8, -_LABEL_PX - 2)
        painter.setPen(QPen(QColor(colours.line), 1))
        painter.drawLine(area.bottomLeft(), area.bottomRight())
        if self._bars:
            self._draw_bars(painter, area, self._bars, colours)
            self._draw_trip(painter, area, self._bars, colours)
        painter.end()

    def _draw_bars(self, painter: QPainter, area: QRectF, bars: _Bars, colours: Colours) -> None:
        width = area.width() / len(bars)
        every = math.ceil(_LEAST_SLOT_PX / width)
        highest = math.log10(1 + max(count for _, count in bars)) or 1.0
        for i, (end_s, count) in enumerate(bars):
            slot = QRectF(area.left() + i * width, area.top(), width, area.height())
            is_late = bool(self._trip_s) and end_s > self._trip_s
            tall = area.height() * math.log10(1 + count) / highest
            bar = QRectF(slot.left() + 2, area.bottom() - tall, width - 4, tall)
            fill = colours.attention if is_late and count else colours.muted
            painter.fillRect(bar, QColor(fill))
            painter.setPen(QColor(colours.text))
            if count and width >= _LEAST_SLOT_PX:
                above = QRectF(slot.left(), bar.top() - _COUNT_PX, width, _COUNT_PX)
                painter.drawText(above, Qt.AlignmentFlag.AlignCenter, str(count))
            if i % every == 0:
                below = QRectF(slot.left() - width, area.bottom() + 2, 3 * width, _LABEL_PX)
                painter.drawText(below, Qt.AlignmentFlag.AlignCenter, _end_text(bars, i))

    def _draw_trip(self, painter: QPainter, area: QRectF, bars: _Bars, colours: Colours) -> None:
        """Between the classes on either side of the trip level."""
        if not self._trip_s:
            return
        n_below = sum(end_s <= self._trip_s + 1e-9 for end_s, _ in bars)
        x = area.left() + n_below * area.width() / len(bars)
        painter.setPen(QPen(QColor(colours.text), 1, Qt.PenStyle.DashLine))
        painter.drawLine(QPointF(x, 2), QPointF(x, area.bottom()))
        words = f"trip level {ms_text(self._trip_s)} "
        room = QRectF(x - 206, 2, 200, _COUNT_PX)
        painter.drawText(room, Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter, words)


def _end_text(bars: _Bars, i: int) -> str:
    """The upper end of a class in ms; the last may have none."""
    end_s = bars[i][0]
    if math.isfinite(end_s):
        return f"{end_s * 1e3:.0f}"
    return f"> {bars[i - 1][0] * 1e3:.0f}" if i else "all"
