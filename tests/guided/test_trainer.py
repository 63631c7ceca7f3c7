"""The trainer with real child processes: a model of the takes that count, or a reason why not."""

import sys
import time
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import pytest

from gestureapp.clock import monotonic
from gestureapp.guided.trained import GESTURES_CHANGED, TAKES_CHANGED, find_own_model
from gestureapp.guided.trainer import Trainer
from gestureapp.guided.values import GuidedSnapshot, TrainingPhase
from gestureapp.recognition.model_file import LiveFigure, load_model, with_live
from gestureapp.recognition.presets import Preset
from gestureapp.recording.people import make_person_folder, model_path
from gestureapp.recording.take_store import NewTake, TakeStore
from gestureapp.recording.take_values import Judgement, Take, Verdict

LIMIT_S = 60.0
GOOD = Judgement(Verdict.GOOD, "")
PUSHES = {"X+": (0, 1.0), "X-": (0, -1.0), "Y+": (1, 1.0)}

pytestmark = pytest.mark.process


@dataclass
class OpenTakes:
    """A person whose takes are open; the store's own values, without the recording around it."""

    person: str = "Ana"
    version: int = 1
    all: list[Take] = field(default_factory=list)

    def snapshot(self) -> GuidedSnapshot:
        return GuidedSnapshot(person=self.person, version=self.version)

    def takes(self, label: str = "") -> tuple[Take, ...]:
        return tuple(self.all)

    def change(self, number: int, **what: object) -> None:
        self.all[number] = replace(self.all[number], **what)
        self.version += 1


def record(store: TakeStore, per_gesture: int) -> None:
    """Takes that differ by a strong push along one axis."""
    rng = np.random.default_rng(3)
    times_s = np.arange(-50, 100) * 0.01 + 0.004
    for number in range(per_gesture):
        for label, (axis, push_g) in PUSHES.items():
            accel_g = rng.normal([0.0, 0.0, 1.0], 0.03, (150, 3))
            accel_g[49:60, axis] += push_g
            store.add(NewTake(label, f"day {number % 2}", 1e9 + number, GOOD, times_s, accel_g))


@pytest.fixture
def source(tmp_path: Path):
    store = TakeStore(tmp_path, "Ana")
    record(store, 12)
    source = OpenTakes(all=list(store.takes()))
    store.close()
    return source


@pytest.fixture
def make_trainer(tmp_path: Path, source: OpenTakes):
    """Makes started trainers and ends them; what they tell the cell is in ``used``."""
    made = []

    def make(**options: object) -> Trainer:
        used: list[tuple[Path | None, str, str]] = []
        trainer = Trainer(source, tmp_path, lambda *told: used.append(told), **options)
        trainer.used = used
        made.append(trainer)
        trainer.start_thread()
        return trainer

    yield make
    for trainer in made:
        trainer.shutdown()


@pytest.fixture
def until():
    """Looks again until it is so; returns whether it was, within the limit."""

    def wait(is_so, limit_s: float = 10.0) -> bool:
        deadline_s = monotonic() + limit_s
        while not is_so():
            if monotonic() > deadline_s:
                return False
            time.sleep(0.01)
        return True

    return wait


@pytest.fixture
def ended(until):
    def wait(trainer: Trainer):
        over = (TrainingPhase.DONE, TrainingPhase.FAILED, TrainingPhase.CANCELLED)
        assert until(lambda: trainer.view().phase in over, LIMIT_S), trainer.view()
        return trainer.view()

    return wait


def test_a_training_ends_with_a_model_for_the_person_and_its_figures(
    make_trainer, ended, until, tmp_path
):
    trainer = make_trainer()
    trainer.start(seed=2)
    assert trainer.view().phase is TrainingPhase.RUNNING
    assert until(lambda: trainer.view().losses, LIMIT_S)
    view = ended(trainer)

    path = model_path(tmp_path, "Ana")
    model = load_model(path)
    assert (view.phase, view.out_of_date, view.done) == (TrainingPhase.DONE, "", 1.0)
    assert view.text.startswith("Ana's model is trained; it took ")
    assert view.result.folds == "by session: 2 sessions"
    assert view.result.evaluation.n == 36
    assert view.result.words[0].startswith("Good. Of 36 takes 100 % are recognised")
    assert ("takes", "36") in view.result.facts
    assert (model.person, model.labels) == ("Ana", ("X+", "X-", "Y+"))
    assert model.training.takes_from == "36 takes of Ana in 2 sittings"
    assert model.training.duration_s == view.result.duration_s > 0.0
    assert trainer.used[-1] == (path, "", "Ana")


def test_the_result_is_there_after_a_restart_and_changed_takes_put_it_out_of_date(
    make_trainer, ended, until, source, tmp_path
):
    first = make_trainer()
    first.start()
    result = ended(first).result
    first.shutdown()

    again = make_trainer()
    assert until(lambda: again.view().result is not None)
    assert again.view().result.words == result.words
    assert again.view().result.evaluation.as_json() == result.evaluation.as_json()

    path = model_path(tmp_path, "Ana")
    source.change(3, is_excluded=True)
    assert until(lambda: again.view().out_of_date == TAKES_CHANGED)
    assert until(lambda: again.used[-1] == (path, TAKES_CHANGED, "Ana"))

    source.change(3, is_excluded=False)
    assert until(lambda: again.view().out_of_date == "")
    assert until(lambda: again.used[-1] == (path, "", "Ana"))

    for number, take in enumerate(source.all):
        if take.label == "Y+":
            source.change(number, is_excluded=True)
    assert until(lambda: again.view().out_of_date == GESTURES_CHANGED)


def test_at_the_start_a_persons_own_model_is_found_and_checked(make_trainer, ended, tmp_path):
    assert find_own_model(tmp_path, "Ana") is None
    assert find_own_model(tmp_path, "") is None
    trainer = make_trainer()
    trainer.start()
    ended(trainer)

    assert find_own_model(tmp_path, "Ana") == (model_path(tmp_path, "Ana"), "")

    store = TakeStore(tmp_path, "Ana")
    store.delete(1)
    store.close()
    assert find_own_model(tmp_path, "Ana") == (model_path(tmp_path, "Ana"), TAKES_CHANGED)


def test_a_live_figure_written_beside_reaches_the_cell(make_trainer, ended, until, tmp_path):
    trainer = make_trainer()
    trainer.start()
    ended(trainer)
    told = len(trainer.used)

    with_live(model_path(tmp_path, "Ana"), LiveFigure(5, 5, 0, 0, "2026-01-02T00:00:00+00:00"))

    assert until(lambda: len(trainer.used) > told)


def test_cancelling_ends_the_child_and_keeps_the_model_there_was(
    make_trainer, ended, until, tmp_path
):
    trainer = make_trainer()
    trainer.start()
    ended(trainer)
    before = model_path(tmp_path, "Ana").read_bytes()

    trainer.start(Preset.PAPER)
    assert until(lambda: trainer.view().losses, LIMIT_S)
    trainer.cancel()
    begun_s = monotonic()
    view = ended(trainer)

    assert monotonic() - begun_s < 5.0  # a paper training takes ten seconds and more
    assert view.phase is TrainingPhase.CANCELLED
    assert view.text == "cancelled; the model there was is kept"
    assert view.result is not None
    assert model_path(tmp_path, "Ana").read_bytes() == before


def test_a_training_cancelled_at_once_or_shut_down_leaves_no_model(make_trainer, ended, tmp_path):
    trainer = make_trainer()
    trainer.start()
    trainer.cancel()
    assert ended(trainer).phase is TrainingPhase.CANCELLED

    trainer.start(Preset.PAPER)
    trainer.shutdown()
    assert not model_path(tmp_path, "Ana").exists()


@pytest.mark.parametrize(
    ("command", "words"),
    [
        ("pass", "ended without a word: train again"),
        ("print('rubbish'); print('[1, 2]')", "ended without a word: train again"),
        ('print(\'{"failed": "no room"}\')', "no room"),
    ],
)
def test_a_child_that_fails_is_told_in_words(make_trainer, ended, command, words):
    trainer = make_trainer(command=[sys.executable, "-c", command])
    trainer.start()
    view = ended(trainer)

    assert view.phase is TrainingPhase.FAILED
    assert view.text.endswith(words)


def test_too_few_takes_are_told_before_anything_is_started(make_trainer, ended, source):
    for number in range(8 * 3):
        source.change(number, is_excluded=True)
    trainer = make_trainer(command=["/nowhere"])
    trainer.start()

    assert "X+ has 4, X- has 4, Y+ has 4 good takes: at least 5" in ended(trainer).text

    source.person = ""
    trainer.start()
    assert "choose a person" in ended(trainer).text


def test_a_child_that_cannot_be_started_is_told(make_trainer, ended):
    trainer = make_trainer(command=["/nowhere/at/all"])
    trainer.start()

    assert "/nowhere/at/all" in ended(trainer).text


def test_a_damaged_model_is_told_and_another_person_has_none(make_trainer, until, source, tmp_path):
    make_person_folder(tmp_path, "Ana")
    model_path(tmp_path, "Ana").write_text("{}")
    trainer = make_trainer()

    assert until(lambda: "is not a model" in trainer.view().text)
    ((path, problem, person),) = trainer.used
    assert (path, person) == (None, "Ana")
    assert "is not a model" in problem

    source.person = "Bea"
    assert until(lambda: trainer.view().text == "")
    assert trainer.used[-1] == (None, "", "Bea")
    assert trainer.view().result is None


def test_a_model_whose_file_goes_bad_or_away_while_it_is_used_is_no_model_any_more(
    make_trainer, ended, until, tmp_path
):
    trainer = make_trainer()
    trainer.start()
    ended(trainer)
    path = model_path(tmp_path, "Ana")
    assert until(lambda: trainer.used[-1] == (path, "", "Ana"))
    whole = path.read_bytes()

    path.write_bytes(whole[:100])
    assert until(lambda: trainer.used[-1][0] is None)
    assert "not a readable model file" in trainer.used[-1][1]
    path.write_bytes(whole)
    assert until(lambda: trainer.used[-1] == (path, "", "Ana"))
    path.unlink()
    assert until(lambda: trainer.used[-1] == (None, "", "Ana"))
