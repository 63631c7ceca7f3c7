"""The gestures to record: small drawing, ring with how many takes are there, quality, what next."""

from collections.abc import Callable

from PySide6.QtCore import QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QFont, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import (
    QAbstractButton,
    QButtonGroup,
    QFrame,
    QSizePolicy,
    QVBoxLayout,
    QWidget,
)

from gestureapp.gestures import GESTURES, gesture
from gestureapp.guided.values import GestureProgress, Quality
from ui.gesture_drawing import paint_figure
from ui.theme import SMALL_PX, TEXT_PX, colours_of
from ui.train_words import quality_sign

_WIDTH_PX = (196, 290)
"""Least and most of a row; its words show where there is room for two lines."""
_ROW_PX = 27
"""Twelve of them fit beside the drawing on a screen of 720 pixels."""
_RING_PX = 18
_ICON_PX = 60


class GestureRow(QAbstractButton):
    """One gesture; a press chooses it. GUI thread only."""

    def __init__(self, label: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._words = gesture(label).words
        self._progress = GestureProgress(label, 0, 0, Quality.NONE)
        self._is_next = False
        self.setObjectName(f"record_{label}")
        self.setText(label)
        self.setCheckable(True)
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Expanding)
        self._name()

    @property
    def progress(self) -> GestureProgress:
        """How far it is, as shown."""
        return self._progress

    @property
    def is_next(self) -> bool:
        """It is marked as the one to record next."""
        return self._is_next

    def show_progress(self, progress: GestureProgress, *, is_next: bool) -> None:
        """Show how far it is, and whether it is the one to record next."""
        if (progress, is_next) == (self._progress, self._is_next):
            return
        self._progress, self._is_next = progress, is_next
        self._name()
        self.update()

    def sizeHint(self) -> QSize:
        """One line."""
        return QSize(_WIDTH_PX[0], _ROW_PX + 6)

    def minimumSizeHint(self) -> QSize:
        """One line, tight."""
        return QSize(_WIDTH_PX[0], _ROW_PX)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw ground, label, words, ring and numbers."""
        painter = QPainter(self)
        colours = colours_of(self.palette())
        if self.isChecked():
            painter.fillRect(self.rect(), QColor(colours.base))
            painter.fillRect(QRectF(0, 0, 4, self.height()), QColor(colours.info))
        if self.hasFocus():
            painter.setPen(QPen(QColor(colours.info), 1, Qt.PenStyle.DotLine))
            painter.drawRect(self.rect().adjusted(1, 1, -2, -2))
        side = min(self.height() - 2, _ICON_PX)
        icon = QRectF(6, (self.height() - side) / 2, side * 1.2, side)
        paint_figure(painter, icon, self.text(), 1.0, colours)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        left = icon.right() + 6
        ring = QRectF(self.width() - 76, (self.height() - _RING_PX) / 2, _RING_PX, _RING_PX)
        self._draw_ring(painter, ring)
        painter.setPen(QColor(colours.text))
        painter.setFont(self._font(TEXT_PX + 2, is_bold=True))
        is_tall = self.height() >= 2 * _ROW_PX - 12
        head = QRectF(left, 0, ring.left() - left - 4, self.height() / (2 if is_tall else 1))
        align = Qt.AlignmentFlag.AlignBottom if is_tall else Qt.AlignmentFlag.AlignVCenter
        mark = " \u25c2 next" if self._is_next else ""
        painter.drawText(head, align, self.text())
        if mark:
            painter.setFont(self._font(SMALL_PX, is_bold=True))
            painter.setPen(QColor(colours.info))
            painter.drawText(head, align | Qt.AlignmentFlag.AlignRight, mark)
        if is_tall:
            painter.setPen(QColor(colours.muted))
            painter.setFont(self._font(SMALL_PX))
            below = QRectF(left, head.bottom(), ring.left() - left, head.height())
            words = painter.fontMetrics().elidedText(
                self._words, Qt.TextElideMode.ElideRight, int(below.width())
            )
            painter.drawText(below, Qt.AlignmentFlag.AlignTop, words)
        painter.end()

    def _draw_ring(self, painter: QPainter, ring: QRectF) -> None:
        colours = colours_of(self.palette())
        own = self._progress
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(QPen(QColor(colours.line), 3))
        painter.drawEllipse(ring)
        share = min(1.0, own.good / own.wanted) if own.wanted else 0.0
        if share:
            painter.setPen(QPen(QColor(colours.info), 3, c=Qt.PenCapStyle.FlatCap))
            painter.drawArc(ring, 90 * 16, -round(share * 360 * 16))
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)
        painter.setPen(QColor(colours.text))
        painter.setFont(self._font(SMALL_PX, is_bold=own.good >= own.wanted > 0))
        text = QRectF(ring.right() + 5, 0, 38, self.height())
        painter.drawText(text, Qt.AlignmentFlag.AlignVCenter, f"{own.good}/{own.wanted}")
        sign = quality_sign(own.quality)
        if sign:
            is_poor = own.quality is Quality.POOR
            painter.setPen(QColor(colours.attention if is_poor else colours.text))
            painter.setFont(self._font(TEXT_PX, is_bold=True))
            painter.drawText(
                QRectF(self.width() - 13, 0, 11, self.height()), Qt.AlignmentFlag.AlignCenter, sign
            )

    def _name(self) -> None:
        own = self._progress
        words = f"{own.label} {self._words}: {own.good} of {own.wanted}, {own.quality.value}"
        spoken = f"{words}; next" if self._is_next else words
        self.setAccessibleName(spoken)
        self.setToolTip(spoken)

    def _font(self, size_px: int, is_bold: bool = False) -> QFont:
        font = QFont(self.font())
        font.setPixelSize(size_px)
        font.setBold(is_bold)
        return font


class GestureList(QFrame):
    """All gestures in their order; one is chosen. GUI thread only.

    Signals:
        chosen: A person chose the gesture with this label.
    """

    chosen = Signal(str)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("gestureList")
        self.setAccessibleName("Gestures to record")
        self.setMaximumWidth(_WIDTH_PX[1])
        group = QButtonGroup(self)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(2, 2, 2, 2)
        layout.setSpacing(1)
        self._rows: dict[str, GestureRow] = {}
        for each in GESTURES:
            row = GestureRow(each.label)
            row.clicked.connect(self._chooser(each.label))
            group.addButton(row)
            layout.addWidget(row)
            self._rows[each.label] = row

    def show_progress(
        self, progress: tuple[GestureProgress, ...], label: str, suggested: str
    ) -> None:
        """Show how far each gesture is.

        Args:
            progress: Of every gesture.
            label: The one at hand.
            suggested: The one to record next; empty when all is done.
        """
        for each in progress:
            if each.label in self._rows:
                is_next = each.label == suggested and suggested != label
                self._rows[each.label].show_progress(each, is_next=is_next)
        chosen = self._rows.get(label)
        if chosen is not None and not chosen.isChecked():
            chosen.setChecked(True)

    def _chooser(self, label: str) -> Callable[[], None]:
        return lambda: self.chosen.emit(label)
