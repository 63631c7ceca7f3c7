"""Assigning by shaking: one sentence to follow from where the person stands, and two bars."""

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QFrame, QGridLayout, QHBoxLayout, QProgressBar, QVBoxLayout, QWidget

from gestureapp.sensing.values import Side
from gestureapp.setup.values import ShakeView
from ui.labels import BigText, plain
from ui.operate_page import framed
from ui.setup_parts import push
from ui.setup_words import ARM_WORK
from ui.theme import LARGE_PX, sized

_BAR_PX = 56
_FULL = 100


class ShakePanel(QFrame):
    """Over the whole step. GUI thread only.

    Signals:
        closed: The person has read what came of it, or gives up.
    """

    closed = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("shakePanel")
        framed(self)
        self._sentence = BigText("shakeSentence", 28, 96)
        self._sentence.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self._bars = [_bar("left"), _bar("right")]
        self._close = push("shakeClose", "Cancel", size_px=LARGE_PX)
        self._close.setMinimumSize(160, 48)
        self._strengths = QWidget()
        grid = QGridLayout(self._strengths)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(16)
        grid.setVerticalSpacing(12)
        grid.setColumnStretch(1, 1)
        for row, (bar, side) in enumerate(zip(self._bars, Side, strict=True)):
            caption = plain(f"{side.value}ShakeCaption", 28, is_wrapped=False)
            caption.setText(f"{ARM_WORK[side]} now")
            sized(caption, 28, is_bold=True)
            grid.addWidget(caption, row, 0)
            grid.addWidget(bar, row, 1)
        foot = QHBoxLayout()
        foot.addStretch(1)
        foot.addWidget(self._close)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(24, 16, 24, 16)
        layout.setSpacing(16)
        layout.addWidget(self._sentence, 1)
        layout.addWidget(self._strengths)
        layout.addLayout(foot)
        self._close.clicked.connect(self.closed)

    def show_shake(self, shake: ShakeView) -> None:
        """Show another moment."""
        self._sentence.show_text(shake.sentence)
        word = "Cancel" if shake.is_on else "Back"
        if word != self._close.text():
            self._close.setText(word)
            self._close.setAccessibleName(word)
        self._strengths.setVisible(shake.is_on)
        for bar, strength in zip(self._bars, (shake.left_shake, shake.right_shake), strict=True):
            bar.setValue(round(_FULL * min(1.0, max(0.0, strength))))


def _bar(name: str) -> QProgressBar:
    bar = QProgressBar()
    bar.setObjectName(f"{name}Shake")
    bar.setAccessibleName(f"How strongly the {name} sensor moves")
    bar.setRange(0, _FULL)
    bar.setTextVisible(False)
    bar.setFixedHeight(_BAR_PX)
    return bar
