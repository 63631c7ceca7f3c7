"""One application for each robot: a lock of the system's own that ends with the process.

On Linux a name in the abstract socket space: one for all users, no file that could be removed,
linked elsewhere or left behind, and gone with its process, also after kill -9. It holds in one
network namespace. A second such name tells who holds the first; ``/proc/net/unix`` lists it. On
Windows a mutex of the machine, which does not tell its holder. Elsewhere there is no such lock.
"""

import contextlib
import os
import socket
import sys
from dataclasses import dataclass
from typing import Protocol

from gestureapp.robot.address import address_word

_NAMES = "/proc/net/unix"


class _Part(Protocol):
    """What holds the lock, or tells who does, for as long as it is not closed."""

    def close(self) -> None:
        """Let it go."""


if sys.platform == "win32":
    import ctypes

    _KERNEL = ctypes.WinDLL("kernel32", use_last_error=True)
    _KERNEL.CreateMutexW.restype = ctypes.c_void_p
    _KERNEL.CloseHandle.argtypes = [ctypes.c_void_p]
    _ALREADY_EXISTS = 183
    """Source: CreateMutexW; another user's mutex gives no handle at all."""

    class _Mutex:
        """A mutex that exists for nobody else. Raises OSError when it does."""

        def __init__(self, name: str) -> None:
            self._handle = _KERNEL.CreateMutexW(None, False, name)
            error = ctypes.get_last_error()
            if not self._handle or error == _ALREADY_EXISTS:
                self.close()
                raise OSError(error, "the mutex is another's")

        def close(self) -> None:
            """Let it go; the end of the process does the same."""
            if self._handle:
                _KERNEL.CloseHandle(self._handle)
            self._handle = None


@dataclass(frozen=True, slots=True)
class InUse:
    """Why the lock is not ours, and what to do, each in words for a person."""

    text: str
    remedy: str
    is_left_over: bool = False
    """Its application is gone; a guardian finishes a stop and ends."""


class AddressLock:
    """The right to open one address. Owned by the guardian; kept until its process ends.

    Args:
        host: The controller's address.
        port: Its TCP port.
        application: Number of the process that others are told to close.
    """

    def __init__(self, host: str, port: int, application: int) -> None:
        self._where = f"{host}:{port}"
        self._name = f"gestureapp-robot-{address_word(host, port)}"
        self._application = application
        self._held: list[_Part] = []

    def take(self) -> InUse | None:
        """Take the lock, or say who has it. At once; None when it is ours, now or already."""
        if not self._held:
            try:
                self._take()
            except OSError:
                return self._in_use()
        return None

    def give_back(self) -> None:
        """Let others have it. Idempotent; the end of the process does the same."""
        for part in self._held:
            part.close()
        self._held.clear()

    def _take(self) -> None:
        if sys.platform == "win32":
            self._held.append(_Mutex(f"Global\\{self._name}"))
        elif sys.platform == "linux":
            self._held.append(_bound(self._name))
            with contextlib.suppress(OSError):  # the lock holds without it
                told = f"{self._name}-of-{self._application}-by-{os.getpid()}"
                self._held.append(_bound(told))

    def _in_use(self) -> InUse:
        application, guardian = self._holder()
        text = f"the robot at {self._where} is in use by another gestureapp"
        if not application:
            return InUse(text, "close that one")
        if _is_alive(application):
            return InUse(f"{text} (process {application})", "close that one")
        text = f"{text}, which is gone; its guardian (process {guardian}) stops the robot"
        return InUse(text, "wait, or end that process", is_left_over=True)

    def _holder(self) -> tuple[int, int]:
        """Process numbers of application and guardian; zeros where they cannot be told."""
        before = f"@{self._name}-of-"
        with contextlib.suppress(OSError, ValueError), open(_NAMES, encoding="utf-8") as names:
            for line in names:
                name = line.rstrip("\n").rpartition(" ")[2]
                if name.startswith(before):
                    application, _, guardian = name.removeprefix(before).partition("-by-")
                    return int(application), int(guardian)
        return 0, 0


def find_other(host: str, port: int) -> InUse | None:
    """The application that has this robot now; None when nobody has it or will have it soon."""
    lock = AddressLock(host, port, os.getpid())
    in_use = lock.take()
    lock.give_back()
    return None if in_use is None or in_use.is_left_over else in_use


def _bound(name: str) -> socket.socket:
    sock = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
    try:
        sock.bind(f"\0{name}")
    except OSError:
        sock.close()
        raise
    return sock


def _is_alive(pid: int) -> bool:
    """Linux only: on Windows this call would end the process."""
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except (OSError, OverflowError):
        return True
    return True
