"""The sensor emulator: one arm's accelerometer served on TCP, in a thread or as a process.

One thread, one selector loop; a sample a tick on the monotonic clock, missed ticks are counted and
never made up. The application opens the stream with ``socket://HOST:PORT``.
"""

import contextlib
import random
import selectors
import socket
import sys
import threading
from dataclasses import dataclass
from types import TracebackType
from typing import Self, TextIO

from gestureapp.clock import Clock, monotonic
from gestureapp.errors import ConfigError
from gestureapp.sensing.values import Side
from gestureapp.simulation.control_port import ControlPort
from gestureapp.simulation.listening import received
from gestureapp.simulation.parent import on_end_signals, on_stdin_end
from gestureapp.simulation.sensor_control import RATE_MAX_HZ, Answer, answer_command
from gestureapp.simulation.sensor_model import RATE_HZ, SensorModel, Wearer
from gestureapp.simulation.sensor_radio import DIRECT, Radio, RadioOptions
from gestureapp.simulation.sensor_stream import StreamPort
from gestureapp.simulation.sensor_wire import COUNTED, ENCODERS, NAME_BYTES_MAX
from gestureapp.worker import Worker

DEMO_SEED = 7
"""The person whose model stands in ``resources/demo``."""

DEMO_SESSION = 2
"""Another day than the one of the takes that this model was trained from."""


@dataclass(frozen=True, slots=True)
class SensorOptions:
    """How a sensor is emulated.

    Attributes:
        side: Which arm wears it.
        port: TCP port of the stream; 0 picks a free one.
        control_port: TCP port of the control lines; 0 picks a free one, None means there is none.
        protocol: ``csv``, ``adxl330``, ``witmotion`` or ``binary``.
        rate_hz: Samples a second, 1 to 2000.
        seed: Who wears it, and the noise.
        session: That person's day; the takes for the demo's model were made on day 1.
        is_practised: Whether that person is a trained operator.
        has_counter: Whether lines carry a running number; only ``csv`` can leave it out.
        host: Address to listen on.
        radio: What is between the sensor and the port.
        identity: What it calls itself, as far as the protocol can say it; empty for a name by side.
        battery_percent: What it says of its battery, likewise; None for unknown.
    """

    side: Side
    port: int = 0
    control_port: int | None = None
    protocol: str = "csv"
    rate_hz: float = RATE_HZ
    seed: int = DEMO_SEED
    session: int = DEMO_SESSION
    is_practised: bool = True
    has_counter: bool = True
    host: str = "127.0.0.1"
    radio: RadioOptions = DIRECT
    identity: str = ""
    battery_percent: int | None = 80


class SensorEmulator:
    """A sensor in a thread of its own; the process runs the same loop in its main thread.

    Owner: whoever creates it; ``start``, ``stop`` from its thread. The loop owns all else.

    Attributes:
        options: As given.
        port: TCP port of the stream.
        control_port: TCP port of the control lines; 0 when there is none.
    """

    def __init__(
        self, options: SensorOptions, wearer: Wearer | None = None, clock: Clock = monotonic
    ) -> None:
        """Take the ports; nothing is sent before ``start`` or ``run``.

        Args:
            options: How the sensor is emulated.
            wearer: The arm; None means the person of the options' seed.
            clock: Monotonic seconds.

        Raises:
            ConfigError: the protocol is unknown or the rate out of range.
            SensorError: a port cannot be served.
        """
        _check(options)
        self.options = options
        self._clock = clock
        self._model = SensorModel(
            options.side,
            _wearer(options) if wearer is None else wearer,
            options.protocol,
            options.rate_hz,
            options.has_counter,
            random.Random(options.seed),
            options.radio.clock_ppm,
            options.identity or f"emulated {options.side.value}",
            options.battery_percent,
        )
        self._radio = Radio(options.radio, random.Random(options.seed))
        side = options.side.value
        with contextlib.ExitStack() as opened:
            self._selector = opened.enter_context(selectors.DefaultSelector())
            self._waker, wakened = socket.socketpair()
            for end in (self._waker, wakened):
                opened.callback(end.close)
                end.setblocking(False)
            self._selector.register(wakened, selectors.EVENT_READ, lambda: received(wakened))
            self._stream = StreamPort(side, options.host, options.port, self._selector, clock)
            opened.callback(self._stream.close)
            self.port = self._stream.port
            self.control_port = 0
            if options.control_port is not None:
                control = ControlPort(
                    side, options.host, options.control_port, self._selector, self._answer
                )
                opened.callback(control.close)
                self.control_port = control.port
            self._opened = opened.pop_all()
        self._worker = Worker(f"{options.side.value} sensor emulator", self.run)

    def start(self) -> None:
        """Start the thread. Once only."""
        self._worker.start()

    def stop(self) -> None:
        """End the loop and close the ports. Idempotent; any thread but the loop's own."""
        self._worker.stopping.set()
        self.wake()
        if self._worker.stop():
            self._opened.close()

    def __enter__(self) -> Self:
        """Start."""
        self.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Stop."""
        self.stop()

    def wake(self) -> None:
        """Make the loop look whether it is to end. Any thread, and signal handlers."""
        with contextlib.suppress(OSError):
            self._waker.send(b"!")

    def run(self, stopping: threading.Event) -> None:
        """Serve until told to stop, then close everything."""
        due_s = self._clock()
        try:
            while not stopping.is_set():
                for key, _ in self._selector.select(max(0.0, due_s - self._clock())):
                    key.data()
                due_s = self._tick_if_due(due_s)
        finally:
            self._opened.close()

    def _tick_if_due(self, due_s: float) -> float:
        """Take a sample if it is time; returns when the next one is due."""
        now_s = self._clock()
        if now_s < due_s:
            return due_s
        sent = self._model.tick(now_s)
        period_s = self._model.period_s
        self._stream.send(self._radio.carry(now_s, sent, period_s))
        self._plug()
        missed = int((now_s - due_s) / period_s)
        self._stream.n_overruns += missed
        return now_s + period_s if missed else due_s + period_s

    def _answer(self, line: bytes) -> Answer:
        answer = answer_command(self._model, line, self._clock(), self._stream.record)
        self._plug()
        return answer

    def _plug(self) -> None:
        if self._model.is_unplugged:
            self._radio.clear()
        self._stream.plug(not self._model.is_unplugged)


def serve_sensor(
    options: SensorOptions, exit_with_stdin: bool = False, out: TextIO | None = None
) -> int:
    """Run one sensor as this process's main job, until SIGTERM or SIGINT.

    Prints ``control on HOST:PORT`` if there is a control port, then ``listening on HOST:PORT``:
    with that line everything is ready.

    Args:
        options: How the sensor is emulated.
        exit_with_stdin: End also when standard input ends, so that no child outlives its parent.
        out: Where the lines go; standard output if None.

    Returns:
        The exit code, 0.

    Raises:
        ConfigError: the protocol is unknown or a value is out of range.
        SensorError: a port cannot be served.
    """
    emulator = SensorEmulator(options)
    stopping = threading.Event()

    def end() -> None:
        stopping.set()
        emulator.wake()

    on_end_signals(end)
    if exit_with_stdin:
        on_stdin_end(end)
    out = sys.stdout if out is None else out
    if options.control_port is not None:
        out.write(f"control on {options.host}:{emulator.control_port}\n")
    out.write(f"listening on {options.host}:{emulator.port}\n")
    out.flush()
    emulator.run(stopping)
    return 0


def _wearer(options: SensorOptions) -> Wearer:
    # Late, as it brings numpy: what only needs the options and the loop starts without it.
    from gestureapp.simulation.wearer import person_of, wearer_of

    person = person_of(options.seed, options.session, options.is_practised)
    return wearer_of(options.side, person, options.seed)


def _check(options: SensorOptions) -> None:
    if options.protocol not in ENCODERS:
        known = ", ".join(sorted(ENCODERS))
        raise ConfigError("protocol", options.protocol, f"unknown; one of {known}")
    if not 1.0 <= options.rate_hz <= RATE_MAX_HZ:
        raise ConfigError("rate", options.rate_hz, f"must be 1 to {RATE_MAX_HZ:g} Hz")
    for name, number in (("seed", options.seed), ("session", options.session)):
        if not 0 <= number < 1 << 32:
            raise ConfigError(name, number, "must be a whole number from 0 to 4294967295")
    if options.protocol in COUNTED and not options.has_counter:
        text = f"{options.protocol} always carries a running number; csv need not"
        raise ConfigError("counter", False, text)
    if not (len(options.identity.encode()) <= NAME_BYTES_MAX and options.identity.isprintable()):
        raise ConfigError("identity", options.identity, f"at most {NAME_BYTES_MAX} bytes of UTF-8")
    battery = options.battery_percent
    if battery is not None and not 0 <= battery <= 100:
        raise ConfigError("battery", battery, "must be 0 to 100 %")
    for name, port in (("port", options.port), ("control-port", options.control_port or 0)):
        if not 0 <= port <= 65_535:
            raise ConfigError(name, port, "must be 0 to 65535")
