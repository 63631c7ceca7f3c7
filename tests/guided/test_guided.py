"""Guided training with its thread, through the surface that a window has."""

import itertools
import threading
from contextlib import closing

import pytest

from gestureapp.config import Settings
from gestureapp.errors import RecordingError
from gestureapp.guided.guided import Guided
from gestureapp.guided.values import Pace, Phase
from gestureapp.recording.take_store import TakeStore
from gestureapp.sensing.values import Connected, Sample, Side
from tests.cell.conftest import wait_until
from tests.guided.bench import SensedArms


class Ticking:
    """A clock of its own pace, that brings a sample of both arms with every look at it."""

    def __init__(self, arms: SensedArms) -> None:
        self.arms = arms
        self.now_s = 0.0
        self.lock = threading.Lock()
        self.numbers = itertools.count()
        for side in Side:
            arms.trackers[side].event(0.0, Connected("here"))

    def __call__(self) -> float:
        with self.lock:
            self.now_s += 0.02
            self.arms.now_s = self.now_s
            number = next(self.numbers)
            for side, store in ((Side.LEFT, self.arms.left), (Side.RIGHT, self.arms.right)):
                sample = Sample(self.now_s, number, (0.001 * (number % 2), 0.0, 1.0))
                store.append(sample)
                self.arms.trackers[side].sample(sample)
            return self.now_s


@pytest.fixture
def guided(tmp_path):
    arms = SensedArms(Settings())
    made = Guided(arms, tmp_path, Ticking(arms), lambda: 1.8e9)
    made.start_thread()
    yield made
    made.shutdown()


def is_so(guided: Guided, condition) -> bool:
    return wait_until(lambda: condition(guided.snapshot()))


def test_a_person_is_open_when_the_call_returns(guided):
    assert guided.snapshot().phase is Phase.CLOSED
    guided.open("Ana")
    assert (guided.snapshot().person, guided.snapshot().phase) == ("Ana", Phase.IDLE)
    assert guided.people() == ("Ana",)
    guided.close()
    guided.close()
    assert guided.snapshot().phase is Phase.CLOSED
    assert guided.takes() == ()


def test_takes_in_use_elsewhere_are_refused_to_the_caller(guided, tmp_path):
    with closing(TakeStore(tmp_path, "Ana")):
        with pytest.raises(RecordingError, match="in use by another gestureapp; close that one"):
            guided.open("Ana")
        assert guided.snapshot().phase is Phase.CLOSED
    guided.open("Ana")
    assert guided.snapshot().person == "Ana"


def test_every_wish_of_the_window_is_fulfilled(guided):
    guided.open("Ana")
    guided.set_wanted(5)
    guided.set_pace(Pace.RHYTHM, 1.2)
    guided.choose("RX-")
    guided.start()
    assert is_so(guided, lambda s: s.phase is Phase.COUNT_IN and s.label == "RX-")
    assert is_so(guided, lambda s: s.phase is Phase.WAITING or s.phase is Phase.TAKING)
    guided.pause()
    assert is_so(guided, lambda s: s.phase is Phase.PAUSED)
    guided.go_on()
    assert is_so(guided, lambda s: len(s.batch) == 1)
    guided.end_batch()
    assert is_so(guided, lambda s: s.phase is Phase.IDLE)
    picture = guided.snapshot()
    assert (picture.batch_size, picture.beat_s) == (5, 1.2)
    assert picture.progress[7].wanted == 5

    (take,) = guided.takes()
    assert guided.takes("RX-") == (take,)
    assert guided.takes("X+") == ()
    assert take.judgement.words == "no posture: the hand is level"
    guided.exclude(take.id)
    guided.move(take.id, "X+")
    assert is_so(guided, lambda s: s.undo == "move to X+ of take 1 of RX-")
    assert [(t.label, t.is_excluded) for t in guided.takes()] == [("X+", True)]
    guided.undo()
    guided.undo()
    guided.redo()
    assert is_so(guided, lambda s: s.redo == "move to X+ of take 1 of RX-")
    guided.delete(take.id)
    assert is_so(guided, lambda s: s.batch == ())
    guided.undo()
    assert is_so(guided, lambda s: len(s.batch) == 1)
    guided.redo_last()
    assert is_so(guided, lambda s: s.batch == () and s.redo == "")


def test_wishes_without_a_person_do_nothing(guided):
    guided.start()
    guided.undo()
    guided.redo_last()
    guided.start_trying()
    guided.stop_trying()
    guided.go_on()
    guided.choose("X+")
    guided.open("Ana")
    assert guided.snapshot().phase is Phase.IDLE


def test_trying_without_a_model_says_so(guided):
    guided.open("Ana")
    guided.start_trying()
    assert is_so(guided, lambda s: s.trying.text == "There is no model yet: train one first.")


def test_the_database_is_free_after_the_end(guided, tmp_path):
    guided.open("Ana")
    guided.shutdown()
    guided.shutdown()
    TakeStore(tmp_path, "Ana").close()
    guided.close()
    assert guided.snapshot().phase is Phase.CLOSED


@pytest.mark.logs_errors
def test_whoever_arms_is_told_that_the_thread_has_ended_by_an_error(tmp_path):
    arms, told = SensedArms(Settings()), []
    guided = Guided(arms, tmp_path, Ticking(arms), lambda: 1.8e9, told.append)
    guided.start_thread()
    guided.set_wanted("many")
    assert wait_until(lambda: told)
    assert "restart the application" in told[0]


@pytest.mark.logs_errors
def test_a_thread_that_has_ended_by_an_error_is_told(guided):
    guided.open("Ana")
    guided.set_wanted("many")
    assert is_so(guided, lambda s: "restart the application" in s.trouble)
    with pytest.raises(RecordingError, match="restart the application"):
        guided.open("Bob")
