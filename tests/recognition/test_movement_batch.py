import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gestureapp.recognition.movement import LEVEL, Follower
from gestureapp.recognition.movement_batch import Streams, follow_all, moments_at
from gestureapp.recognition.window import N_INPUTS, inputs_of

FIELDS = ("cells_g", "is_full", "elapsed_s", "baseline_g", "now_g", "is_still", "quality")


def streams_of(seed, rate_hz, n_takes=3):
    """Takes with rest, a push, tremor and a held tilt; some samples lost, times shaken."""
    rng = np.random.default_rng(seed)
    n = int(1.4 * rate_hz)
    times, accel = np.zeros((n_takes, n)), np.zeros((n_takes, n, 3))
    lengths = np.zeros(n_takes, np.int64)
    for k in range(n_takes):
        even = np.arange(n) / rate_hz
        begin, size = rng.uniform(-0.1, 0.9), rng.normal(0.0, 0.8, 3)
        inside = (even > begin) & (even < begin + 0.5)
        push = np.sin(2 * np.pi * (even - begin) / 0.5) * inside
        tilt = np.clip((even - begin - 0.5) / 0.2, 0.0, 1.0) * rng.uniform(0.0, 1.0)
        noise = rng.normal(0.0, rng.choice([0.003, 0.02, 0.06]), (n, 3))
        readings = LEVEL + push[:, None] * size + tilt[:, None] * np.array([0.9, 0.0, -0.6]) + noise
        keep = rng.random(n) > rng.choice([0.0, 0.1])
        keep[0] = True
        m = int(keep.sum())
        shaken = np.maximum.accumulate(even[keep] + np.abs(rng.normal(0.0, 0.002, m)))
        times[k, :m], accel[k, :m], lengths[k] = shaken, readings[keep], m
        times[k, m:] = shaken[-1] + np.arange(1, n - m + 1) / rate_hz
        accel[k, m:] = readings[keep][-1]
    return Streams(times, accel, lengths)


@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 10**6), rate_hz=st.sampled_from([50, 100, 200]))
def test_many_takes_at_once_give_the_numbers_of_one_by_one(seed, rate_hz):
    streams = streams_of(seed, rate_hz)
    followed = follow_all(streams, onset_g=0.13)

    for take in range(len(streams.times_s)):
        follower = Follower(onset_g=0.13)
        for i in range(int(streams.n_samples[take])):
            follower.feed(float(streams.times_s[take, i]), tuple(streams.accel_g[take, i].tolist()))
            assert follower.is_moving == followed.is_moving[take, i]
            assert follower.is_still == followed.is_still[take, i]
            assert follower.is_posture == followed.is_posture[take, i]
            assert follower.onset_s == pytest.approx(
                followed.onset_s[take, i], abs=1e-9, nan_ok=True
            )
            if follower.moment().elapsed_s < 0.9:
                one = follower.moment()
                many = moments_at(followed, np.array([take]), np.array([i]))
                for name in FIELDS:
                    assert np.allclose(getattr(one, name), getattr(many, name)[0], atol=1e-8), name
                assert np.allclose(inputs_of(one), inputs_of(many)[0], atol=1e-7)


def test_an_onset_that_might_have_been_elsewhere_moves_the_cells():
    streams = streams_of(3, 100)
    followed = follow_all(streams)
    takes, samples = np.nonzero(followed.is_moving & (followed.elapsed_s < 0.3))

    as_found = moments_at(followed, takes, samples)
    later = moments_at(followed, takes, samples, np.full(len(takes), 0.004))

    assert np.allclose(later.elapsed_s, np.maximum(as_found.elapsed_s - 0.004, 0.0))
    assert inputs_of(later).shape == (len(takes), N_INPUTS)
