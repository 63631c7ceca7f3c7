"""Looking for sensors: what sends on which port, and whose arm it is to be."""

from collections.abc import Sequence
from functools import partial

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QFrame, QGridLayout, QHBoxLayout, QPushButton, QVBoxLayout, QWidget

from gestureapp.sensing.values import Side
from gestureapp.setup.values import FindingView, FoundSensor, SensorCard
from ui.labels import BigText, plain
from ui.operate_page import framed
from ui.setup_parts import enable, push
from ui.theme import LARGE_PX, TEXT_PX, sized

MAX_ROWS = 8
"""As many are shown; a cell has two sensors."""


class FindPanel(QFrame):
    """Everything that sends, each with a button for either arm. GUI thread only.

    Signals:
        wanted: The person wants this ``FoundSensor`` on the arm of this ``Side``.
        closed: The person has seen enough; finding ends.
    """

    wanted = Signal(FoundSensor, Side)
    closed = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("findPanel")
        framed(self)
        self._found: tuple[FoundSensor, ...] | None = None
        self._sentence = BigText("findSentence", LARGE_PX + 2, 32)
        self._rows = [_FoundRow(number, self) for number in range(MAX_ROWS)]
        self._more = plain("findMore", TEXT_PX)
        self._close = push("findClose", "Stop looking", size_px=LARGE_PX)
        grid = QGridLayout()
        grid.setVerticalSpacing(6)
        grid.setHorizontalSpacing(8)
        grid.setColumnStretch(0, 1)
        for number, row in enumerate(self._rows):
            grid.addWidget(row.text, number, 0)
            for column, button in enumerate(row.buttons.values(), start=1):
                grid.addWidget(button, number, column)
        foot = QHBoxLayout()
        foot.addWidget(self._more, 1)
        foot.addWidget(self._close)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(18, 12, 18, 12)
        layout.addWidget(self._sentence, 1)
        layout.addLayout(grid)
        layout.addStretch(2)
        layout.addLayout(foot)
        self._close.clicked.connect(self.closed)

    def show_finding(self, finding: FindingView, cards: Sequence[SensorCard]) -> None:
        """Show another moment.

        Args:
            finding: What came of it so far.
            cards: Both arms': what is in use already.
        """
        self._sentence.show_text(finding.sentence)
        self._close.setText("Stop looking" if finding.is_on else "Back")
        self._close.setAccessibleName(self._close.text())
        n_more = len(finding.found) - MAX_ROWS
        self._more.setText(f"and {n_more} more" if n_more > 0 else "")
        for number, row in enumerate(self._rows):
            found = finding.found[number] if number < len(finding.found) else None
            row.show_found(found, cards)


class _FoundRow:
    """One found sensor: its text and its two buttons, which lie in the panel's grid."""

    def __init__(self, number: int, panel: FindPanel) -> None:
        self._panel = panel
        self._found: FoundSensor | None = None
        self.text = plain(f"found_{number}", LARGE_PX)
        self.text.setAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        self.buttons: dict[Side, QPushButton] = {}
        for side in Side:
            button = push(f"found_{number}_{side.value}", f"{side.value.capitalize()} arm")
            button.setMinimumWidth(130)
            button.clicked.connect(partial(self._take, side))
            self.buttons[side] = button
        self.show_found(None, ())

    def show_found(self, found: FoundSensor | None, cards: Sequence[SensorCard]) -> None:
        """Show another sensor; None shows nothing."""
        self._found = found
        self.text.setVisible(found is not None)
        if found is not None and found.text != self.text.text():
            self.text.setText(found.text)
        for button in self.buttons.values():
            button.setVisible(found is not None)
        if found is None:
            return
        is_in_use = any(card.port == found.port.url for card in cards)
        for card in cards:
            button, is_own = self.buttons[card.side], card.port == found.port.url
            enable(button, bool(found.protocol) and not is_in_use)
            word = f"is the {card.worn} arm's" if is_own else f"use for {card.worn} arm"
            if word != button.text():
                button.setText(word)
                button.setAccessibleName(f"{found.port.name}: {word}")
                sized(button, TEXT_PX + 1, is_bold=is_own)

    def _take(self, side: Side) -> None:
        if self._found is not None:
            self._panel.wanted.emit(self._found, side)
