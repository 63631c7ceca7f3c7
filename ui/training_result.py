"""What a training came to: words first, then the table and the matrix, then the technical part."""

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QGridLayout, QHBoxLayout, QLabel, QVBoxLayout, QWidget

from gestureapp.guided.trained_words import Level as Reliance
from gestureapp.guided.trained_words import level_of
from gestureapp.guided.values import TrainingResult
from ui.confusion_matrix import ConfusionMatrix
from ui.fold import FoldButton
from ui.labels import plain
from ui.marks import Level, Mark
from ui.recognition_table import RecognitionTable
from ui.theme import LARGE_PX, SMALL_PX, TEXT_PX, sized

_JUDGEMENT_PX = 24


class TrainingResultView(QWidget):
    """One result; what is shown is kept until another one comes. GUI thread only."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("trainingResult")
        self._result: TrainingResult | None = None
        self._judgement = plain("resultJudgement", _JUDGEMENT_PX)
        sized(self._judgement, _JUDGEMENT_PX, is_bold=True)
        self._advice = plain("resultAdvice", LARGE_PX)
        self._how = plain("resultHow", SMALL_PX + 1)
        self._table = RecognitionTable()
        self._matrix = ConfusionMatrix("resultMatrix")
        self._facts = _Facts()
        self._mark = Mark(20)
        judged = QHBoxLayout()
        judged.setSpacing(8)
        judged.addWidget(self._mark)
        judged.addWidget(self._judgement, 1)
        shown = QWidget()
        figures = QHBoxLayout(shown)
        figures.setContentsMargins(0, 0, 0, 0)
        figures.setSpacing(14)
        figures.addWidget(self._table, 2)
        figures.addWidget(self._matrix, 3)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(6)
        layout.addLayout(judged)
        layout.addWidget(self._advice)
        layout.addWidget(self._how)
        layout.addWidget(shown, 1)
        layout.addWidget(self._facts, 1)
        layout.addWidget(FoldButton("technicalFold", "Technical part", self._facts, shown))

    def show_result(self, result: TrainingResult) -> None:
        """Show another result."""
        if result is self._result:
            return
        self._result = result
        judgement, _, others = " ".join(result.words).partition(". ")
        self._judgement.setText(f"{judgement.rstrip('.')}.")
        self._advice.setText(others)
        self._advice.setVisible(bool(others))
        evaluation = result.evaluation
        is_poor = level_of(evaluation) is Reliance.POOR
        self._mark.setVisible(is_poor)
        self._mark.show_level(Level.ATTENTION)
        self._how.setText(
            f"{evaluation.n} takes, each heard by a network that had not seen it ({result.folds}). "
            "Only trying it with the arms shows how well it does in operation."
        )
        self._table.show_evaluation(evaluation)
        self._matrix.show_evaluation(evaluation)
        self._facts.show_facts(result)


class _Facts(QFrame):
    """Names and values in two columns."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("technicalPart")
        self._grid = QGridLayout(self)
        self._grid.setContentsMargins(18, 2, 8, 4)
        self._grid.setHorizontalSpacing(16)
        self._grid.setVerticalSpacing(2)
        self._grid.setColumnStretch(1, 1)
        self._labels: list[QLabel] = []

    def show_facts(self, result: TrainingResult) -> None:
        """Show another result's facts."""
        for label in self._labels:
            self._grid.removeWidget(label)
            label.deleteLater()
        self._labels = []
        took = ("from the press to the written model", f"{result.duration_s:.1f} s")
        for row, fact in enumerate((*result.facts, took)):
            for column, text in enumerate(fact):
                label = plain(f"fact_{row}_{column}", TEXT_PX, is_wrapped=column > 0)
                label.setText(text)
                label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
                self._grid.addWidget(label, row, column, Qt.AlignmentFlag.AlignTop)
                self._labels.append(label)
            self._grid.setRowStretch(row, 0)
        self._grid.setRowStretch(len(result.facts) + 1, 1)
