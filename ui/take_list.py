"""The takes of a gesture in lines, the odd ones first."""

from PySide6.QtCore import QItemSelectionModel, Signal
from PySide6.QtGui import QColor
from PySide6.QtWidgets import (
    QAbstractItemView,
    QHeaderView,
    QTableWidget,
    QTableWidgetItem,
    QWidget,
)

from gestureapp.guided.check import CheckedTake, GestureCheck
from ui.theme import colours_of
from ui.train_words import take_text

HEADINGS = ("Take", "Verdict", "From the median")
_TAKE_PX, _FAR_PX = 40, 156


class TakeList(QTableWidget):
    """One line a take; one or several can be chosen.

    Signals:
        chosen_changed: Other takes are chosen by a person.
    """

    chosen_changed = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(0, len(HEADINGS), parent)
        self.setObjectName("takeList")
        self.setAccessibleName("Takes of the gesture, odd ones first")
        self.setHorizontalHeaderLabels(list(HEADINGS))
        self.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        self.setSelectionMode(QAbstractItemView.SelectionMode.ExtendedSelection)
        self.setTabKeyNavigation(False)
        self.setShowGrid(False)
        self.verticalHeader().hide()
        self.verticalHeader().setDefaultSectionSize(24)
        header = self.horizontalHeader()
        header.setHighlightSections(False)
        # Widths that follow the contents are measured again at every cell: 20 ms for thirty takes.
        header.setSectionResizeMode(QHeaderView.ResizeMode.Fixed)
        header.setSectionResizeMode(1, QHeaderView.ResizeMode.Stretch)
        header.resizeSection(0, _TAKE_PX)
        header.resizeSection(2, _FAR_PX)
        self._takes: tuple[CheckedTake, ...] = ()
        self.itemSelectionChanged.connect(self.chosen_changed)

    @property
    def chosen(self) -> tuple[CheckedTake, ...]:
        """The chosen takes, top to bottom."""
        rows = sorted(index.row() for index in self.selectionModel().selectedRows())
        return tuple(self._takes[row] for row in rows)

    def show_check(self, check: GestureCheck) -> None:
        """Show the takes of a gesture; those that were chosen stay so if they are still there."""
        kept = {checked.take.id for checked in self.chosen}
        self.blockSignals(True)
        self._takes = check.takes
        self.setRowCount(len(check.takes))
        for row, checked in enumerate(check.takes):
            self._fill(row, checked)
        self.blockSignals(False)
        self.choose(kept)

    def choose(self, take_ids: set[int]) -> None:
        """Choose these takes and no others, without saying so."""
        self.blockSignals(True)
        self.clearSelection()
        flags = QItemSelectionModel.SelectionFlag
        first = None
        for row, checked in enumerate(self._takes):
            if checked.take.id in take_ids:
                index = self.model().index(row, 0)
                self.selectionModel().select(index, flags.Select | flags.Rows)
                first = index if first is None else first
        if first is not None:
            self.scrollTo(first)
        self.blockSignals(False)

    def _fill(self, row: int, checked: CheckedTake) -> None:
        colours = colours_of(self.palette())
        texts = (f"{checked.number}", take_text(checked.take), checked.words)
        mark = "▲ " if checked.is_odd else ""
        for column, text in enumerate(texts):
            item = QTableWidgetItem(f"{mark}{text}" if column == len(texts) - 1 else text)
            if not checked.take.counts:
                item.setForeground(QColor(colours.muted))
            elif checked.is_odd and column == len(texts) - 1:
                item.setForeground(QColor(colours.attention))
            item.setToolTip(f"Take {checked.number}, session {checked.take.session}: {texts[1]}")
            self.setItem(row, column, item)
