"""The reader thread on real byte streams: samples, losses, reopening, ending."""

import logging
import os
import queue
import socket
import sys
import threading
from collections.abc import Callable, Iterator
from itertools import count

import pytest
import serial

from gestureapp.clock import Clock
from gestureapp.config import SensorSettings
from gestureapp.errors import ConfigError, SensorDisconnected, WorkerError
from gestureapp.sensing import reader as reader_module
from gestureapp.sensing.calibration import Calibration
from gestureapp.sensing.ports import Port, open_port
from gestureapp.sensing.reader import SensorReader
from gestureapp.sensing.values import (
    Connected,
    CounterGap,
    Disconnected,
    Garbage,
    Impossible,
    Sample,
    SensorEvent,
    Side,
)

LIMIT_S = 10.0
"""Nothing here takes that long; a test that waits for it has failed."""

posix_only = pytest.mark.skipif(sys.platform == "win32", reason="needs pseudo terminals")


class Bench:
    """A reader and everything it told, in order; ends with its thread gone."""

    def __init__(self, port: str, protocol: str = "csv", **settings) -> None:
        self.told: queue.Queue[Sample | SensorEvent] = queue.Queue()
        opener: Callable[[str, str], Port] = settings.pop("opener", open_port)
        ticks = count(100)
        clock: Clock = settings.pop("clock", lambda: float(next(ticks)))
        self.reader = SensorReader(
            Side.LEFT,
            SensorSettings(port=port, protocol=protocol, **settings),
            self.told.put,
            self.told.put,
            clock,
            opener=opener,
        )

    def __enter__(self) -> "Bench":
        self.reader.start()
        return self

    def __exit__(self, *_: object) -> None:
        assert self.reader.stop()
        assert not self.reader.is_alive

    def next(self, kind: type | None = None):
        """The next thing told, of this kind if one is named."""
        while True:
            told = self.told.get(timeout=LIMIT_S)
            if kind is None or isinstance(told, kind):
                return told

    def samples(self, n: int) -> list[Sample]:
        return [self.next(Sample) for _ in range(n)]


class ScriptedPort:
    """A port that gives these pieces, one a read, then is gone."""

    def __init__(self, *pieces: bytes) -> None:
        self._pieces = iter(pieces)
        self.is_closed = False

    def read(self) -> bytes:
        for piece in self._pieces:
            return piece
        raise SensorDisconnected("left", "the script is over: write more")

    def close(self) -> None:
        self.is_closed = True


@pytest.fixture
def server() -> Iterator[socket.socket]:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        listener.settimeout(LIMIT_S)
        yield listener


def url_of(listener: socket.socket) -> str:
    host, port = listener.getsockname()
    return f"socket://{host}:{port}"


def script(*pieces: bytes) -> Callable[[str, str], Port]:
    """Opens a scripted port once; after it is gone, an endlessly silent loop."""
    ports: list[Port] = [ScriptedPort(*pieces)]
    return lambda side, _: ports.pop() if ports else open_port(side, "loop://")


def test_csv_over_tcp_becomes_calibrated_samples(server: socket.socket):
    url = url_of(server)
    with Bench(url) as bench:
        bench.reader.set_calibration(
            Calibration((0.1, 0.0, 0.0), ((2.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.5, 1.0)))
        )
        peer, _ = server.accept()
        with peer:
            peer.sendall(b"\n7,0.6,0,1\r\n8,0.1,-0.5,0.9\r\n")
            assert bench.next() == Connected(url)
            first, second = bench.samples(2)
    assert first.accel_g == (1.0, 0.0, 1.0)
    assert second.accel_g == (0.0, -0.5, 0.65)
    assert (first.seq, second.seq) == (0, 1)
    assert (first.counter, second.counter) == (7, 8)


def test_another_port_and_protocol_are_used_without_a_new_reader(server: socket.socket):
    with socket.create_server(("127.0.0.1", 0)) as other, Bench(url_of(server)) as bench:
        other.settimeout(LIMIT_S)
        first, _ = server.accept()
        with first:
            first.sendall(b"\n1,0,0,1\n")
            assert bench.next(Sample).seq == 0
            bench.reader.use(SensorSettings(url_of(other), "adxl330"))
            second, _ = other.accept()
            with second:
                assert first.recv(1) == b"", "the old port is closed"
                second.sendall(b"\n1,512,512,614\n")
                sample = bench.next(Sample)
    assert sample.seq == 1
    assert sample.accel_g == pytest.approx((0.0, 0.0, 1.0), abs=0.01)


def test_a_reader_that_waits_to_try_again_takes_another_port_at_once(server: socket.socket):
    with Bench("") as bench:
        assert isinstance(bench.next(), Disconnected)
        bench.reader.use(SensorSettings(url_of(server), "csv"))
        with server.accept()[0]:
            assert bench.next(Connected) == Connected(url_of(server))


def test_an_unknown_protocol_changes_nothing(server: socket.socket):
    with Bench(url_of(server)) as bench, server.accept()[0] as peer:
        with pytest.raises(ConfigError):
            bench.reader.use(SensorSettings("loop://", "morse"))
        peer.sendall(b"\n1,0,0,1\n")
        assert bench.next(Sample).accel_g == (0.0, 0.0, 1.0)


def test_adxl330_counts_become_g(server: socket.socket):
    with Bench(url_of(server), "adxl330") as bench, server.accept()[0] as peer:
        peer.sendall(b"\n1,512,512,614\r\n")
        (sample,) = bench.samples(1)
    assert sample.accel_g == pytest.approx((0, 0, 1), abs=0.005)


def test_all_samples_of_one_read_have_the_time_at_which_it_returned():
    pieces = (b"\n0,0,1\n0,0,2\n0,0,", b"3\n", b"", b"0,0,4\n")
    with Bench("script", opener=script(*pieces)) as bench:
        times = [sample.t_s for sample in bench.samples(4)]
    assert times == [100.0, 100.0, 101.0, 102.0]


def test_bad_lines_gaps_and_samples_come_in_the_order_of_the_wire():
    pieces = (b"\n1,0,0,1\nrubbish\n4,0,0,1\n5,0,0,40\n6,0,0,1\n",)
    with Bench("script", opener=script(*pieces)) as bench:
        told = [bench.next() for _ in range(7)]
    kinds = [type(thing) for thing in told]
    assert kinds == [Connected, Sample, Garbage, CounterGap, Sample, Impossible, Sample]
    assert told[2].first_bytes == b"rubbish"
    assert told[3].missed == 2
    assert "40.0 g" in told[5].reason
    assert [thing.seq for thing in told if isinstance(thing, Sample)] == [0, 1, 2]


def test_a_line_cut_by_the_loss_is_garbage_before_the_loss_is_told():
    with Bench("script", opener=script(b"\n1,0,0,1\n2,0,0,1.")) as bench:
        told = [bench.next() for _ in range(4)]
    assert [type(thing) for thing in told] == [Connected, Sample, Garbage, Disconnected]
    assert told[3].reason == "the script is over: write more"


def test_the_running_number_of_samples_goes_on_over_a_loss():
    ports = iter([ScriptedPort(b"\n0,0,1\n0,0,2\n"), ScriptedPort(b"\n0,0,3\n")])
    silent = open_port("left", "loop://")
    with Bench("script", opener=lambda *_: next(ports, silent)) as bench:
        assert [sample.seq for sample in bench.samples(3)] == [0, 1, 2]


def test_every_port_that_was_opened_is_closed():
    port = ScriptedPort(b"0,0,1\n")
    ports: list[Port] = [open_port("left", "loop://"), port]
    with Bench("script", opener=lambda *_: ports.pop()) as bench:
        bench.next(Disconnected)
        bench.next(Connected)
        assert port.is_closed


def test_a_server_that_goes_and_comes_back_is_reconnected(server: socket.socket):
    url = url_of(server)
    with Bench(url) as bench:
        server.accept()[0].close()
        assert bench.next() == Connected(url)
        assert "lost" in bench.next().reason
        with server.accept()[0] as peer:
            assert bench.next() == Connected(url)
            peer.sendall(b"\n0,0,1\n")
            assert bench.next(Sample).accel_g == (0.0, 0.0, 1.0)


def test_nobody_there_is_told_once_and_the_server_is_found_when_it_comes():
    with socket.socket() as listener:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.bind(("127.0.0.1", 0))
        listener.settimeout(LIMIT_S)
        n_attempts = threading.Semaphore(0)

        def opener(side: str, url: str) -> Port:
            n_attempts.release()
            return open_port(side, url)

        with Bench(url_of(listener), opener=opener) as bench:
            assert "nobody answers" in bench.next().reason
            for _ in range(3):
                assert n_attempts.acquire(timeout=LIMIT_S)
            listener.listen()
            with listener.accept()[0]:
                assert isinstance(bench.next(), Connected)


def test_waits_between_attempts_double_to_a_limit_and_start_over_with_data():
    waits: list[float] = []

    stopping = threading.Event()

    class Woken(threading.Event):
        """Keeps how long it was waited on, and waits for nothing."""

        def wait(self, timeout: float | None = None) -> bool:
            waits.append(timeout or 0.0)
            if len(waits) == 8:
                stopping.set()
            return False

    def opener(side: str, _: str) -> Port:
        return ScriptedPort(b"0,0,1\n") if len(waits) == 6 else open_port(side, "/dev/nothing")

    bench = Bench("script", opener=opener)
    bench.reader._woken = Woken()
    bench.reader._run(stopping)
    assert waits == [0.2, 0.4, 0.8, 1.6, 2.0, 2.0, 0.2, 0.4]


def test_a_new_cause_is_told_even_without_a_connection_between():
    causes = iter(["/dev/nothing", "/dev/nothing", "", "loop://"])
    with Bench("script", opener=lambda side, _: open_port(side, next(causes))) as bench:
        told = [bench.next() for _ in range(3)]
    assert "not found" in told[0].reason
    assert "no port is set" in told[1].reason
    assert isinstance(told[2], Connected)


@posix_only
def test_a_device_that_is_unplugged_is_told_and_then_not_found():
    master, slave = os.openpty()
    name = os.ttyname(slave)
    with Bench(name) as bench:
        assert bench.next() == Connected(name)
        os.close(slave)
        os.write(master, b"\n1,0,0,1\n")
        assert bench.next().accel_g == (0.0, 0.0, 1.0)
        os.close(master)
        assert "is gone: plug the receiver in" in bench.next().reason
        assert "not found" in bench.next().reason


@posix_only
def test_a_busy_device_is_told_and_opened_when_it_is_free():
    master, slave = os.openpty()
    other = serial.Serial(os.ttyname(slave), exclusive=True)
    with Bench(os.ttyname(slave)) as bench:
        assert "in use by another program" in bench.next().reason
        other.close()
        assert isinstance(bench.next(), Connected)
    os.close(master)
    os.close(slave)


def test_loop_is_read_and_stopping_while_it_is_silent_ends_the_thread():
    opened: queue.Queue[serial.SerialBase] = queue.Queue()

    def opener(side: str, url: str) -> Port:
        port = open_port(side, url)
        opened.put(port.serial)  # type: ignore[attr-defined]
        return port

    with Bench("loop://", opener=opener) as bench:
        opened.get(timeout=LIMIT_S).write(b"\n0,0,1\n")
        assert bench.next(Sample).accel_g == (0.0, 0.0, 1.0)


def test_stop_tells_nothing_and_may_be_repeated(server: socket.socket):
    with Bench(url_of(server)) as bench:
        assert isinstance(bench.next(), Connected)
        assert bench.reader.stop()
        assert bench.reader.stop()
    assert bench.told.empty()


def test_the_thread_is_named_after_its_side():
    with Bench("loop://") as bench:
        bench.next(Connected)
        assert "left reader" in [thread.name for thread in threading.enumerate()]


def test_an_unknown_protocol_is_refused_before_any_thread_starts():
    with pytest.raises(ConfigError, match="did you mean 'csv'"):
        Bench("loop://", protocol="csvv")


def test_bad_lines_are_all_told_but_logged_once_a_second(caplog: pytest.LogCaptureFixture):
    times = iter([10.0, 10.5, 11.5, 12.0])
    pieces = (b"\n\xffbad\xff\nworse\n", b"third\n", b"fourth\n")
    with caplog.at_level(logging.WARNING, reader_module.__name__):
        opener = script(*pieces)
        with Bench("script", opener=opener, clock=lambda: next(times)) as bench:
            for _ in range(4):
                bench.next(Garbage)
    dropped = [text for text in caplog.messages if "dropped" in text]
    assert len(dropped) == 2
    assert r"b'\xffbad\xff'" in dropped[0]
    assert "fourth" in dropped[1]
    assert "2 more" in dropped[1]


def test_rubbish_without_end_is_survived_and_the_next_line_read(server: socket.socket):
    with Bench(url_of(server)) as bench, server.accept()[0] as peer:
        peer.sendall(bytes(range(256)) * 20 + b"U" * 2000 + b"\n0.5,0,1\n")
        assert bench.next(Sample).accel_g == (0.5, 0.0, 1.0)


@pytest.mark.logs_errors
def test_a_callback_that_raises_ends_the_reader_with_a_report_and_a_closed_port(
    caplog: pytest.LogCaptureFixture,
):
    reports: queue.Queue[WorkerError] = queue.Queue()
    port = ScriptedPort(b"\n0,0,1\n")

    def on_sample(_: Sample) -> None:
        raise ZeroDivisionError

    reader = SensorReader(
        Side.RIGHT,
        SensorSettings(port="script"),
        on_sample,
        lambda _: None,
        lambda: 0.0,
        on_error=reports.put,
        opener=lambda *_: port,
    )
    reader.start()
    assert reports.get(timeout=LIMIT_S).worker == "right reader"
    assert reader.stop()
    assert port.is_closed
    assert "right reader ended by an error" in caplog.text


@pytest.mark.parametrize("url", ["loop://?logging=abc", "hwgrep://["])
def test_a_mistyped_url_is_told_and_the_reader_lives_to_read_the_right_one(url: str):
    with Bench(url) as bench:
        assert "is no port" in bench.next(Disconnected).reason
        bench.reader.use(SensorSettings("loop://"))
        assert bench.next(Connected) == Connected("loop://")
