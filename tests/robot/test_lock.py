"""The lock of an address, in this process and from others."""

import os
import signal
import subprocess
import sys

import pytest

from gestureapp.children import child_environment
from gestureapp.robot.lock import AddressLock, InUse, find_other

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="abstract socket names")

HOLD = """
import os, sys
from gestureapp.robot.lock import AddressLock
lock = AddressLock("192.0.2.10", int(sys.argv[1]), os.getppid())
print(lock.take(), flush=True)
sys.stdin.read()
"""
PORT = 50000 + os.getpid() % 10000
"""Of no robot; another run of these tests beside this one has another."""
LIMIT_S = 10.0


@pytest.fixture
def lock():
    """Makes locks; all are given back in the end."""
    made = []

    def of(host="192.0.2.10", port=PORT, application=None):
        made.append(AddressLock(host, port, application or os.getpid()))
        return made[-1]

    yield of
    for each in made:
        each.give_back()


@pytest.fixture
def holder():
    """Another process that holds the lock."""
    child = subprocess.Popen(
        [sys.executable, "-c", HOLD, str(PORT)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        env=child_environment(),
    )
    assert child.stdout.readline() == b"None\n"
    yield child
    child.kill()
    child.wait(LIMIT_S)
    child.stdin.close()
    child.stdout.close()


def test_who_holds_it_is_told_with_the_remedy(lock, holder):
    told = f"the robot at 192.0.2.10:{PORT} is in use by another gestureapp (process {os.getpid()})"
    assert lock().take() == InUse(told, "close that one")


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGTERM])
def test_it_goes_with_its_process_however_that_ends(lock, holder, how):
    mine = lock()
    assert mine.take() is not None
    holder.send_signal(how)
    holder.wait(LIMIT_S)
    assert mine.take() is None


def test_a_process_that_hangs_keeps_it_until_it_is_killed(lock, holder):
    holder.send_signal(signal.SIGSTOP)
    assert lock().take() is not None
    holder.kill()
    holder.wait(LIMIT_S)
    assert lock().take() is None


def test_it_is_one_for_each_address(lock, holder):
    assert lock(port=PORT + 1).take() is None
    assert lock(host="192.0.2.11").take() is None
    assert lock(host="::ffff:192.0.2.10").take() is not None


def test_taken_twice_by_the_same_it_is_taken_once(lock):
    mine, other = lock(), lock()
    assert mine.take() is None
    assert mine.take() is None
    assert other.take() is not None
    mine.give_back()
    mine.give_back()
    assert other.take() is None


def test_of_an_application_that_is_gone_its_guardian_is_named(lock):
    gone = subprocess.Popen([sys.executable, "-c", ""])
    gone.wait(LIMIT_S)
    assert lock(application=gone.pid).take() is None
    in_use = lock().take()
    assert in_use is not None
    assert in_use.text.endswith(
        f"another gestureapp, which is gone; its guardian (process {os.getpid()}) stops the robot"
    )
    assert in_use.remedy == "wait, or end that process"


def test_a_name_that_somebody_else_has_taken_is_in_use_all_the_same(lock):
    import socket

    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as stranger:
        stranger.bind(f"\0gestureapp-robot-192.0.2.10-{PORT}")
        in_use = lock().take()
    assert in_use == InUse(
        f"the robot at 192.0.2.10:{PORT} is in use by another gestureapp", "close that one"
    )


def test_another_application_that_has_the_robot_is_found_and_one_that_is_gone_is_not(lock, holder):
    other = find_other("192.0.2.10", PORT)
    assert other is not None
    assert str(os.getpid()) in other.text
    holder.kill()
    holder.wait(LIMIT_S)
    assert find_other("192.0.2.10", PORT) is None
    gone = subprocess.Popen([sys.executable, "-c", ""])
    gone.wait(LIMIT_S)
    assert lock(application=gone.pid).take() is None
    assert find_other("192.0.2.10", PORT) is None, "its guardian lets go by itself"
