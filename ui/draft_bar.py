"""Below settings being edited: what is not applied yet, Undo and Apply; and the PIN before them."""

from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QLineEdit, QPushButton, QWidget

from gestureapp.setup.controls import SetupControls
from gestureapp.setup.lock import PIN_DIGITS
from gestureapp.setup.site_values import LockView
from ui.background import Background
from ui.labels import plain
from ui.marks import Level, Mark
from ui.setting_editor import LockMark
from ui.settings_draft import SettingsDraft
from ui.theme import LARGE_PX, TEXT_PX, sized


class DraftBar(QFrame):
    """What a draft says, with Undo and Apply. GUI thread only."""

    def __init__(self, draft: SettingsDraft, name: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName(name)
        self._draft = draft
        self._mark = Mark(16)
        self._text = plain(f"{name}Text", TEXT_PX)
        self._undo = QPushButton("Undo")
        self._undo.setObjectName(f"{name}Undo")
        self._undo.setAccessibleName("Forget what was typed and not applied")
        self._apply = QPushButton("Apply")
        self._apply.setObjectName(f"{name}Apply")
        self._apply.setAccessibleName("Apply what was typed")
        layout = QHBoxLayout(self)
        layout.setContentsMargins(10, 6, 10, 6)
        layout.setSpacing(8)
        layout.addWidget(self._mark)
        layout.addWidget(self._text, 1)
        for button in (self._undo, self._apply):
            button.setAutoDefault(False)
            button.setMinimumSize(96, 36)
            sized(button, LARGE_PX, is_bold=button is self._apply)
            layout.addWidget(button)
        self._undo.clicked.connect(draft.undo)
        self._apply.clicked.connect(draft.apply)
        draft.changed.connect(self._show)
        self._show()

    def _show(self) -> None:
        draft = self._draft
        self._text.setText(draft.sentence)
        is_stuck = bool(draft.wrong) or draft.is_locked
        level = Level.ATTENTION if is_stuck else Level.BUSY if draft.names else Level.OFF
        self._mark.show_level(level)
        can_be_pressed = {self._undo: bool(draft.names), self._apply: draft.can_apply}
        if any(button.hasFocus() and not can for button, can in can_be_pressed.items()):
            self.setFocus()  # else Space would press whatever Qt hands the focus to
        for button, can in can_be_pressed.items():
            button.setEnabled(can)


class LockBar(QFrame):
    """Whether settings that bear on motion can be changed, and the PIN that opens them.

    Hidden while there is no PIN.
    """

    def __init__(self, controls: SetupControls, name: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName(name)
        self._controls = controls
        self._lock = LockMark()
        self._text = plain(f"{name}Text", TEXT_PX)
        self._background = Background("PIN", self)
        self._pin = pin_field(f"{name}Pin", "The PIN")
        self._open = QPushButton("Unlock")
        self._open.setObjectName(f"{name}Open")
        self._open.setAccessibleName("Give the PIN")
        self._close = QPushButton("Lock again")
        self._close.setObjectName(f"{name}Close")
        self._close.setAccessibleName("Lock the settings that bear on motion again")
        layout = QHBoxLayout(self)
        layout.setContentsMargins(10, 4, 10, 4)
        layout.setSpacing(8)
        layout.addWidget(self._lock)
        layout.addWidget(self._text, 1)
        for widget in (self._pin, self._open, self._close):
            layout.addWidget(widget)
        for button in (self._open, self._close):
            button.setAutoDefault(False)
            button.setMinimumHeight(32)
        self._open.clicked.connect(self._give)
        self._pin.returnPressed.connect(self._give)
        self._close.clicked.connect(controls.close_lock)
        self.show_lock(LockView())

    def show_lock(self, lock: LockView) -> None:
        """Show another moment of the lock."""
        is_closed = lock.has_pin and not lock.is_open
        going = (self._close,) if is_closed else (self._pin, self._open)
        if any(widget.hasFocus() for widget in going):
            self.setFocus()  # else Qt hands it to whatever comes next, and scrolls there
        self._lock.setVisible(is_closed)
        for widget in (self._pin, self._open):
            widget.setVisible(is_closed)
        self._close.setVisible(lock.has_pin and lock.is_open)
        self.setVisible(lock.has_pin)
        text = lock.text
        if text != self._text.text():
            self._text.setText(text)
            self._text.setAccessibleName(text)

    def _give(self) -> None:
        pin = self._pin.text()
        self._background.run(lambda: self._controls.open_lock(pin), lambda _: None)
        self._pin.clear()


def pin_field(name: str, what: str) -> QLineEdit:
    """A field for a PIN: digits that are not shown."""
    field = QLineEdit()
    field.setObjectName(name)
    field.setAccessibleName(what)
    field.setPlaceholderText("PIN")
    field.setEchoMode(QLineEdit.EchoMode.Password)
    field.setMaxLength(PIN_DIGITS[1])
    field.setFixedWidth(110)
    return field


def heading(name: str, text: str) -> QLabel:
    """A heading over a part of a page."""
    label = plain(name, LARGE_PX, is_wrapped=False)
    label.setText(text)
    sized(label, LARGE_PX, is_bold=True)
    return label
