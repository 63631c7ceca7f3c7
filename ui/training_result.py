"""What a training came to: words first, then the table and the matrix, then the technical part."""

from collections.abc import Sequence

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QGridLayout, QHBoxLayout, QScrollArea, QVBoxLayout, QWidget

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
        self._judgement.setWordWrap(False)
        self._advice = plain("resultAdvice", LARGE_PX)
        self._how = plain("resultHow", SMALL_PX + 1)
        self._table = RecognitionTable()
        self._matrix = ConfusionMatrix("resultMatrix")
        self._facts = _Facts()
        self._mark = Mark(20)
        self._figures = QWidget()
        self._lay_out()

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
        how = f"Every take was heard by a network that had not seen it: {result.folds}."
        self._how.setText(f"{how} {result.promise}".strip())
        self._table.show_evaluation(evaluation)
        self._matrix.show_evaluation(evaluation)
        self._facts.show_facts(result.facts)

    def _lay_out(self) -> None:
        judged = QHBoxLayout()
        judged.setSpacing(10)
        judged.addWidget(self._mark)
        judged.addWidget(self._judgement)
        judged.addWidget(self._advice, 1)
        figures = QHBoxLayout(self._figures)
        figures.setContentsMargins(0, 0, 0, 0)
        figures.setSpacing(14)
        figures.addWidget(self._table, 2)
        figures.addWidget(self._matrix, 3)
        how = QHBoxLayout()
        how.addWidget(self._how, 1)
        how.addWidget(FoldButton("technicalFold", "Technical part", self._facts, self._figures))
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(4)
        layout.addLayout(judged)
        layout.addLayout(how)
        layout.addWidget(self._figures, 1)
        layout.addWidget(self._facts, 1)


class _Facts(QScrollArea):
    """Names and values in two columns."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("technicalPart")
        self.setAccessibleName("Technical part")
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setWidgetResizable(True)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)

    def show_facts(self, facts: Sequence[tuple[str, str]]) -> None:
        """Show other facts."""
        content = QWidget()
        grid = QGridLayout(content)
        grid.setHorizontalSpacing(16)
        grid.setVerticalSpacing(2)
        grid.setColumnStretch(1, 1)
        for row, fact in enumerate(facts):
            for column, text in enumerate(fact):
                label = plain(f"fact_{row}_{column}", TEXT_PX, is_wrapped=column > 0)
                label.setText(text)
                label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
                grid.addWidget(label, row, column, Qt.AlignmentFlag.AlignTop)
        grid.setRowStretch(len(facts), 1)
        self.setWidget(content)
