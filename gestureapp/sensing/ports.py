"""Opens a sensor's port and says in words why it cannot: the only place that knows pyserial.

``socket://HOST:PORT`` is read here directly. pyserial's own handler for it waits 5 s for an
answer, throws away what came first, gives one byte a read, sleeps 0.3 s in ``close`` and leaves
the socket open when the other side went first (version 3.5, ``urlhandler/protocol_socket.py``).
Everything else, devices and other URLs, is ``serial.serial_for_url``.
"""

import errno
import os
import re
import socket
import sys
import urllib.parse
from pathlib import Path
from typing import Any, Protocol

import serial

from gestureapp.errors import SensorBusy, SensorDisconnected, SensorError, SensorNotFound

READ_WAIT_S = 0.1
"""A read gives up after this long, so that the reader sees that it is to stop."""

CONNECT_WAIT_S = 1.0
"""A sensor's server is in the same house; longer only delays the report."""

MAX_READ_BYTES = 4096

BAUD = 115200
"""For ports with a real line; Bluetooth ports ignore it. 100 lines of 30 bytes need 30,000."""

IN_USE = "is in use by another program"
"""Stands in the reason of a port that somebody else has."""

_KEEPALIVE = (("TCP_KEEPIDLE", 5), ("TCP_KEEPINTVL", 2), ("TCP_KEEPCNT", 3))
"""Seconds, seconds, probes: a peer that vanished without a word is noticed after some 11 s."""


class Port(Protocol):
    """An open port. Owned and closed by the thread that reads it."""

    def read(self) -> bytes:
        """What is waiting; empty when nothing comes within ``READ_WAIT_S``.

        Raises:
            SensorDisconnected: the port is gone.
        """

    def close(self) -> None:
        """Close it. Never raises."""


def open_port(sensor: str, url: str) -> Port:
    """Open anything a person may set as a port.

    Args:
        sensor: ``left`` or ``right``, for the errors.
        url: A device, ``socket://HOST:PORT``, or another URL that pyserial knows.

    Raises:
        SensorNotFound: there is no such port, or nobody answers.
        SensorBusy: another program has it.
        SensorError: it cannot be opened for another reason.
    """
    if not url.strip():
        raise SensorNotFound(sensor, "no port is set: choose one in the settings")
    if url.lower().startswith("socket://"):
        return TcpPort(sensor, url)
    return DevicePort(sensor, url)


class TcpPort:
    """A sensor served over TCP."""

    def __init__(self, sensor: str, url: str) -> None:
        self._sensor = sensor
        self._where, address = _address(sensor, url)
        try:
            self._socket = socket.create_connection(address, timeout=CONNECT_WAIT_S)
        except (OSError, ValueError) as error:  # ValueError: a host name that no host can have
            raise open_failure(sensor, self._where, error) from error
        try:
            self._configure()
        except OSError as error:
            self._socket.close()
            raise open_failure(sensor, self._where, error) from error

    def read(self) -> bytes:
        """See ``Port.read``."""
        try:
            data = self._socket.recv(MAX_READ_BYTES)
        except TimeoutError as error:
            if error.errno == errno.ETIMEDOUT:  # keep-alive, not our own time limit
                raise SensorDisconnected(self._sensor, self._gone()) from error
            return b""
        except OSError as error:
            raise SensorDisconnected(self._sensor, self._gone()) from error
        if not data:
            raise SensorDisconnected(self._sensor, self._gone())
        return data

    def close(self) -> None:
        """See ``Port.close``."""
        self._socket.close()

    def _configure(self) -> None:
        self._socket.settimeout(READ_WAIT_S)
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
        for name, value in _KEEPALIVE:
            if hasattr(socket, name):
                self._socket.setsockopt(socket.IPPROTO_TCP, getattr(socket, name), value)

    def _gone(self) -> str:
        return f"connection to {self._where} lost: switch the sensor on, bring it closer"


class DevicePort:
    """A device, or a URL that pyserial handles.

    Attributes:
        serial: The open pyserial port.
    """

    def __init__(self, sensor: str, url: str) -> None:
        self._sensor = sensor
        self._url = url
        # Only devices can be locked; without the lock on both sides two programs share the bytes.
        options: dict[str, Any] = {} if "://" in url else {"exclusive": True}
        try:
            self.serial = serial.serial_for_url(url, baudrate=BAUD, timeout=READ_WAIT_S, **options)
        except Exception as error:  # each kind of URL is read by code of its own, raising anything
            raise open_failure(sensor, url, error) from error

    def read(self) -> bytes:
        """See ``Port.read``. Never a large fixed count: that would wait for all of it."""
        try:
            waiting = min(MAX_READ_BYTES, max(1, self.serial.in_waiting))
            return bytes(self.serial.read(waiting))
        except Exception as error:  # as above; a closed port raises TypeError
            reason = f"{self._url} is gone: plug the receiver in or switch the sensor on"
            raise SensorDisconnected(self._sensor, reason) from error

    def close(self) -> None:
        """See ``Port.close``."""
        try:
            self.serial.close()
        except Exception:
            # A port that was pulled out may fail in any of these ways; it is gone either way.
            return


def open_failure(sensor: str, where: str, error: Exception) -> SensorError:
    """Say why a port could not be opened: the cause, and what to do."""
    code = _errno(error)
    if isinstance(error, socket.gaierror):
        return SensorNotFound(sensor, f"{where}: no host has this name: check the address")
    if code in _BUSY or (code in _FORBIDDEN and sys.platform == "win32"):
        return SensorBusy(sensor, f"{where} {IN_USE}: close that program")
    if code in _FORBIDDEN:
        group = group_of(where) or "dialout"
        remedy = f"add the user to the {group} group (sudo adduser $USER {group}), log in again"
        return SensorError(sensor, f"no permission to open {where}: {remedy}")
    if code in _NOT_THERE:
        remedy = "plug the receiver in, or choose another port"
        return SensorNotFound(sensor, f"port {where} not found: {remedy}")
    if code in _NO_ANSWER or isinstance(error, TimeoutError):
        remedy = "switch the sensor on, or check the address"
        return SensorNotFound(sensor, f"nobody answers at {where}: {remedy}")
    if isinstance(error, _NO_PORT):
        return SensorError(sensor, f"{where} is no port: give a device or socket://HOST:PORT")
    cause = " ".join(str(error).split()) or type(error).__name__
    return SensorError(sensor, f"{where} cannot be opened ({cause}): choose another port")


def is_same_port(one: str, other: str) -> bool:
    """Whether two texts mean one port, as far as that can be told without opening it.

    Devices are one behind whatever links. Each ``loop://`` is its own.
    """
    if not one or not other or one.lower().startswith("loop://"):
        return False
    return one == other or _plain(one) == _plain(other)


def group_of(device: str) -> str:
    """Name of the group that may use a device file; empty where there is no such thing."""
    try:
        return Path(device).group()
    except (OSError, KeyError, ValueError, NotImplementedError):
        return ""


def _plain(url: str) -> str:
    """A port's text without what makes no difference."""
    if "://" in url:
        return url.lower().rstrip("/").replace("://localhost:", "://127.0.0.1:")
    try:
        return os.path.normcase(os.path.realpath(url) if os.name == "posix" else url)
    except (OSError, ValueError):
        return url


def _address(sensor: str, url: str) -> tuple[str, tuple[str, int]]:
    try:
        parts = urllib.parse.urlsplit(url)
        host, port = parts.hostname, parts.port
    except ValueError:
        host = port = None
    if not host or not port:
        raise SensorNotFound(sensor, f"{url} is no address: give socket://HOST:PORT")
    return f"{host}:{port}", (host, port)


def _errno(error: Exception) -> int | None:
    """The system's number for a failure, also where pyserial left it in the text only."""
    code = getattr(error, "errno", None)
    if isinstance(code, int):
        return code
    # On Windows: SerialException("could not open port 'COM3': PermissionError(13, ...)").
    for name, number in (("FileNotFoundError", errno.ENOENT), ("PermissionError", errno.EACCES)):
        if name in str(error):
            return number
    return None


_NO_PORT = (ValueError, LookupError, TypeError, AttributeError, re.error)
"""What a URL that is no port makes pyserial raise: its parts are looked up and searched for."""

_BUSY = (errno.EBUSY, errno.EAGAIN)
"""EBUSY: another program asked the kernel for exclusive use. EAGAIN: it holds the file lock."""

_FORBIDDEN = (errno.EACCES, errno.EPERM)
"""On Windows this is how a port in use shows; elsewhere it is a matter of groups."""

_NOT_THERE = (errno.ENOENT, errno.ENXIO, errno.ENODEV, errno.EIO, errno.ENOTDIR)

_NO_ANSWER = (
    errno.ECONNREFUSED,
    errno.ETIMEDOUT,
    errno.EHOSTUNREACH,
    errno.ENETUNREACH,
    errno.ECONNRESET,
    getattr(errno, "EHOSTDOWN", errno.EHOSTUNREACH),  # a bound Bluetooth port, sensor off
)
