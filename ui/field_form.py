"""Some settings below each other, with what is drawn of them beside: the field, the facing."""

from collections.abc import Iterable

from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import (
    QButtonGroup,
    QGridLayout,
    QHBoxLayout,
    QVBoxLayout,
    QWidget,
)

from gestureapp.cell.snapshot import RobotView
from ui.choice_button import ChoiceButton
from ui.draft_bar import heading
from ui.facing_view import TURNS, FacingView, facing_text
from ui.labels import plain
from ui.pages import scrolled
from ui.robot_view import FieldView
from ui.setting_editor import SettingEditor
from ui.setting_values import edited_robot, in_words, why_not_text
from ui.settings_draft import SettingsDraft
from ui.theme import SMALL_PX, TEXT_PX, sized

FIELD = (
    ("Field of operation", ("ext_radius_mm", "int_radius_mm", "margin_mm")),
    ("Floor and ceiling", ("floor_mm", "ceiling_mm")),
    ("Robot's column", ("column_radius_mm", "column_top_mm")),
    ("Keep-outs", ("keep_outs",)),
    ("Orientation", ("rx_range_deg", "ry_range_deg", "rz_range_deg", "margin_deg")),
    ("Speeds", ("speed_mm_s", "speed_deg_s")),
)
"""Headings, and names in the table ``robot`` under each."""
DRIVE = (
    ("What ends a move", ("site.drive_mode",)),
    ("Tool and frame", ("robot.tool", "robot.tool_mm", "robot.frame")),
    ("Supervision by the controller", ("robot.supervision_input", "robot.supervision_hz")),
)
YAW = "robot.yaw_deg"
_TURN_WORDS = {
    0: "as the robot",
    90: "to its left",
    180: "towards it",
    -90: "to its right",
}


class SettingsForm(QWidget):
    """Editors under headings, scrolling where there is no room; built when the rows are there."""

    def __init__(
        self,
        draft: SettingsDraft,
        name: str,
        parts: Iterable[tuple[str, tuple[str, ...]]],
        parent: QWidget | None = None,
        *,
        has_meaning: bool = False,
    ) -> None:
        super().__init__(parent)
        self.setObjectName(name)
        self._draft = draft
        self._parts = tuple(parts)
        self._has_meaning = has_meaning
        self._editors: dict[str, SettingEditor] = {}
        self._column = QVBoxLayout()
        self._column.setSpacing(4)
        self._column.setContentsMargins(12, 8, 12, 8)
        area = scrolled(self._column, f"{name}Area", "Settings of the robot")
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(area)
        draft.changed.connect(self._show)

    def showEvent(self, event: QShowEvent) -> None:
        """Build it when it is first seen; the draft may have changed meanwhile."""
        super().showEvent(event)
        self._show()

    def _show(self) -> None:
        if not self.isVisible():
            return
        if not self._editors and self._draft.rows:
            self._build()
        for editor in self._editors.values():
            editor.show_draft()

    def _build(self) -> None:
        for title, names in self._parts:
            there = [name for name in names if name in self._draft.rows]
            if not there:
                continue
            self._column.addWidget(heading(f"title_{there[0]}", title))
            for name in there:
                editor = self._editors[name] = SettingEditor(self._draft, name)
                self._column.addWidget(editor)
                if self._has_meaning:
                    meaning = plain(f"about_{name}", SMALL_PX)
                    meaning.setText(in_words(self._draft.rows[name].about))
                    self._column.addWidget(meaning)
                    self._column.addSpacing(4)
            self._column.addSpacing(8)
        self._column.addStretch(1)


class FieldForm(QWidget):
    """The field of operation and the speeds, with the picture of what is typed."""

    def __init__(self, draft: SettingsDraft, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("fieldForm")
        self._draft = draft
        parts = [(title, tuple(f"robot.{n}" for n in names)) for title, names in FIELD]
        form = SettingsForm(draft, "fieldSettings", parts)
        self._picture = FieldView(edited_robot((), {}))
        self._picture.setObjectName("fieldPicture")
        note = plain("fieldNote", TEXT_PX)
        note.setText("As typed, before it is applied. The cross is the tool.")
        right = QVBoxLayout()
        right.setContentsMargins(8, 8, 8, 8)
        right.addWidget(self._picture, 1)
        right.addWidget(note)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(form, 6)
        layout.addLayout(right, 5)
        draft.changed.connect(self._show)

    def show_robot(self, robot: RobotView) -> None:
        """Show where the tool is."""
        self._picture.show_robot(robot)

    def _show(self) -> None:
        values = self._draft.usable_values()
        self._picture.show_settings(edited_robot(self._draft.rows.values(), values))


class DriveForm(QWidget):
    """Which way the operator faces, tool and frame, supervision, and what ends a move."""

    def __init__(self, draft: SettingsDraft, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("driveForm")
        self._draft = draft
        self._view = FacingView()
        self._words = plain("facingWords", TEXT_PX)
        self._lock = plain("facingLock", TEXT_PX)
        self._group = QButtonGroup(self)
        self._turns: dict[int, ChoiceButton] = {}
        self._facing = QWidget()
        self._facing.setObjectName("facingPanel")
        self._lay_out_facing()
        form = SettingsForm(draft, "driveSettings", DRIVE, has_meaning=True)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(form, 6)
        layout.addWidget(self._facing, 5)
        draft.changed.connect(self._show)

    def _lay_out_facing(self) -> None:
        buttons = QGridLayout()
        buttons.setSpacing(6)
        for i, turn in enumerate(TURNS):
            button = ChoiceButton(f"{_TURN_WORDS[turn]}  {turn}\u00b0")
            button.setObjectName(f"faces_{turn}")
            button.setAccessibleName(f"The operator faces {_TURN_WORDS[turn]}, {turn} degrees")
            button.setMinimumHeight(36)
            sized(button, TEXT_PX)
            button.clicked.connect(lambda _=False, turn=turn: self._draft.edit(YAW, str(turn)))
            self._group.addButton(button)
            self._turns[turn] = button
            buttons.addWidget(button, i // 2, i % 2)
        layout = QVBoxLayout(self._facing)
        layout.setContentsMargins(12, 8, 12, 8)
        layout.addWidget(heading("facingTitle", "Which way the operator faces"))
        layout.addWidget(self._view, 1)
        layout.addWidget(self._words)
        layout.addWidget(self._lock)
        layout.addLayout(buttons)

    def _show(self) -> None:
        row = self._draft.rows.get(YAW)
        self._facing.setVisible(row is not None)
        if row is None:
            return
        value = self._draft.usable_values().get(YAW, row.value)
        turn = float(value) if isinstance(value, int | float) else 0.0
        self._view.show_turn(turn)
        self._words.setText(facing_text(turn))
        why_not = why_not_text(row)
        self._lock.setText(why_not)
        self._lock.setVisible(bool(why_not))
        for each, button in self._turns.items():
            button.setEnabled(not why_not)
            button.setChecked(each == round(turn))
