"""A person's stop and start posture: recorded one after the other, with what lies between."""

from PySide6.QtCore import QRectF, QSize, Qt
from PySide6.QtGui import QColor, QFont, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QFrame, QHBoxLayout, QSizePolicy, QVBoxLayout, QWidget

from gestureapp.setup.controls import SetupControls
from gestureapp.setup.values import PositionState, PosturesView
from ui.arm_figure import LEFT_START, LEFT_STOP
from ui.gesture_drawing import GestureDrawing
from ui.labels import BigText
from ui.operate_page import framed
from ui.progress_ring import paint_ring
from ui.setup_parts import Figure, OutcomeLine, enable, push
from ui.setup_words import POSTURE_FIGURES, posture_texts, postures_kept, postures_sentence
from ui.theme import LARGE_PX, colours_of

_RING_PX = 64


class PosturesPanel(QFrame):
    """Stop, then start. GUI thread only."""

    def __init__(self, setup: SetupControls, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("posturesPanel")
        framed(self)
        self._setup = setup
        self._is_on = False
        self._sentence = BigText("posturesSentence", 22, 90)
        self._stop = PostureTile("stopPosture", "stop", LEFT_STOP)
        self._start = PostureTile("startPosture", "start", LEFT_START)
        self._figures = [Figure(f"postures{key}", caption, 28) for key, caption in POSTURE_FIGURES]
        self._outcome = OutcomeLine("posturesOutcome", LARGE_PX)
        self._begin = push("beginPostures", "Record postures", size_px=LARGE_PX)
        self._forget = push("forgetPostures", "Use the built-in ones", size_px=LARGE_PX)
        self._lay_out()
        self._begin.clicked.connect(self._begin_or_end)
        self._forget.clicked.connect(setup.forget_postures)

    def show_view(self, view: PosturesView, is_left_alive: bool) -> None:
        """Show another moment.

        Args:
            view: Of the person's postures.
            is_left_alive: The left sensor sends.
        """
        self._is_on = view.is_on
        sentence = postures_sentence(view, is_left_alive)
        self._sentence.show_text(sentence)
        is_stop_now = view.is_on and not view.is_stop_done
        is_start_now = view.is_on and view.is_stop_done and not view.is_start_done
        self._stop.show_state(_state(view.is_stop_done, is_stop_now, view.is_on), view.progress)
        self._start.show_state(_state(view.is_start_done, is_start_now, view.is_on), view.progress)
        for figure, text in zip(self._figures, posture_texts(view), strict=True):
            figure.show_value(text)
        self._outcome.show_outcome(view.outcome, postures_kept(view), sentence)
        word = "Stop recording" if view.is_on else "Record postures"
        if word != self._begin.text():
            self._begin.setText(word)
            self._begin.setAccessibleName(word)
        enable(self._begin, view.is_on or (bool(view.person) and is_left_alive))
        is_to_forget = view.wall_s > 0 or bool(view.problem)
        enable(self._forget, not view.is_on and bool(view.person) and is_to_forget)

    def _begin_or_end(self) -> None:
        if self._is_on:
            self._setup.end_postures()
        else:
            self._setup.begin_postures()

    def _lay_out(self) -> None:
        tiles = QHBoxLayout()
        tiles.setSpacing(8)
        tiles.addWidget(self._stop)
        tiles.addWidget(self._start)
        figures = QHBoxLayout()
        figures.setSpacing(24)
        for figure in self._figures:
            figures.addWidget(figure)
        figures.addStretch(1)
        buttons = QHBoxLayout()
        buttons.setSpacing(8)
        buttons.addWidget(self._outcome, 1)
        buttons.addWidget(self._forget)
        buttons.addWidget(self._begin)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(14, 8, 12, 10)
        layout.setSpacing(8)
        layout.addWidget(self._sentence, 3)
        layout.addLayout(tiles, 6)
        layout.addLayout(figures)
        layout.addLayout(buttons)


class PostureTile(QWidget):
    """A posture's drawing with its word and its ring."""

    def __init__(self, name: str, word: str, label: str) -> None:
        super().__init__()
        self.setObjectName(name)
        self._word = word
        self._state: PositionState | None = PositionState.MISSING
        self._progress = 0.0
        drawing = GestureDrawing(label, is_animated=False)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(10, 10, _RING_PX + 60, 10)
        layout.addWidget(drawing)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.show_state(None, 0.0)

    def show_state(self, state: PositionState | None, progress: float) -> None:
        """Show how far it is; None while nothing is recorded nor being so."""
        progress = progress if state is PositionState.HOLD_STILL else 0.0
        if (state, progress) == (self._state, self._progress):
            return
        self._state, self._progress = state, progress
        state_words = "" if state is None else f": {state.value}"
        self.setAccessibleName(f"{self._word} posture{state_words}")
        self.update()

    def minimumSizeHint(self) -> QSize:
        """A small drawing beside the words."""
        return QSize(260, 110)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw frame, words and ring; the drawing is a widget of its own."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        colours = colours_of(self.palette())
        is_now = self._state is PositionState.HOLD_STILL
        is_missing = self._state is PositionState.MISSING
        pen = QPen(QColor(colours.info if is_now else colours.muted), 5 if is_now else 1.5)
        pen.setStyle(Qt.PenStyle.DashLine if is_missing else Qt.PenStyle.SolidLine)
        painter.setPen(pen)
        painter.setBrush(QColor(colours.base))
        frame = QRectF(self.rect()).adjusted(3, 3, -3, -3)
        painter.drawRect(frame)
        words = QRectF(frame.right() - _RING_PX - 52, frame.top(), _RING_PX + 48, frame.height())
        font = QFont(self.font())
        font.setPixelSize(26)
        font.setBold(True)
        painter.setFont(font)
        painter.setPen(QColor(colours.text))
        line = QRectF(words.left(), words.center().y() - 74, words.width(), 34)
        painter.drawText(line, Qt.AlignmentFlag.AlignCenter, self._word)
        if self._state is None:
            painter.end()
            return
        font.setPixelSize(LARGE_PX + 2)
        font.setBold(is_now)
        painter.setFont(font)
        line.translate(0, 30)
        painter.drawText(line, Qt.AlignmentFlag.AlignCenter, self._state.value)
        ring = QRectF(0, 0, _RING_PX, _RING_PX)
        ring.moveCenter(words.center())
        ring.moveTop(words.center().y() - 4)
        paint_ring(painter, ring, self._state, self._progress, colours)
        painter.end()


def _state(is_done: bool, is_now: bool, is_on: bool) -> PositionState | None:
    if is_done:
        return PositionState.DONE
    if is_now:
        return PositionState.HOLD_STILL
    return PositionState.MISSING if is_on else None
