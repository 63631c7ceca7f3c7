"""One arm's live acceleration: x, y, z over the last eight seconds."""

import numpy as np
import pyqtgraph as pg
from numpy.typing import NDArray
from PySide6.QtCore import QEvent, QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QFont, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QFrame, QHBoxLayout, QSizePolicy, QVBoxLayout, QWidget

from gestureapp.sensing.store import SampleStore
from ui.decimate import decimate
from ui.labels import plain
from ui.plots import colour_plot, still_plot, ticks
from ui.theme import AXIS_DASHES, AXIS_NAMES, TEXT_PX, colours_of, mixed, sized

BRIDGED_S = 0.3
"""A longer time without samples is shown as what it is: nothing is drawn across it."""
SPAN_S = 8.0
RANGE_G = 2.5
_MARK_PX = 4
"""Three samples are less than a pixel wide; the mark is at least this."""


class Legend(QWidget):
    """x, y, z with a piece of each line, in colour and dash."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)
        self.setAccessibleName("x solid, y dashed, z dotted")

    def sizeHint(self) -> QSize:
        """Room for three entries."""
        return QSize(3 * 54, 16)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the entries."""
        painter = QPainter(self)
        colours = colours_of(self.palette())
        font = QFont(self.font())
        font.setPixelSize(TEXT_PX)
        painter.setFont(font)
        for i, name in enumerate(AXIS_NAMES):
            left, middle = 54.0 * i, self.height() / 2
            painter.setPen(QPen(QColor(colours.axes[i]), 2, AXIS_DASHES[i]))
            painter.drawLine(QPointF(left + 14, middle), QPointF(left + 44, middle))
            painter.setPen(QColor(colours.text))
            painter.drawText(
                QRectF(left, 0, 14, self.height()), Qt.AlignmentFlag.AlignVCenter, name
            )
        painter.end()


class ArmPlot(QFrame):
    """Three curves with a fixed range; says so when no data comes. GUI thread only.

    Lines are one pixel wide without antialiasing and there is no grid: wider and smoother ones cost
    ten times as much a frame.
    """

    def __init__(self, name: str, title: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName(name)
        self._title = title
        self._is_alive: bool | None = None
        self._window_s: tuple[float, float] | None = None
        self._is_anew, self._since_s = False, float("-inf")
        self._heading = plain(f"{name}Title", TEXT_PX, is_wrapped=False)
        self._heading.setText(f"{title} in g, {SPAN_S:.0f} s")
        sized(self._heading, TEXT_PX, is_bold=True)
        self._plot = still_plot(f"{name}Curves")
        self._set_up_plot()
        self._curves = [self._plot.plot(skipFiniteCheck=True) for _ in AXIS_NAMES]
        self._mark = pg.LinearRegionItem(movable=False)
        self._mark.setZValue(-10)
        self._plot.addItem(self._mark)
        self._note = pg.TextItem("no data", anchor=(0.5, 0.5))
        self._note.setPos(-SPAN_S / 2, 0)
        self._plot.addItem(self._note, ignoreBounds=True)
        head = QHBoxLayout()
        head.addWidget(self._heading)
        head.addStretch(1)
        head.addWidget(Legend())
        layout = QVBoxLayout(self)
        layout.setContentsMargins(10, 6, 8, 4)
        layout.setSpacing(2)
        layout.addLayout(head)
        layout.addWidget(self._plot, 1)
        self.mark_window(None, 0.0)
        self._show_alive(False)
        self._colour()

    @property
    def note(self) -> str:
        """What stands across the plot; empty while data comes."""
        return "no data" if self._note.isVisible() else ""

    def curve(self, axis: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """The points drawn for an axis: time before now in s, value in g."""
        times, values = self._curves[axis].getData()
        if times is None:
            return np.empty(0), np.empty(0)
        return times, values

    def show_samples(self, store: SampleStore, now_s: float, is_alive: bool) -> None:
        """Draw the newest samples.

        Args:
            store: The arm's samples.
            now_s: The right edge, monotonic clock.
            is_alive: Whether data comes; when not, the old curve is dimmed and says so.
        """
        self._show_alive(is_alive)
        rows = store.tail(SPAN_S)
        rows = rows[rows[:, 0] >= now_s - SPAN_S] if len(rows) else rows
        width = max(2, int(self._plot.getViewBox().width()))
        points = decimate(self._newer(rows, now_s), SPAN_S, width)
        times = points[:, 0] - now_s
        is_joined = np.append(np.diff(times) <= BRIDGED_S, False) if len(times) else times
        connect = "all" if is_joined[:-1].all() else is_joined.astype(np.int32)
        for axis, curve in enumerate(self._curves):
            curve.setData(times, points[:, axis + 1], connect=connect)
        self._place_mark(now_s)

    def show_title(self, title: str) -> None:
        """Call it otherwise."""
        if title != self._title:
            self._title, self._is_alive = title, None
            self._heading.setText(f"{title} in g, {SPAN_S:.0f} s")

    def begin_anew(self) -> None:
        """Another sensor is shown from now on: what the one before sent is not drawn any more."""
        self._is_anew = True

    def _newer(self, rows: NDArray[np.float64], now_s: float) -> NDArray[np.float64]:
        if self._is_anew:
            self._is_anew, self._since_s = False, now_s
        return rows[rows[:, 0] > self._since_s] if len(rows) else rows

    def mark_window(self, window_s: tuple[float, float] | None, now_s: float) -> None:
        """Mark the samples that the recogniser used; None takes the mark away."""
        self._window_s = window_s
        self._place_mark(now_s)

    def changeEvent(self, event: QEvent) -> None:
        """Follow the colour scheme."""
        super().changeEvent(event)
        if event.type() is QEvent.Type.PaletteChange and hasattr(self, "_note"):
            self._colour()

    def _place_mark(self, now_s: float) -> None:
        if self._window_s is None or self._window_s[1] < now_s - SPAN_S:
            self._mark.setVisible(False)
            return
        start, end = (t - now_s for t in self._window_s)
        least_s = _MARK_PX * SPAN_S / max(1.0, self._plot.getViewBox().width())
        pad = max(0.0, (least_s - (end - start)) / 2)
        self._mark.setRegion((start - pad, end + pad))
        self._mark.setVisible(True)

    def _show_alive(self, is_alive: bool) -> None:
        if is_alive is self._is_alive:
            return
        self._is_alive = is_alive
        self._note.setVisible(not is_alive)
        self._plot.setAccessibleName(f"{self._title}: {'live' if is_alive else 'no data'}")
        self._colour()

    def _set_up_plot(self) -> None:
        self._plot.setMinimumHeight(70)
        item = self._plot.getPlotItem()
        item.setRange(xRange=(-SPAN_S, 0), yRange=(-RANGE_G, RANGE_G), padding=0)
        ticks(self._plot, "left", [(g, f"{g:+d}" if g else "0") for g in (-2, -1, 0, 1, 2)])
        item.getAxis("left").setWidth(26)
        ticks(self._plot, "bottom", [(-t, f"-{t} s") for t in (1, 3, 5, 7)])

    def _colour(self) -> None:
        colours = colours_of(self.palette())
        colour_plot(self._plot, colours)
        for i, curve in enumerate(self._curves):
            colour = QColor(colours.axes[i])
            if not self._is_alive:
                colour = mixed(colours.axes[i], colours.base, 0.35)
            curve.setPen(pg.mkPen(colour, width=1, style=AXIS_DASHES[i]))
        fill = QColor(colours.info)
        fill.setAlpha(90)
        self._mark.setBrush(fill)
        for line in self._mark.lines:
            line.setPen(pg.mkPen(colours.info, width=1))
        self._note.setColor(colours.text)
        font = QFont(self.font())
        font.setPixelSize(20)
        font.setBold(True)
        self._note.setFont(font)
