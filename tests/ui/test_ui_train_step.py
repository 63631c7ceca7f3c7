"""The step Train: what is missing, how far it is, what came of it, and that it can be cancelled."""

import math
from dataclasses import replace

import numpy as np
import pytest
from pyqtgraph import PlotWidget
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QLabel, QProgressBar, QPushButton, QRadioButton, QToolButton, QWidget

from gestureapp.gestures import LABELS
from gestureapp.guided.values import (
    GestureProgress,
    GuidedSnapshot,
    Quality,
    TrainingPhase,
    TrainingResult,
    TrainingView,
)
from gestureapp.recognition.evaluation import Evaluation
from gestureapp.recognition.presets import Preset
from ui.loss_plot import LossPlot
from ui.theme import DARK, palette_of
from ui.train_step import TrainStep


class NotedTrainer:
    """Implements ``TrainerControls``: the test says how far the training is."""

    def __init__(self) -> None:
        self.shown = TrainingView()
        self.started: list[Preset] = []
        self.n_cancelled = 0

    def view(self) -> TrainingView:
        return self.shown

    def start(self, preset: Preset = Preset.DEFAULT, seed: int = 0) -> None:
        self.started.append(preset)

    def cancel(self) -> None:
        self.n_cancelled += 1


def recorded(**good: int) -> GuidedSnapshot:
    """Thirty takes of each gesture, but for those named (``Zm=3`` is Z-)."""
    counts = {name.replace("p", "+").replace("m", "-"): n for name, n in good.items()}
    progress = tuple(
        GestureProgress(label, counts.get(label, 30), 30, Quality.GOOD) for label in LABELS
    )
    return GuidedSnapshot(person="Ana", progress=progress, version=1)


def result(*words: str) -> TrainingResult:
    confusion = 28 * np.eye(12, 13, dtype=np.int64)
    confusion[:, -1] = 2
    evaluation = Evaluation(LABELS, confusion, (24.0, 31.0))
    return TrainingResult(
        words or ("Good. Of 360 takes 93 % are recognised.", "Record more RZ+."),
        evaluation,
        "by session: 3 sessions",
        (("preset", "default"), ("passes", "142")),
        5.4,
    )


class Desk:
    """The step in a window, and the person before it."""

    def __init__(self, qtbot) -> None:
        self.qtbot = qtbot
        self.trainer = NotedTrainer()
        self.step = TrainStep(self.trainer)
        qtbot.addWidget(self.step)
        self.step.resize(1100, 590)
        self.step.show()

    def show(self, view: TrainingView, snapshot: GuidedSnapshot | None = None) -> None:
        self.trainer.shown = view
        self.step.show_snapshot(recorded() if snapshot is None else snapshot)

    def text(self, name: str) -> str:
        return self.step.findChild(QLabel, name).text()

    def is_seen(self, name: str) -> bool:
        return self.step.findChild(QWidget, name).isVisible()

    def press(self, name: str, kind: type = QPushButton) -> None:
        button = self.step.findChild(kind, name)
        assert button.isVisible()
        assert button.isEnabled()
        self.qtbot.mouseClick(button, Qt.MouseButton.LeftButton)


@pytest.fixture
def desk(qtbot) -> Desk:
    return Desk(qtbot)


def test_one_press_trains_by_the_default_preset(desk):
    desk.show(TrainingView())
    assert desk.text("trainText") == "360 takes of 12 gestures count."
    desk.press("trainButton")
    assert desk.trainer.started == [Preset.DEFAULT]


def test_the_other_preset_is_folded_away_and_can_be_chosen(desk):
    desk.show(TrainingView())
    assert not desk.is_seen("preset_paper")
    desk.press("presetFold", QToolButton)
    desk.press("preset_paper", QRadioButton)
    desk.press("trainButton")
    assert desk.trainer.started == [Preset.PAPER]


def test_what_is_missing_is_said_and_nothing_can_be_pressed(desk):
    desk.show(TrainingView(), recorded(Zm=3))
    assert "Z- has 3" in desk.text("trainText")
    assert "at least 5" in desk.text("trainText")
    assert not desk.step.findChild(QPushButton, "trainButton").isEnabled()
    desk.show(TrainingView(), replace(recorded(), person=""))
    assert desk.text("trainText") == "Choose a person first."


def test_gestures_without_takes_are_named(desk):
    desk.show(TrainingView(), recorded(RXp=0, RXm=0))
    assert desk.text("trainText") == (
        "300 takes of 10 gestures count. The model will not know RX+, RX-: no takes."
    )
    desk.press("trainButton")


def test_while_it_trains_progress_remaining_time_and_loss_are_seen(desk):
    losses = tuple((i, math.exp(-i / 50)) for i in range(1, 3000))
    desk.show(TrainingView(TrainingPhase.RUNNING, 0.414, 4.2, losses, "pass 2999 of 7000"))
    bar = desk.step.findChild(QProgressBar, "trainProgress")
    assert bar.text() == "41 %, about 4 s left"
    assert desk.text("trainText") == "Pass 2999 of 7000"
    points = desk.step.findChild(LossPlot, "lossPlot").points()
    assert 300 <= len(points) <= 500
    assert points[-1] == pytest.approx((2999, -2999 / 50 / math.log(10)))
    assert not desk.step.findChild(QPushButton, "trainButton").isEnabled()
    desk.press("cancelTraining")
    assert desk.trainer.n_cancelled == 1


def test_a_loss_that_is_no_number_is_not_drawn(desk):
    losses = ((1, 0.5), (2, math.nan), (3, 0.0), (4, math.inf), (5, 0.4))
    desk.show(TrainingView(TrainingPhase.RUNNING, losses=losses))
    assert [n for n, _ in desk.step.findChild(LossPlot, "lossPlot").points()] == [1, 5]


def test_the_loss_has_no_values_at_its_axes_before_its_first_point(desk):
    def sides_with_values() -> list[str]:
        item = desk.step.findChild(LossPlot, "lossPlot").findChild(PlotWidget).getPlotItem()
        return [side for side in ("left", "bottom") if item.getAxis(side).style["showValues"]]

    desk.show(TrainingView(TrainingPhase.RUNNING))
    assert sides_with_values() == []
    desk.show(TrainingView(TrainingPhase.RUNNING, losses=((1, 0.5), (2, 0.4))))
    assert sides_with_values() == ["left", "bottom"]
    desk.show(TrainingView(TrainingPhase.RUNNING))
    assert sides_with_values() == []


def test_the_words_come_first_and_large_then_the_figures(desk):
    desk.show(TrainingView(TrainingPhase.DONE, 1.0, text="Trained.", result=result()))
    judgement = desk.step.findChild(QLabel, "resultJudgement")
    assert judgement.text() == "Good."
    assert judgement.font().pixelSize() >= 24
    assert desk.text("resultAdvice") == "Of 360 takes 93 % are recognised. Record more RZ+."
    assert "by session: 3 sessions" in desk.text("resultHow")
    assert judgement.mapTo(desk.step, judgement.pos()).y() < 150
    assert desk.is_seen("recognitionTable")
    assert desk.is_seen("resultMatrix")
    assert not desk.is_seen("cancelTraining")
    assert not desk.is_seen("lossPlot")


def test_the_technical_part_is_folded_away(desk):
    desk.show(TrainingView(TrainingPhase.DONE, result=result()))
    assert not desk.is_seen("technicalPart")
    desk.press("technicalFold", QToolButton)
    assert desk.is_seen("technicalPart")
    assert desk.text("fact_1_0") == "passes"
    assert desk.text("fact_1_1") == "142"


def test_a_model_that_is_out_of_date_says_why(desk):
    why = "the takes have changed since the model was trained"
    desk.show(TrainingView(TrainingPhase.DONE, text="trained", result=result(), out_of_date=why))
    assert desk.text("trainText") == f"Out of date: {why}. Train again."
    assert desk.is_seen("trainingResult")
    desk.show(TrainingView(TrainingPhase.DONE, text="trained", result=result()))
    assert desk.text("trainText") == "Trained"


@pytest.mark.parametrize("phase", [TrainingPhase.CANCELLED, TrainingPhase.FAILED])
def test_a_training_that_ended_early_says_so_and_leaves_the_model_in_sight(desk, phase):
    text = "Cancelled; the model there was stays."
    desk.show(TrainingView(phase, text=text, result=result()))
    assert desk.text("trainText") == text
    assert desk.is_seen("trainingResult")
    desk.show(TrainingView(phase, text=text, result=result(), out_of_date="the takes have changed"))
    assert desk.text("trainText").startswith(f"{text}\nOut of date: ")
    desk.press("trainButton")
    assert desk.trainer.started == [Preset.DEFAULT]


def test_another_result_replaces_the_first(desk):
    desk.show(TrainingView(TrainingPhase.DONE, result=result()))
    desk.show(TrainingView(TrainingPhase.DONE, result=result("Not reliable yet.")))
    assert desk.text("resultJudgement") == "Not reliable yet."
    assert not desk.is_seen("resultAdvice")


def test_it_has_room_in_a_small_window_and_on_a_dark_screen(desk):
    desk.show(TrainingView(TrainingPhase.DONE, result=result()))
    least = desk.step.minimumSizeHint()
    assert least.width() <= 1000
    assert least.height() <= 484
    desk.step.setPalette(palette_of(DARK))
    desk.step.grab()
