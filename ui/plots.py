"""Plots that only show: nothing to drag, no menu, no grid, the theme's colours."""

from collections.abc import Sequence

import pyqtgraph as pg
from PySide6.QtCore import Qt
from PySide6.QtGui import QFont
from PySide6.QtWidgets import QFrame

from ui.theme import SMALL_PX, Colours

_SIDES = ("left", "bottom")


def still_plot(name: str) -> pg.PlotWidget:
    """A plot without ranges that follow the data; set them.

    Args:
        name: Its objectName.
    """
    plot = pg.PlotWidget()
    plot.setObjectName(name)
    plot.setFrameShape(QFrame.Shape.NoFrame)
    plot.setFocusPolicy(Qt.FocusPolicy.NoFocus)
    item = plot.getPlotItem()
    item.setMenuEnabled(False)
    item.setMouseEnabled(x=False, y=False)
    item.hideButtons()
    item.disableAutoRange()
    font = QFont(plot.font())
    font.setPixelSize(SMALL_PX - 1)
    for side in _SIDES:
        item.getAxis(side).setStyle(tickFont=font, tickLength=-4)
    item.getAxis("bottom").setHeight(18)
    return plot


def ticks(plot: pg.PlotWidget, side: str, places: Sequence[tuple[float, str]]) -> None:
    """Say where an axis has marks and what stands there.

    Args:
        plot: Whose axis.
        side: ``left`` or ``bottom``.
        places: Value and text of each mark.
    """
    plot.getPlotItem().getAxis(side).setTicks([list(places)])


def colour_plot(plot: pg.PlotWidget, colours: Colours) -> None:
    """Give background and axes the scheme's colours."""
    plot.setBackground(colours.base)
    for side in _SIDES:
        axis = plot.getPlotItem().getAxis(side)
        axis.setPen(pg.mkPen(colours.line, width=1))
        axis.setTextPen(pg.mkPen(colours.muted))
