"""How far the right hand is from level, as a spirit level and in words."""

import math

from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QFont, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QSizePolicy, QWidget

from ui.theme import TEXT_PX, colours_of
from ui.train_words import level_text

_FULL_DEG = 45.0
"""The bubble is at the end of the tube from here on."""
_STEP_DEG = 0.5
"""Less than this moves the bubble by less than a pixel."""
_TUBE_PX = 120
_STACKED_PX = 52
"""From this height on the words stand under the tube, else beside it."""


class LevelView(QWidget):
    """A tube with a bubble that leaves the middle as the hand tilts. GUI thread only.

    Attributes:
        text: What it says.
    """

    def __init__(self, name: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName(name)
        self.text = ""
        self._tilt_deg, self._is_wrong = math.nan, False
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.show_tilt(math.nan, False)

    def show_tilt(
        self,
        tilt_deg: float,
        is_level: bool,
        *,
        is_moving: bool = False,
        is_level_wanted: bool = True,
    ) -> None:
        """Show another tilt.

        Args:
            tilt_deg: From level; NaN without samples.
            is_level: That is little enough.
            is_moving: A gesture is being made: its acceleration hides the tilt.
            is_level_wanted: The hand has to be level: a tilt is wrong, not only shown.
        """
        if is_moving:
            tilt_deg = math.nan
        self._is_wrong = is_level_wanted and not is_level and not math.isnan(tilt_deg)
        words = level_text(tilt_deg, is_level, is_wanted=is_level_wanted)
        text = f"Right hand: {'moving' if is_moving else words}"
        if text == self.text and abs(tilt_deg - self._tilt_deg) < _STEP_DEG:
            return
        self._tilt_deg = tilt_deg
        if text != self.text:
            self.text = text
            self.setAccessibleName(text)
        self.update()

    def sizeHint(self) -> QSize:
        """Tube and words."""
        return QSize(_TUBE_PX + 220, 26)

    def minimumSizeHint(self) -> QSize:
        """Words may be elided."""
        return QSize(_TUBE_PX + 60, 26)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw tube, bubble and words."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        colours = colours_of(self.palette())
        is_stacked = self.height() >= _STACKED_PX
        top = 2 if is_stacked else (self.height() - 18) / 2
        tube = QRectF(1, top, _TUBE_PX, 18)
        painter.setPen(QPen(QColor(colours.line), 1))
        painter.setBrush(QColor(colours.base))
        painter.drawRoundedRect(tube, 9, 9)
        centre = tube.center()
        for side in (-12, 12):
            x = centre.x() + side
            painter.drawLine(QPointF(x, tube.top()), QPointF(x, tube.bottom()))
        if not math.isnan(self._tilt_deg):
            share = min(1.0, self._tilt_deg / _FULL_DEG)
            x = centre.x() + share * (tube.width() / 2 - 10)
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(QColor(colours.attention if self._is_wrong else colours.muted))
            painter.drawEllipse(QPointF(x, centre.y()), 8, 7)
        font = QFont(self.font())
        font.setPixelSize(TEXT_PX + 2)
        font.setBold(self._is_wrong)
        painter.setFont(font)
        painter.setPen(QColor(colours.attention if self._is_wrong else colours.text))
        if is_stacked:
            room = QRectF(0, tube.bottom() + 4, self.width(), self.height() - tube.bottom() - 4)
            flags = Qt.AlignmentFlag.AlignTop | Qt.TextFlag.TextWordWrap
            painter.drawText(room, flags, self.text)
        else:
            room = QRectF(_TUBE_PX + 10, 0, self.width() - _TUBE_PX - 12, self.height())
            painter.drawText(room, Qt.AlignmentFlag.AlignVCenter, self.text)
        painter.end()
