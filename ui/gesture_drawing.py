"""The drawing of a gesture: an arm that shows what to do, still or moving."""

import numpy as np
from PySide6.QtCore import QPointF, QRectF, QSize, Qt, QTimer
from PySide6.QtGui import (
    QBrush,
    QColor,
    QHideEvent,
    QPainter,
    QPaintEvent,
    QPen,
    QPolygonF,
    QShowEvent,
)
from PySide6.QtWidgets import QSizePolicy, QWidget

from gestureapp.clock import Clock, monotonic
from gestureapp.simulation.motion import minimum_jerk
from ui.arm_figure import Look, Shape, box_of, figure, words_of
from ui.theme import Colours, colours_of, mixed

FRAME_MS = 33
PAUSE_S, MOVE_S, HOLD_S, BACK_S = 0.5, 0.6, 0.9, 1.0
"""At the start, to the end as quickly as a person does it, there, and slowly back."""
CYCLE_S = PAUSE_S + MOVE_S + HOLD_S + BACK_S
ICON_PX = 90
"""Below this a drawing is still and shows the arm and a broad arrow alone."""
_BOLD_PX = 180
_MARGIN_M = 0.02


def share_at(t_s: float) -> float:
    """How much of the movement is done at this time after the drawing began; it repeats.

    Minimum jerk there and back, as a hand moves.
    """
    t_s %= CYCLE_S
    if t_s < PAUSE_S + MOVE_S:
        return _eased((t_s - PAUSE_S) / MOVE_S)
    return 1.0 - _eased((t_s - PAUSE_S - MOVE_S - HOLD_S) / BACK_S)


class GestureDrawing(QWidget):
    """One gesture, large and moving; ``set_animated(False)`` for a still one. GUI thread only.

    The timer runs only while the drawing is to be seen.

    Args:
        label: A gesture's label, ``LEFT_STOP`` or ``LEFT_START``; empty draws nothing.
        clock: Monotonic seconds.
        is_animated: Whether the arm moves.
        parent: Qt's.

    Attributes:
        label: What is drawn.
        is_animated: Whether the arm moves while it is to be seen.
    """

    def __init__(
        self,
        label: str = "",
        clock: Clock = monotonic,
        is_animated: bool = True,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.setObjectName("gestureDrawing")
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.label = ""
        self.is_animated = is_animated
        self._clock = clock
        self._began_s = clock()
        self._drawn = float("nan")
        self._timer = QTimer(self)
        self._timer.setInterval(FRAME_MS)
        self._timer.timeout.connect(self._tick)
        self.setAccessibleName("Drawing: nothing")
        self.set_gesture(label)

    def set_gesture(self, label: str) -> None:
        """Draw another gesture, from its start; the same one goes on as it is.

        Raises:
            KeyError: nothing of this name can be drawn.
        """
        if label == self.label:
            return
        words = words_of(label) if label else "nothing"
        self.label = label
        self._began_s = self._clock()
        self.setAccessibleName(f"Drawing: {label} {words}" if label else "Drawing: nothing")
        self._run_timer()
        self.update()

    def set_animated(self, is_animated: bool) -> None:
        """Let the arm move, from its start, or show it still at the end of the movement."""
        if is_animated is self.is_animated:
            return
        self.is_animated = is_animated
        self._began_s = self._clock()
        self._run_timer()
        self.update()

    @property
    def share(self) -> float:
        """How much of the movement the drawing shows as done now, 0 to 1."""
        return share_at(self._clock() - self._began_s) if self.is_animated else 1.0

    @property
    def is_running(self) -> bool:
        """Whether frames are drawn by themselves now."""
        return self._timer.isActive()

    def sizeHint(self) -> QSize:
        """Large enough for three metres."""
        return QSize(420, 320)

    def minimumSizeHint(self) -> QSize:
        """An icon in a list."""
        return QSize(28, 24)

    def showEvent(self, event: QShowEvent) -> None:
        """Begin from the start posture."""
        super().showEvent(event)
        self._began_s = self._clock()
        self._run_timer()

    def hideEvent(self, event: QHideEvent) -> None:
        """Nothing is drawn, nothing is timed."""
        super().hideEvent(event)
        self._run_timer()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the arm."""
        if not self.label:
            return
        painter = QPainter(self)
        colours = colours_of(self.palette())
        self._drawn = self.share
        paint_figure(painter, QRectF(self.rect()), self.label, self._drawn, colours)
        painter.end()

    def _tick(self) -> None:
        """Draw another frame, unless the hand stands still."""
        if self.share != self._drawn:
            self.update()

    def _run_timer(self) -> None:
        if self.is_animated and self.label and self.isVisible():
            self._timer.start()
        else:
            self._timer.stop()


def paint_figure(
    painter: QPainter, area: QRectF, label: str, share: float, colours: Colours
) -> None:
    """Draw a gesture into an area, as large as fits.

    Args:
        painter: Of the widget or picture.
        area: Where, in the painter's units.
        label: A gesture's label, ``LEFT_STOP`` or ``LEFT_START``.
        share: How much of the movement is done, 0 to 1.
        colours: The scheme.

    Raises:
        KeyError: nothing of this name can be drawn.
    """
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    size_px = min(area.width(), area.height())
    is_icon = size_px < ICON_PX
    box = box_of(label, is_icon)
    wide, high = box.right - box.left + _MARGIN_M, box.top - box.bottom + _MARGIN_M
    scale = min(area.width() / wide, area.height() / high)
    dx = area.center().x() - scale * (box.left + box.right) / 2
    dy = area.center().y() + scale * (box.bottom + box.top) / 2
    looks = _looks(colours, 2.0 if size_px > _BOLD_PX else 1.0)
    for shape in figure(label, share, is_icon):
        pen, brush = looks[shape.look]
        painter.setPen(pen)
        painter.setBrush(brush)
        _paint(painter, shape, scale, dx, dy)


def _paint(painter: QPainter, shape: Shape, scale: float, dx: float, dy: float) -> None:
    points = QPolygonF([QPointF(dx + scale * x, dy - scale * y) for x, y in shape.points])
    if shape.look is Look.EDGE:
        painter.drawPolyline(points)
    else:
        painter.drawPolygon(points)


def _looks(colours: Colours, line_px: float) -> dict[Look, tuple[QPen, QBrush]]:
    """Line and filling of everything; two colours and greys."""
    text, info = QColor(colours.text), QColor(colours.info)
    none, empty = QPen(Qt.PenStyle.NoPen), QBrush(Qt.BrushStyle.NoBrush)
    join = Qt.PenJoinStyle.RoundJoin
    line = QPen(text, line_px, j=join)
    ghost = QPen(QColor(colours.line), line_px, j=join)
    paper = QBrush(QColor(colours.base))
    shade = QBrush(mixed(colours.line, colours.base, 0.5))
    return {
        Look.FLOOR: (QPen(mixed(colours.line, colours.panel, 0.7), 1.0), empty),
        Look.SHADOW: (none, QBrush(mixed(colours.line, colours.panel, 0.35))),
        Look.GHOST: (ghost, QBrush(mixed(colours.line, colours.panel, 0.2))),
        Look.SKIN: (line, paper),
        Look.SIDE: (none, shade),
        Look.EDGE: (QPen(text, 1.0), empty),
        Look.SENSOR: (QPen(QColor(colours.base), 1.0, j=join), QBrush(text)),
        Look.ARROW: (QPen(QColor(colours.base), 1.0, j=join), QBrush(info)),
    }


def _eased(tau: float) -> float:
    position, _, _ = minimum_jerk(np.array(tau))
    return float(position)
