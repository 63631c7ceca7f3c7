"""The sensor emulator in a thread, over real sockets, read with the product's decoders."""

import itertools
import json
import socket
from collections.abc import Callable, Iterator

import pytest

from gestureapp.clock import monotonic
from gestureapp.errors import ConfigError, SensorBusy, SensorError
from gestureapp.sensing.decoder import Decoder
from gestureapp.sensing.posture import PostureDetector
from gestureapp.sensing.protocols import protocol
from gestureapp.sensing.values import (
    ArmPosture,
    CounterGap,
    DecoderEvent,
    Frame,
    Garbage,
    Repeated,
    Side,
)
from gestureapp.simulation.control_link import ControlLink
from gestureapp.simulation.sensor import SensorEmulator, SensorOptions
from gestureapp.simulation.sensor_radio import RadioOptions

LIMIT_S = 10.0


class Reader:
    """A client of the stream that decodes what it reads."""

    def __init__(self, port: int, protocol_name: str = "csv") -> None:
        self.socket = socket.create_connection(("127.0.0.1", port), LIMIT_S)
        self.decoder: Decoder = protocol(protocol_name).new_decoder()
        self.raw = b""

    def until(self, done: Callable[[list[DecoderEvent]], bool]) -> list[DecoderEvent]:
        """Read until the events since this call satisfy the condition."""
        events: list[DecoderEvent] = []
        deadline_s = monotonic() + LIMIT_S
        while not done(events):
            assert monotonic() < deadline_s, events[-5:]
            data = self.socket.recv(4096)
            assert data, "the sensor closed the connection"
            self.raw += data
            events += self.decoder.feed(data)
        return events

    def frames(self, count: int) -> list[Frame]:
        events = self.until(lambda found: len(only_frames(found)) >= count)
        return only_frames(events)

    def close(self) -> None:
        self.socket.close()


def only_frames(events: list[DecoderEvent]) -> list[Frame]:
    return [event for event in events if isinstance(event, Frame)]


def options(side: Side = Side.RIGHT, protocol_name: str = "csv", rate_hz: float = 500.0, **more):
    return SensorOptions(side, 0, 0, protocol_name, rate_hz, **more)


@pytest.fixture
def right() -> Iterator[SensorEmulator]:
    with SensorEmulator(options()) as emulator:
        yield emulator


@pytest.fixture
def control(right: SensorEmulator) -> Iterator[ControlLink]:
    with ControlLink("sensor", "127.0.0.1", right.control_port) as link:
        yield link


@pytest.fixture
def reader(right: SensorEmulator) -> Iterator[Reader]:
    client = Reader(right.port)
    yield client
    client.close()


@pytest.mark.parametrize("name", ["csv", "adxl330", "witmotion", "binary"])
@pytest.mark.parametrize("side", list(Side))
def test_a_hand_at_rest_reads_one_g_upwards_in_every_protocol(side, name):
    with SensorEmulator(options(side, name)) as emulator:
        client = Reader(emulator.port, name)
        frames = client.frames(20)
        client.close()
    for frame in frames:
        assert protocol(name).to_nominal_g(frame.raw) == pytest.approx((0.0, 0.0, 1.0), abs=0.15)
    numbers = [frame.counter for frame in frames[1:]]
    if name == "witmotion":
        assert set(numbers) == {None}
        return
    assert numbers == list(range(numbers[0], numbers[0] + len(numbers)))


@pytest.mark.parametrize("name", ["witmotion", "binary"])
@pytest.mark.parametrize("kind", ["garbage", "truncated"])
def test_a_garbled_binary_stream_is_garbage_and_then_good_again(name, kind):
    with SensorEmulator(options(protocol_name=name)) as emulator:
        client = Reader(emulator.port, name)
        with ControlLink("sensor", "127.0.0.1", emulator.control_port) as link:
            client.frames(3)
            link.ask({"do": "fault", "kind": kind})
            client.until(lambda events: any(isinstance(event, Garbage) for event in events))
            link.ask({"do": "fault", "kind": "none"})
            client.frames(40)
        client.close()


def test_over_a_radio_frames_come_in_bursts_and_in_order():
    radio = RadioOptions(burst=5, gap_s=(0.02, 0.03))
    with SensorEmulator(options(radio=radio)) as emulator:
        client = Reader(emulator.port)
        events = client.until(lambda found: len(only_frames(found)) >= 50)
        with ControlLink("sensor", "127.0.0.1", emulator.control_port) as link:
            sent_s = [line["sent_s"] for line in link.ask({"do": "log", "count": 50})["log"]]
        client.close()
    assert [event for event in events if not isinstance(event, Frame)] == []
    together = sum(after - before < 0.002 for before, after in itertools.pairwise(sent_s))
    assert together > len(sent_s) / 2


def test_the_left_arm_is_seen_in_start_and_in_stop_again():
    detector = PostureDetector(25.0, 40.0, 3)

    def shows(wanted: ArmPosture) -> Callable[[list[DecoderEvent]], bool]:
        return lambda events: (
            bool(events) and detector.feed(only_frames(events[-1:])[0].raw) is wanted
        )

    with SensorEmulator(options(Side.LEFT, rate_hz=100.0)) as emulator:
        client = Reader(emulator.port)
        with ControlLink("sensor", "127.0.0.1", emulator.control_port) as link:
            client.until(shows(ArmPosture.STOP))
            link.ask({"do": "take", "posture": "start"})
            client.until(shows(ArmPosture.START))
            link.ask({"do": "take", "posture": "stop"})
            client.until(shows(ArmPosture.STOP))
        client.close()


def test_a_push_forward_shows_as_positive_then_negative_acceleration(reader, control):
    control.ask({"do": "perform", "label": "X+"})
    reader.until(lambda events: any(f.raw[0] > 0.6 for f in only_frames(events)))
    reader.until(lambda events: any(f.raw[0] < -0.6 for f in only_frames(events)))


def test_the_log_tells_when_a_line_was_written(reader, control):
    before_s = monotonic()
    frames = reader.frames(10)
    log = control.ask({"do": "log", "count": 1000})["log"]
    after_s = monotonic()
    by_number = {line["n"]: line for line in log}
    for frame in frames[1:]:
        line = by_number[frame.counter]
        assert before_s - 1.0 <= line["sent_s"] <= after_s
        assert line["accel_g"] == pytest.approx(frame.raw, abs=0.6e-4)
    times = [line["sent_s"] for line in log]
    assert times == sorted(times)


@pytest.mark.parametrize("kind", ["garbage", "truncated"])
def test_a_garbled_stream_is_garbage_to_the_decoder_and_then_good_again(reader, control, kind):
    reader.frames(3)
    control.ask({"do": "fault", "kind": kind})
    reader.until(lambda events: any(isinstance(event, Garbage) for event in events))
    control.ask({"do": "fault", "kind": "none"})
    reader.frames(40)


def test_a_spike_is_beyond_what_the_sensor_can_give(reader, control):
    control.ask({"do": "fault", "kind": "spike"})
    reader.until(lambda events: any(f.raw == (40.0, 40.0, 40.0) for f in only_frames(events)))


def test_a_frozen_sensor_repeats_one_line_when_even_its_number_stands(reader, control):
    control.ask({"do": "fault", "kind": "frozen", "counts_on": False})
    reader.until(lambda events: sum(isinstance(event, Repeated) for event in events) > 5)


def test_a_silent_sensor_keeps_its_port_open_and_misses_its_numbers(reader, control):
    reader.frames(3)
    control.ask({"do": "fault", "kind": "silent", "seconds": 0.2})
    events = reader.until(lambda found: any(isinstance(event, CounterGap) for event in found))
    assert max(e.missed for e in events if isinstance(e, CounterGap)) > 10


def test_a_stall_can_end_in_a_burst_without_loss(reader, control):
    reader.frames(3)
    control.ask({"do": "fault", "kind": "stall", "seconds": 0.1, "burst": True})
    events = reader.until(lambda found: len(only_frames(found)) > 80)
    assert [event for event in events if not isinstance(event, Frame)] == []


def test_an_unplugged_sensor_closes_and_refuses_until_it_is_plugged_in(right, reader, control):
    control.ask({"do": "fault", "kind": "unplugged"})
    while reader.socket.recv(4096):
        pass
    with pytest.raises(ConnectionRefusedError):
        socket.create_connection(("127.0.0.1", right.port), LIMIT_S)
    control.ask({"do": "fault", "kind": "none"})
    again = Reader(right.port)
    again.frames(3)
    again.close()


def test_clients_come_one_after_another(right):
    for _ in range(3):
        client = Reader(right.port)
        client.frames(2)
        client.close()


def test_a_second_client_is_turned_away_while_the_first_is_served(right, reader):
    reader.frames(2)
    with socket.create_connection(("127.0.0.1", right.port), LIMIT_S) as second:
        assert second.recv(100) == b""
    reader.frames(2)


def test_a_client_that_resets_the_connection_makes_room_for_the_next(right):
    first = Reader(right.port)
    first.frames(2)
    first.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, b"\x01\0\0\0\0\0\0\0")
    first.close()
    next_one = Reader(right.port)
    next_one.frames(2)
    next_one.close()


def test_lines_for_a_client_that_does_not_read_are_dropped_whole():
    with SensorEmulator(options(rate_hz=2000.0)) as emulator:
        lazy = socket.socket()
        lazy.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 2048)
        lazy.settimeout(LIMIT_S)
        lazy.connect(("127.0.0.1", emulator.port))
        with ControlLink("sensor", "127.0.0.1", emulator.control_port) as link:
            wait_for_state(link, lambda state: state["n_dropped"] > 50)
            decoder = protocol("csv").new_decoder()
            events: list[DecoderEvent] = []
            while not any(isinstance(event, CounterGap) for event in events):
                events += decoder.feed(lazy.recv(4096))
        lazy.close()
    assert not any(isinstance(event, Garbage) for event in events)


def wait_for_state(link: ControlLink, holds: Callable[[dict], bool]) -> None:
    deadline_s = monotonic() + LIMIT_S
    while not holds(state := link.ask({"do": "state"})):
        assert monotonic() < deadline_s, state


def test_bad_commands_are_answered_and_the_stream_goes_on(right, reader):
    with socket.create_connection(("127.0.0.1", right.control_port), LIMIT_S) as raw:
        raw.sendall(b"\xff\x00\n{]\n\n" + b'{"do":"fly"}\n{"do":"st')
        lines = raw.makefile("rb")
        answers = [json.loads(lines.readline()) for _ in range(3)]
        raw.sendall(b'ate"}\n')
        assert json.loads(lines.readline())["side"] == "right"
        lines.close()
    assert [answer["ok"] for answer in answers] == [False, False, False]
    reader.frames(3)


def test_an_endless_command_line_is_refused_and_forgotten(right):
    with socket.create_connection(("127.0.0.1", right.control_port), LIMIT_S) as raw:
        lines = raw.makefile("rb")
        raw.sendall(b"x" * 200_000)
        assert "longer than" in json.loads(lines.readline())["error"]
        lines.close()


def test_two_control_clients_are_served_at_once(right, control):
    with ControlLink("other", "127.0.0.1", right.control_port) as other:
        assert control.ask({"do": "state"})["side"] == "right"
        assert other.ask({"do": "state"})["side"] == "right"


def test_a_port_in_use_is_named_with_the_remedy(right):
    with pytest.raises(SensorBusy, match=f"port {right.port} of 127.0.0.1 is in use"):
        SensorEmulator(SensorOptions(Side.LEFT, right.port))
    with pytest.raises(SensorError, match="cannot serve"):
        SensorEmulator(SensorOptions(Side.LEFT, host="no.such.host.invalid"))


@pytest.mark.parametrize(
    ("wrong", "field"),
    [
        ({"protocol": "morse"}, "protocol"),
        ({"rate_hz": 0.0}, "rate"),
        ({"rate_hz": float("nan")}, "rate"),
        ({"port": 70_000}, "port"),
        ({"control_port": -1}, "control-port"),
        ({"seed": -1}, "seed"),
        ({"session": 1 << 40}, "session"),
        ({"protocol": "adxl330", "has_counter": False}, "counter"),
        ({"protocol": "binary", "has_counter": False}, "counter"),
        ({"identity": "a name of more than 20 bytes"}, "identity"),
        ({"identity": "two\nlines"}, "identity"),
        ({"battery_percent": 101}, "battery"),
    ],
)
def test_options_that_cannot_be_are_refused_by_name(wrong, field):
    with pytest.raises(ConfigError) as refusal:
        SensorEmulator(SensorOptions(Side.LEFT, **wrong))
    assert refusal.value.field == field


def test_a_late_loop_anchors_anew_and_counts_instead_of_catching_up():
    now_s = [100.0]
    emulator = SensorEmulator(options(rate_hz=100.0), clock=lambda: now_s[0])
    due_s = emulator._tick_if_due(100.0)
    assert due_s == pytest.approx(100.01)
    now_s[0] = 100.095
    due_s = emulator._tick_if_due(due_s)
    assert due_s == pytest.approx(100.105)
    assert emulator._tick_if_due(due_s) == due_s
    assert emulator._stream.record.n_overruns == 8
    emulator.stop()


def test_stopping_twice_or_without_start_is_fine():
    emulator = SensorEmulator(options())
    emulator.stop()
    emulator.stop()
    with pytest.raises(OSError, match="refused"):
        socket.create_connection(("127.0.0.1", emulator.port), LIMIT_S)
