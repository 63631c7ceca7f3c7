"""A training in words: the judgement first, then what to do, in plain sentences."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gestureapp.guided.trained_words import (
    Level,
    level_of,
    missing_words,
    words_of,
)
from gestureapp.recognition.evaluation import Evaluation, tally

GESTURES = ("X+", "X-", "RZ+", "RZ-")


def heard(n: int = 30, **wrong: dict[str, int]) -> Evaluation:
    """Each gesture n times, heard right but for what is told: ``RZ_plus={"RZ-": 4}``."""
    answers: list[tuple[str, str | None]] = []
    for label in GESTURES:
        others = wrong.get(label.replace("+", "_plus").replace("-", "_minus"), {})
        for other, count in others.items():
            answers += [(label, other or None)] * count
        answers += [(label, label)] * (n - sum(others.values()))
    return tally(GESTURES, answers, [20.0] * len(answers))


def test_a_model_that_hears_nearly_all_is_called_good_with_its_figures():
    assert words_of(heard(X_plus={"": 3})) == (
        "Good. Of 120 takes 98 % are recognised, 0 % heard as another gesture, 2 % not recognised.",
    )


def test_two_gestures_that_are_confused_are_named_together_with_what_to_record():
    words = words_of(heard(RZ_plus={"RZ-": 3}, RZ_minus={"RZ+": 2}))

    assert words[0].startswith("Usable. ")
    assert words[1:] == ("RZ+ and RZ- are often confused: record ten more of each.",)


def test_a_gesture_that_is_often_not_recognised_says_how_to_make_it():
    words = words_of(heard(X_minus={"": 12}))

    assert words[1] == (
        "X- is often not recognised: record ten more, and begin both arms at the same time."
    )


def test_the_worst_comes_first():
    words = words_of(heard(X_plus={"X-": 3, "": 6}, X_minus={"X+": 3}, RZ_plus={"RZ-": 12}))

    assert [sentence.split()[0] for sentence in words[1:]] == ["RZ+", "X+", "X+"]


def test_few_takes_make_figures_rough_and_it_is_said():
    assert words_of(heard(8))[-1] == (
        "With fewer than 20 takes of a gesture these figures are rough."
    )
    few = tally(("a", "b"), [("a", "a")] * 30 + [("b", "b")] * 6)
    assert words_of(few)[-1] == "b has fewer than 20 takes: the figures are rough there."


def test_no_takes_give_no_figures():
    assert words_of(tally(GESTURES, ())) == ("Nothing was heard: there are no takes.",)


@pytest.mark.parametrize(
    ("wrong", "level"),
    [
        ({"": 12}, Level.GOOD),
        ({"": 13}, Level.USABLE),
        ({"X-": 3}, Level.GOOD),
        ({"X-": 4}, Level.USABLE),
        ({"X-": 9}, Level.USABLE),
        ({"X-": 10}, Level.POOR),
        ({"": 24}, Level.USABLE),
        ({"": 25}, Level.POOR),
    ],
)
def test_levels_change_at_their_limits(wrong, level):
    assert level_of(heard(X_plus=wrong)) is level


def test_what_is_missing_for_a_training_is_said_by_gesture():
    assert missing_words(["X+"] * 5 + ["X-"] * 5) == ""
    assert missing_words(["X+"] * 5 + ["Z-"] * 3).startswith(
        "Z- has 3 good takes: at least 5 of a gesture are needed"
    )
    assert "two gestures" in missing_words(["X+"] * 30)
    assert "two gestures" in missing_words([])


@given(
    counts=st.lists(st.integers(0, 40), min_size=12, max_size=12),
    labels=st.permutations(["a", "b", "c"]),
)
def test_any_table_has_words_of_one_line_each_that_never_praise_a_bad_one(counts, labels):
    evaluation = Evaluation(tuple(labels), np.array(counts).reshape(3, 4), (20.0, 30.0))

    words = words_of(evaluation)

    assert all(len(sentence.splitlines()) == 1 for sentence in words)
    assert 1 <= len(words) <= 5
    if words[0].startswith("Good."):
        assert evaluation.recognised >= 0.9
        assert evaluation.wrong <= 0.03
