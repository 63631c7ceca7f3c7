"""Fitting a calibration: what is found, what is left, what is refused."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gestureapp.sensing.calibration import NOMINAL
from gestureapp.setup.fit import UP, fit_calibration
from tests.setup.lying import ALL, OFF, OFF_OFFSET_G, turn

TRUTH = np.array([UP[position] for position in ALL])


def read(sensor=OFF, offset_g=OFF_OFFSET_G, askew=None):
    truth = (
        TRUTH
        if askew is None
        else np.array([turn(a) @ t for a, t in zip(askew, TRUTH, strict=True)])
    )
    return truth @ np.asarray(sensor).T + np.asarray(offset_g)


def left_mg(fit, sensor, offset_g, seed=0):
    """What is left in any direction, root of the mean square."""
    anywhere = np.random.default_rng(seed).standard_normal((300, 3))
    anywhere /= np.linalg.norm(anywhere, axis=1)[:, None]
    corrected = [fit.calibration.applied(tuple(sensor @ t + offset_g)) for t in anywhere]
    return 1000 * float(np.sqrt(np.mean((np.linalg.norm(corrected, axis=1) - 1) ** 2)))


_ERROR = st.floats(-0.1, 0.1)


@given(gains=st.tuples(_ERROR, _ERROR, _ERROR), offset=st.tuples(_ERROR, _ERROR, _ERROR))
def test_gain_and_offset_are_taken_out(gains, offset):
    sensor = np.diag(1.0 + np.array(gains))
    fit = fit_calibration(read(sensor, offset), ALL)
    assert fit.is_good
    assert fit.calibration.offset_g == pytest.approx(offset, abs=1e-3)
    assert left_mg(fit, sensor, np.array(offset)) < 1.0
    assert fit.after_mg <= fit.before_mg + 0.5


@settings(max_examples=40)
@given(askew=st.tuples(*[st.floats(-4, 4)] * 3))
def test_a_sensor_askew_in_its_box_is_turned_into_it(askew):
    sensor = OFF @ turn(askew)
    fit = fit_calibration(read(sensor), ALL)
    assert fit.is_good
    for truth in TRUTH:
        nominal = tuple(sensor @ truth + OFF_OFFSET_G)
        assert fit.calibration.applied(nominal) == pytest.approx(truth, abs=0.02)


@settings(max_examples=40)
@given(
    seed=st.integers(0, 10_000),
    order=st.permutations(range(6)),
)
def test_sides_a_degree_askew_leave_little_and_the_order_does_not_matter(seed, order):
    askew = np.random.default_rng(seed).uniform(-1.0, 1.0, (6, 3))
    means = read(askew=askew)
    fit = fit_calibration(means, ALL)
    assert fit.is_good
    assert left_mg(fit, OFF, OFF_OFFSET_G) < 20.0
    other = fit_calibration(means[list(order)], [ALL[k] for k in order])
    assert np.allclose(other.calibration.matrix, fit.calibration.matrix)


@pytest.mark.parametrize(
    ("sensor", "offset_g", "words"),
    [
        (np.diag([1.25, 1, 1]), (0, 0, 0), "axis X reads 1.25 g for 1 g, up to 20% off"),
        (np.diag([1, 0.7, 1]), (0, 0, 0), "axis Y reads 0.70 g for 1 g"),
        (np.eye(3), (0, 0, 0.35), "axis Z reads +0.35 g where 0 is"),
        (turn((0, 0, 9)), (0, 0, 0), "one axis reads 1"),
    ],
)
def test_what_no_such_sensor_has_is_refused(sensor, offset_g, words):
    fit = fit_calibration(read(sensor, offset_g), ALL)
    assert not fit.is_good
    assert fit.verdict.startswith("Refused: ")
    assert words in fit.verdict


@pytest.mark.parametrize("gain", [0.81, 1.19])
def test_what_lies_just_within_the_limits_is_taken(gain):
    fit = fit_calibration(read(np.diag([gain, 1, 1]), (0.29, 0, -0.29)), ALL)
    assert fit.is_good


@pytest.mark.parametrize("position", ALL)
def test_the_one_position_that_was_not_flat_is_the_one_that_is_named(position):
    askew = [(6.0, 8.0, -7.0) if one is position else (0.0, 0.0, 0.0) for one in ALL]
    fit = fit_calibration(read(askew=askew), ALL)
    axis, _, way = position.value.partition("-")
    assert fit.verdict.startswith(f"Not flat: with {axis.upper()} {way} ")


@pytest.mark.parametrize(
    "means", [np.zeros((6, 3)), np.full((6, 3), np.nan), np.full((6, 3), np.inf), TRUTH * [1, 1, 0]]
)
def test_readings_that_tell_nothing_are_refused(means):
    fit = fit_calibration(means, ALL)
    assert (fit.is_good, fit.calibration) == (False, NOMINAL)
    assert fit.verdict.startswith("Refused: ")


@settings(max_examples=100)
@given(st.lists(st.floats(-5, 5), min_size=18, max_size=18))
def test_a_calibration_that_is_taken_reads_one_g_in_every_position(numbers):
    means = np.array(numbers).reshape(6, 3) * 0.3 + TRUTH
    fit = fit_calibration(means, ALL)
    if fit.is_good:
        for mean in means:
            length = np.linalg.norm(fit.calibration.applied(tuple(mean)))
            assert abs(length - 1.0) <= 0.020 + 1e-9


@pytest.mark.parametrize("positions", [ALL[:5], (*ALL[:5], ALL[0]), (*ALL, ALL[0])])
def test_each_position_is_needed_once(positions):
    with pytest.raises(ValueError, match="once"):
        fit_calibration(np.ones((len(positions), 3)), positions)
