"""Record: which gesture, what to do, the live hand, the batch's takes, and its buttons."""

from PySide6.QtCore import Signal
from PySide6.QtGui import QKeySequence, QShortcut
from PySide6.QtWidgets import QHBoxLayout, QVBoxLayout, QWidget

from gestureapp.cell.controls import CellControls
from gestureapp.cell.snapshot import Snapshot
from gestureapp.gestures import is_held
from gestureapp.guided.controls import GuidedControls
from gestureapp.guided.values import GuidedSnapshot, Phase
from gestureapp.recording.take_values import AFTER_S, BEFORE_S
from ui.arm_plot import ArmPlot
from ui.gesture_list import GestureList
from ui.level_view import LevelView
from ui.operate_page import framed
from ui.prompt_view import PromptView
from ui.record_controls import RecordControls
from ui.sounds import SoundBox, Sounds, TrainingSounds
from ui.take_strip import TakeStrip

_SIDE_PX = 132


class RecordStep(QWidget):
    """Everything a batch needs on one screen. GUI thread only.

    Signals:
        pace_chosen: The person has said what begins a take.
    """

    pace_chosen = Signal()

    def __init__(
        self, cell: CellControls, guided: GuidedControls, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.setObjectName("recordStep")
        self._cell, self._guided = cell, guided
        self._list = GestureList()
        framed(self._list)
        self._prompt = PromptView()
        self._plot = ArmPlot("recordPlot", "Right arm")
        framed(self._plot)
        self._level = LevelView("recordLevel")
        sounds = Sounds()
        self._sounds = TrainingSounds(sounds, parent=self)
        self._sound = SoundBox(sounds)
        self._strip = TakeStrip()
        self._controls = RecordControls(guided, self._strip)
        self._lay_out()
        self._connect()

    def show_snapshot(self, guided: GuidedSnapshot, cell: Snapshot) -> None:
        """Show another moment."""
        self._list.show_progress(guided.progress, guided.label, guided.suggested)
        self._prompt.show_snapshot(guided)
        self._sounds.show_snapshot(guided)
        self._strip.show_batch(guided.batch)
        self._controls.show_snapshot(guided)
        is_moving = guided.phase is Phase.TAKING
        self._level.show_tilt(
            guided.tilt_deg,
            guided.is_level,
            is_moving=is_moving,
            is_level_wanted=not (guided.label and is_held(guided.label)),
        )
        taken = (guided.activation_s - BEFORE_S, guided.activation_s + AFTER_S)
        self._plot.mark_window(taken, cell.t_s)
        self._plot.show_samples(self._cell.right, cell.t_s, cell.right.is_alive)

    def _connect(self) -> None:
        self._list.chosen.connect(self._guided.choose)
        controls = self._controls
        controls.pace_chosen.connect(self.pace_chosen)
        # Only while this step is in sight; none of them is a key of the virtual operator.
        for key, act in (
            ("Return", controls.begin),
            ("Enter", controls.begin),
            ("R", controls.redo_last),
            ("Ctrl+Z", controls.undo),
            ("Ctrl+Shift+Z", controls.redo),
        ):
            shortcut = QShortcut(QKeySequence(key), self)
            shortcut.setAutoRepeat(False)
            shortcut.activated.connect(act)

    def _lay_out(self) -> None:
        live = QHBoxLayout()
        live.setSpacing(8)
        live.addWidget(self._plot, 1)
        self._level.setFixedWidth(_SIDE_PX)
        self._level.setFixedHeight(80)
        side = QVBoxLayout()
        side.setSpacing(2)
        side.addWidget(self._level)
        side.addWidget(self._sound)
        live.addLayout(side)
        middle = QVBoxLayout()
        middle.setSpacing(6)
        middle.addWidget(self._prompt, 5)
        middle.addLayout(live, 2)
        middle.addWidget(self._strip)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(6)
        layout.addWidget(self._list, 2)
        layout.addLayout(middle, 6)
        layout.addWidget(self._controls)
