"""What the robot will do before it does it, and how far it has come while it does."""

from PySide6.QtWidgets import QFrame, QGridLayout, QLabel, QProgressBar, QWidget

from gestureapp.cell.snapshot import CellState, RobotView, Snapshot
from ui.labels import plain
from ui.theme import TEXT_PX, sized
from ui.words import end_of, increment_text, near, pose_age_text, pose_text, progress

_TITLES = {
    CellState.ACTIVATED: "The robot will",
    CellState.MOVING: "The robot moves",
    CellState.STOPPING: "The robot is stopping",
}
_LAST = "Last move of the robot"
_ROWS = ("Direction", "Start", "End", "Distance", "Speed", "Ends at", "Now at")


class MotionPanel(QFrame):
    """The one increment of an activation, in figures."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("motionPanel")
        self._title = plain("motionTitle", TEXT_PX, is_wrapped=False)
        sized(self._title, TEXT_PX, is_bold=True)
        self._values: dict[str, QLabel] = {}
        layout = QGridLayout(self)
        layout.setContentsMargins(10, 6, 10, 6)
        layout.setVerticalSpacing(2)
        layout.setHorizontalSpacing(10)
        layout.setColumnStretch(1, 1)
        layout.addWidget(self._title, 0, 0, 1, 2)
        for i, name in enumerate(_ROWS):
            caption = plain(f"motion{name.replace(' ', '')}Caption", TEXT_PX, is_wrapped=False)
            caption.setText(name)
            value = plain(f"motion{name.replace(' ', '')}", TEXT_PX)
            layout.addWidget(caption, i + 1, 0)
            layout.addWidget(value, i + 1, 1)
            self._values[name] = value
        self._bar = QProgressBar()
        self._bar.setObjectName("motionBar")
        self._bar.setAccessibleName("How much of the move is done")
        self._bar.setRange(0, 1000)
        self._bar.setMaximumHeight(18)
        layout.addWidget(self._bar, len(_ROWS) + 1, 0, 1, 2)
        layout.setRowStretch(len(_ROWS) + 2, 1)

    def show_snapshot(self, snapshot: Snapshot) -> None:
        """Show another moment."""
        robot = snapshot.robot
        self._title.setText(_TITLES.get(snapshot.state, _LAST))
        self._values["Now at"].setText(_now_text(robot))
        if robot.increment is None or robot.start is None:
            self._show_nothing()
            return
        direction, distance = increment_text(robot.increment)
        is_rotation = robot.increment.is_rotation
        end = end_of(robot.start, robot.increment)
        for name, text in (
            ("Direction", direction),
            ("Start", pose_text(robot.start, is_rotation)),
            ("End", pose_text(end, is_rotation)),
            ("Distance", distance),
            ("Speed", robot.speed),
            ("Ends at", f"{distance}: {robot.limited_by}"),
        ):
            self._values[name].setText(text)
        if robot.pose is not None:
            done = progress(robot.start, robot.increment, robot.pose)
            self._bar.setValue(round(1000 * done))
            self._bar.setFormat(f"{100 * done:.0f} % of {distance}")

    def _show_nothing(self) -> None:
        for name in _ROWS[:-1]:
            self._values[name].setText("-")
        self._bar.setValue(0)
        self._bar.setFormat("no move yet")


def _now_text(robot: RobotView) -> str:
    old = pose_age_text(robot)
    if robot.pose is None:
        return old
    is_rotation = robot.increment is not None and robot.increment.is_rotation
    pose = near(robot.pose, robot.start) if is_rotation and robot.start else robot.pose
    return pose_text(pose, is_rotation) + (f" ({old})" if old else "")
