"""Looks for sensors: opens one port after the other, listens, and lists what sends."""

import threading
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Final

from gestureapp.clock import Clock
from gestureapp.errors import SensorError
from gestureapp.sensing.ports import Port, open_port
from gestureapp.sensing.protocols import Protocol
from gestureapp.setup.hearing_ports import Heard, PortEar
from gestureapp.setup.values import FindingView, FoundSensor, PortChoice, SensorCard
from gestureapp.worker import Worker

LISTEN_S: Final = 1.5
"""On each port: a sensor at 20 Hz has sent enough by then, and a Bluetooth one has woken up."""
_PLUG_IN: Final = "plug a receiver in, or pair a sensor with this machine."
_JOIN_S: Final = 0.5
"""A read that is under way ends within a fifth of this; only opening a port may take longer."""


class Finder:
    """Tries ports in a thread of its own, as opening one may take seconds.

    Started and stopped by one thread; the view may be read by any.

    Args:
        clock: Monotonic seconds.
        protocols: All there are.
        opener: Opens a port.

    Attributes:
        view: For the window.
    """

    def __init__(
        self,
        clock: Clock,
        protocols: Callable[[], Sequence[Protocol]],
        opener: Callable[[str, str], Port] = open_port,
    ) -> None:
        self._clock, self._protocols, self._opener = clock, protocols, opener
        self._worker: Worker | None = None
        self._in_use: tuple[FoundSensor, ...] = ()
        self.view = FindingView()

    def start(self, ports: Sequence[PortChoice], in_use: Sequence[FoundSensor] = ()) -> None:
        """Try these ports; what is under way is ended first.

        Args:
            ports: Those that nobody here reads.
            in_use: What sends on the others, listed beside what is found.
        """
        self.stop()
        self._in_use = tuple(in_use)
        if not ports:
            sentence = f"No {'other ' if in_use else ''}port is free: {_PLUG_IN}"
            self.view = FindingView(sentence=self._with_used(sentence), found=self._in_use)
            return
        self.view = FindingView(is_on=True, sentence="Looking for sensors.", found=self._in_use)
        self._worker = Worker("finding sensors", lambda stopping: self._run(stopping, ports))
        self._worker.start()

    def stop(self) -> None:
        """End it; what was found stays in the view. The port is closed when this returns.

        But for one that is just being opened: it is closed as soon as the system lets go of it.
        """
        worker, self._worker = self._worker, None
        if worker is None:
            return
        worker.stop(_JOIN_S)
        if self.view.is_on:
            self.view = replace(self.view, is_on=False, sentence=self._sum_up(self.view, "Ended"))

    def _run(self, stopping: threading.Event, ports: Sequence[PortChoice]) -> None:
        found = [*self._in_use]
        troubles: list[str] = []
        for number, port in enumerate(ports, 1):
            if stopping.is_set():
                return
            sentence = f"Listening to {port.name}, {number} of {len(ports)}."
            self.view = FindingView(is_on=True, sentence=sentence, found=tuple(found))
            try:
                heard = self._listen(stopping, port.url)
            except SensorError as error:
                troubles.append(error.reason)
                continue
            if heard.n_bytes:
                found.append(_found(port, heard))
        if stopping.is_set():
            return
        view = FindingView(found=tuple(found))
        self.view = replace(view, sentence=self._sum_up(view, "All ports tried", troubles))

    def _sum_up(self, view: FindingView, how: str, troubles: Sequence[str] = ()) -> str:
        other = "other " if self._in_use else ""
        n = sum(bool(found.protocol) for found in view.found[len(self._in_use) :])
        words = {0: f"no {other}sensor sends", 1: f"1 {other}sensor sends"}
        said = words.get(n, f"{n} {other}sensors send")
        tail = f" Not opened: {'; '.join(troubles)}." if troubles else ""
        remedy = " Switch them on and bring them closer." if n + len(self._in_use) < 2 else ""
        return self._with_used(f"{how}: {said}.{remedy}{tail}")

    def _with_used(self, sentence: str) -> str:
        n = len(self._in_use)
        used = "1 sensor is" if n == 1 else f"{n} sensors are"
        return f"{used} in use already. {sentence}" if n else sentence

    def _listen(self, stopping: threading.Event, url: str) -> Heard:
        """Raises SensorError: it cannot be opened, or went away."""
        ear = PortEar(self._protocols())
        port = self._opener("any", url)
        try:
            until_s = self._clock() + LISTEN_S
            while not stopping.is_set() and not ear.is_sure and self._clock() < until_s:
                ear.feed(self._clock(), port.read())
            return ear.heard()
        finally:
            port.close()


def _found(port: PortChoice, heard: Heard) -> FoundSensor:
    if not heard.protocol:
        text = f"{port.name}: sends {heard.first_bytes!r}, which no protocol can read"
        return FoundSensor(port, "", 0.0, text)
    called = f"{heard.identity}, " if heard.identity else ""
    text = f"{port.name}: {called}{heard.protocol}, {heard.rate_hz:.0f} Hz"
    return FoundSensor(port, heard.protocol, heard.rate_hz, text)


def found_in_use(card: SensorCard, port: PortChoice) -> FoundSensor:
    """A sensor that the cell reads already, as one that was found."""
    rate_hz = card.health.rate_hz
    called = "" if card.name in (port.name, "") else f"{card.name}, "
    text = f"{port.name}: {called}{card.protocol}, {rate_hz:.0f} Hz; in use"
    return FoundSensor(port, card.protocol, rate_hz, text)
