"""The application's end of the line to the guardian: starts it, talks to it, notices its death."""

import contextlib
import logging
import secrets
import selectors
import socket
import subprocess
import threading
from collections.abc import Callable
from pathlib import Path

from gestureapp.cell.guardian_process import close_pipes
from gestureapp.cell.lifeline import hold_lifeline
from gestureapp.clock import Clock
from gestureapp.errors import GuardianLost
from gestureapp.robot import messages as m
from gestureapp.robot.gate import Limits
from gestureapp.robot.leftover import KeptMoves
from gestureapp.robot.values import StopReason
from gestureapp.worker import Worker

log = logging.getLogger(__name__)

START_LIMIT_S = 2.0
"""From the ``Start`` line to the "listening" one. A new process needs 0.2 s, more on a cold disk;
one that has not answered by then is left for another."""
SEND_LIMIT_S = 0.05
"""A guardian that takes no bytes for this long counts as lost."""


class GuardianLink:
    """One guardian process and the connections to it. Made and closed by the cell.

    ``send`` belongs to the control thread, ``stop_now`` to the window's: each has a connection of
    its own, so neither ever waits for the other.

    Args:
        process: Waits for its ``Start`` line; the link's own from now on.
        host: The controller's address; empty when there is none.
        port: Its TCP port.
        limits: For the guardian's whole life.
        is_simulation: The controller is an emulator on this machine.
        kept: What a guardian before has learned of this controller.
        log_file: For the guardian's own log, or None.
        on_message: Gets what the guardian says, in the link's reader thread.
        on_lost: Told once, in the reader thread, when the guardian is gone unasked.
        clock: Monotonic seconds.

    Raises:
        GuardianLost: it could not be started.
        ValueError: a simulation was given an address outside this machine.
    """

    def __init__(
        self,
        process: subprocess.Popen[bytes],
        host: str,
        port: int,
        limits: Limits,
        is_simulation: bool,
        kept: KeptMoves,
        log_file: Path | None,
        on_message: Callable[[m.FromGuardian], None],
        on_lost: Callable[[str], None],
        clock: Clock,
    ) -> None:
        self._on_message = on_message
        self._on_lost = on_lost
        self._clock = clock
        self._is_closing = False
        token = secrets.token_hex(16)
        start = m.Start(token, host, port, limits, str(log_file or ""), is_simulation, kept)
        self._process = process
        try:
            self._tell_start(start)
            address = ("127.0.0.1", self._read_port())
            self._control = self._connect(address, token, m.Role.CONTROL)
            self._window = self._connect(address, token, m.Role.WINDOW)
            lifeline = socket.create_connection(address, timeout=START_LIMIT_S)
            lifeline.setblocking(True)
            hold_lifeline(lifeline, m.encode(m.Hello(token, m.Role.LIFELINE)))
        except (OSError, GuardianLost) as error:
            self._process.kill()
            self._end_process()
            raise GuardianLost(f"the guardian did not start: {error}; start again") from error
        self._window_lock = threading.Lock()
        self._reader = Worker("guardian reader", self._read)
        self._reader.start()

    @property
    def pid(self) -> int:
        """Of the guardian process."""
        return self._process.pid

    def send(self, message: m.ToGuardian) -> None:
        """Say something. Control thread only; a guardian that does not take it shows as lost."""
        self._send_on(self._control, message)

    def stop_now(self, text: str, reason: StopReason = StopReason.STOP_PRESSED) -> None:
        """STOP from the window: straight to the guardian, past every queue. Any thread."""
        message = m.Stop(reason, text, self._clock())
        with self._window_lock:
            self._send_on(self._window, message)

    def dismiss(self) -> None:
        """Say goodbye: the guardian stops what may still move, then ends. Does not wait for it."""
        if self._is_closing:
            return
        self._is_closing = True
        self._send_on(self._control, m.Bye())
        for sock in (self._control, self._window):
            with contextlib.suppress(OSError):
                sock.shutdown(socket.SHUT_WR)

    def close(self, wait_s: float = 3.0, *, is_killed: bool = False) -> bool:
        """Let the guardian go: it stops what may still move, then ends. Idempotent.

        Args:
            wait_s: How long it may take.
            is_killed: End one that has not ended by then: another one takes its place.

        Returns:
            Whether the guardian has ended within the time.
        """
        self.dismiss()
        has_ended = self._wait(wait_s, is_killed)
        self._reader.stop()
        for sock in (self._control, self._window):
            sock.close()
        if has_ended:
            self._end_process()
        return has_ended

    def _tell_start(self, start: m.Start) -> None:
        assert self._process.stdin is not None
        self._process.stdin.write(m.encode(start))
        self._process.stdin.flush()

    def _read_port(self) -> int:
        assert self._process.stdout is not None
        with selectors.DefaultSelector() as selector:
            selector.register(self._process.stdout, selectors.EVENT_READ)
            if not selector.select(START_LIMIT_S):
                raise GuardianLost(f"it said nothing within {START_LIMIT_S:.0f} s")
        message = m.decode(self._process.stdout.readline())
        if not isinstance(message, m.Listening):
            raise GuardianLost("it ended at once")
        return message.port

    def _connect(self, address: tuple[str, int], token: str, role: m.Role) -> socket.socket:
        sock = socket.create_connection(address, timeout=START_LIMIT_S)
        sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        sock.settimeout(SEND_LIMIT_S)
        sock.sendall(m.encode(m.Hello(token, role)))
        return sock

    def _send_on(self, sock: socket.socket, message: m.ToGuardian) -> None:
        try:
            sock.sendall(m.encode(message))
        except OSError as error:
            if not self._is_closing:
                log.error("the guardian takes no messages: %s", error)
            # Half a message may have gone out: the line is of no use any more. The guardian sees
            # it end and stops the robot; the reader sees it end and reports the loss.
            with contextlib.suppress(OSError):
                sock.shutdown(socket.SHUT_RDWR)

    def _read(self, stopping: threading.Event) -> None:
        unread = b""
        while not stopping.is_set():
            try:
                data = self._control.recv(65536)
            except TimeoutError:
                continue
            except OSError:
                data = b""
            if not data:
                break
            *lines, unread = (unread + data).split(b"\n")
            for line in lines:
                self._hand_on(line)
        if not self._is_closing:
            self._on_lost("the guardian process has ended; a new one holds the robot first")

    def _hand_on(self, line: bytes) -> None:
        message = m.decode(line)
        if isinstance(message, m.FromGuardian):
            self._on_message(message)
        else:
            log.error("unreadable line from the guardian: %r", line[:80])

    def _wait(self, wait_s: float, is_killed: bool) -> bool:
        try:
            self._process.wait(wait_s)
        except subprocess.TimeoutExpired:
            if not is_killed:
                log.error("the guardian (process %d) is still stopping the robot", self.pid)
                return False
            log.warning("the guardian (process %d) hangs and is killed", self.pid)
            self._process.kill()
        return True

    def _end_process(self) -> None:
        self._process.wait()
        close_pipes(self._process)
