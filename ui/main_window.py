"""The window: the cell on one screen, polled from one timer."""

import logging
from functools import partial

from PySide6.QtCore import QSize, Qt, QTimer
from PySide6.QtGui import QCloseEvent, QPalette, QResizeEvent
from PySide6.QtWidgets import (
    QApplication,
    QFrame,
    QGridLayout,
    QHBoxLayout,
    QLayout,
    QMainWindow,
    QScrollArea,
    QVBoxLayout,
    QWidget,
)

from gestureapp.cell.controls import CellControls
from gestureapp.cell.last_time import LastTime
from gestureapp.cell.snapshot import CellState, Snapshot
from gestureapp.clock import Clock, monotonic
from ui.alarm_bars import AlarmBars
from ui.arm_plot import ArmPlot
from ui.blocker_list import BlockerList
from ui.event_list import EventList
from ui.gesture_panel import GesturePanel
from ui.last_time_bar import LastTimeBar
from ui.motion_panel import MotionPanel
from ui.notice_row import NoticeRow
from ui.robot_view import FieldView
from ui.state_panel import StatePanel
from ui.status_strip import StatusStrip
from ui.stop_slab import StopKeys, StopSlab
from ui.virtual_operator import VirtualOperator, VirtualOperatorPanel

log = logging.getLogger(__name__)

FRAME_MS = 30
"""33 frames a second."""
STOP_SHARE = 6
"""The slab takes at least this part, one sixth, of the window's width."""
_STATE_SHARE = 8
_LEAST = (900, 500)
"""Everything is in sight from 1280 by 720 on; below that the middle scrolls, never STOP."""
_BEFORE_A_MOVE = (CellState.NOT_READY, CellState.READY, CellState.STOPPED)


class MainWindow(QMainWindow):
    """Shows snapshots of the cell, passes the operator's wishes on, decides nothing about motion.

    Closing it stops the robot, takes the permission back and shuts the cell down, in this order,
    without asking: a question in the way of a stop would be one step too many.

    Owned by ``run_window``; GUI thread only.

    Attributes:
        n_failed: Polls in a row that gave no picture.
    """

    def __init__(
        self,
        cell: CellControls,
        virtual: VirtualOperator | None = None,
        clock: Clock = monotonic,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.setObjectName("mainWindow")
        self.setWindowTitle("Gesture control of the robot cell")
        self.n_failed = 0
        self._cell = cell
        self._strip = StatusStrip()
        self._bars = AlarmBars(clock)
        self._last_time = LastTimeBar()
        self._state = StatePanel(clock)
        self._blockers = BlockerList()
        self._motion = MotionPanel()
        self._events = EventList()
        self._gesture = GesturePanel()
        self._field = FieldView(cell.settings.robot)
        self._left_plot = ArmPlot("leftPlot", "Left arm")
        self._right_plot = ArmPlot("rightPlot", "Right arm")
        self._slab = StopSlab()
        self._virtual = VirtualOperatorPanel(virtual) if virtual is not None else None
        self._lay_out()
        self._connect()
        self._timer = QTimer(self, interval=FRAME_MS)
        self._timer.setTimerType(Qt.TimerType.PreciseTimer)
        self._timer.timeout.connect(self.poll)
        self._timer.start()

    def poll(self) -> None:
        """Show the newest snapshot and tell the cell that the window lives.

        A window that cannot show the cell does not report itself alive, so that the robot is
        stopped when this lasts; STOP goes on working.
        """
        try:
            self._show(self._cell.snapshot())
            if self._virtual is not None:
                self._virtual.refresh()
        except Exception as error:  # the top of the poll: the window and its STOP must outlive it
            self.n_failed += 1
            if self.n_failed == 1:
                log.exception("the cell cannot be shown")
            self._bars.show_blind(f"The window cannot show the cell, what you see is old: {error}")
            return
        if self.n_failed:
            log.warning("the cell can be shown again, after %d failed polls", self.n_failed)
            self.n_failed = 0
            self._bars.show_blind("")
        self._cell.gui_tick()

    def stop(self) -> None:
        """STOP was pressed, by mouse or key."""
        self._cell.stop()

    def tell_last_time(self, last_time: LastTime) -> None:
        """Show what the guardian did when no window could, until it is put away."""
        self._last_time.tell(last_time.text, last_time.details, last_time.note_shown)

    def closeEvent(self, event: QCloseEvent) -> None:
        """Stop, disarm, shut down; then close, whatever came of it."""
        self._timer.stop()
        stop = partial(self._cell.stop, "the window was closed")
        for step in (stop, self._cell.disarm, self._cell.shutdown):
            try:
                step()
            except Exception:  # the last thing that runs: each step gets its turn
                log.exception("while closing the window")
        self._remove_keys()
        event.accept()

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Keep the slab's share of the width, and the state's of the height."""
        super().resizeEvent(event)
        self._state.setMinimumHeight(self.height() // _STATE_SHARE)
        self._slab.setFixedWidth(-(-self.width() // STOP_SHARE))

    def _show(self, snapshot: Snapshot) -> None:
        self._bars.show_unconfirmed(snapshot.is_stop_unconfirmed)
        self._state.show_snapshot(snapshot)
        self._strip.show_snapshot(snapshot)
        self._blockers.show_blockers(snapshot.blockers)
        is_before = snapshot.state in _BEFORE_A_MOVE
        self._blockers.setVisible(is_before)
        has_blockers = is_before and bool(snapshot.blockers)
        self._motion.setVisible(not has_blockers or snapshot.robot.increment is not None)
        self._motion.show_snapshot(snapshot, is_short=has_blockers)
        self._events.show_events(snapshot.events)
        recognition = snapshot.recognition
        self._gesture.show_recognition(recognition, snapshot.direction)
        self._field.show_robot(snapshot.robot)
        used = None
        if recognition is not None:
            used = (recognition.window_start_s, recognition.window_end_s)
        now_s = snapshot.t_s
        self._right_plot.mark_window(used, now_s)
        self._left_plot.show_samples(self._cell.left, now_s, snapshot.left.is_alive)
        self._right_plot.show_samples(self._cell.right, now_s, snapshot.right.is_alive)

    def _connect(self) -> None:
        self._slab.button.pressed.connect(self.stop)
        self._state.arm_wanted.connect(self._cell.arm)
        self._state.disarm_wanted.connect(self._cell.disarm)
        self._state.servo_on_wanted.connect(self._cell.servo_on)
        self._state.servo_off_wanted.connect(self._cell.servo_off)
        self._keys = StopKeys(self.stop, self)
        app = QApplication.instance()
        if app is not None:
            app.installEventFilter(self._keys)

    def _remove_keys(self) -> None:
        app = QApplication.instance()
        if app is not None:
            app.removeEventFilter(self._keys)

    def _lay_out(self) -> None:
        for panel in self._panels():
            panel.setFrameShape(QFrame.Shape.StyledPanel)
            panel.setBackgroundRole(QPalette.ColorRole.AlternateBase)
            panel.setAutoFillBackground(True)
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
        work = QVBoxLayout()
        work.setContentsMargins(0, 0, 0, 0)
        work.addWidget(self._state)
        work.addLayout(middle, 1)
        if self._virtual is not None:
            work.addWidget(self._virtual)
        body = QHBoxLayout()
        body.setContentsMargins(6, 0, 6, 6)
        body.addWidget(_scrolling(work), 1)
        body.addWidget(self._slab)
        for layout in (told, right, plots, middle, work, body):
            layout.setSpacing(6)
        whole = QWidget()
        column_of_all = QVBoxLayout(whole)
        column_of_all.setContentsMargins(0, 0, 0, 0)
        column_of_all.setSpacing(6)
        column_of_all.addWidget(self._strip)
        column_of_all.addWidget(NoticeRow(self._last_time, self._bars))
        column_of_all.addLayout(body, 1)
        self.setCentralWidget(whole)
        self.setMinimumSize(QSize(*_LEAST).boundedTo(self.screen().availableSize()))

    def _panels(self) -> list[QFrame]:
        panels: list[QFrame] = [
            self._strip,
            self._state,
            self._blockers,
            self._motion,
            self._events,
            self._gesture,
            self._field,
            self._left_plot,
            self._right_plot,
        ]
        return panels + ([self._virtual] if self._virtual is not None else [])


class _Compressible(QWidget):
    """Asks for its least height only.

    Texts that wrap would otherwise make a scroll area ask for the height they like best, and scroll
    long before anything is out of room.
    """

    def hasHeightForWidth(self) -> bool:  # noqa: N802, Qt's spelling
        """No: the height is what there is."""
        return False


def _scrolling(layout: QLayout) -> QScrollArea:
    """Room that scrolls when the screen is too small, so that what stands beside it stays."""
    content = QWidget()
    inner = _Compressible()
    inner.setLayout(layout)
    outer = QVBoxLayout(content)
    outer.setContentsMargins(0, 0, 0, 0)
    outer.addWidget(inner)
    area = QScrollArea()
    area.setObjectName("workArea")
    area.setAccessibleName("The cell")
    area.setFrameShape(QFrame.Shape.NoFrame)
    area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
    area.setWidgetResizable(True)
    area.setWidget(content)
    return area
