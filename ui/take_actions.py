"""What can be done with chosen takes: exclude, move, delete; and all of it taken back."""

from collections.abc import Sequence

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeySequence, QShortcut
from PySide6.QtWidgets import QGridLayout, QMenu, QPushButton, QToolButton, QWidget

from gestureapp.guided.controls import GuidedControls
from gestureapp.guided.values import GuidedSnapshot
from gestureapp.recording.take_values import Take
from ui.labels import ElidedLabel
from ui.model_words import gesture_words
from ui.theme import SMALL_PX, sized


class TakeActions(QWidget):
    """Buttons for the chosen takes. Asks ``GuidedControls``; what came of it is in its snapshot."""

    def __init__(self, guided: GuidedControls, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._guided = guided
        self._takes: tuple[Take, ...] = ()
        self._labels: tuple[str, ...] = ()
        self._exclude = _button("excludeTakes", "Exclude")
        self._move = QToolButton()
        self._move.setObjectName("moveTakes")
        self._move.setText("Move to…")
        self._move.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        self._move.setSizePolicy(self._exclude.sizePolicy())
        self._menu = QMenu(self._move)
        self._menu.setObjectName("moveTakesMenu")
        self._move.setMenu(self._menu)
        self._delete = _button("deleteTakes", "Delete")
        self._undo = _button("checkUndo", "Undo")
        self._redo = _button("checkRedo", "Redo")
        self._undo_words = ElidedLabel()
        self._undo_words.setObjectName("checkUndoWords")
        self._undo_words.setTextFormat(Qt.TextFormat.PlainText)
        sized(self._undo_words, SMALL_PX)
        self._lay_out()
        self._connect()
        self.show_takes((), ())

    def show_takes(self, takes: Sequence[Take], labels: tuple[str, ...]) -> None:
        """Act on these takes from now on.

        Args:
            takes: The chosen ones.
            labels: The gestures that a take can be moved to.
        """
        self._takes = tuple(takes)
        for button in (self._exclude, self._move, self._delete):
            button.setEnabled(bool(takes))
        are_out = bool(takes) and all(take.is_excluded for take in takes)
        word = "Include" if are_out else "Exclude"
        self._exclude.setText(word)
        what = f"{len(takes)} takes" if len(takes) != 1 else "the chosen take"
        self._exclude.setAccessibleName(f"{word} {what}")
        self._move.setAccessibleName(f"Move {what} to another gesture")
        self._delete.setAccessibleName(f"Delete {what}")
        if labels != self._labels:
            self._labels = labels
            self._fill_menu()
        own = {take.label for take in takes}
        for action in self._menu.actions():
            action.setVisible(action.data() not in own)

    def show_snapshot(self, snapshot: GuidedSnapshot) -> None:
        """Say what can be taken back, and done again."""
        self._undo.setEnabled(bool(snapshot.undo))
        self._redo.setEnabled(bool(snapshot.redo))
        words = f"Undo: {snapshot.undo}" if snapshot.undo else ""
        if snapshot.redo and not words:
            words = f"Redo: {snapshot.redo}"
        if words != self._undo_words.text():
            self._undo_words.setText(words)
            self._undo_words.setToolTip(words)
        self._undo.setToolTip(f"{snapshot.undo} (Ctrl+Z)" if snapshot.undo else "")
        self._redo.setToolTip(f"{snapshot.redo} (Ctrl+Shift+Z)" if snapshot.redo else "")
        self._undo.setAccessibleName(f"Undo {snapshot.undo}".strip())
        self._redo.setAccessibleName(f"Redo {snapshot.redo}".strip())

    def _change_exclusion(self) -> None:
        are_out = all(take.is_excluded for take in self._takes)
        for take in self._takes:
            if take.is_excluded is are_out:
                self._guided.exclude(take.id, is_excluded=not are_out)

    def _delete_takes(self) -> None:
        for take in self._takes:
            self._guided.delete(take.id)

    def _move_takes(self, label: str) -> None:
        for take in self._takes:
            self._guided.move(take.id, label)

    def _fill_menu(self) -> None:
        self._menu.clear()
        for label in self._labels:
            action = self._menu.addAction(f"{label}  {gesture_words(label)}".strip())
            action.setObjectName(f"moveTakes_{label}")
            action.setData(label)

    def _connect(self) -> None:
        self._exclude.clicked.connect(self._change_exclusion)
        self._delete.clicked.connect(self._delete_takes)
        self._menu.triggered.connect(lambda action: self._move_takes(action.data()))
        self._undo.clicked.connect(self._guided.undo)
        self._redo.clicked.connect(self._guided.redo)

    def add_keys(self, owner: QWidget) -> None:
        """Let keys do the same while ``owner`` is in sight, wherever the focus is."""
        keys = QKeySequence.StandardKey
        for key, button in (
            (QKeySequence(keys.Delete), self._delete),
            (QKeySequence("Ctrl+Z"), self._undo),
            (QKeySequence("Ctrl+Shift+Z"), self._redo),
        ):
            shortcut = QShortcut(key, owner)
            shortcut.setAutoRepeat(False)
            shortcut.activated.connect(button.click)

    def _lay_out(self) -> None:
        layout = QGridLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(4)
        self._undo_words.setMinimumHeight(self._undo_words.fontMetrics().lineSpacing())
        layout.addWidget(self._exclude, 0, 0)
        layout.addWidget(self._move, 0, 1)
        layout.addWidget(self._delete, 0, 2)
        layout.addWidget(self._undo, 1, 0)
        layout.addWidget(self._redo, 1, 1)
        layout.addWidget(self._undo_words, 2, 0, 1, 3)
        for column in range(3):
            layout.setColumnStretch(column, 1)


def _button(name: str, text: str) -> QPushButton:
    button = QPushButton(text)
    button.setObjectName(name)
    button.setAccessibleName(text)
    return button
