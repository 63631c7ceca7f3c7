"""All takes of a gesture over each other, an axis to a plot, with their median and band."""

import math
from collections.abc import Sequence

import numpy as np
import pyqtgraph as pg
from numpy.typing import NDArray
from PySide6.QtCore import QEvent, QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QHBoxLayout, QSizePolicy, QVBoxLayout, QWidget

from gestureapp.guided.check import GRID_S, LEAST_TO_COMPARE, GestureCheck, resample
from gestureapp.recording.take_values import Take
from ui.labels import plain
from ui.plots import colour_plot, still_plot, ticks
from ui.theme import AXIS_NAMES, SMALL_PX, TEXT_PX, Colours, colours_of, mixed, sized

F64 = NDArray[np.float64]
_LEAST_RANGE_G = (-1.5, 1.5)
_STEP_G = 0.5
_FAINT = 0.45
SHOWN_AT_ONCE = 2
"""Takes that can be compared."""


class CurveLegend(QWidget):
    """What each kind of line means."""

    _ENTRIES = ("median", "8 of 10", "odd", "not counted", "chosen", "compared")
    _LINE_PX = 16
    _GAP_PX = 8

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        sized(self, SMALL_PX)
        self.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)
        self.setAccessibleName("Lines: " + ", ".join(self._ENTRIES))

    def sizeHint(self) -> QSize:
        """Room for all entries."""
        return QSize(sum(map(self._width, self._ENTRIES)), 16)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the entries."""
        painter = QPainter(self)
        colours = colours_of(self.palette())
        left, middle = 0.0, self.height() / 2
        for name, pen in zip(self._ENTRIES, _pens(colours, 2), strict=True):
            line = QRectF(left, middle - 5, self._LINE_PX, 10)
            if pen is None:
                painter.fillRect(line, _band_colour(colours, 2))
            else:
                painter.setPen(pen)
                painter.drawLine(QPointF(line.left(), middle), QPointF(line.right(), middle))
            painter.setPen(QColor(colours.text))
            text = QRectF(line.right() + 4, 0, self._width(name), self.height())
            painter.drawText(text, Qt.AlignmentFlag.AlignVCenter, name)
            left += self._width(name)
        painter.end()

    def _width(self, name: str) -> int:
        return self._LINE_PX + 4 + self.fontMetrics().horizontalAdvance(name) + self._GAP_PX


class TakeCurves(QWidget):
    """Three plots side by side with one scale. Drawn anew only when the takes change."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("takeCurves")
        self._title = plain("takeCurvesTitle", TEXT_PX)
        sized(self._title, TEXT_PX, is_bold=True)
        self._panels = [_AxisPanel(axis) for axis in range(len(AXIS_NAMES))]
        row = QHBoxLayout()
        row.setSpacing(6)
        for panel in self._panels:
            row.addWidget(panel.plot, 1)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(3)
        layout.addWidget(self._title)
        layout.addLayout(row, 1)
        layout.addWidget(CurveLegend(), 0, Qt.AlignmentFlag.AlignHCenter)
        self._colour()

    @property
    def n_drawn(self) -> int:
        """How many takes are drawn, chosen ones apart."""
        times = [item.getData()[0] for item in self._panels[0].groups]
        return sum(len(each) for each in times if each is not None) // len(GRID_S)

    @property
    def n_chosen(self) -> int:
        """How many takes are drawn as chosen or compared."""
        return sum(item.isVisible() for item in self._panels[0].chosen)

    def show_check(self, check: GestureCheck, title: str) -> None:
        """Show the takes of a gesture."""
        self._title.setText(title)
        odd = np.array([checked.is_odd for checked in check.takes], dtype=bool)
        counts = np.array([checked.take.counts for checked in check.takes], dtype=bool)
        low_g, high_g = _range_g(check.curves_g)
        for panel in self._panels:
            curves = check.curves_g[:, :, panel.axis]
            for item, group in zip(panel.groups, (counts & ~odd, odd, ~counts), strict=True):
                _draw_joined(item, curves[group])
            panel.median.setData(GRID_S, check.median_g[:, panel.axis])
            panel.low.setData(GRID_S, check.low_g[:, panel.axis])
            panel.high.setData(GRID_S, check.high_g[:, panel.axis])
            panel.median.setVisible(bool(check.takes))
            panel.band.setVisible(int(counts.sum()) >= LEAST_TO_COMPARE)
            panel.plot.getPlotItem().setRange(
                xRange=(float(GRID_S[0]), float(GRID_S[-1])), yRange=(low_g, high_g), padding=0
            )
            ticks(panel.plot, "left", [(g, f"{g:+d}" if g else "0") for g in _whole(low_g, high_g)])
            panel.plot.setAccessibleName(f"{AXIS_NAMES[panel.axis]} in g. {title}")

    def show_chosen(self, takes: Sequence[Take]) -> None:
        """Draw up to two takes, of any gesture, on top."""
        shown = list(takes[:SHOWN_AT_ONCE])
        curves = resample(shown, GRID_S)
        for panel in self._panels:
            for i, item in enumerate(panel.chosen):
                item.setVisible(i < len(shown))
                if i < len(shown):
                    item.setData(GRID_S, curves[i, :, panel.axis])

    def changeEvent(self, event: QEvent) -> None:
        """Follow the colour scheme."""
        super().changeEvent(event)
        if event.type() is QEvent.Type.PaletteChange and hasattr(self, "_panels"):
            self._colour()

    def _colour(self) -> None:
        for panel in self._panels:
            panel.colour(colours_of(self.palette()))


class _AxisPanel:
    """One axis: usual, odd and uncounted takes as one item each, as hundreds would be slow."""

    def __init__(self, axis: int) -> None:
        self.axis = axis
        self.plot = still_plot(f"takePlot_{AXIS_NAMES[axis]}")
        self.plot.setMinimumHeight(120)
        item = self.plot.getPlotItem()
        item.getAxis("left").setWidth(26)
        ticks(self.plot, "bottom", [(0.0, "0"), (0.5, "0.5 s")])
        self.low, self.high = pg.PlotCurveItem(), pg.PlotCurveItem()
        self.band = pg.FillBetweenItem(self.low, self.high)
        self.groups = [pg.PlotCurveItem() for _ in range(3)]
        self.median = pg.PlotCurveItem()
        self.chosen = [pg.PlotCurveItem() for _ in range(SHOWN_AT_ONCE)]
        self._activation = pg.InfiniteLine(0.0, 90)
        self._name = pg.TextItem(f"{AXIS_NAMES[axis]} in g", anchor=(0, 0))
        for part in (self.band, self._activation, *self.groups, self.median, *self.chosen):
            item.addItem(part, ignoreBounds=True)
        self._name.setParentItem(item.getViewBox())
        self._name.setPos(4, 2)

    def colour(self, colours: Colours) -> None:
        """Take the scheme's colours."""
        colour_plot(self.plot, colours)
        median, _, odd, uncounted, chosen, compared = _pens(colours, self.axis)
        usual = pg.mkPen(mixed(colours.axes[self.axis], colours.base, _FAINT), width=1)
        for item, pen in zip(self.groups, (usual, odd, uncounted), strict=True):
            item.setPen(pen)
        self.median.setPen(median)
        self.band.setBrush(_band_colour(colours, self.axis))
        for item, pen in zip(self.chosen, (chosen, compared), strict=True):
            item.setPen(pen)
        self._activation.setPen(pg.mkPen(colours.muted, width=1))
        self._name.setColor(colours.text)


def _pens(colours: Colours, axis: int) -> list[QPen | None]:
    """Median, band (a fill), odd, uncounted, chosen, compared; widths in pixels."""
    return [
        pg.mkPen(colours.axes[axis], width=3),
        None,
        pg.mkPen(colours.attention, width=1),
        pg.mkPen(colours.muted, width=1, style=Qt.PenStyle.DotLine),
        pg.mkPen(colours.text, width=2),
        pg.mkPen(colours.text, width=2, style=Qt.PenStyle.DashLine),
    ]


def _band_colour(colours: Colours, axis: int) -> QColor:
    fill = QColor(colours.axes[axis])
    fill.setAlpha(45)
    return fill


def _draw_joined(item: pg.PlotCurveItem, curves: F64) -> None:
    """Curves, shape (m, times), as one line of points that is not joined between two of them."""
    joins = np.ones(curves.shape, dtype=bool)
    joins[:, -1:] = False
    item.setData(np.tile(GRID_S, len(curves)), curves.ravel(), connect=joins.ravel())


def _range_g(curves: F64) -> tuple[float, float]:
    low, high = _LEAST_RANGE_G
    if curves.size:
        low = min(low, math.floor(float(curves.min()) / _STEP_G) * _STEP_G)
        high = max(high, math.ceil(float(curves.max()) / _STEP_G) * _STEP_G)
    return low, high


def _whole(low: float, high: float) -> range:
    """Whole numbers between, without the edges: a mark there would be cut."""
    return range(math.floor(low) + 1, math.ceil(high))
