"""Record: which gesture, what to do, the live hand, the batch's takes, and its buttons."""

from functools import partial

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeySequence, QShortcut
from PySide6.QtWidgets import QHBoxLayout, QMenu, QPushButton, QVBoxLayout, QWidget

from gestureapp.cell.controls import CellControls
from gestureapp.cell.snapshot import Snapshot
from gestureapp.gestures import GESTURES
from gestureapp.guided.controls import GuidedControls
from gestureapp.guided.values import GuidedSnapshot, Phase
from ui.arm_plot import ArmPlot
from ui.gesture_list import WIDTH_PX, GestureList
from ui.level_view import LevelView
from ui.operate_page import framed
from ui.prompt_view import PromptView
from ui.record_controls import RecordControls
from ui.take_strip import TakeStrip
from ui.theme import SMALL_PX, sized

_BEFORE_S, _AFTER_S = 0.5, 1.0
"""A take holds the samples from so long before its activation to so long after it."""
_SIDE_PX = 132


class RecordStep(QWidget):
    """Everything a batch needs on one screen. GUI thread only."""

    def __init__(
        self, cell: CellControls, guided: GuidedControls, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.setObjectName("recordStep")
        self._cell, self._guided = cell, guided
        self._list = GestureList()
        framed(self._list)
        self._list.setFixedWidth(WIDTH_PX + 8)
        self._prompt = PromptView()
        self._plot = ArmPlot("recordPlot", "Right arm")
        framed(self._plot)
        self._level = LevelView("recordLevel")
        self._strip = TakeStrip()
        self._exclude = QPushButton("Exclude")
        self._move = QPushButton("Move to\u2026")
        self._controls = RecordControls(guided)
        self._set_up_take_buttons()
        self._lay_out()
        self._connect()

    def show_snapshot(self, guided: GuidedSnapshot, cell: Snapshot) -> None:
        """Show another moment."""
        self._list.show_progress(guided.progress, guided.label, guided.suggested)
        self._prompt.show_snapshot(guided)
        self._strip.show_batch(guided.batch)
        self._controls.show_snapshot(guided)
        is_moving = guided.phase is Phase.TAKING
        self._level.show_tilt(guided.tilt_deg, guided.is_level, is_moving=is_moving)
        taken = (guided.activation_s - _BEFORE_S, guided.activation_s + _AFTER_S)
        self._plot.mark_window(taken, cell.t_s)
        self._plot.show_samples(self._cell.right, cell.t_s, cell.right.is_alive)

    def _press_exclude(self) -> None:
        take = self._strip.chosen
        if take is not None:
            self._guided.exclude(take.id, is_excluded=not take.is_excluded)

    def _move_to(self, label: str) -> None:
        take = self._strip.chosen
        if take is not None and take.label != label:
            self._guided.move(take.id, label)

    def _name_take_buttons(self) -> None:
        take = self._strip.chosen
        for button in (self._exclude, self._move):
            button.setEnabled(take is not None)
        self._exclude.setText(
            "Take back in" if take is not None and take.is_excluded else "Exclude"
        )

    def _set_up_take_buttons(self) -> None:
        menu = QMenu(self._move)
        menu.setObjectName("moveMenu")
        for each in GESTURES:
            action = menu.addAction(f"{each.label}   {each.words}")
            action.setObjectName(f"moveTo_{each.label}")
            action.triggered.connect(partial(self._move_to, each.label))
        self._move.setMenu(menu)
        for button, name, spoken in (
            (self._exclude, "excludeTake", "Take the marked take out of the training, or back in"),
            (self._move, "moveTake", "Say that the marked take shows another gesture"),
        ):
            button.setObjectName(name)
            button.setAccessibleName(spoken)
            button.setToolTip(spoken)
            button.setAutoDefault(False)
            button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
            button.setFixedWidth(_SIDE_PX)
            sized(button, SMALL_PX + 1)

    def _connect(self) -> None:
        self._list.chosen.connect(self._guided.choose)
        self._exclude.clicked.connect(self._press_exclude)
        self._strip.selected.connect(self._name_take_buttons)
        self._name_take_buttons()
        controls = self._controls
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
        live.addWidget(self._level)
        taken = QHBoxLayout()
        taken.setSpacing(8)
        taken.addWidget(self._strip, 1)
        act = QVBoxLayout()
        act.addStretch(1)
        act.addWidget(self._exclude)
        act.addWidget(self._move)
        act.addStretch(1)
        taken.addLayout(act)
        middle = QVBoxLayout()
        middle.setSpacing(6)
        middle.addWidget(self._prompt, 5)
        middle.addLayout(live, 2)
        middle.addLayout(taken)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(6)
        layout.addWidget(self._list)
        layout.addLayout(middle, 1)
        layout.addWidget(self._controls)
