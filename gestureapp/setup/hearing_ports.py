"""What a port sends: every protocol listens to the same bytes, and the best one is named. Pure."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Final

from gestureapp.sensing.calibration import Vector
from gestureapp.sensing.decoder import Decoder
from gestureapp.sensing.lines import readable_bytes
from gestureapp.sensing.protocols import Protocol
from gestureapp.sensing.values import DecoderEvent, Frame, Garbage, Identity

ENOUGH_FRAMES: Final = 40
"""So many good frames say which protocol it is; at 100 Hz they take less than half a second."""
IDENTITY_WITHIN_S: Final = 1.1
"""A sensor that says who it is does so once a second."""
_LEAST_FRAMES: Final = 5
_PLAUSIBLE_G: Final = (0.3, 3.0)
"""A sensor that lies or is held reads about 1 g; the wrong scale reads far from it."""
_SHOWN_BYTES: Final = 16


@dataclass(frozen=True, slots=True)
class Heard:
    """What came over a port.

    Attributes:
        protocol: Its protocol, or empty when bytes came that nobody can read, or none at all.
        rate_hz: Frames a second, roughly.
        n_bytes: How many bytes came.
        identity: What the sensor calls itself; empty when it does not.
        first_bytes: The first ones, as a person can read them.
    """

    protocol: str
    rate_hz: float
    n_bytes: int
    identity: str = ""
    first_bytes: str = ""


@dataclass(slots=True)
class _Ear:
    """One protocol listening."""

    protocol: Protocol
    decoder: Decoder
    n_good: int = 0
    n_bad: int = 0
    n_plausible: int = 0
    identity: str = ""
    times_s: list[float] = field(default_factory=list)

    def take(self, t_s: float, events: list[DecoderEvent]) -> None:
        for event in events:
            match event:
                case Frame():
                    self._frame(t_s, self.protocol.to_nominal_g(event.raw))
                case Garbage():
                    self.n_bad += 1
                case Identity():
                    self.identity = event.name

    @property
    def score(self) -> float:
        """Good frames less bad ones; those that a sensor at rest would send count twice."""
        return self.n_good + self.n_plausible - 2.0 * self.n_bad

    def _frame(self, t_s: float, nominal_g: Vector) -> None:
        if not all(abs(value) <= self.protocol.limit_g for value in nominal_g):
            self.n_bad += 1
            return
        self.n_good += 1
        self.times_s.append(t_s)
        low, high = _PLAUSIBLE_G
        self.n_plausible += low <= math.hypot(*nominal_g) <= high


class PortEar:
    """Listens to one port with every protocol. Owned by one thread.

    Args:
        protocols: Which to try.
    """

    def __init__(self, protocols: Sequence[Protocol]) -> None:
        self._ears = [_Ear(known, known.new_decoder()) for known in protocols]
        self._first = b""
        self._n_bytes = 0

    def feed(self, t_s: float, data: bytes) -> None:
        """Take bytes as they came, received at ``t_s``."""
        self._n_bytes += len(data)
        self._first += data[: _SHOWN_BYTES - len(self._first)]
        for ear in self._ears:
            ear.take(t_s, ear.decoder.feed(data))

    @property
    def is_sure(self) -> bool:
        """Enough has come to say what it is, and who."""
        best = self._best()
        if best is None or best.n_good < ENOUGH_FRAMES:
            return False
        return bool(best.identity) or best.times_s[-1] - best.times_s[0] >= IDENTITY_WITHIN_S

    def heard(self) -> Heard:
        """What it is, as far as can be told now."""
        shown = readable_bytes(self._first)
        best = self._best()
        if best is None:
            return Heard("", 0.0, self._n_bytes, "", shown)
        span_s = best.times_s[-1] - best.times_s[0]
        rate_hz = (best.n_good - 1) / span_s if span_s > 0 else 0.0
        return Heard(best.protocol.name, rate_hz, self._n_bytes, best.identity, shown)

    def _best(self) -> _Ear | None:
        best = max(self._ears, key=lambda ear: ear.score, default=None)
        if best is None or best.n_good < _LEAST_FRAMES or best.n_bad >= best.n_good:
            return None
        return best
