"""The field of operation from the side and from above, to scale, with the tool and its way."""

from collections.abc import Iterator
from dataclasses import dataclass

from PySide6.QtCore import QLineF, QPointF, QRectF, QSize, QSizeF, Qt
from PySide6.QtGui import (
    QBrush,
    QColor,
    QFont,
    QFontMetricsF,
    QPainter,
    QPainterPath,
    QPaintEvent,
    QPen,
    QPolygonF,
)
from PySide6.QtWidgets import QFrame, QSizePolicy, QWidget

from gestureapp.cell.snapshot import RobotView
from gestureapp.config import RobotSettings
from gestureapp.robot.values import Pose, PoseIncrement
from ui.field_names import NAME_LENGTH, beside, best_place, short_name, within
from ui.theme import SMALL_PX, TEXT_PX, Colours, colours_of
from ui.words import end_of, pose_age_text

_PATH_STEP_MM = 2.0
_PATH_LIMIT = 2000
"""Points kept of the path; at 2 mm each longer than the field is wide."""
_ROOM_PX = 10
_LABELLED_MM = 1000
_TOOL_PX = 9
"""From the middle of the tool's cross to its ends."""


@dataclass(frozen=True, slots=True)
class Plane:
    """Which two axes a view shows, and its heading."""

    title: str
    across: int
    up: int


SIDE = Plane("Side view", 0, 2)
TOP = Plane("Top view", 0, 1)


class FieldView(QFrame):
    """Both views beside each other at one scale. GUI thread only, owned by the window.

    Attributes:
        path_mm: Where the tool has been since the move began, robot frame.
    """

    def __init__(self, settings: RobotSettings, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("robotView")
        self.path_mm: list[tuple[float, float, float]] = []
        self._settings = settings
        self._robot = RobotView(False, "")
        self._move: tuple[Pose | None, PoseIncrement | None] = (None, None)
        self._drawn: tuple[object, ...] = ()
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setAccessibleName("Robot: no position")
        self._name_keep_outs()

    def sizeHint(self) -> QSize:
        """Two squares."""
        return QSize(480, 250)

    def minimumSizeHint(self) -> QSize:
        """Small, but the axes can still be read."""
        return QSize(360, 170)

    def show_settings(self, settings: RobotSettings) -> None:
        """Show another field; repaints only when it is another one."""
        if settings != self._settings:
            self._settings = settings
            self._name_keep_outs()
            self.update()

    def show_robot(self, robot: RobotView) -> None:
        """Show another moment; repaints only when something has moved."""
        if (robot.start, robot.increment) != self._move:
            self._move = (robot.start, robot.increment)
            self.path_mm = []
        self._robot = robot
        if robot.pose is not None:
            self._extend_path(robot.pose)
        drawn = (robot.pose, self._move, len(self.path_mm), pose_age_text(robot))
        if drawn != self._drawn:
            self._drawn = drawn
            self._say(robot)
            self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw both views."""
        super().paintEvent(event)
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        colours = colours_of(self.palette())
        half = self.width() / 2
        for i, plane in enumerate((SIDE, TOP)):
            area = QRectF(i * half, 0, half, self.height()).adjusted(4, 5, -4, -4)
            _View(painter, area, plane, self._settings, colours).draw(self._robot, self.path_mm)
        painter.end()

    def _extend_path(self, pose: Pose) -> None:
        here = pose.position_mm
        if self.path_mm:
            gone = sum((a - b) ** 2 for a, b in zip(here, self.path_mm[-1], strict=True))
            if gone < _PATH_STEP_MM**2:
                return
        self.path_mm.append(here)
        del self.path_mm[:-_PATH_LIMIT]

    def _name_keep_outs(self) -> None:
        """Names too long for the picture in full."""
        boxes = self._settings.keep_outs
        self.setToolTip("\n".join(box.name for box in boxes if len(box.name) > NAME_LENGTH))

    def _say(self, robot: RobotView) -> None:
        if robot.pose is None:
            self.setAccessibleName("Robot: no position")
        else:
            where = "X {:.0f} Y {:.0f} Z {:.0f} mm".format(*robot.pose.position_mm)
            self.setAccessibleName(f"Robot: tool at {where}")


@dataclass(frozen=True, slots=True)
class _Body:
    """What the tool stays out of, on the screen; a column has no name, it is the robot."""

    area: QRectF
    name: str = ""
    is_round: bool = False
    is_bound: bool = False
    """Floor or ceiling: has its name inside, a box beside it."""


class _View:
    """One view while it is painted: the scale and the pens."""

    def __init__(
        self,
        painter: QPainter,
        area: QRectF,
        plane: Plane,
        settings: RobotSettings,
        colours: Colours,
    ) -> None:
        self._painter = painter
        self._plane = plane
        self._settings = settings
        self._colours = colours
        self._frame = area.adjusted(0, TEXT_PX + 6, 0, 0)
        self._title = QRectF(area.left() + 8, area.top(), area.width() - 8, TEXT_PX + 6)
        room = min(self._frame.width(), self._frame.height()) / 2 - _ROOM_PX
        self._scale = max(room, 10.0) / settings.ext_radius_mm
        self._font = QFont(painter.font())

    def draw(self, robot: RobotView, path_mm: list[tuple[float, float, float]]) -> None:
        """Draw everything of this view."""
        self._painter.save()
        self._draw_field()
        self._draw_bodies()
        self._draw_axes()
        self._name_bodies(robot)
        self._draw_bodies(is_outline=True)
        self._painter.setClipRect(self._frame)
        if len(path_mm) > 1:
            self._painter.setPen(QPen(QColor(self._colours.text), 2))
            self._painter.drawPolyline(QPolygonF([self._at(point) for point in path_mm]))
        if robot.start is not None and robot.increment is not None:
            self._draw_plan(robot.start, robot.increment)
        if robot.pose is not None:
            self._draw_tool(robot.pose)
        self._painter.restore()
        old = pose_age_text(robot)
        if old:
            self._write(self._title.adjusted(0, 2, -6, 0), old, Qt.AlignmentFlag.AlignRight)

    def _at(self, position_mm: tuple[float, float, float]) -> QPointF:
        across, up = position_mm[self._plane.across], position_mm[self._plane.up]
        return self._frame.center() + QPointF(across, -up) * self._scale

    def _draw_field(self) -> None:
        painter, colours = self._painter, self._colours
        centre = self._frame.center()
        for radius_mm, fill in (
            (self._settings.ext_radius_mm, colours.base),
            (self._settings.int_radius_mm, colours.panel),
        ):
            radius = radius_mm * self._scale
            painter.setPen(QPen(QColor(colours.line), 1.5))
            painter.setBrush(QColor(fill))
            painter.drawEllipse(centre, radius, radius)
            corner = centre + QPointF(-0.6, 0.8) * radius
            label = QRectF(corner.x() - 62, corner.y() + 1, 60, 16)
            self._write(label, f"R {radius_mm:.0f}", Qt.AlignmentFlag.AlignRight)
        painter.setBrush(Qt.BrushStyle.NoBrush)

    def _draw_bodies(self, *, is_outline: bool = False) -> None:
        """What the tool stays out of, hatched or in outline, as far as it lies inside the field."""
        painter, inside = self._painter, QPainterPath()
        radius = self._settings.ext_radius_mm * self._scale
        inside.addEllipse(self._frame.center(), radius, radius)
        painter.save()
        painter.setClipPath(inside)
        painter.setPen(QPen(QColor(self._colours.muted), 1))
        hatching = QBrush(QColor(self._colours.line), Qt.BrushStyle.BDiagPattern)
        painter.setBrush(QBrush() if is_outline else hatching)
        for body in self._bodies():
            if self._plane is TOP and body.is_round:
                painter.drawEllipse(body.area)
            else:
                painter.drawRect(body.area)
        painter.restore()

    def _bodies(self) -> Iterator["_Body"]:
        """The bodies that can be seen from here; floor and ceiling from the side only."""
        s, far = self._settings, self._settings.ext_radius_mm
        out = s.column_radius_mm
        if self._plane is SIDE:
            floor, ceiling = max(-far, s.floor_mm), min(far, s.ceiling_mm)
            if floor > -far:
                area = self._area((-far, -far), (far, floor))
                yield _Body(area, f"floor {floor:.0f}", is_bound=True)
            if ceiling < far:
                area = self._area((-far, ceiling), (far, far))
                yield _Body(area, f"ceiling {ceiling:.0f}", is_bound=True)
            top = min(s.column_top_mm, ceiling)
            if out and top > floor:
                yield _Body(self._area((-out, floor), (out, top)))
        elif out:
            yield _Body(self._area((-out, -out), (out, out)), is_round=True)
        across, up = self._plane.across, self._plane.up
        for box in s.keep_outs:
            low, high = box.low_mm, box.high_mm
            area = self._area((low[across], low[up]), (high[across], high[up]))
            yield _Body(area, box.name)

    def _area(self, low_mm: tuple[float, float], high_mm: tuple[float, float]) -> QRectF:
        centre, scale = self._frame.center(), self._scale
        corner = centre + QPointF(low_mm[0], -low_mm[1]) * scale
        return QRectF(corner, centre + QPointF(high_mm[0], -high_mm[1]) * scale).normalized()

    def _name_bodies(self, robot: RobotView) -> None:
        """The names, on patches that keep hatching and axes away from them."""
        self._font.setBold(False)
        self._font.setPixelSize(SMALL_PX - 1)
        self._painter.setFont(self._font)
        for name, patch in self._places_of_names(robot):
            self._painter.fillRect(patch, QColor(self._colours.base))
            self._painter.setPen(QPen(QColor(self._colours.muted), 1))
            self._painter.drawText(patch, Qt.AlignmentFlag.AlignCenter, name)

    def _places_of_names(self, robot: RobotView) -> Iterator[tuple[str, QRectF]]:
        """Each name, short, with its patch: off the boxes, the tool and each other if it can be."""
        metrics = QFontMetricsF(self._font)
        view = self._frame.adjusted(2, 2, -2, -2)
        bodies = [body for body in self._bodies() if body.area.intersects(view)]
        boxes = [body.area for body in bodies if not body.is_bound]
        kept_free = [*self._corners(), *self._marks(robot)]
        for body in bodies:
            if not body.name:
                continue
            name = body.name if body.is_bound else short_name(body.name)
            size = QSizeF(metrics.horizontalAdvance(name) + 6, metrics.height())
            if body.is_bound:
                places = within(size, body.area, view, 6)
            else:
                places = beside(size, body.area, view)
            patch = best_place(places, kept_free, boxes)
            kept_free.append(patch)
            yield name, patch

    def _marks(self, robot: RobotView) -> Iterator[QRectF]:
        """Where the tool's cross and both ends of the move are drawn."""
        if robot.pose is not None:
            yield self._around(robot.pose, _TOOL_PX + 2)
        if robot.start is not None and robot.increment is not None:
            yield self._around(robot.start, 6)
            yield self._around(end_of(robot.start, robot.increment), 6)

    def _around(self, pose: Pose, reach_px: float) -> QRectF:
        reach, here = QPointF(reach_px, reach_px), self._at(pose.position_mm)
        return QRectF(here - reach, here + reach)

    def _corners(self) -> tuple[QRectF, QRectF]:
        """Where the axes are named, across and up: free of the field, whatever the tool does."""
        frame = self._frame
        return (
            QRectF(frame.right() - 84, frame.bottom() - 18, 80, 16),
            QRectF(frame.left() + 4, frame.top() + 2, 80, 16),
        )

    def _draw_axes(self) -> None:
        painter, frame = self._painter, self._frame
        centre = frame.center()
        names = "XYZ"
        self._write(self._title, self._plane.title, Qt.AlignmentFlag.AlignLeft, is_bold=True)
        painter.setPen(QPen(QColor(self._colours.line), 1))
        painter.drawLine(QLineF(frame.left(), centre.y(), frame.right(), centre.y()))
        painter.drawLine(QLineF(centre.x(), frame.top(), centre.x(), frame.bottom()))
        for mm in range(-1000, 1001, 500):
            step = mm * self._scale
            painter.drawLine(
                QLineF(centre.x() + step, centre.y() - 3, centre.x() + step, centre.y() + 3)
            )
            painter.drawLine(
                QLineF(centre.x() - 3, centre.y() - step, centre.x() + 3, centre.y() - step)
            )
        if self._settings.ext_radius_mm > _LABELLED_MM:
            at = centre.x() - _LABELLED_MM * self._scale
            above = QRectF(at - 30, centre.y() - 19, 60, 16)
            self._write(above, f"-{_LABELLED_MM}", Qt.AlignmentFlag.AlignHCenter)
        across, up = (
            f"{names[self._plane.across]}+ \u2192 mm",
            f"{names[self._plane.up]}+ \u2191 mm",
        )
        low, high = self._corners()
        self._write(low, across, Qt.AlignmentFlag.AlignRight)
        self._write(high, up, Qt.AlignmentFlag.AlignLeft)

    def _draw_plan(self, start: Pose, increment: PoseIncrement) -> None:
        begin = self._at(start.position_mm)
        end = self._at(end_of(start, increment).position_mm)
        blue = QColor(self._colours.info)
        self._painter.setPen(QPen(blue, 2, Qt.PenStyle.DashLine))
        self._painter.drawLine(begin, end)
        self._painter.setPen(QPen(blue, 2))
        self._painter.drawEllipse(begin, 3, 3)
        self._painter.drawRect(QRectF(end.x() - 4, end.y() - 4, 8, 8))

    def _draw_tool(self, pose: Pose) -> None:
        here = self._at(pose.position_mm)
        self._painter.setPen(QPen(QColor(self._colours.text), 1.5))
        self._painter.drawLine(here - QPointF(_TOOL_PX, 0), here + QPointF(_TOOL_PX, 0))
        self._painter.drawLine(here - QPointF(0, _TOOL_PX), here + QPointF(0, _TOOL_PX))
        self._painter.setBrush(QColor(self._colours.text))
        self._painter.drawEllipse(here, 4, 4)
        self._painter.setBrush(Qt.BrushStyle.NoBrush)

    def _write(
        self, area: QRectF, text: str, alignment: Qt.AlignmentFlag, is_bold: bool = False
    ) -> None:
        self._font.setBold(is_bold)
        self._font.setPixelSize(TEXT_PX if is_bold else SMALL_PX - 1)
        self._painter.setFont(self._font)
        self._painter.setPen(QColor(self._colours.text if is_bold else self._colours.muted))
        self._painter.drawText(area, alignment | Qt.AlignmentFlag.AlignTop, text)
