"""A bar across the window for what wants a person soon; in the row kept for bars."""

from PySide6.QtCore import Qt
from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import QWidget

from ui.labels import ElidedLabel
from ui.theme import LARGE_PX, attention_palette, sized


class NoticeBar(ElidedLabel):
    """Hidden while there is nothing to say. GUI thread only."""

    def __init__(self, name: str, parent: QWidget | None = None) -> None:
        super().__init__("", parent)
        self.setObjectName(name)
        self.setTextFormat(Qt.TextFormat.PlainText)
        self.setAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        self.setContentsMargins(14, 0, 14, 0)
        self.setAutoFillBackground(True)
        sized(self, LARGE_PX, is_bold=True)
        self.hide()

    def show_text(self, text: str) -> None:
        """Show a line; an empty one hides the bar."""
        if text != self.text():
            self.setText(text)
            self.setToolTip(text)
            self.setAccessibleName(text)
        self.setVisible(bool(text))

    def showEvent(self, event: QShowEvent) -> None:
        """Take the colours."""
        super().showEvent(event)
        self.setPalette(attention_palette(self))
