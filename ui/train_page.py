"""The training's page: its steps across the top, the one in sight below."""

from PySide6.QtWidgets import QVBoxLayout, QWidget

from gestureapp.cell.controls import CellControls
from gestureapp.cell.snapshot import Snapshot
from gestureapp.guided.controls import GuidedControls, TrainerControls
from gestureapp.guided.values import GuidedSnapshot, Pace, Phase
from ui.check_step import CheckStep
from ui.pages import PageStack
from ui.person_step import PersonStep
from ui.record_step import RecordStep
from ui.sensors_step import SensorsStep
from ui.step_bar import StepBar
from ui.train_step import TrainStep
from ui.train_words import Step, is_running, step_states
from ui.try_step import TryStep


class TrainPage(QWidget):
    """Leads from a person to a tried model. Only the step in sight is drawn. GUI thread only.

    Attributes:
        step: The one in sight.
        newest: What was shown last.
        notice: What has to be said across the window: a lost sensor, takes that cannot be kept.
    """

    def __init__(
        self,
        cell: CellControls,
        guided: GuidedControls,
        trainer: TrainerControls,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.setObjectName("trainPage")
        self.step = Step.PERSON
        self.notice = ""
        self._guided, self._trainer = guided, trainer
        self.newest = guided.snapshot()
        self._person = ""
        self._bar = StepBar()
        self._person_step = PersonStep(guided, cell.settings.person.name)
        self._sensors_step = SensorsStep(cell)
        self._record_step = RecordStep(cell, guided)
        self._steps: dict[Step, QWidget] = {
            Step.PERSON: self._person_step,
            Step.SENSORS: self._sensors_step,
            Step.RECORD: self._record_step,
        }
        self._later_steps: dict[Step, CheckStep | TrainStep | TryStep] = {
            Step.CHECK: CheckStep(guided),
            Step.TRAIN: TrainStep(trainer),
            Step.TRY: TryStep(guided, trainer),
        }
        self._steps.update(self._later_steps)
        self._stack = PageStack("trainSteps")
        for widget in self._steps.values():
            self._stack.addWidget(widget)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(6)
        layout.addWidget(self._bar)
        layout.addWidget(self._stack, 1)
        self._bar.chosen.connect(self.go_to)
        self._person_step.finished.connect(lambda: self.go_to(Step.SENSORS))
        self._sensors_step.finished.connect(lambda: self.go_to(Step.RECORD))

    def show_snapshot(self, cell: Snapshot) -> None:
        """Show another moment of the cell and of the training."""
        guided = self.newest = self._guided.snapshot()
        states = step_states(guided, self._trainer.view(), cell)
        self._bar.show_states(states)
        if states[self.step].barrier:
            self.go_to(Step.PERSON)
        if guided.person != self._person:
            self._person = guided.person
            self._choose_pace(guided, cell)
        self.notice = _notice_of(guided)
        match self.step:
            case Step.PERSON:
                self._person_step.show_snapshot(guided)
            case Step.SENSORS:
                self._sensors_step.show_snapshot(guided, cell)
            case Step.RECORD:
                self._record_step.show_snapshot(guided, cell)
            case later if later in self._later_steps:
                self._later_steps[later].show_snapshot(guided)

    def go_to(self, step: Step) -> None:
        """Show another step; a batch or a test under way is put on hold."""
        if step is not self.step:
            self.leave()
        if step is Step.PERSON:
            self._person_step.refresh()
        self.step = step
        self._bar.show_step(step)
        self._stack.setCurrentWidget(self._steps[step])
        self.setFocus()  # else Space would press whatever Qt hands the focus to

    def leave(self) -> None:
        """The page or its step goes out of sight: nothing is to be recorded unseen."""
        if is_running(self.newest.phase):
            self._guided.pause()
        if self.newest.trying.is_on:
            self._guided.stop_trying()

    def _choose_pace(self, guided: GuidedSnapshot, cell: Snapshot) -> None:
        """By the beat where there is no left sensor; else as in operation."""
        if guided.person and guided.phase is Phase.IDLE and not cell.left.is_ok:
            self._guided.set_pace(Pace.RHYTHM, guided.beat_s)


def _notice_of(guided: GuidedSnapshot) -> str:
    if guided.trouble:
        return guided.trouble
    return guided.sentence if guided.phase is Phase.SENSOR_LOST else ""
