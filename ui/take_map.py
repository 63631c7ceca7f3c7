"""Every take as a point: alike takes lie together, odd ones apart. A click chooses a take."""

from dataclasses import dataclass

import numpy as np
import pyqtgraph as pg
from numpy.typing import NDArray
from pyqtgraph.graphicsItems.ScatterPlotItem import drawSymbol
from PySide6.QtCore import QEvent, QSize, Qt, Signal
from PySide6.QtGui import QColor, QFont, QPainter, QPaintEvent
from PySide6.QtWidgets import QHBoxLayout, QSizePolicy, QVBoxLayout, QWidget

from gestureapp.gestures import Kind, gesture
from gestureapp.guided.check import TakeMap
from ui.labels import plain
from ui.plots import colour_plot, still_plot
from ui.theme import SMALL_PX, TEXT_PX, Colours, colours_of, mixed, sized

_SIZE_PX = 9
_RING_PX = 17
_OTHERS = 0.45
"""How strong the takes of the gestures that are not chosen are drawn."""
_SHAPES = {Kind.MOVEMENT: ("o", "s", "t1"), Kind.POSTURE: ("d", "star", "+")}
"""For the axes x, y, z."""
_OTHER_SHAPES = ("o", "s", "t1", "d", "star", "+", "t", "p", "h", "x", "t2", "t3")
_LEGEND_ROW_PX = 19


@dataclass(frozen=True, slots=True)
class Look:
    """How takes are drawn: the axis gives the colour, axis and kind the shape, + is filled."""

    symbol: str
    colour: str
    is_filled: bool


def look_of(label: str, index: int, colours: Colours) -> Look:
    """How a gesture is drawn.

    Args:
        label: The gesture.
        index: Its place among those shown, for one that this window does not know.
        colours: The scheme.
    """
    try:
        known = gesture(label)
    except KeyError:
        return Look(_OTHER_SHAPES[index % len(_OTHER_SHAPES)], colours.axes[index % 3], True)
    return Look(_SHAPES[known.kind][known.axis], colours.axes[known.axis], known.sign > 0)


class MapLegend(QWidget):
    """Shape and name of each gesture, below each other."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._labels: tuple[str, ...] = ()
        self.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Preferred)

    def show_labels(self, labels: tuple[str, ...]) -> None:
        """Name other gestures."""
        if labels != self._labels:
            self._labels = labels
            self.setAccessibleName("Gestures on the map: " + ", ".join(labels))
            self.update()

    def sizeHint(self) -> QSize:
        """Room for twelve."""
        return QSize(58, 12 * _LEGEND_ROW_PX)

    def minimumSizeHint(self) -> QSize:
        """Narrower rows are still read."""
        return QSize(58, 12 * 14)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the entries."""
        painter = QPainter(self)
        colours = colours_of(self.palette())
        font = QFont(self.font())
        font.setPixelSize(SMALL_PX)
        painter.setFont(font)
        row = min(_LEGEND_ROW_PX, self.height() / max(1, len(self._labels)))
        for i, label in enumerate(self._labels):
            look = look_of(label, i, colours)
            painter.save()
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.translate(10, (i + 0.5) * row)
            brush = QColor(look.colour if look.is_filled else colours.panel)
            drawSymbol(painter, look.symbol, _SIZE_PX, _pen(QColor(look.colour)), brush)
            painter.restore()
            painter.setPen(QColor(colours.text))
            middle = Qt.AlignmentFlag.AlignVCenter
            painter.drawText(22, round(i * row), 36, round(row), middle, label)
        painter.end()


class TakeMapView(QWidget):
    """The map with its legend.

    Signals:
        take_clicked: The take's number.
    """

    take_clicked = Signal(int)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("takeMapView")
        self._map: TakeMap | None = None
        self._label = ""
        self._title = plain("takeMapTitle", TEXT_PX)
        sized(self._title, TEXT_PX, is_bold=True)
        self._plot = still_plot("takeMap")
        self._plot.setMinimumHeight(150)
        self._plot.getPlotItem().getAxis("left").setWidth(34)
        self._ring = pg.ScatterPlotItem(size=_RING_PX, symbol="o", brush=None)
        self._plot.addItem(self._ring)
        self._spots: dict[str, pg.ScatterPlotItem] = {}
        self._names: dict[str, pg.TextItem] = {}
        self._legend = MapLegend()
        row = QHBoxLayout()
        row.addWidget(self._plot, 1)
        row.addWidget(self._legend)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(3)
        layout.addWidget(self._title)
        layout.addLayout(row, 1)
        self._colour()

    def place_of(self, take_id: int) -> tuple[float, float] | None:
        """Where a take is on the map, in the map's g; None when it is not there."""
        if self._map is None or take_id not in self._map.ids:
            return None
        x, y = self._map.points[self._map.ids.index(take_id)].tolist()
        return x, y

    def show_map(self, take_map: TakeMap, order: tuple[str, ...]) -> tuple[str, ...]:
        """Make room for other takes; ``draw`` puts each gesture's there.

        Args:
            take_map: The points.
            order: The gestures in the order of the legend.

        Returns:
            The gestures to draw.
        """
        self._map = take_map
        found = set(take_map.labels)
        labels = tuple(label for label in order if label in found)
        labels += tuple(sorted(found - set(labels)))
        self._legend.show_labels(labels)
        shown = f"{100 * sum(take_map.shares):.0f} %"
        self._title.setText(
            f"All {len(take_map.ids)} takes, alike ones together "
            f"({shown} of their difference). Click one."
        )
        self._plot.setAccessibleName(f"Map of the takes. {self._title.text()}")
        self._make_items(labels)
        self._fit(take_map.points)
        return labels

    def draw(self, label: str) -> None:
        """Draw the takes of one gesture of the map."""
        if self._map is None:
            return
        mine = [i for i, other in enumerate(self._map.labels) if other == label]
        points = self._map.points[mine]
        style = self._style(list(self._spots).index(label), label)
        ids = [self._map.ids[i] for i in mine]
        self._spots[label].setData(pos=points, data=ids, size=_SIZE_PX, **style)
        self._names[label].setPos(*np.median(points, axis=0).tolist())
        self._colour_name(label)

    def highlight(self, label: str, chosen: tuple[int, ...]) -> None:
        """Draw one gesture stronger than the others, and a ring around the chosen takes."""
        if label != self._label:
            others, self._label = self._label, label
            self._recolour({others, label})
        places = [place for place in map(self.place_of, chosen) if place is not None]
        self._ring.setData(pos=np.array(places).reshape(-1, 2))

    def changeEvent(self, event: QEvent) -> None:
        """Follow the colour scheme."""
        super().changeEvent(event)
        if event.type() is QEvent.Type.PaletteChange and hasattr(self, "_legend"):
            self._colour()

    def _make_items(self, labels: tuple[str, ...]) -> None:
        if tuple(self._spots) == labels:
            return
        for item in (*self._spots.values(), *self._names.values()):
            self._plot.removeItem(item)
        self._spots = {label: pg.ScatterPlotItem(size=_SIZE_PX) for label in labels}
        self._names = {label: pg.TextItem(label, anchor=(0.5, 0.5)) for label in labels}
        for spots in self._spots.values():
            spots.sigClicked.connect(self._clicked)
            self._plot.addItem(spots)
        for name in self._names.values():
            name.setZValue(20)
            self._plot.addItem(name, ignoreBounds=True)

    def _fit(self, points: NDArray[np.float64]) -> None:
        if len(points):
            low, high = points.min(axis=0), points.max(axis=0)
            self._plot.getPlotItem().setRange(
                xRange=(low[0], max(high[0], low[0] + 0.1)),
                yRange=(low[1], max(high[1], low[1] + 0.1)),
                padding=0.06,
            )

    def _clicked(self, _spots: object, points: list[pg.SpotItem], _event: object) -> None:
        if len(points):
            self.take_clicked.emit(int(points[0].data()))

    def _style(self, number: int, label: str) -> dict[str, object]:
        """Of a gesture's points: stronger for the one that is looked at."""
        colours = colours_of(self.palette())
        look = look_of(label, number, colours)
        colour = QColor(look.colour)
        if not self._is_main(label):
            colour = mixed(look.colour, colours.base, _OTHERS)
        brush = pg.mkBrush(colour if look.is_filled else colours.base)
        return {"pen": _pen(colour), "brush": brush, "symbol": look.symbol}

    def _is_main(self, label: str) -> bool:
        return label == self._label or self._label not in self._spots

    def _recolour(self, labels: set[str]) -> None:
        for number, (label, spots) in enumerate(self._spots.items()):
            if label in labels:
                style = self._style(number, label)
                spots.setPen(style["pen"], update=False)
                spots.setBrush(style["brush"])
                spots.setZValue(10 if self._is_main(label) else 0)
                self._colour_name(label)

    def _colour_name(self, label: str) -> None:
        colours = colours_of(self.palette())
        name = self._names[label]
        name.setColor(colours.text if self._is_main(label) else colours.muted)
        name.fill = pg.mkBrush(_see_through(colours.base))

    def _colour(self) -> None:
        colours = colours_of(self.palette())
        colour_plot(self._plot, colours)
        self._ring.setPen(pg.mkPen(colours.text, width=2))
        self._ring.setZValue(30)
        self._recolour(set(self._spots))


def _pen(colour: QColor) -> object:
    return pg.mkPen(colour, width=1)


def _see_through(colour: str) -> QColor:
    seen = QColor(colour)
    seen.setAlpha(120)
    return seen
