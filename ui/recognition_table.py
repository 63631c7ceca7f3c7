"""How each gesture was heard: the table of the paper, in per cent with counts."""

from PySide6.QtCore import Qt
from PySide6.QtGui import QFont
from PySide6.QtWidgets import (
    QAbstractItemView,
    QHeaderView,
    QSizePolicy,
    QTableWidget,
    QTableWidgetItem,
    QWidget,
)

from gestureapp.guided.trying import NOT_RECOGNISED
from gestureapp.recognition.evaluation import Evaluation
from ui.model_words import gesture_words, share_words

HEADINGS = ("Gesture", "recognised", "wrong", NOT_RECOGNISED)
ALL = "All"
_ROW_PX = 21


class RecognitionTable(QTableWidget):
    """A row for each gesture in the takes, and one for all. Source of the form: paper, Table I."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(0, len(HEADINGS), parent)
        self.setObjectName("recognitionTable")
        self.setAccessibleName("Recognised, wrong and not recognised, for each gesture")
        self.setHorizontalHeaderLabels(list(HEADINGS))
        self.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.setSelectionMode(QAbstractItemView.SelectionMode.NoSelection)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setShowGrid(False)
        self.setAlternatingRowColors(True)
        self.verticalHeader().hide()
        self.verticalHeader().setMinimumSectionSize(_ROW_PX)
        self.verticalHeader().setSectionResizeMode(QHeaderView.ResizeMode.Stretch)
        header = self.horizontalHeader()
        header.setSectionResizeMode(QHeaderView.ResizeMode.Stretch)
        header.setSectionResizeMode(0, QHeaderView.ResizeMode.ResizeToContents)
        header.setHighlightSections(False)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setMinimumWidth(340)

    def show_evaluation(self, evaluation: Evaluation) -> None:
        """Show another evaluation."""
        rows = table_rows(evaluation)
        self.setRowCount(len(rows))
        for i, row in enumerate(rows):
            is_all = row[0] == ALL
            for column, text in enumerate(row):
                item = QTableWidgetItem(text)
                side = Qt.AlignmentFlag.AlignLeft if column == 0 else Qt.AlignmentFlag.AlignRight
                item.setTextAlignment(side | Qt.AlignmentFlag.AlignVCenter)
                if is_all:
                    font = QFont(self.font())
                    font.setBold(True)
                    item.setFont(font)
                if column == 0:
                    item.setToolTip(gesture_words(text))
                self.setItem(i, column, item)
        self.setMinimumHeight(self.horizontalHeader().sizeHint().height() + _ROW_PX * len(rows) + 4)


def table_rows(evaluation: Evaluation) -> list[tuple[str, str, str, str]]:
    """The table's texts: gesture, then recognised, wrong, not recognised as count and per cent."""
    rows = []
    for i, label in enumerate(evaluation.labels):
        counts = evaluation.confusion[i]
        total = int(counts.sum())
        if total:
            rows.append((label, *_shares(int(counts[i]), int(counts[-1]), total)))
    if rows:
        right = sum(int(evaluation.confusion[i, i]) for i in range(len(evaluation.labels)))
        none = int(evaluation.confusion[:, -1].sum())
        rows.append((ALL, *_shares(right, none, evaluation.n)))
    return rows


def _shares(right: int, none: int, total: int) -> tuple[str, str, str]:
    wrong = total - right - none
    return share_words(right, total), share_words(wrong, total), share_words(none, total)
