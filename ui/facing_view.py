"""Which way the operator faces: the robot's base from above, the operator, and both their axes."""

import math
from typing import Final

from PySide6.QtCore import QLineF, QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QBrush, QColor, QFont, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QSizePolicy, QWidget

from ui.theme import SMALL_PX, Colours, colours_of

TURNS: Final = (0, 90, 180, -90)
"""From the robot's X+ to where the operator faces, degrees, counter-clockwise seen from above."""
_AXES: Final = ("X+", "Y+", "X-", "Y-")
"""Of the robot, each a quarter turn to the left of the one before."""
_BASE_SHARE: Final = 0.15
_REACH_SHARE: Final = 0.23
_OPERATOR_SHARE: Final = 0.14
_STAND_SHARE: Final = 0.44
"""From the robot to the operator, of the drawing's smaller side."""


def robot_axis(operator_axis: str, turn_deg: float) -> str:
    """The robot's axis that one of the operator's points along.

    Args:
        operator_axis: ``X+`` (forward), ``Y+`` (to the left), ``X-`` or ``Y-``.
        turn_deg: Which way the operator faces; a multiple of 90.
    """
    return _AXES[(_AXES.index(operator_axis) + round(turn_deg / 90)) % 4]


def facing_text(turn_deg: float) -> str:
    """Which of the robot's axes the operator's gestures mean, in words."""
    forward, left = robot_axis("X+", turn_deg), robot_axis("Y+", turn_deg)
    return (
        f"Forward (the gesture X+) moves the robot along its {forward}; to the left (Y+) along "
        f"its {left}. Up stays up."
    )


class FacingView(QWidget):
    """The robot's base in the middle and the operator behind it, looking over it.

    Attributes:
        turn_deg: Which way the operator faces, as in the settings.
    """

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("facingView")
        self.turn_deg = 0.0
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setAccessibleName(facing_text(0))

    def sizeHint(self) -> QSize:
        """A square."""
        return QSize(280, 280)

    def minimumSizeHint(self) -> QSize:
        """The letters can still be told apart."""
        return QSize(150, 130)

    def show_turn(self, turn_deg: float) -> None:
        """Draw another way."""
        if turn_deg != self.turn_deg:
            self.turn_deg = turn_deg
            self.setAccessibleName(facing_text(turn_deg))
            self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw robot, operator and their axes."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        colours = colours_of(self.palette())
        font = QFont(painter.font())
        font.setPixelSize(SMALL_PX)
        painter.setFont(font)
        size, centre = float(min(self.width(), self.height())), QRectF(self.rect()).center()
        _draw_robot(painter, centre, size, colours)
        ahead = _along(self.turn_deg, 1.0)
        _draw_operator(painter, centre - ahead * size * _STAND_SHARE, size, self.turn_deg, colours)
        painter.end()


def _along(turn_deg: float, length: float) -> QPointF:
    """That far along a direction; the robot's X+ to the right, its Y+ up, as in the top view."""
    angle = math.radians(turn_deg)
    return QPointF(math.cos(angle), -math.sin(angle)) * length


def _draw_robot(painter: QPainter, centre: QPointF, size: float, colours: Colours) -> None:
    half = size * _BASE_SHARE / 2
    grey = QColor(colours.muted)
    painter.setPen(QPen(grey, 1.5))
    painter.setBrush(QColor(colours.panel))
    painter.drawRect(QRectF(centre.x() - half, centre.y() - half, 2 * half, 2 * half))
    painter.drawEllipse(centre, half * 0.6, half * 0.6)
    span = (half, size * _REACH_SHARE)
    for turn, name in ((0, "robot X+"), (90, "robot Y+")):
        _draw_arrow(painter, centre, turn, span, grey)
        _name_beside(painter, centre + _along(turn, (span[0] + span[1]) / 2), turn, half + 3, name)


def _draw_operator(
    painter: QPainter, at: QPointF, size: float, turn_deg: float, colours: Colours
) -> None:
    """Shoulders and head from above, and the way of the two gestures."""
    span = (size * 0.04, size * _OPERATOR_SHARE)
    for turn in (0, 90):
        _draw_arrow(painter, at, turn_deg + turn, span, QColor(colours.info))
    _name_beside(
        painter, at + _along(turn_deg, span[1] * 0.7), turn_deg, size * 0.075 + 3, "X+ forward"
    )
    _name_beside(painter, at + _along(turn_deg + 90, span[1]), turn_deg + 180, 3, "Y+ left")
    painter.save()
    painter.translate(at)
    painter.rotate(-turn_deg)
    painter.setPen(QPen(QColor(colours.text), 1.5))
    painter.setBrush(QColor(colours.base))
    painter.drawEllipse(QPointF(0, 0), size * 0.03, size * 0.075)
    painter.setBrush(QColor(colours.text))
    painter.drawEllipse(QPointF(0, 0), size * 0.025, size * 0.025)
    painter.restore()


def _draw_arrow(
    painter: QPainter, centre: QPointF, turn_deg: float, span: tuple[float, float], colour: QColor
) -> None:
    """An arrow from one distance to another."""
    begin, tip = centre + _along(turn_deg, span[0]), centre + _along(turn_deg, span[1])
    painter.setPen(QPen(colour, 2))
    painter.drawLine(QLineF(begin, tip))
    painter.setBrush(QBrush(colour))
    wings = [tip + _along(turn_deg + side, 9) for side in (155, -155)]
    painter.drawPolygon(QPolygonF([tip, *wings]))


def _name_beside(painter: QPainter, at: QPointF, turn_deg: float, gap: float, name: str) -> None:
    """A name to the right of a place on an arrow that points there, in the arrow's colour."""
    room = painter.fontMetrics().boundingRect(name)
    box = QRectF(0, 0, room.width() + 6, room.height() + 2)
    away = _along(turn_deg - 90, 1.0)
    reach = QPointF(away.x() * (box.width() / 2 + 8), away.y() * (box.height() / 2 + gap))
    box.moveCenter(at + reach)
    painter.drawText(box, Qt.AlignmentFlag.AlignCenter, name)
