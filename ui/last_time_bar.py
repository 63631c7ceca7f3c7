"""A bar that tells what the guardian did when no window could show it; put away by a press."""

from collections.abc import Callable

from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import QHBoxLayout, QPushButton, QWidget

from ui.labels import plain
from ui.theme import TEXT_PX, attention_palette, sized


class LastTimeBar(QWidget):
    """Hidden until there is something to tell. GUI thread only."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._on_shown: Callable[[], None] | None = None
        self._text = plain("lastTimeBar", TEXT_PX)
        sized(self._text, TEXT_PX, is_bold=True)
        button = QPushButton("Put away")
        button.setObjectName("lastTimeAway")
        button.setAccessibleName("Put away the notice of the last run")
        button.clicked.connect(self.hide)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(14, 2, 8, 2)
        layout.addWidget(self._text, 1)
        layout.addWidget(button)
        self.setAutoFillBackground(True)
        self.hide()

    def tell(self, text: str, details: str, on_shown: Callable[[], None]) -> None:
        """Show a line, with more in its tooltip.

        Args:
            text: For the operator.
            details: For whoever looks for the cause.
            on_shown: Called once the line is on the screen.
        """
        self._on_shown = on_shown
        self._text.setText(text)
        self._text.setAccessibleName(text)
        self.setToolTip(f"{text}\n\n{details}")
        self.show()

    def showEvent(self, event: QShowEvent) -> None:
        """Take the colours, and say that it is seen."""
        super().showEvent(event)
        self.setPalette(attention_palette(self))
        on_shown, self._on_shown = self._on_shown, None
        if on_shown is not None:
            on_shown()
