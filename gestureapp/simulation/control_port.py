"""A TCP port that answers each JSON line with a JSON line. Loop's thread only; never blocks."""

import contextlib
import json
import selectors
import socket
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from gestureapp.simulation.listening import READ_MAX_BYTES, accepted, listen, received, written

CLIENTS_MAX = 16

UNREAD_MAX_BYTES = 16_000_000
"""A client that leaves more answers than this unread is dropped; the longest answer is a log."""


@dataclass(slots=True)
class _Client:
    socket: socket.socket
    inbox: bytes = b""
    outbox: bytes = b""


class ControlPort:
    """Takes command lines from several clients and answers each with one line.

    Owned by the emulator's loop.

    Attributes:
        port: TCP port.
    """

    def __init__(
        self,
        sensor: str,
        host: str,
        port: int,
        selector: selectors.BaseSelector,
        answer: Callable[[bytes], Mapping[str, object]],
    ) -> None:
        self._selector = selector
        self._answer = answer
        self._listener = listen(sensor, host, port)
        self.port: int = self._listener.getsockname()[1]
        self._clients: list[_Client] = []
        selector.register(self._listener, selectors.EVENT_READ, self._accept)

    def close(self) -> None:
        """Close everything. Idempotent."""
        for client in list(self._clients):
            self._drop(client)
        with contextlib.suppress(KeyError, ValueError):
            self._selector.unregister(self._listener)
        self._listener.close()

    def _accept(self) -> None:
        connection = accepted(self._listener)
        if connection is None:
            return
        if len(self._clients) >= CLIENTS_MAX:
            connection.close()
            return
        client = _Client(connection)
        self._clients.append(client)
        self._selector.register(connection, selectors.EVENT_READ, lambda: self._serve(client))

    def _serve(self, client: _Client) -> None:
        data = received(client.socket) if client in self._clients else None
        if data == b"":
            self._drop(client)
            return
        *lines, client.inbox = (client.inbox + (data or b"")).split(b"\n")
        for line in lines:
            if line.strip():
                self._queue(client, self._answer(line))
        if len(client.inbox) > READ_MAX_BYTES:
            error = f"a line is longer than {READ_MAX_BYTES} bytes"
            client.inbox = b""
            self._queue(client, {"ok": False, "error": error})
        self._flush(client)

    def _queue(self, client: _Client, answer: Mapping[str, object]) -> None:
        client.outbox += json.dumps(answer, separators=(",", ":")).encode("ascii") + b"\n"

    def _flush(self, client: _Client) -> None:
        if client not in self._clients:
            return
        n = written(client.socket, client.outbox) if client.outbox else 0
        if n is None or len(client.outbox) > UNREAD_MAX_BYTES:
            self._drop(client)
            return
        client.outbox = client.outbox[n:]
        wanted = selectors.EVENT_READ | (selectors.EVENT_WRITE if client.outbox else 0)
        self._selector.modify(client.socket, wanted, lambda: self._serve(client))

    def _drop(self, client: _Client) -> None:
        self._clients.remove(client)
        self._selector.unregister(client.socket)
        client.socket.close()
