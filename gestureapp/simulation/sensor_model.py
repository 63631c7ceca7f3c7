"""An emulated sensor as a pure model: arm, running number and fault make the bytes of a tick."""

import random
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from enum import Enum
from typing import Protocol

from gestureapp.sensing.values import Side
from gestureapp.simulation.sensor_wire import (
    COUNTER_SPAN,
    ENCODERS,
    Accel,
    cut,
    encode_binary,
    encode_identity,
    garbage_like,
)

RATE_HZ = 100.0
"""Samples a second. Source: the paper's sensors."""

SPIKE_G = 40.0
"""Far beyond what a 3 g sensor can give."""

SLOW_HZ = 20.0
"""Too slow for any cell to arm."""

JUMP = -500
"""Five seconds back."""

BURST_MAX = 1000
"""Lines kept back at most during a stall that ends in a burst; the radio loses older ones."""

IDENTITY_EVERY_S = 1.0
"""How often a sensor of the ``binary`` protocol says what it is."""


class Verb(Enum):
    """What an arm can be asked to do."""

    PERFORM = "perform"
    REST = "rest"
    TAKE = "take"
    LIE = "lie"
    """The sensor is taken off and laid on a table; it is worn again with the next action."""


@dataclass(frozen=True, slots=True)
class ArmAction:
    """One thing an arm does.

    Attributes:
        verb: What.
        what: A gesture's label, a posture's name or how the sensor lies; empty for rest.
        hold_s: How long the end of a gesture is held; None is as usual.
        back_s: Duration of the way back from it; None is as usual.
        askew_deg: How far a sensor that is laid down tilts.
    """

    verb: Verb
    what: str = ""
    hold_s: float | None = None
    back_s: float | None = None
    askew_deg: float = 0.0


class Wearer(Protocol):
    """The arm that wears the sensor, sensor errors included."""

    def accel_g(self, t_s: float) -> Accel:
        """What the sensor reads at this time; called with increasing times."""

    def begin(self, action: ArmAction, t_s: float) -> None:
        """Begin an action at this present or future time."""


class FaultKind(Enum):
    """What can be wrong with a sensor or the radio between."""

    NONE = "none"
    SILENT = "silent"
    """The port stays open and no byte comes."""
    FROZEN = "frozen"
    """One value for ever; the running number goes on, or not."""
    GARBAGE = "garbage"
    """Random bytes."""
    TRUNCATED = "truncated"
    """Every line loses its end."""
    SPIKE = "spike"
    """An impossible value on every axis; a protocol of counts can say no more than its rail."""
    SLOW = "slow"
    """Too few samples a second."""
    UNPLUGGED = "unplugged"
    """The connection is closed and new ones are refused."""
    STALL = "stall"
    """Nothing for a while; then what was kept back comes in one burst, or is lost."""
    JUMP = "jump"
    """The running number jumps once, as the sensor's clock would, and goes on from there."""


@dataclass(frozen=True, slots=True)
class Fault:
    """A fault and its options.

    Attributes:
        kind: Which.
        seconds: It ends by itself after this time; None means it lasts until another is set.
        counts_on: Frozen: whether the running number goes on.
        spike_g: Spike: the value.
        rate_hz: Slow: the rate.
        jump: Jump: by how much; less than 0 is back in time.
        is_burst: Stall: whether what was kept back comes in one burst.
    """

    kind: FaultKind = FaultKind.NONE
    seconds: float | None = None
    counts_on: bool = True
    spike_g: float = SPIKE_G
    rate_hz: float = SLOW_HZ
    jump: int = JUMP
    is_burst: bool = False


NO_FAULT = Fault()


@dataclass(frozen=True, slots=True)
class Emission:
    """One line for the wire.

    Attributes:
        data: Its bytes.
        counter: Its running number, also where the line does not carry it.
        accel_g: What it says (or would say, were it not garbled).
    """

    data: bytes
    counter: int
    accel_g: Accel


@dataclass(slots=True)
class SensorModel:
    """One sensor on one arm. Pure: the time comes in. Owned by the emulator's loop.

    Attributes:
        side: Whose sensor.
        wearer: The arm.
        protocol: One of ``ENCODERS``.
        rate_hz: Samples a second without fault, by the sensor's own clock.
        has_counter: Whether lines carry the running number; ``csv`` only.
        rng: Chance for garbage and cuts.
        clock_ppm: How much too slow the sensor's clock is, in millionths; less than 0 is fast.
        identity: What it calls itself; ``binary`` only.
        battery_percent: What it says of its battery, None for unknown; ``binary`` only.
        fault: The present one.
        doing: The action begun last, or None.
    """

    side: Side
    wearer: Wearer
    protocol: str = "csv"
    rate_hz: float = RATE_HZ
    has_counter: bool = True
    rng: random.Random = field(default_factory=lambda: random.Random(1))
    clock_ppm: float = 0.0
    identity: str = ""
    battery_percent: int | None = None
    fault: Fault = NO_FAULT
    doing: ArmAction | None = None
    _fault_end_s: float | None = None
    _counter: int = -1
    _last: Accel | None = None
    _last_s: float = float("-inf")
    _scheduled: tuple[float, ArmAction] | None = None
    _kept: list[Emission] = field(default_factory=list)

    @property
    def period_s(self) -> float:
        """Time between two samples, under the present fault."""
        slow = self.fault.kind is FaultKind.SLOW
        return (1.0 + self.clock_ppm * 1e-6) / (self.fault.rate_hz if slow else self.rate_hz)

    @property
    def is_unplugged(self) -> bool:
        """Whether the port is to refuse connections."""
        return self.fault.kind is FaultKind.UNPLUGGED

    @property
    def scheduled_s(self) -> float | None:
        """When the next action begins; None if nothing waits."""
        return self._scheduled[0] if self._scheduled else None

    def schedule(self, action: ArmAction, at_s: float, now_s: float) -> float:
        """Begin an action now or later; one that still waits is forgotten, the newest wish counts.

        Returns:
            When it begins: ``at_s``, or now if that has passed.
        """
        at_s = max(at_s, now_s, self._last_s)
        self._scheduled = (at_s, action)
        self._begin_due(now_s)
        return at_s

    def set_fault(self, fault: Fault, now_s: float) -> None:
        """Replace the present fault. Lines kept back by a stall are lost."""
        self._kept.clear()
        self.fault = fault
        if fault.kind is FaultKind.JUMP:
            self._counter = (self._counter + fault.jump) % COUNTER_SPAN
        self._fault_end_s = None if fault.seconds is None else now_s + fault.seconds

    def tick(self, now_s: float) -> Sequence[Emission]:
        """Take one sample.

        Returns:
            The lines to send now: one as a rule, none under some faults, many after a stall.
        """
        self._begin_due(now_s)
        late = self._end_fault_if_over(now_s)
        self._last_s = max(now_s, self._last_s)
        accel_g = self.wearer.accel_g(self._last_s)
        line = self._line(accel_g)
        if line is None:
            return late
        if self.fault.kind is FaultKind.STALL:
            if self.fault.is_burst:
                self._kept = [*self._kept[-BURST_MAX + 1 :], line]
            return ()
        return [*late, line]

    def _begin_due(self, now_s: float) -> None:
        """Hand the scheduled action to the arm one tick ahead: it may start between two ticks."""
        if self._scheduled is None or self._scheduled[0] > now_s + self.period_s:
            return
        at_s, action = self._scheduled
        self._scheduled = None
        self.wearer.begin(action, max(at_s, self._last_s))
        self.doing = action

    def _end_fault_if_over(self, now_s: float) -> list[Emission]:
        if self._fault_end_s is None or now_s < self._fault_end_s:
            return []
        kept = self._kept
        self._kept = []
        self.set_fault(NO_FAULT, now_s)
        return kept

    def _line(self, accel_g: Accel) -> Emission | None:
        kind = self.fault.kind
        if kind is FaultKind.FROZEN and self._last is not None:
            accel_g = self._last
        else:
            self._last = accel_g
        if kind is not FaultKind.FROZEN or self.fault.counts_on:
            self._counter = (self._counter + 1) % COUNTER_SPAN
        if kind in (FaultKind.SILENT, FaultKind.UNPLUGGED):
            return None
        if kind is FaultKind.SPIKE:
            accel_g = (self.fault.spike_g,) * 3
        return self._encoded(accel_g)

    def _encoded(self, accel_g: Accel) -> Emission:
        kind = self.fault.kind
        number = max(self._counter, 0)
        data = self._identified(number) + self._data(number, accel_g)
        line = Emission(data, number, accel_g)
        if kind is FaultKind.GARBAGE:
            return replace(line, data=garbage_like(data, self.rng))
        if kind is FaultKind.TRUNCATED:
            return replace(line, data=cut(self.protocol, data, self.rng))
        return line

    def _data(self, number: int, accel_g: Accel) -> bytes:
        if self.protocol == "binary" and self.battery_percent is not None:
            return encode_binary(number, accel_g, self.battery_percent)
        return ENCODERS[self.protocol](number if self.has_counter else None, accel_g)

    def _identified(self, number: int) -> bytes:
        """The frame that goes before a sample once a second, of a protocol that has one."""
        is_due = number % max(1, round(IDENTITY_EVERY_S * self.rate_hz)) == 0
        has_one = self.protocol == "binary" and self.identity
        return encode_identity(self.identity) if has_one and is_due else b""
