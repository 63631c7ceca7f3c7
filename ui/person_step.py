"""Person: whose takes these are; continue as somebody, or begin with a new name."""

import html

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import (
    QFrame,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QListWidget,
    QListWidgetItem,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from gestureapp.errors import GestureAppError
from gestureapp.guided.controls import GuidedControls
from gestureapp.guided.values import GuidedSnapshot
from ui.labels import ElidedLabel, plain
from ui.operate_page import framed
from ui.theme import LARGE_PX, TEXT_PX, sized
from ui.train_words import continue_text

NOBODY = "Choose who wears the sensors. Each person has takes and a model of their own."
_NAME_PX = 18
_ROW_PX = 36
_LONGEST_NAME = 60
_WIDEST_PX = 420
"""Of the button with a name."""
_BESIDE_PX = 20
"""Between a button's words and its edge."""


class PersonStep(QWidget):
    """People who have takes, and a field for a new name. GUI thread only.

    Args:
        guided: Opens a person's takes.
        usual: The name in the settings, offered while nobody has takes.

    Signals:
        finished: A person is chosen; the next step can begin.
    """

    finished = Signal()

    def __init__(
        self, guided: GuidedControls, usual: str = "", parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.setObjectName("personStep")
        self._guided = guided
        self._people: tuple[str, ...] = ()
        self._last = ""
        self._person: str | None = None
        self._who = _titled("peopleTitle", "Who wears the sensors?")
        self._list = QListWidget()
        self._list.setObjectName("peopleList")
        self._list.setAccessibleName("People who have takes here")
        self._name = QLineEdit(usual)
        self._name.setObjectName("newPersonName")
        self._name.setAccessibleName("A new person's name")
        self._name.setPlaceholderText("name")
        self._name.setMaxLength(_LONGEST_NAME)
        self._open = QPushButton("Begin")
        self._open.setObjectName("openPerson")
        self._open.setAccessibleName("Begin with this name")
        self._trouble = plain("personTrouble", LARGE_PX)
        self._chosen = ElidedLabel()
        self._chosen.setObjectName("personChosen")
        self._chosen.setTextFormat(Qt.TextFormat.PlainText)
        self._far = plain("personProgress", LARGE_PX + 2)
        self._next = QPushButton("Continue")
        self._next.setObjectName("continuePerson")
        self._next.setAccessibleName("Continue with this person")
        self._lay_out()
        self._list.itemClicked.connect(lambda item: self._choose(item.text()))
        self._list.itemActivated.connect(lambda item: self._choose(item.text()))
        self._name.returnPressed.connect(self._begin)
        self._open.clicked.connect(self._begin)
        self._next.clicked.connect(self._go_on)

    def refresh(self) -> None:
        """Ask again who has takes, and who was here last."""
        self._people = self._guided.people()
        self._last = "" if self._person else self._guided.last_person()
        self._list.clear()
        for name in self._people:
            item = QListWidgetItem(name)
            item.setSizeHint(QSize(0, _ROW_PX))
            item.setToolTip(_as_tip(name))
            self._list.addItem(item)
        for widget in (self._who, self._list):
            widget.setVisible(bool(self._people))
        self._mark(self._person or self._last)

    def showEvent(self, event: QShowEvent) -> None:
        """Somebody may have come in the meantime."""
        super().showEvent(event)
        self.refresh()

    def show_snapshot(self, snapshot: GuidedSnapshot) -> None:
        """Show who is chosen and how far that person is."""
        if snapshot.person != self._person:
            self._person = snapshot.person
            self.refresh()
        who = snapshot.person or self._last
        self._next.setEnabled(bool(who))
        _say(self._chosen, who or "Nobody is chosen yet")
        _say(self._next, self._continue_as(who) if who else "Continue")
        for widget in (self._chosen, self._next):
            widget.setToolTip(_as_tip(who))
        if snapshot.person:
            _say(self._far, continue_text(snapshot))
        elif who:
            _say(self._far, "Recorded here last. Continue, or choose somebody else.")
        else:
            _say(self._far, NOBODY)

    def _continue_as(self, who: str) -> str:
        """What stands on the button: a long name is elided, an ``&`` marks no shortcut."""
        room = _WIDEST_PX - 2 * _BESIDE_PX
        metrics = self._next.fontMetrics()
        text = metrics.elidedText(f"Continue as {who}", Qt.TextElideMode.ElideRight, room)
        return text.replace("&", "&&")

    def _go_on(self) -> None:
        if self._choose(self._person or self._last):
            self.finished.emit()

    def _begin(self) -> None:
        name = " ".join(self._name.text().split())
        if not name:
            self._tell("Enter a name first.")
            return
        if self._choose(name):
            self._name.clear()
            self.finished.emit()

    def _choose(self, name: str) -> bool:
        if name == self._person:
            return True
        try:
            self._guided.open(name)
        except GestureAppError as error:
            self._tell(str(error))
            self._mark(self._person or "")
            return False
        self._tell("")
        return True

    def _tell(self, text: str) -> None:
        self._trouble.setText(text)
        self._trouble.setAccessibleName(text)
        self._trouble.setVisible(bool(text))

    def _mark(self, name: str) -> None:
        found = self._list.findItems(name, Qt.MatchFlag.MatchExactly)
        if found:
            self._list.setCurrentItem(found[0])
        else:
            self._list.clearSelection()

    def _lay_out(self) -> None:
        sized(self._list, _NAME_PX)
        sized(self._name, _NAME_PX)
        sized(self._chosen, 30, is_bold=True)
        sized(self._trouble, LARGE_PX, is_bold=True)
        for button in (self._open, self._next):
            button.setAutoDefault(False)
            button.setMinimumSize(120, 44)
            sized(button, LARGE_PX, is_bold=True)
        self._next.setMaximumWidth(_WIDEST_PX)
        self._trouble.hide()
        new = _titled("newPersonTitle", "Somebody new")
        entry = QHBoxLayout()
        entry.setSpacing(8)
        entry.addWidget(self._name, 1)
        entry.addWidget(self._open)
        left = QFrame()
        framed(left)
        column = QVBoxLayout(left)
        column.addWidget(self._who)
        column.addWidget(self._list, 1)
        column.addWidget(new)
        column.addLayout(entry)
        column.addWidget(self._trouble)
        column.addStretch(0)  # where nobody is listed
        right = QFrame()
        framed(right)
        facts = QVBoxLayout(right)
        facts.setContentsMargins(24, 20, 24, 20)
        facts.addStretch(1)
        facts.addWidget(self._chosen)
        facts.addWidget(self._far)
        facts.addSpacing(12)
        facts.addWidget(self._next, alignment=Qt.AlignmentFlag.AlignLeft)
        facts.addStretch(2)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(6)
        layout.addWidget(left, 4)
        layout.addWidget(right, 6)


def _titled(name: str, text: str) -> QWidget:
    title = plain(name, TEXT_PX, is_wrapped=False)
    title.setText(text)
    sized(title, TEXT_PX, is_bold=True)
    return title


def _as_tip(name: str) -> str:
    """A name as tool tip: one that looks like markup would be read as such."""
    return f"<span>{html.escape(name)}</span>" if "<" in name else name


def _say(widget: QLabel | QPushButton, text: str) -> None:
    if widget.text() != text:
        widget.setText(text)
