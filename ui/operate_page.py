"""The page an operator works on: state, what stands against arming, the gesture, the move."""

from PySide6.QtGui import QPalette
from PySide6.QtWidgets import QFrame, QGridLayout, QHBoxLayout, QVBoxLayout, QWidget

from gestureapp.cell.controls import CellControls
from gestureapp.cell.snapshot import CellState, Snapshot
from gestureapp.clock import Clock, monotonic
from gestureapp.guided.controls import GuidedControls
from ui.arm_plot import ArmPlot
from ui.blocker_list import BlockerList
from ui.event_list import EventList
from ui.gesture_panel import GesturePanel
from ui.motion_panel import MotionPanel
from ui.robot_view import FieldView
from ui.state_panel import StatePanel

_STATE_SHARE = 8
_BEFORE_A_MOVE = (CellState.NOT_READY, CellState.READY, CellState.STOPPED)


class OperatePage(QWidget):
    """Shows snapshots of the cell and passes the operator's wishes on. GUI thread only.

    Args:
        cell: Polled and asked.
        clock: Monotonic seconds.
        guided: Keeps what was heard as a take; without it there is no button for that.
        parent: Qt's.
    """

    def __init__(
        self,
        cell: CellControls,
        clock: Clock = monotonic,
        guided: GuidedControls | None = None,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.setObjectName("operatePage")
        self._cell = cell
        self._state = StatePanel(clock)
        self._blockers = BlockerList()
        self._motion = MotionPanel()
        self._events = EventList()
        self._guided = guided
        self._gesture = GesturePanel(guided)
        self._field = FieldView(cell.settings.robot)
        self._left_plot = ArmPlot("leftPlot", "Left arm")
        self._right_plot = ArmPlot("rightPlot", "Right arm")
        self._lay_out()
        self._state.arm_wanted.connect(cell.arm)
        self._state.disarm_wanted.connect(cell.disarm)
        self._state.servo_on_wanted.connect(cell.servo_on)
        self._state.servo_off_wanted.connect(cell.servo_off)

    def fit(self, window_height: int) -> None:
        """Keep the state's share of the window's height, in pixels."""
        self._state.setMinimumHeight(window_height // _STATE_SHARE)

    def show_snapshot(self, snapshot: Snapshot) -> None:
        """Show another moment."""
        self._state.show_snapshot(snapshot)
        self._blockers.show_blockers(snapshot.blockers)
        is_before = snapshot.state in _BEFORE_A_MOVE
        self._blockers.setVisible(is_before)
        has_blockers = is_before and bool(snapshot.blockers)
        self._motion.setVisible(not has_blockers or snapshot.robot.increment is not None)
        self._motion.show_snapshot(snapshot, is_short=has_blockers)
        self._events.show_events(snapshot.events)
        recognition = snapshot.recognition
        self._gesture.show_recognition(recognition, snapshot.direction)
        if self._guided is not None:
            self._gesture.show_heard(self._guided.snapshot().heard)
        self._field.show_settings(self._cell.settings.robot)
        self._field.show_robot(snapshot.robot)
        used = None
        if recognition is not None and recognition.outputs:  # else no sample was used
            used = (recognition.window_start_s, recognition.window_end_s)
        now_s = snapshot.t_s
        self._right_plot.mark_window(used, now_s)
        self._left_plot.show_samples(self._cell.left, now_s, snapshot.left.is_alive)
        self._right_plot.show_samples(self._cell.right, now_s, snapshot.right.is_alive)

    def _lay_out(self) -> None:
        panels: list[QFrame] = [
            self._state,
            self._blockers,
            self._motion,
            self._events,
            self._gesture,
            self._field,
            self._left_plot,
            self._right_plot,
        ]
        for panel in panels:
            framed(panel)
        told = QVBoxLayout()
        told.addWidget(self._blockers, 3)
        told.addWidget(self._motion, 2)
        told.addWidget(self._events)
        right = QGridLayout()
        right.addWidget(self._gesture, 0, 0, 1, 2)
        right.addWidget(self._field, 0, 2, 1, 3)
        plots = QHBoxLayout()
        plots.addWidget(self._left_plot)
        plots.addWidget(self._right_plot)
        right.addLayout(plots, 1, 0, 1, 5)
        right.setRowStretch(0, 9)
        right.setRowStretch(1, 7)
        for column in range(5):
            right.setColumnStretch(column, 1)
        middle = QHBoxLayout()
        middle.addLayout(told, 4)
        middle.addLayout(right, 9)
        work = QVBoxLayout(self)
        work.setContentsMargins(0, 0, 0, 0)
        work.addWidget(self._state)
        work.addLayout(middle, 1)
        for layout in (told, right, plots, middle, work):
            layout.setSpacing(6)


def framed(panel: QFrame) -> None:
    """Give a panel its frame and its ground."""
    panel.setFrameShape(QFrame.Shape.StyledPanel)
    panel.setBackgroundRole(QPalette.ColorRole.AlternateBase)
    panel.setAutoFillBackground(True)
