"""Finding sensors on real ports: what sends is listed, and nothing is left open."""

import contextlib
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
import serial

from gestureapp.clock import monotonic
from gestureapp.sensing.ports import Port, open_port
from gestureapp.sensing.protocols import protocols
from gestureapp.setup.finding import Finder
from gestureapp.setup.hearing_ports import PortEar
from gestureapp.setup.values import PortChoice
from gestureapp.simulation.sensor_wire import (
    encode_adxl330,
    encode_binary,
    encode_csv,
    encode_identity,
    encode_witmotion,
)
from tests.setup.bench import LEVEL, LIMIT_S, PtyPort

ENCODERS = {
    "csv": encode_csv,
    "adxl330": encode_adxl330,
    "witmotion": encode_witmotion,
    "binary": encode_binary,
}


@contextlib.contextmanager
def sending(port: PtyPort, *pieces: bytes) -> Iterator[PortChoice]:
    """Something that sends these bytes over and over, until nobody looks any more."""
    stopping = threading.Event()

    def send() -> None:
        number = 0
        while not stopping.wait(0.005):
            port.write(pieces[number % len(pieces)])
            number += 1

    thread = threading.Thread(target=send)
    if pieces:
        thread.start()
    try:
        yield PortChoice(port.url, Path(port.url).name)
    finally:
        stopping.set()
        if pieces:
            thread.join()
        port.unplug()


def wait_for(condition: threading.Event) -> None:
    assert condition.wait(LIMIT_S)


def test_every_port_that_sends_is_listed_with_its_protocol(tmp_path: Path):
    csv = [encode_csv(n, (0.01 * (n % 3), 0.0, 1.0)) for n in range(1000)]
    named = [encode_binary(n, LEVEL) for n in range(1000)]
    named[50::50] = [encode_identity("wrist A") + frame for frame in named[50::50]]
    with (
        sending(PtyPort(tmp_path, "one"), *csv) as one,
        sending(PtyPort(tmp_path, "two"), *named) as two,
        sending(PtyPort(tmp_path, "noise"), b"AT+OK\r\n") as noise,
        sending(PtyPort(tmp_path, "silent")) as silent,
    ):
        missing = PortChoice(str(tmp_path / "missing"), "missing")
        finder = Finder(monotonic, protocols)
        finder.start((one, two, noise, silent, missing))
        assert finder.view.is_on
        until_s = monotonic() + LIMIT_S
        while finder.view.is_on and monotonic() < until_s:
            time.sleep(0.01)
        view = finder.view
        finder.stop()
        assert not view.is_on
        assert [(found.port, found.protocol) for found in view.found] == [
            (one, "csv"),
            (two, "binary"),
            (noise, ""),
        ]
        assert "wrist A, binary" in view.found[1].text
        assert "AT+OK" in view.found[2].text
        assert view.sentence.startswith("All ports tried: 2 sensors send.")
        assert "missing not found" in view.sentence
        for port in (one, two, noise, silent):  # nobody has them any more
            serial.Serial(port.url, exclusive=True).close()


def test_it_can_be_stopped_at_once_and_leaves_nothing_open(tmp_path: Path):
    opened = threading.Event()

    def opener(sensor: str, url: str) -> Port:
        port = open_port(sensor, url)
        opened.set()
        return port

    with sending(PtyPort(tmp_path, "silent")) as silent:
        finder = Finder(monotonic, protocols, opener)
        finder.start((silent, silent, silent))
        wait_for(opened)
        finder.stop()
        assert not finder.view.is_on
        assert finder.view.sentence.startswith("Ended: no sensor sends.")
        serial.Serial(silent.url, exclusive=True).close()
        finder.stop()


def test_without_a_free_port_it_says_what_to_do():
    finder = Finder(monotonic, protocols)
    finder.start(())
    assert finder.view.sentence.startswith("No port is free")


@pytest.mark.parametrize("name", ENCODERS)
def test_each_protocol_is_told_from_all_others(name: str):
    ear = PortEar(protocols())
    for number in range(120):
        accel_g = (0.3 + 0.01 * (number % 3), -0.2, 0.93)
        ear.feed(number * 0.01, ENCODERS[name](number, accel_g))
    heard = ear.heard()
    assert heard.protocol == name
    assert heard.rate_hz == pytest.approx(100, abs=5)
    assert ear.is_sure


def test_rubbish_is_no_protocol():
    ear = PortEar(protocols())
    for number in range(60):
        ear.feed(number * 0.01, bytes((number * 37 + k * 11) % 256 for k in range(20)))
    heard = ear.heard()
    assert heard.protocol == ""
    assert heard.n_bytes == 1200
