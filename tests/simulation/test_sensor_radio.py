"""The radio between sensor and port as a pure model: frames and time in, what arrives out."""

import itertools
import random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gestureapp.errors import ConfigError
from gestureapp.sensing.protocols import protocol
from gestureapp.sensing.values import Battery, Frame, Identity, Side
from gestureapp.simulation.sensor_model import Emission, SensorModel
from gestureapp.simulation.sensor_radio import BLUETOOTH, DIRECT, LINKS, Radio, RadioOptions

PERIOD_S = 0.01


def frame(n: int) -> Emission:
    return Emission(b"%d,0,0,1\n" % n, n, (0.0, 0.0, 1.0))


def carried(options: RadioOptions, count: int, seed: int = 1) -> list[tuple[float, list[int]]]:
    """What arrives, and when, of so many frames at 100 Hz; ticks without arrivals are left out."""
    radio = Radio(options, random.Random(seed))
    arrivals = []
    for n in range(count):
        now_s = n * PERIOD_S
        arrived = radio.carry(now_s, [frame(n)], PERIOD_S)
        if arrived:
            arrivals.append((now_s, [one.counter for one in arrived]))
    return arrivals


def gaps_s(arrivals: list[tuple[float, list[int]]]) -> list[float]:
    return [after - before for (before, _), (after, _) in itertools.pairwise(arrivals)]


def test_a_cable_gives_every_frame_at_once():
    assert carried(DIRECT, 5) == [(pytest.approx(n * PERIOD_S), [n]) for n in range(5)]


def test_bluetooth_gives_bursts_with_gaps_of_20_to_60_ms():
    arrivals = carried(BLUETOOTH, 6000)
    assert min(gaps_s(arrivals)) == pytest.approx(0.02)
    assert max(gaps_s(arrivals)) == pytest.approx(0.06)
    assert {len(numbers) for _, numbers in arrivals[1:]} >= {2, 3, 4, 5, 6}


def test_bluetooth_loses_about_one_frame_in_a_thousand():
    n_arrived = sum(len(numbers) for _, numbers in carried(BLUETOOTH, 50_000))
    assert 20 <= 50_000 - n_arrived <= 100


@given(
    st.integers(1, 12),
    st.floats(0, 0.1),
    st.floats(0, 0.1),
    st.integers(0, 999),
)
def test_what_arrives_without_loss_is_everything_in_order_within_the_gaps(
    burst: int, shortest_s: float, more_s: float, seed: int
):
    options = RadioOptions(burst, (shortest_s, shortest_s + more_s))
    arrivals = carried(options, 300, seed)
    numbers = [number for _, some in arrivals for number in some]
    assert numbers == list(range(len(numbers)))
    longest_s = max(shortest_s + more_s, burst * PERIOD_S) + PERIOD_S / 2
    assert all(gap_s <= longest_s + 1e-9 for gap_s in gaps_s(arrivals))
    assert all(len(some) >= burst for _, some in arrivals)
    assert 300 - len(numbers) <= longest_s / PERIOD_S + 1


def test_the_same_seed_has_the_same_fate_and_another_one_another():
    assert carried(BLUETOOTH, 500, 3) == carried(BLUETOOTH, 500, 3)
    assert carried(BLUETOOTH, 500, 3) != carried(BLUETOOTH, 500, 4)


def test_what_is_under_way_when_the_connection_ends_is_lost():
    radio = Radio(RadioOptions(burst=3), random.Random(1))
    assert radio.carry(0.0, [frame(0), frame(1)], PERIOD_S) == ()
    radio.clear()
    assert radio.carry(0.01, [frame(2)], PERIOD_S) == ()


@pytest.mark.parametrize(
    ("options", "field"),
    [
        ({"burst": 0}, "link-burst"),
        ({"gap_s": (0.06, 0.02)}, "link-gap-ms"),
        ({"gap_s": (float("nan"), 0.1)}, "link-gap-ms"),
        ({"gap_s": (0.0, 60.0)}, "link-gap-ms"),
        ({"loss": 1.5}, "link-loss"),
        ({"clock_ppm": 1e6}, "clock-ppm"),
    ],
)
def test_a_radio_that_cannot_be_is_refused_by_name(options, field):
    with pytest.raises(ConfigError) as refusal:
        RadioOptions(**options)
    assert refusal.value.field == field


def test_links_are_known_by_name():
    assert LINKS == {"direct": DIRECT, "bluetooth": BLUETOOTH}


class _Still:
    def accel_g(self, t_s: float) -> tuple[float, float, float]:
        return (0.0, 0.0, 1.0)

    def begin(self, action: object, t_s: float) -> None:
        raise AssertionError(f"{action} at {t_s}")


def test_a_slow_clock_makes_ten_thousand_samples_last_a_second_longer():
    slow = SensorModel(Side.LEFT, _Still(), clock_ppm=10_000)
    assert 10_000 * slow.period_s == pytest.approx(101.0)


def test_a_binary_sensor_says_its_name_once_a_second_and_its_battery():
    model = SensorModel(Side.LEFT, _Still(), "binary", identity="Arm links 7", battery_percent=41)
    data = b"".join(line.data for n in range(300) for line in model.tick(n / 100))
    assert data.count(b"Arm links 7") == 3
    events = protocol("binary").new_decoder().feed(data)
    assert events[:2] == [Identity("Arm links 7"), Battery(41.0)]
    assert [type(event) for event in events[2:]] == [Frame] * 300
