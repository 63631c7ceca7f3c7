"""One setting in the window: its name, what it is set with, its unit, and what is allowed."""

from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QIcon, QPainter, QPaintEvent, QPalette, QPen, QPixmap
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QGridLayout,
    QHBoxLayout,
    QLineEdit,
    QPlainTextEdit,
    QSizePolicy,
    QWidget,
)

from gestureapp.setup.site_values import SettingRow
from ui.labels import plain
from ui.marks import Level, Mark
from ui.setting_values import (
    BOX_FORM,
    NEEDS_PIN,
    OFF,
    ON,
    Kind,
    caption_of,
    choice_texts,
    in_words,
    kind_of,
    why_not_text,
)
from ui.settings_draft import SettingsDraft
from ui.theme import SMALL_PX, TEXT_PX, colours_of

Control = QLineEdit | QCheckBox | QComboBox | QPlainTextEdit
_NUMBER_PX = 96
_WORDS_PX = 220
_BOXES_PX = 66
_ICON_PX = 64
"""Large enough for every scale of the screen."""


class LockMark(QWidget):
    """A padlock beside what needs the PIN. Drawn, not loaded."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)
        self.setAccessibleName(NEEDS_PIN)

    def sizeHint(self) -> QSize:
        """A square."""
        return QSize(16, 16)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw body and shackle."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        draw_lock(painter, QRectF(self.rect()), QColor(colours_of(self.palette()).muted))
        painter.end()


def draw_lock(painter: QPainter, area: QRectF, colour: QColor) -> None:
    """A padlock as large as the area."""
    size = min(area.width(), area.height())
    body = QRectF(0, 0, size * 0.75, size * 0.5)
    body.moveCenter(QPointF(area.center().x(), area.center().y() + size * 0.2))
    painter.fillRect(body, colour)
    painter.setPen(QPen(colour, max(1.5, size / 9)))
    painter.setBrush(Qt.BrushStyle.NoBrush)
    shackle = QRectF(0, 0, size * 0.42, size * 0.6)
    shackle.moveCenter(QPointF(area.center().x(), body.top()))
    painter.drawArc(shackle, 0, 180 * 16)


def lock_icon(colour: str) -> QIcon:
    """The padlock for a list."""
    picture = QPixmap(_ICON_PX, _ICON_PX)
    picture.fill(Qt.GlobalColor.transparent)
    painter = QPainter(picture)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    draw_lock(painter, QRectF(picture.rect()), QColor(colour))
    painter.end()
    return QIcon(picture)


class SettingEditor(QWidget):
    """Edits one setting of a draft. GUI thread only.

    Args:
        draft: Holds what is typed.
        name: Dotted name of the setting; the draft has it.
        has_caption: Whether its name stands before it.
    """

    def __init__(
        self,
        draft: SettingsDraft,
        name: str,
        parent: QWidget | None = None,
        *,
        has_caption: bool = True,
    ) -> None:
        super().__init__(parent)
        self.name = name
        self._draft = draft
        row = draft.rows[name]
        self._control = _control_for(row)
        self._control.setObjectName(f"setting_{name}")
        self._control.setAccessibleName(f"{caption_of(name)} {row.unit}".strip())
        self._lock = LockMark()
        self._mark = Mark(14)
        self._mark.show_level(Level.ATTENTION)
        self._note = plain(f"note_{name}", SMALL_PX)
        self._note.setBuddy(self._control)
        self._lay_out(row, has_caption)
        self._connect()
        self.show_draft()

    def show_draft(self) -> None:
        """Show what the draft has: the text, what is wrong with it, whether it is locked."""
        row = self._draft.rows.get(self.name)
        if row is None:
            return
        _put(self._control, self._draft.text(self.name))
        wrong = self._draft.wrong.get(self.name, "")
        self._control.setEnabled(not row.is_locked and not row.fixed)
        self._lock.setVisible(row.is_locked or bool(row.fixed))
        self._mark.setVisible(bool(wrong))
        self._note.setText(in_words(wrong or _note_of(row)))
        self._control.setAccessibleDescription(self._note.text())
        colours = colours_of(self.palette())
        palette = QPalette(self.palette())
        colour = QColor(colours.attention if wrong else colours.muted)
        palette.setColor(QPalette.ColorRole.WindowText, colour)
        self._note.setPalette(palette)

    def _lay_out(self, row: SettingRow, has_caption: bool) -> None:
        kind = kind_of(row)
        unit = plain(f"unit_{self.name}", TEXT_PX, is_wrapped=False)
        unit.setText(row.unit)
        entry = QHBoxLayout()
        entry.setSpacing(6)
        entry.addWidget(self._control, 1 if kind in (Kind.TEXT, Kind.BOXES) else 0)
        entry.addWidget(unit)
        entry.addStretch(0 if kind in (Kind.TEXT, Kind.BOXES) else 1)
        said = QHBoxLayout()
        said.setSpacing(5)
        for widget in (self._lock, self._mark):
            said.addWidget(widget)
        said.addWidget(self._note, 1)
        layout = QGridLayout(self)
        layout.setContentsMargins(0, 2, 0, 2)
        layout.setHorizontalSpacing(10)
        layout.setVerticalSpacing(1)
        if has_caption:
            caption = plain(f"caption_{self.name}", TEXT_PX)
            caption.setText(caption_of(self.name))
            caption.setFixedWidth(160)
            layout.addWidget(caption, 0, 0)
        if kind in (Kind.BOXES, Kind.TEXT, Kind.CHOICE):
            layout.addLayout(entry, 0, 1)
            layout.addLayout(said, 1, 1)
            layout.setColumnStretch(1, 1)
        else:
            layout.addLayout(entry, 0, 1)
            layout.addLayout(said, 0, 2)
            layout.setColumnStretch(2, 1)

    def _connect(self) -> None:
        control = self._control
        if isinstance(control, QLineEdit):
            control.textEdited.connect(self._typed)
        elif isinstance(control, QCheckBox):
            control.toggled.connect(lambda is_on: self._typed(ON if is_on else OFF))
        elif isinstance(control, QComboBox):
            control.currentTextChanged.connect(self._typed)
        else:
            control.textChanged.connect(lambda: self._typed(control.toPlainText()))

    def _typed(self, text: str) -> None:
        self._draft.edit(self.name, text)


def _note_of(row: SettingRow) -> str:
    """Why it cannot be changed, and what it may be."""
    why_not = "Locked." if row.is_locked and not row.fixed else why_not_text(row)
    allowed = f"Allowed: {row.allowed}" if row.allowed and not row.choices else ""
    return f"{why_not} {allowed}".strip()


def _control_for(row: SettingRow) -> Control:
    match kind_of(row):
        case Kind.TOGGLE:
            return QCheckBox("on")
        case Kind.CHOICE:
            choice = QComboBox()
            choice.addItems(choice_texts(row))
            choice.setFixedWidth(_WORDS_PX)
            return choice
        case Kind.BOXES:
            boxes = QPlainTextEdit()
            boxes.setPlaceholderText(f"one on each line, {BOX_FORM}")
            boxes.setFixedHeight(_BOXES_PX)
            boxes.setTabChangesFocus(True)
            boxes.setLineWrapMode(QPlainTextEdit.LineWrapMode.NoWrap)
            return boxes
        case kind:
            line = QLineEdit()
            if kind is not Kind.TEXT:
                line.setFixedWidth(_NUMBER_PX if kind is Kind.NUMBER else _NUMBER_PX + 30)
            return line


def _put(control: Control, text: str) -> None:
    """Show a text without that counting as typed; the cursor stays where it is."""
    is_blocked = control.blockSignals(True)
    if isinstance(control, QCheckBox):
        control.setChecked(text == ON)
    elif isinstance(control, QComboBox):
        if control.findText(text) < 0:
            control.addItem(text)
        control.setCurrentText(text)
    elif isinstance(control, QLineEdit):
        if control.text() != text:
            control.setText(text)
    elif control.toPlainText() != text:
        control.setPlainText(text)
    control.blockSignals(is_blocked)
