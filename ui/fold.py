"""A button that brings something into sight, and puts it away again."""

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QToolButton, QWidget


class FoldButton(QToolButton):
    """Shows a widget while it is down, and another one while it is not. Both lie elsewhere.

    Args:
        name: objectName.
        title: What stands on it.
        shows: In sight while the button is down.
        hides: Gives its place up meanwhile.
    """

    def __init__(
        self,
        name: str,
        title: str,
        shows: QWidget,
        hides: QWidget | None = None,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self._shows, self._hides = shows, hides
        self.setObjectName(name)
        self.setAccessibleName(title)
        self.setText(title)
        self.setCheckable(True)
        self.setAutoRaise(True)
        self.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        self.toggled.connect(self._unfold)
        self._unfold(False)

    def _unfold(self, is_open: bool) -> None:
        self.setArrowType(Qt.ArrowType.DownArrow if is_open else Qt.ArrowType.RightArrow)
        self._shows.setVisible(is_open)
        if self._hides is not None:
            self._hides.setVisible(not is_open)
