"""The sensor emulator as a process of its own: its lines, its end, and its parent's end."""

import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

import gestureapp
from gestureapp.clock import monotonic
from gestureapp.errors import WorkerError
from gestureapp.simulation.child import EmulatorProcess
from gestureapp.simulation.control_link import ControlLink

pytestmark = pytest.mark.process

LIMIT_S = 20.0
PROGRAM = [sys.executable, str(Path(__file__).with_name("emulator_program.py"))]
SENSOR = [*PROGRAM, "simulate", "sensor", "--port", "0", "--control-port", "0"]
ROOT = Path(gestureapp.__file__).resolve().parent.parent


@pytest.fixture
def process() -> Iterator[subprocess.Popen[bytes]]:
    child = subprocess.Popen(
        [*SENSOR, "--exit-with-stdin"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        env={"PYTHONPATH": str(ROOT), "OPENBLAS_NUM_THREADS": "1"},
    )
    yield child
    child.kill()
    child.communicate()


def ports(child: subprocess.Popen[bytes]) -> tuple[int, int]:
    words = [child.stdout.readline().decode().split() for _ in range(2)]
    assert [line[:2] for line in words] == [["control", "on"], ["listening", "on"]]
    hosts = [line[2].split(":") for line in words]
    assert [host for host, _ in hosts] == ["127.0.0.1", "127.0.0.1"]
    return int(hosts[1][1]), int(hosts[0][1])


def test_it_says_where_it_listens_once_all_is_ready(process):
    port, control_port = ports(process)
    with socket.create_connection(("127.0.0.1", port), LIMIT_S) as client:
        assert client.recv(100)
    with ControlLink("sensor", "127.0.0.1", control_port) as link:
        assert link.ask({"do": "state"})["side"] == "left"


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_it_ends_cleanly_on_a_signal(process, number):
    ports(process)
    process.send_signal(number)
    assert process.wait(LIMIT_S) == 0


def test_it_ends_when_its_standard_input_ends(process):
    ports(process)
    process.stdin.close()
    assert process.wait(LIMIT_S) == 0
    process.stdin = None


def test_it_ends_with_a_parent_that_is_killed():
    parent_code = (
        "import sys\n"
        "from gestureapp.simulation.child import EmulatorProcess\n"
        "child = EmulatorProcess('sensor', sys.argv[1:])\n"
        "from gestureapp.clock import monotonic\n"
        "child.wait_ready(monotonic() + 20)\n"
        "print(child.control_port, flush=True)\n"
        "sys.stdin.read()\n"
    )
    with subprocess.Popen(
        [sys.executable, "-c", parent_code, *SENSOR, "--exit-with-stdin"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        env={"PYTHONPATH": str(ROOT), "OPENBLAS_NUM_THREADS": "1"},
    ) as parent:
        port = int(parent.stdout.readline())
        with socket.create_connection(("127.0.0.1", port), LIMIT_S) as link:
            link.sendall(b'{"do":"state"}\n')
            assert link.recv(4096)
            parent.kill()
            assert link.recv(100) == b""


def test_a_child_that_ends_at_once_is_reported_in_words(monkeypatch):
    monkeypatch.setenv("BREAK", "sensor=die")
    child = EmulatorProcess("left sensor emulator", SENSOR)
    with pytest.raises(WorkerError, match=r"left sensor emulator: ended with code 3 \(no room"):
        child.wait_ready(monotonic() + LIMIT_S)
    child.close()


def test_a_child_that_never_listens_is_given_up_at_the_deadline(monkeypatch):
    monkeypatch.setenv("BREAK", "sensor=mute")
    child = EmulatorProcess("left sensor emulator", SENSOR)
    with pytest.raises(WorkerError, match="not ready in time"):
        child.wait_ready(0.0)
    child.close(LIMIT_S)
    assert child.problem == ""


def test_a_program_that_does_not_exist_is_reported_in_words():
    with pytest.raises(WorkerError, match="cannot be started"):
        EmulatorProcess("left sensor emulator", ["/no/such/program"])
