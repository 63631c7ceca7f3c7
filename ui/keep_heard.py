"""One click: what was heard was right, or was done as asked, and becomes a take."""

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QHBoxLayout, QPushButton, QWidget

from gestureapp.guided.controls import GuidedControls
from gestureapp.guided.values import Heard
from ui.labels import plain
from ui.theme import SMALL_PX, TEXT_PX, sized

_HEIGHT = 30
"""Two lines of small text fit as well."""


class KeepHeard(QWidget):
    """A button while the last activation can be kept, and what came of it. GUI thread only.

    Its room stays when there is nothing to say, so that nothing jumps.

    Args:
        name: The button's object name is this, the line's has ``Words`` behind it.
        guided: Asked to keep.
        is_tried: Shows what came of trying a model; else of operation.
    """

    def __init__(
        self, name: str, guided: GuidedControls, is_tried: bool, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self._guided = guided
        self._is_tried = is_tried
        self._heard: Heard | None = None
        self._button = QPushButton()
        self._button.setObjectName(name)
        self._button.setMinimumHeight(_HEIGHT)
        # Space is a key for STOP, and must not press what was clicked last.
        self._button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        sized(self._button, TEXT_PX)
        self._words = plain(f"{name}Words", SMALL_PX)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(8)
        layout.addWidget(self._button)
        layout.addWidget(self._words, 1)
        self.setFixedHeight(_HEIGHT + 2)
        self._button.clicked.connect(self._keep)
        self.show_heard(Heard())

    def show_heard(self, heard: Heard, was_right: bool = True) -> None:
        """Show another moment.

        Args:
            heard: Of guided training.
            was_right: What was heard is what was asked for.
        """
        mine = heard if heard.is_tried is self._is_tried else Heard()
        words = "That was right" if was_right else f"I did {mine.label}"
        self._button.setVisible(mine.can_keep)
        self._button.setText("Try again" if mine.text else f"{words}: keep as a take")
        self._button.setAccessibleName(f"{words}: keep it as a take of {mine.label}")
        self._words.setText(mine.text)
        self._heard = mine

    def _keep(self) -> None:
        if self._heard is not None:
            self._guided.keep_heard(self._heard.number)
