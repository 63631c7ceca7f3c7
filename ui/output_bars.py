"""The small bars: what the network says to each gesture, with the marks it has to reach."""

from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QFont, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QSizePolicy, QWidget

from gestureapp.gestures import LABELS
from gestureapp.recognition.values import NO_GESTURE, Candidate, two_digits
from ui.theme import SMALL_PX, colours_of

_LABEL_PX = 15
_NUMBER_PX = 12
_NUMBERED = 0.25
"""From here on a bar has its number: what could be one of two candidates."""
_ROOMY = 26
"""Pixels for each bar; with less the labels are a pixel smaller."""
_EMPTY = (*LABELS, NO_GESTURE)
"""Before the first answer and where the network was not asked."""
_NONE_SHARE = 1.2
"""The word "none" is wider than the labels of gestures."""


class OutputBars(QWidget):
    """One bar per gesture, 0 to 1, with a dashed line at each threshold. GUI thread only.

    Where the recogniser knows "none of them", a last bar in another colour shows it.
    """

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("outputBars")
        self._outputs: tuple[Candidate, ...] = ()
        self._thresholds: tuple[float, ...] = ()
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setAccessibleName("Certainty of each gesture: none yet")

    def sizeHint(self) -> QSize:
        """Room for twelve labels and "none"."""
        return QSize(300, 84)

    def minimumSizeHint(self) -> QSize:
        """Below this the labels run into each other."""
        return QSize(288, 60)

    def show_outputs(
        self, outputs: tuple[Candidate, ...], thresholds: tuple[float, ...] = ()
    ) -> None:
        """Show other outputs; an empty tuple shows empty bars.

        Args:
            outputs: Of the network, 0 to 1.
            thresholds: What an answer needs; a line for each.
        """
        if (outputs, thresholds) == (self._outputs, self._thresholds):
            return
        self._outputs, self._thresholds = outputs, thresholds
        spoken = ", ".join(c.words for c in outputs) or "none"
        needed = " or ".join(f"{threshold:.2f}" for threshold in thresholds)
        self.setAccessibleName(
            f"Certainty of each gesture: {spoken}" + (f"; needed: {needed}" if needed else "")
        )
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw bars, labels and thresholds."""
        painter = QPainter(self)
        colours = colours_of(self.palette())
        font = QFont(self.font())
        candidates = self._outputs or tuple(Candidate(label, 0.0) for label in _EMPTY)
        is_narrow = self.width() < _ROOMY * len(candidates)
        font.setPixelSize(SMALL_PX - (2 if is_narrow else 1))
        painter.setFont(font)
        area = QRectF(0, _NUMBER_PX, self.width(), self.height() - _LABEL_PX - _NUMBER_PX)
        shares = [_NONE_SHARE if c.label == NO_GESTURE else 1.0 for c in candidates]
        left = 0.0
        for candidate, share in zip(candidates, shares, strict=True):
            width = self.width() * share / sum(shares)
            slot = QRectF(left, area.top(), width, area.height()).adjusted(3, 0, -3, 0)
            self._draw_bar(painter, slot, candidate)
            left += width
        painter.setPen(QPen(QColor(colours.text), 1, Qt.PenStyle.DashLine))
        for threshold in self._thresholds:
            y = area.bottom() - threshold * area.height()
            painter.drawLine(QPointF(0, y), QPointF(self.width(), y))
        painter.end()

    def _draw_bar(self, painter: QPainter, slot: QRectF, candidate: Candidate) -> None:
        colours = colours_of(self.palette())
        share = min(1.0, max(0.0, candidate.confidence))
        is_gesture = candidate.label != NO_GESTURE
        needed = min(self._thresholds, default=1.0)
        has_reached = is_gesture and candidate.confidence >= needed
        is_numbered = candidate.confidence >= _NUMBERED
        painter.fillRect(slot, QColor(colours.base))
        filled = QRectF(slot)
        filled.setTop(slot.bottom() - share * slot.height())
        bar = colours.info if has_reached else colours.line if is_gesture else colours.muted
        painter.fillRect(filled, QColor(bar))
        painter.setPen(QColor(colours.text if has_reached or is_numbered else colours.muted))
        below = QRectF(slot.left() - 3, slot.bottom() + 1, slot.width() + 6, _LABEL_PX - 1)
        whole = Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextDontClip
        painter.drawText(below, whole, candidate.label)
        if is_numbered:
            above = QRectF(slot.left() - 6, slot.top() - _NUMBER_PX, slot.width() + 12, _NUMBER_PX)
            painter.drawText(above, Qt.AlignmentFlag.AlignCenter, two_digits(candidate.confidence))
