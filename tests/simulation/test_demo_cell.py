"""The demo cell: real processes, started together, ended together, deaths told in words."""

import os
import signal
import socket
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from gestureapp.config import DriveMode, Settings, SiteSettings
from gestureapp.errors import WorkerError
from gestureapp.simulation.control_link import ControlLink
from gestureapp.simulation.demo import DemoCell, DemoOptions

pytestmark = pytest.mark.process

LIMIT_S = 20.0
STAND_IN = (sys.executable, str(Path(__file__).with_name("emulator_program.py")))


def cell(**options) -> DemoCell:
    return DemoCell(DemoOptions(program=STAND_IN, **options))


def test_the_demo_gives_settings_that_lead_to_its_emulators():
    with cell() as demo:
        assert demo.problem == ""
        site = SiteSettings(drive_mode=DriveMode.START_STOP)
        settings = demo.settings(replace(Settings(), site=site))
        for sensor in (settings.left, settings.right):
            host, port = sensor.port.removeprefix("socket://").split(":")
            with socket.create_connection((host, int(port)), LIMIT_S) as stream:
                assert stream.recv(100)
        assert (settings.left.protocol, settings.right.protocol) == ("adxl330", "csv")
        assert settings.is_simulation
        assert settings.site == site
        assert (settings.robot.host, settings.robot.port) == ("127.0.0.1", demo.nx100.port)
        assert settings.person.name == "Demo operator"
        assert settings.person.model.parts[-3:] == ("resources", "demo", "model.json")
        demo.operator.left_start()
        assert demo.operator.wait_idle(LIMIT_S)
        with ControlLink("left", "127.0.0.1", demo.left.control_port) as link:
            assert link.ask({"do": "state"})["doing"] == "take start"


def test_closing_ends_every_process_and_may_be_repeated():
    demo = cell()
    demo.start()
    ports = [child.port for child in (demo.left, demo.right, demo.nx100)]
    demo.close()
    demo.close()
    for port in ports:
        with pytest.raises(OSError, match="refused"):
            socket.create_connection(("127.0.0.1", port), LIMIT_S)
    assert demo.problem == ""


def test_an_emulator_that_cannot_start_fails_the_demo_in_words_and_leaves_none(monkeypatch):
    monkeypatch.setenv("BREAK", "nx100=die")
    demo = cell()
    with pytest.raises(WorkerError, match=r"NX100 emulator: ended with code 3 \(no room"):
        demo.start()
    for child in (demo.left, demo.right):
        with pytest.raises(OSError, match="refused"):
            socket.create_connection(("127.0.0.1", child.port), LIMIT_S)


def test_an_emulator_that_dies_later_is_told_in_words():
    with cell() as demo:
        address = ("127.0.0.1", demo.right.control_port)
        with socket.create_connection(address, LIMIT_S) as link:
            link.sendall(b'{"do":"state"}\n')
            assert link.recv(4096)
            os.kill(demo.right.pid, signal.SIGKILL)
            assert link.recv(1) == b""
        assert demo.right.wait_ended(LIMIT_S)
        assert demo.problem.startswith("right sensor emulator: ended with code -9")
        assert "start the demo again" in demo.problem


def test_the_applications_own_command_starts_a_controller_that_answers():
    with DemoCell() as demo:
        robot = demo.settings().robot
        with socket.create_connection((robot.host, robot.port), LIMIT_S) as link:
            link.sendall(b"CONNECT Robot_access\r\n")
            assert link.recv(100).startswith(b"OK: ")
