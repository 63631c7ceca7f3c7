from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gestureapp.gestures import LABELS
from gestureapp.recognition.decision import Decision, judge_early, judge_last
from gestureapp.recognition.ensemble import Ensemble, Layer
from gestureapp.recognition.kinds import recogniser_for
from gestureapp.recognition.model_file import Model, TrainingRecord
from gestureapp.recognition.network import Network
from gestureapp.recognition.onset import GIVE_UP_S, MIN_ELAPSED_S, OnsetRecogniser
from gestureapp.recognition.paper import PaperRecogniser
from gestureapp.recognition.values import NO_GESTURE, SILENT_AFTER_S, Candidate
from gestureapp.recognition.window import INPUT_ONSET, N_CELLS, N_INPUTS
from gestureapp.simulation.arm import RightArm
from gestureapp.simulation.people import practised_person

LEVEL = (0.0, 0.0, 1.0)
DIRECTIONS = ("X+", "X-", "Y+", "Y-", "Z+", "Z-")
POSTURES = ("RX+", "RX-", "RY+", "RY-")
SPEED_AT, NOW_AT = 7 * N_CELLS, 7 * N_CELLS + 16
RECORD = TrainingRecord("onset", "by hand", 0, 0.25, 0, 0, 0.0, 0.0)


def model_by_hand(sure=1.0, decision=None):
    """Knows a push by the change of velocity and a posture by the reading now; else it is none.

    Args:
        sure: Below 1 it stays in doubt.
        decision: Thresholds.
    """
    labels = (*DIRECTIONS, *POSTURES)
    weights, bias = np.zeros((1, N_INPUTS, len(labels) + 1)), np.zeros((1, len(labels) + 1))
    for k in range(6):
        weights[0, SPEED_AT + k // 2, k] = 40.0 if k % 2 == 0 else -40.0
    for k, (axis, sign) in enumerate([(1, 1.0), (1, -1.0), (0, 1.0), (0, -1.0)]):
        weights[0, NOW_AT + axis, 6 + k] = 30.0 * sign
        weights[0, NOW_AT + 2, 6 + k] = -30.0
    bias[0, -1] = 5.0
    network = Ensemble(
        np.zeros((1, N_INPUTS)),
        np.ones((1, N_INPUTS)),
        (Layer(sure * weights, sure * bias),),
    )
    return Model(
        "onset",
        labels,
        network,
        "",
        RECORD,
        "",
        "",
        "",
        INPUT_ONSET,
        decision=decision or Decision(),
    )


def model_with_outputs(*shares):
    """Gives these shares for g0, g1 … and at last for none of them, whatever it sees."""
    n = len(shares)
    network = Ensemble(
        np.zeros((1, N_INPUTS)),
        np.ones((1, N_INPUTS)),
        (Layer(np.zeros((1, N_INPUTS, n)), np.log(np.array([shares]))),),
    )
    labels = tuple(f"g{k}" for k in range(n - 1))
    return Model("onset", labels, network, "", RECORD, "", "", "", decision=Decision())


def push_at(t_s, begin_s, direction=(0.8, 0.0, 0.0), length_s=0.3):
    """A movement and its braking; before and after it a level hand."""
    share = (t_s - begin_s) / length_s
    size = np.sin(2 * np.pi * share) if 0.0 <= share <= 1.0 else 0.0
    return tuple(float(r + size * d) for r, d in zip(LEVEL, direction, strict=True))


def hear(recogniser, reading_at, activation_s, times_s, late_s=0.0):
    """Feed what is read at these times; the answers. The activation is told so much too late."""
    answers, told = [], False
    for t_s in times_s:
        if not told and t_s >= activation_s + late_s:
            recogniser.activate(1, activation_s)
            told = True
        answers.append(recogniser.feed(float(t_s), reading_at(float(t_s))))
    return [answer for answer in answers if answer is not None]


def steps(rate_hz=100.0, length_s=2.5):
    return np.arange(round(length_s * rate_hz)) / rate_hz


@pytest.mark.parametrize("rate_hz", [50.0, 100.0, 200.0])
@pytest.mark.parametrize("lead_s", [-0.1, -0.03, 0.0, 0.05, 0.4])
@pytest.mark.parametrize("label", DIRECTIONS)
def test_a_push_is_heard_at_every_rate_whichever_arm_is_first(label, lead_s, rate_hz):
    direction = np.zeros(3)
    direction["XYZ".index(label[0])] = 0.8 if label[1] == "+" else -0.8
    begin_s = 0.6 + lead_s
    recogniser = OnsetRecogniser(model_by_hand())

    (answer,) = hear(recogniser, lambda t: push_at(t, begin_s, direction), 0.6, steps(rate_hz))

    assert (answer.label, answer.reason) == (label, "")
    assert answer.onset_s == pytest.approx(begin_s, abs=0.02)
    assert answer.window_start_s == answer.onset_s
    assert answer.window_end_s == answer.decided_s
    assert answer.decided_s <= max(begin_s, 0.6) + 0.16
    assert answer.decided_s >= answer.onset_s + MIN_ELAPSED_S
    assert answer.outputs[-1].label == NO_GESTURE


@pytest.mark.parametrize(
    ("label", "held"),
    [("RX+", (0, 1, 0)), ("RX-", (0, -1, 0)), ("RY+", (1, 0, 0)), ("RY-", (-1, 0, 0))],
)
def test_a_held_posture_is_answered_with_the_first_sample_after_the_activation(label, held):
    recogniser = OnsetRecogniser(model_by_hand())

    (answer,) = hear(recogniser, lambda _t: held, 0.605, steps())

    assert (answer.label, answer.decided_s) == (label, pytest.approx(0.61))
    assert answer.onset_s is None
    assert answer.window_start_s == pytest.approx(0.61 - 0.045)


def test_a_movement_that_begins_with_the_stream_is_heard_too():
    recogniser = OnsetRecogniser(model_by_hand())

    (answer,) = hear(recogniser, lambda t: push_at(t, -0.02, (2.0, 0.0, 0.0)), 0.0, steps())

    assert answer.label == "X+"


def test_a_resting_hand_is_no_movement_once_the_time_is_over():
    recogniser = OnsetRecogniser(model_by_hand())

    (answer,) = hear(recogniser, lambda _t: LEVEL, 0.5, steps())

    assert (answer.label, answer.reason) == (None, "no movement of the right arm")
    assert answer.outputs == ()
    assert answer.decided_s == pytest.approx(0.5 + GIVE_UP_S, abs=0.011)


def test_a_movement_that_began_long_before_is_not_taken_for_the_gesture():
    recogniser = OnsetRecogniser(model_by_hand())
    shaken = lambda t: push_at(t % 0.3, 0.0)  # noqa: E731

    (answer,) = hear(recogniser, shaken, 0.8, steps(length_s=3.0))

    assert (answer.label, answer.reason) == (
        None,
        "the right arm was moving before the activation",
    )


def test_a_model_in_doubt_answers_when_the_budget_is_over():
    decision = Decision(early=0.9999, last=0.5)
    recogniser = OnsetRecogniser(model_by_hand(sure=0.1, decision=decision))

    (answer,) = hear(recogniser, lambda t: push_at(t, 0.6), 0.6, steps())

    assert answer.label == "X+"
    assert 0.14 < answer.decided_s - answer.onset_s <= 0.16
    assert answer.thresholds == (0.9999, 0.5)


@pytest.mark.parametrize(
    ("shares", "words"),
    [
        ((0.48, 0.41, 0.11), "two candidates (g0 0.48, g1 0.41)"),
        ((0.555, 0.20, 0.245), "not sure (g0 0.55, g1 0.20)"),
        ((0.03, 0.01, 0.96), "nothing I know (none 0.96)"),
    ],
)
def test_the_reason_says_why_nothing_was_recognised(shares, words):
    recogniser = OnsetRecogniser(model_with_outputs(*shares))

    (answer,) = hear(recogniser, lambda t: push_at(t, 0.6), 0.6, steps())

    assert (answer.label, answer.reason) == (None, words)


def test_the_budget_ends_also_when_no_sample_tells():
    recogniser = OnsetRecogniser(model_with_outputs(0.7, 0.1, 0.2))
    assert hear(recogniser, lambda t: push_at(t, 0.6), 0.6, steps(length_s=0.73)) == []

    assert recogniser.check(0.76) is None
    answer = recogniser.check(0.77)

    assert (answer.label, answer.decided_s) == ("g0", 0.77)
    assert recogniser.check(5.0) is None


@pytest.mark.parametrize("last_s", [0.55, 0.66])
def test_an_arm_that_falls_silent_is_never_guessed_from_what_came_before(last_s):
    recogniser = OnsetRecogniser(model_with_outputs(0.7, 0.1, 0.2))
    assert hear(recogniser, lambda t: push_at(t, 0.6), 0.52, steps(length_s=last_s)) == []

    answers = [recogniser.check(last_s + 0.01 * k) for k in range(60)]

    (answer,) = [answer for answer in answers if answer is not None]
    assert (answer.label, answer.reason) == (None, "right arm silent")
    assert answer.decided_s <= last_s + SILENT_AFTER_S + 0.011


@pytest.mark.parametrize("bad", [float("nan"), float("inf"), 1e308, -101.0])
def test_a_reading_that_is_not_a_number_gives_no_gesture_and_spoils_nothing(bad):
    recogniser = OnsetRecogniser(model_by_hand())
    recogniser.feed(0.0, LEVEL)
    recogniser.activate(1, 0.01)

    answer = recogniser.feed(0.01, (0.0, bad, 1.0))

    assert (answer.label, answer.reason) == (None, "a reading of the right arm is not a number")
    (after,) = hear(recogniser, lambda t: push_at(t, 0.6), 0.6, 0.02 + steps())
    assert after.label == "X+"


def test_a_time_that_is_not_a_number_is_passed_over():
    recogniser = OnsetRecogniser(model_by_hand())
    recogniser.activate(1, 0.5)

    assert recogniser.feed(float("nan"), LEVEL) is None
    (answer,) = hear(recogniser, lambda t: push_at(t, 0.6), 0.6, steps())
    assert answer.label == "X+"


def test_a_gap_before_the_activation_does_not_shorten_the_time_to_decide():
    recogniser = OnsetRecogniser(model_with_outputs(0.5, 0.3, 0.2))
    times_s = [t_s for t_s in steps() if not 0.1 < t_s < 1.0]

    (answer,) = hear(recogniser, lambda t: push_at(t, 1.1), 1.02, times_s)

    assert answer.decided_s >= answer.onset_s + 0.14


def test_a_cancelled_activation_is_never_answered_and_a_new_one_replaces_an_open_one():
    recogniser = OnsetRecogniser(model_by_hand())
    readings = [(float(t), push_at(float(t), 0.6)) for t in steps()]
    recogniser.activate(1, 0.1)
    recogniser.cancel()
    assert [recogniser.feed(*reading) for reading in readings] == [None] * len(readings)
    assert recogniser.check(9.0) is None

    recogniser.activate(2, 10.1)
    recogniser.activate(3, 10.5)
    answers = [recogniser.feed(10.0 + t_s, accel_g) for t_s, accel_g in readings]

    assert [(a.activation_id, a.label) for a in answers if a is not None] == [(3, "X+")]


def test_times_that_jump_are_survived():
    recogniser = OnsetRecogniser(model_by_hand())
    hear(recogniser, lambda _t: LEVEL, 9.0, 100.0 + steps(length_s=0.5))

    (answer,) = hear(recogniser, lambda t: push_at(t, 0.6), 0.6, steps())

    assert answer.label == "X+"


@settings(max_examples=40, deadline=None)
@given(
    seed=st.integers(0, 10**6),
    rate_hz=st.sampled_from([50.0, 100.0, 200.0]),
    lost=st.floats(0.0, 0.3),
)
def test_one_activation_is_answered_at_most_once_and_in_time_whatever_comes(seed, rate_hz, lost):
    rng = np.random.default_rng(seed)
    times = np.sort(steps(rate_hz, 3.0) + rng.normal(0.0, 0.004, round(3.0 * rate_hz)))
    times = times[rng.random(len(times)) > lost]
    walk = np.cumsum(rng.normal(0.0, 0.1, (len(times), 3)), axis=0) * rng.choice([0.01, 0.3, 1.0])
    recogniser, answers = OnsetRecogniser(model_by_hand()), []
    recogniser.activate(5, 0.5)
    for t_s, reading in zip(times.tolist(), (walk + LEVEL).tolist(), strict=True):
        answers += [recogniser.feed(t_s, tuple(reading)), recogniser.check(t_s)]

    given_answers = [answer for answer in answers if answer is not None]
    assert len(given_answers) == 1
    assert given_answers[0].decided_s <= 0.5 + GIVE_UP_S + 0.16 + 0.3


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 10**6), splits=st.lists(st.integers(1, 40), min_size=1, max_size=8))
def test_any_split_of_the_feeding_gives_the_same_answer(seed, splits):
    rng = np.random.default_rng(seed)
    begin_s, times = float(rng.uniform(0.4, 0.8)), steps(100.0)
    direction = rng.normal(0.0, 0.8, 3)
    readings = [push_at(float(t), begin_s, direction) for t in times]
    (whole,) = hear(
        OnsetRecogniser(model_by_hand()), lambda t: push_at(t, begin_s, direction), 0.6, times
    )

    recogniser, answers, k = OnsetRecogniser(model_by_hand()), [], 0
    while k < len(times):
        for n in splits:
            part = slice(k, k + n)
            if len(times[part]) and times[part][0] <= 0.6 + 1e-9 <= times[part][-1] + 0.01:
                recogniser.activate(1, 0.6)
            for t_s, reading in zip(times[part].tolist(), readings[part], strict=True):
                answers.append(recogniser.feed(t_s, reading))
            k += n
            if k < len(times):
                answers.append(recogniser.check(float(times[k]) - 0.01))
    (split,) = [answer for answer in answers if answer is not None]
    assert (split.label, split.reason, split.outputs) == (whole.label, whole.reason, whole.outputs)


def test_an_activation_that_is_told_late_is_answered_with_the_next_sample():
    recogniser = OnsetRecogniser(model_by_hand())

    (answer,) = hear(recogniser, lambda t: push_at(t, 0.6), 0.6, steps(), late_s=0.1)

    assert answer.label == "X+"
    assert answer.decided_s == pytest.approx(0.70)


@pytest.mark.parametrize("label", ["X+", "Y-", "Z+", "RX-", "RY+"])
@pytest.mark.parametrize("rate_hz", [50.0, 100.0, 200.0])
def test_a_simulated_arm_is_heard(label, rate_hz):
    person = practised_person(11)
    arm = RightArm(person, 3)
    arm.perform_for(label, 1.0)
    times = np.arange(round(2.5 * rate_hz)) / rate_hz
    readings = person.right_sensor.read(arm.accel_at(times), np.random.default_rng(0))
    recogniser = OnsetRecogniser(model_by_hand())
    by_time = dict(zip(times.tolist(), readings.tolist(), strict=True))

    (answer,) = hear(recogniser, lambda t: tuple(by_time[t]), 1.0, times)

    assert answer.label == label


def candidates(*shares):
    names = [*(f"g{k}" for k in range(len(shares) - 1)), NO_GESTURE]
    return tuple(map(Candidate, names, shares))


@given(st.lists(st.floats(0.001, 1.0), min_size=2, max_size=13))
def test_a_gesture_is_the_answer_only_when_it_is_likeliest_and_sure(weights):
    shares = (np.array(weights) / np.sum(weights)).tolist()
    outputs, decision = candidates(*shares), Decision(early=0.9, last=0.6)

    early, (last, reason) = judge_early(outputs, decision), judge_last(outputs, decision)

    best = max(shares[:-1])
    assert (early is not None) == (best >= 0.9)
    assert (last is not None) == (best >= 0.6)
    assert (last is None) == bool(reason)
    assert early in (None, last)


def test_the_kind_of_a_model_chooses_its_recogniser():
    onset = model_by_hand()
    network = Network(np.zeros((1, 9)), np.zeros(1), np.zeros((2, 1)), np.zeros(2))
    paper = Model("paper", ("X+", "X-"), network, "", RECORD, "", "", "")

    assert isinstance(recogniser_for(onset), OnsetRecogniser)
    assert isinstance(recogniser_for(paper), PaperRecogniser)
    for wrong in (
        replace(paper, kind="onset"),
        replace(onset, decision=None),
        replace(onset, labels=("X+", "X-")),
        replace(onset, labels=(*onset.labels[:-1], NO_GESTURE)),
    ):
        with pytest.raises(ValueError, match=r"onset recogniser|must not be called"):
            recogniser_for(wrong)
    assert set(onset.labels) < set(LABELS)
