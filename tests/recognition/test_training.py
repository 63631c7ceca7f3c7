import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

from gestureapp.errors import NotEnoughTakes
from gestureapp.recognition import training
from gestureapp.recognition.folds import FoldBy
from gestureapp.recognition.hearing import evaluate
from gestureapp.recognition.presets import Preset
from gestureapp.recognition.takes import TakeSet
from gestureapp.recognition.training import train
from gestureapp.simulation.takes import make_takes


def easy_takes(labels=("wave", "X-", "X+"), count=10, seed=0, rate_hz=50.0, length=8):
    """Takes that differ by a strong push along one axis; the activation is their third sample."""
    rng = np.random.default_rng(seed)
    parts, names = [], []
    for k, label in enumerate(labels):
        for _ in range(count):
            part = rng.normal([0.0, 0.0, 1.0], 0.05, (length, 3))
            part[2:, k % 3] += 1.0 if k < 3 else -1.0
            parts.append(part)
            names.append(label)
    offsets = np.cumsum([0, *(len(part) for part in parts)])
    activation = np.full(len(names), 2)
    return TakeSet(np.concatenate(parts), offsets, tuple(names), activation, rate_hz=rate_hz)


SMALL_NETWORKS = (Preset.PAPER, Preset.SMALL)


@pytest.fixture
def few_cycles(monkeypatch):
    """The same rules with fewer passes, to keep the suite quick."""
    monkeypatch.setattr(training, "PAPER_CYCLES", 2_000)
    monkeypatch.setattr(training, "SMALL_CYCLES", 400)


@pytest.mark.usefixtures("few_cycles")
@pytest.mark.parametrize("preset", SMALL_NETWORKS)
def test_any_gesture_names_at_any_rate_are_learned(preset):
    model = train(easy_takes(), preset, seed=1)

    assert model.labels == ("X+", "X-", "wave")
    assert model.shape == (9, 10, 3)
    assert evaluate(model, easy_takes(seed=5)).recognised > 0.95


@pytest.mark.usefixtures("few_cycles")
@pytest.mark.parametrize("preset", SMALL_NETWORKS)
def test_a_seed_gives_the_same_weights_and_another_seed_others(preset):
    first, again, other = (train(easy_takes(), preset, seed).network for seed in (1, 1, 2))

    assert np.array_equal(first.hidden, again.hidden)
    assert np.array_equal(first.output_bias, again.output_bias)
    assert not np.array_equal(first.hidden, other.hidden)


@pytest.mark.usefixtures("few_cycles")
def test_progress_is_told_in_order_up_to_the_end_and_the_error_falls():
    told = []

    train(easy_takes(), Preset.PAPER, 0, lambda *now: told.append(now))

    assert [done for done, _, _ in told] == sorted({done for done, _, _ in told})
    assert told[-1][:2] == (2_000, 2_000)
    assert told[-1][2] < 0.2 * told[0][2]


@pytest.mark.usefixtures("few_cycles")
def test_what_progress_raises_ends_the_training():
    class CancelledError(Exception):
        pass

    def cancel(done, total, loss):
        raise CancelledError

    with pytest.raises(CancelledError):
        train(easy_takes(), Preset.SMALL, 0, cancel)


@pytest.mark.usefixtures("few_cycles")
def test_the_record_says_what_made_the_model():
    takes = easy_takes()
    now = iter([10.0, 12.5])

    model = train(takes, Preset.PAPER, 4, clock=lambda: next(now), takes_from="a test")

    record = model.training
    assert (record.preset, record.cycles, record.learning_rate) == ("paper", 2_000, 0.25)
    assert (record.seed, record.n_takes, record.duration_s) == (4, 30, 2.5)
    assert record.takes_from == "a test"
    assert model.takes_fingerprint == takes.fingerprint()


@pytest.mark.usefixtures("few_cycles")
@pytest.mark.parametrize("preset", SMALL_NETWORKS)
def test_no_network_of_the_cross_validation_hears_what_it_was_trained_with(preset):
    """Labels by chance: whoever has seen a take knows it; whoever has not can only guess."""
    takes = easy_takes(labels=("a", "b"), count=20, seed=3)
    guessed = np.random.default_rng(0).permutation(takes.labels)
    model = train(replace(takes, labels=tuple(guessed.tolist())), preset, seed=1)

    blind = model.cross_validation.evaluation
    assert blind.n == 40
    assert blind.recognised < 0.75


@pytest.mark.usefixtures("few_cycles")
@pytest.mark.parametrize("preset", SMALL_NETWORKS)
def test_changing_a_fold_changes_nothing_in_the_network_that_hears_it(preset, monkeypatch):
    heard = []
    monkeypatch.setattr(
        training, "_cross_validate", lambda _m, found: heard.append(found.networks[1:])
    )
    takes = easy_takes(labels=("a", "b"), count=10)
    first_fold = [0, 1, 10, 11]
    samples = takes.samples.copy()
    for take in first_fold:
        samples[8 * take : 8 * take + 8] += 0.5

    train(takes, preset, seed=1)
    train(replace(takes, samples=samples), preset, seed=1)

    assert np.array_equal(heard[0][0].hidden, heard[1][0].hidden)
    assert np.array_equal(heard[0][0].output, heard[1][0].output)
    assert not np.array_equal(heard[0][1].hidden, heard[1][1].hidden)


@pytest.mark.usefixtures("few_cycles")
def test_the_model_is_the_same_with_and_without_a_cross_validation():
    with_it = train(easy_takes(), Preset.SMALL, 1)
    without = train(easy_takes(), Preset.SMALL, 1, is_validated=False)

    assert without.cross_validation is None
    assert np.allclose(with_it.network.hidden, without.network.hidden, atol=1e-3)


@pytest.mark.usefixtures("few_cycles")
def test_the_figures_say_how_the_takes_were_divided_and_count_every_whole_take():
    takes = easy_takes(count=8)
    short = np.concatenate([takes.samples, np.zeros((2, 3))])
    takes = TakeSet(
        short,
        [*takes.offsets, len(short)],
        (*takes.labels, "X+"),
        [*takes.activation, 0],
        session=("monday", "friday") * 12 + ("friday",),
    )

    model = train(takes, Preset.SMALL, 1)

    assert model.cross_validation.folds == "by session: 2 sessions"
    assert model.cross_validation.evaluation.n == 24
    assert model.training.n_takes == 24
    assert train(takes, Preset.SMALL, folds=FoldBy.TIME).cross_validation.folds.startswith(
        "by time: 5 blocks"
    )


def one_step_by_hand(takes, seed):
    """One cycle of the paper's rule by finite differences of the error it says it descends."""
    rng = np.random.default_rng([seed, 0])
    first = rng.uniform(-0.5, 0.5, (1, 10, 10))[0]
    second = rng.uniform(-0.5, 0.5, (1, 11, 3))[0]
    x = np.array([takes.accel_g(i)[2:5].reshape(-1) for i in range(len(takes))])
    t = np.array([[label == name for name in ("X+", "X-", "wave")] for label in takes.labels])

    def error():
        h = 1 / (1 + np.exp(-(x @ first[:9] + first[9])))
        y = 1 / (1 + np.exp(-(h @ second[:10] + second[10])))
        return 0.5 * np.sum((y - t) ** 2) / len(x)

    def slope(weights, at):
        weights[at] += 1e-6
        above = error()
        weights[at] -= 2e-6
        below = error()
        weights[at] += 1e-6
        return (above - below) / 2e-6

    steps = [np.array([slope(w, at) for at in np.ndindex(w.shape)]) for w in (first, second)]
    return [
        w - 0.25 * step.reshape(w.shape) for w, step in zip((first, second), steps, strict=True)
    ]


def test_a_cycle_of_the_paper_preset_is_the_rule_it_says_it_is(monkeypatch):
    monkeypatch.setattr(training, "PAPER_CYCLES", 1)
    monkeypatch.setattr(training, "PAPER_REPORTS", 1)
    takes = easy_takes()

    network = train(takes, Preset.PAPER, 9).network

    first, second = one_step_by_hand(takes, 9)
    assert np.allclose(network.hidden, first[:9].T, atol=1e-6)
    assert np.allclose(network.hidden_bias, first[9], atol=1e-6)
    assert np.allclose(network.output, second[:10].T, atol=1e-6)
    assert np.allclose(network.output_bias, second[10], atol=1e-6)


def test_too_few_takes_are_named_by_gesture():
    with pytest.raises(NotEnoughTakes, match="only 4 of X\\+, 4 of X-, 4 of wave"):
        train(easy_takes(count=4), Preset.SMALL, 0)


def test_takes_that_end_before_the_third_sample_do_not_count():
    with pytest.raises(NotEnoughTakes, match="only 0 of X\\+"):
        train(easy_takes(length=4), Preset.SMALL, 0)


@pytest.mark.parametrize("takes", [easy_takes(labels=("X+",)), easy_takes().select([])])
def test_one_gesture_or_none_is_not_enough(takes):
    with pytest.raises(NotEnoughTakes, match="at least two gestures"):
        train(takes, Preset.SMALL, 0)


def test_the_small_preset_learns_an_ordinary_person_well_enough_to_use(monkeypatch):
    monkeypatch.setattr(training, "SMALL_CYCLES", 500)
    takes = make_takes(1, 20, seed=7)
    fresh = make_takes(1, 30, seed=7, session=2)

    result = evaluate(train(takes, Preset.SMALL, 1), fresh)

    assert result.recognised > 0.6
    shares = result.per_gesture()
    assert min(shares[label][0] for label in ("RX+", "RX-", "RY+", "RY-")) > 0.95


@pytest.mark.process
def test_recognising_does_not_import_torch():
    code = (
        "import sys; import gestureapp.recognition.paper, gestureapp.recognition.hearing, "
        "gestureapp.recognition.model_file, gestureapp.recognition.training; "
        "sys.exit('torch' in sys.modules)"
    )

    assert subprocess.run([sys.executable, "-c", code], check=False, timeout=60).returncode == 0


def test_a_start_whose_network_with_all_takes_is_lost_on_a_gesture_is_not_kept():
    n_checks = training.EARLIEST_STOP // training.CHECK_EVERY + 2
    losses = np.full((n_checks, training.SMALL_STARTS, 2), 0.10)
    losses[-1, 0] = (0.01, 0.20)  # the least error without the held-out takes, but lost with all
    losses[-2, 1] = (0.02, 0.01)
    n_networks = 2 * training.SMALL_STARTS
    numbers = np.arange(n_networks, dtype=np.float64)[:, None, None]
    kept = [
        (np.zeros((n_networks, 10, 10)), np.zeros((n_networks, 2, 11)) + 100.0 * check + numbers)
        for check in range(n_checks)
    ]
    outcome = training._stopped(losses, kept, 0)
    assert outcome.cycles == (n_checks - 1) * training.CHECK_EVERY
    assert outcome.loss == pytest.approx(0.02)
    assert outcome.network.output_bias[0] == 100.0 * (n_checks - 2) + 3
