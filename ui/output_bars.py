"""The twelve small bars: what the network says to each gesture, with the mark it has to reach."""

from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QFont, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QSizePolicy, QWidget

from gestureapp.gestures import LABELS
from gestureapp.recognition.values import Candidate
from ui.theme import SMALL_PX, colours_of

THRESHOLD = 0.5
"""Source: the paper, section IV.C; exactly one output has to reach it."""
_LABEL_PX = 15
_NUMBER_PX = 12


class OutputBars(QWidget):
    """One bar per gesture, 0 to 1, with a dashed line at the threshold. GUI thread only."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("outputBars")
        self._outputs: tuple[Candidate, ...] = ()
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setAccessibleName("Certainty of each gesture: none yet")

    def sizeHint(self) -> QSize:
        """Room for twelve labels."""
        return QSize(300, 84)

    def minimumSizeHint(self) -> QSize:
        """Below this the labels run into each other."""
        return QSize(288, 60)

    def show_outputs(self, outputs: tuple[Candidate, ...]) -> None:
        """Show other outputs; an empty tuple shows empty bars."""
        if outputs == self._outputs:
            return
        self._outputs = outputs
        spoken = ", ".join(f"{c.label} {c.confidence:.2f}" for c in outputs) or "none"
        self.setAccessibleName(f"Certainty of each gesture: {spoken}")
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw bars, labels and threshold."""
        painter = QPainter(self)
        colours = colours_of(self.palette())
        font = QFont(self.font())
        font.setPixelSize(SMALL_PX - 1)
        painter.setFont(font)
        candidates = self._outputs or tuple(Candidate(label, 0.0) for label in LABELS)
        width = self.width() / len(candidates)
        area = QRectF(0, _NUMBER_PX, self.width(), self.height() - _LABEL_PX - _NUMBER_PX)
        for i, candidate in enumerate(candidates):
            slot = QRectF(i * width, area.top(), width, area.height()).adjusted(3, 0, -3, 0)
            self._draw_bar(painter, slot, candidate)
        y = area.bottom() - THRESHOLD * area.height()
        painter.setPen(QPen(QColor(colours.text), 1, Qt.PenStyle.DashLine))
        painter.drawLine(QPointF(0, y), QPointF(self.width(), y))
        painter.end()

    def _draw_bar(self, painter: QPainter, slot: QRectF, candidate: Candidate) -> None:
        colours = colours_of(self.palette())
        share = min(1.0, max(0.0, candidate.confidence))
        has_reached = candidate.confidence >= THRESHOLD
        painter.fillRect(slot, QColor(colours.base))
        filled = QRectF(slot)
        filled.setTop(slot.bottom() - share * slot.height())
        painter.fillRect(filled, QColor(colours.info if has_reached else colours.line))
        painter.setPen(QColor(colours.text if has_reached else colours.muted))
        below = QRectF(slot.left() - 3, slot.bottom() + 1, slot.width() + 6, _LABEL_PX - 1)
        painter.drawText(below, Qt.AlignmentFlag.AlignCenter, candidate.label)
        if has_reached:
            above = QRectF(slot.left() - 6, slot.top() - _NUMBER_PX, slot.width() + 12, _NUMBER_PX)
            painter.drawText(above, Qt.AlignmentFlag.AlignCenter, f"{candidate.confidence:.2f}")
