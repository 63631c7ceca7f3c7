"""What the right arm said: the gesture, where it sends the robot, how certain, and how fast."""

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QHBoxLayout, QProgressBar, QVBoxLayout, QWidget

from gestureapp.gestures import gesture
from gestureapp.guided.controls import GuidedControls
from gestureapp.guided.values import Heard
from gestureapp.recognition.values import Recognition, two_digits
from gestureapp.robot.values import Direction
from ui.direction_view import DirectionView
from ui.keep_heard import KeepHeard
from ui.labels import BigWord, plain
from ui.output_bars import OutputBars
from ui.theme import LARGE_PX, SMALL_PX, TEXT_PX, sized
from ui.words import decision_text, needed_text, not_recognised_text

NOTHING = ""
"""The big label before the first gesture."""
UNSURE = "?"
"""The big label of "not recognised"."""


class GesturePanel(QFrame):
    """The last recognition. "Not recognised" is a normal, calm state of it.

    Args:
        guided: Keeps what was heard as a take; without it there is no button for that.
        parent: Qt's.
    """

    def __init__(self, guided: GuidedControls | None = None, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("gesturePanel")
        self._shown: tuple[Recognition | None, Direction | None] | None = None
        title = plain("gestureTitle", TEXT_PX, is_wrapped=False)
        title.setText("Recognised gesture")
        sized(title, TEXT_PX, is_bold=True)
        self._label = BigWord("RX+", 67, 130)
        self._label.setObjectName("gestureLabel")
        self._words = plain("gestureWords", LARGE_PX - 1)
        self._arrow = DirectionView()
        self._certainty = QProgressBar()
        self._certainty.setObjectName("certaintyBar")
        self._certainty.setRange(0, 100)
        self._certainty.setMaximumHeight(20)
        self._time = plain("decisionLabel", SMALL_PX)
        self._bars = OutputBars()
        top = QHBoxLayout()
        top.addWidget(self._label, 1)
        top.addWidget(self._arrow, 1)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(10, 6, 10, 6)
        layout.setSpacing(4)
        layout.addWidget(title)
        layout.addLayout(top, 3)
        layout.addWidget(self._words)
        layout.addWidget(self._certainty)
        layout.addWidget(self._time)
        layout.addWidget(self._bars, 2)
        self._keep = None
        if guided is not None:
            self._keep = KeepHeard("keepOperated", guided, is_tried=False)
            layout.addWidget(self._keep)
        # Lines are kept for texts that come and go, so that nothing jumps.
        for text, lines in ((self._words, 2), (self._time, 1)):
            text.setAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignTop)
            text.setMinimumHeight(lines * text.fontMetrics().lineSpacing())
        self.show_recognition(None, None)

    def show_recognition(
        self, recognition: Recognition | None, direction: Direction | None
    ) -> None:
        """Show another answer, with the direction it asks of the robot."""
        if (recognition, direction) == self._shown:
            return
        self._shown = (recognition, direction)
        self._arrow.show_direction(direction)
        if recognition is None:
            self._bars.show_outputs(())
        else:
            self._bars.show_outputs(recognition.outputs, recognition.thresholds)
        if recognition is None:
            self._show(NOTHING, "no gesture yet", None, "")
        elif recognition.label is None:
            reason = f"not recognised: {not_recognised_text(recognition)}"
            self._show(UNSURE, reason, None, decision_text(recognition))
        else:
            certainty = _certainty_of(recognition)
            words = _words_of(recognition.label)
            needed = needed_text(certainty, recognition.thresholds)
            self._show(recognition.label, words, certainty, decision_text(recognition), needed)

    def show_heard(self, heard: Heard) -> None:
        """Show whether the last gesture can be kept as a take."""
        if self._keep is not None:
            self._keep.show_heard(heard)

    def _show(
        self, label: str, words: str, certainty: float | None, time: str, needed: str = ""
    ) -> None:
        """``certainty`` is None where nothing was recognised: the bar then says nothing."""
        self._label.setText(label)
        self._label.setAccessibleName(f"Recognised gesture: {label} {words}")
        self._words.setText(words)
        percent = round(100 * min(1.0, max(0.0, certainty or 0.0)))
        self._certainty.setValue(percent)
        self._certainty.setFormat(
            "" if certainty is None else f"certainty {two_digits(certainty)}{needed}"
        )
        self._certainty.setAccessibleName(f"Certainty {percent} %{needed}")
        self._time.setText(time)


def _certainty_of(recognition: Recognition) -> float:
    return next((c.confidence for c in recognition.outputs if c.label == recognition.label), 0.0)


def _words_of(label: str) -> str:
    try:
        return gesture(label).words
    except KeyError:
        return ""  # a model may know gestures that this window has no words for
