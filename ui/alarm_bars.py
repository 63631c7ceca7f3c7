"""Full-width bars above everything else: a stop that was not confirmed, a window that is blind."""

from collections.abc import Callable

from PySide6.QtGui import QColor, QPalette
from PySide6.QtWidgets import QApplication, QVBoxLayout, QWidget

from gestureapp.clock import Clock, monotonic
from ui.labels import plain
from ui.theme import TEXT_PX, colours_of, sized

UNCONFIRMED = "ROBOT HAS NOT CONFIRMED THE STOP. USE THE EMERGENCY STOP ON THE PENDANT"
"""Here the words mean the real one, the hardware."""
_BEEP_EVERY_S = 1.0


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
        self._unconfirmed = plain("stopUnconfirmedBar", 22)
        self._unconfirmed.setText(UNCONFIRMED)
        self._unconfirmed.setAccessibleName(UNCONFIRMED)
        self._blind = plain("blindBar", TEXT_PX + 1)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(2)
        for bar, size_px in ((self._unconfirmed, 22), (self._blind, TEXT_PX + 1)):
            sized(bar, size_px, is_bold=True)
            bar.setAutoFillBackground(True)
            bar.setContentsMargins(14, 5, 14, 5)
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
        self._blind.setVisible(bool(reason))
        self._fold()

    def _fold(self) -> None:
        self.setVisible(not (self._unconfirmed.isHidden() and self._blind.isHidden()))

    def _paint_red(self) -> None:
        colours = colours_of(self.window().palette())
        palette = QPalette(self.palette())
        palette.setColor(QPalette.ColorRole.Window, QColor(colours.alarm))
        palette.setColor(QPalette.ColorRole.WindowText, QColor(colours.on_alarm))
        for bar in (self._unconfirmed, self._blind):
            bar.setPalette(palette)
