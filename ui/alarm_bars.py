"""Full-width bars in a row kept for them: a stop not confirmed, a window that is blind."""

from collections.abc import Callable

from PySide6.QtCore import Qt
from PySide6.QtGui import QColor, QFont, QFontMetrics, QPalette, QResizeEvent
from PySide6.QtWidgets import QApplication, QSizePolicy, QVBoxLayout, QWidget

from gestureapp.clock import Clock, monotonic
from ui.labels import ElidedLabel, plain
from ui.theme import TEXT_PX, colours_of, sized

UNCONFIRMED = "ROBOT HAS NOT CONFIRMED THE STOP. USE THE EMERGENCY STOP ON THE PENDANT"
"""Here the words mean the real one, the hardware."""
_BEEP_EVERY_S = 1.0
_ALONE_PX, _TOGETHER_PX, _LEAST_PX = 22, 16, 12
"""Letters of the alarm: alone, above the other bar, and where the window is narrow."""
_MARGIN_PX = 14


class AlarmBars(QWidget):
    """Hidden while all is well. GUI thread only."""

    def __init__(
        self,
        clock: Clock = monotonic,
        beep: Callable[[], None] = QApplication.beep,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self._clock = clock
        self._beep = beep
        self._beeped_s = float("-inf")
        self._unconfirmed = plain("stopUnconfirmedBar", _ALONE_PX, is_wrapped=False)
        self._unconfirmed.setText(UNCONFIRMED)
        self._unconfirmed.setAccessibleName(UNCONFIRMED)
        self._unconfirmed.setMinimumWidth(1)  # the letters follow the width, see _fit
        self._blind = ElidedLabel()
        self._blind.setObjectName("blindBar")
        self._blind.setTextFormat(Qt.TextFormat.PlainText)
        self._blind.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        sized(self._blind, TEXT_PX + 1, is_bold=True)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        for bar in (self._unconfirmed, self._blind):
            bar.setAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
            bar.setAutoFillBackground(True)
            bar.setContentsMargins(_MARGIN_PX, 0, _MARGIN_PX, 0)
            bar.hide()
            layout.addWidget(bar)
        self.hide()

    def show_unconfirmed(self, is_unconfirmed: bool) -> None:
        """Show or hide the alarm, and sound while it lasts."""
        if not is_unconfirmed:
            self._unconfirmed.hide()
            self._beeped_s = float("-inf")
            self._fold()
            return
        if self._unconfirmed.isHidden():
            self._paint_red()
            self._unconfirmed.show()
            self._fold()
        now_s = self._clock()
        if now_s - self._beeped_s >= _BEEP_EVERY_S:
            self._beeped_s = now_s
            self._beep()

    def show_blind(self, reason: str) -> None:
        """Say that what stands in the window is old, and why; an empty reason takes it back."""
        if reason and (self._blind.isHidden() or self._blind.text() != reason):
            self._paint_red()
            self._blind.setText(reason)
            self._blind.setToolTip(reason)
            self._blind.setAccessibleName(reason)
        self._blind.setVisible(bool(reason))
        self._fold()

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Keep the alarm in one line."""
        super().resizeEvent(event)
        self._fit()

    def _fold(self) -> None:
        self._fit()
        self.setVisible(not (self._unconfirmed.isHidden() and self._blind.isHidden()))

    def _fit(self) -> None:
        """The largest letters in which the alarm has room; above the other bar smaller ones."""
        size_px = _ALONE_PX if self._blind.isHidden() else _TOGETHER_PX
        room = self.width() - 2 * _MARGIN_PX
        while size_px > _LEAST_PX and _alarm_width(self._unconfirmed.font(), size_px) > room:
            size_px -= 1
        if size_px != self._unconfirmed.font().pixelSize():
            sized(self._unconfirmed, size_px, is_bold=True)

    def _paint_red(self) -> None:
        colours = colours_of(self.window().palette())
        palette = QPalette(self.palette())
        palette.setColor(QPalette.ColorRole.Window, QColor(colours.alarm))
        palette.setColor(QPalette.ColorRole.WindowText, QColor(colours.on_alarm))
        for bar in (self._unconfirmed, self._blind):
            bar.setPalette(palette)


def _alarm_width(font: QFont, size_px: int) -> int:
    font.setPixelSize(size_px)
    font.setBold(True)
    return QFontMetrics(font).horizontalAdvance(UNCONFIRMED)
