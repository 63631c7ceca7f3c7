"""Room for the window's pages: one in sight, and a middle that scrolls where there is no room."""

from PySide6.QtCore import QSize, Qt
from PySide6.QtWidgets import QFrame, QLayout, QScrollArea, QStackedWidget, QVBoxLayout, QWidget


class PageStack(QStackedWidget):
    """Asks for no more room than the page in sight needs: a hidden one must not make it scroll."""

    def __init__(self, name: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName(name)
        self.currentChanged.connect(lambda _: self.updateGeometry())

    def sizeHint(self) -> QSize:
        """Of the page in sight."""
        page = self.currentWidget()
        return page.sizeHint() if page is not None else super().sizeHint()

    def minimumSizeHint(self) -> QSize:
        """Of the page in sight."""
        page = self.currentWidget()
        return page.minimumSizeHint() if page is not None else super().minimumSizeHint()

    def hasHeightForWidth(self) -> bool:  # noqa: N802, Qt's spelling
        """No: the height is what there is."""
        return False


class _Compressible(QWidget):
    """Asks for its least height only.

    Texts that wrap would otherwise make a scroll area ask for the height they like best, and scroll
    long before anything is out of room.
    """

    def hasHeightForWidth(self) -> bool:  # noqa: N802, Qt's spelling
        """No: the height is what there is."""
        return False


def scrolling(layout: QLayout) -> QScrollArea:
    """Room that scrolls when the screen is too small, so that what stands beside it stays."""
    content = QWidget()
    inner = _Compressible()
    inner.setLayout(layout)
    outer = QVBoxLayout(content)
    outer.setContentsMargins(0, 0, 0, 0)
    outer.addWidget(inner)
    return _area(content, "workArea", "The cell")


def scrolled(layout: QLayout, name: str, title: str) -> QScrollArea:
    """A part of a page that is as high as its texts want, and scrolls where that is too much.

    Args:
        layout: Its content.
        name: objectName.
        title: Accessible name.
    """
    content = QWidget()
    content.setLayout(layout)
    area = _area(content, name, title)
    area.viewport().setAutoFillBackground(False)  # the ground of what it stands on
    content.setAutoFillBackground(False)
    return area


def _area(content: QWidget, name: str, title: str) -> QScrollArea:
    area = QScrollArea()
    area.setObjectName(name)
    area.setAccessibleName(title)
    area.setFrameShape(QFrame.Shape.NoFrame)
    area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
    area.setWidgetResizable(True)
    area.setWidget(content)
    return area
