"""How long the onset-aligned recogniser takes for a sample, with a network that is never sure."""

import time
from itertools import pairwise

import numpy as np

from gestureapp.benchmark.report import Report, Row
from gestureapp.clock import Clock, monotonic
from gestureapp.gestures import LABELS
from gestureapp.recognition.decision import Decision
from gestureapp.recognition.ensemble import Ensemble, Layer
from gestureapp.recognition.kinds import recogniser_for
from gestureapp.recognition.model_file import Model, TrainingRecord
from gestureapp.recognition.model_weights import KIND_ONSET
from gestureapp.recognition.window import N_INPUTS
from gestureapp.simulation.takes import make_takes

MEMBERS = 3
SHAPE = (N_INPUTS, 64, 32, len(LABELS) + 1)
RATES_HZ = (50.0, 100.0, 200.0)
PEOPLE, TAKES, SEED = 2, 4, 7
AIM = "1000 us"


def measure_hearing() -> Report:
    """Feed simulated takes to the recogniser; each sample of the budget asks the network."""
    rows: list[Row] = []
    for rate_hz in RATES_HZ:
        for kind, clock in (("", monotonic), (", processor time", time.thread_time)):
            idle, asked = _times_us(rate_hz, clock)
            rows.append(Row(f"{rate_hz:.0f} Hz, nobody activated{kind}", "us", idle, AIM))
            rows.append(Row(f"{rate_hz:.0f} Hz, an answer wanted{kind}", "us", asked, AIM))
    words = "-".join(map(str, SHAPE))
    return Report("Hearing a sample", rows, [f"{MEMBERS} members of {words}."])


def _times_us(rate_hz: float, clock: Clock) -> tuple[tuple[float, ...], tuple[float, ...]]:
    takes, model = make_takes(PEOPLE, TAKES, SEED, rate_hz=rate_hz), _unsure_model()
    idle: list[float] = []
    asked: list[float] = []
    for index in range(len(takes)):
        recogniser, to = recogniser_for(model), idle
        for k, (x, y, z) in enumerate(takes.accel_g(index).tolist()):
            if k == takes.activation[index]:
                recogniser.activate(index, k / rate_hz)
                to = asked
            begun_s = clock()
            answer = recogniser.feed(k / rate_hz, (x, y, z))
            to.append(1e6 * (clock() - begun_s))
            if answer is not None:
                to = idle
    return tuple(idle), tuple(asked)


def _unsure_model() -> Model:
    """Of the usual size; its probabilities reach no threshold."""
    rng = np.random.default_rng(SEED)
    layers = [
        Layer(rng.normal(0.0, 0.01, (MEMBERS, a, b)), np.zeros((MEMBERS, b)))
        for a, b in pairwise(SHAPE)
    ]
    zeros = np.zeros((MEMBERS, N_INPUTS))
    network = Ensemble(zeros, zeros + 1.0, tuple(layers))
    record = TrainingRecord("none", "random weights", 0, 0.0, SEED, 0, 0.0, 0.0)
    decision = Decision(early=1.0, last=1.0)
    return Model(KIND_ONSET, LABELS, network, "", record, "", "", "", decision=decision)
