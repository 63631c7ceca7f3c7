import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from gestureapp.recognition.network import Network


def sigmoid(z):
    return 1.0 / (1.0 + math.exp(-z))


def network_of(seed=0, shape=(9, 10, 12), scale=3.0):
    rng = np.random.default_rng(seed)
    inputs, hidden, outputs = shape
    return Network(
        rng.normal(0, scale, (hidden, inputs)),
        rng.normal(0, scale, hidden),
        rng.normal(0, scale, (outputs, hidden)),
        rng.normal(0, scale, outputs),
    )


def test_a_pass_is_equation_five_of_the_paper_neuron_by_neuron():
    network = network_of()
    x = np.linspace(-1.0, 1.0, 9)

    hidden = [
        sigmoid(sum(w * v for w, v in zip(row, x, strict=True)) + bias)
        for row, bias in zip(network.hidden, network.hidden_bias, strict=True)
    ]
    expected = [
        sigmoid(sum(w * v for w, v in zip(row, hidden, strict=True)) + bias)
        for row, bias in zip(network.output, network.output_bias, strict=True)
    ]

    assert network.outputs(x).tolist() == pytest.approx(expected, abs=1e-12)


def test_many_patterns_at_once_give_the_same_as_one_by_one():
    network = network_of(1)
    patterns = np.random.default_rng(2).normal(0, 1, (20, 9))

    together = network.outputs(patterns)

    for pattern, outputs in zip(patterns, together, strict=True):
        assert np.allclose(network.outputs(pattern), outputs, atol=1e-12)


@given(arrays(np.float64, 9, elements=st.floats(-1e300, 1e300)))
def test_outputs_stay_between_zero_and_one_for_any_finite_input(x):
    outputs = network_of(3, scale=1.0).outputs(x)

    assert np.all((outputs >= 0.0) & (outputs <= 1.0))


def test_a_nan_never_reaches_the_threshold():
    x = np.zeros(9)
    x[4] = np.nan

    assert not np.any(network_of().outputs(x) >= 0.5)


def test_weights_are_copied_and_cannot_be_written():
    hidden = np.zeros((2, 3))
    network = Network(hidden, np.zeros(2), np.zeros((1, 2)), np.zeros(1))
    hidden[0, 0] = 7.0

    assert network.hidden[0, 0] == 0.0
    with pytest.raises(ValueError, match="read-only"):
        network.hidden[0, 0] = 1.0


@pytest.mark.parametrize(
    "shapes",
    [
        ((10, 9), (9,), (12, 10), (12,)),
        ((10, 9), (10,), (12, 9), (12,)),
        ((9,), (1,), (1, 1), (1,)),
    ],
)
def test_shapes_that_do_not_fit_are_refused(shapes):
    with pytest.raises(ValueError, match="weights"):
        Network(*(np.zeros(shape) for shape in shapes))


def test_weights_that_are_not_finite_are_refused():
    with pytest.raises(ValueError, match="not finite"):
        Network(np.full((2, 3), np.inf), np.zeros(2), np.zeros((1, 2)), np.zeros(1))
