"""What the robot will do before it does it, how far it has come, and how far it came."""

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QGridLayout, QLabel, QProgressBar, QWidget

from gestureapp.cell.snapshot import CellState, RobotView, Snapshot
from gestureapp.robot.values import Pose, PoseIncrement
from ui.labels import plain
from ui.theme import TEXT_PX, sized
from ui.words import (
    end_of,
    increment_text,
    near,
    outcome_text,
    pose_age_text,
    pose_text,
    progress,
)

_TITLES = {
    CellState.ACTIVATED: "The robot will",
    CellState.MOVING: "The robot moves",
    CellState.STOPPING: "The robot is stopping",
}
_LAST = "Last move of the robot"
_ROWS = ("Direction", "Start", "End", "Distance", "Speed", "Ends at", "Now at")
_SPARED = ("Start", "End", "Distance", "Speed")
"""Not shown where room is short."""
_UNDER_WAY = (CellState.MOVING, CellState.STOPPING)
_SETTLES_S = 1.0
"""Positions that come later than this after a move do not belong to it."""


class MotionPanel(QFrame):
    """The one increment of an activation, in figures."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("motionPanel")
        self._move: tuple[Pose | None, PoseIncrement | None] = (None, None)
        self._done = 0.0
        self._settled_s = float("-inf")
        self._title = plain("motionTitle", TEXT_PX, is_wrapped=False)
        sized(self._title, TEXT_PX, is_bold=True)
        self._captions: dict[str, QLabel] = {}
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
            layout.addWidget(caption, i + 1, 0, Qt.AlignmentFlag.AlignTop)
            layout.addWidget(value, i + 1, 1)
            self._captions[name], self._values[name] = caption, value
        self._bar = QProgressBar()
        self._bar.setObjectName("motionBar")
        self._bar.setAccessibleName("How much of the move is done")
        self._bar.setRange(0, 1000)
        self._bar.setMaximumHeight(18)
        layout.addWidget(self._bar, len(_ROWS) + 1, 0, 1, 2)
        layout.setRowStretch(len(_ROWS) + 2, 1)

    def show_snapshot(self, snapshot: Snapshot, *, is_short: bool = False) -> None:
        """Show another moment.

        Args:
            snapshot: The cell at this moment.
            is_short: Leave out what can be spared: others need the room.
        """
        robot = snapshot.robot
        self._title.setText(_TITLES.get(snapshot.state, _LAST))
        for name in _SPARED:
            self._captions[name].setVisible(not is_short)
            self._values[name].setVisible(not is_short)
        self._values["Now at"].setText(_now_text(robot))
        if robot.increment is None or robot.start is None:
            self._show_nothing()
            return
        self._follow(snapshot)
        direction, distance = increment_text(robot.increment)
        is_rotation = robot.increment.is_rotation
        end = end_of(robot.start, robot.increment)
        for name, text in (
            ("Direction", direction),
            ("Start", pose_text(robot.start, is_rotation)),
            ("End", pose_text(end, is_rotation)),
            ("Distance", distance),
            ("Speed", robot.speed),
        ):
            self._values[name].setText(text)
        self._captions["Distance"].setText("Turn" if is_rotation else "Distance")
        self._show_end(snapshot.state, robot.increment, robot.limited_by)
        self._bar.setValue(round(1000 * self._done))
        self._bar.setFormat(f"{100 * self._done:.0f} % of {distance}")

    def _follow(self, snapshot: Snapshot) -> None:
        """Keep how far this move has come; afterwards the robot may be led elsewhere."""
        robot = snapshot.robot
        if (robot.start, robot.increment) != self._move:
            self._move, self._done = (robot.start, robot.increment), 0.0
            self._settled_s = snapshot.t_s + _SETTLES_S
        if snapshot.state in _UNDER_WAY:
            self._settled_s = snapshot.t_s + _SETTLES_S
        is_its_own = snapshot.t_s <= self._settled_s
        if is_its_own and robot.pose and robot.start and robot.increment:
            self._done = progress(robot.start, robot.increment, robot.pose)

    def _show_end(self, state: CellState, increment: PoseIncrement, limited_by: str) -> None:
        """Where the move ends, or, once nothing drives it on, where it came to."""
        if state in (CellState.ACTIVATED, CellState.MOVING):
            caption, text = "Ends at", f"{increment_text(increment)[1]}: {limited_by}"
            is_whole = True
        else:
            caption, text = outcome_text(increment, self._done, limited_by)
            is_whole = caption == "Ended at"
            if state is CellState.STOPPING and not is_whole:
                caption = "Stopping"
        self._captions["Ends at"].setText(caption)
        self._values["Ends at"].setText(text)
        self._captions["End"].setText("End" if is_whole else "Planned end")

    def _show_nothing(self) -> None:
        for name in _ROWS[:-1]:
            self._captions[name].setText(name)
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
