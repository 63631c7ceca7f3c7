"""The emulated NX100 on TCP: one thread, one selector loop around pure conversations."""

import contextlib
import logging
import math
import os
import selectors
import socket
import struct
import threading
from dataclasses import dataclass, field

from gestureapp.clock import Clock, monotonic
from gestureapp.errors import RobotError, SensorError
from gestureapp.robot.values import Pose
from gestureapp.simulation.control_port import ControlPort
from gestureapp.simulation.controller import Controller
from gestureapp.simulation.listening import accepted, received, written
from gestureapp.simulation.nx100_commands import Answer, execute
from gestureapp.simulation.nx100_control import obey
from gestureapp.simulation.nx100_conversation import Conversation
from gestureapp.simulation.nx100_lines import Bad, LineEvent, Request
from gestureapp.simulation.nx100_log import EventLog, LogEvent, What
from gestureapp.simulation.nx100_options import Fault, FaultKind, Nx100Options, Second
from gestureapp.simulation.nx100_values import Hold, Mode, MotionStarted
from gestureapp.worker import Worker

log = logging.getLogger(__name__)

IDLE_WAIT_S = 1.0
"""Longest sleep of the loop; only bounds how long a lost wake-up could matter."""
UNSENT_MAX_BYTES = 1_000_000
_RESET_ON_CLOSE = struct.pack("hh" if os.name == "nt" else "ii", 1, 0)
"""SO_LINGER of no time: closing sends RST."""


@dataclass(slots=True, eq=False)
class _Connection:
    number: int
    socket: socket.socket
    conversation: Conversation
    outbox: bytearray = field(default_factory=bytearray)
    has_ended: bool = False
    is_shut: bool = False


class Nx100Emulator:
    """An NX100 with an HP6 that obeys the Ethernet server function's protocol.

    Either ``start`` it in a thread of its own, or ``open`` it and ``run`` its loop in yours. Every
    other method may be called from any thread while it runs.

    Attributes:
        options: As given.
        controller: The model; touch it from another thread only under ``lock``.
        lock: Held by the loop while it works.
        log: What was heard, said and done.
    """

    def __init__(self, options: Nx100Options | None = None, clock: Clock = monotonic) -> None:
        self.options = options or Nx100Options()
        self.lock = threading.RLock()
        self.controller = Controller(self.options.controller, clock())
        self.log = EventLog(self.options.log_file)
        self._clock = clock
        self._fault = Fault()
        self._script = sorted(self.options.script, key=lambda entry: entry.at_s)
        self._start_s = clock()
        self._worker: Worker | None = None
        self._selector = selectors.DefaultSelector()
        self._waker, self._wakened = socket.socketpair()
        self._listener: socket.socket | None = None
        self._control: ControlPort | None = None
        self._connections: list[_Connection] = []
        self._count = 0
        self._port = self.options.port

    @property
    def port(self) -> int:
        """TCP port it listens on; known after ``open`` or ``start``."""
        return self._port

    @property
    def control_port(self) -> int | None:
        """TCP port of the virtual pendant, or None."""
        return self._control.port if self._control is not None else None

    # Life

    def __enter__(self) -> "Nx100Emulator":
        self.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    def open(self) -> None:
        """Listen.

        Raises:
            RobotError: the address or the control port cannot be served.
        """
        self._waker.setblocking(False)
        self._wakened.setblocking(False)
        self._selector.register(self._wakened, selectors.EVENT_READ, self._calm)
        try:
            self._listen()
            self._open_control()
        except Exception:
            self._close()
            raise
        self._start_s = self._clock()

    def start(self) -> None:
        """Listen and serve in a thread until ``stop``. Errors as ``open``."""
        self.open()
        self._worker = Worker("nx100-emulator", self.run)
        self._worker.start()

    def stop(self) -> None:
        """End the thread and close every connection; idempotent."""
        if self._worker is not None:
            self._worker.stopping.set()
            self.wake()
            self._worker.stop()
        self._close()

    def run(self, stopping: threading.Event) -> None:
        """Serve in the calling thread until ``stopping`` is set and ``wake`` was called."""
        try:
            while not stopping.is_set():
                with self.lock:
                    wait_s = min(IDLE_WAIT_S, max(0.0, self._next_s() - self._clock()))
                ready = self._selector.select(wait_s)
                with self.lock:
                    # New connections last: one that makes room may have ended in the same moment.
                    for key, _ in sorted(ready, key=lambda r: r[0].fileobj is self._listener):
                        key.data()
                    self._turn()
        finally:
            self._close()

    def wake(self) -> None:
        """Make the loop look at the time again. A signal handler may do it, too."""
        with contextlib.suppress(OSError):
            self._waker.send(b"\0")

    # The virtual pendant

    def now_s(self) -> float:
        """Read the emulator's clock."""
        return self._clock()

    def servo(self, is_on: bool) -> None:
        """Switch servo power; off stops a move at once."""
        with self.lock:
            self.controller.set_servo(is_on, self._clock())
        self.wake()

    def remote(self, is_on: bool) -> None:
        """Select command remote, or not."""
        with self.lock:
            self.controller.set_remote(is_on, self._clock())
        self.wake()

    def hold(self, who: Hold, is_on: bool) -> None:
        """Press or release HOLD on the pendant, or the external hold input."""
        with self.lock:
            self.controller.set_hold(who, is_on, self._clock())
        self.wake()

    def alarm(self, code: int, data: int = 0) -> None:
        """Raise an alarm: servo power drops."""
        with self.lock:
            self.controller.raise_alarm(code, data, self._clock())
        self.wake()

    def error(self, code: int, data: int = 0) -> None:
        """Show an error, cleared by CANCEL."""
        with self.lock:
            self.controller.raise_error(code, data, self._clock())
        self.wake()

    def mode(self, mode: Mode) -> None:
        """Turn the key."""
        with self.lock:
            self.controller.set_mode(mode, self._clock())
        self.wake()

    def place(self, pose: Pose) -> bool:
        """Put the arm elsewhere; False while it moves."""
        with self.lock:
            return self.controller.set_pose(pose, self._clock())

    def pose(self) -> Pose:
        """Give where the arm is now."""
        with self.lock:
            return self.controller.pose(self._clock())

    def is_running(self) -> bool:
        """Whether the arm moves now."""
        with self.lock:
            return self.controller.is_running(self._clock())

    def fault(self, fault: Fault) -> None:
        """Let something be wrong from now on, or with ``Fault()`` nothing any more."""
        with self.lock:
            self._begin(fault)
        self.wake()

    # The loop

    def _next_s(self) -> float:
        script_s = self._start_s + self._script[0].at_s if self._script else math.inf
        talks_s = [c.conversation.next_s for c in self._connections]
        return min(self.controller.next_event_s, script_s, *talks_s, math.inf)

    def _turn(self) -> None:
        now_s = self._clock()
        while self._script and self._start_s + self._script[0].at_s <= now_s:
            self._begin_scripted(self._script.pop(0).fault)
        self.controller.advance(now_s)
        for connection in list(self._connections):
            self._serve(connection)
        for event in self.controller.take_events():
            if isinstance(event, MotionStarted):
                self._note(What.MOTION_START, t_s=event.t_s, pose=event.pose)
            else:
                name = event.reason.value
                self._note(What.MOTION_END, t_s=event.t_s, pose=event.pose, name=name)
        self.log.flush()

    def _calm(self) -> None:
        with contextlib.suppress(OSError):
            self._wakened.recv(4096)

    def _listen(self) -> None:
        try:
            listener = socket.create_server((self.options.host, self._port), backlog=8)
        except (OSError, OverflowError) as error:
            place = f"{self.options.host}:{self._port}"
            raise RobotError(f"cannot serve {place}: {error}; name another port, or 0") from error
        listener.setblocking(False)
        self._listener, self._port = listener, listener.getsockname()[1]
        self._selector.register(listener, selectors.EVENT_READ, self._accept)

    def _open_control(self) -> None:
        host, port = self.options.host, self.options.control_port
        if port is None:
            return
        try:
            self._control = ControlPort(
                "NX100 control", host, port, self._selector, lambda line: obey(self, line)
            )
        except SensorError as error:  # the port is shared with the sensors' emulator, its name not
            text = f"cannot serve the control port {host}:{port}; name another, or 0"
            raise RobotError(text) from error

    def _unlisten(self) -> None:
        if self._listener is not None:
            with contextlib.suppress(KeyError):  # it waits for its turn
                self._selector.unregister(self._listener)
            self._listener.close()
            self._listener = None

    def _accept(self) -> None:
        is_taken = any(not c.has_ended for c in self._connections)
        if self._listener is None or (is_taken and self.options.second is Second.IGNORE):
            return
        client = accepted(self._listener)
        if client is None:
            return
        self._count += 1
        talk = Conversation(self.options, self._execute, self._clock())
        connection = _Connection(self._count, client, talk)
        self._note(What.OPEN, connection=self._count)
        self._connections.append(connection)
        if is_taken and self.options.second is Second.REFUSE:
            self._drop(connection, "refused")
            return
        self._selector.register(client, selectors.EVENT_READ, lambda: self._hear(connection))
        if self.options.second is Second.IGNORE:
            self._selector.unregister(self._listener)

    def _execute(self, request: Request, now_s: float) -> Answer:
        return execute(request, self.controller, now_s)

    def _hear(self, connection: _Connection) -> None:
        if connection not in self._connections or connection.has_ended:
            return
        data = received(connection.socket)
        now_s = self._clock()
        if data is None:
            return
        if not data:
            connection.has_ended = True
            self._selector.unregister(connection.socket)
            return
        number = connection.number
        self._note(What.IN, connection=number, data=data, t_s=now_s)
        for event in connection.conversation.receive(data, now_s, self._fault):
            self._note_line(event, number, now_s)

    def _note_line(self, event: LineEvent, number: int, now_s: float) -> None:
        if isinstance(event, Request):
            name, text, is_odd = event.name, event.data, event.is_odd
            self.log.add(LogEvent(now_s, What.REQUEST, number, b"", name, text, is_odd))
        elif isinstance(event, Bad):
            name = event.refused.value
            self._note(What.BAD, connection=number, name=name, text=event.line, t_s=now_s)

    def _serve(self, connection: _Connection) -> None:
        now_s, talk = self._clock(), connection.conversation
        for chunk in talk.take(now_s, self._fault):
            if not self._send(connection, chunk):
                return
        if connection.outbox and not self._send(connection, b""):
            return
        if talk.is_refused and talk.is_drained and not connection.is_shut:
            connection.is_shut = True
            with contextlib.suppress(OSError):
                connection.socket.shutdown(socket.SHUT_WR)
        if talk.is_over(now_s):
            self._drop(connection, "closed")
        elif connection.has_ended and talk.is_drained:
            self._drop(connection, "ended")

    def _send(self, connection: _Connection, chunk: bytes) -> bool:
        """Send what can be sent. Returns whether the connection is still there."""
        connection.outbox += chunk
        n = written(connection.socket, bytes(connection.outbox))
        if n is None or len(connection.outbox) > UNSENT_MAX_BYTES:
            self._drop(connection, "lost")
            return False
        del connection.outbox[:n]
        if chunk:
            self._note(What.OUT, connection=connection.number, data=chunk)
        if not connection.has_ended:
            wanted = selectors.EVENT_READ | (selectors.EVENT_WRITE if connection.outbox else 0)
            self._selector.modify(connection.socket, wanted, lambda: self._hear(connection))
        return True

    def _drop(self, connection: _Connection, why: str, with_reset: bool = False) -> None:
        self._connections.remove(connection)
        with contextlib.suppress(KeyError):
            self._selector.unregister(connection.socket)
        if with_reset or why == "refused":
            with contextlib.suppress(OSError):
                connection.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, _RESET_ON_CLOSE)
        connection.socket.close()
        self._note(What.CLOSE, connection=connection.number, name=why)
        if self.options.second is Second.IGNORE and self._listener is not None:
            with contextlib.suppress(KeyError):
                self._selector.register(self._listener, selectors.EVENT_READ, self._accept)

    def _begin_scripted(self, fault: Fault) -> None:
        try:
            self._begin(fault)
        except RobotError as error:
            log.error("the script goes on without its fault: %s", error)

    def _begin(self, fault: Fault) -> None:
        self._note(What.FAULT, name=fault.kind.value)
        if fault.kind is FaultKind.DROP:
            for connection in list(self._connections):
                self._drop(connection, "dropped", with_reset=True)
            fault = Fault()
        if fault.kind is FaultKind.REFUSE:
            self._unlisten()
        elif self._listener is None:
            self._listen()
        self._fault = fault

    def _note(
        self,
        what: What,
        *,
        t_s: float | None = None,
        connection: int = 0,
        data: bytes = b"",
        name: str = "",
        text: str = "",
        pose: Pose | None = None,
    ) -> None:
        when_s = self._clock() if t_s is None else t_s
        self.log.add(LogEvent(when_s, what, connection, data, name, text, False, pose))

    def _close(self) -> None:
        with self.lock:
            for connection in list(self._connections):
                self._drop(connection, "stopped")
            if self._control is not None:
                self._control.close()
            if self._listener is not None:
                self._listener.close()
                self._listener = None
            self._selector.close()
            self._waker.close()
            self._wakened.close()
            self.log.close()
