"""The window: the cell on one screen, polled from one timer."""

import logging
from functools import partial

from PySide6.QtCore import QSize, Qt, QTimer
from PySide6.QtGui import QCloseEvent, QResizeEvent
from PySide6.QtWidgets import QApplication, QHBoxLayout, QMainWindow, QVBoxLayout, QWidget

from gestureapp.cell.controls import TRAINING_OPEN, CellControls
from gestureapp.cell.last_time import LastTime
from gestureapp.cell.snapshot import CellState, Snapshot
from gestureapp.clock import Clock, monotonic
from gestureapp.guided.controls import GuidedControls, TrainerControls
from gestureapp.setup.controls import SetupControls
from ui.alarm_bars import AlarmBars
from ui.last_time_bar import LastTimeBar
from ui.nav_rail import NavRail, Place
from ui.notice_bar import NoticeBar
from ui.notice_row import NoticeRow
from ui.operate_page import OperatePage, framed
from ui.pages import PageStack, scrolling
from ui.setup_page import SetupPage
from ui.status_strip import StatusStrip
from ui.step_state import place_barrier
from ui.stop_slab import StopKeys, StopSlab
from ui.train_page import TrainPage
from ui.virtual_operator import VirtualOperator, VirtualOperatorPanel

log = logging.getLogger(__name__)

FRAME_MS = 30
"""33 frames a second."""
STOP_SHARE = 6
"""The slab takes at least this part, one sixth, of the window's width."""
_LEAST = (900, 500)
"""Everything is in sight from 1280 by 720 on; below that the middle scrolls, never STOP."""


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
        guided: GuidedControls | None = None,
        trainer: TrainerControls | None = None,
        setup: SetupControls | None = None,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.setObjectName("mainWindow")
        self.setWindowTitle("Gesture control of the robot cell")
        self.n_failed = 0
        self._place = Place.OPERATE
        self._cell = cell
        self._strip = StatusStrip()
        self._bars = AlarmBars(clock)
        self._last_time = LastTimeBar()
        self._operate = OperatePage(cell, clock, guided)
        self._train = None
        if guided is not None and trainer is not None:
            self._train = TrainPage(cell, guided, trainer)
        self._setup = SetupPage(cell, setup) if setup is not None else None
        self._notice = NoticeBar("pageNotice")
        self._stopped = NoticeBar("stoppedNotice")
        self._pages = PageStack("pages")
        pages = (self._operate, self._train, self._setup)
        self._places = {place: page for place, page in zip(Place, pages, strict=True) if page}
        self._rail = NavRail(tuple(self._places))
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
                train = self._train if self._place is Place.TRAIN else None
                setup = self._setup if self._place is Place.SETUP else None
                self._virtual.refresh(
                    None if train is None else train.newest,
                    None if setup is None else setup.newest,
                )
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

    def go_to(self, place: Place) -> None:
        """Open another page. While the training or the setup is in sight nothing can be armed.

        Their entries on the rail are closed while the robot is not at rest.
        """
        if place not in self._places or place is self._place:
            return
        left, self._place = self._place, place
        self._leave(left)
        if place is Place.TRAIN:
            self._cell.hold_arming(TRAINING_OPEN)
        elif place is Place.SETUP and self._setup is not None:
            self._setup.enter()
        self._rail.show_place(place)
        page = self._places[place]
        self._pages.setCurrentWidget(page)
        page.setFocus()  # else Space would press whatever Qt hands the focus to
        self.poll()

    def stop(self) -> None:
        """STOP was pressed, by mouse or key. Recording and trying end once the stop is out."""
        self._cell.stop()
        if self._train is not None:
            self._train.leave()

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
        self._operate.fit(self.height())
        self._slab.setFixedWidth(-(-self.width() // STOP_SHARE))

    def _show(self, snapshot: Snapshot) -> None:
        self._bars.show_unconfirmed(snapshot.is_stop_unconfirmed)
        self._strip.show_snapshot(snapshot)
        for place in (Place.TRAIN, Place.SETUP):
            self._rail.show_note(place, place_barrier(snapshot))
        if self._place is Place.TRAIN and self._train is not None:
            self._train.show_snapshot(snapshot)
            self._notice.show_text(self._train.notice)
        elif self._place is Place.SETUP and self._setup is not None:
            self._setup.show_snapshot(snapshot)
            self._notice.show_text(self._setup.notice)
        else:
            self._operate.show_snapshot(snapshot)
            return
        is_stopped = snapshot.state is CellState.STOPPED
        self._stopped.show_text(snapshot.sentence if is_stopped else "")

    def _leave(self, place: Place) -> None:
        """What was under way on a page ends with it, and so does its hold on arming."""
        if place is Place.TRAIN and self._train is not None:
            self._train.leave()
            self._cell.hold_arming("")
        elif place is Place.SETUP and self._setup is not None:
            self._setup.leave()
        self._notice.show_text("")
        self._stopped.show_text("")

    def _connect(self) -> None:
        self._slab.button.pressed.connect(self.stop)
        self._rail.chosen.connect(self.go_to)
        self._keys = StopKeys(self.stop, self._slab.button, self)
        app = QApplication.instance()
        if app is not None:
            app.installEventFilter(self._keys)

    def _remove_keys(self) -> None:
        app = QApplication.instance()
        if app is not None:
            app.removeEventFilter(self._keys)

    def _lay_out(self) -> None:
        framed(self._strip)
        framed(self._rail)
        for page in self._places.values():
            self._pages.addWidget(page)
        middle = QHBoxLayout()
        middle.addWidget(self._rail)
        middle.addWidget(self._pages, 1)
        work = QVBoxLayout()
        work.setContentsMargins(0, 0, 0, 0)
        work.addLayout(middle, 1)
        if self._virtual is not None:
            framed(self._virtual)
            work.addWidget(self._virtual)
        body = QHBoxLayout()
        body.setContentsMargins(6, 0, 6, 6)
        body.addWidget(scrolling(work), 1)
        body.addWidget(self._slab)
        whole = QWidget()
        column_of_all = QVBoxLayout(whole)
        column_of_all.setContentsMargins(0, 0, 0, 0)
        column_of_all.addWidget(self._strip)
        column_of_all.addWidget(NoticeRow(self._stopped, self._notice, self._last_time, self._bars))
        column_of_all.addLayout(body, 1)
        for layout in (middle, work, body, column_of_all):
            layout.setSpacing(6)
        self.setCentralWidget(whole)
        self.setMinimumSize(QSize(*_LEAST).boundedTo(self.screen().availableSize()))
