"""The stream port of the sensor emulator: lines to one client, never queued. Loop's thread only."""

import contextlib
import selectors
import socket
from collections import deque
from collections.abc import Sequence

from gestureapp.clock import Clock
from gestureapp.simulation.listening import accepted, bind, listen, received, written
from gestureapp.simulation.sensor_control import SentLine, StreamRecord
from gestureapp.simulation.sensor_model import Emission

LOG_LINES = 20_000
"""Lines written that are remembered: over three minutes at 100 Hz."""

SEND_BUFFER_BYTES = 16_384
"""Asked of the operating system: a client that does not read gets no long queue of old samples."""


class StreamPort:
    """Serves the lines to one client at a time, as a Bluetooth serial port does.

    While somebody is connected, others are closed at once. Owned by the emulator's loop.

    Attributes:
        port: TCP port.
        n_overruns: Set by the loop: ticks missed and never made up.
    """

    def __init__(
        self, sensor: str, host: str, port: int, selector: selectors.BaseSelector, clock: Clock
    ) -> None:
        self._sensor = sensor
        self._host = host
        self._selector = selector
        self._clock = clock
        self._listener = listen(sensor, host, port)
        self.port: int = self._listener.getsockname()[1]
        self._is_plugged = True
        self._client: socket.socket | None = None
        self._rest = b""
        self._log: deque[SentLine] = deque(maxlen=LOG_LINES)
        self._n_sent = 0
        self._n_dropped = 0
        self.n_overruns = 0
        selector.register(self._listener, selectors.EVENT_READ, self._accept)

    @property
    def record(self) -> StreamRecord:
        """How the stream went so far."""
        has_client = self._client is not None
        lines = tuple(self._log)
        return StreamRecord(lines, has_client, self._n_sent, self._n_dropped, self.n_overruns)

    def plug(self, is_plugged: bool) -> None:
        """Unplug (close the client, refuse others) or plug in again. Does nothing if it is so."""
        if is_plugged == self._is_plugged:
            return
        if is_plugged:
            self._listener.listen(8)
            self._selector.register(self._listener, selectors.EVENT_READ, self._accept)
        else:
            self._drop_client()
            self._selector.unregister(self._listener)
            self._listener.close()
            # Bound but not listening: connections are refused, and nobody else gets the port.
            self._listener = bind(self._sensor, self._host, self.port)
        self._is_plugged = is_plugged

    def send(self, lines: Sequence[Emission]) -> None:
        """Write lines as one burst, or drop those for which the client leaves no room.

        Only the end of a line that the operating system took in part is kept, so that a reader that
        wakes up finds whole lines.
        """
        if self._client is None:
            return
        self._rest = self._rest[self._write(self._rest) :]
        sent_s = self._clock()
        n = 0 if self._rest else self._write(b"".join(line.data for line in lines))
        for line in lines:
            if n <= 0:
                self._n_dropped += 1
                continue
            self._rest = line.data[n:]
            n -= len(line.data)
            self._n_sent += 1
            if not self._rest:
                self._log.append(SentLine(sent_s, line.counter, line.accel_g))

    def close(self) -> None:
        """Close everything. Idempotent."""
        self._drop_client()
        with contextlib.suppress(KeyError, ValueError):
            self._selector.unregister(self._listener)
        self._listener.close()

    def _write(self, data: bytes) -> int:
        if not data or self._client is None:
            return 0
        n = written(self._client, data)
        if n is None:
            self._drop_client()
            return 0
        return n

    def _accept(self) -> None:
        connection = accepted(self._listener)
        if connection is None:
            return
        self._read()  # a client that has just gone makes room
        if self._client is not None:
            connection.close()
            return
        with contextlib.suppress(OSError):
            connection.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, SEND_BUFFER_BYTES)
        self._client = connection
        self._selector.register(connection, selectors.EVENT_READ, self._read)

    def _read(self) -> None:
        """Whatever a client says to a sensor is ignored; that it goes away is noticed."""
        if self._client is not None and received(self._client) == b"":
            self._drop_client()

    def _drop_client(self) -> None:
        if self._client is not None:
            self._selector.unregister(self._client)
            self._client.close()
            self._client = None
            self._rest = b""
