"""The stop test: the robot moves 20 mm slowly, somebody presses STOP, and the time is told."""

import math

from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QButtonGroup,
    QGridLayout,
    QHBoxLayout,
    QVBoxLayout,
    QWidget,
)

from gestureapp.clock import Clock, monotonic
from gestureapp.setup.controls import SetupControls
from gestureapp.setup.site_values import StopTestPhase, StopTestView
from gestureapp.setup.snapshot import SetupSnapshot
from gestureapp.setup.values import Outcome
from ui.choice_button import ChoiceButton
from ui.connection_panel import date_text
from ui.draft_bar import heading
from ui.hold_button import HoldButton
from ui.labels import plain
from ui.marks import Level, Mark
from ui.setup_parts import check_level
from ui.theme import LARGE_PX, TEXT_PX, sized

WHAT_IT_IS = (
    "The robot moves 20 mm slowly in the direction chosen, as the operator faces; press STOP while "
    "it moves, and the time from the press to standstill is measured."
)
HOW_TO = (
    "Hold the button with the mouse and press Esc, or hold it with Space and press STOP with the "
    "mouse. Letting go stops the robot as well. The left arm rests in its stop posture meanwhile."
)
ITS_WORTH = (
    "The figure is typical of that move: of this speed, this direction and this load. A faster or "
    "heavier one takes longer."
)
HOLD_TEXT = "Hold: arm and move 20 mm slowly"
DIRECTIONS = ("X+", "Y+", "Z+", "X-", "Y-", "Z-")
_WORDS = {
    "X+": "forward",
    "X-": "back",
    "Y+": "left",
    "Y-": "right",
    "Z+": "up",
    "Z-": "down",
}
_AT_REST = (StopTestPhase.IDLE, StopTestPhase.DONE)


class StopTestPanel(QWidget):
    """Chooses the direction, is held, and tells what came of it. GUI thread only."""

    def __init__(
        self, controls: SetupControls, clock: Clock = monotonic, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.setObjectName("stopTestPanel")
        self._controls = controls
        self._chosen = "Z+"
        self._group = QButtonGroup(self)
        self._hold = HoldButton(HOLD_TEXT, clock)
        self._hold.setObjectName("holdStopTest")
        self._hold.setAccessibleName(HOLD_TEXT)
        self._hold.setAccessibleDescription(HOW_TO)
        sized(self._hold, LARGE_PX + 2, is_bold=True)
        self._mark = Mark(22)
        self._sentence = plain("stopTestSentence", 20)
        sized(self._sentence, 20, is_bold=True)
        self._why_not = plain("stopTestWhyNot", LARGE_PX)
        self._result = plain("stopTestResult", LARGE_PX)
        self._lay_out()
        self._hold.held.connect(lambda: controls.begin_stop_test(self._chosen))
        self._hold.let_go.connect(controls.release_stop_test)

    def show_snapshot(self, setup: SetupSnapshot) -> None:
        """Show another moment of the test."""
        test = setup.stop_test
        is_at_rest = test.phase in _AT_REST
        why_not = test.why_not if is_at_rest else ""
        # While it is held it stays enabled: what stands against another test must not let it go.
        self._hold.setEnabled(self._hold.is_held or not is_at_rest or not why_not)
        for button in self._group.buttons():
            button.setEnabled(is_at_rest and not self._hold.is_held)
        self._why_not.setText(f"Not possible now: {why_not}" if why_not else "")
        self._why_not.setVisible(bool(why_not))
        self._sentence.setText(_sentence_of(test))
        self._mark.show_level(_level_of(test, setup.robot.stop_test))
        self._result.setText(result_text(test, setup.robot.stop_test))

    def _choose(self, label: str) -> None:
        self._chosen = label

    def _lay_out(self) -> None:
        words = [plain(name, TEXT_PX) for name in ("stopTestWords", "stopTestHow", "stopTestWorth")]
        for note, text in zip(words, (WHAT_IT_IS, HOW_TO, ITS_WORTH), strict=True):
            note.setText(text)
        sized(words[0], LARGE_PX)
        directions = QGridLayout()
        directions.setSpacing(6)
        for i, label in enumerate(DIRECTIONS):
            button = ChoiceButton(f"{label}  {_WORDS[label]}")
            button.setObjectName(f"stopTest_{label}")
            button.setAccessibleName(f"Move {label}, {_WORDS[label]}")
            button.setChecked(label == self._chosen)
            button.setMinimumSize(130, 38)
            button.clicked.connect(lambda _=False, label=label: self._choose(label))
            self._group.addButton(button)
            directions.addWidget(button, i // 3, i % 3)
        directions.setColumnStretch(3, 1)
        told = QHBoxLayout()
        told.setSpacing(10)
        told.addWidget(self._mark, alignment=Qt.AlignmentFlag.AlignTop)
        told.addWidget(self._sentence, 1)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(14, 10, 14, 10)
        layout.setSpacing(10)
        layout.addWidget(words[0])
        layout.addLayout(directions)
        layout.addWidget(self._hold, alignment=Qt.AlignmentFlag.AlignLeft)
        layout.addWidget(words[1])
        layout.addWidget(self._why_not)
        layout.addLayout(told)
        layout.addSpacing(6)
        layout.addWidget(heading("stopTestTitle", "Last stop test"))
        layout.addWidget(self._result)
        layout.addWidget(words[2])
        layout.addStretch(1)


def result_text(test: StopTestView, last: Outcome) -> str:
    """The figures of the last test, with its date."""
    if last.text:
        when = date_text(last)
        return f"{last.text} ({when})" if when else last.text
    if test.phase is not StopTestPhase.DONE or math.isnan(test.took_ms):
        return "None yet."
    further = "" if math.isnan(test.ran_on_mm) else f", {test.ran_on_mm:.1f} mm further"
    return f"{test.took_ms:.0f} ms from the press to standstill{further}"


def _sentence_of(test: StopTestView) -> str:
    if test.sentence:
        return f"{test.sentence[:1].upper()}{test.sentence[1:]}"
    return {
        StopTestPhase.IDLE: "Choose a direction with room in it, then hold the button.",
        StopTestPhase.ARMING: "Arming. Keep holding.",
        StopTestPhase.MOVING: "The robot moves. Press STOP.",
        StopTestPhase.STOPPING: "Stopping.",
        StopTestPhase.DONE: "Done.",
    }[test.phase]


def _level_of(test: StopTestView, last: Outcome) -> Level:
    return check_level(last.check) if test.phase in _AT_REST else Level.BUSY
