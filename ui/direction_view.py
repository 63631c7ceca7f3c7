"""A drawing of the robot's axes with the arrow that the gesture asks for."""

from math import cos, hypot, pi, sin

from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QFont, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QSizePolicy, QWidget

from gestureapp.robot.values import Direction
from ui.theme import SMALL_PX, colours_of
from ui.words import AXES, direction_text

_ON_SCREEN = (QPointF(0.86, -0.42), QPointF(-0.86, -0.42), QPointF(0.0, -0.95))
"""+X, +Y, +Z seen from behind, from the right and from above; screen y points down."""
_ARC_FROM, _ARC_TO, _ARC_STEPS = -0.75 * pi, 0.75 * pi, 36


class DirectionView(QWidget):
    """Three axes, and a thick arrow along one of them or around it. GUI thread only."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("directionView")
        self._direction: Direction | None = None
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setAccessibleName("Direction of the robot: none")

    def sizeHint(self) -> QSize:
        """Large enough to tell the axes apart at a glance."""
        return QSize(130, 110)

    def minimumSizeHint(self) -> QSize:
        """Below this the letters touch the arrow."""
        return QSize(100, 90)

    def show_direction(self, direction: Direction | None) -> None:
        """Show another direction, or the axes alone."""
        if direction == self._direction:
            return
        self._direction = direction
        words = direction_text(direction) if direction is not None else "none"
        self.setAccessibleName(f"Direction of the robot: {words}")
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw axes and arrow."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        colours = colours_of(self.palette())
        font = QFont(self.font())
        font.setPixelSize(SMALL_PX)
        painter.setFont(font)
        unit = min(self.width() / 2 - 24, self.height() / 2 - 10)
        centre = QPointF(self.width() / 2, self.height() / 2)
        for axis in range(3):
            self._draw_axis(
                painter, centre, unit, axis, QColor(colours.line), QColor(colours.muted)
            )
        if self._direction is not None:
            painter.setPen(_arrow_pen(QColor(colours.info), unit))
            painter.setBrush(QColor(colours.info))
            points = _arrow_points(self._direction, centre, unit)
            painter.drawPolyline(QPolygonF(points[:-1]))
            _draw_head(painter, points, max(7.0, unit / 5))
        painter.end()

    def _draw_axis(
        self,
        painter: QPainter,
        centre: QPointF,
        unit: float,
        axis: int,
        line: QColor,
        text: QColor,
    ) -> None:
        reach = _ON_SCREEN[axis] * unit * 0.85
        painter.setPen(QPen(line, 1.5))
        painter.drawLine(centre - reach, centre + reach)
        at = centre + _ON_SCREEN[axis] * (unit + 2)
        painter.setPen(text)
        box = QRectF(at.x() - 14, at.y() - 9, 28, 18)
        painter.drawText(box, Qt.AlignmentFlag.AlignCenter, f"{AXES[axis]}+")


def _arrow_pen(colour: QColor, unit: float) -> QPen:
    return QPen(colour, max(3.0, unit / 11), c=Qt.PenCapStyle.FlatCap, j=Qt.PenJoinStyle.RoundJoin)


def _arrow_points(direction: Direction, centre: QPointF, unit: float) -> list[QPointF]:
    axis = _ON_SCREEN[direction.axis]
    if not direction.is_rotation:
        end = axis * unit * 0.8 * direction.sign
        return [centre - end * 0.6, centre + end * 0.85, centre + end]
    # The two other axes span the plane of the turn; their cyclic order makes it right-handed.
    first, second = _ON_SCREEN[(direction.axis + 1) % 3], _ON_SCREEN[(direction.axis + 2) % 3]
    middle = centre + axis * unit * 0.3
    turn = [_ARC_FROM + (_ARC_TO - _ARC_FROM) * i / _ARC_STEPS for i in range(_ARC_STEPS + 1)]
    if direction.sign < 0:
        turn.reverse()
    return [middle + (first * cos(a) + second * sin(a)) * unit * 0.55 for a in turn]


def _draw_head(painter: QPainter, points: list[QPointF], size: float) -> None:
    tip, before = points[-1], points[-2]
    along = tip - before
    length = hypot(along.x(), along.y()) or 1.0
    ahead = along / length * size
    side = QPointF(-ahead.y(), ahead.x()) * 0.8
    base = before
    painter.setPen(Qt.PenStyle.NoPen)
    painter.drawPolygon(QPolygonF([base + ahead * 1.3, base + side, base - side]))
