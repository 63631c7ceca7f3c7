"""Sentences about training and trying."""

import math

import pytest

from gestureapp.guided.values import Trying
from ui.model_words import gesture_words, outcome_words, remaining_words, share_words


@pytest.mark.parametrize(
    ("remaining_s", "words"),
    [
        (math.nan, ""),
        (math.inf, ""),
        (0.4, "nearly done"),
        (4.2, "about 4 s left"),
        (59.9, "about 60 s left"),
        (150.0, "about 2 min left"),
    ],
)
def test_remaining_time_is_rounded_to_what_is_known(remaining_s, words):
    assert remaining_words(remaining_s) == words


def test_a_share_has_its_count():
    assert share_words(28, 30) == "28 (93.3 %)"
    assert share_words(0, 0) == "0"


@pytest.mark.parametrize(
    ("heard", "was_right", "words"),
    [
        ("", False, ""),
        ("X+", True, "X+: right"),
        ("Y-", False, "X+: wrong, heard Y-"),
        ("not recognised", False, "X+: not recognised"),
    ],
)
def test_an_answer_is_right_wrong_or_not_recognised(heard, was_right, words):
    assert outcome_words(Trying(heard=heard, was_right=was_right, answered="X+")) == words


def test_a_gesture_nobody_knows_has_no_words():
    assert gesture_words("X+") == "push forward"
    assert gesture_words("wave") == ""
