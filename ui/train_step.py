"""The step Train: one button, how far it is, and what came of it."""

from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QButtonGroup,
    QHBoxLayout,
    QProgressBar,
    QPushButton,
    QRadioButton,
    QVBoxLayout,
    QWidget,
)

from gestureapp.guided.controls import TrainerControls
from gestureapp.guided.values import GuidedSnapshot, TrainingPhase, TrainingView
from gestureapp.recognition.presets import Preset
from ui.fold import FoldButton
from ui.labels import plain
from ui.loss_plot import LossPlot
from ui.marks import Level, Mark
from ui.model_words import (
    PRESET_WORDS,
    missing_for_training,
    ready_words,
    remaining_words,
    sentence,
)
from ui.theme import LARGE_PX, RADIO_STYLE, TEXT_PX, sized
from ui.training_result import TrainingResultView

_LEVELS = {
    TrainingPhase.FAILED: Level.ATTENTION,
    TrainingPhase.DONE: Level.OK,
}
_ENDED_EARLY = (TrainingPhase.CANCELLED, TrainingPhase.FAILED)


class TrainStep(QWidget):
    """Trains the person's model and says how good it is. GUI thread only.

    Args:
        trainer: Asked to train and to cancel; polled for how far it is.
        parent: Qt's.
    """

    def __init__(self, trainer: TrainerControls, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("trainStep")
        self._trainer = trainer
        self._train = QPushButton("Train")
        self._train.setObjectName("trainButton")
        self._train.setMinimumSize(150, 40)
        sized(self._train, LARGE_PX + 2, is_bold=True)
        self._cancel = QPushButton("Cancel")
        self._cancel.setObjectName("cancelTraining")
        self._cancel.setAccessibleName("Cancel the training; the model there was stays")
        self._cancel.setMinimumSize(110, 40)
        sized(self._cancel, LARGE_PX)
        self._mark = Mark(16)
        self._text = plain("trainText", LARGE_PX)
        self._progress = QProgressBar()
        self._progress.setObjectName("trainProgress")
        self._progress.setRange(0, 1000)
        self._progress.setMinimumHeight(26)
        self._loss = LossPlot()
        self._result = TrainingResultView()
        self._presets = QButtonGroup(self)
        self._lay_out()
        self._train.clicked.connect(self._start)
        self._cancel.clicked.connect(trainer.cancel)

    def show_snapshot(self, snapshot: GuidedSnapshot) -> None:
        """Show another moment; nothing is done while the step is out of sight."""
        if not self.isVisible():
            return
        view = self._trainer.view()
        is_running = view.phase is TrainingPhase.RUNNING
        missing = "Choose a person first."
        if snapshot.person:
            missing = missing_for_training(snapshot.progress)
        self._train.setEnabled(not is_running and not missing)
        self._train.setText("Train again" if view.result is not None else "Train")
        self._train.setAccessibleName(missing or "Train the model from the takes that count")
        self._cancel.setVisible(is_running)
        for button in self._presets.buttons():
            button.setEnabled(not is_running)
        self._show_text(view, missing, snapshot)
        self._show_progress(view)
        self._result.setVisible(view.result is not None and not is_running)
        self._filler.setVisible(view.result is None and not is_running)
        if view.result is not None:
            self._result.show_result(view.result)

    def _show_text(self, view: TrainingView, missing: str, snapshot: GuidedSnapshot) -> None:
        stands_against = missing
        if view.out_of_date and not missing:
            stands_against = f"Out of date: {view.out_of_date}. Train again."
        ended = sentence(view.text) if view.phase in _ENDED_EARLY else ""
        if view.phase is TrainingPhase.RUNNING:
            text, level = view.text, Level.BUSY
        elif stands_against:
            text, level = f"{ended}\n{stands_against}".strip(), Level.ATTENTION
        else:
            text = view.text or ready_words(snapshot.progress)
            level = _LEVELS.get(view.phase, Level.OFF)
        self._text.setText(sentence(text))
        self._mark.show_level(level)

    def _show_progress(self, view: TrainingView) -> None:
        is_running = view.phase is TrainingPhase.RUNNING
        self._progress.setVisible(is_running)
        self._loss.setVisible(is_running)
        if not is_running:
            return
        done = min(1.0, max(0.0, view.done))
        words = remaining_words(view.remaining_s)
        self._progress.setValue(round(1000 * done))
        self._progress.setFormat(f"{100 * done:.0f} %{', ' if words else ''}{words}")
        self._progress.setAccessibleName(f"Training: {self._progress.text()}")
        self._loss.show_losses(view.losses)

    def _start(self) -> None:
        self._loss.show_losses(())
        self._trainer.start(list(PRESET_WORDS)[self._presets.checkedId()])

    def _preset_chooser(self) -> QWidget:
        chooser = QWidget()
        layout = QVBoxLayout(chooser)
        layout.setContentsMargins(18, 0, 0, 0)
        layout.setSpacing(2)
        for number, preset in enumerate(PRESET_WORDS):
            button = QRadioButton(PRESET_WORDS[preset])
            button.setStyleSheet(RADIO_STYLE)
            button.setObjectName(f"preset_{preset.value}")
            button.setAccessibleName(PRESET_WORDS[preset])
            button.setChecked(preset is Preset.DEFAULT)
            sized(button, TEXT_PX)
            self._presets.addButton(button, number)
            layout.addWidget(button, 0, Qt.AlignmentFlag.AlignLeft)
        return chooser

    def _lay_out(self) -> None:
        top = QHBoxLayout()
        top.setSpacing(12)
        top.addWidget(self._train)
        top.addWidget(self._cancel)
        top.addWidget(self._mark)
        top.addWidget(self._text, 1)
        chooser = self._preset_chooser()
        top.addWidget(FoldButton("presetFold", "More", chooser))
        self._filler = QWidget()
        layout = QVBoxLayout(self)
        layout.setContentsMargins(12, 4, 12, 4)
        layout.setSpacing(6)
        layout.addLayout(top)
        layout.addWidget(chooser)
        layout.addWidget(self._progress)
        layout.addWidget(self._loss, 1)
        layout.addWidget(self._result, 1)
        layout.addWidget(self._filler, 1)
