"""A ring that fills while something is held still, and bears a tick when it is done."""

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPen

from gestureapp.setup.values import PositionState
from ui.theme import Colours

_TOP = 90 * 16
_TURN = 360 * 16


def paint_ring(
    painter: QPainter, area: QRectF, state: PositionState, progress: float, colours: Colours
) -> None:
    """Draw a dashed ring (missing), a filling one (hold still), or one with a tick (done).

    Args:
        painter: Of the widget.
        area: A square.
        state: Which of the three.
        progress: 0 to 1, of the time to be held still.
        colours: The scheme.
    """
    width = max(2.0, area.width() / 9)
    ring = area.adjusted(width / 2, width / 2, -width / 2, -width / 2)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    flat = Qt.PenCapStyle.FlatCap
    if state is PositionState.MISSING:
        painter.setPen(QPen(QColor(colours.muted), width / 2, Qt.PenStyle.DotLine))
        painter.drawEllipse(ring)
    elif state is PositionState.HOLD_STILL:
        painter.setPen(QPen(QColor(colours.line), width, c=flat))
        painter.drawEllipse(ring)
        painter.setPen(QPen(QColor(colours.info), width, c=flat))
        painter.drawArc(ring, _TOP, -round(_TURN * min(1.0, max(0.0, progress))))
    else:
        painter.setPen(QPen(QColor(colours.text), width / 2))
        painter.drawEllipse(ring)
        _paint_tick(painter, ring, QColor(colours.text), width)


def _paint_tick(painter: QPainter, ring: QRectF, colour: QColor, width: float) -> None:
    cap, join = Qt.PenCapStyle.RoundCap, Qt.PenJoinStyle.RoundJoin
    painter.setPen(QPen(colour, width, c=cap, j=join))
    left, top, size = ring.left(), ring.top(), ring.width()
    corners = [(0.28, 0.54), (0.44, 0.70), (0.74, 0.34)]
    painter.drawPolyline([QPointF(left + u * size, top + v * size) for u, v in corners])
