"""One thread per sensor: port -> decoder -> calibration -> samples with their receive time."""

import logging
import threading
from collections.abc import Callable
from dataclasses import dataclass

from gestureapp.clock import Clock, monotonic
from gestureapp.config import SensorSettings
from gestureapp.errors import SensorDisconnected, SensorError, WorkerError
from gestureapp.sensing.calibration import NOMINAL, Calibration, accel_of
from gestureapp.sensing.ports import Port, open_port
from gestureapp.sensing.protocols import Protocol, protocol
from gestureapp.sensing.values import (
    Battery,
    Connected,
    CounterGap,
    CounterJump,
    DecoderEvent,
    Disconnected,
    Frame,
    Garbage,
    Identity,
    Impossible,
    Sample,
    SensorEvent,
    Side,
)
from gestureapp.worker import Worker

log = logging.getLogger(__name__)

RETRY_MIN_S = 0.2
RETRY_MAX_S = 2.0
"""Waits between attempts to open double from the least to the most, and start over with data."""

LOG_EVERY_S = 1.0
"""Bad lines are written to the log at most this often; each of them is reported all the same."""


class SensorReader:
    """Reads one sensor, reopens its port by itself, and hands on what comes.

    The thread owns the port, the decoder and the running number of the samples. Both callbacks are
    called in it, in the order in which things came; they must be quick, and must not raise: that
    ends the reader with a ``WorkerError``, and a silent sensor stops the robot.

    All samples of one read get the same receive time, taken as the read returns: a radio's burst
    is one arrival, and spreading it out would invent times. The sensor's running number of each
    sample tells their order and distance.

    Args:
        side: Whose sensor.
        settings: Port and protocol.
        on_sample: Gets every calibrated sample.
        on_event: Gets garbage, gaps, connections and losses. A loss or a failure to open is told
            again only when its reason changes or a connection came between.
        clock: Monotonic seconds.
        on_error: Gets what ended the thread, if anything did.
        opener: Opens the port; another one lets a test hold both ends.

    Raises:
        ConfigError: there is no protocol of that name.
    """

    def __init__(
        self,
        side: Side,
        settings: SensorSettings,
        on_sample: Callable[[Sample], None],
        on_event: Callable[[SensorEvent], None],
        clock: Clock = monotonic,
        on_error: Callable[[WorkerError], None] | None = None,
        opener: Callable[[str, str], Port] = open_port,
    ) -> None:
        self._side = side
        self._source = _Source(settings.port, protocol(settings.protocol))
        self._calibration = NOMINAL
        self._on_sample = on_sample
        self._on_event = on_event
        self._clock = clock
        self._opener = opener
        self._seq = 0
        self._told: str | None = None
        self._woken = threading.Event()
        self._is_ending = False
        self._bad_lines = _BadLineLog(side)
        self._worker = Worker(f"{side.value} reader", self._run, on_error)

    def start(self) -> None:
        """Start the thread. Once only."""
        self._worker.start()

    def stop(self) -> bool:
        """End the thread and close the port; idempotent. Returns whether it has ended.

        Takes at most one read's time, or one attempt to connect.
        """
        self._is_ending = True
        self._woken.set()
        return self._worker.stop()

    def use(self, settings: SensorSettings) -> None:
        """Read from this port, with this protocol, from now on; any thread, does not wait.

        A port that is open is closed first, at the latest after one read's time.

        Raises:
            ConfigError: there is no protocol of that name; then all stays as it was.
        """
        self._source = _Source(settings.port, protocol(settings.protocol))
        self._woken.set()

    def set_calibration(self, calibration: Calibration) -> None:
        """Take this sensor's own errors out of every sample from now on; any thread."""
        self._calibration = calibration

    @property
    def is_alive(self) -> bool:
        """Whether the thread runs."""
        return self._worker.is_alive

    def _run(self, stopping: threading.Event) -> None:
        retry_s = RETRY_MIN_S
        while not stopping.is_set():
            has_read, source = False, self._source
            try:
                has_read = self._connection(stopping, source)
            except SensorError as error:
                self._tell_lost(error.reason)
            if self._is_ending:
                return
            retry_s = RETRY_MIN_S if has_read or source is not self._source else retry_s
            if source is self._source:
                self._woken.wait(retry_s)
            self._woken.clear()
            retry_s = min(2 * retry_s, RETRY_MAX_S)

    def _connection(self, stopping: threading.Event, source: "_Source") -> bool:
        """Live through one connection; whether any data came.

        Raises:
            SensorError: the port could not be opened.
        """
        port = self._opener(self._side.value, source.port)
        try:
            log.info("%s sensor: connected to %s", self._side.value, source.port)
            self._told = None
            self._on_event(Connected(source.port))
            return self._read_until_lost(port, stopping, source)
        finally:
            port.close()

    def _read_until_lost(self, port: Port, stopping: threading.Event, source: "_Source") -> bool:
        decoder = source.protocol.new_decoder()
        has_read = False
        while not stopping.is_set():
            if source is not self._source:
                self._tell_lost("another port or protocol was chosen: wait a moment")
                break
            try:
                data = port.read()
            except SensorDisconnected as error:
                self._hand_on(decoder.end(), self._clock(), source)
                self._tell_lost(error.reason)
                break
            if data:
                t_s = self._clock()
                has_read = True
                self._hand_on(decoder.feed(data), t_s, source)
        return has_read

    def _hand_on(self, events: list[DecoderEvent], t_s: float, source: "_Source") -> None:
        for event in events:
            if isinstance(event, Frame):
                self._hand_on_frame(event, t_s, source)
            elif isinstance(event, CounterGap | CounterJump | Identity | Battery):
                self._on_event(event)
            else:
                self._hand_on_garbage(event, t_s)

    def _hand_on_frame(self, frame: Frame, t_s: float, source: "_Source") -> None:
        accel_g = accel_of(frame, source.protocol, self._calibration)
        if isinstance(accel_g, Impossible):
            self._hand_on_garbage(accel_g, t_s)
            return
        seq, self._seq = self._seq, self._seq + 1
        self._on_sample(Sample(t_s, seq, accel_g, frame.counter))

    def _hand_on_garbage(self, garbage: Garbage, t_s: float) -> None:
        self._bad_lines.note(garbage, t_s)
        self._on_event(garbage)

    def _tell_lost(self, reason: str) -> None:
        if reason == self._told:
            return
        self._told = reason
        log.warning("%s sensor: %s", self._side.value, reason)
        self._on_event(Disconnected(reason))


@dataclass(frozen=True, slots=True, eq=False)
class _Source:
    """Where a sensor is read from; another one is another, even if it says the same."""

    port: str
    protocol: Protocol


class _BadLineLog:
    """Writes bad lines to the log, at most one per ``LOG_EVERY_S``, with the number left out."""

    def __init__(self, side: Side) -> None:
        self._side = side
        self._written_s: float | None = None
        self._n_left_out = 0

    def note(self, garbage: Garbage, t_s: float) -> None:
        """One more bad line, received at ``t_s``."""
        if self._written_s is not None and t_s - self._written_s < LOG_EVERY_S:
            self._n_left_out += 1
            return
        log.warning(
            "%s sensor: dropped %r (%d bytes): %s; %d more since the last line",
            self._side.value,
            garbage.first_bytes,
            garbage.n_bytes,
            garbage.reason,
            self._n_left_out,
        )
        self._written_s = t_s
        self._n_left_out = 0
