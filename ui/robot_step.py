"""Robot: its address and answers, its field and speeds, where the operator faces, the stop test."""

from PySide6.QtCore import QRectF
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QShowEvent
from PySide6.QtWidgets import QFrame, QTabBar, QVBoxLayout, QWidget

from gestureapp.cell.snapshot import Snapshot
from gestureapp.clock import Clock, monotonic
from gestureapp.setup.controls import SetupControls
from gestureapp.setup.snapshot import SetupSnapshot
from ui.connection_panel import ConnectionPanel
from ui.draft_bar import DraftBar, LockBar
from ui.field_form import DriveForm, FieldForm
from ui.operate_page import framed
from ui.pages import PageStack
from ui.settings_draft import SettingsDraft
from ui.stop_test_panel import StopTestPanel
from ui.theme import LARGE_PX, colours_of, sized

_LINE_PX = 3
REFRESH_S = 1.0
"""Settings are asked for again after this time: a file or another step may have changed them."""


class PartsBar(QTabBar):
    """Tabs with the line of what is selected under the one that is, in any scheme."""

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the line over the tabs."""
        super().paintEvent(event)
        painter = QPainter(self)
        below = QRectF(self.tabRect(self.currentIndex())).adjusted(1, 0, -1, 0)
        below.setTop(below.bottom() - _LINE_PX)
        painter.fillRect(below, QColor(colours_of(self.palette()).info))
        painter.end()


class RobotStep(QWidget):
    """Four parts behind tabs, and below them what is not applied yet. GUI thread only.

    Args:
        controls: Asked for settings and tests.
        clock: Monotonic seconds, for the button that is held.
    """

    def __init__(
        self, controls: SetupControls, clock: Clock = monotonic, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.setObjectName("robotStep")
        self._next_s = 0.0
        self._draft = SettingsDraft(controls, self)
        self._connection = ConnectionPanel(controls)
        self._field = FieldForm(self._draft)
        self._drive = DriveForm(self._draft)
        self._stop_test = StopTestPanel(controls, clock)
        self._lock = LockBar(controls, "robotLock")
        self._bar = DraftBar(self._draft, "robotDraft")
        self._forms: tuple[QWidget, ...] = (self._field, self._drive)
        self._tabs = PartsBar()
        self._parts = PageStack("robotParts")
        self._lay_out()

    def show_snapshot(self, setup: SetupSnapshot, cell: Snapshot) -> None:
        """Show another moment of setting up and of the cell."""
        if not self._draft.rows or setup.t_s >= self._next_s:
            self.refresh()
            self._next_s = setup.t_s + REFRESH_S
        self._lock.show_lock(setup.lock)
        self._bar.setVisible(bool(self._draft.names) or self._parts.currentWidget() in self._forms)
        self._connection.show_card(setup.robot)
        self._stop_test.show_snapshot(setup)
        if self._parts.currentWidget() is self._field:
            self._field.show_robot(cell.robot)

    def leave(self) -> None:
        """The step goes out of sight, and with it the button that is held; what was typed stays."""

    def refresh(self) -> None:
        """Ask for the settings anew."""
        self._draft.refresh()
        self._connection.show_rows(self._draft.rows)

    def showEvent(self, event: QShowEvent) -> None:
        """Another step may have changed the settings."""
        super().showEvent(event)
        self._next_s = 0.0

    def _lay_out(self) -> None:
        self._tabs.setObjectName("robotTabs")
        self._tabs.setAccessibleName("Parts of the robot's setup")
        self._tabs.setDrawBase(False)
        self._tabs.setExpanding(False)
        sized(self._tabs, LARGE_PX)
        for widget, title in (
            (self._connection, "Connection"),
            (self._field, "Field and speeds"),
            (self._drive, "Operator, tool, drive"),
            (self._stop_test, "Stop test"),
        ):
            self._tabs.addTab(title)
            self._parts.addWidget(widget)
        self._tabs.currentChanged.connect(self._parts.setCurrentIndex)
        ground = QFrame()
        room = QVBoxLayout(ground)
        room.setContentsMargins(0, 0, 0, 0)
        room.addWidget(self._parts)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(4)
        layout.addWidget(self._tabs)
        frames: tuple[QFrame, ...] = (ground, self._lock, self._bar)
        for frame in frames:
            framed(frame)
            layout.addWidget(frame, int(frame is ground))
