"""A real guardian process, an application for it, and the emulated controller."""

import contextlib
import secrets
import selectors
import socket
import subprocess
import threading
from dataclasses import replace

import pytest

from gestureapp.children import child_command, child_environment
from gestureapp.clock import monotonic
from gestureapp.robot import messages as m
from gestureapp.robot.values import Direction
from gestureapp.simulation.nx100 import Nx100Emulator
from gestureapp.simulation.nx100_log import What
from gestureapp.worker import Worker

LIMIT_S = 10.0
FORWARD = Direction(0, 1, is_rotation=False)


class GuardianProcess:
    """A guardian child as the application starts it."""

    def __init__(self, host, port, limits, log=""):
        self.token = secrets.token_hex(16)
        self.child = subprocess.Popen(
            child_command("guardian"),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            start_new_session=True,
            env=child_environment(),
        )
        self.child.stdin.write(m.encode(m.Start(self.token, host, port, limits, str(log))))
        self.child.stdin.flush()
        with selectors.DefaultSelector() as selector:
            selector.register(self.child.stdout, selectors.EVENT_READ)
            assert selector.select(LIMIT_S)
        self.port = m.decode(self.child.stdout.readline()).port

    def connect(self):
        sock = socket.create_connection(("127.0.0.1", self.port), LIMIT_S)
        sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        return sock

    def ended(self, limit_s=LIMIT_S):
        return self.child.wait(limit_s)

    def close(self):
        if self.child.poll() is None:
            self.child.kill()
        self.child.wait(LIMIT_S)
        self.child.stdin.close()
        self.child.stdout.close()


class Application:
    """Both connections of an application, its heartbeat and what it hears."""

    def __init__(self, guardian):
        self.guardian = guardian
        self.control, self.window = guardian.connect(), guardian.connect()
        self.control.sendall(m.encode(m.Hello(guardian.token, m.Role.CONTROL)))
        self.window.sendall(m.encode(m.Hello(guardian.token, m.Role.WINDOW)))
        self.posture = "stop"
        self._heard, self._changed = [], threading.Condition()
        self._workers = [Worker("beats", self._beat), Worker("hears", self._hear)]
        for worker in self._workers:
            worker.start()

    def say(self, message):
        self.control.sendall(m.encode(message))

    def wait_for(self, kind, is_it=lambda message: True):
        def found():
            return next((x for x in self._heard if isinstance(x, kind) and is_it(x)), None)

        with self._changed:
            message = self._changed.wait_for(found, LIMIT_S)
        assert message is not None, f"no {kind.__name__} among {self._heard[-20:]}"
        return message

    def heard(self, kind):
        with self._changed:
            return [message for message in self._heard if isinstance(message, kind)]

    def arm(self):
        self.wait_for(m.StatusReport)
        self.wait_for(m.PoseReport)
        self.say(self._now())
        self.say(m.Arm())
        self.wait_for(m.Armed)

    def move(self, emulator):
        """Arm and move; give the time when the robot ran."""
        self.arm()
        self.posture = "start"
        self.say(self._now())
        self.say(m.Propose(1, FORWARD, monotonic()))
        self.wait_for(m.CommandAccepted)
        assert emulator.log.wait_for(lambda e: e.what is What.MOTION_START)

    def close(self):
        for worker in self._workers:
            worker.stopping.set()
        for sock in (self.control, self.window):
            with contextlib.suppress(OSError):
                sock.shutdown(socket.SHUT_RDWR)
        for worker in self._workers:
            worker.stop()
        self.control.close()
        self.window.close()

    def _now(self):
        t_s = monotonic()
        return m.Beat(t_s, self.posture == "start", self.posture == "stop", t_s, t_s)

    def _beat(self, stopping):
        while not stopping.wait(0.01):
            try:
                self.say(self._now())
            except OSError:
                return

    def _hear(self, stopping):
        unread = b""
        self.control.settimeout(None)
        while not stopping.is_set():
            try:
                data = self.control.recv(65536)
            except OSError:
                data = b""
            if not data:
                return
            *lines, unread = (unread + data).split(b"\n")
            with self._changed:
                self._heard += [m.decode(line) for line in lines]
                self._changed.notify_all()


@pytest.fixture(scope="package", autouse=True)
def lonely(limits):
    """A guardian nobody greets, from the first test on: its end takes seconds."""
    guardian = GuardianProcess("", 0, limits)
    yield guardian
    guardian.close()


@pytest.fixture
def start(limits):
    """Starts emulators, guardians and applications; all gone in the end."""
    with contextlib.ExitStack() as stack:

        def started(options=None, *, log="", port=None, host="127.0.0.1", **change):
            emulator = stack.enter_context(Nx100Emulator(options))
            wanted = replace(limits, trip_level_s=0.3, control_limit_s=0.5, gui_limit_s=1.0)
            wanted = replace(wanted, **change)
            guardian = GuardianProcess(host, emulator.port if port is None else port, wanted, log)
            stack.callback(guardian.close)
            return emulator, guardian

        def application(guardian):
            app = Application(guardian)
            stack.callback(app.close)
            return app

        yield started, application


@pytest.fixture(scope="session")
def hold_after():
    """Gives the seconds from a moment to the HOLD that the controller has heard whole."""

    def seconds(emulator, t_s, what):
        event = emulator.log.wait_for(
            lambda e: e.what is What.REQUEST and (e.name, e.text) == ("HOLD", "1") and e.t_s >= t_s
        )
        assert event is not None, "no HOLD came"
        print(f"{what}: {(event.t_s - t_s) * 1000:.1f} ms")  # noqa: T201  for who runs it with -s
        return event.t_s - t_s

    return seconds
