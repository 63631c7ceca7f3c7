"""The shared base model on simulated people that it has never seen, through the real recogniser."""

import numpy as np
import pytest

from gestureapp.gestures import LABELS, is_held
from gestureapp.recognition.base import BASE
from gestureapp.recognition.hearing import evaluate, hear
from gestureapp.recognition.kinds import recogniser_for
from gestureapp.recognition.model_file import load_model
from gestureapp.simulation.negatives import KINDS, make_negatives
from gestureapp.simulation.takes import make_takes

UNSEEN = 8123


@pytest.fixture(scope="module")
def base():
    return load_model(BASE)


def heard(model, times_s, accel_g, activation_s):
    """All answers to one activation, told before the first sample at or after it."""
    recogniser, answers = recogniser_for(model), []
    first = int(np.searchsorted(times_s, activation_s))
    for k, (t_s, reading) in enumerate(zip(times_s.tolist(), accel_g.tolist(), strict=True)):
        if k == first:
            recogniser.activate(1, activation_s)
        answers.append(recogniser.feed(t_s, tuple(reading)))
    return [answer for answer in answers if answer is not None]


@pytest.mark.parametrize("rate_hz", [50.0, 100.0, 200.0])
def test_people_never_seen_are_heard_at_every_rate(base, rate_hz):
    takes = make_takes(6, 2, seed=UNSEEN, session=2, rate_hz=rate_hz)

    found = evaluate(base, takes)

    assert set(found.per_gesture()) == set(LABELS)
    assert min(right for right, _, _ in found.per_gesture().values()) >= 0.8
    assert found.recognised >= 0.97
    assert found.wrong <= 0.01
    median_ms, p95_ms = found.decision_ms
    assert median_ms < 100.0
    assert p95_ms < 250.0


@pytest.mark.parametrize("rate_hz", [50.0, 100.0, 200.0])
def test_lost_late_and_shaken_samples_cost_little(base, rate_hz):
    takes = make_takes(6, 2, seed=UNSEEN, session=3, rate_hz=rate_hz)
    rng = np.random.default_rng(5)
    right = wrong = 0
    for i in range(len(takes)):
        accel_g = takes.accel_g(i)
        keep = rng.random(len(accel_g)) > 0.1
        times_s = np.arange(len(accel_g)) / rate_hz + np.abs(rng.normal(0.0, 0.002, len(accel_g)))
        activation_s = float(takes.activation[i]) / rate_hz
        answers = heard(base, np.maximum.accumulate(times_s)[keep], accel_g[keep], activation_s)
        assert len(answers) == 1
        right += answers[0].label == takes.labels[i]
        wrong += answers[0].label not in (None, takes.labels[i])

    assert right >= 0.95 * len(takes)
    assert wrong <= 0.015 * len(takes)


@pytest.mark.parametrize("shift_s", [-0.06, -0.03, 0.03, 0.1])
def test_the_left_arm_may_be_early_or_late(base, shift_s):
    takes = make_takes(4, 1, seed=UNSEEN, session=2)
    right = 0
    for i in range(len(takes)):
        accel_g = takes.accel_g(i)
        activation_s = takes.activation[i] / 100.0 + shift_s
        (answer,) = heard(base, np.arange(len(accel_g)) / 100.0, accel_g, activation_s)
        right += answer.label == takes.labels[i]
        if answer.label is not None and not is_held(answer.label):
            assert answer.decided_s <= max(answer.onset_s, activation_s) + 0.161

    assert right >= 0.93 * len(takes)


@pytest.mark.parametrize("rate_hz", [50.0, 100.0, 200.0])
def test_what_is_no_gesture_is_seldom_heard_as_one(base, rate_hz):
    takes = make_negatives(160, seed=77, rate_hz=rate_hz)

    moved = [takes.labels[i] for i in range(len(takes)) if hear(base, takes, i).label is not None]

    assert set(takes.labels) == set(KINDS)
    assert len(moved) <= 0.06 * len(takes), moved
    assert not {"fall", "drift", "settle"} & set(moved)
