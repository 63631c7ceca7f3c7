"""Every built-in protocol, from an emulated sensor over a socket to the health of its stream."""

import itertools
import os
import queue
import subprocess
import sys
from collections.abc import Iterator

import pytest

from gestureapp.clock import monotonic
from gestureapp.config import SensorSettings
from gestureapp.sensing.protocols import BUILT_IN
from gestureapp.sensing.reader import SensorReader
from gestureapp.sensing.stream import StreamTracker
from gestureapp.sensing.values import (
    Connected,
    CounterGap,
    Garbage,
    Sample,
    SensorEvent,
    Side,
    StreamHealth,
)
from gestureapp.simulation.sensor import SensorEmulator, SensorOptions
from gestureapp.simulation.sensor_radio import BLUETOOTH, RadioOptions
from gestureapp.simulation.sensor_wire import ENCODERS
from tests.sensing.test_reader import Bench, posix_only

LIMIT_S = 20.0
NAMES = [known.name for known in BUILT_IN]
RATE_HZ = (50.0, 230.0)
"""Wider than a site's: the machine of a test may be busy."""


class Stream:
    """A reader on this port, and the tracker that follows what it tells."""

    def __init__(self, port: int, protocol: str) -> None:
        self.samples: list[Sample] = []
        self._told: queue.Queue[tuple[float, Sample | SensorEvent]] = queue.Queue()
        self._tracker = StreamTracker(Side.LEFT, 0.5, *RATE_HZ)
        settings = SensorSettings(f"socket://127.0.0.1:{port}", protocol)
        self.reader = SensorReader(Side.LEFT, settings, self._note, self._note)

    def _note(self, told: Sample | SensorEvent) -> None:
        self._told.put((monotonic(), told))

    def until_ok(self) -> StreamHealth:
        """The stream's health once it is all right."""
        deadline_s = monotonic() + LIMIT_S
        while not (health := self._tracker.health(monotonic())).is_ok:
            assert monotonic() < deadline_s, health
            t_s, told = self._told.get(timeout=LIMIT_S)
            if isinstance(told, Sample):
                self.samples.append(told)
                self._tracker.sample(told)
            else:
                self._tracker.event(t_s, told)
        return health

    def __enter__(self) -> "Stream":
        self.reader.start()
        return self

    def __exit__(self, *_: object) -> None:
        assert self.reader.stop()


def emulated(protocol: str, radio: RadioOptions) -> SensorEmulator:
    options = SensorOptions(
        Side.LEFT, protocol=protocol, radio=radio, identity="arm 7", battery_percent=41
    )
    return SensorEmulator(options)


@pytest.mark.parametrize("name", NAMES)
def test_a_sensor_of_every_protocol_becomes_a_stream_that_is_all_right(name: str):
    with emulated(name, RadioOptions()) as sensor, Stream(sensor.port, name) as stream:
        health = stream.until_ok()
    assert health.n_bad == 0
    assert stream.samples[-1].accel_g == pytest.approx((0.0, 0.0, 1.0), abs=0.15)
    said = (health.identity, health.battery_percent)
    assert said == (("arm 7", 41.0) if name == "binary" else ("", None))


@pytest.mark.parametrize("name", NAMES)
def test_over_a_radio_every_protocol_shows_its_bursts_as_jitter(name: str):
    with emulated(name, BLUETOOTH) as sensor, Stream(sensor.port, name) as stream:
        health = stream.until_ok()
    assert health.n_bad == 0
    assert health.jitter_s > 0.003
    assert health.worst_gap_s > 0.019


@posix_only
@pytest.mark.parametrize(("name", "count_g"), [("witmotion", 16 / 32768), ("binary", 0.0005)])
def test_every_byte_there_is_gets_through_a_serial_device(name: str, count_g: float):
    """Line ends, flow control and the end of a file are bytes like others."""
    master, slave = os.openpty()
    sent_g = [(n * count_g, -n * count_g, 1.0) for n in range(256)]
    with Bench(os.ttyname(slave), name) as bench:
        bench.next(Connected)
        for n, accel_g in enumerate(sent_g):
            os.write(master, ENCODERS[name](n, accel_g))
        told = [bench.next(Sample | Garbage | CounterGap) for _ in sent_g]
    os.close(master)
    os.close(slave)
    assert [sample.accel_g for sample in told] == [pytest.approx(g, abs=1e-9) for g in sent_g]


@pytest.fixture
def process() -> Iterator[subprocess.Popen[str]]:
    arguments = "simulate sensor --arm left --port 0 --protocol binary --identity Arm --battery 7"
    finer = "--link bluetooth --link-burst 3 --link-gap-ms 10 20 --link-loss 0 --clock-ppm 500"
    code = f"from gestureapp.cli import main; main({[*arguments.split(), *finer.split()]!r})"
    child = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
    yield child
    child.kill()
    child.communicate()


@pytest.mark.process
def test_the_command_line_emulates_a_binary_sensor_over_a_link_of_ones_choice(process):
    assert process.stdout is not None
    port = int(process.stdout.readline().rsplit(":", 1)[1])
    with Stream(port, "binary") as stream:
        health = stream.until_ok()
    assert (health.identity, health.battery_percent) == ("Arm", 7.0)
    times_s = [sample.t_s for sample in stream.samples]
    together = sum(after - before < 0.005 for before, after in itertools.pairwise(times_s))
    assert together > len(times_s) / 2


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--protocol", "morse"], "protocol = 'morse': unknown; one of"),
        (["--link-loss", "2"], "link-loss = 2.0: must be 0 to 1"),
        (["--link-gap-ms", "60", "20"], "link-gap-ms = '60 to 20': must be two times"),
        (["--battery", "101"], "battery = 101: must be 0 to 100 %"),
    ],
)
def test_what_cannot_be_emulated_is_one_line(
    arguments: list[str], words: str, capsys: pytest.CaptureFixture[str]
):
    from gestureapp.cli import FAILED, main

    command = ["simulate", "sensor", "--arm", "left", "--port", "0", *arguments]
    assert main(command) == FAILED
    told = capsys.readouterr().err
    assert words in told
    assert told.count("\n") == 1
