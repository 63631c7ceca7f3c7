"""The robot's address, and what its controller says before anything may move."""

from datetime import datetime

from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from gestureapp.setup.controls import SetupControls
from gestureapp.setup.site_values import RobotCard, RobotRow, SettingRow
from gestureapp.setup.values import Check, Outcome
from ui.background import Background
from ui.draft_bar import heading
from ui.labels import plain
from ui.marks import Level, Mark
from ui.pages import scrolled
from ui.setting_values import why_not_text
from ui.theme import LARGE_PX, TEXT_PX, sized

WHAT_IT_DOES = "Connecting only reads: nothing moves before somebody arms."
_HOST, _PORT = "robot.host", "robot.port"
_LEVELS = {
    Check.NOT_RUN: Level.OFF,
    Check.RUNNING: Level.BUSY,
    Check.PASSED: Level.OK,
    Check.FAILED: Level.ATTENTION,
}


class ConnectionPanel(QWidget):
    """Host and port, and the rows of the read-only connection test. GUI thread only."""

    def __init__(self, controls: SetupControls, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("connectionPanel")
        self._controls = controls
        self._background = Background("robot's address", self)
        self._background.on_error(self._tell)
        self._shown: tuple[str, str] | None = None
        self._host = _line("robotHost", "Address of the controller", 200)
        self._port = _line("robotPort", "TCP port of the controller", 80)
        self._connect = QPushButton("Connect, reading only")
        self._connect.setObjectName("connectRobot")
        self._connect.setAccessibleName("Connect to the controller, reading only")
        self._trouble = plain("robotTrouble", TEXT_PX)
        self._why_not = plain("robotLocked", TEXT_PX)
        self._allowed = plain("robotPortAllowed", TEXT_PX, is_wrapped=False)
        self._text = plain("robotText", LARGE_PX)
        self._rows: list[_Row] = []
        self._grid = QGridLayout()
        self._lay_out()
        for field in (self._host, self._port):
            field.returnPressed.connect(self._connect_now)
        self._connect.clicked.connect(self._connect_now)

    def show_rows(self, rows: dict[str, SettingRow]) -> None:
        """Take address and port from the settings; what is being typed stays."""
        host, port = rows.get(_HOST), rows.get(_PORT)
        if host is None or port is None:
            return
        used = (str(host.value), str(port.value))
        if used != self._shown:
            self._shown = used
            self._host.setText(used[0])
            self._port.setText(used[1])
        self._allowed.setText(f"Allowed: {port.allowed}" if port.allowed else "")
        for widget in (self._host, self._port, self._connect):
            widget.setEnabled(not why_not_text(host))
        why_not = why_not_text(host)
        self._why_not.setText(why_not)
        self._why_not.setVisible(bool(why_not))

    def show_card(self, card: RobotCard) -> None:
        """Show another moment of the robot."""
        _say(self._text, card.text or "No controller has been asked yet.")
        for spare in self._rows[len(card.rows) :]:
            spare.setVisible(False)
        while len(self._rows) < len(card.rows):
            self._rows.append(_Row(self._grid, len(self._rows)))
        for shown, row in zip(self._rows, card.rows, strict=False):
            shown.show_row(row)

    def _connect_now(self) -> None:
        port = self._port.text().strip()
        if not port.isdecimal():
            self._tell(f"{port!r} is no port; enter a whole number")
            return
        host, choose = self._host.text().strip(), self._controls.choose_robot
        self._background.run(lambda: choose(host, int(port)), self._tell)

    def _tell(self, text: str) -> None:
        self._trouble.setText(text)
        self._trouble.setVisible(bool(text))

    def _lay_out(self) -> None:
        entry = QHBoxLayout()
        entry.setSpacing(8)
        for text, field in (("Address", self._host), ("Port", self._port)):
            label = QLabel(text)
            label.setBuddy(field)
            entry.addWidget(label)
            entry.addWidget(field)
        entry.addWidget(self._allowed)
        entry.addSpacing(8)
        entry.addWidget(self._connect)
        entry.addStretch(1)
        self._connect.setAutoDefault(False)
        self._connect.setMinimumHeight(36)
        sized(self._connect, LARGE_PX, is_bold=True)
        self._trouble.hide()
        sized(self._trouble, TEXT_PX, is_bold=True)
        what = plain("connectingWords", TEXT_PX)
        what.setText(WHAT_IT_DOES)
        self._grid.setColumnStretch(3, 1)
        self._grid.setHorizontalSpacing(12)
        self._grid.setVerticalSpacing(8)
        inner = QVBoxLayout()
        inner.addLayout(self._grid)
        inner.addStretch(1)
        area = scrolled(inner, "connectionRows", "What the controller said")
        layout = QVBoxLayout(self)
        layout.setContentsMargins(14, 10, 14, 10)
        layout.setSpacing(8)
        layout.addLayout(entry)
        layout.addWidget(self._trouble)
        layout.addWidget(self._why_not)
        layout.addWidget(what)
        layout.addSpacing(4)
        layout.addWidget(heading("connectionTitle", "What the controller says"))
        layout.addWidget(self._text)
        layout.addWidget(area, 1)


class _Row:
    """Mark, name, word and what was said, in one row of a grid."""

    def __init__(self, grid: QGridLayout, number: int) -> None:
        self._mark = Mark(16)
        self._name = plain(f"robotRow{number}Name", TEXT_PX, is_wrapped=False)
        self._word = plain(f"robotRow{number}Word", TEXT_PX, is_wrapped=False)
        self._text = plain(f"robotRow{number}Text", TEXT_PX)
        sized(self._name, TEXT_PX, is_bold=True)
        for column, widget in enumerate((self._mark, self._name, self._word, self._text)):
            grid.addWidget(widget, number, column, Qt.AlignmentFlag.AlignTop)

    def show_row(self, row: RobotRow) -> None:
        """Show what was asked and what came of it."""
        self.setVisible(True)
        self._mark.show_level(_LEVELS[row.outcome.check])
        _say(self._name, f"{row.name[:1].upper()}{row.name[1:]}")
        is_failed = row.outcome.check is Check.FAILED
        _say(self._word, "failed because" if is_failed else row.outcome.check.value)
        _say(self._text, row.outcome.text)

    def setVisible(self, is_visible: bool) -> None:  # noqa: N802, as a widget's
        """Show or hide all of it."""
        for widget in (self._mark, self._name, self._word, self._text):
            widget.setVisible(is_visible)


def date_text(outcome: Outcome) -> str:
    """When a test ended, in local time; empty before that."""
    if not outcome.wall_s:
        return ""
    return datetime.fromtimestamp(outcome.wall_s).astimezone().strftime("%Y-%m-%d %H:%M")


def _line(name: str, what: str, width_px: int) -> QLineEdit:
    field = QLineEdit()
    field.setObjectName(name)
    field.setAccessibleName(what)
    field.setFixedWidth(width_px)
    field.setMinimumHeight(32)
    return field


def _say(label: QLabel, text: str) -> None:
    if label.text() != text:
        label.setText(text)
