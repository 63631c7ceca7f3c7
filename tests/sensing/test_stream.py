"""Health of a stream: the four states, the three words, the watchdog's time, the reasons."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gestureapp.sensing.stream import StreamTracker
from gestureapp.sensing.values import (
    Battery,
    Connected,
    CounterGap,
    CounterJump,
    Disconnected,
    Garbage,
    Identity,
    Impossible,
    LinkState,
    Repeated,
    Sample,
    Side,
)

TRIP_S = 0.1
UNREADABLE = Garbage(3, b"abc", "expected n,x,y,z")


class Bench:
    """A tracker with a hand on the clock and a sensor that trembles."""

    def __init__(self, connect: bool = True) -> None:
        self.now_s = 1000.0
        self.tracker = StreamTracker(Side.LEFT, TRIP_S, 70.0, 230.0)
        self._n = 0
        if connect:
            self.tracker.event(self.now_s, Connected("socket://sensor:1"))

    @property
    def health(self):
        return self.tracker.health(self.now_s)

    def wait(self, span_s: float) -> None:
        self.now_s += span_s

    def sample(self, value_g: float | None = None) -> None:
        self._n += 1
        tremble_g = 0.001 * (self._n % 7) if value_g is None else value_g
        self.tracker.sample(Sample(self.now_s, self._n, (tremble_g, 0.0, 1.0)))

    def stream(self, span_s: float, rate_hz: float = 100.0, value_g: float | None = None) -> None:
        for _ in range(round(span_s * rate_hz)):
            self.wait(1 / rate_hz)
            self.sample(value_g)

    def rubbish(self, span_s: float, garbage: Garbage = UNREADABLE) -> None:
        for _ in range(round(span_s * 100)):
            self.wait(0.01)
            self.tracker.event(self.now_s, garbage)


def test_before_the_port_was_opened_it_is_not_connected():
    health = Bench(connect=False).health
    assert health.link is LinkState.NOT_CONNECTED
    assert not health.is_alive
    assert not health.is_valid
    assert math.isinf(health.age_s)
    assert "settings" in health.reason


def test_a_failure_to_open_is_the_reason_word_for_word():
    bench = Bench(connect=False)
    bench.tracker.event(bench.now_s, Disconnected("port /dev/x not found: plug it in"))
    assert bench.health.reason == "port /dev/x not found: plug it in"


def test_open_and_silent_is_no_data_with_its_time():
    bench = Bench()
    bench.wait(0.34)
    assert bench.health.link is LinkState.NO_DATA
    assert bench.health.reason.startswith("no data for 340 ms: switch the sensor on")
    assert bench.tracker.last_valid_s(bench.now_s) is None


def test_a_good_stream_is_alive_valid_and_at_its_rate_after_two_seconds():
    bench = Bench()
    bench.stream(2.1)
    health = bench.health
    assert health.link is LinkState.RECEIVING
    assert health.is_ok
    assert health.reason == ""
    assert health.rate_hz == pytest.approx(100, abs=1)
    assert health.worst_gap_s == pytest.approx(0.01)
    assert health.n_samples == 210
    assert (health.n_bad, health.n_lost) == (0, 0)


def test_the_rate_is_not_claimed_before_two_seconds_have_passed():
    bench = Bench()
    bench.stream(1.9)
    assert bench.health.rate_hz == 0
    assert not bench.health.is_freq_ok
    assert bench.health.reason == "rate not known yet: wait 2 s"
    assert bench.health.is_alive
    assert bench.health.is_valid


def test_a_20_hz_stream_is_alive_but_not_at_its_rate():
    bench = Bench()
    bench.stream(3.0, rate_hz=20)
    health = bench.health
    assert health.is_alive
    assert not health.is_freq_ok
    assert health.rate_hz == pytest.approx(20, abs=1)
    assert health.reason.startswith("20 Hz measured, 70 to 230 Hz wanted: ")


def test_a_stream_that_is_too_fast_is_not_at_its_rate():
    bench = Bench()
    bench.stream(2.5, rate_hz=400)
    assert not bench.health.is_freq_ok
    assert bench.health.reason.startswith("400 Hz measured")


def test_half_the_lines_unreadable_says_so_beside_the_rate():
    bench = Bench()
    for _ in range(120):
        bench.stream(0.02, rate_hz=50)
        bench.tracker.event(bench.now_s, UNREADABLE)
    health = bench.health
    assert health.link is LinkState.RECEIVING
    assert not health.is_freq_ok
    assert "50 Hz measured" in health.reason
    assert "expected n,x,y,z" in health.reason
    assert health.n_bad == 120


def test_silence_ends_alive_just_over_the_trip_level():
    bench = Bench()
    bench.stream(3.0)
    bench.wait(TRIP_S - 0.001)
    assert bench.health.is_alive
    bench.wait(0.002)
    health = bench.health
    assert not health.is_alive
    assert health.is_valid
    assert health.link is LinkState.NO_DATA
    assert health.reason.startswith("no data for 101 ms")


def test_a_frozen_sensor_is_named_and_stops_counting_when_it_froze():
    bench = Bench()
    bench.stream(3.0)
    bench.sample(0.5)
    froze_s = bench.now_s
    bench.stream(0.14, value_g=0.5)
    health = bench.health
    assert bench.tracker.last_valid_s(bench.now_s) == froze_s
    assert health.link is LinkState.WRONG_DATA
    assert not health.is_alive
    assert not health.is_valid
    assert health.age_s == pytest.approx(0.14)
    assert health.reason == "frozen on one value for 140 ms: switch the sensor off and on"


def test_a_value_that_stays_for_less_than_the_trip_level_is_not_frozen():
    bench = Bench()
    bench.stream(3.0)
    bench.stream(0.09, value_g=0.5)
    assert bench.health.is_ok
    bench.stream(0.05)
    assert bench.health.is_ok


def test_a_frozen_sensor_that_moves_again_counts_again():
    bench = Bench()
    bench.stream(3.0)
    bench.stream(0.5, value_g=0.5)
    bench.stream(0.01)
    assert bench.health.link is LinkState.RECEIVING
    assert bench.tracker.last_valid_s(bench.now_s) == bench.now_s


def test_a_change_on_one_axis_is_enough():
    bench = Bench()
    for i in range(40):
        bench.wait(0.01)
        bench.tracker.sample(Sample(bench.now_s, i, (0.0, 0.0, 1.0 + 0.01 * (i % 2))))
    assert bench.health.is_alive


@pytest.mark.parametrize(
    ("garbage", "words"),
    [
        (UNREADABLE, "unreadable data for 200 ms (expected n,x,y,z): check port and protocol"),
        (
            Impossible(0, b"0,0,40", "40.0 g on Z, the sensor can give 16 g"),
            "impossible values for 200 ms (40.0 g on Z, the sensor can give 16 g): check",
        ),
        (
            Repeated(9, b"7,0,0,1", "running number 7 came twice"),
            "repeated data for 200 ms (running number 7 came twice): switch the sensor off and on",
        ),
    ],
)
def test_data_that_is_never_a_sample_stops_counting_and_is_named(garbage: Garbage, words: str):
    bench = Bench()
    bench.stream(3.0)
    last_s = bench.now_s
    bench.rubbish(0.2, garbage)
    health = bench.health
    assert bench.tracker.last_valid_s(bench.now_s) == last_s
    assert health.link is LinkState.WRONG_DATA
    assert not health.is_alive
    assert not health.is_valid
    assert health.reason.startswith(words)
    assert health.n_bad == 20


def test_one_bad_line_among_good_ones_changes_only_the_count():
    bench = Bench()
    bench.stream(3.0)
    bench.tracker.event(bench.now_s, UNREADABLE)
    assert bench.health.is_ok
    assert bench.health.n_bad == 1


def test_silence_after_rubbish_becomes_no_data():
    bench = Bench()
    bench.rubbish(0.5)
    assert bench.health.link is LinkState.WRONG_DATA
    bench.wait(1.5)
    assert bench.health.link is LinkState.NO_DATA


def test_silence_after_frozen_becomes_no_data():
    bench = Bench()
    bench.stream(1.0, value_g=0.5)
    bench.wait(0.2)
    assert bench.health.link is LinkState.NO_DATA


@pytest.mark.parametrize("n_equal", [1, 2, 4])
def test_silence_after_a_few_equal_readings_is_told_as_silence(n_equal: int):
    bench = Bench()
    bench.stream(3.0)
    bench.stream(0.01 * (n_equal + 1), value_g=0.5)
    bench.wait(TRIP_S + 0.002 - 0.01 * n_equal)
    health = bench.health
    assert health.age_s > TRIP_S
    assert health.link is LinkState.NO_DATA
    assert "no data" in health.reason


def test_readings_that_stay_equal_are_told_as_frozen():
    bench = Bench()
    bench.stream(3.0)
    bench.stream(TRIP_S + 0.02, value_g=0.5)
    assert bench.health.link is LinkState.WRONG_DATA
    assert "frozen on one value" in bench.health.reason


def test_a_gap_in_the_running_numbers_is_counted_as_lost():
    bench = Bench()
    bench.tracker.event(bench.now_s, CounterGap(5))
    bench.tracker.event(bench.now_s, CounterGap(2))
    assert bench.health.n_lost == 7


@pytest.mark.parametrize("event", [CounterJump(5000, 4500), CounterGap(500)])
def test_a_sensor_whose_clock_jumps_is_not_used_until_it_has_been_judged_anew(event):
    bench = Bench()
    bench.stream(3.0)
    bench.wait(0.01)
    bench.tracker.event(bench.now_s, event)
    bench.sample()
    assert "running number jumped" in bench.health.reason
    bench.stream(1.9)
    assert not bench.health.is_ok
    bench.stream(0.2)
    assert bench.health.is_ok


def test_frames_that_were_lost_in_the_time_they_take_are_no_jump():
    bench = Bench()
    bench.stream(3.0)
    bench.wait(0.05)
    bench.tracker.event(bench.now_s, CounterGap(5))
    bench.sample()
    assert bench.health.is_ok


def test_a_lost_port_is_not_alive_although_the_last_sample_is_fresh():
    bench = Bench()
    bench.stream(3.0)
    bench.tracker.event(bench.now_s, Disconnected("gone: plug it in"))
    health = bench.health
    assert health.link is LinkState.NOT_CONNECTED
    assert not health.is_alive
    assert health.reason == "gone: plug it in"
    assert health.age_s == 0


def test_a_new_connection_is_judged_by_its_own_samples():
    bench = Bench()
    bench.stream(3.0)
    bench.tracker.event(bench.now_s, Disconnected("gone"))
    bench.tracker.event(bench.now_s, Connected("x"))
    assert bench.health.link is LinkState.NO_DATA
    bench.stream(0.05)
    assert bench.health.link is LinkState.RECEIVING
    assert bench.health.rate_hz == 0
    bench.stream(2.1)
    assert bench.health.is_ok
    assert bench.health.n_samples == 515


def test_samples_that_were_received_before_the_owner_heard_of_the_connection_count():
    bench = Bench(connect=False)
    bench.tracker.event(bench.now_s + 0.05, Connected("x"))
    bench.sample()
    bench.wait(0.06)
    assert bench.health.link is LinkState.RECEIVING


def test_a_frozen_sensor_gains_nothing_by_a_new_connection():
    bench = Bench()
    bench.stream(1.0, value_g=0.5)
    bench.tracker.event(bench.now_s, Disconnected("gone"))
    bench.tracker.event(bench.now_s, Connected("x"))
    bench.stream(0.05, value_g=0.5)
    assert bench.health.link is LinkState.WRONG_DATA


def test_a_time_from_the_future_earns_no_respite():
    bench = Bench()
    bench.sample()
    assert bench.tracker.last_valid_s(bench.now_s - 1) == bench.now_s - 1


def test_bursts_of_a_radio_count_by_their_receive_time():
    bench = Bench()
    for _ in range(60):
        bench.wait(0.05)
        for _ in range(5):
            bench.sample()
    health = bench.health
    assert health.is_ok
    assert health.rate_hz == pytest.approx(100, abs=3)
    assert health.worst_gap_s == pytest.approx(0.05)


def test_the_worst_gap_is_forgotten_after_a_minute():
    bench = Bench()
    bench.stream(1.0)
    bench.wait(0.8)
    bench.stream(58.0)
    assert bench.health.worst_gap_s == pytest.approx(0.81)
    bench.stream(4.0)
    assert bench.health.worst_gap_s == pytest.approx(0.01)


def test_rate_falls_while_nothing_comes():
    bench = Bench()
    bench.stream(3.0)
    bench.wait(1.0)
    assert bench.health.rate_hz == pytest.approx(50, abs=1)
    bench.wait(2.0)
    assert bench.health.rate_hz == 0


def test_the_jitter_of_a_radio_is_that_of_its_bursts():
    even, uneven = Bench(), Bench()
    for bench, spans_s in ((even, (0.05, 0.05)), (uneven, (0.03, 0.07))):
        for n in range(50):
            bench.wait(spans_s[n % 2])
            for _ in range(5):
                bench.sample()
    assert even.health.jitter_s == pytest.approx(0, abs=1e-6)
    assert uneven.health.jitter_s == pytest.approx(0.02, abs=0.001)


def test_jitter_is_not_claimed_before_the_rate_is():
    bench = Bench()
    bench.stream(1.9)
    assert bench.health.jitter_s == 0


def test_what_a_sensor_says_of_itself_is_shown_until_another_connection():
    bench = Bench()
    assert (bench.health.identity, bench.health.battery_percent) == ("", None)
    bench.tracker.event(bench.now_s, Identity("arm 7"))
    bench.tracker.event(bench.now_s, Battery(80.0))
    assert (bench.health.identity, bench.health.battery_percent) == ("arm 7", 80.0)
    bench.tracker.event(bench.now_s, Disconnected("gone"))
    assert bench.health.identity == "arm 7"
    bench.tracker.event(bench.now_s, Connected("x"))
    assert (bench.health.identity, bench.health.battery_percent) == ("", None)


_ACTIONS = st.sampled_from(["sample", "same", "bad", "gap", "lost", "open", "wait", "long"])


@given(st.lists(_ACTIONS, max_size=60))
def test_whatever_comes_alive_means_a_changed_sample_within_the_trip_level(actions: list[str]):
    bench = Bench(connect=False)
    changed_s = -math.inf
    n_good = 0
    for action in actions:
        match action:
            case "sample":
                bench.wait(0.01)
                bench.sample()
                changed_s, n_good = bench.now_s, n_good + 1
            case "same" if n_good:
                bench.wait(0.01)
                bench.tracker.sample(Sample(bench.now_s, 0, (0.001 * (bench._n % 7), 0.0, 1.0)))
                n_good += 1
            case "bad":
                bench.tracker.event(bench.now_s, UNREADABLE)
            case "gap":
                bench.tracker.event(bench.now_s, CounterGap(1))
            case "lost":
                bench.tracker.event(bench.now_s, Disconnected("gone"))
            case "open":
                bench.tracker.event(bench.now_s, Connected("x"))
            case "wait":
                bench.wait(0.03)
            case "long":
                bench.wait(0.5)
        health = bench.health
        assert health.age_s == bench.now_s - changed_s
        assert health.n_samples == n_good
        assert not health.is_alive or health.age_s <= TRIP_S
        assert health.is_alive is (health.link is LinkState.RECEIVING)
        assert health.is_ok is (health.reason == "")


def test_the_offending_bytes_are_shown_while_they_are_what_is_wrong():
    bench = Bench()
    bench.stream(0.5)
    assert bench.health.bad_bytes == ""
    bench.rubbish(0.2, Garbage(7, b"AT+OK\r\n", "expected n,x,y,z"))
    assert bench.health.bad_bytes == "AT+OK"
    bench.rubbish(0.2, Garbage(3, b"\x00\xff\x10", "expected n,x,y,z"))
    assert bench.health.bad_bytes == "00 ff 10"
    bench.sample()
    assert bench.health.bad_bytes == ""
