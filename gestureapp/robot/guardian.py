"""The guardian process: it alone owns the robot's socket. One thread, one selector loop.

The thinking is in ``supervisor``; here are only sockets and the clock. The application starts it,
hands it one ``Start`` line on standard input, and connects: from the control thread, from the
window, and for its end alone. When any of these ends without a ``Bye``, the application is gone
and the robot is stopped. Before it opens the robot's address it takes the lock for it, and keeps it
until its end: one application for each robot.
"""

import contextlib
import logging
import os
import selectors
import signal
import socket
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass

from gestureapp.robot import messages as m
from gestureapp.robot.acts import Act, Did, act_of
from gestureapp.robot.clock import monotonic
from gestureapp.robot.guardian_log import open_log
from gestureapp.robot.lock import AddressLock
from gestureapp.robot.outputs import DropRobot, ToApp, ToRobot
from gestureapp.robot.supervisor import Supervisor
from gestureapp.robot.values import StopReason

log = logging.getLogger("guardian")

HELLO_LIMIT_S = 5.0
"""An application that has not connected by then has died on the way."""
CONNECT_LIMIT_S = 1.0
RETRY_S = 0.2
"""Between two attempts to reach the controller; none while a stop waits for the line."""
UNREACHABLE_LIMIT_S = 60.0
"""How long a guardian without application goes on trying to reach a robot that may be moving."""
ALIVE_S = 0.1
"""The application hears of the guardian at least this often."""
BACKLOG_LIMIT = 1 << 20
"""Bytes kept for an application that does not read; more is dropped, it is frozen anyway."""


@dataclass(slots=True)
class _Peer:
    """One connection of the application."""

    sock: socket.socket
    role: m.Role | None = None
    unread: bytes = b""
    unsent: bytes = b""


class Guardian:
    """The loop around the supervisor. Owns every socket of the process."""

    def __init__(
        self, start: m.Start, listener: socket.socket, write_log: Callable[[], None] = lambda: None
    ) -> None:
        self._start = start
        self._supervisor = Supervisor(start.limits, start.kept)
        self._selector = selectors.DefaultSelector()
        self._listener = listener
        self._listener.setblocking(False)
        self._selector.register(listener, selectors.EVENT_READ)
        self._peers: dict[socket.socket, _Peer] = {}
        self._robot: socket.socket | None = None
        self._is_connecting = False
        self._lock = AddressLock(start.host, start.port, os.getppid())
        self._connect_s = float("-inf")
        self._born_s = monotonic()
        self._was_greeted = False
        self._was_told = False
        self._gone_s: float | None = None
        self._seen_s = self._told_s = float("-inf")
        self._could_move = False
        self._run = f"{os.getpid()} {time.time():.3f}"
        self._write_log = write_log
        self._is_leaving = False
        self.is_told_to_end = False

    def run(self) -> int:
        """Serve until the application is gone and the robot stands; then close everything."""
        with contextlib.closing(self):
            return self._serve()

    def close(self) -> None:
        """Close the robot's line, give its address back, close the rest. Idempotent."""
        self._close_robot()
        self._lock.give_back()
        for peer in list(self._peers.values()):
            self._close_peer(peer)
        self._selector.close()

    def _serve(self) -> int:
        has_failed = False
        self._note(Did.STARTED, f"for {self._start.host}:{self._start.port}")
        while not self._is_over(monotonic()):
            try:
                self._turn()
            except Exception as error:  # the top of the process: it must not leave a robot running
                if has_failed:
                    raise
                has_failed = True
                log.exception("the guardian failed; it stops the robot and ends")
                self._application_gone(f"the guardian failed: {error}")
        self._note(Did.ENDED)
        self._write_log()
        return int(has_failed)

    def _turn(self) -> None:
        self._write_log()  # now that what had to go out is out
        self._could_move = self._supervisor.may_move
        now_s = monotonic()
        wait_s = max(0.0, self._supervisor.next_due_s(now_s) - now_s)
        ready = self._selector.select(wait_s)
        # The application first: a STOP must not wait for what the controller says.
        for key, mask in sorted(ready, key=lambda item: item[0].fileobj is self._robot):
            if key.fileobj is self._listener:
                self._accept()
            elif key.data is not None:
                self._peer_ready(key.data, mask)
            elif key.fileobj is self._robot:  # else it was closed for what came before it
                self._robot_ready(mask)
        self._keep_robot(monotonic())
        self._supervisor.tick(monotonic())
        self._flush()
        if monotonic() - self._told_s >= ALIVE_S:
            self._tell(m.Alive())

    # The application's connections.

    def _accept(self) -> None:
        try:
            sock, _ = self._listener.accept()
        except OSError as error:  # it went away before its turn, or there are too many
            log.warning("a connection could not be taken: %s", error)
            return
        sock.setblocking(False)
        sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        peer = self._peers[sock] = _Peer(sock)
        self._selector.register(sock, selectors.EVENT_READ, peer)

    def _peer_ready(self, peer: _Peer, mask: int) -> None:
        if mask & selectors.EVENT_WRITE:
            self._send_unsent(peer)
        if not mask & selectors.EVENT_READ:
            return
        try:
            data = peer.sock.recv(65536)
        except BlockingIOError:
            return
        except OSError:
            data = b""
        if not data:
            self._peer_ended(peer)
            return
        *lines, peer.unread = (peer.unread + data).split(b"\n")
        for line in lines:
            if peer.sock in self._peers:
                self._peer_said(peer, line)
        if len(peer.unread) > BACKLOG_LIMIT:
            self._peer_ended(peer)

    def _peer_said(self, peer: _Peer, line: bytes) -> None:
        message = m.decode(line)
        now_s = monotonic()
        if peer.role is None:
            if isinstance(message, m.Hello) and message.token == self._start.token:
                peer.role = message.role
                self._was_greeted = True
                if peer.role is m.Role.CONTROL:
                    self._supervisor.greeted(now_s)
                    self._flush()
            else:
                log.warning("a connection without the token was closed")
                self._close_peer(peer)
        elif message is None:
            log.warning("unreadable line from the application: %r", line[:80])
        elif isinstance(message, m.Bye):
            self._is_leaving = True
        elif peer.role is m.Role.CONTROL or isinstance(message, m.Stop):
            self._was_told = True
            if isinstance(message, m.Beat):
                self._seen_s = min(message.control_s, message.gui_s)
            self._supervisor.message(message, now_s)
            self._flush()

    def _peer_ended(self, peer: _Peer) -> None:
        role = peer.role
        self._close_peer(peer)
        if role is not None:
            self._application_gone(f"its {role.value} connection ended")

    def _close_peer(self, peer: _Peer) -> None:
        if self._peers.pop(peer.sock, None) is not None:
            self._selector.unregister(peer.sock)
            peer.sock.close()

    def _application_gone(self, how: str) -> None:
        if self._gone_s is not None:
            return
        now_s = monotonic()
        self._gone_s = now_s
        is_orderly = self._is_leaving and not self._supervisor.may_move
        self._note(Did.GONE, how, could_move=not is_orderly, seen_s=self._seen_s)
        if is_orderly:
            return
        self._supervisor.stop(StopReason.APPLICATION_GONE, f"application gone: {how}", now_s)
        self._supervisor.tick(now_s)
        self._flush()

    def _is_over(self, now_s: float) -> bool:
        if self.is_told_to_end:
            self._application_gone("told to end")
        if self._gone_s is None:
            return not self._was_greeted and now_s - self._born_s > HELLO_LIMIT_S
        if not self._supervisor.is_stopping:
            return True
        is_reachable = (
            self._supervisor.is_link_open
            or self._supervisor.has_commanded
            or self._robot is not None  # a guardian that has just taken over still gets there
        )
        return not is_reachable or now_s - self._gone_s > UNREACHABLE_LIMIT_S

    # The controller's connection.

    def _keep_robot(self, now_s: float) -> None:
        # A guardian that follows a dead one is told to stop first: until it has been told
        # anything, it does not even read, so that HOLD can be the first request.
        if not self._start.host or not self._was_told:
            return
        if self._robot is None:
            pause_s = 0.02 if self._supervisor.is_stopping else RETRY_S
            if now_s - self._connect_s >= pause_s:
                self._connect_s = now_s
                self._open_robot(now_s)
        elif self._is_connecting and now_s - self._connect_s > CONNECT_LIMIT_S:
            self._robot_gone(f"no connection within {CONNECT_LIMIT_S:.0f} s")

    def _open_robot(self, now_s: float) -> None:
        in_use = self._lock.take()
        if in_use is None:
            self._connect()
        else:
            self._supervisor.robot_ended(in_use.text, now_s, in_use.remedy)
            self._flush()

    def _connect(self) -> None:
        try:
            address = (self._start.host, self._start.port)
            family = socket.AF_INET6 if ":" in self._start.host else socket.AF_INET
            sock = socket.socket(family, socket.SOCK_STREAM)
            sock.setblocking(False)
            sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            self._robot, self._is_connecting = sock, True
            self._selector.register(sock, selectors.EVENT_READ | selectors.EVENT_WRITE)
            with contextlib.suppress(BlockingIOError):
                sock.connect(address)
        except (OSError, ValueError, OverflowError) as error:  # also a host or port that is none
            self._robot_gone(str(error))

    def _robot_ready(self, mask: int) -> None:
        sock = self._robot
        if sock is None:
            return
        now_s = monotonic()
        if self._is_connecting:
            error = sock.getsockopt(socket.SOL_SOCKET, socket.SO_ERROR)
            if error:
                self._robot_gone(os.strerror(error))
                return
            self._is_connecting = False
            self._selector.modify(sock, selectors.EVENT_READ)
            self._supervisor.robot_connected(now_s)
            self._flush()
        if mask & selectors.EVENT_READ:
            self._read_robot(sock)

    def _read_robot(self, sock: socket.socket) -> None:
        try:
            data = sock.recv(65536)
        except BlockingIOError:
            return
        except OSError as error:
            self._robot_gone(error.strerror or str(error))
            return
        if not data:
            self._robot_gone("the controller closed the connection")
            return
        self._supervisor.robot_bytes(data, monotonic())
        self._flush()

    def _robot_gone(self, reason: str) -> None:
        self._close_robot()
        where = f"{self._start.host}:{self._start.port}"
        self._supervisor.robot_ended(f"{where}: {reason}", monotonic())
        self._flush()

    def _close_robot(self) -> None:
        sock, self._robot = self._robot, None
        self._is_connecting = False
        if sock is not None:
            self._selector.unregister(sock)
            sock.close()

    # What goes out.

    def _flush(self) -> None:
        for output in self._supervisor.take_outputs():
            match output:
                case ToRobot():
                    self._send_robot(output.data)
                case DropRobot():
                    log.warning("robot link dropped: %s", output.reason)
                    self._close_robot()
                case ToApp():
                    self._tell(output.message)

    def _send_robot(self, data: bytes) -> None:
        if self._robot is None:
            return
        try:
            sent = self._robot.send(data)
        except OSError as error:
            sent = -1
            log.warning("robot link: %s", error)
        if sent != len(data):
            self._robot_gone("the controller takes no bytes")

    def _tell(self, message: m.FromGuardian) -> None:
        act = act_of(message, self._run, time.time(), self._could_move)
        if act is not None:
            log.warning("%s", act.line)
        line, self._told_s = m.encode(message), monotonic()
        for peer in self._peers.values():
            if peer.role is m.Role.CONTROL and len(peer.unsent) < BACKLOG_LIMIT:
                peer.unsent += line
                self._send_unsent(peer)

    def _send_unsent(self, peer: _Peer) -> None:
        with contextlib.suppress(OSError):  # a peer that is gone shows at its next read
            sent = peer.sock.send(peer.unsent)
            peer.unsent = peer.unsent[sent:]
        writes = selectors.EVENT_WRITE if peer.unsent else 0
        self._selector.modify(peer.sock, selectors.EVENT_READ | writes, peer)

    def _note(
        self, did: Did, text: str = "", *, could_move: bool = False, seen_s: float = 0.0
    ) -> None:
        act = Act(did, self._run, time.time(), monotonic(), text, "", could_move, max(seen_s, 0.0))
        log.info("%s", act.line)


def main() -> int:
    """The process: read ``Start``, say where it listens, serve. Returns the exit code."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the application; it stops us
    line = sys.stdin.buffer.readline()
    if not line:  # a spare one, and the application has ended
        return 0
    start = m.decode(line)
    if not isinstance(start, m.Start):
        sys.stderr.write("guardian: it is started by the application, not by hand\n")
        return 2
    write_log = open_log(start.log)
    with socket.create_server(("127.0.0.1", 0)) as listener:
        sys.stdout.buffer.write(m.encode(m.Listening(listener.getsockname()[1])))
        sys.stdout.buffer.flush()
        guardian = Guardian(start, listener, write_log)

        def told_to_end(_signal: int, _frame: object) -> None:
            guardian.is_told_to_end = True

        signal.signal(signal.SIGTERM, told_to_end)
        return guardian.run()
