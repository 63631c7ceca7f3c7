"""Labels that keep to the room they are given: one that elides, one that grows its letters."""

import re

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QFont, QFontMetrics, QPainter, QPaintEvent, QResizeEvent
from PySide6.QtWidgets import QLabel, QSizePolicy, QWidget

from ui.theme import LARGE_PX, sized


class ElidedLabel(QLabel):
    """One line that ends in an ellipsis where the room ends. ``text()`` stays whole."""

    def __init__(self, text: str = "", parent: QWidget | None = None) -> None:
        super().__init__(text, parent)
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)

    def minimumSizeHint(self) -> QSize:
        """Any width will do."""
        return QSize(0, super().minimumSizeHint().height())

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw what fits."""
        painter = QPainter(self)
        painter.setPen(self.palette().color(self.foregroundRole()))
        shown = self.fontMetrics().elidedText(
            self.text(), Qt.TextElideMode.ElideRight, self.contentsRect().width()
        )
        painter.drawText(self.contentsRect(), self.alignment(), shown)
        painter.end()


_BREAK = "\u200b"
_LONG_WORD = re.compile(r"\S{25,}")
_PIECE = re.compile(r"[^/\\_.:-]{1,12}[/\\_.:-]*|[/\\_.:-]+")


def breaking(text: str) -> str:
    """The text with places where a long word, as a path, may go on in the next line."""
    return _LONG_WORD.sub(lambda word: _BREAK.join(_PIECE.findall(word[0])), text)


class BreakingLabel(QLabel):
    """Breaks a path that is longer than its room, which else would widen all there is around it.

    ``text()`` is what was set.
    """

    def setText(self, text: str) -> None:  # noqa: N802, Qt's spelling
        """Show another text."""
        super().setText(breaking(text))

    def text(self) -> str:
        """What was set."""
        return super().text().replace(_BREAK, "")


class BigWord(QLabel):
    """A word in letters as large as the room allows, to be read from 3 m.

    The size follows the longest word it may ever show, so that the letters do not jump.
    """

    def __init__(
        self, longest: str, min_px: int, max_px: int, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self._longest = longest
        self._min_px = min_px
        self._max_px = max_px
        sized(self, min_px, is_bold=True)
        self.setAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        self.setTextFormat(Qt.TextFormat.PlainText)
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Expanding)

    def minimumSizeHint(self) -> QSize:
        """Room for the longest word in the smallest letters."""
        metrics = self._metrics(self._min_px)
        return QSize(metrics.horizontalAdvance(self._longest) + 4, metrics.capHeight() + 8)

    def sizeHint(self) -> QSize:
        """The smallest is asked for; more is taken when it is there."""
        return self.minimumSizeHint()

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Take the largest letters that fit."""
        low, high = self._min_px, self._max_px
        while low < high:
            middle = (low + high + 1) // 2
            if self._fits(middle):
                low = middle
            else:
                high = middle - 1
        if low != self.font().pixelSize():
            sized(self, low, is_bold=True)
        super().resizeEvent(event)

    def _fits(self, size_px: int) -> bool:
        metrics = self._metrics(size_px)
        return (
            metrics.horizontalAdvance(self._longest) + 4 <= self.width()
            and metrics.capHeight() + 8 <= self.height()
        )

    def _metrics(self, size_px: int) -> QFontMetrics:
        font = QFont(self.font())
        font.setPixelSize(size_px)
        font.setBold(True)
        return QFontMetrics(font)


class BigText(QLabel):
    """A sentence in letters as large as its room allows, over several lines, for 3 m.

    Args:
        name: objectName.
        min_px: Smallest letters.
        max_px: Largest.
        parent: Qt's.
    """

    def __init__(self, name: str, min_px: int, max_px: int, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._range_px, self._said = (min_px, max_px), ""
        self.setObjectName(name)
        self.setTextFormat(Qt.TextFormat.PlainText)
        self.setWordWrap(True)
        self.setAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Expanding)
        sized(self, min_px, is_bold=True)

    def show_text(self, text: str) -> None:
        """Show another sentence."""
        if text != self._said:
            self._said = text
            self.setText(breaking(text))
            self._fit()

    def text(self) -> str:
        """What was set."""
        return self._said

    def minimumSizeHint(self) -> QSize:
        """Two lines of the smallest letters, as wide as there is room."""
        return QSize(120, 2 * self._range_px[0] + 16)

    def sizeHint(self) -> QSize:
        """The smallest is asked for; more is taken when it is there."""
        return self.minimumSizeHint()

    def hasHeightForWidth(self) -> bool:  # noqa: N802, Qt's spelling
        """No: the letters follow the room, not the room the letters."""
        return False

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Take the largest letters that fit."""
        super().resizeEvent(event)
        self._fit()

    def _fit(self) -> None:
        low, high = self._range_px
        while low < high:
            middle = (low + high + 1) // 2
            if self._fits(middle):
                low = middle
            else:
                high = middle - 1
        if low != self.font().pixelSize():
            sized(self, low, is_bold=True)

    def _fits(self, size_px: int) -> bool:
        font = QFont(self.font())
        font.setPixelSize(size_px)
        metrics, room = QFontMetrics(font), self.contentsRect()
        flags = Qt.AlignmentFlag.AlignLeft | Qt.TextFlag.TextWordWrap
        box = metrics.boundingRect(0, 0, room.width(), 10_000, flags.value, super().text())
        widest = max(
            (
                metrics.horizontalAdvance(word)
                for word in re.split(f"[{_BREAK}\\s]+", super().text())
            ),
            default=0,
        )
        return box.height() <= room.height() and widest <= room.width()


def plain(name: str, size_px: int = LARGE_PX, is_wrapped: bool = True) -> QLabel:
    """A label for text that comes from elsewhere: never read as markup.

    Args:
        name: Its objectName.
        size_px: Letter height.
        is_wrapped: Whether it may take several lines.
    """
    label = BreakingLabel() if is_wrapped else QLabel()
    label.setObjectName(name)
    label.setTextFormat(Qt.TextFormat.PlainText)
    label.setWordWrap(is_wrapped)
    sized(label, size_px)
    return label
