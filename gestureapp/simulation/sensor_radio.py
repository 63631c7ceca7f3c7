"""The radio between an emulated sensor and the application: bursts, gaps and loss. Pure."""

import random
from collections.abc import Sequence
from dataclasses import dataclass

from gestureapp.errors import ConfigError
from gestureapp.simulation.sensor_model import Emission

GAP_MAX_S = 5.0
BURST_FRAMES_MAX = 100


@dataclass(frozen=True, slots=True)
class RadioOptions:
    """How a radio carries frames.

    Attributes:
        burst: So many frames at least leave together, 1 to 100.
        gap_s: Shortest and longest time between two bursts; each is drawn between them. Frames
            leave with the sensor's ticks, so a gap is a whole number of these.
        loss: Share of the frames that never arrive, 0 to 1.
        clock_ppm: How much too slow the sensor's own clock is, in millionths.
    """

    burst: int = 1
    gap_s: tuple[float, float] = (0.0, 0.0)
    loss: float = 0.0
    clock_ppm: float = 0.0

    def __post_init__(self) -> None:
        """Check the ranges.

        Raises:
            ConfigError: one is not kept.
        """
        if not 1 <= self.burst <= BURST_FRAMES_MAX:
            raise ConfigError("link-burst", self.burst, f"must be 1 to {BURST_FRAMES_MAX} frames")
        shortest_s, longest_s = self.gap_s
        if not 0.0 <= shortest_s <= longest_s <= GAP_MAX_S:
            text = f"must be two times from 0 to {GAP_MAX_S * 1000:g} ms, the shorter one first"
            given = f"{shortest_s * 1000:g} to {longest_s * 1000:g}"
            raise ConfigError("link-gap-ms", given, text)
        if not 0.0 <= self.loss <= 1.0:
            raise ConfigError("link-loss", self.loss, "must be 0 to 1")
        if not abs(self.clock_ppm) <= 100_000:
            raise ConfigError("clock-ppm", self.clock_ppm, "must be -100000 to 100000")


DIRECT = RadioOptions()
"""A cable: every frame at once."""

BLUETOOTH = RadioOptions(burst=2, gap_s=(0.02, 0.06), loss=0.001, clock_ppm=100.0)
"""As serial ports over Bluetooth do it: the radio sends when it has its turn, so frames come two to
six together. A cheap part's crystal is off by some tens of millionths, a warm one's by more."""

LINKS = {"direct": DIRECT, "bluetooth": BLUETOOTH}
"""By the name on the command line."""


class Radio:
    """Keeps frames back and loses some. Owned by the emulator's loop; same seed, same fate.

    Args:
        options: How it carries them.
        rng: Chance for gaps and loss.
    """

    def __init__(self, options: RadioOptions, rng: random.Random) -> None:
        self._options = options
        self._rng = rng
        self._held: list[Emission] = []
        self._next_s = float("-inf")

    def carry(
        self, now_s: float, frames: Sequence[Emission], period_s: float
    ) -> Sequence[Emission]:
        """Take what the sensor sends now; gives what arrives now.

        Args:
            now_s: Time of this tick.
            frames: What the sensor sends.
            period_s: Time to the next tick.
        """
        self._held += [frame for frame in frames if self._rng.random() >= self._options.loss]
        # Half a tick early: a gap that was drawn is met to the nearest tick, never exceeded by one.
        if len(self._held) < self._options.burst or now_s < self._next_s - period_s / 2:
            return ()
        arriving, self._held = self._held, []
        self._next_s = now_s + self._rng.uniform(*self._options.gap_s)
        return arriving

    def clear(self) -> None:
        """What is under way is lost, as when the connection ends."""
        self._held.clear()
