"""What sensing hands on: frames and garbage from a decoder, samples and health from a stream."""

from dataclasses import dataclass
from enum import Enum


class Side(Enum):
    """Which arm a sensor is worn on."""

    LEFT = "left"
    RIGHT = "right"


@dataclass(frozen=True, slots=True)
class Frame:
    """One packet on the wire, as sent.

    Attributes:
        counter: The running number that the sensor put into it, or None where there is none.
        raw: x, y, z in the protocol's own unit (g for ``csv``, counts for ``adxl330``).
    """

    counter: int | None
    raw: tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Garbage:
    """Bytes that were no frame.

    Attributes:
        n_bytes: How many bytes were dropped.
        first_bytes: The first of them, at most 32.
        reason: What was expected instead, in words.
    """

    n_bytes: int
    first_bytes: bytes
    reason: str


@dataclass(frozen=True, slots=True)
class Repeated(Garbage):
    """A frame with the running number of the one before: old news, so it is no sample."""


@dataclass(frozen=True, slots=True)
class Impossible(Garbage):
    """A frame that could be read, with a value that the sensor cannot give. ``n_bytes`` is 0."""


@dataclass(frozen=True, slots=True)
class CounterGap:
    """The running number jumped: frames were lost on the way. ``missed`` says how many."""

    missed: int


@dataclass(frozen=True, slots=True)
class CounterJump:
    """The running number went where no loss leads: what comes now may be of another time."""

    before: int
    now: int


@dataclass(frozen=True, slots=True)
class Identity:
    """What the sensor calls itself; it stays the same whatever port it is on."""

    name: str


@dataclass(frozen=True, slots=True)
class Battery:
    """How full the sensor says its battery is. ``percent``: 0 to 100."""

    percent: float


DecoderEvent = Frame | Garbage | CounterGap | CounterJump | Identity | Battery


@dataclass(frozen=True, slots=True)
class Connected:
    """The port is open. ``port`` is its name as set."""

    port: str


@dataclass(frozen=True, slots=True)
class Disconnected:
    """The port could not be opened or is gone. ``reason``: one line with cause and remedy."""

    reason: str


SensorEvent = Garbage | CounterGap | CounterJump | Identity | Battery | Connected | Disconnected
"""What a sensor's reader tells besides samples."""


@dataclass(frozen=True, slots=True)
class Sample:
    """One calibrated reading.

    Attributes:
        t_s: Receive time on the monotonic clock, taken at the read.
        seq: Our own running number within the stream, from 0, without gaps.
        accel_g: Specific force x, y, z in g; a level sensor at rest reads (0, 0, 1).
        counter: The sensor's running number, or None.
    """

    t_s: float
    seq: int
    accel_g: tuple[float, float, float]
    counter: int | None = None


class LinkState(Enum):
    """The four states of a sensor that must be told apart."""

    NOT_CONNECTED = "not connected"
    NO_DATA = "connected, no data"
    WRONG_DATA = "wrong data"
    RECEIVING = "receiving"


@dataclass(frozen=True, slots=True)
class StreamHealth:
    """How a sensor's stream is, at one moment.

    Attributes:
        side: Whose it is.
        link: Which of the four states.
        is_alive: A valid sample came within the trip level.
        is_valid: What comes can be read, is possible, and changes.
        is_freq_ok: The measured rate lies within the site's limits.
        reason: Empty when all is well; else cause and remedy in one line.
        age_s: Time since the last valid sample; infinite before the first.
        rate_hz: Measured over the last two seconds; 0 before that.
        worst_gap_s: The longest time between two valid samples in the last minute.
        n_samples: Valid samples since the start.
        n_bad: Unreadable lines and impossible values since the start.
        n_lost: Frames missing by the running number since the start.
        jitter_s: Standard deviation of the times between two arrivals, over the last two seconds; a
            burst that was received at one time is one arrival.
        identity: What the sensor calls itself; empty when it does not.
        battery_percent: What it says of its battery, 0 to 100; None when it says nothing.
        bad_bytes: The newest bytes that were no frame, as a person can read them; empty unless
            the data are wrong.
    """

    side: Side
    link: LinkState
    is_alive: bool
    is_valid: bool
    is_freq_ok: bool
    reason: str
    age_s: float
    rate_hz: float
    worst_gap_s: float
    n_samples: int
    n_bad: int
    n_lost: int
    jitter_s: float = 0.0
    identity: str = ""
    battery_percent: float | None = None
    bad_bytes: str = ""

    @property
    def is_ok(self) -> bool:
        """Alive, valid and at the right rate."""
        return self.is_alive and self.is_valid and self.is_freq_ok


class ArmPosture(Enum):
    """What the left arm says."""

    STOP = "stop"
    START = "start"
    NEITHER = "neither"
