"""Settings: all of them, by table, with meaning, range and origin; the PIN; what is wrong."""

from collections.abc import Sequence

from PySide6.QtCore import Qt
from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QLineEdit, QVBoxLayout, QWidget

from gestureapp.cell.snapshot import Snapshot
from gestureapp.settings_check import SettingsFinding
from gestureapp.setup.controls import SetupControls
from gestureapp.setup.site_values import SettingRow
from gestureapp.setup.snapshot import SetupSnapshot
from ui.draft_bar import DraftBar, LockBar, heading
from ui.labels import plain
from ui.marks import Level, Mark
from ui.operate_page import framed
from ui.pages import scrolled
from ui.pin_panel import PinPanel
from ui.robot_step import REFRESH_S
from ui.setting_editor import SettingEditor
from ui.setting_values import caption_of, in_words
from ui.settings_draft import SettingsDraft
from ui.settings_tree import SettingsTree
from ui.theme import LARGE_PX, SMALL_PX, TEXT_PX, sized

_FINDINGS_PX = 110
"""They scroll from this height on: the settings must stay in sight."""


class SettingsStep(QWidget):
    """A list to choose from, beside it the setting chosen. GUI thread only."""

    def __init__(self, controls: SetupControls, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("settingsStep")
        self._next_s = 0.0
        self._draft = SettingsDraft(controls, self)
        self._search = QLineEdit()
        self._search.setObjectName("settingsSearch")
        self._search.setAccessibleName("Look for settings by name or meaning")
        self._search.setPlaceholderText("look for a setting")
        self._search.setClearButtonEnabled(True)
        self._tree = SettingsTree(self._draft)
        self._none = plain("settingsNone", TEXT_PX)
        self._detail = _Detail(self._draft)
        self._findings = _Findings()
        self._pin = PinPanel(controls)
        self._lock = LockBar(controls, "settingsLock")
        self._bar = DraftBar(self._draft, "settingsDraft")
        self._lay_out()
        self._search.textChanged.connect(self._look_for)
        self._tree.chosen.connect(self._detail.show_setting)

    def show_snapshot(self, setup: SetupSnapshot, cell: Snapshot) -> None:
        """Show another moment of setting up."""
        if not self._draft.rows or setup.t_s >= self._next_s:
            self._draft.refresh()
            self._next_s = setup.t_s + REFRESH_S
        self._lock.show_lock(setup.lock)
        self._pin.show_lock(setup.lock)
        self._findings.show_findings(setup.findings)

    def leave(self) -> None:
        """The step goes out of sight; what was typed stays."""

    def showEvent(self, event: QShowEvent) -> None:
        """Another step may have changed the settings."""
        super().showEvent(event)
        self._next_s = 0.0

    def _look_for(self, wanted: str) -> None:
        n = self._tree.look_for(wanted)
        self._none.setText("" if n else f"No setting is called that: {wanted.strip()!r}.")
        self._none.setVisible(not n)

    def _lay_out(self) -> None:
        self._search.setMinimumHeight(32)
        self._none.hide()
        left = QVBoxLayout()
        left.setContentsMargins(0, 0, 0, 0)
        left.addWidget(self._search)
        left.addWidget(self._none)
        left.addWidget(self._tree, 1)
        right = QVBoxLayout()
        right.setContentsMargins(0, 0, 0, 0)
        right.addWidget(self._detail, 1)
        right.addWidget(self._pin)
        middle = QHBoxLayout()
        middle.addLayout(left, 6)
        middle.addLayout(right, 5)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self._findings)
        layout.addLayout(middle, 1)
        frames: tuple[QFrame, ...] = (self._detail, self._pin, self._lock, self._bar)
        for frame in frames:
            framed(frame)
        for frame in (self._lock, self._bar):
            layout.addWidget(frame)
        for each in (left, right, middle, layout):
            each.setSpacing(4)


class _Detail(QFrame):
    """One setting with everything that is known of it."""

    def __init__(self, draft: SettingsDraft, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("settingDetail")
        self._draft = draft
        self._editor: SettingEditor | None = None
        self._title = heading("settingTitle", "Choose a setting")
        self._name = plain("settingName", SMALL_PX)
        self._about = plain("settingAbout", TEXT_PX)
        self._origin = plain("settingOrigin", TEXT_PX)
        for label in (self._name, self._about, self._origin):
            label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self._place = QVBoxLayout()
        column = QVBoxLayout()
        column.setContentsMargins(12, 10, 12, 10)
        column.setSpacing(6)
        for widget in (self._title, self._name, self._about):
            column.addWidget(widget)
        column.addLayout(self._place)
        column.addWidget(self._origin)
        column.addStretch(1)
        area = scrolled(column, "settingDetailArea", "The setting chosen")
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(area)
        draft.changed.connect(self._show)

    def show_setting(self, name: str) -> None:
        """Show another one."""
        if self._editor is not None:
            if self._editor.name == name:
                return
            self._place.removeWidget(self._editor)
            self._editor.deleteLater()
        self._editor = SettingEditor(self._draft, name, has_caption=False)
        self._place.addWidget(self._editor)
        self._show()

    def _show(self) -> None:
        if self._editor is None:
            return
        row = self._draft.rows.get(self._editor.name)
        if row is None:
            return
        self._editor.show_draft()
        self._title.setText(caption_of(row.name))
        self._name.setText(row.name)
        self._about.setText(in_words(row.about))
        self._origin.setText(_origin_text(row))


class _Findings(QFrame):
    """What is wrong in the settings files, with file and line; hidden when nothing is."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("settingsFindings")
        self._shown: tuple[SettingsFinding, ...] = ()
        self._mark = Mark(16)
        self._mark.show_level(Level.ATTENTION)
        self._title = plain("findingsTitle", LARGE_PX)
        sized(self._title, LARGE_PX, is_bold=True)
        self._list = QVBoxLayout()
        self._list.setContentsMargins(0, 0, 6, 0)
        area = scrolled(self._list, "findingsArea", "What is wrong in the settings files")
        area.setMaximumHeight(_FINDINGS_PX)
        head = QHBoxLayout()
        head.addWidget(self._mark)
        head.addWidget(self._title, 1)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(12, 6, 12, 6)
        layout.addLayout(head)
        layout.addWidget(area)
        framed(self)
        self.hide()

    def show_findings(self, findings: Sequence[SettingsFinding]) -> None:
        """Show others."""
        if tuple(findings) == self._shown:
            return
        self._shown = tuple(findings)
        while (item := self._list.takeAt(0)) is not None:
            widget = item.widget()
            if widget is not None:
                widget.deleteLater()
        for i, finding in enumerate(self._shown):
            line: QLabel = plain(f"finding{i}", TEXT_PX)
            line.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
            line.setText(str(finding))
            self._list.addWidget(line)
        n = len(self._shown)
        one = "One thing is wrong in the settings files" if n == 1 else f"{n} things are wrong"
        self._title.setText(f"{one}; correct the file, or set the value here.")
        self.setVisible(bool(n))


def _origin_text(row: SettingRow) -> str:
    return f"Comes from: {row.origin}" if row.origin else ""
