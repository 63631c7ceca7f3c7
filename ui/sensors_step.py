"""Sensors: both arms' state with its remedy, live, before anything is recorded."""

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QPushButton, QVBoxLayout, QWidget

from gestureapp.cell.controls import CellControls
from gestureapp.cell.snapshot import Snapshot
from gestureapp.guided.values import GuidedSnapshot
from gestureapp.sensing.store import SampleStore
from gestureapp.sensing.values import ArmPosture, LinkState, Side, StreamHealth
from ui.arm_plot import ArmPlot
from ui.labels import plain
from ui.level_view import LevelView
from ui.marks import Level, Mark
from ui.operate_page import framed
from ui.theme import LARGE_PX, TEXT_PX, sized
from ui.train_words import arm_text, posture_text


class ArmCard(QFrame):
    """One arm: which of the four states, what to do, and its live plot. GUI thread only."""

    def __init__(self, side: Side, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        name = side.value
        self.setObjectName(f"{name}ArmCard")
        framed(self)
        title = plain(f"{name}ArmTitle", LARGE_PX + 2, is_wrapped=False)
        title.setText(f"{name.capitalize()} arm")
        sized(title, LARGE_PX + 2, is_bold=True)
        self._states = {state: _StateRow(f"{name}State_{state.name}", state) for state in LinkState}
        self._text = plain(f"{name}ArmText", LARGE_PX)
        self._text.setAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignTop)
        self._text.setMinimumHeight(2 * self._text.fontMetrics().lineSpacing())
        self._plot = ArmPlot(f"{name}SensorPlot", f"{name.capitalize()} arm")
        layout = QVBoxLayout(self)
        layout.setContentsMargins(14, 8, 12, 8)
        layout.setSpacing(4)
        layout.addWidget(title)
        for row in self._states.values():
            layout.addWidget(row)
        layout.addWidget(self._text)
        layout.addWidget(self._plot, 1)

    def show_health(self, health: StreamHealth, store: SampleStore, now_s: float) -> None:
        """Show another moment of this arm."""
        for state, row in self._states.items():
            row.show_current(is_current=state is health.link, is_ok=health.is_ok)
        text = arm_text(health)
        if text != self._text.text():
            self._text.setText(text)
        self._plot.show_samples(store, now_s, health.is_alive)

    def add(self, widget: QWidget) -> None:
        """Put something under the plot."""
        layout = self.layout()
        if layout is not None:
            layout.addWidget(widget)


class SensorsStep(QWidget):
    """Both arms side by side. GUI thread only.

    Signals:
        finished: The person wants to go on.
    """

    finished = Signal()

    def __init__(self, cell: CellControls, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("sensorsStep")
        self._cell = cell
        self._was_stop_seen = False
        self._left = ArmCard(Side.LEFT)
        self._right = ArmCard(Side.RIGHT)
        self._level = LevelView("sensorLevel")
        self._posture = plain("leftPosture", LARGE_PX, is_wrapped=False)
        self._posture.setMinimumHeight(self._posture.sizeHint().height())
        self._left.add(self._posture)
        self._right.add(self._level)
        self._told = plain("sensorsTold", LARGE_PX)
        self._next = QPushButton("Next")
        self._next.setObjectName("sensorsNext")
        self._next.setAccessibleName("Go on to recording")
        self._next.setAutoDefault(False)
        self._next.setMinimumSize(140, 44)
        sized(self._next, LARGE_PX, is_bold=True)
        self._next.clicked.connect(self.finished)
        cards = QHBoxLayout()
        cards.setSpacing(6)
        cards.addWidget(self._left)
        cards.addWidget(self._right)
        foot = QHBoxLayout()
        foot.setSpacing(12)
        foot.addWidget(self._told, 1)
        foot.addWidget(self._next)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(6)
        layout.addLayout(cards, 1)
        layout.addLayout(foot)

    def show_snapshot(self, guided: GuidedSnapshot, cell: Snapshot) -> None:
        """Show another moment."""
        self._left.show_health(cell.left, self._cell.left, cell.t_s)
        self._right.show_health(cell.right, self._cell.right, cell.t_s)
        if not cell.left.is_ok:
            self._was_stop_seen = False
        elif cell.posture is ArmPosture.STOP:
            self._was_stop_seen = True
        posture = posture_text(cell.posture, self._was_stop_seen) if cell.left.is_alive else ""
        _say(self._posture, posture)
        self._level.show_tilt(guided.tilt_deg, guided.is_level)
        told, can_go_on = self._judge(guided, cell)
        _say(self._told, told)
        self._next.setEnabled(can_go_on)

    def _judge(self, guided: GuidedSnapshot, cell: Snapshot) -> tuple[str, bool]:
        """Takes need the right arm; without the left one they go by the beat."""
        if not guided.person:
            return "Choose a person first.", False
        if not cell.right.is_ok:
            return "The right arm's sensor is needed to record takes.", False
        if not cell.left.is_ok:
            return "Without the left sensor, takes are recorded by the beat.", True
        if not self._was_stop_seen:
            return "Hold the left arm in the stop posture for a moment.", False
        return "Both arms are fine.", True


class _StateRow(QWidget):
    """One of the four states; the current one has its mark and bold letters."""

    def __init__(self, name: str, state: LinkState) -> None:
        super().__init__()
        self._shown: tuple[bool, bool] | None = None
        self._is_good = state is LinkState.RECEIVING
        self._mark = Mark(14)
        self._label = plain(name, TEXT_PX + 1, is_wrapped=False)
        self._label.setText(state.value)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(8)
        layout.addWidget(self._mark)
        layout.addWidget(self._label, 1)

    def show_current(self, *, is_current: bool, is_ok: bool) -> None:
        """Say whether this is the state, and whether nothing is wrong with it."""
        if (is_current, is_ok) == self._shown:
            return
        self._shown = (is_current, is_ok)
        is_fine = self._is_good and is_ok
        level = Level.OFF if not is_current else Level.OK if is_fine else Level.ATTENTION
        self._mark.show_level(level)
        sized(self._label, TEXT_PX + 1, is_bold=is_current)
        self._label.setEnabled(is_current)
        spoken = f"{self._label.text()}: {'yes' if is_current else 'no'}"
        self._label.setAccessibleName(spoken)


def _say(label: QLabel, text: str) -> None:
    if label.text() != text:
        label.setText(text)
