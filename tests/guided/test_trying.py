"""A live test: gestures are asked for at random, what the model hears is counted."""

import random
from collections import Counter
from dataclasses import replace
from pathlib import Path

import pytest

from gestureapp.gestures import LABELS
from gestureapp.guided.arms import News
from gestureapp.guided.trying import PATIENCE_S, SHOWN_S, LiveTest
from gestureapp.guided.values import Phase
from gestureapp.recognition.model_file import load_model, save_model
from gestureapp.recognition.values import Recognition
from gestureapp.recording.people import make_person_folder, model_path
from gestureapp.sensing.values import ArmPosture, Side

DEMO_MODEL = Path(__file__).parents[2] / "resources" / "demo" / "model.json"


class Parrot:
    """A recogniser of any kind: says what it is told to, with the first sample."""

    labels = ("X+", "X-")

    def __init__(self) -> None:
        self.says: str | None = "X+"
        self.activation: tuple[int, float] | None = None

    def activate(self, activation_id, t_s):
        self.activation = (activation_id, t_s)

    def cancel(self):
        self.activation = None

    def feed(self, t_s, accel_g):
        if self.activation is None or t_s < self.activation[1]:
            return None
        activation_id, activation_s = self.activation
        self.activation = None
        reason = "" if self.says else "no clear gesture"
        return Recognition(activation_id, self.says, reason, (), activation_s, t_s, t_s)

    def check(self, t_s):
        return None


class Trial:
    """A live test with the time and the arms in the hand."""

    def __init__(self, per_gesture=2, posture=ArmPosture.STOP) -> None:
        self.parrot = Parrot()
        self.now_s = 100.0
        chance = random.Random(1)
        self.test = LiveTest(self.parrot, Parrot.labels, per_gesture, 100.0, posture, chance)

    def tick(self, *postures, lost=None, step_s=0.01):
        self.now_s += step_s
        changes = tuple((self.now_s - 0.001, posture) for posture in postures)
        self.test.step(self.now_s, News(changes, ((self.now_s, 0.0, 0.0, 1.0),)), lost)
        return self.test.view

    def answer(self, says) -> None:
        """Wait until something is asked for, and let it be heard as this."""
        if not self.test.view.asked:
            self.tick(ArmPosture.STOP, step_s=SHOWN_S + 0.1)
        self.parrot.says = says
        self.tick(ArmPosture.START)


def test_what_is_asked_and_heard_is_counted():
    trial = Trial()
    trial.tick()
    asked = trial.test.view.asked
    assert asked in Parrot.labels
    trial.answer(asked)
    view = trial.test.view
    assert (view.asked, view.heard, view.was_right, view.n_done) == ("", asked, True, 1)
    trial.answer("X+" if asked == "X-" else "X-")
    assert trial.test.view.n_done == 2
    trial.answer(None)
    assert (trial.test.view.heard, trial.test.view.reason) == ("not recognised", "no clear gesture")
    assert not trial.test.view.was_right
    trial.answer("X+")

    view = trial.test.view
    assert (view.n_done, view.n_planned, view.is_on) == (4, 4, False)
    assert view.text == "All 4 of 4 gestures tried."
    assert view.live is not None
    assert view.live.is_over
    evaluation = view.live.evaluation
    assert evaluation.n == 4
    assert evaluation.confusion.sum(axis=1).tolist() == [2, 2]
    assert int(evaluation.confusion[:, -1].sum()) == 1
    assert evaluation.decision_ms[0] == pytest.approx(1.0, abs=0.01)


def test_every_gesture_is_asked_for_as_often_in_an_order_of_chance():
    orders = []
    for seed in range(3):
        parrot = Parrot()
        test = LiveTest(parrot, LABELS, 5, 0.0, ArmPosture.STOP, random.Random(seed))
        orders.append(tuple(test._open))
        assert set(Counter(test._open).values()) == {5}
    assert len(set(orders)) == 3
    assert orders[0] != tuple(sorted(orders[0]))


def test_without_an_activation_it_asks_again_and_counts_nothing():
    trial = Trial()
    trial.tick()
    asked = trial.test.view.asked
    trial.tick(step_s=PATIENCE_S - 0.1)
    assert "No activation" not in trial.test.view.text
    trial.tick(step_s=0.2)
    assert trial.test.view.text.startswith(f"No activation within 8 s. {asked}: ")
    assert (trial.test.view.asked, trial.test.view.n_done) == (asked, 0)
    trial.answer(asked)
    assert trial.test.view.n_done == 1


def test_nothing_is_asked_before_the_left_arm_is_down():
    trial = Trial(posture=ArmPosture.START)
    trial.tick(step_s=5.0)
    assert (trial.test.view.asked, trial.test.view.text) == (
        "",
        "Bring the left arm to the stop posture.",
    )
    trial.tick(ArmPosture.START)
    assert trial.test.view.n_done == 0
    trial.tick(ArmPosture.STOP)
    assert trial.test.view.asked


def test_a_lost_sensor_interrupts_and_the_gesture_is_asked_for_again():
    trial = Trial()
    trial.tick()
    asked = trial.test.view.asked
    trial.tick(lost=Side.LEFT)
    view = trial.test.view
    assert view.asked == ""
    assert view.text.startswith("Left sensor lost; 0 tried.")
    trial.tick(ArmPosture.START, lost=Side.LEFT)
    assert trial.test.view.n_done == 0
    trial.tick(ArmPosture.STOP)
    assert trial.test.view.asked == asked


def test_ending_early_keeps_what_was_counted():
    trial = Trial()
    trial.tick()
    trial.answer("X+")
    trial.test.stop()
    view = trial.test.view
    assert (view.is_on, view.n_done, view.text) == (False, 1, "Ended: 1 of 4 gestures tried.")
    assert view.live is not None
    assert not view.live.is_over


@pytest.fixture
def trained(bench, tmp_path):
    """A person with the model of the demonstration."""
    make_person_folder(tmp_path, "Ana")
    save_model(model_path(tmp_path, "Ana"), replace(load_model(DEMO_MODEL), live=None))
    bench.desk.open("Ana")
    return bench


def test_a_person_tries_the_model_and_its_live_figure_stays_with_it(trained, tmp_path):
    trained.desk.start_trying(1)
    trained.run_until(lambda picture: picture.trying.n_planned == 12)
    trained.run_until(lambda picture: not picture.trying.is_on)

    live = trained.picture.trying.live
    assert live is not None
    assert live.is_over
    assert live.evaluation.n == 12
    kept = load_model(model_path(tmp_path, "Ana")).live
    assert kept is not None
    assert kept.n == 12
    assert kept.recognised == int(live.evaluation.confusion.trace())
    assert kept.recognised >= 8
    assert kept.when.startswith("2027-01-15")


def test_a_stopped_test_writes_nothing(trained, tmp_path):
    trained.desk.start_trying(1)
    trained.run_until(lambda picture: picture.trying.n_done == 2)
    trained.desk.stop_trying()
    trained.tick()
    assert trained.picture.trying.live is not None
    assert load_model(model_path(tmp_path, "Ana")).live is None


def test_a_model_that_was_trained_anew_does_not_get_the_figure_of_the_old_one(trained, tmp_path):
    trained.desk.start_trying(1)
    trained.run_until(lambda picture: picture.trying.n_done == 11)
    path = model_path(tmp_path, "Ana")
    save_model(path, replace(load_model(path), created="later"))
    trained.run_until(lambda picture: not picture.trying.is_on)
    assert "trained anew while it was tried" in trained.picture.trying.text
    assert load_model(path).live is None


def test_without_a_model_it_says_what_to_do(bench):
    bench.desk.start_trying(1)
    bench.tick()
    assert not bench.picture.trying.is_on
    bench.desk.open("Bob")
    bench.desk.start_trying(1)
    bench.tick()
    assert bench.picture.trying.text == "There is no model yet: train one first."


def test_a_damaged_model_is_told_in_one_line(bench, tmp_path):
    bench.desk.open("Bob")
    model_path(tmp_path, "Bob").write_text("{")
    bench.desk.start_trying(1)
    bench.tick()
    assert "is not a readable model file" in bench.picture.trying.text
    assert "\n" not in bench.picture.trying.text


def test_recording_and_trying_end_each_other(trained):
    trained.desk.start()
    trained.run(1.0)
    trained.desk.start_trying(1)
    trained.tick()
    assert trained.picture.phase is Phase.IDLE
    assert trained.picture.trying.is_on
    trained.desk.start()
    trained.tick()
    assert trained.picture.phase is Phase.COUNT_IN
    assert not trained.picture.trying.is_on
    assert trained.desk.takes == ()
