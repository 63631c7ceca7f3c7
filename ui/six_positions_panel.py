"""The six positions of one sensor, followed from where the sensor is laid down; the level check."""

from PySide6.QtWidgets import QFrame, QGridLayout, QHBoxLayout, QProgressBar, QVBoxLayout, QWidget

from gestureapp.sensing.values import Side
from gestureapp.setup.controls import SetupControls
from gestureapp.setup.snapshot import SetupSnapshot
from gestureapp.setup.values import CalibrationView, Check, LevelView, Position, SensorCard
from ui.labels import BigText
from ui.operate_page import framed
from ui.position_tile import PositionTile
from ui.setup_parts import Figure, OutcomeLine, enable, push
from ui.setup_words import RESIDUALS, calibrate_sentence, level_words, residual_texts
from ui.theme import LARGE_PX

_PERCENT = 100


class SixPositionsPanel(QFrame):
    """Calibration and level check of one sensor at a time. GUI thread only.

    Attributes:
        side: Whose.
    """

    def __init__(self, setup: SetupControls, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("sixPositions")
        framed(self)
        self.side = Side.LEFT
        self._setup = setup
        self._is_on = False
        self._sentence = BigText("calibrateSentence", 20, 80)
        self._tiles = {position: PositionTile(position) for position in Position}
        self._figures = [Figure(f"calibrate{key}", caption, 20) for key, caption in RESIDUALS]
        self._outcome = OutcomeLine("calibrateOutcome", LARGE_PX)
        self._level = OutcomeLine("levelOutcome", LARGE_PX)
        self._level_bar = QProgressBar()
        self._level_bar.setObjectName("levelProgress")
        self._level_bar.setAccessibleName("How much of the level check is done")
        self._level_bar.setRange(0, _PERCENT)
        self._level_bar.setTextVisible(False)
        self._level_bar.setFixedSize(160, 18)
        self._begin = push("beginCalibration", "Calibrate", size_px=LARGE_PX)
        self._check = push("checkLevel", "Check level", size_px=LARGE_PX)
        self._lay_out()
        self._begin.clicked.connect(self._begin_or_end)
        self._check.clicked.connect(lambda: setup.begin_level_check(self.side))

    def show_snapshot(self, setup: SetupSnapshot) -> None:
        """Show another moment."""
        card = setup.left if self.side is Side.LEFT else setup.right
        is_own = setup.calibration.side is self.side
        view = setup.calibration if is_own else CalibrationView(self.side)
        level = setup.level if setup.level.side is self.side else LevelView(self.side)
        self._is_on = view.is_on
        sentence = calibrate_sentence(card, view, level)
        self._sentence.show_text(sentence)
        shown = {each.position: each for each in view.positions}
        for position, tile in self._tiles.items():
            is_wanted = view.is_on and position is view.wanted
            tile.show_view(shown.get(position), is_wanted)
        for figure, text in zip(self._figures, residual_texts(view), strict=True):
            figure.show_value(text)
        self._outcome.show_outcome(view.outcome, card.calibration, sentence)
        self._show_level(card, level)
        self._show_buttons(card, level, setup.calibration.is_on)

    def _show_level(self, card: SensorCard, level: LevelView) -> None:
        is_running = level.outcome.check is Check.RUNNING
        self._level_bar.setVisible(is_running)
        self._level_bar.setValue(round(_PERCENT * level.progress))
        self._level.show_outcome(level_words(level), card.level or "level not checked")

    def _show_buttons(self, card: SensorCard, level: LevelView, is_any_on: bool) -> None:
        is_checking = level.outcome.check is Check.RUNNING
        enable(self._begin, self._is_on or (card.health.is_alive and not is_checking))
        enable(self._check, card.health.is_alive and not is_any_on and not is_checking)
        word = "Stop calibrating" if self._is_on else "Calibrate"
        if word != self._begin.text():
            self._begin.setText(word)
        self._begin.setAccessibleName(f"{word}: {card.worn} arm's sensor")
        self._check.setAccessibleName(f"Check level: {card.worn} arm's sensor")

    def _begin_or_end(self) -> None:
        if self._is_on:
            self._setup.end_calibration()
        else:
            self._setup.begin_calibration(self.side)

    def _lay_out(self) -> None:
        tiles = QGridLayout()
        tiles.setSpacing(6)
        for number, tile in enumerate(self._tiles.values()):
            tiles.addWidget(tile, number % 2, number // 2)
        result = QHBoxLayout()
        result.setSpacing(12)
        for figure in self._figures:
            result.addWidget(figure)
        result.addWidget(self._outcome, 1)
        result.addWidget(self._begin)
        checked = QHBoxLayout()
        checked.setSpacing(12)
        checked.addWidget(self._level, 1)
        checked.addWidget(self._level_bar)
        checked.addWidget(self._check)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(14, 8, 12, 10)
        layout.setSpacing(6)
        layout.addWidget(self._sentence, 3)
        layout.addLayout(tiles, 8)
        layout.addLayout(result)
        layout.addLayout(checked)
