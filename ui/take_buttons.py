"""What can be done with the marked take: take it out, or say that it shows another gesture."""

from functools import partial

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QHBoxLayout, QMenu, QPushButton, QWidget

from gestureapp.gestures import GESTURES
from gestureapp.guided.controls import GuidedControls
from ui.take_strip import TakeStrip
from ui.theme import TEXT_PX, sized


class TakeButtons(QWidget):
    """Acts on the take that is marked in a strip. GUI thread only."""

    def __init__(
        self, guided: GuidedControls, strip: TakeStrip, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self._guided, self._strip = guided, strip
        self._exclude = QPushButton("Exclude")
        self._move = QPushButton("Move to\u2026")
        self._set_up()
        layout = QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(5)
        layout.addWidget(self._exclude, 1)
        layout.addWidget(self._move, 1)
        strip.selected.connect(self._show_marked)
        self._show_marked()

    def _show_marked(self) -> None:
        take = self._strip.chosen
        for button in (self._exclude, self._move):
            button.setEnabled(take is not None)
        is_out = take is not None and take.is_excluded
        self._exclude.setText("Take in" if is_out else "Exclude")

    def _press_exclude(self) -> None:
        take = self._strip.chosen
        if take is not None:
            self._guided.exclude(take.id, is_excluded=not take.is_excluded)

    def _move_to(self, label: str) -> None:
        take = self._strip.chosen
        if take is not None and take.label != label:
            self._guided.move(take.id, label)

    def _set_up(self) -> None:
        menu = QMenu(self._move)
        menu.setObjectName("moveMenu")
        for each in GESTURES:
            action = menu.addAction(f"{each.label}   {each.words}")
            action.setObjectName(f"moveTo_{each.label}")
            action.triggered.connect(partial(self._move_to, each.label))
        self._move.setMenu(menu)
        self._exclude.clicked.connect(self._press_exclude)
        for button, name, spoken in (
            (self._exclude, "excludeTake", "Take the marked take out of the training, or back in"),
            (self._move, "moveTake", "Say that the marked take shows another gesture"),
        ):
            button.setObjectName(name)
            button.setAccessibleName(spoken)
            button.setToolTip(spoken)
            button.setAutoDefault(False)
            button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
            button.setMinimumWidth(40)
            sized(button, TEXT_PX)
