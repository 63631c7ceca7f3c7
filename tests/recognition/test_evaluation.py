import json

import numpy as np
import pytest

from gestureapp.errors import ModelMismatch
from gestureapp.recognition.evaluation import tally
from gestureapp.recognition.hearing import evaluate
from gestureapp.recognition.model_file import Model, TrainingRecord
from gestureapp.recognition.network import Network
from gestureapp.recognition.takes import TakeSet

RECORD = TrainingRecord("paper", "by hand", 0, 0.25, 0, 0, 0.0, 0.0)


def model_by_first_x():
    """Hears X+ when the first ax is above 0.5 g, X- when it is below -0.5 g."""
    hidden = np.zeros((2, 9))
    hidden[0, 0], hidden[1, 0] = 40.0, -40.0
    network = Network(hidden, np.array([-20.0, -20.0]), 20.0 * np.eye(2), np.array([-10.0, -10.0]))
    return Model("paper", ("X+", "X-"), network, "", RECORD, "", "", "")


def takes_of(*takes, rate_hz=100.0):
    """From (label, activation, ax of each sample)."""
    parts = [[(ax, 0.0, 1.0) for ax in column] for _, _, column in takes]
    return TakeSet(
        np.concatenate(parts) if parts else np.zeros((0, 3)),
        np.cumsum([0, *map(len, parts)]),
        tuple(label for label, _, _ in takes),
        np.array([activation for _, activation, _ in takes], dtype=np.int64),
        rate_hz=rate_hz,
    )


MIXED = (
    ("X+", 2, [0, 0, 0.9, 0.9, 0.9, 0]),
    ("X+", 0, [0.9, 0.9, 0.9]),
    ("X+", 1, [0.9, -0.9, -0.9, -0.9]),
    ("X-", 0, [-0.9, -0.9, -0.9, 0.9]),
    ("X-", 3, [-0.9, -0.9, -0.9, 0.0, 0.0, 0.0]),
    ("wave", 0, [0.9, 0.9, 0.9]),
)


def test_what_was_done_and_what_was_heard_are_counted():
    result = evaluate(model_by_first_x(), takes_of(*MIXED))

    assert result.labels == ("X+", "X-", "wave")
    assert result.confusion.tolist() == [[2, 1, 0, 0], [0, 1, 0, 1], [1, 0, 0, 0]]
    assert result.n == 6
    assert result.recognised == pytest.approx(3 / 6)
    assert result.wrong == pytest.approx(2 / 6)
    assert result.rejected == pytest.approx(1 / 6)
    assert result.per_gesture()["X-"] == (0.5, 0.0, 0.5)


def test_the_decision_time_counts_from_the_activation():
    result = evaluate(model_by_first_x(), takes_of(*MIXED))
    slower = evaluate(model_by_first_x(), takes_of(*MIXED, rate_hz=50.0))

    assert result.decision_ms == pytest.approx((20.0, 20.0))
    assert slower.decision_ms == pytest.approx((40.0, 40.0))


def test_an_unknown_rate_is_taken_for_the_papers():
    result = evaluate(model_by_first_x(), takes_of(*MIXED, rate_hz=None))

    assert result.decision_ms == pytest.approx((20.0, 20.0))


def test_a_take_that_ends_too_soon_is_not_recognised():
    result = evaluate(model_by_first_x(), takes_of(("X+", 1, [0.0, 0.9, 0.9])))

    assert result.rejected == 1.0
    assert result.decision_ms[0] > 250.0


def test_no_takes_at_all_are_refused():
    with pytest.raises(ModelMismatch, match="no takes at all"):
        evaluate(model_by_first_x(), takes_of())


def test_takes_of_which_the_model_knows_no_label_are_refused_with_both_lists():
    takes = takes_of(("forward", 0, [0.9, 0.9, 0.9]))
    with pytest.raises(ModelMismatch, match=r"holds forward; this model knows X\+, X-"):
        evaluate(model_by_first_x(), takes)


def test_the_json_has_every_figure_and_survives_a_round_trip():
    result = evaluate(model_by_first_x(), takes_of(*MIXED))

    content = json.loads(json.dumps(result.as_json()))

    assert content["n"] == 6
    assert content["labels"] == ["X+", "X-", "wave"]
    assert content["confusion"] == result.confusion.tolist()
    assert content["recognised"] + content["wrong"] + content["rejected"] == pytest.approx(1.0)
    assert content["per_gesture"]["X+"]["wrong"] == pytest.approx(1 / 3)
    assert content["decision_ms"] == {
        "median": pytest.approx(20.0),
        "p95": pytest.approx(20.0),
    }


def test_the_table_has_a_row_for_each_gesture_and_their_mean():
    result = evaluate(model_by_first_x(), takes_of(*MIXED))

    rows = [line.split() for line in result.as_table().splitlines()]

    assert rows[1] == ["X+", "66.7", "33.3", "0.0"]
    assert rows[2] == ["X-", "50.0", "0.0", "50.0"]
    assert rows[3] == ["wave", "0.0", "100.0", "0.0"]
    assert rows[4] == ["Mean", "38.9", "44.4", "16.7"]


def test_the_table_writes_out_what_a_terminal_would_obey():
    table = tally(["a"], [("\x1b[31mred", "a"), ("a\nb", None), ("a", "a")]).as_table()
    lines = table.splitlines()
    assert [line.split()[0] for line in lines] == [
        "Gesture",
        "a",
        r"\x1b[31mred",
        r"a\nb",
        "Mean",
    ]
    assert len({len(line) for line in lines}) == 1
    assert table.replace("\n", "").isprintable()
