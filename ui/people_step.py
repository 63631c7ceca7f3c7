"""People: who is here, whose model and postures are used, and which hand shows the gestures."""

from collections.abc import Callable

from PySide6.QtCore import Qt
from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import (
    QButtonGroup,
    QFrame,
    QGridLayout,
    QHBoxLayout,
    QLineEdit,
    QPushButton,
    QRadioButton,
    QVBoxLayout,
    QWidget,
)

from gestureapp.cell.snapshot import Snapshot
from gestureapp.recording.person_profile import Handedness
from gestureapp.setup.controls import SetupControls
from gestureapp.setup.site_values import PersonRow
from gestureapp.setup.snapshot import SetupSnapshot
from ui.draft_bar import heading
from ui.labels import ElidedLabel, plain
from ui.marks import Level, Mark
from ui.operate_page import framed
from ui.pages import scrolled
from ui.robot_step import REFRESH_S
from ui.theme import LARGE_PX, RADIO_STYLE, TEXT_PX, sized

NOBODY = "Nobody is here yet. Enter a name; takes, a model and postures come with it later."
_NAME_PX = 20
_LONGEST_NAME = 60
_USE_PX = 250
_SHOWN_NAME = 16
"""Letters of a name within a sentence."""


class PeopleStep(QWidget):
    """A card for each person, and a field for a new name. GUI thread only."""

    def __init__(self, controls: SetupControls, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("setupPeopleStep")
        self._controls = controls
        self._next_s = 0.0
        self._folk: tuple[PersonRow, ...] | None = None
        self._cards: list[_Card] = []
        self._in_use = plain("peopleInUse", LARGE_PX)
        self._mark = Mark(18)
        self._trouble = plain("peopleTrouble", LARGE_PX)
        sized(self._trouble, LARGE_PX, is_bold=True)
        self._name = QLineEdit()
        self._name.setObjectName("setupNewPerson")
        self._name.setAccessibleName("A new person's name")
        self._name.setPlaceholderText("name of somebody new")
        self._name.setMaxLength(_LONGEST_NAME)
        self._add = QPushButton("Add and use")
        self._add.setObjectName("addPerson")
        self._add.setAccessibleName("Add this person and use the person's model and postures")
        self._list = QVBoxLayout()
        self._lay_out()
        self._name.returnPressed.connect(self._add_new)
        self._add.clicked.connect(self._add_new)

    def show_snapshot(self, setup: SetupSnapshot, cell: Snapshot) -> None:
        """Show another moment of setting up and of the cell."""
        if setup.t_s >= self._next_s:  # what was clicked and not taken is taken back
            self._folk = None
            self._next_s = setup.t_s + REFRESH_S
        self.refresh()
        chosen = next((row for row in self._folk or () if row.is_chosen), None)
        level, text = in_use_text(chosen, cell)
        self._mark.show_level(level)
        if text != self._in_use.text():
            self._in_use.setText(text)
            self._in_use.setAccessibleName(text)

    def leave(self) -> None:
        """The step goes out of sight."""
        self._tell("")

    def refresh(self) -> None:
        """Ask again who is here."""
        folk = self._controls.people()
        if folk == self._folk:
            return
        self._folk = folk
        while len(self._cards) < len(folk):
            card = _Card(self._controls, self._choose, self._tell, len(self._cards), folk[0])
            self._cards.append(card)
            self._list.insertWidget(len(self._cards) - 1, card)
        for i, card in enumerate(self._cards):
            card.setVisible(i < len(folk))
        for card, row in zip(self._cards, folk, strict=False):
            card.show_person(row)
        self._nobody.setVisible(not folk)

    def showEvent(self, event: QShowEvent) -> None:
        """Somebody may have come in the meantime."""
        super().showEvent(event)
        self._folk = None

    def _add_new(self) -> None:
        name = " ".join(self._name.text().split())
        if not name:
            self._tell("Enter a name first.")
        elif self._choose(name):
            self._name.clear()

    def _choose(self, name: str) -> bool:
        why_not = self._controls.choose_person(name)
        self._tell(why_not)
        self.refresh()
        return not why_not

    def _tell(self, text: str) -> None:
        self._trouble.setText(text)
        self._trouble.setAccessibleName(text)
        self._trouble.setVisible(bool(text))

    def _lay_out(self) -> None:
        self._nobody = plain("peopleNobody", LARGE_PX)
        self._nobody.setText(NOBODY)
        self._trouble.hide()
        used = QHBoxLayout()
        used.setSpacing(8)
        used.addWidget(self._mark)
        used.addWidget(self._in_use, 1)
        self._list.setSpacing(6)
        self._list.addStretch(1)
        area = scrolled(self._list, "peopleArea", "People")
        entry = QHBoxLayout()
        entry.setSpacing(8)
        entry.addWidget(self._name)
        entry.addWidget(self._add)
        entry.addStretch(1)
        self._name.setFixedWidth(320)
        for widget in (self._name, self._add):
            widget.setMinimumHeight(38)
            sized(widget, LARGE_PX)
        self._add.setAutoDefault(False)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(10, 6, 10, 6)
        layout.setSpacing(8)
        layout.addLayout(used)
        layout.addWidget(self._trouble)
        layout.addWidget(self._nobody)
        layout.addWidget(area, 1)
        layout.addWidget(heading("somebodyNew", "Somebody new"))
        layout.addLayout(entry)


class _Card(QFrame):
    """One person: what is known, and the one click that switches."""

    def __init__(
        self,
        controls: SetupControls,
        choose: Callable[[str], object],
        tell: Callable[[str], None],
        number: int,
        row: PersonRow,
    ) -> None:
        super().__init__()
        self._row = row
        self.setObjectName(f"person{number}")
        framed(self)
        self._controls, self._choose, self._tell = controls, choose, tell
        self._mark = Mark(16)
        self._name = ElidedLabel()
        self._name.setObjectName(f"person{number}Name")
        self._name.setTextFormat(Qt.TextFormat.PlainText)
        sized(self._name, _NAME_PX, is_bold=True)
        self._takes = plain(f"person{number}Takes", TEXT_PX)
        self._model = plain(f"person{number}Model", TEXT_PX)
        self._postures = plain(f"person{number}Postures", TEXT_PX)
        self._what = plain(f"person{number}What", TEXT_PX)
        self._use = QPushButton()
        self._use.setObjectName(f"usePerson{number}")
        self._use.setAutoDefault(False)
        self._use.setFixedWidth(_USE_PX)
        self._use.setMinimumHeight(40)
        sized(self._use, LARGE_PX, is_bold=True)
        self._hands = QButtonGroup(self)
        self._hand_of: dict[Handedness, QRadioButton] = {}
        for hand in Handedness:
            button = QRadioButton(hand.value)
            button.setObjectName(f"person{number}{hand.name.title()}")
            button.setStyleSheet(RADIO_STYLE)
            button.clicked.connect(lambda _=False, hand=hand: self._set_hand(hand))
            self._hands.addButton(button)
            self._hand_of[hand] = button
        self._lay_out()
        self._use.clicked.connect(lambda: self._choose(self._row.name))

    def show_person(self, row: PersonRow) -> None:
        """Show somebody."""
        self._row = row
        self._mark.show_level(Level.BUSY if row.is_chosen else Level.OFF)
        self._name.setText(row.name)
        takes = "no takes" if not row.n_takes else f"{row.n_takes} takes"
        self._takes.setText(takes)
        self._model.setText(f"Model: {row.model or 'none'}")
        self._postures.setText(f"Postures: {row.postures}")
        self._use.setEnabled(not row.is_chosen)
        self._use.setText("In use" if row.is_chosen else self._short(f"Use {row.name}"))
        self._use.setAccessibleName(f"Use the model and postures of {row.name}")
        self._what.setText(what_changes(row))
        for hand, button in self._hand_of.items():
            button.setChecked(hand is row.handedness)
            button.setAccessibleName(f"{row.name} is {hand.value}")

    def _set_hand(self, hand: Handedness) -> None:
        why_not = self._controls.set_handedness(self._row.name, hand)
        self._tell(why_not)
        if why_not:
            self.show_person(self._row)

    def _short(self, text: str) -> str:
        metrics = self._use.fontMetrics()
        return metrics.elidedText(text, Qt.TextElideMode.ElideRight, _USE_PX - 24).replace(
            "&", "&&"
        )

    def _lay_out(self) -> None:
        head = QHBoxLayout()
        head.setSpacing(8)
        head.addWidget(self._mark)
        head.addWidget(self._name, 1)
        hands = QHBoxLayout()
        hands.setSpacing(12)
        for button in self._hand_of.values():
            hands.addWidget(button)
        hands.addWidget(self._takes)
        hands.addStretch(1)
        layout = QGridLayout(self)
        layout.setContentsMargins(12, 8, 12, 8)
        layout.setVerticalSpacing(3)
        layout.setHorizontalSpacing(16)
        layout.setColumnStretch(0, 1)
        layout.addLayout(head, 0, 0)
        layout.addLayout(hands, 1, 0)
        layout.addWidget(self._model, 2, 0)
        layout.addWidget(self._postures, 3, 0)
        layout.addWidget(self._use, 0, 1, 2, 1)
        layout.addWidget(self._what, 2, 1, 2, 1, Qt.AlignmentFlag.AlignTop)
        self._what.setFixedWidth(_USE_PX)


def what_changes(row: PersonRow) -> str:
    """What a click on this person's button does, in words."""
    name = row.name if len(row.name) <= _SHOWN_NAME else f"{row.name[:_SHOWN_NAME]}\u2026"
    if row.is_chosen:
        return f"Model and postures are those of {name}."
    return f"Switches to model and postures of {name} once nothing may move."


def in_use_text(chosen: PersonRow | None, cell: Snapshot) -> tuple[Level, str]:
    """Whose model is used now, and whether that is who is chosen here."""
    if chosen is None:
        return Level.ATTENTION, "Nobody is chosen: nothing can be armed with a model of nobody."
    model = cell.model or "no model"
    if cell.person and cell.person != chosen.name:
        return (
            Level.ATTENTION,
            f"{chosen.name} is chosen, but the model in use is for {cell.person}: {model}. Train "
            f"{chosen.name} first, or choose {cell.person}.",
        )
    return Level.BUSY, f"In use: {chosen.name}. Model: {model}."
