"""Setting and taking away the PIN, with what it is good for."""

from PySide6.QtWidgets import QFrame, QHBoxLayout, QPushButton, QVBoxLayout, QWidget

from gestureapp.setup.controls import SetupControls
from gestureapp.setup.lock import WHAT_FOR
from gestureapp.setup.site_values import LockView
from ui.background import Background
from ui.draft_bar import heading, pin_field
from ui.labels import plain
from ui.theme import TEXT_PX

GIVE_FIRST = "Give the PIN first to change it or take it away."
DIFFERENT = "The two are different; type the new PIN again."


class PinPanel(QFrame):
    """Two fields for a new PIN. GUI thread only."""

    def __init__(self, controls: SetupControls, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("pinPanel")
        self._controls = controls
        self._background = Background("PIN", self)
        self._wanted: bool | None = None
        """Whether there will be a PIN, once that is done."""
        self._background.on_error(self._tell)
        self._new = pin_field("newPin", "A new PIN")
        self._again = pin_field("newPinAgain", "The new PIN again")
        self._new.setPlaceholderText("new PIN")
        self._again.setPlaceholderText("once more")
        self._set = QPushButton("Set PIN")
        self._set.setObjectName("setPin")
        self._set.setAccessibleName("Set the PIN")
        self._clear = QPushButton("Take it away")
        self._clear.setObjectName("clearPin")
        self._clear.setAccessibleName("Take the PIN away")
        self._worth = plain("pinWorth", TEXT_PX)
        self._said = plain("pinSaid", TEXT_PX)
        self._lay_out()
        self._set.clicked.connect(self._set_new)
        self._again.returnPressed.connect(self._set_new)
        self._clear.clicked.connect(self._take_away)
        self.show_lock(LockView())

    def show_lock(self, lock: LockView) -> None:
        """Show what can be done in this state of the lock."""
        is_open = lock.is_open or not lock.has_pin
        worth = WHAT_FOR if lock.has_pin else lock.text
        if worth != self._worth.text():
            self._worth.setText(worth)
        for widget in (self._new, self._again, self._set):
            widget.setEnabled(is_open)
        self._clear.setVisible(lock.has_pin)
        self._clear.setEnabled(is_open)
        if not is_open:
            self._tell(GIVE_FIRST)
        elif self._said.text() == GIVE_FIRST:
            self._tell("")
        if self._wanted is not None and self._wanted is lock.has_pin:
            self._tell("The PIN is set." if lock.has_pin else "There is no PIN any more.")
            self._wanted = None

    def _set_new(self) -> None:
        pin, again = self._new.text(), self._again.text()
        if not pin:
            self._tell("Type the new PIN first.")
            return
        if pin != again:
            self._tell(DIFFERENT)
            return
        self._keep(pin)
        self._new.clear()
        self._again.clear()

    def _take_away(self) -> None:
        self._keep("")

    def _keep(self, pin: str) -> None:
        set_pin = self._controls.set_pin
        self._wanted = None
        self._background.run(lambda: set_pin(pin), lambda why_not: self._asked(pin, why_not))

    def _asked(self, pin: str, why_not: str) -> None:
        self._tell(why_not)
        self._wanted = None if why_not else bool(pin)

    def _tell(self, text: str) -> None:
        if text != self._said.text():
            self._said.setText(text)
        self._said.setVisible(bool(text))

    def _lay_out(self) -> None:
        entry = QHBoxLayout()
        entry.setSpacing(6)
        for widget in (self._new, self._again, self._set, self._clear):
            entry.addWidget(widget)
        entry.addStretch(1)
        for button in (self._set, self._clear):
            button.setAutoDefault(False)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(12, 8, 12, 8)
        layout.setSpacing(4)
        layout.addWidget(heading("pinTitle", "PIN"))
        layout.addWidget(self._worth)
        layout.addLayout(entry)
        layout.addWidget(self._said)
