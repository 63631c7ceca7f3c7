"""The preset ``default`` with its real base model: simulated people, and takes of other makes."""

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

from gestureapp.errors import ModelInvalid, NotEnoughTakes
from gestureapp.gestures import LABELS
from gestureapp.recognition import base, onset_training, training
from gestureapp.recognition.base import load_base
from gestureapp.recognition.hearing import evaluate, hear
from gestureapp.recognition.members import Steps
from gestureapp.recognition.model_file import load_model, save_model
from gestureapp.recognition.presets import Preset
from gestureapp.recognition.takes import TakeSet
from gestureapp.recognition.training import train
from gestureapp.simulation.takes import make_takes

SEED = 8000


@pytest.fixture
def few_steps(monkeypatch):
    """The same rule with fewer steps, to keep the suite quick."""
    monkeypatch.setattr(onset_training, "NEW", Steps(150, 2e-3, 64, 1e-3))
    monkeypatch.setattr(onset_training, "KEPT", Steps(50, 1e-3, 64, 1e-3))


def other_takes(labels=("wave", "poke", "X+"), count=6, seed=0, rate_hz=50.0, length=40, begin=0):
    """Strong pushes of other makers' gestures; the record begins shortly before the movement."""
    rng = np.random.default_rng(seed)
    parts, names = [], []
    steps = np.arange(length) - 10.0
    course = np.where((steps >= 0) & (steps < 20), np.sin(2.0 * np.pi * steps / 20.0), 0.0)
    for k, label in enumerate(labels):
        for _ in range(count):
            part = rng.normal([0.0, 0.0, 1.0], 0.01, (length, 3))
            part[:, k % 3] += course * rng.uniform(0.8, 1.2)
            parts.append(part[begin:])
            names.append(label)
    offsets = np.cumsum([0, *(len(part) for part in parts)])
    activation = np.zeros(len(names), dtype=int)
    return TakeSet(np.concatenate(parts), offsets, tuple(names), activation, rate_hz=rate_hz)


@pytest.mark.usefixtures("few_steps")
def test_a_person_is_recognised_on_another_day_and_the_file_says_the_same(tmp_path):
    takes = make_takes(1, 6, SEED)

    model = train(takes, seed=1)
    save_model(tmp_path / "model.json", model)
    result = evaluate(load_model(tmp_path / "model.json"), make_takes(1, 8, SEED, session=2))

    assert model.kind == "onset"
    assert model.labels == LABELS
    assert result.recognised > 0.9
    assert result.wrong < 0.03
    assert model.cross_validation.evaluation.n == 72
    assert model.cross_validation.evaluation.recognised > 0.9
    assert (tmp_path / "model.json").stat().st_size < 1_500_000


def still_from(takes, rows):
    """The same, but in these takes nothing moves."""
    samples = takes.samples.copy()
    for row in rows:
        samples[takes.offsets[row] : takes.offsets[row + 1]] = [0.0, 0.0, 1.0]
    return replace(takes, samples=samples)


@pytest.mark.parametrize("still", [range(6, 12), range(18)], ids=["one gesture", "all"])
def test_a_gesture_in_whose_takes_nothing_moves_is_refused_by_name(still):
    takes = still_from(other_takes(), still)

    with pytest.raises(NotEnoughTakes, match=r"in the takes of .*poke") as no:
        train(takes, seed=1)

    assert ("wave" in str(no.value)) == (len(still) == 18)


@pytest.mark.usefixtures("few_steps")
def test_a_fold_in_which_nothing_moves_is_heard_as_nothing():
    takes = replace(other_takes(), repetition=tuple(str(n % 6) for n in range(18)))
    takes = still_from(takes, [row for row in range(18) if row % 6 == 2])

    found = train(takes, seed=1).cross_validation.evaluation

    assert found.n == 18
    assert found.rejected >= 3 / 18


@pytest.mark.usefixtures("few_steps")
def test_a_seed_gives_the_same_model_and_another_seed_another():
    takes = make_takes(1, 5, SEED, gestures=("X+", "Z-"))

    first, again, other = (train(takes, seed=seed) for seed in (1, 1, 2))

    assert np.array_equal(first.network.layers[0].weights, again.network.layers[0].weights)
    assert first.decision == again.decision
    assert not np.array_equal(first.network.layers[0].weights, other.network.layers[0].weights)


@pytest.mark.usefixtures("few_steps")
@pytest.mark.parametrize("rate_hz", [50.0, 100.0, 200.0])
def test_some_of_the_gestures_are_enough_at_any_rate(rate_hz):
    gestures = ("X+", "Y-", "RX+")
    takes = make_takes(1, 5, SEED, rate_hz=rate_hz, gestures=gestures)

    model = train(takes, seed=1)

    fresh = make_takes(1, 8, SEED, session=2, rate_hz=rate_hz, gestures=gestures)
    assert model.labels == gestures
    assert evaluate(model, fresh).recognised > 0.85


@pytest.mark.usefixtures("few_steps")
@pytest.mark.parametrize("begin", [0, 8, 11])
def test_other_gestures_are_learned_from_records_that_begin_anywhere(begin):
    """The activation is at 0: the hand rests, is about to move, or moves already."""
    model = train(other_takes(begin=begin), seed=1)

    assert model.labels == ("X+", "poke", "wave")
    assert evaluate(model, other_takes(seed=5, begin=begin)).recognised > 0.8


def test_one_take_of_each_gesture_is_enough_to_begin_with():
    model = train(make_takes(1, 1, SEED), seed=1)

    assert model.cross_validation is None
    assert evaluate(model, make_takes(1, 4, SEED, session=2)).recognised > 0.9


def test_a_gesture_that_was_not_taught_is_not_heard_as_another():
    taught = tuple(label for label in LABELS if not label.startswith("RZ"))

    model = train(make_takes(1, 8, SEED, gestures=taught), seed=1)

    turns = make_takes(1, 8, SEED, session=2, gestures=("RZ+", "RZ-"))
    named = [answer for i in range(len(turns)) if (answer := hear(model, turns, i).label)]
    assert len(named) <= 1
    assert evaluate(model, make_takes(1, 4, SEED, session=2, gestures=taught)).recognised > 0.9


def test_of_other_gestures_five_takes_are_needed():
    with pytest.raises(NotEnoughTakes, match="only 4 of X\\+, 4 of poke"):
        train(other_takes(labels=("X+", "poke"), count=4))


@pytest.mark.usefixtures("few_steps")
def test_changing_a_fold_changes_nothing_in_the_networks_that_hear_it(monkeypatch):
    heard = []
    monkeypatch.setattr(training, "_cross_validate", lambda _m, found: heard.append(found))
    takes = make_takes(1, 5, SEED, gestures=("X+", "Y-"))
    samples = takes.samples.copy()
    samples[takes.offsets[0] : takes.offsets[1]] *= 1.3

    train(takes, seed=1)
    train(replace(takes, samples=samples), seed=1)

    before, after = heard
    fold = int(before.division.fold[0])
    for number in range(before.division.n_folds):
        same = [
            np.array_equal(a.weights, b.weights)
            for a, b in zip(
                before.networks[1 + number].layers, after.networks[1 + number].layers, strict=True
            )
        ]
        assert all(same) == (number == fold)


@pytest.mark.usefixtures("few_steps")
def test_progress_is_told_in_order_up_to_the_end():
    told = []

    model = train(make_takes(1, 5, SEED, gestures=("X+", "X-")), progress=lambda *n: told.append(n))

    assert [done for done, _, _ in told] == sorted({done for done, _, _ in told})
    assert told[-1][:2] == (200, 200)
    assert (model.training.preset, model.training.cycles) == ("default", 200)


def test_the_base_alone_knows_people_it_has_never_met_and_few_of_its_non_gestures():
    shipped = load_model(base.BASE)

    assert evaluate(shipped, make_takes(2, 4, SEED)).recognised > 0.93
    assert Counter(load_base().negatives.labels).total() == 480


def test_a_missing_base_is_said_with_its_place(monkeypatch, tmp_path):
    monkeypatch.setattr(base, "BASE", tmp_path / "base.json")

    with pytest.raises(ModelInvalid, match=r"base\.json"):
        train(make_takes(1, 5, SEED, gestures=("X+", "X-")), Preset.DEFAULT)
