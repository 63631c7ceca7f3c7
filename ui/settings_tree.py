"""All settings in a list by table: value, where it comes from, whether it is locked or changed."""

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtGui import QIcon
from PySide6.QtWidgets import QAbstractItemView, QHeaderView, QTreeWidget, QTreeWidgetItem, QWidget

from gestureapp.setup.site_values import SettingRow
from ui.setting_editor import lock_icon
from ui.setting_values import caption_of, matches, value_text
from ui.settings_draft import SettingsDraft
from ui.theme import colours_of

_MARK = 3
_COLUMNS = ("Setting", "Value", "Comes from", "State")
_NAME_ROLE = Qt.ItemDataRole.UserRole
_ROW_PX = 26
_TABLES = {
    "left": "Left sensor",
    "right": "Right sensor",
    "site": "Site",
    "robot": "Robot",
    "joints": "Joints of the robot",
    "person": "Person",
    "training": "Training",
}


class SettingsTree(QTreeWidget):
    """One line for each setting. GUI thread only.

    Signals:
        chosen: Dotted name of the setting to be looked at.
    """

    chosen = Signal(str)

    def __init__(self, draft: SettingsDraft, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("settingsList")
        self.setAccessibleName("Settings")
        self._draft = draft
        self._items: dict[str, QTreeWidgetItem] = {}
        self._heads: dict[str, QTreeWidgetItem] = {}
        self._tables: dict[str, list[str]] = {}
        self._wanted = ""
        self._lock = lock_icon(colours_of(self.palette()).muted)
        self.setColumnCount(len(_COLUMNS))
        self.setHeaderLabels(list(_COLUMNS))
        self.setUniformRowHeights(True)
        self.setRootIsDecorated(False)
        self.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setTextElideMode(Qt.TextElideMode.ElideMiddle)
        self.currentItemChanged.connect(self._choose)
        draft.changed.connect(self._show)

    def look_for(self, wanted: str) -> int:
        """Show only the settings that match; how many do."""
        self._wanted = wanted
        n = 0
        for name, item in self._items.items():
            is_shown = matches(self._draft.rows[name], wanted)
            item.setHidden(not is_shown)
            n += is_shown
        for table, names in self._tables.items():
            self._heads[table].setHidden(all(self._items[name].isHidden() for name in names))
        return n

    def _show(self) -> None:
        if list(self._items) != list(self._draft.rows):
            self._build()
        for name, item in self._items.items():
            self._fill(item, self._draft.rows[name])
        self.setColumnHidden(_MARK, not any(i.text(_MARK) for i in self._items.values()))

    def _build(self) -> None:
        self.clear()
        for known in (self._items, self._heads, self._tables):
            known.clear()
        for name in self._draft.rows:
            table = name.partition(".")[0]
            if table not in self._heads:
                self._heads[table] = self._head(table)
                self._tables[table] = []
            self._tables[table].append(name)
            item = self._items[name] = QTreeWidgetItem(self._heads[table])
            item.setData(0, _NAME_ROLE, name)
            item.setSizeHint(0, QSize(0, _ROW_PX))
        self.expandAll()
        self._size_columns()
        self.look_for(self._wanted)

    def _head(self, table: str) -> QTreeWidgetItem:
        head = QTreeWidgetItem([_TABLES.get(table, table)])
        head.setFlags(Qt.ItemFlag.ItemIsEnabled)
        font = self.font()
        font.setBold(True)
        head.setFont(0, font)
        head.setSizeHint(0, QSize(0, _ROW_PX))
        self.addTopLevelItem(head)
        head.setFirstColumnSpanned(True)
        return head

    def _size_columns(self) -> None:
        header = self.header()
        header.setStretchLastSection(False)
        modes = (
            QHeaderView.ResizeMode.Stretch,
            QHeaderView.ResizeMode.Fixed,
            QHeaderView.ResizeMode.Fixed,
            QHeaderView.ResizeMode.Fixed,
        )
        for column, mode in enumerate(modes):
            header.setSectionResizeMode(column, mode)
        for column, width_px in ((1, 130), (2, 130), (3, 84)):
            header.resizeSection(column, width_px)

    def _fill(self, item: QTreeWidgetItem, row: SettingRow) -> None:
        draft = self._draft
        is_changed = row.name in draft.names
        text = draft.text(row.name) if is_changed else value_text(row)
        value = f"{' | '.join(text.splitlines())} {row.unit}".strip()
        mark = "wrong" if row.name in draft.wrong else "changed" if is_changed else ""
        if row.is_locked or row.fixed:
            mark = "fixed" if row.fixed else "locked"
        item.setIcon(_MARK, self._lock if row.is_locked or row.fixed else QIcon())
        for column, words in enumerate((caption_of(row.name), value, row.origin, mark)):
            if item.text(column) != words:
                item.setText(column, words)

    def _choose(self, item: QTreeWidgetItem | None) -> None:
        name = None if item is None else item.data(0, _NAME_ROLE)
        if name:
            self.chosen.emit(name)
