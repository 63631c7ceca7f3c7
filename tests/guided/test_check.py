"""Odd takes come first, whatever the others are; the map always gives the same picture."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from gestureapp.gestures import LABELS
from gestureapp.guided.check import (
    GRID_S,
    LEAST_TO_COMPARE,
    ODD_RATIO,
    check_gesture,
    distance_g,
    map_takes,
    resample,
)
from gestureapp.recording.take_values import Judgement, Take, Verdict
from gestureapp.simulation.takes import make_takes

GOOD = Judgement(Verdict.GOOD, "good")
GAP = Judgement(Verdict.GAP, "gap of 43 ms")


def take(
    number: int,
    accel_g,
    times_s=GRID_S,
    label: str = "X+",
    judgement: Judgement = GOOD,
    is_excluded: bool = False,
) -> Take:
    return Take(
        number, label, "2026-11-23", 1.0 * number, judgement, is_excluded, False, times_s, accel_g
    )


def wave(size: float = 1.0, late_s: float = 0.0) -> np.ndarray:
    accel = np.zeros((len(GRID_S), 3))
    accel[:, 0] = size * np.exp(-(((GRID_S - late_s) / 0.1) ** 2))
    accel[:, 2] = 1.0
    return accel


def alike(n: int = 9) -> list[Take]:
    return [take(i, wave(1.0 + 0.02 * i)) for i in range(1, n + 1)]


def simulated(n: int = 8, seed: int = 3) -> list[Take]:
    made = make_takes(1, n, seed, practised=True)
    return [
        take(
            i + 1,
            made.accel_g(i),
            (np.arange(len(made.accel_g(i))) - int(made.activation[i]) + 0.4) / 100.0,
            made.labels[i],
        )
        for i in range(len(made))
    ]


def test_a_late_take_comes_first_and_says_how_far_it_is():
    check = check_gesture("X+", [take(50, wave(late_s=0.3)), *alike()])
    assert check.takes[0].take.id == 50
    assert check.takes[0].is_odd
    assert check.takes[0].words.endswith("× as far as usual")
    assert check.n_odd == 1


def test_takes_that_do_not_count_come_last_and_move_no_median():
    spoilt = [
        take(50, wave(-3.0), judgement=GAP),
        take(51, wave(-3.0), is_excluded=True),
    ]
    check = check_gesture("X+", [*spoilt, *alike()])
    assert {each.take.id for each in check.takes[-2:]} == {50, 51}
    assert not check.takes[-1].is_odd
    np.testing.assert_array_equal(check.median_g, check_gesture("X+", alike()).median_g)


def test_takes_keep_the_number_they_have_by_age():
    check = check_gesture("X+", [take(7, wave(late_s=0.4)), take(30, wave()), *alike(3)])
    numbers = {each.take.id: each.number for each in check.takes}
    assert numbers == {1: 1, 2: 2, 3: 3, 7: 4, 30: 5}


def test_too_few_takes_are_not_compared():
    check = check_gesture("X+", alike(LEAST_TO_COMPARE - 1))
    assert {each.words for each in check.takes} == {"too few to compare"}
    assert check.n_odd == 0


def test_takes_that_differ_by_noise_only_are_all_alike():
    rng = np.random.default_rng(1)
    takes = [take(i, wave() + rng.normal(0.0, 0.001, (len(GRID_S), 3))) for i in range(9)]
    assert check_gesture("X+", [*takes, take(20, wave(1.02))]).n_odd == 0


@pytest.mark.parametrize("takes", [[], [take(1, np.zeros((0, 3)), np.zeros(0))]])
def test_nothing_to_look_at_is_no_error(takes):
    check = check_gesture("X+", takes)
    assert check.takes == ()
    assert check.median_g.shape == (len(GRID_S), 3)
    assert map_takes(takes).ids == ()


def test_what_is_handed_out_cannot_be_changed():
    check = check_gesture("X+", alike())
    shown = map_takes(alike())
    for array in (check.curves_g, check.median_g, check.low_g, check.high_g, shown.points):
        assert not array.flags.writeable


def test_nine_of_ten_wrong_gestures_among_a_practised_persons_takes_are_found():
    takes = simulated()
    n_found = 0
    for label in LABELS:
        own = [each for each in takes if each.label == label]
        stray = next(each for each in takes if each.label == LABELS[-1 - LABELS.index(label)])
        check = check_gesture(label, [*own, take(1000, stray.accel_g, stray.times_s, label)])
        n_found += check.takes[0].take.id == 1000 and check.takes[0].ratio >= ODD_RATIO
    assert n_found >= 0.9 * len(LABELS)


@settings(max_examples=40)
@given(
    hnp.arrays(float, (7, 12, 3), elements=st.floats(-3, 3)),
    st.integers(0, 40),
    st.floats(0.005, 0.02),
)
def test_resampling_keeps_samples_that_fall_on_the_grid_and_holds_the_ends(arrays, first, step_s):
    times_s = -0.5 + 0.01 * first + step_s * np.arange(12)
    takes = [take(i, array, times_s) for i, array in enumerate(arrays)]
    np.testing.assert_allclose(resample(takes, times_s), arrays, atol=1e-6)
    ends = resample(takes, np.array([-50.0, 50.0]))
    np.testing.assert_allclose(ends[:, 0], arrays[:, 0], atol=1e-6)
    np.testing.assert_allclose(ends[:, 1], arrays[:, -1], atol=1e-6)


@settings(max_examples=40)
@given(st.permutations(range(20)), st.integers(0, 5))
def test_the_map_does_not_depend_on_the_order_of_the_takes(order, seed):
    rng = np.random.default_rng(seed)
    takes = [take(i, wave(rng.normal(), rng.normal(0.0, 0.05))) for i in range(20)]
    one, other = map_takes(takes), map_takes([takes[i] for i in order])
    for i in range(20):
        place = other.points[other.ids.index(i)]
        np.testing.assert_allclose(one.points[one.ids.index(i)], place, atol=1e-8)
    assert 0.0 <= other.shares[1] <= other.shares[0] <= 1.0
    assert sum(other.shares) <= 1.0 + 1e-9


def test_the_map_shows_equal_takes_at_one_place_and_leaves_out_those_without_a_window():
    ended = take(3, wave()[:51], GRID_S[:51])
    shown = map_takes([take(1, wave()), take(2, wave()), ended, take(4, wave(2.0))])
    assert shown.ids == (1, 2, 4)
    np.testing.assert_allclose(shown.points[0], shown.points[1])
    assert shown.points[2, 0] - shown.points[0, 0] == pytest.approx(1.0, abs=0.03)
    assert map_takes([take(1, wave()), take(2, wave())]).shares == (0.0, 0.0)


def test_two_takes_are_as_far_apart_as_their_curves():
    level = wave(0.0)
    assert distance_g(take(1, level), take(2, level + np.array([0.3, 0.0, 0.4]))) == pytest.approx(
        0.5
    )
