"""The step Train with the real training child behind it."""

from collections.abc import Iterator

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QLabel, QPushButton

from gestureapp.config import Settings
from gestureapp.guided.guided import Guided
from gestureapp.guided.trainer import Trainer
from gestureapp.guided.values import TrainingPhase
from gestureapp.recording.people import model_path
from tests.guided.bench import SensedArms
from tests.ui.filled import PERSON, fill
from ui.train_step import TrainStep

LIMIT_MS = 45_000


class Desk:
    """The step in a window, its trainer, and the person before it."""

    def __init__(self, qtbot, guided: Guided, trainer: Trainer) -> None:
        self.qtbot, self.guided, self.trainer = qtbot, guided, trainer
        self.step = TrainStep(trainer)
        qtbot.addWidget(self.step)
        self.step.resize(1100, 590)
        self.step.show()

    def see(self, condition) -> None:
        def is_seen() -> bool:
            self.step.show_snapshot(self.guided.snapshot())
            return condition()

        self.qtbot.waitUntil(is_seen, timeout=LIMIT_MS)

    def text(self, name: str) -> str:
        return self.step.findChild(QLabel, name).text()

    def press(self, name: str) -> None:
        button = self.step.findChild(QPushButton, name)
        self.see(lambda: button.isVisible() and button.isEnabled())
        self.qtbot.mouseClick(button, Qt.MouseButton.LeftButton)


@pytest.fixture
def desk(qtbot, tmp_path) -> Iterator[Desk]:
    fill(tmp_path)
    guided = Guided(SensedArms(Settings()), tmp_path)
    guided.start_thread()
    guided.open(PERSON)
    trainer = Trainer(guided, tmp_path, lambda *told: None)
    trainer.start_thread()
    yield Desk(qtbot, guided, trainer)
    trainer.shutdown()
    guided.shutdown()


@pytest.mark.process
def test_a_press_gives_a_model_and_words_about_it_and_a_change_makes_it_old(desk, tmp_path):
    desk.press("trainButton")
    desk.see(lambda: desk.text("resultJudgement") != "")
    assert desk.trainer.view().phase is TrainingPhase.DONE
    assert model_path(tmp_path, PERSON).exists()
    assert desk.text("resultAdvice").startswith("Of 71 takes ")
    desk.guided.exclude(desk.guided.takes("RZ-")[0].id)
    desk.see(lambda: desk.text("trainText").startswith("Out of date: the takes have changed"))


@pytest.mark.process
def test_a_training_is_cancelled_and_leaves_no_model(desk, tmp_path):
    desk.press("trainButton")
    desk.press("cancelTraining")
    desk.see(lambda: desk.text("trainText") == "Cancelled")
    assert not model_path(tmp_path, PERSON).exists()
    assert desk.step.findChild(QPushButton, "trainButton").isEnabled()
