"""What to do now, to be read from three metres: drawing, words, count-in, beat, how many."""

from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QColor, QFont, QFontMetrics, QPainter, QPaintEvent, QPen, QResizeEvent
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QSizePolicy, QVBoxLayout, QWidget

from gestureapp.gestures import Kind, gesture
from gestureapp.guided.values import GuidedSnapshot, Phase
from ui.gesture_drawing import GestureDrawing
from ui.labels import BigWord, plain
from ui.operate_page import framed
from ui.theme import LARGE_PX, colours_of
from ui.train_words import instruction, last_verdict, take_count

FLASH_S = 0.15
"""How long the frame is lit at a beat."""
_LONGEST = "turn right"
_FLASH_PX = 10
_BAND_PX = 44


class PromptView(QFrame):
    """The drawing at the left, the words at the right. GUI thread only.

    Attributes:
        is_lit: The beat's flash is shown.
        count: The number shown over the drawing; empty without one.
    """

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("promptView")
        framed(self)
        self.is_lit = False
        self.count = ""
        self._label = ""
        self.drawing = GestureDrawing()
        self.drawing.setMinimumSize(150, 120)
        self._verdict = _VerdictBand(self.drawing)
        self._count = _CountIn(self.drawing)
        self._words = [BigWord(_LONGEST, 26, 110) for _ in range(2)]
        for i, word in enumerate(self._words):
            word.setObjectName(f"promptWords_{i}")
        self._how = BigWord("RX+   hand level", 18, 54)
        self._how.setObjectName("promptHow")
        self._take = BigWord("take 100 of 100", 22, 60)
        self._take.setObjectName("takeLabel")
        self._sentence = plain("recordSentence", LARGE_PX + 1)
        self._sentence.setAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignTop)
        self._sentence.setMinimumHeight(2 * self._sentence.fontMetrics().lineSpacing())
        words = QVBoxLayout()
        words.setSpacing(2)
        for word in self._words:
            words.addWidget(word, 5)
        words.addWidget(self._how, 3)
        words.addWidget(self._take, 4)
        words.addWidget(self._sentence)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(12, 10, 12, 10)
        layout.setSpacing(12)
        layout.addWidget(self.drawing, 11)
        layout.addLayout(words, 9)
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Expanding)

    def show_snapshot(self, snapshot: GuidedSnapshot) -> None:
        """Show another moment."""
        if snapshot.label != self._label:
            self._show_gesture(snapshot.label)
        _say(self._take, take_count(snapshot))
        _say(self._sentence, snapshot.sentence)
        is_bad = bool(snapshot.batch) and not snapshot.batch[-1].counts
        self._verdict.show_text(last_verdict(snapshot), is_bad=is_bad)
        self.count = str(snapshot.count_in) if snapshot.count_in else ""
        self._count.show_text(self.count)
        is_taking = snapshot.phase in (Phase.WAITING, Phase.TAKING)
        is_lit = is_taking and 0 <= snapshot.t_s - snapshot.activation_s < FLASH_S
        if is_lit is not self.is_lit:
            self.is_lit = is_lit
            self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Light the frame at a beat."""
        super().paintEvent(event)
        if not self.is_lit:
            return
        painter = QPainter(self)
        pen = QPen(QColor(colours_of(self.palette()).info), _FLASH_PX)
        pen.setJoinStyle(Qt.PenJoinStyle.MiterJoin)
        painter.setPen(pen)
        half = _FLASH_PX / 2
        painter.drawRect(QRectF(self.rect()).adjusted(half, half, -half, -half))
        painter.end()

    def _show_gesture(self, label: str) -> None:
        self._label = label
        self.drawing.set_gesture(label)
        if not label:
            for word in (*self._words, self._how):
                word.clear()
            return
        first, second = two_lines(gesture(label).words)
        self._words[0].setText(first)
        self._words[1].setText(second)
        is_level = gesture(label).kind is Kind.MOVEMENT
        self._how.setText(f"{label}   hand level" if is_level else label)
        self.setAccessibleName(f"{label}: {instruction(label)}")


class _CountIn(QWidget):
    """A number as tall as the drawing it lies upon; lets everything through."""

    def __init__(self, under: QWidget) -> None:
        super().__init__(under)
        self.setObjectName("countIn")
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self._text = ""
        self.hide()

    def show_text(self, text: str) -> None:
        """Show a number; an empty one hides it."""
        parent = self.parentWidget()
        if text and parent is not None and self.geometry() != parent.rect():
            self.setGeometry(parent.rect())
        if text == self._text:
            return
        self._text = text
        self.setAccessibleName(f"begins in {text}" if text else "")
        self.setVisible(bool(text))
        self.raise_()
        self.update()

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Draw anew."""
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the number over a veil."""
        painter = QPainter(self)
        colours = colours_of(self.palette())
        veil = QColor(colours.panel)
        veil.setAlpha(190)
        painter.fillRect(self.rect(), veil)
        font = QFont(self.font())
        font.setBold(True)
        font.setPixelSize(max(40, int(self.height() * 0.9)))
        painter.setFont(font)
        painter.setPen(QColor(colours.text))
        painter.drawText(self.rect(), Qt.AlignmentFlag.AlignCenter, self._text)
        painter.end()


class _VerdictBand(QWidget):
    """What became of the last take, along the lower edge of the drawing."""

    def __init__(self, under: QWidget) -> None:
        super().__init__(under)
        self.setObjectName("lastVerdict")
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.text = ""
        self._is_bad = False
        self.hide()

    def show_text(self, text: str, *, is_bad: bool) -> None:
        """Show other words; empty ones hide the band."""
        parent = self.parentWidget()
        if text and parent is not None:
            high = max(_BAND_PX, parent.height() // 5)
            self.setGeometry(0, parent.height() - high, parent.width(), high)
        if (text, is_bad) == (self.text, self._is_bad):
            return
        self.text, self._is_bad = text, is_bad
        self.setAccessibleName(f"last take: {text}" if text else "")
        self.setVisible(bool(text))
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the words as large as they fit in one line, else in two."""
        painter = QPainter(self)
        colours = colours_of(self.palette())
        painter.fillRect(self.rect(), QColor(colours.base))
        painter.setPen(QColor(colours.attention if self._is_bad else colours.text))
        font = QFont(self.font())
        font.setBold(True)
        font.setPixelSize(round(self.height() * 0.62))
        if QFontMetrics(font).horizontalAdvance(self.text) > self.width() - 16:
            font.setPixelSize(round(self.height() * 0.38))
        painter.setFont(font)
        flags = Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap
        painter.drawText(self.rect().adjusted(4, 0, -4, 0), flags, self.text)
        painter.end()


def two_lines(words: str) -> tuple[str, str]:
    """Cut words into two lines: ``turn right`` and ``and hold``."""
    first, space, rest = words.partition(" and ")
    if space:
        return first, f"and {rest}"
    first, _, rest = words.partition(" ")
    return first, rest


def _say(label: QLabel, text: str) -> None:
    if label.text() != text:
        label.setText(text)
        label.setAccessibleName(text)
