import numpy as np
import pytest

from gestureapp.recognition import base
from gestureapp.recognition.hearing import hear
from gestureapp.recognition.model_file import load_model
from gestureapp.simulation.base_people import wide
from gestureapp.simulation.negatives import KINDS, SATURATION_G, make_negatives
from gestureapp.simulation.people import draw_person


def test_a_seed_gives_the_same_takes_and_every_kind_in_turn():
    takes, again, other = (make_negatives(2 * len(KINDS), seed) for seed in (1, 1, 2))

    assert takes.labels == tuple(KINDS) * 2
    assert takes.fingerprint() == again.fingerprint() != other.fingerprint()


@pytest.mark.parametrize("rate_hz", [50.0, 100.0, 200.0])
def test_readings_are_those_of_a_worn_sensor(rate_hz):
    takes = make_negatives(8 * len(KINDS), 3, rate_hz)

    assert np.abs(takes.samples).max() <= SATURATION_G + 0.01
    assert 0.7 < np.median(np.linalg.norm(takes.samples, axis=1)) < 1.1
    assert takes.activation.tolist() == [round(0.5 * rate_hz)] * len(takes)


def test_the_base_model_takes_few_of_them_for_gestures():
    takes = make_negatives(30 * len(KINDS), 4)
    model = load_model(base.BASE)

    heard = [hear(model, takes, row).label for row in range(len(takes))]

    assert sum(label is not None for label in heard) < 0.06 * len(takes)


def test_people_outside_the_ordinary_are_quicker_and_never_slower():
    rng = np.random.default_rng(0)
    people = [draw_person(5, index) for index in range(20)]

    shares = [wide(person, rng).duration_s / person.duration_s for person in people]

    assert 0.35 <= min(shares) < max(shares) <= 1.0
