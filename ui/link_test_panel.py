"""The link test of one sensor: half a minute of arrivals, their figures, and what they carry."""

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QFrame, QHBoxLayout, QProgressBar, QVBoxLayout, QWidget

from gestureapp.sensing.values import Side
from gestureapp.setup.values import Check, LinkTestView
from ui.gap_histogram import GapHistogram
from ui.labels import plain
from ui.operate_page import framed
from ui.setup_parts import Figure, OutcomeLine, enable, push, say
from ui.setup_words import LINK_FIGURES, link_figure_texts
from ui.theme import LARGE_PX, TEXT_PX, sized


class LinkTestPanel(QFrame):
    """Over the whole step. GUI thread only.

    Signals:
        again: The person wants the link of the sensor of this ``Side`` tested.
        closed: The person has seen enough; a test under way ends.
    """

    again = Signal(Side)
    closed = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("linkTestPanel")
        framed(self)
        self._side = Side.LEFT
        self._title = plain("linkTestTitle", 24, is_wrapped=False)
        sized(self._title, 24, is_bold=True)
        self._bar = QProgressBar()
        self._bar.setObjectName("linkTestProgress")
        self._bar.setAccessibleName("How much of the link test is done")
        self._bar.setFixedHeight(30)
        self._figures = [Figure(f"link{key}", caption, 20) for key, caption in LINK_FIGURES]
        self._caption = plain("linkHistogramCaption", TEXT_PX, is_wrapped=False)
        self._caption.setText("How often which time passed between two arrivals; classes up to, ms")
        self._histogram = GapHistogram("linkHistogram")
        self._outcome = OutcomeLine("linkOutcome", LARGE_PX + 4)
        self._again = push("linkTestAgain", "Test again", size_px=LARGE_PX)
        self._close = push("linkTestClose", "Stop testing", size_px=LARGE_PX)
        self._lay_out()
        self._again.clicked.connect(lambda: self.again.emit(self._side))
        self._close.clicked.connect(self.closed)

    def show_test(self, test: LinkTestView, worn: str) -> None:
        """Show another moment of the sensor that is worn on this arm."""
        self._side = test.side or self._side
        say(self._title, f"Link test: {worn} arm's sensor")
        self._bar.setRange(0, max(1, round(10 * test.total_s)))
        self._bar.setValue(round(10 * min(test.elapsed_s, test.total_s)))
        self._bar.setFormat(f"{test.elapsed_s:.0f} of {test.total_s:.0f} s")
        for figure, text in zip(self._figures, link_figure_texts(test), strict=True):
            figure.show_value(text)
        self._histogram.show_gaps(test.histogram, test.set_trip_s)
        is_on = test.outcome.check is Check.RUNNING
        self._outcome.show_outcome(test.outcome)
        enable(self._again, not is_on)
        word = "Stop testing" if is_on else "Back"
        if word != self._close.text():
            self._close.setText(word)
            self._close.setAccessibleName(word)

    def _lay_out(self) -> None:
        figures = QHBoxLayout()
        figures.setSpacing(8)
        for figure in self._figures:
            figures.addWidget(figure, 1)
        foot = QHBoxLayout()
        foot.addStretch(1)
        foot.addWidget(self._again)
        foot.addWidget(self._close)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(18, 10, 18, 12)
        layout.setSpacing(8)
        layout.addWidget(self._title)
        layout.addWidget(self._bar)
        layout.addLayout(figures)
        layout.addWidget(self._caption)
        layout.addWidget(self._histogram, 1)
        layout.addWidget(self._outcome)
        layout.addLayout(foot)
