"""What the training's page says: steps, takes, verdicts, sensors."""

from dataclasses import replace
from math import nan

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gestureapp.gestures import GESTURES
from gestureapp.guided.values import GestureProgress, GuidedSnapshot, Phase, Quality, TrainingView
from gestureapp.recording.take_values import Judgement, Take, Verdict
from gestureapp.sensing.values import ArmPosture
from ui.prompt_view import two_lines
from ui.train_words import (
    Step,
    continue_text,
    instruction,
    last_verdict,
    level_text,
    posture_text,
    short_take_text,
    step_states,
    take_count,
    verdict_sign,
)


def taken(verdict: Verdict, words: str = "", is_excluded: bool = False) -> Take:
    judgement = Judgement(verdict, words or verdict.value)
    still = np.zeros((2, 3))
    return Take(1, "X+", "", 0.0, judgement, is_excluded, False, np.array([0.0, 0.01]), still)


def recorded(*good: int, wanted: int = 30) -> GuidedSnapshot:
    progress = tuple(
        GestureProgress(gesture.label, n, wanted, Quality.GOOD)
        for gesture, n in zip(GESTURES, good, strict=False)
    )
    return GuidedSnapshot(person="Ana", label="X+", suggested="X-", progress=progress)


def test_surplus_takes_of_one_gesture_do_not_stand_for_another(scenes):
    states = step_states(recorded(40, 10), TrainingView(), scenes.ready())
    assert states[Step.RECORD].text == "40 of 60"
    assert not states[Step.RECORD].is_done
    assert states[Step.CHECK].text == "2 of 2 alike"


def test_how_far_a_person_is_and_what_comes_next():
    assert continue_text(recorded(30, 12)) == "42 of 60 takes. Next X- pull back: 12 of 30."
    done = replace(recorded(30, 30), suggested="")
    assert continue_text(done) == "60 of 60 takes. All gestures are recorded."


@given(st.integers(0, 400), st.integers(5, 200))
def test_the_take_to_come_never_exceeds_those_wanted(n_good: int, wanted: int):
    words = take_count(recorded(n_good, wanted=wanted))
    if n_good < wanted:
        assert words == f"take {n_good + 1} of {wanted}"
    else:
        assert words == f"{n_good} of {wanted}: done"


@pytest.mark.parametrize(
    ("take", "sign", "short"),
    [
        (taken(Verdict.GOOD), "\u2713", "good"),
        (taken(Verdict.UNLIKE, "looks like RZ+"), "!", "looks like RZ+"),
        (taken(Verdict.GAP, "gap of 43 ms"), "\u2717", "gap of 43 ms"),
        (taken(Verdict.TOO_LATE, "too late by 312 ms"), "\u2717", "too late"),
        (taken(Verdict.GOOD, is_excluded=True), "\u2013", "excluded"),
    ],
)
def test_a_take_is_told_by_sign_and_words(take, sign, short):
    assert (verdict_sign(take), short_take_text(take)) == (sign, short)


@pytest.mark.parametrize("phase", Phase)
def test_the_last_verdict_stands_only_during_a_batch(phase):
    late = taken(Verdict.TOO_LATE, "too late by 312 ms")
    words = last_verdict(GuidedSnapshot(phase=phase, batch=(taken(Verdict.GOOD), late)))
    is_batch = phase not in (Phase.CLOSED, Phase.IDLE, Phase.COUNT_IN)
    assert words == ("\u2717  too late by 312 ms" if is_batch else "")


def test_only_movements_ask_for_a_level_hand():
    assert instruction("X+") == "push forward, hand level"
    assert instruction("RX+") == "roll right and hold"


@pytest.mark.parametrize("gesture", GESTURES, ids=lambda gesture: gesture.label)
def test_words_are_cut_into_two_lines_of_which_none_is_empty(gesture):
    first, second = two_lines(gesture.words)
    assert f"{first} {second}" == gesture.words
    assert first
    assert second


def test_level_and_posture_in_words():
    assert level_text(nan, False) == "no data"
    assert level_text(3.0, True) == "level"
    assert level_text(25.4, False) == "25\u00b0 off, hold it level"
    assert level_text(25.4, False, is_wanted=False) == "25\u00b0 from level"
    assert "was seen" in posture_text(ArmPosture.START, was_stop_seen=True)
    assert "Bring it to the stop posture" in posture_text(ArmPosture.NEITHER, was_stop_seen=False)
