"""The step Try: the model is tried with the arms, without the robot, and the answers counted."""

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QHBoxLayout, QProgressBar, QPushButton, QVBoxLayout, QWidget

from gestureapp.guided.controls import GuidedControls, TrainerControls
from gestureapp.guided.trying import NOT_RECOGNISED
from gestureapp.guided.values import GuidedSnapshot, TrainingView, Trying
from ui.answer_mark import Answer, AnswerMark
from ui.confusion_matrix import ConfusionMatrix
from ui.gesture_drawing import GestureDrawing
from ui.keep_heard import KeepHeard
from ui.labels import BigWord, plain
from ui.model_words import gesture_words, live_words, outcome_words
from ui.theme import LARGE_PX, SMALL_PX, sized

HOW = "Every gesture is asked for five times, in random order. The robot is not asked for anything."
_WORDS_PX = 26
_ANSWER_PX = 24


class TryStep(QWidget):
    """Asks for gestures in random order and shows what was heard. GUI thread only.

    Args:
        guided: Asked to start and to stop.
        trainer: Polled for whether there is a model, and whether it fits.
        parent: Qt's.
    """

    def __init__(
        self, guided: GuidedControls, trainer: TrainerControls, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.setObjectName("tryStep")
        self._guided = guided
        self._trainer = trainer
        self._is_on = False
        self._start = QPushButton("Start")
        self._start.setObjectName("tryButton")
        self._start.setMinimumSize(150, 46)
        sized(self._start, LARGE_PX + 2, is_bold=True)
        self._progress = QProgressBar()
        self._progress.setObjectName("tryProgress")
        self._progress.setMinimumHeight(26)
        self._text = plain("tryText", LARGE_PX)
        self._asked = BigWord("RX+", 60, 120)
        self._asked.setObjectName("tryAsked")
        self._words = plain("tryWords", _WORDS_PX)
        self._drawing = GestureDrawing()
        self._mark = AnswerMark(44)
        self._heard = plain("tryHeard", _ANSWER_PX)
        sized(self._heard, _ANSWER_PX, is_bold=True)
        self._reason = plain("tryReason", LARGE_PX)
        self._keep = KeepHeard("keepTried", guided, is_tried=True)
        self._figure = plain("tryFigure", _ANSWER_PX)
        sized(self._figure, _ANSWER_PX, is_bold=True)
        self._meaning = plain("tryMeaning", SMALL_PX + 1)
        self._matrix = ConfusionMatrix("tryMatrix")
        self._lay_out()
        self._start.clicked.connect(self._start_or_stop)

    def show_snapshot(self, snapshot: GuidedSnapshot) -> None:
        """Show another moment; nothing is done while the step is out of sight."""
        if not self.isVisible():
            return
        trying = snapshot.trying
        barrier = _barrier(snapshot, self._trainer.view())
        self._is_on = trying.is_on
        self._start.setEnabled(trying.is_on or not barrier)
        self._start.setText("Stop" if trying.is_on else "Try again" if trying.n_done else "Start")
        self._start.setAccessibleName(
            "Stop trying; what was counted is kept" if trying.is_on else barrier or "Try the model"
        )
        self._text.setText(trying.text if trying.is_on else barrier or trying.text or HOW)
        self._progress.setVisible(bool(trying.n_planned))
        self._progress.setRange(0, max(1, trying.n_planned))
        self._progress.setValue(trying.n_done)
        self._progress.setFormat(f"{trying.n_done} of {trying.n_planned}")
        self._progress.setAccessibleName(f"{trying.n_done} of {trying.n_planned} gestures tried")
        self._show_asked(trying.asked if trying.is_on else "")
        self._show_answer(trying)
        self._show_live(trying)
        self._keep.show_heard(snapshot.heard, trying.was_right)

    def _show_asked(self, label: str) -> None:
        if label == self._asked.text() and self._asked.accessibleName():
            return
        words = gesture_words(label)
        self._asked.setText(label)
        self._asked.setAccessibleName(f"Asked for: {label} {words}" if label else "Nothing asked")
        self._words.setText(words)
        # A model may know gestures that nothing is drawn for.
        self._drawing.set_gesture(label if words else "")

    def _show_answer(self, trying: Trying) -> None:
        answer = Answer.NONE
        if trying.heard:
            answer = Answer.RIGHT if trying.was_right else Answer.WRONG
            if trying.heard == NOT_RECOGNISED:
                answer = Answer.NOT_RECOGNISED
        self._mark.show_answer(answer)
        self._heard.setText(outcome_words(trying))
        self._reason.setText(trying.reason if trying.heard else "")

    def _show_live(self, trying: Trying) -> None:
        live = trying.live
        self._matrix.show_evaluation(live.evaluation if live is not None else None)
        if live is None:
            self._figure.setText("")
            self._meaning.setText("What is heard here is the figure that Operate shows.")
            return
        self._figure.setText(f"Recognised: {live_words(live.evaluation)}")
        state = (
            "This is the figure" if live.is_over else "So far. When all are tried, it is the one"
        )
        self._meaning.setText(f"{state} that Operate shows, with its count.")

    def _start_or_stop(self) -> None:
        if self._is_on:
            self._guided.stop_trying()
        else:
            self._guided.start_trying()

    def _lay_out(self) -> None:
        top = QHBoxLayout()
        top.setSpacing(12)
        top.addWidget(self._start)
        top.addWidget(self._text, 3)
        top.addWidget(self._progress, 2)
        answer = QHBoxLayout()
        answer.setSpacing(10)
        answer.addWidget(self._mark)
        answer.addWidget(self._heard, 1)
        left = QVBoxLayout()
        left.setSpacing(4)
        left.addWidget(self._asked, 2)
        left.addWidget(self._words)
        left.addWidget(self._drawing, 5)
        left.addLayout(answer)
        left.addWidget(self._reason)
        left.addWidget(self._keep)
        # Two lines are kept, so that nothing jumps when an answer comes.
        self._reason.setMinimumHeight(2 * self._reason.fontMetrics().lineSpacing())
        self._reason.setAlignment(Qt.AlignmentFlag.AlignTop)
        right = QVBoxLayout()
        right.setSpacing(4)
        right.addWidget(self._figure)
        right.addWidget(self._meaning)
        right.addWidget(self._matrix, 1)
        asked = QFrame()
        asked.setLayout(left)
        middle = QHBoxLayout()
        middle.setSpacing(14)
        middle.addWidget(asked, 4)
        middle.addLayout(right, 6)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(12, 8, 12, 8)
        layout.setSpacing(8)
        layout.addLayout(top)
        layout.addLayout(middle, 1)


def _barrier(snapshot: GuidedSnapshot, training: TrainingView) -> str:
    """Why the model cannot be tried; empty when it can."""
    if not snapshot.person:
        return "Choose a person first."
    if training.result is None:
        return "There is no model yet: train one first."
    return ""
