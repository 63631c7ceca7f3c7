"""The takes of the batch as small pictures: curve, tick, warning or cross, and why."""

from collections.abc import Callable

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt, Signal
from PySide6.QtGui import QColor, QFont, QPainter, QPaintEvent, QPen, QPolygonF, QResizeEvent
from PySide6.QtWidgets import QAbstractButton, QHBoxLayout, QSizePolicy, QWidget

from gestureapp.recording.take_values import Take
from ui.theme import SMALL_PX, colours_of
from ui.train_words import short_take_text, take_text, verdict_sign

_LEAST_PX, _MOST_PX = 64, 110
"""Eight takes fit on a screen of 1280 pixels, and a batch of ten on a large one."""
_GAP_PX = 4
_HEIGHT_PX = 86
_CURVE_PX = 46
BATCH = 10
"""So many have room beside each other where there is room enough."""
_POINTS = 40
"""Enough for a curve a thumb wide."""
_RANGE_G = 1.8


def key_of(take: Take) -> tuple[object, ...]:
    """What makes a take look different; arrays cannot be compared."""
    return (take.id, take.label, take.judgement, take.is_excluded, take.is_deleted)


class TakePicture(QAbstractButton):
    """One take; a press selects it. GUI thread only.

    Attributes:
        take: The one shown, or None.
    """

    def __init__(self, place: int, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.take: Take | None = None
        self._number = 0
        self._curves: list[QPolygonF] = []
        self.setObjectName(f"take_{place}")
        self.setCheckable(True)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setFixedHeight(_HEIGHT_PX)

    def show_take(self, take: Take, number: int) -> None:
        """Show a take, the how-manieth of the batch."""
        if self.take is not None and key_of(take) == key_of(self.take) and number == self._number:
            return
        self.take, self._number = take, number
        words = f"take {number} of this batch, {take.label}: {take_text(take)}"
        self.setAccessibleName(words)
        self.setToolTip(words)
        self._curves = _curves_of(take)
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw curves, sign and words."""
        if self.take is None:
            return
        painter = QPainter(self)
        colours = colours_of(self.palette())
        area = QRectF(self.rect()).adjusted(0.5, 0.5, -0.5, -0.5)
        painter.fillRect(area, QColor(colours.base))
        is_chosen = self.isChecked()
        painter.setPen(QPen(QColor(colours.info if is_chosen else colours.line), 1 + 2 * is_chosen))
        painter.drawRect(area.adjusted(is_chosen, is_chosen, -is_chosen, -is_chosen))
        self._draw_curves(painter, QRectF(3, 3, self.width() - 6, _CURVE_PX))
        counts = self.take.counts
        painter.setPen(QColor(colours.text if counts else colours.attention))
        painter.setFont(self._font(20, is_bold=True))
        sign = QRectF(4, 2, 20, 22)
        painter.drawText(sign, Qt.AlignmentFlag.AlignCenter, verdict_sign(self.take))
        painter.setFont(self._font(SMALL_PX - 1))
        below = _CURVE_PX + 3
        words = QRectF(3, below, self.width() - 6, _HEIGHT_PX - below - 3)
        flags = Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap
        painter.drawText(words, flags, short_take_text(self.take))
        painter.end()

    def _draw_curves(self, painter: QPainter, area: QRectF) -> None:
        colours = colours_of(self.palette())
        painter.save()
        painter.translate(area.topLeft())
        painter.scale(area.width(), area.height())
        for curve, colour in zip(self._curves, colours.axes, strict=False):
            pen = QPen(QColor(colour), 1)
            pen.setCosmetic(True)
            painter.setPen(pen)
            painter.drawPolyline(curve)
        painter.restore()

    def _font(self, size_px: int, is_bold: bool = False) -> QFont:
        font = QFont(self.font())
        font.setPixelSize(size_px)
        font.setBold(is_bold)
        return font


class TakeStrip(QWidget):
    """As many of the newest takes as there is room for, oldest first. GUI thread only.

    Signals:
        selected: Another take is selected, or none.
    """

    selected = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("takeStrip")
        self.setAccessibleName("Takes of this batch")
        self._batch: tuple[Take, ...] = ()
        self._chosen: int | None = None
        self._pictures: list[TakePicture] = []
        self._row = QHBoxLayout(self)
        self._row.setContentsMargins(0, 0, 0, 0)
        self._row.setSpacing(_GAP_PX)
        self._row.addStretch(1)
        self.setFixedHeight(_HEIGHT_PX)
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)

    @property
    def chosen(self) -> Take | None:
        """The take that was pressed, or the newest one."""
        for take in self._batch:
            if take.id == self._chosen:
                return take
        return self._batch[-1] if self._batch else None

    @property
    def pictures(self) -> tuple[TakePicture, ...]:
        """Those in sight, oldest first."""
        return tuple(each for each in self._pictures if not each.isHidden())

    def show_batch(self, batch: tuple[Take, ...]) -> None:
        """Show other takes."""
        if [key_of(take) for take in batch] == [key_of(take) for take in self._batch]:
            return
        if batch and (not self._batch or batch[-1].id != self._batch[-1].id):
            self._chosen = None  # the newest one, again
        self._batch = batch
        self._lay_out()
        self.selected.emit()

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Show as many as fit."""
        super().resizeEvent(event)
        self._lay_out()

    def _lay_out(self) -> None:
        wide = (self.width() + _GAP_PX) // BATCH - _GAP_PX
        wide = min(max(wide, _LEAST_PX), _MOST_PX)
        room = max(1, (self.width() + _GAP_PX) // (wide + _GAP_PX))
        n = len(self._batch)
        shown = self._batch[-room:]
        while len(self._pictures) < len(shown):
            picture = TakePicture(len(self._pictures))
            picture.clicked.connect(self._press_of(picture))
            self._row.insertWidget(len(self._pictures), picture)
            self._pictures.append(picture)
        for i, picture in enumerate(self._pictures):
            picture.setVisible(i < len(shown))
            picture.setFixedWidth(wide)
            if i < len(shown):
                picture.show_take(shown[i], n - len(shown) + i + 1)
        self._mark()

    def _mark(self) -> None:
        chosen = self.chosen
        for picture in self._pictures:
            take = picture.take
            picture.setChecked(chosen is not None and take is not None and take.id == chosen.id)

    def _press_of(self, picture: TakePicture) -> Callable[[], None]:
        def press() -> None:
            if picture.take is not None:
                self._chosen = picture.take.id
            self._mark()
            self.selected.emit()

        return press


def _curves_of(take: Take) -> list[QPolygonF]:
    """x, y and z of a take in a unit square, without the mean so that all three are seen."""
    n = len(take.times_s)
    if n < 2:
        return []
    picked = np.unique(np.linspace(0, n - 1, min(n, _POINTS)).astype(int))
    times = take.times_s[picked]
    span_s = max(1e-6, float(times[-1] - times[0]))
    x = (times - times[0]) / span_s
    level = take.accel_g[picked] - np.median(take.accel_g, axis=0)
    y = 0.5 - np.clip(level, -_RANGE_G, _RANGE_G) / (2 * _RANGE_G)
    return [
        QPolygonF([QPointF(float(a), float(b)) for a, b in zip(x, y[:, axis], strict=True)])
        for axis in range(y.shape[1])
    ]
