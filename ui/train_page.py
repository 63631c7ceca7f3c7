"""The training's page: its steps across the top, the one in sight below."""

from collections.abc import Callable
from dataclasses import dataclass

from PySide6.QtGui import QShowEvent
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


@dataclass(frozen=True, slots=True)
class _Built:
    """A step's widget, and how it is shown another moment of the training and of the cell."""

    widget: QWidget
    show: Callable[[GuidedSnapshot, Snapshot], None]


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
        self._cell, self._guided, self._trainer = cell, guided, trainer
        self.newest = guided.snapshot()
        self._person = ""
        self._is_pace_open = True
        """The person has not said what begins a take."""
        self._is_entered = False
        """The step in sight has come into sight since the last moment shown."""
        self._bar = StepBar("stepBar", tuple(Step), "step")
        self._built: dict[Step, _Built] = {}
        self._stack = PageStack("trainSteps")
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(6)
        layout.addWidget(self._bar)
        layout.addWidget(self._stack, 1)
        self._bar.chosen.connect(self.go_to)

    def show_snapshot(self, cell: Snapshot) -> None:
        """Show another moment of the cell and of the training."""
        guided = self.newest = self._guided.snapshot()
        states = step_states(guided, self._trainer.view(), cell)
        self._bar.show_states(states)
        if states[self.step].barrier:
            self.go_to(Step.PERSON)
        if guided.person != self._person:
            self._person = guided.person
            self._is_pace_open = True
        if self._is_entered and self.step is Step.RECORD:
            self._choose_pace(guided, cell)
        self._is_entered = False
        self.notice = _notice_of(guided)
        self._in_sight().show(guided, cell)

    def go_to(self, step: Step) -> None:
        """Show another step; a batch or a test under way is put on hold."""
        if step is not self.step:
            self.leave()
        self.step, self._is_entered = step, True
        self._bar.show_step(step)
        self._in_sight()
        self.setFocus()  # else Space would press whatever Qt hands the focus to

    def showEvent(self, event: QShowEvent) -> None:
        """The page comes into sight, and its step with it."""
        super().showEvent(event)
        self._is_entered = True

    def leave(self) -> None:
        """Hold a batch and end a live test: STOP was pressed, or nobody would see them go on."""
        if is_running(self._guided.snapshot().phase):
            self._guided.pause()
        if self.newest.trying.is_on:
            self._guided.stop_trying()

    def _in_sight(self) -> _Built:
        """The step to be seen; built when it is first wanted, so that no start waits for it."""
        built = self._built.get(self.step)
        if built is None:
            built = self._built[self.step] = self._build(self.step)
            self._stack.addWidget(built.widget)
        self._stack.setCurrentWidget(built.widget)
        return built

    def _build(self, step: Step) -> _Built:
        match step:
            case Step.PERSON:
                person = PersonStep(self._guided, self._cell.settings.person.name)
                person.finished.connect(lambda: self.go_to(Step.SENSORS))
                return _Built(person, lambda guided, _: person.show_snapshot(guided))
            case Step.SENSORS:
                sensors = SensorsStep(self._cell)
                sensors.finished.connect(lambda: self.go_to(Step.RECORD))
                return _Built(sensors, sensors.show_snapshot)
            case Step.RECORD:
                record = RecordStep(self._cell, self._guided)
                record.pace_chosen.connect(self._keep_pace)
                return _Built(record, record.show_snapshot)
            case Step.CHECK:
                check = CheckStep(self._guided)
                return _Built(check, lambda guided, _: check.show_snapshot(guided))
            case Step.TRAIN:
                train = TrainStep(self._trainer)
                return _Built(train, lambda guided, _: train.show_snapshot(guided))
            case Step.TRY:
                tried = TryStep(self._guided, self._trainer)
                return _Built(tried, lambda guided, _: tried.show_snapshot(guided))

    def _choose_pace(self, guided: GuidedSnapshot, cell: Snapshot) -> None:
        """By the beat where there is no left sensor; else as in operation."""
        pace = Pace.HANDS_FREE if cell.left.is_ok else Pace.RHYTHM
        if self._is_pace_open and guided.phase is Phase.IDLE and pace is not guided.pace:
            self._guided.set_pace(pace, guided.beat_s)

    def _keep_pace(self) -> None:
        self._is_pace_open = False


def _notice_of(guided: GuidedSnapshot) -> str:
    if guided.trouble:
        return guided.trouble
    return guided.sentence if guided.phase is Phase.SENSOR_LOST else ""
