from pathlib import Path

import numpy as np
import pytest

from gestureapp.gestures import LABELS
from gestureapp.recognition.hearing import evaluate
from gestureapp.recognition.kinds import recogniser_for
from gestureapp.recognition.model_file import load_model
from gestureapp.sensing.posture import PostureDetector
from gestureapp.sensing.values import ArmPosture
from gestureapp.simulation.arm import LeftArm, RightArm, start_seen_after_s
from gestureapp.simulation.people import practised_person
from gestureapp.simulation.takes import make_takes

DEMO_MODEL = Path(__file__).parents[2] / "resources" / "demo" / "model.json"
DEMO_SEED = 7


def test_a_set_holds_every_gesture_of_everybody():
    takes = make_takes(2, 3, seed=4, session=2)

    assert len(takes) == 2 * 3 * 12
    assert takes.labels[:4] == ("X+", "X+", "X+", "X-")
    assert set(takes.labels) == set(LABELS)
    assert (takes.user[0], takes.user[-1]) == ("p1", "p2")
    assert set(takes.session) == {"2"}


@pytest.mark.parametrize(("rate_hz", "before"), [(100.0, 50), (50.0, 25), (200.0, 100)])
def test_a_take_is_half_a_second_before_and_one_after_the_activation(rate_hz, before):
    takes = make_takes(1, 1, seed=4, rate_hz=rate_hz)

    assert takes.rate_hz == rate_hz
    assert set(takes.activation.tolist()) == {before}
    assert set(np.diff(takes.offsets).tolist()) == {3 * before}


def test_the_same_call_gives_the_same_takes_and_another_session_fresh_ones():
    first, again = make_takes(1, 2, seed=4), make_takes(1, 2, seed=4)
    other_day = make_takes(1, 2, seed=4, session=2)

    assert first.fingerprint() == again.fingerprint()
    assert first.fingerprint() != other_day.fingerprint()


def test_only_the_gestures_asked_for_are_made_by_the_same_people():
    four = make_takes(2, 3, seed=4, gestures=["Y-", "X+", "RX+", "RZ-"])

    assert four.labels[::3] == ("Y-", "X+", "RX+", "RZ-") * 2
    assert set(four.user) == {"p1", "p2"}


@pytest.mark.parametrize("wrong", [[], ["X+", "X+"], ["X+", "W+"]])
def test_gestures_that_make_no_sense_are_refused_by_name(wrong):
    with pytest.raises(ValueError, match=r"gestures must be some of X\+"):
        make_takes(1, 1, seed=4, gestures=wrong)


def test_readings_come_in_the_steps_of_a_10_bit_converter():
    counts = make_takes(1, 2, seed=4).samples * 102.4

    assert np.allclose(counts, np.rint(counts), atol=1e-9)
    assert len(np.unique(np.rint(counts))) > 100


def test_the_hand_rests_before_and_moves_after_the_activation():
    takes = make_takes(1, 5, seed=4, practised=True)

    for index in range(len(takes)):
        accel, label = takes.accel_g(index), takes.labels[index]
        if label[:2] in ("RX", "RY"):
            held = accel[50:53].mean(axis=0)
            assert np.abs(held[:2]).max() > 0.9
        else:
            assert np.abs(accel[:40] - [0, 0, 1]).max() < 0.15
            assert np.abs(accel[50:100] - [0, 0, 1]).max() > 0.25


@pytest.mark.parametrize(
    "wrong",
    [{"people": 0}, {"takes": 0}, {"session": 0}, {"seed": -1}, {"rate_hz": 0.0},
     {"rate_hz": float("nan")}],
)  # fmt: skip
def test_numbers_that_make_no_sense_are_refused(wrong):
    with pytest.raises(ValueError, match="must"):
        make_takes(**({"people": 1, "takes": 1, "seed": 0} | wrong))


@pytest.mark.parametrize("session", [2, 3])
def test_the_demonstrations_model_recognises_fresh_takes_of_its_person(session):
    fresh = make_takes(1, 50, seed=DEMO_SEED, session=session, practised=True)

    result = evaluate(load_model(DEMO_MODEL), fresh)

    assert result.recognised >= 0.95
    assert result.wrong <= 0.01
    assert min(share[0] for share in result.per_gesture().values()) >= 0.9


def test_the_demonstrations_model_was_made_from_the_takes_it_names():
    model = load_model(DEMO_MODEL)

    assert model.labels == LABELS
    assert (model.kind, model.training.preset) == ("onset", "default")
    assert model.training.n_takes == 360


def test_both_arms_of_the_demonstration_together_are_recognised():
    """Left arm, posture detector, activation and right arm, as their samples come in."""
    person, model = practised_person(DEMO_SEED), load_model(DEMO_MODEL)
    rng = np.random.default_rng(0)
    heard = []
    for number, label in enumerate(LABELS * 3):
        right, left = RightArm(person, number), LeftArm(person, number)
        right.perform_for(label, 2.0)
        left.take(ArmPosture.START, 2.0 - start_seen_after_s(person))
        activation_s = seen_s(person.left_sensor.read, left, rng)
        recogniser = recogniser_for(model)
        recogniser.activate(number, activation_s)
        times_s = (np.arange(300) + rng.uniform()) / 100.0
        readings = person.right_sensor.read(right.accel_at(times_s), rng)
        answers = [
            recogniser.feed(t_s, tuple(row))
            for t_s, row in zip(times_s.tolist(), readings.tolist(), strict=True)
        ]
        heard += [answer.label for answer in answers if answer is not None]

    assert len(heard) == 36
    assert sum(a == b for a, b in zip(heard, LABELS * 3, strict=True)) >= 34


def seen_s(read, left, rng):
    """When the start posture is seen in the left sensor's samples."""
    times_s = (np.arange(300) + rng.uniform()) / 100.0
    detector = PostureDetector(25.0, 40.0, 3)
    for t_s, row in zip(times_s.tolist(), read(left.accel_at(times_s), rng).tolist(), strict=True):
        if detector.feed(tuple(row)) is ArmPosture.START:
            return t_s
    raise AssertionError("the start posture was never seen")
