"""Recognisers side by side: who hears what, and how the tables read."""

import json

import numpy as np
import pytest

from gestureapp import cli
from gestureapp.benchmark import contest, peers
from gestureapp.benchmark.contest import at_onset, measure_file, measure_simulated
from gestureapp.errors import ModelError, NotEnoughTakes
from gestureapp.recognition import onset_training, training
from gestureapp.recognition.members import Steps
from gestureapp.recognition.takes import TakeSet, save_takes

REST_S = 0.5


@pytest.fixture
def few_cycles(monkeypatch):
    monkeypatch.setattr(training, "PAPER_CYCLES", 400)
    monkeypatch.setattr(onset_training, "NEW", Steps(60, 2e-3, 64, 1e-3))
    monkeypatch.setattr(onset_training, "KEPT", Steps(30, 1e-3, 64, 1e-3))
    monkeypatch.setattr(contest, "TRAINED_ON", 6)
    monkeypatch.setattr(contest, "TESTED_ON", 2)
    monkeypatch.setattr(contest, "ADAPTED_TO", (1, 6))
    monkeypatch.setattr(contest, "NEGATIVES", 16)
    monkeypatch.setattr(contest, "SETTINGS", ((0.95, 0.6),))


def pushes(begin=60, **who):
    """Two people push two ways ten times each; the hand moves from the 60th sample on."""
    rng = np.random.default_rng(2)
    parts, labels = [], []
    for _ in range(20):
        for label, push_g in (("to", 1.0), ("fro", -1.0)):
            parts.append(rng.normal([0.0, 0.0, 1.0], 0.01, (100, 3)))
            parts[-1][begin : begin + 20, 0] += push_g
            labels.append(label)
    offsets = np.cumsum([0, *map(len, parts)])
    activation = np.full(40, 57)
    return TakeSet(np.concatenate(parts), offsets, tuple(labels), activation, rate_hz=100.0, **who)


WHO = {"user": ("a",) * 20 + ("b",) * 20, "repetition": tuple(f"{n // 10 % 2}" for n in range(40))}


@pytest.mark.usefixtures("few_cycles")
def test_a_file_is_heard_by_repetition_and_by_person(tmp_path, capsys):
    path = tmp_path / "takes.npz"
    save_takes(path, pushes(**WHO))

    assert cli.main(["benchmark", "recognition", "--takes", str(path), "--json"]) == cli.FINE

    found = json.loads(capsys.readouterr().out)
    titles = [table["title"] for table in found["contests"]]
    assert titles == [
        f"takes.npz, {words}"
        for words in ("each person alone, by repetition", "one person left out")
    ]
    for table in found["contests"]:
        assert {"paper, from activation", "paper, from onset", "ours"} <= set(table["columns"])
        assert all(column["n"] == 40 for column in table["columns"].values())
        assert table["columns"]["paper, from onset"]["recognised"] == 1.0


@pytest.mark.usefixtures("few_cycles")
def test_who_made_every_gesture_once_is_left_out_alone_and_named(tmp_path, monkeypatch):
    path = tmp_path / "takes.npz"
    monkeypatch.setattr(contest, "_peers", lambda: ())
    who = {"user": ("a",) * 26 + ("b",) * 14, "repetition": ("0",) * 13 + ("1",) * 13 + ("0",) * 14}
    save_takes(path, pushes(**who))

    report = measure_file(path)

    alone, others = report.contests
    assert (dict(alone.columns)["ours"].n, dict(others.columns)["ours"].n) == (26, 40)
    assert "Left out alone, with one repetition only: b." in report.as_table()


@pytest.mark.parametrize(
    ("who", "words"),
    [
        (
            WHO | {"repetition": (("0",) * 16 + ("1",) * 4) * 2},
            r"\(a alone, without repetition 0\): only 2 of fro",
        ),
        ({"user": ("a",) * 36 + ("b",) * 4}, r"takes\.npz \(without a\): only 2 of fro, 2 of to"),
        ({"user": ("a", "b") * 20}, r"takes\.npz \(without a\): takes of at least two gestures"),
    ],
    ids=["a fold of a person", "the others", "one gesture each"],
)
def test_with_too_few_takes_the_person_or_fold_is_named_before_anybody_learns(
    tmp_path, monkeypatch, who, words
):
    monkeypatch.setattr(contest, "_score", None)
    save_takes(tmp_path / "takes.npz", pushes(**who))

    with pytest.raises(NotEnoughTakes, match=words):
        measure_file(tmp_path / "takes.npz")


def test_a_gesture_that_the_file_does_not_hold_is_refused_by_name(tmp_path, capsys):
    path = tmp_path / "takes.npz"
    save_takes(path, pushes(**WHO))

    asked = ("--takes", str(path), "--gestures", "to, frow , fro")
    assert cli.main(["benchmark", "recognition", *asked]) == cli.FAILED

    expected = f"gestureapp: {path}: not in this file: frow; there are: to, fro\n"
    assert capsys.readouterr().err == expected


def test_names_of_gestures_may_have_blanks_between_them(tmp_path, monkeypatch, capsys):
    path, heard = tmp_path / "takes.npz", []
    monkeypatch.setattr(contest, "_peers", lambda: ())
    monkeypatch.setattr(contest, "learn_ours", lambda seen: heard.append(seen) or _never)
    save_takes(path, pushes(**WHO))

    asked = ("--takes", str(path), "--gestures", " fro, to ")
    assert cli.main(["benchmark", "recognition", *asked]) == cli.FINE

    assert {label for seen in heard for label in seen.labels} == {"to", "fro"}
    assert "| to | 0.0 (0.0) |" in capsys.readouterr().out


def _never(takes):
    return [(None, 0.0)] * len(takes)


@pytest.mark.usefixtures("few_cycles")
def test_simulated_people_are_heard_on_later_days_and_by_takes():
    report = measure_simulated(1)

    first, adapted, _, nothing = report.contests
    assert dict(nothing.columns)["ours"].n == 16
    assert {evaluation.n for _, evaluation in first.columns} == {12 * 2 * 3}
    assert "6 takes" in dict(adapted.columns)
    table = report.as_table()
    assert "| recognised, % |" in table
    assert "\n| RZ- |" in table


def test_a_library_that_is_missing_is_said_with_its_remedy(monkeypatch):
    monkeypatch.setattr(peers, "find_spec", lambda name: None if name == "sklearn" else object())
    assert peers.missing_words() == (
        "SVM and 1-NN DTW are left out: scikit-learn is not installed here: "
        "pip install 'gestureapp[peers]'"
    )


def test_takes_that_say_neither_person_nor_repetition_are_refused_in_words(tmp_path):
    save_takes(tmp_path / "takes.npz", pushes())
    with pytest.raises(ModelError, match="nothing to split by"):
        measure_file(tmp_path / "takes.npz")


def test_the_onset_is_where_the_hand_begins_to_move_even_before_the_activation():
    assert set(at_onset(pushes(), 0.1).activation.tolist()) <= {59, 60}
    assert set(at_onset(pushes(begin=50), 0.1).activation.tolist()) <= {49, 50}
    assert set(at_onset(pushes(begin=100), 0.1).activation.tolist()) == {57}


def test_the_window_of_the_peers_begins_at_the_onset():
    takes = pushes()
    found = peers.windows(takes, peers.onsets_s(takes, peers.onset_level_g(takes)))
    assert found.shape == (40, peers.STEPS, 3)
    assert np.abs(found[:, 2:, 0]).min() > 0.9


@pytest.mark.parametrize("learn", [peers.learn_svm, peers.learn_nearest])
def test_peers_learn_what_is_easy(learn):
    pytest.importorskip("sklearn")
    pytest.importorskip("dtaidistance")
    takes = pushes()
    seen = peers.windows(takes, peers.onsets_s(takes, peers.onset_level_g(takes)))
    assert list(learn(seen, takes.labels)(seen)) == list(takes.labels)
