"""The figures of recognition: who is compared with whom, and how a table of them reads."""

import json

import numpy as np
import pytest

from gestureapp import cli
from gestureapp.benchmark import recognition
from gestureapp.benchmark.recognition import Outcome, at_onset, measure_people, measure_takes
from gestureapp.errors import ModelError
from gestureapp.recognition import training
from gestureapp.recognition.takes import TakeSet, save_takes


@pytest.fixture
def few_cycles(monkeypatch):
    monkeypatch.setattr(training, "PAPER_CYCLES", 400)
    monkeypatch.setattr(training, "DEFAULT_CYCLES", 200)
    monkeypatch.setattr(recognition, "TRAINED_ON", 6)
    monkeypatch.setattr(recognition, "TESTED_ON", 4)


def pushes(**who):
    """Two people push two ways six times each; the hand moves two samples after the activation."""
    rng = np.random.default_rng(2)
    parts, labels = [], []
    for _ in range(12):
        for label, push_g in (("to", 1.0), ("fro", -1.0)):
            parts.append(rng.normal([0.0, 0.0, 1.0], 0.02, (10, 3)))
            parts[-1][4:, 0] += push_g
            labels.append(label)
    offsets = np.cumsum([0, *map(len, parts)])
    return TakeSet(np.concatenate(parts), offsets, tuple(labels), np.full(24, 2), **who)


WHO = {"user": ("a",) * 12 + ("b",) * 12, "repetition": tuple(f"{n // 2 % 6}" for n in range(24))}


@pytest.mark.usefixtures("few_cycles")
def test_both_presets_are_compared_on_the_same_people():
    report = measure_people(2)

    paper, default, difference, blind = report.outcomes
    assert np.allclose(difference.shares, default.shares - paper.shares)
    assert np.allclose(default.shares.sum(axis=1), 100.0)
    assert np.allclose(difference.shares.sum(axis=1), 0.0)
    assert len(blind.shares) == 2
    assert report.as_table().count("\n| ") == 5


@pytest.mark.usefixtures("few_cycles")
def test_takes_from_a_file_are_split_by_repetition_and_by_person(tmp_path, capsys):
    path = tmp_path / "takes.npz"
    save_takes(path, pushes(**WHO))

    assert cli.main(["benchmark", "recognition", "--takes", str(path), "--json"]) == cli.FINE

    names = [outcome["name"] for outcome in json.loads(capsys.readouterr().out)["outcomes"]]
    splits = ("each person alone, by repetition", "all together, by repetition", "one person left")
    assert [sum(split in name for name in names) for split in splits] == [4, 4, 4]


@pytest.mark.usefixtures("few_cycles")
def test_takes_of_one_person_are_split_by_repetition_only(tmp_path):
    path = tmp_path / "takes.npz"
    save_takes(path, pushes(repetition=WHO["repetition"]))

    assert len(measure_takes(path, ["to", "fro"]).outcomes) == 4


def test_takes_that_say_neither_are_refused_in_words(tmp_path):
    save_takes(tmp_path / "takes.npz", pushes())

    with pytest.raises(ModelError, match="nothing to split by"):
        measure_takes(tmp_path / "takes.npz")


def test_the_onset_is_the_first_sample_away_from_rest_or_the_activation():
    takes = pushes()
    still = np.tile([0.0, 0.0, 1.0], (10, 1))
    samples = np.concatenate([takes.samples[:-10], still])

    moved = at_onset(TakeSet(samples, takes.offsets, takes.labels, takes.activation))

    assert moved.activation.tolist() == [4] * 23 + [2]


def test_a_row_tells_the_mean_the_spread_and_the_ends():
    shares = np.array([[80.0, 5.0, 15.0], [90.0, 1.0, 9.0]])

    assert Outcome("it", shares).as_row() == (
        "| it | 85.0 ± 7.1 (80.0 to 90.0) | 3.0 ± 2.8 (1.0 to 5.0) | 12.0 ± 4.2 (9.0 to 15.0) |"
    )
    assert Outcome("all", shares[:1]).as_row() == "| all | 80.0 | 5.0 | 15.0 |"
