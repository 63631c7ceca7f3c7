"""Sleep, shutdown, lock and log-off: a small logind on a bus of its own, and a whole cell."""

import os
import shutil
import signal
import subprocess
import threading
from dataclasses import replace

import pytest
from PySide6.QtCore import QTimer
from PySide6.QtDBus import (
    QDBusConnection,
    QDBusMessage,
    QDBusUnixFileDescriptor,
    QDBusVirtualObject,
)
from PySide6.QtWidgets import QWidget

from gestureapp.cell.snapshot import CellState
from tests.cell.bench import Bench
from ui.app import run_window
from ui.session_end import LOGIND, LOGIND_PATH, MANAGER, SessionEnd

NEEDS_BUS = pytest.mark.skipif(shutil.which("dbus-daemon") is None, reason="no dbus-daemon")
SESSION = f"{LOGIND}.Session"
OURS, ANOTHERS = f"{LOGIND_PATH}/session/_312", f"{LOGIND_PATH}/session/c3"
LIMIT_MS = 6000
KEPT = []
"""Widgets that nobody else holds."""


class Logind(QDBusVirtualObject):
    """Gives inhibitors as logind does: the end of a pipe; announces what it is told to."""

    def __init__(self, bus):
        super().__init__()
        self.bus = bus
        self.asked = []
        self.refuses = False
        self._ends = []

    def introspect(self, path):
        return ""

    def handleMessage(self, message, connection):  # noqa: N802, Qt's spelling
        if message.member() != "Inhibit":
            return False
        self.asked.append(message.arguments())
        if self.refuses:
            connection.send(message.createErrorReply(f"{LOGIND}.Denied", "not for you"))
            return True
        ours, theirs = os.pipe()
        connection.send(message.createReply([QDBusUnixFileDescriptor(theirs)]))
        os.close(theirs)
        os.set_blocking(ours, False)
        self._ends.append(ours)
        return True

    def n_waited_for(self):
        """How many inhibitors are held: how many ends of pipes are still open elsewhere."""
        held = 0
        for end in self._ends:
            try:
                os.read(end, 1)
            except BlockingIOError:
                held += 1
        return held

    def announce(self, name, *arguments, path=LOGIND_PATH, interface=MANAGER):
        told = QDBusMessage.createSignal(path, interface, name)
        told.setArguments(list(arguments))
        assert self.bus.send(told)

    def close(self):
        for end in self._ends:
            os.close(end)


@pytest.fixture
def buses(qapp):
    """Connections to a bus of our own, by name."""
    daemon = subprocess.Popen(
        ["dbus-daemon", "--session", "--nofork", "--print-address=1"],
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
    )
    address = daemon.stdout.readline().decode().strip()
    names = []

    def connect(name):
        names.append(f"{name} {address}")
        bus = QDBusConnection.connectToBus(address, names[-1])
        assert bus.isConnected()
        return bus

    yield connect
    for name in names:
        QDBusConnection.disconnectFromBus(name)
    daemon.terminate()
    daemon.wait(10.0)
    daemon.stdout.close()


@pytest.fixture
def logind(buses):
    bus = buses("logind")
    logind = Logind(bus)
    assert bus.registerService(LOGIND)
    below = QDBusConnection.VirtualObjectRegisterOption.SubPath
    assert bus.registerVirtualObject(LOGIND_PATH, logind, below)
    yield logind
    logind.close()


@pytest.fixture
def session_end(cell, logind, buses, qtbot):
    session_end = SessionEnd(cell, buses("application"), "12")
    qtbot.waitUntil(lambda: logind.n_waited_for() == 1, timeout=LIMIT_MS)
    yield session_end
    session_end.close()


@NEEDS_BUS
@pytest.mark.logs_errors
@pytest.mark.parametrize(
    ("announced", "why"),
    [
        ("PrepareForSleep", "the computer goes to sleep"),
        ("PrepareForShutdown", "the computer is shut down"),
    ],
)
def test_it_waits_for_the_robot_to_stand(session_end, logind, cell, scenes, qtbot, announced, why):
    assert logind.asked[0][0] == "sleep:shutdown"
    assert logind.asked[0][3] == "delay"
    cell.shown = scenes.moving()
    logind.announce(announced, True)
    qtbot.waitUntil(lambda: cell.calls == ["stop", "disarm"], timeout=LIMIT_MS)
    assert cell.whys == [why]
    cell.shown = replace(cell.shown, state=CellState.STOPPING)
    n_polls = cell.n_polls
    qtbot.waitUntil(lambda: cell.n_polls > n_polls + 3, timeout=LIMIT_MS)
    assert logind.n_waited_for() == 1

    cell.shown = replace(cell.shown, state=CellState.STOPPED)
    qtbot.waitUntil(lambda: logind.n_waited_for() == 0, timeout=LIMIT_MS)
    logind.announce(announced, False)
    qtbot.waitUntil(lambda: logind.n_waited_for() == 1, timeout=LIMIT_MS)
    assert len(logind.asked) == 2


@NEEDS_BUS
@pytest.mark.logs_errors
def test_a_robot_that_does_not_stand_keeps_no_computer_awake_for_ever(
    session_end, logind, cell, scenes, qtbot, caplog
):
    cell.shown = scenes.moving()
    logind.announce("PrepareForSleep", True)
    qtbot.waitUntil(lambda: logind.n_waited_for() == 0, timeout=LIMIT_MS)
    assert "was not read back to stand" in caplog.text


@NEEDS_BUS
def test_a_robot_at_rest_is_not_held_for_a_sleep(session_end, logind, cell, qtbot):
    logind.announce("PrepareForSleep", True)
    qtbot.waitUntil(lambda: logind.n_waited_for() == 0, timeout=LIMIT_MS)
    assert cell.calls == ["disarm"]


@NEEDS_BUS
def test_the_lock_of_our_session_stops_and_anothers_does_not(
    session_end, logind, cell, scenes, qtbot
):
    cell.shown = scenes.moving()
    logind.announce("Lock", path=ANOTHERS, interface=SESSION)
    logind.announce("Lock", path=OURS, interface=SESSION)
    qtbot.waitUntil(lambda: "disarm" in cell.calls, timeout=LIMIT_MS)
    assert cell.calls == ["stop", "disarm"]
    assert cell.whys == ["the session was locked"]


@NEEDS_BUS
def test_a_session_that_is_not_known_takes_the_lock_of_any(logind, buses, cell, scenes, qtbot):
    session_end = SessionEnd(cell, buses("application"))
    qtbot.waitUntil(lambda: logind.n_waited_for() == 1, timeout=LIMIT_MS)
    cell.shown = scenes.moving()
    logind.announce("Lock", path=ANOTHERS, interface=SESSION)
    qtbot.waitUntil(lambda: cell.calls == ["stop", "disarm"], timeout=LIMIT_MS)
    session_end.close()
    qtbot.waitUntil(lambda: logind.n_waited_for() == 0, timeout=LIMIT_MS)


@NEEDS_BUS
def test_without_leave_to_delay_the_robot_is_stopped_all_the_same(
    logind, buses, cell, scenes, qtbot, caplog
):
    logind.refuses = True
    session_end = SessionEnd(cell, buses("application"), "12")
    qtbot.waitUntil(lambda: "not for you" in caplog.text, timeout=LIMIT_MS)
    cell.shown = scenes.moving()
    logind.announce("PrepareForSleep", True)
    qtbot.waitUntil(lambda: cell.calls == ["stop", "disarm"], timeout=LIMIT_MS)
    session_end.close()


def test_a_log_off_goes_on_when_the_robot_stands(qapp, cell, scenes, qtbot):
    session_end = SessionEnd(cell, None)
    cell.shown = scenes.moving()

    def stand():
        cell.shown = replace(cell.shown, state=CellState.STOPPED)

    QTimer.singleShot(60, stand)
    session_end._log_off(None)
    assert cell.shown.state is CellState.STOPPED
    assert cell.calls == ["stop", "disarm"]
    assert cell.whys == ["the session ends"]
    session_end.close()


@pytest.mark.skipif(not hasattr(signal, "SIGHUP"), reason="no terminals to close")
def test_a_terminal_that_is_closed_closes_the_window(qapp, cell):
    QTimer.singleShot(50, lambda: os.kill(os.getpid(), signal.SIGHUP))
    assert run_window(cell, exit_after_s=20.0) == 0
    assert cell.calls[:3] == ["stop", "disarm", "shutdown"]
    assert cell.whys == ["the window was closed"]


def fail():
    raise RuntimeError("broken by the test")


class Broken(QWidget):
    """Fails to paint itself, once; then it is gone."""

    def paintEvent(self, event):
        QTimer.singleShot(0, self.close)
        fail()


def fail_in_paint():
    KEPT.append(Broken())
    KEPT[-1].show()


def fail_in_a_thread():
    thread = threading.Thread(target=fail)
    thread.start()
    thread.join(10.0)


@pytest.mark.process
@pytest.mark.logs_errors
@pytest.mark.parametrize(
    "fault", [fail, fail_in_paint, fail_in_a_thread], ids=["slot", "paint", "thread"]
)
def test_an_error_nobody_handled_stops_a_moving_robot(qapp, tmp_path, fault):
    seen = []
    with Bench(tmp_path) as bench:
        bench.move()

        def look():
            snapshot = bench.now
            if snapshot.state is CellState.STOPPED:
                seen.append((snapshot.sentence, bench.nx100.is_running()))
                timer.stop()
                QTimer.singleShot(0, lambda: os.kill(os.getpid(), signal.SIGTERM))

        timer = QTimer(interval=20)
        timer.timeout.connect(look)
        timer.start()
        QTimer.singleShot(0, fault)
        run_window(bench.cell, exit_after_s=10.0)
    ((sentence, is_running),) = seen
    assert sentence.startswith("An error nobody handled: RuntimeError: broken by the test.")
    assert not is_running
