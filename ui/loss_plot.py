"""How the loss fell while training."""

import math
from collections.abc import Sequence

import pyqtgraph as pg
from PySide6.QtCore import QEvent
from PySide6.QtWidgets import QFrame, QVBoxLayout, QWidget

from ui.labels import plain
from ui.plots import colour_plot, still_plot, ticks
from ui.theme import TEXT_PX, colours_of, sized

_MOST_POINTS = 400
"""About one for each pixel."""
_FEW_POWERS = 3


class LossPlot(QFrame):
    """Loss over passes; the loss on a logarithmic scale. GUI thread only."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("lossPlot")
        self._shown: tuple[int, object] | None = None
        heading = plain("lossTitle", TEXT_PX, is_wrapped=False)
        heading.setText("Loss while training, by passes over the takes (lower is better)")
        sized(heading, TEXT_PX, is_bold=True)
        self._plot = still_plot("lossCurve")
        self._plot.setMinimumHeight(110)
        self._plot.getPlotItem().setLogMode(x=False, y=True)
        self._plot.getPlotItem().getAxis("left").setWidth(44)
        self._curve = self._plot.plot()
        layout = QVBoxLayout(self)
        layout.setContentsMargins(10, 6, 10, 4)
        layout.setSpacing(2)
        layout.addWidget(heading)
        layout.addWidget(self._plot, 1)
        self.show_losses(())
        self._colour()

    def points(self) -> list[tuple[float, float]]:
        """What is drawn: passes and the logarithm to base ten of the loss."""
        passes, logs = self._curve.getData()
        return [] if passes is None else list(zip(passes.tolist(), logs.tolist(), strict=True))

    def show_losses(self, losses: Sequence[tuple[int, float]]) -> None:
        """Show another course of the loss, oldest first."""
        newest = (len(losses), losses[-1] if losses else None)
        if newest == self._shown:
            return
        self._shown = newest
        step = max(1, -(-len(losses) // _MOST_POINTS))
        newest_first = losses[::-step]
        kept = [(n, loss) for n, loss in newest_first[::-1] if loss > 0 and math.isfinite(loss)]
        passes, values = [n for n, _ in kept], [loss for _, loss in kept]
        self._curve.setData(passes, values)
        for side in ("left", "bottom"):
            # Without a point the values would be those of no range at all.
            self._plot.getPlotItem().getAxis(side).setStyle(showValues=bool(kept))
        if kept:
            low = math.floor(math.log10(min(values)))
            high = max(low + 1, math.ceil(math.log10(max(values))))
            across = (passes[0], max(passes[0] + 1, passes[-1]))
            self._plot.getPlotItem().setRange(xRange=across, yRange=(low, high), padding=0.02)
            ticks(self._plot, "left", _marks(low, high))
            self._plot.setAccessibleName(f"Loss {values[-1]:.2g} after {passes[-1]} passes")

    def changeEvent(self, event: QEvent) -> None:
        """Follow the colour scheme."""
        super().changeEvent(event)
        if event.type() is QEvent.Type.PaletteChange and hasattr(self, "_curve"):
            self._colour()

    def _colour(self) -> None:
        colours = colours_of(self.palette())
        colour_plot(self._plot, colours)
        self._curve.setPen(pg.mkPen(colours.info, width=1))


def _marks(low: int, high: int) -> list[tuple[float, str]]:
    """Marks of a logarithmic axis between two powers of ten; fewer where there are many powers."""
    steps = (1, 2, 5) if high - low <= _FEW_POWERS else (1,)
    values = [step * 10.0**power for power in range(low, high + 1) for step in steps]
    return [(math.log10(value), f"{value:g}") for value in values]
