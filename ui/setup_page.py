"""The setup's page: its steps across the top, the one in sight below."""

from collections.abc import Callable
from typing import Protocol

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QVBoxLayout, QWidget

from gestureapp.cell.controls import CellControls
from gestureapp.cell.snapshot import Snapshot
from gestureapp.sensing.values import Side
from gestureapp.setup.controls import SetupControls
from gestureapp.setup.snapshot import SetupSnapshot
from ui.pages import PageStack
from ui.setup_words import SetupStep, setup_states
from ui.step_bar import StepBar


class StepWidget(Protocol):
    """What the page asks of the widget of a step."""

    def show_snapshot(self, setup: SetupSnapshot, cell: Snapshot) -> None:
        """Show another moment."""

    def leave(self) -> None:
        """The step goes out of sight: what must not go on unseen ends."""


class SetupPage(QWidget):
    """Leads from a box of sensors to a cell that is ready. GUI thread only.

    A step's widget is built when it is first wanted, so that no start waits for it, and drawn only
    while it is in sight.

    Attributes:
        step: The one in sight.
        newest: What was shown last; None before the first moment.
        notice: What has to be said across the window: why nothing here works.
    """

    _wanted_side = Signal(Side)

    def __init__(
        self, cell: CellControls, setup: SetupControls, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.setObjectName("setupPage")
        self.step = SetupStep.SENSORS
        self.newest: SetupSnapshot | None = None
        self.notice = ""
        self._cell, self._setup = cell, setup
        self._builders = self._all_builders()
        self._bar = StepBar("setupBar", tuple(self._builders), "setupStep")
        self._built: dict[SetupStep, tuple[QWidget, StepWidget]] = {}
        self._stack = PageStack("setupSteps")
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(6)
        layout.addWidget(self._bar)
        layout.addWidget(self._stack, 1)
        self._bar.chosen.connect(self.go_to)

    def show_snapshot(self, cell: Snapshot) -> None:
        """Show another moment of the cell and of setting up."""
        setup = self.newest = self._setup.snapshot()
        states = setup_states(setup, cell)
        self._bar.show_states({step: states[step] for step in self._builders})
        self.notice = setup.trouble
        self._in_sight().show_snapshot(setup, cell)

    def go_to(self, step: SetupStep) -> None:
        """Show another step."""
        if step is not self.step:
            self._leave_step()
        self.step = step
        self._bar.show_step(step)
        self._in_sight()
        self.setFocus()  # else Space would press whatever Qt hands the focus to

    def enter(self) -> None:
        """The page comes into sight: nothing can be armed."""
        self._setup.look(True)

    def leave(self) -> None:
        """The page goes out of sight."""
        self._leave_step()
        self._setup.look(False)

    def _leave_step(self) -> None:
        if self.step in self._built:
            self._built[self.step][1].leave()

    def _in_sight(self) -> StepWidget:
        if self.step not in self._built:
            self._builders[self.step]()
        widget, step = self._built[self.step]
        self._stack.setCurrentWidget(widget)
        return step

    def _all_builders(self) -> dict[SetupStep, Callable[[], None]]:
        """How each step is made, in their order."""
        return {
            SetupStep.SENSORS: self._build_sensors,
            SetupStep.CALIBRATE: self._build_calibrate,
            SetupStep.ROBOT: self._build_robot,
            SetupStep.SETTINGS: self._build_settings,
            SetupStep.PEOPLE: self._build_people,
        }

    # A step's modules are imported with it: together they would hold the start up.

    def _build_sensors(self) -> None:
        from ui.setup_sensors_step import SetupSensorsStep

        sensors = SetupSensorsStep(self._cell, self._setup)
        sensors.calibration_wanted.connect(self._calibrate)
        self._keep(SetupStep.SENSORS, sensors, sensors)

    def _build_calibrate(self) -> None:
        from ui.setup_calibrate_step import CalibrateStep

        calibrate = CalibrateStep(self._setup)
        self._wanted_side.connect(calibrate.choose_side)
        self._keep(SetupStep.CALIBRATE, calibrate, calibrate)

    def _build_robot(self) -> None:
        from ui.robot_step import RobotStep

        robot = RobotStep(self._setup)
        self._keep(SetupStep.ROBOT, robot, robot)

    def _build_settings(self) -> None:
        from ui.settings_step import SettingsStep

        settings = SettingsStep(self._setup)
        self._keep(SetupStep.SETTINGS, settings, settings)

    def _build_people(self) -> None:
        from ui.people_step import PeopleStep

        people = PeopleStep(self._setup)
        self._keep(SetupStep.PEOPLE, people, people)

    def _calibrate(self, side: Side) -> None:
        self.go_to(SetupStep.CALIBRATE)
        self._wanted_side.emit(side)

    def _keep(self, step: SetupStep, widget: QWidget, built: StepWidget) -> None:
        self._built[step] = (widget, built)
        self._stack.addWidget(widget)
