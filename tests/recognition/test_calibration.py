"""The early decision on tables of probabilities, and the thresholds that keep the promise."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gestureapp.recognition import base
from gestureapp.recognition.base import load_base
from gestureapp.recognition.calibration import (
    FEWEST,
    MOST_WRONG,
    Promise,
    calibrate,
    decided,
    promise_of,
    questions_of,
    shares_at,
)
from gestureapp.recognition.decision import EARLY, LAST
from gestureapp.recognition.evaluation import tally
from gestureapp.recognition.hearing import hear
from gestureapp.recognition.model_file import CrossValidation, load_model
from gestureapp.recognition.movement_batch import follow_all, moments_at
from gestureapp.recognition.onset_views import streams_of
from gestureapp.recognition.window import inputs_of
from gestureapp.simulation.takes import make_takes


def sums_of(shares):
    return np.log(np.asarray(shares, dtype=float))[None]


def test_a_take_is_heard_early_or_at_its_last_question_or_not_at_all():
    take = np.array([0, 0, 1, 1, 2, 2, 3])
    shares = [[0.6, 0.4], [0.1, 0.9], [0.96, 0.04], [0.1, 0.9], [0.5, 0.5], [0.7, 0.3], [0.5, 0.5]]

    heard = decided(take, np.array(shares), 0.95, 0.6, 5)

    # 0: the last question says "none of them"; 1: sure at once; 2: sure enough at the end.
    assert heard.tolist() == [-1, 0, 0, -1, -1]


@given(st.integers(0, 30), st.integers(FEWEST, 400), st.integers(0, 1000))
def test_thresholds_keep_the_promise_or_come_as_near_as_any(n_wrong, n_takes, seed):
    rng = np.random.default_rng(seed)
    sure = rng.uniform(0.5, 0.999, n_takes)
    said = np.zeros(n_takes, dtype=np.int64)
    said[:n_wrong] = 1
    sure[:n_wrong] = rng.uniform(0.5, 0.9, n_wrong)  # what is wrong is less sure
    shares = np.full((n_takes, 3), 1e-6)
    shares[np.arange(n_takes), said] = sure
    shares[:, 2] = 1.0 - sure

    outputs = np.zeros(n_takes, dtype=np.int64)
    found = calibrate(np.arange(n_takes), sums_of(shares), outputs)

    assert EARLY <= found.early < 1.0
    assert LAST <= found.last <= found.early
    at = shares_at(sums_of(shares), found.temperature)

    def expected(early, last):
        heard = decided(np.arange(n_takes), at, early, last, n_takes)
        return ((heard == 1).sum() + 1) / ((heard >= 0).sum() + 2)

    others = [expected(EARLY, LAST), expected(0.98, 0.8), expected(0.995, 0.9)]
    assert expected(found.early, found.last) <= max(MOST_WRONG, min(others))


@pytest.mark.parametrize(
    ("right", "wrong", "silent", "promise"),
    [
        (198, 0, 40, Promise.KEPT),
        (197, 0, 200, Promise.UNKNOWN),
        (398, 0, 0, Promise.KEPT),
        (397, 1, 0, Promise.KEPT),
        (396, 1, 9, Promise.NOT_SHOWN),
        (198, 1, 0, Promise.NOT_SHOWN),
    ],
)
def test_the_promise_is_kept_not_shown_or_not_known(right, wrong, silent, promise):
    answers = [("X+", "X+")] * right + [("X+", "X-")] * wrong + [("X+", None)] * silent
    validation = CrossValidation(tally(("X+", "X-"), answers), "by hand")

    found, why = promise_of(replace(load_model(base.BASE), cross_validation=validation))

    assert found is promise
    assert f"{wrong} of {right + wrong} answers" in why


def test_nothing_heard_blind_promises_nothing():
    model = load_model(base.BASE)

    assert promise_of(model)[0] is Promise.UNKNOWN
    assert promise_of(replace(model, decision=None)) is None


def test_few_takes_change_nothing():
    outputs = np.zeros(FEWEST - 1, dtype=np.int64)
    sums = sums_of(np.tile([0.1, 0.8, 0.1], (FEWEST - 1, 1)))

    found = calibrate(np.arange(FEWEST - 1), sums, outputs)

    assert (found.early, found.last, found.temperature) == (EARLY, LAST, 1.0)


def test_takes_are_asked_about_where_the_recogniser_asks():
    takes = make_takes(2, 2, seed=8001)
    model, ensemble = load_model(base.BASE), load_base().ensemble
    followed = follow_all(streams_of(takes), model.decision.onset_g)
    asked = questions_of(followed)
    shares = ensemble.outputs(inputs_of(moments_at(followed, asked.take, asked.sample)))

    heard = decided(asked.take, shares, model.decision.early, model.decision.last, len(takes))

    names = [model.labels[k] if k >= 0 else None for k in heard]
    assert names == [hear(model, takes, row).label for row in range(len(takes))]
