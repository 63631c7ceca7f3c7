import os
import signal
import socket
import subprocess
import sys
import threading

import pytest

from gestureapp.cell.lifeline import hold_lifeline
from tests.cell.conftest import wait_until

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="Linux has the tables it needs")

HOLDS_AND_WAITS = """
import socket, sys, time
from gestureapp.cell.lifeline import hold_lifeline
sock = socket.create_connection(("127.0.0.1", int(sys.argv[1])))
assert hold_lifeline(sock, b"hello")
time.sleep(60)
"""


def _pair() -> tuple[socket.socket, socket.socket]:
    ours, theirs = socket.socketpair()
    theirs.settimeout(5.0)
    return ours, theirs


def _threads() -> list[str]:
    return [thread.name for thread in threading.enumerate()]


def test_a_lifeline_lives_on_after_the_process_has_closed_it_and_ends_with_the_other_side():
    ours, theirs = _pair()
    with theirs:
        assert hold_lifeline(ours, b"hello")
        assert ours.fileno() == -1
        assert theirs.recv(100) == b"hello"
        theirs.setblocking(False)
        with pytest.raises(BlockingIOError):
            theirs.recv(1)
    assert wait_until(lambda: "lifeline" not in _threads())


def test_a_lifeline_keeps_nothing_else_open():
    before, other_before = _pair()
    ours, theirs = _pair()
    after, other_after = _pair()
    with theirs, other_before, other_after:
        assert hold_lifeline(ours, b"hello")
        before.close()
        after.close()
        assert other_before.recv(1) == b""
        assert other_after.recv(1) == b""


@pytest.mark.process
def test_a_lifeline_ends_when_its_process_is_killed():
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = str(server.getsockname()[1])
        with subprocess.Popen([sys.executable, "-c", HOLDS_AND_WAITS, port]) as child:
            held, _ = server.accept()
            with held:
                held.settimeout(20.0)
                assert held.recv(100) == b"hello"
                os.kill(child.pid, signal.SIGKILL)
                assert held.recv(100) == b""
