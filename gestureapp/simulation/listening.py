"""Listening sockets that never block, for the emulator's selector loop. Loop's thread only."""

import contextlib
import errno
import os
import socket

from gestureapp.errors import SensorBusy, SensorError

READ_MAX_BYTES = 65_536


def bind(sensor: str, host: str, port: int) -> socket.socket:
    """Take a port without listening on it yet: connections are refused.

    Args:
        sensor: ``left`` or ``right``, for the error's text.
        host: Address of this machine.
        port: TCP port; 0 picks a free one.

    Raises:
        SensorBusy: another program has the port.
        SensorError: the address cannot be served.
    """
    listener = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    try:
        if os.name == "posix":  # elsewhere it would let two programs share a port
            listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.bind((host, port))
        listener.setblocking(False)
    except (OSError, OverflowError) as error:
        listener.close()
        if isinstance(error, OSError) and error.errno == errno.EADDRINUSE:
            raise _busy(sensor, host, port) from error
        raise SensorError(sensor, f"cannot serve {host}:{port}: {error}") from error
    return listener


def listen(sensor: str, host: str, port: int) -> socket.socket:
    """Open a listening socket; arguments and errors as ``bind``."""
    listener = bind(sensor, host, port)
    try:
        listener.listen(8)
    except OSError as error:  # two may bind with SO_REUSEADDR, one may listen
        listener.close()
        raise _busy(sensor, host, port) from error
    return listener


def accepted(listener: socket.socket) -> socket.socket | None:
    """The next client, non-blocking and without Nagle's delay; None when it is gone again."""
    try:
        connection, _ = listener.accept()
    except OSError:
        return None
    connection.setblocking(False)
    with contextlib.suppress(OSError):
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    return connection


def received(client: socket.socket) -> bytes | None:
    """What came; empty when the other end is gone, None when nothing is there."""
    try:
        return client.recv(READ_MAX_BYTES)
    except BlockingIOError:
        return None
    except OSError:
        return b""


def written(client: socket.socket, data: bytes) -> int | None:
    """Write what fits. Returns how many bytes were taken, None when the other end is gone."""
    try:
        return client.send(data)
    except BlockingIOError:
        return 0
    except OSError:
        return None


def _busy(sensor: str, host: str, port: int) -> SensorBusy:
    return SensorBusy(sensor, f"port {port} of {host} is in use; name another, or 0 for a free one")
