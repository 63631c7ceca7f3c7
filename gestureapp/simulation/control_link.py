"""A client's end of an emulator's control port: a JSON line out, one back. One thread at a time."""

import json
import socket
from collections.abc import Mapping
from typing import Self

from gestureapp.errors import WorkerError

WAIT_S = 1.0
"""Longest wait for a connection or an answer; an emulator on this machine answers within 10 ms."""


class ControlLink:
    """Asks one emulator; connects at the first question and again after a failure.

    Attributes:
        name: Of the emulator, for a person.
        host: Where its control port is.
        port: Its number.
    """

    def __init__(self, name: str, host: str, port: int, wait_s: float = WAIT_S) -> None:
        self.name = name
        self.host = host
        self.port = port
        self._wait_s = wait_s
        self._socket: socket.socket | None = None
        self._inbox = b""

    def ask(self, command: Mapping[str, object]) -> dict[str, object]:
        """Send a command and wait for its answer.

        Raises:
            WorkerError: nobody answers, or the emulator refuses; the text says which and why.
        """
        try:
            line = self._exchange(json.dumps(command).encode("ascii") + b"\n")
            answer = json.loads(line)
        except (OSError, ValueError) as error:
            self.close()
            where = f"{self.host}:{self.port}"
            reason = str(error) or type(error).__name__
            text = f"does not answer at {where} ({reason}); start it again"
            raise WorkerError(self.name, text) from error
        if not isinstance(answer, dict) or answer.get("ok") is not True:
            why = answer.get("error") if isinstance(answer, dict) else "no JSON object"
            raise WorkerError(self.name, f"refuses {command.get('do')}: {why}")
        return answer

    def close(self) -> None:
        """Close the connection. Idempotent; the next question opens it again."""
        if self._socket is not None:
            self._socket.close()
            self._socket = None
        self._inbox = b""

    def __enter__(self) -> Self:
        """Nothing is opened before the first question."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close."""
        self.close()

    def _exchange(self, line: bytes) -> bytes:
        if self._socket is None:
            self._socket = socket.create_connection((self.host, self.port), self._wait_s)
            self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._socket.sendall(line)
        while b"\n" not in self._inbox:
            data = self._socket.recv(65_536)
            if not data:
                raise ConnectionError("the connection was closed")
            self._inbox += data
        answer, _, self._inbox = self._inbox.partition(b"\n")
        return answer
