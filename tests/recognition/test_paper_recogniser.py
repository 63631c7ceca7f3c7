from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gestureapp.recognition.model_file import Model, TrainingRecord
from gestureapp.recognition.network import Network
from gestureapp.recognition.paper import REST_G, SILENT_AFTER_S, PaperRecogniser, judge
from gestureapp.recognition.values import Candidate

LEVEL = (0.0, 0.0, 1.0)
RECORD = TrainingRecord("paper", "by hand", 0, 0.25, 0, 0, 0.0, 0.0)


def model_of(network, labels):
    return Model("paper", labels, network, "", RECORD, "", "", "")


def model_by_first_x():
    """Hears X+ when the first ax is above 0.5 g, X- when it is below -0.5 g; each by one neuron."""
    hidden = np.zeros((2, 9))
    hidden[0, 0], hidden[1, 0] = 40.0, -40.0
    output = np.array([[20.0, 0.0], [0.0, 20.0]])
    network = Network(hidden, np.array([-20.0, -20.0]), output, np.array([-10.0, -10.0]))
    return model_of(network, ("X+", "X-"))


def model_with_outputs(*values):
    """Gives these outputs whatever it sees."""
    bias = np.log(np.array(values) / (1.0 - np.array(values)))
    network = Network(np.zeros((1, 9)), np.zeros(1), np.zeros((len(values), 1)), bias)
    return model_of(network, tuple(f"g{k}" for k in range(len(values))))


def feed_all(recogniser, samples, start_s=0.0, step_s=0.01):
    answers = [recogniser.feed(start_s + k * step_s, sample) for k, sample in enumerate(samples)]
    return [answer for answer in answers if answer is not None]


def test_the_third_sample_from_the_activation_brings_the_answer():
    recogniser = PaperRecogniser(model_by_first_x())
    assert feed_all(recogniser, [LEVEL] * 5) == []
    recogniser.activate(7, 0.045)

    assert recogniser.feed(0.05, (0.9, 0.0, 1.0)) is None
    assert recogniser.feed(0.06, (0.9, 0.0, 1.0)) is None
    answer = recogniser.feed(0.07, (0.9, 0.0, 1.0))

    assert answer is not None
    assert (answer.activation_id, answer.label, answer.reason) == (7, "X+", "")
    assert (answer.window_start_s, answer.window_end_s) == (0.05, 0.07)
    assert answer.decided_s == 0.07
    assert [c.label for c in answer.outputs] == ["X+", "X-"]


def test_a_sample_before_the_activation_is_not_used():
    recogniser = PaperRecogniser(model_by_first_x())
    recogniser.activate(1, 1.0)

    answers = feed_all(recogniser, [(-2.0, 0, 1), (0.9, 0, 1), (0, 0, 1), (0, 0, 1)], start_s=0.99)

    assert [answer.label for answer in answers] == ["X+"]


def test_a_sample_at_the_very_time_of_the_activation_is_the_first():
    recogniser = PaperRecogniser(model_by_first_x())
    recogniser.activate(1, 1.0)

    answers = feed_all(recogniser, [(0.9, 0, 1), (0, 0, 1), (0, 0, 1)], start_s=1.0)

    assert [answer.window_start_s for answer in answers] == [1.0]


def test_samples_that_overtook_the_activation_still_count():
    recogniser = PaperRecogniser(model_by_first_x())
    assert feed_all(recogniser, [LEVEL, (0.9, 0, 1), (0, 0, 1)], start_s=0.99) == []

    recogniser.activate(1, 1.0)
    answer = recogniser.feed(1.02, (0, 0, 1))

    assert answer is not None
    assert (answer.label, answer.window_start_s) == ("X+", 1.0)


def test_one_activation_is_answered_once():
    recogniser = PaperRecogniser(model_by_first_x())
    recogniser.activate(1, 0.0)

    assert len(feed_all(recogniser, [(0.9, 0, 1)] * 50)) == 1
    assert recogniser.check(10.0) is None


def test_a_cancelled_activation_is_never_answered():
    recogniser = PaperRecogniser(model_by_first_x())
    recogniser.activate(1, 0.0)
    recogniser.feed(0.0, (0.9, 0, 1))
    recogniser.cancel()

    assert feed_all(recogniser, [(0.9, 0, 1)] * 5, start_s=0.01) == []
    assert recogniser.check(10.0) is None


def test_a_new_activation_replaces_an_open_one():
    recogniser = PaperRecogniser(model_by_first_x())
    recogniser.activate(1, 0.0)
    recogniser.feed(0.0, (0.9, 0, 1))
    recogniser.activate(2, 0.005)

    answers = feed_all(recogniser, [(-0.9, 0, 1)] * 3, start_s=0.01)

    assert [(a.activation_id, a.label) for a in answers] == [(2, "X-")]


def test_silence_is_named_once_the_time_is_over_and_not_before():
    recogniser = PaperRecogniser(model_by_first_x())
    recogniser.activate(3, 1.0)
    recogniser.feed(1.0, (0.9, 0, 1))

    assert recogniser.check(1.0 + SILENT_AFTER_S) is None
    answer = recogniser.check(1.001 + SILENT_AFTER_S)

    assert answer is not None
    assert (answer.activation_id, answer.label) == (3, None)
    assert answer.reason == "right arm silent"
    assert answer.outputs == ()


def test_a_third_sample_that_comes_too_late_is_no_gesture():
    recogniser = PaperRecogniser(model_by_first_x())
    recogniser.activate(1, 0.0)

    answers = feed_all(recogniser, [(0.9, 0, 1)] * 3, step_s=0.2)

    assert [(a.label, a.reason) for a in answers] == [(None, "right arm silent")]


def test_a_resting_hand_is_no_gesture_whatever_the_network_says():
    recogniser = PaperRecogniser(model_with_outputs(0.99, 0.01))
    recogniser.activate(1, 0.0)

    (answer,) = feed_all(recogniser, [(0.0, 0.0, 1.0 + 0.9 * REST_G)] * 3)

    assert answer.label is None
    assert answer.reason == "no movement of the right arm"
    assert answer.outputs[0].confidence == pytest.approx(0.99)


def test_one_sample_that_moves_is_enough_to_ask_the_network():
    recogniser = PaperRecogniser(model_with_outputs(0.99, 0.01))
    recogniser.activate(1, 0.0)

    (answer,) = feed_all(recogniser, [LEVEL, LEVEL, (1.1 * REST_G, 0.0, 1.0)])

    assert answer.label == "g0"


@pytest.mark.parametrize("bad", [float("nan"), float("inf"), float("-inf")])
@pytest.mark.parametrize("place", [0, 1, 2])
def test_a_reading_that_is_not_a_number_never_gives_a_gesture(bad, place):
    recogniser = PaperRecogniser(model_with_outputs(0.99, 0.01))
    recogniser.activate(1, 0.0)
    samples = [(0.9, 0.0, 1.0)] * 3
    samples[place] = (0.9, bad, 1.0)

    (answer,) = feed_all(recogniser, samples)

    assert (answer.label, answer.reason) == (None, "a reading of the right arm is not a number")


def candidates(*values):
    return tuple(Candidate(f"g{k}", value) for k, value in enumerate(values))


def test_exactly_half_is_recognised_and_just_under_is_not():
    assert judge(candidates(0.1, 0.5)) == ("g1", "")
    assert judge(candidates(0.1, 0.4999)) == (None, "no clear gesture (g1 0.49, g0 0.10)")


def test_two_at_once_are_two_candidates():
    assert judge(candidates(0.7, 0.1, 0.93)) == (None, "two candidates (g2 0.93, g0 0.70)")


def test_a_model_with_one_gesture_is_judged_too():
    assert judge(candidates(0.2)) == (None, "no clear gesture (g0 0.20)")


@given(st.lists(st.floats(0.0, 1.0), min_size=1, max_size=12))
def test_a_label_is_given_exactly_when_one_output_reaches_half(values):
    label, reason = judge(candidates(*values))

    reached = [k for k, value in enumerate(values) if value >= 0.5]
    assert (label is not None) == (len(reached) == 1)
    assert (label is None) == bool(reason)
    if label is not None:
        assert label == f"g{reached[0]}"


def test_a_model_of_another_kind_or_window_is_refused():
    with pytest.raises(ValueError, match="not for the paper's recogniser"):
        PaperRecogniser(replace(model_by_first_x(), kind="onset"))
    network = Network(np.zeros((1, 6)), np.zeros(1), np.zeros((2, 1)), np.zeros(2))
    with pytest.raises(ValueError, match="not for the paper's recogniser"):
        PaperRecogniser(model_of(network, ("X+", "X-")))
