"""Calibrate: six positions of each sensor, the level check, and the stop and start posture."""

from collections.abc import Callable

from PySide6.QtWidgets import QButtonGroup, QHBoxLayout, QVBoxLayout, QWidget

from gestureapp.cell.snapshot import Snapshot
from gestureapp.sensing.values import Side
from gestureapp.setup.controls import SetupControls
from gestureapp.setup.snapshot import SetupSnapshot
from ui.pages import PageStack
from ui.postures_panel import PosturesPanel
from ui.setup_parts import enable
from ui.setup_words import posture_level, posture_problem, postures_kept, sensor_task
from ui.six_positions_panel import SixPositionsPanel
from ui.task_button import TaskButton

_TASKS_PX = 236


class CalibrateStep(QWidget):
    """One sensor, or the postures, at a time. GUI thread only."""

    def __init__(self, setup: SetupControls, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("setupCalibrateStep")
        self._setup = setup
        self._snapshot = setup.snapshot()
        self._sides = {
            side: TaskButton(f"calibrate_{side.value}", f"{side.value.capitalize()} arm's sensor")
            for side in Side
        }
        self._postures_button = TaskButton("calibratePostures", "Postures")
        self._six = SixPositionsPanel(setup)
        self._postures = PosturesPanel(setup)
        self._stack = PageStack("calibratePanels")
        self._stack.addWidget(self._six)
        self._stack.addWidget(self._postures)
        self._lay_out()
        self.choose_side(Side.LEFT)

    def show_snapshot(self, setup: SetupSnapshot, cell: Snapshot) -> None:
        """Show another moment."""
        self._snapshot = setup
        self._follow(setup)
        for card in (setup.left, setup.right):
            self._sides[card.side].show_title(f"{card.worn.capitalize()} arm's sensor")
            self._sides[card.side].show_state(*sensor_task(card, setup.calibration))
        postures = setup.postures
        self._postures_button.show_state(
            posture_level(postures), posture_problem(postures) or postures_kept(postures)
        )
        if self._stack.currentWidget() is self._six:
            self._six.show_snapshot(setup)
        else:
            self._postures.show_view(postures, setup.left.health.is_alive)

    def choose_side(self, side: Side) -> None:
        """Show this arm's sensor."""
        self._six.side = side
        self._sides[side].setChecked(True)
        self._stack.setCurrentWidget(self._six)

    def choose_postures(self) -> None:
        """Show the person's postures."""
        self._postures_button.setChecked(True)
        self._stack.setCurrentWidget(self._postures)

    def leave(self) -> None:
        """The step goes out of sight: nobody would see what is asked for."""
        if self._snapshot.calibration.is_on:
            self._setup.end_calibration()
        if self._snapshot.postures.is_on:
            self._setup.end_postures()

    def _follow(self, setup: SetupSnapshot) -> None:
        """What is under way stays in sight until it ends."""
        calibrated = setup.calibration.side if setup.calibration.is_on else None
        if calibrated is not None:
            self.choose_side(calibrated)
        elif setup.postures.is_on:
            self.choose_postures()
        is_free = calibrated is None and not setup.postures.is_on
        for button in (*self._sides.values(), self._postures_button):
            enable(button, is_free or button.isChecked())

    def _lay_out(self) -> None:
        group = QButtonGroup(self)
        tasks = QVBoxLayout()
        tasks.setSpacing(6)
        for side, button in self._sides.items():
            button.clicked.connect(self._chooser(side))
        self._postures_button.clicked.connect(self.choose_postures)
        for button in (*self._sides.values(), self._postures_button):
            group.addButton(button)
            button.setFixedWidth(_TASKS_PX)
            tasks.addWidget(button)
        tasks.addStretch(1)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(6)
        layout.addLayout(tasks)
        layout.addWidget(self._stack, 1)

    def _chooser(self, side: Side) -> Callable[[], None]:
        return lambda: self.choose_side(side)
