"""The buttons of a batch: begin, pause, end, take back; and what begins a take."""

from collections.abc import Callable

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QAbstractSpinBox,
    QApplication,
    QButtonGroup,
    QDoubleSpinBox,
    QFrame,
    QGridLayout,
    QLabel,
    QPushButton,
    QSpinBox,
    QVBoxLayout,
    QWidget,
)

from gestureapp.config import BEAT_RANGE_S, N_TAKES_RANGE
from gestureapp.guided.controls import GuidedControls
from gestureapp.guided.values import GuidedSnapshot, Pace, Phase
from ui.labels import plain
from ui.operate_page import framed
from ui.take_buttons import TakeButtons
from ui.take_strip import TakeStrip
from ui.theme import LARGE_PX, SMALL_PX, TEXT_PX, sized
from ui.train_words import is_running, pace_text

WIDTH_PX = 196


class RecordControls(QFrame):
    """Passes presses on; shows what can be done now. GUI thread only.

    Signals:
        pace_chosen: The person has said what begins a take.
    """

    pace_chosen = Signal()

    def __init__(
        self, guided: GuidedControls, strip: TakeStrip, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.setObjectName("recordControls")
        framed(self)
        self.setFixedWidth(WIDTH_PX)
        self._guided = guided
        self._phase = Phase.CLOSED
        self._start = _button("startBatch", "Start\n[Enter]", "Start a batch of takes")
        self._pause = _button("pauseBatch", "Pause", "Pause the batch, or go on")
        self._end = _button("endBatch", "End", "End the batch; what was taken is kept")
        self._redo_last = _button("redoLast", "Redo last  [R]", "Do the last take again")
        self._undo = _button("undoTake", "Undo", "Undo the last change of the takes")
        self._redo = _button("redoTake", "Redo", "Do it again after all")
        self._paces = {
            Pace.HANDS_FREE: _button("paceHandsFree", "Hands-free", pace_text(Pace.HANDS_FREE)),
            Pace.RHYTHM: _button("paceRhythm", "Rhythm", pace_text(Pace.RHYTHM)),
        }
        self._marked = TakeButtons(guided, strip)
        self._beat = QDoubleSpinBox()
        self._wanted = QSpinBox()
        self._set_up_numbers()
        self._lay_out()
        self._connect()

    def show_snapshot(self, snapshot: GuidedSnapshot) -> None:
        """Show what can be done now."""
        phase = snapshot.phase
        if phase is not self._phase:
            self._phase = phase
            self._pause.setText("Go on" if phase is Phase.PAUSED else "Pause")
        is_idle, is_open = phase is Phase.IDLE, phase is not Phase.CLOSED
        is_paused = phase is Phase.PAUSED
        self._start.setEnabled(is_idle)
        self._pause.setEnabled(is_paused or is_running(phase))
        self._end.setEnabled(is_open and not is_idle)
        self._redo_last.setEnabled(bool(snapshot.batch))
        for button, word, what in (
            (self._undo, "Undo", snapshot.undo),
            (self._redo, "Redo", snapshot.redo),
        ):
            button.setEnabled(bool(what))
            _tell(button, f"{word} {what}" if what else f"{word}: nothing")
        for pace, button in self._paces.items():
            button.setChecked(pace is snapshot.pace)
            button.setEnabled(is_idle or is_paused)
        self._beat.setEnabled(snapshot.pace is Pace.RHYTHM and (is_idle or is_paused))
        self._show_numbers(snapshot)

    def begin(self) -> None:
        """Enter was pressed: begin a batch, or go on after a pause."""
        focused = QApplication.focusWidget()
        if isinstance(focused, QAbstractSpinBox):
            focused.clearFocus()  # the number is taken; the next Enter begins
        elif self._phase is Phase.PAUSED:
            self._guided.go_on()
        else:
            self._start.click()

    def redo_last(self) -> None:
        """R was pressed."""
        self._redo_last.click()

    def undo(self) -> None:
        """Ctrl+Z was pressed."""
        self._undo.click()

    def redo(self) -> None:
        """Ctrl+Shift+Z was pressed."""
        self._redo.click()

    def _show_numbers(self, snapshot: GuidedSnapshot) -> None:
        if not self._beat.hasFocus() and self._beat.value() != snapshot.beat_s:
            self._beat.setValue(snapshot.beat_s)
        wanted = snapshot.progress[0].wanted if snapshot.progress else 0
        self._wanted.setEnabled(bool(wanted))
        if wanted and not self._wanted.hasFocus() and self._wanted.value() != wanted:
            self._wanted.setValue(wanted)

    def _press_pause(self) -> None:
        if self._phase is Phase.PAUSED:
            self._guided.go_on()
        else:
            self._guided.pause()

    def _set_pace(self, pace: Pace) -> Callable[[], None]:
        return lambda: self._guided.set_pace(pace, self._beat.value())

    def _connect(self) -> None:
        guided = self._guided
        self._start.clicked.connect(lambda: guided.start())
        self._pause.clicked.connect(self._press_pause)
        self._end.clicked.connect(lambda: guided.end_batch())
        self._redo_last.clicked.connect(lambda: guided.redo_last())
        self._undo.clicked.connect(lambda: guided.undo())
        self._redo.clicked.connect(lambda: guided.redo())
        for pace, button in self._paces.items():
            button.clicked.connect(self._set_pace(pace))
            button.clicked.connect(lambda: self.pace_chosen.emit())
        self._beat.editingFinished.connect(self._take_beat)
        self._wanted.editingFinished.connect(lambda: guided.set_wanted(self._wanted.value()))

    def _take_beat(self) -> None:
        """The field is left; also when it is shut because hands-free was chosen."""
        if self._paces[Pace.RHYTHM].isChecked():
            self._guided.set_pace(Pace.RHYTHM, self._beat.value())

    def _set_up_numbers(self) -> None:
        self._beat.setObjectName("beatTime")
        self._beat.setAccessibleName("Time between two beats in seconds")
        self._beat.setRange(*BEAT_RANGE_S)
        self._beat.setSingleStep(0.1)
        self._beat.setDecimals(1)
        self._beat.setSuffix(" s")
        self._wanted.setObjectName("takesWanted")
        self._wanted.setAccessibleName("Good takes wanted of each gesture")
        self._wanted.setRange(*N_TAKES_RANGE)
        for box in (self._beat, self._wanted):
            box.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
            box.setKeyboardTracking(False)

    def _lay_out(self) -> None:
        sized(self._start, LARGE_PX + 2, is_bold=True)
        self._start.setMinimumHeight(56)
        for button in (self._pause, self._end):
            button.setMinimumHeight(36)
        group = QButtonGroup(self)
        for button in self._paces.values():
            button.setCheckable(True)
            group.addButton(button)
        grid = QGridLayout()
        grid.setSpacing(5)
        grid.addWidget(self._start, 0, 0, 1, 2)
        grid.addWidget(self._pause, 1, 0)
        grid.addWidget(self._end, 1, 1)
        grid.addWidget(self._redo_last, 2, 0, 1, 2)
        grid.addWidget(self._undo, 3, 0)
        grid.addWidget(self._redo, 3, 1)
        grid.addWidget(_caption("markedTitle", "The marked take"), 4, 0, 1, 2)
        grid.addWidget(self._marked, 5, 0, 1, 2)
        grid.addWidget(_caption("paceTitle", "What begins a take"), 6, 0, 1, 2)
        grid.addWidget(self._paces[Pace.HANDS_FREE], 7, 0)
        grid.addWidget(self._paces[Pace.RHYTHM], 7, 1)
        grid.addWidget(_caption("beatTitle", "Beat"), 8, 0)
        grid.addWidget(self._beat, 8, 1)
        grid.addWidget(_caption("wantedTitle", "Takes each"), 9, 0)
        grid.addWidget(self._wanted, 9, 1)
        for column in (0, 1):
            grid.setColumnStretch(column, 1)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(8, 8, 8, 6)
        layout.addLayout(grid)
        layout.addStretch(1)


def _button(name: str, text: str, spoken: str) -> QPushButton:
    button = QPushButton(text)
    button.setObjectName(name)
    button.setAutoDefault(False)
    # A press by mouse leaves the focus where it is: Space must not press it again.
    button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
    button.setMinimumWidth(40)
    sized(button, TEXT_PX)
    _tell(button, spoken)
    return button


def _tell(button: QPushButton, spoken: str) -> None:
    if button.toolTip() != spoken:
        button.setToolTip(spoken)
        button.setAccessibleName(spoken)


def _caption(name: str, text: str) -> QLabel:
    label = plain(name, SMALL_PX, is_wrapped=False)
    label.setText(text)
    return label
