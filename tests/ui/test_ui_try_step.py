"""The step Try: a simulated person does what it asks for, and sees what was heard."""

import shutil
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QLabel, QProgressBar, QPushButton, QWidget

from gestureapp.guided.values import GuidedSnapshot, TrainingResult, TrainingView, Trying
from gestureapp.recognition.evaluation import Evaluation
from gestureapp.recording.people import model_path
from tests.guided.bench import Bench
from ui.answer_mark import Answer, AnswerMark
from ui.confusion_matrix import ConfusionMatrix
from ui.gesture_drawing import GestureDrawing
from ui.try_step import TryStep

PERSON = "Ana"
DEMO_MODEL = Path(__file__).parents[2] / "resources" / "demo" / "model.json"


class BenchControls:
    """What of ``GuidedControls`` the step asks, done at once by the bench's desk."""

    def __init__(self, bench: Bench) -> None:
        self._desk = bench.desk
        self.most = 5

    def start_trying(self, per_gesture: int = 5) -> None:
        self._desk.start_trying(min(per_gesture, self.most))

    def stop_trying(self) -> None:
        self._desk.stop_trying()

    def keep_heard(self, number: int) -> None:
        self._desk.keep_heard(number)


class Trained:
    """A trainer with a model, or without."""

    def __init__(self) -> None:
        evaluation = Evaluation(("X+",), np.array([[30, 0]]), (24.0, 31.0))
        self.shown = TrainingView(result=TrainingResult(("Good.",), evaluation, "", (), 5.0))

    def view(self) -> TrainingView:
        return self.shown


class Desk:
    """The step in a window, and the person before it."""

    def __init__(self, qtbot, bench: Bench) -> None:
        self.qtbot, self.bench = qtbot, bench
        self.trainer = Trained()
        self.controls = BenchControls(bench)
        self.step = TryStep(self.controls, self.trainer)
        qtbot.addWidget(self.step)
        self.step.resize(1100, 590)
        self.step.show()
        self.see()

    def see(self) -> None:
        self.step.show_snapshot(self.bench.picture)

    def run_until(self, condition) -> None:
        self.bench.run_until(condition, limit_s=600.0)
        self.see()

    def text(self, name: str) -> str:
        return self.step.findChild(QLabel, name).text()

    @property
    def button(self) -> QPushButton:
        return self.step.findChild(QPushButton, "tryButton")

    @property
    def matrix(self) -> ConfusionMatrix:
        return self.step.findChild(ConfusionMatrix, "tryMatrix")

    @property
    def answer(self) -> Answer:
        return self.step.findChild(AnswerMark).answer

    def press(self) -> None:
        assert self.button.isEnabled()
        self.qtbot.mouseClick(self.button, Qt.MouseButton.LeftButton)
        self.bench.run(0.05)
        self.see()


@pytest.fixture
def desk(qtbot, tmp_path) -> Desk:
    bench = Bench(tmp_path)
    bench.desk.open(PERSON)
    shutil.copy(DEMO_MODEL, model_path(tmp_path, PERSON))
    yield Desk(qtbot, bench)
    bench.desk.close()


def tried(n: int):
    return lambda picture: picture.trying.n_done >= n


def test_before_it_begins_nothing_is_asked(desk):
    assert desk.button.text() == "Start"
    assert desk.text("tryAsked") == ""
    assert desk.matrix.evaluation is None
    assert not desk.step.findChild(QWidget, "tryProgress").isVisible()


def test_it_asks_for_a_gesture_in_large_letters_with_its_drawing(desk):
    desk.press()
    desk.run_until(lambda picture: bool(picture.trying.asked))
    asked = desk.bench.picture.trying.asked
    label = desk.step.findChild(QLabel, "tryAsked")
    assert label.text() == asked
    assert label.font().pixelSize() >= 60
    assert desk.step.findChild(GestureDrawing).label == asked
    assert desk.button.text() == "Stop"


def test_what_was_heard_is_counted_and_said(desk):
    desk.press()
    desk.run_until(tried(5))
    trying = desk.bench.picture.trying
    assert desk.step.findChild(QProgressBar, "tryProgress").text() == "5 of 60"
    assert desk.matrix.evaluation.n == 5
    right = int(np.trace(desk.matrix.evaluation.confusion))
    assert desk.text("tryFigure") == f"Recognised: {100 * right / 5:.0f} % of 5"
    assert desk.text("tryMeaning").startswith("So far.")
    assert (desk.answer is Answer.RIGHT) is trying.was_right


def test_it_can_be_stopped_and_what_was_counted_stays_in_sight(desk):
    desk.press()
    desk.run_until(tried(3))
    desk.press()
    assert desk.button.text() == "Try again"
    assert desk.text("tryAsked") == ""
    assert desk.matrix.evaluation.n == 3


def test_at_the_end_it_says_that_this_is_the_figure(desk):
    desk.controls.most = 1
    desk.press()
    desk.run_until(tried(12))
    assert desk.text("tryFigure").endswith("% of 12")
    assert desk.text("tryMeaning") == "This is the figure that Operate shows, with its count."
    assert desk.button.text() == "Try again"


@pytest.mark.parametrize(
    ("heard", "was_right", "answer", "words"),
    [
        ("Z+", True, Answer.RIGHT, "Z+: right"),
        ("Y-", False, Answer.WRONG, "Z+: wrong, heard Y-"),
        ("not recognised", False, Answer.NOT_RECOGNISED, "Z+: not recognised"),
        ("", False, Answer.NONE, ""),
    ],
)
def test_the_sign_and_the_words_say_the_same(desk, heard, was_right, answer, words):
    trying = Trying(
        is_on=True, asked="X-", heard=heard, was_right=was_right, reason="why", answered="Z+"
    )
    desk.step.show_snapshot(GuidedSnapshot(person=PERSON, trying=trying))
    assert desk.answer is answer
    assert desk.text("tryHeard") == words
    desk.step.grab()


def test_without_a_model_or_a_person_it_cannot_begin_and_says_why(desk):
    desk.trainer.shown = TrainingView()
    desk.see()
    assert not desk.button.isEnabled()
    assert desk.text("tryText") == "There is no model yet: train one first."
    desk.bench.desk.close()
    desk.bench.run(0.05)
    desk.see()
    assert desk.text("tryText") == "Choose a person first."


def test_what_was_done_as_asked_becomes_a_take_with_a_click(desk):
    desk.press()
    desk.run_until(lambda picture: picture.heard.can_keep)
    label = desk.bench.picture.heard.label
    button = desk.step.findChild(QPushButton, "keepTried")
    assert button.isVisible()
    assert button.accessibleName().endswith(f"keep it as a take of {label}")

    desk.qtbot.mouseClick(button, Qt.MouseButton.LeftButton)
    desk.bench.tick()
    desk.see()

    assert [take.label for take in desk.bench.desk.takes] == [label]
    assert not button.isVisible()
    assert desk.text("keepTriedWords").startswith(f"Kept as a take of {label}")
