"""Health of one sensor's stream: alive, valid, freq_ok, and the time the watchdog counts. Pure."""

import math

from gestureapp.sensing.lines import readable_bytes
from gestureapp.sensing.rate import RATE_SPAN_S, RateMeter, WorstGap
from gestureapp.sensing.values import (
    Battery,
    Connected,
    CounterGap,
    CounterJump,
    Disconnected,
    Garbage,
    Identity,
    Impossible,
    LinkState,
    Repeated,
    Sample,
    SensorEvent,
    Side,
    StreamHealth,
)

RECENT_S = 1.0
"""So long after the last unreadable bytes the trouble is "wrong data"; later it is silence."""
JUMP_REACH = 64
"""So many more frames than time allows may be missing: a burst that was lost on its way."""

_RESTART = "switch the sensor off and on"
_SILENCE_REMEDY = "switch the sensor on, bring it closer, charge it"
_KINDS: dict[type[Garbage], str] = {
    Garbage: "unreadable data",
    Repeated: "repeated data",
    Impossible: "impossible values",
}
_REMEDIES: dict[type[Garbage], str] = {
    Garbage: "check port and protocol in the settings",
    Repeated: _RESTART,
    Impossible: "check the sensor's cable and supply, and its protocol in the settings",
}


class StreamTracker:
    """Follows one stream and says how it is at any time. Owned by one thread.

    A sample *counts* when it differs from the one before in at least one axis. Time since the
    newest one that counts is what the watchdog holds against the trip level: silence, a frozen
    sensor, unreadable bytes and impossible values (these never become samples) all make it grow.

    A worn sensor trembles, but a 10-bit converter hides some of it: a simulated arm held still read
    the same for up to 90 ms in ten minutes (``adxl330``, 100 Hz), and one that lies on a table may
    for longer. It is then reported as frozen, as nothing tells the two apart.

    What comes counts in the order of the calls, so the owner keeps the reader's order.

    Args:
        side: Whose stream.
        trip_level_s: Older than this is not alive.
        rate_min_hz: Slowest rate that is all right.
        rate_max_hz: Fastest rate that is all right.
    """

    def __init__(
        self, side: Side, trip_level_s: float, rate_min_hz: float, rate_max_hz: float
    ) -> None:
        self._side = side
        self._trip_level_s = trip_level_s
        self._rate_min_hz = rate_min_hz
        self._rate_max_hz = rate_max_hz
        self._rate = RateMeter()
        self._gaps = WorstGap()
        self._is_connected = False
        self._why_not = "not opened yet: check the port in the settings"
        self._connected_s = 0.0
        self._accel_g: tuple[float, float, float] | None = None
        self._newest_s: float | None = None
        self._changed_s: float | None = None
        self._garbage: Garbage | None = None
        self._garbage_s = -math.inf
        self._is_garbage_newest = False
        self._jump = ""
        self._identity = ""
        self._battery_percent: float | None = None
        self._n_samples = 0
        self._n_bad = 0
        self._n_lost = 0

    def set_limits(self, trip_level_s: float, rate_min_hz: float, rate_max_hz: float) -> None:
        """Judge by these from now on; what was measured stays."""
        self._trip_level_s = trip_level_s
        self._rate_min_hz = rate_min_hz
        self._rate_max_hz = rate_max_hz

    def event(self, t_s: float, event: SensorEvent) -> None:
        """Take whatever a reader tells besides samples, received at ``t_s``."""
        match event:
            case Garbage():
                self.garbage(t_s, event)
            case CounterGap():
                self.gap(t_s, event)
            case CounterJump():
                self._jumped(f"running number jumped from {event.before} to {event.now}")
            case Identity():
                self._identity = event.name
            case Battery():
                self._battery_percent = event.percent
            case Connected():
                self.connected(t_s)
            case Disconnected():
                self.disconnected(event.reason)

    def sample(self, sample: Sample) -> None:
        """Take the next sample."""
        self._n_samples += 1
        self._newest_s = sample.t_s
        self._is_garbage_newest = False
        self._rate.add(sample.t_s)
        if sample.accel_g != self._accel_g:
            self._accel_g = sample.accel_g
            self._changed_s = sample.t_s
            self._gaps.add(sample.t_s)

    def garbage(self, t_s: float, garbage: Garbage) -> None:
        """Something came that is no sample: unreadable, repeated or impossible."""
        self._n_bad += 1
        self._garbage = garbage
        self._garbage_s = t_s
        self._is_garbage_newest = True

    def gap(self, t_s: float, gap: CounterGap) -> None:
        """Frames were lost on the way; more than time allows are a jump of the sensor's clock."""
        self._n_lost += gap.missed
        if self._newest_s is None:
            return
        most = (t_s - self._newest_s) * self._rate_max_hz + JUMP_REACH
        if gap.missed > most:
            self._jumped(f"running number jumped by {gap.missed}")

    def _jumped(self, words: str) -> None:
        """Nobody knows of when the samples are: the stream is judged anew, as a new connection."""
        self._jump = words
        self._rate.restart()

    def connected(self, t_s: float) -> None:
        """The port is open; the rate is measured anew, and it may be another sensor."""
        self._jump = ""
        self._identity = ""
        self._battery_percent = None
        self._is_connected = True
        self._connected_s = t_s
        self._newest_s = None
        self._is_garbage_newest = False
        self._rate.restart()

    def disconnected(self, reason: str) -> None:
        """The port is gone or could not be opened. ``reason``: cause and remedy."""
        self._is_connected = False
        self._why_not = reason

    def last_valid_s(self, now_s: float) -> float | None:
        """Receive time of the newest sample that counts for the watchdog; None before the first.

        A frozen stream stops counting at the sample after which nothing changed. Never later than
        ``now_s``: a time from the future earns no respite.
        """
        return None if self._changed_s is None else min(self._changed_s, now_s)

    def health(self, now_s: float) -> StreamHealth:
        """How the stream is at ``now_s``, monotonic clock."""
        last_s = self.last_valid_s(now_s)
        age_s = math.inf if last_s is None else now_s - last_s
        link, trouble = self._link(now_s, age_s)
        rate_hz = self._rate.rate_hz(now_s)
        is_freq_ok = self._rate_min_hz <= rate_hz <= self._rate_max_hz
        return StreamHealth(
            side=self._side,
            link=link,
            is_alive=link is LinkState.RECEIVING,
            is_valid=last_s is not None and link is not LinkState.WRONG_DATA,
            is_freq_ok=is_freq_ok,
            reason=trouble or ("" if is_freq_ok else self._rate_trouble(now_s, rate_hz)),
            age_s=age_s,
            rate_hz=rate_hz,
            worst_gap_s=self._gaps.worst_s(now_s),
            n_samples=self._n_samples,
            n_bad=self._n_bad,
            n_lost=self._n_lost,
            bad_bytes=self._bad_bytes(link),
            jitter_s=self._rate.jitter_s(now_s),
            identity=self._identity,
            battery_percent=self._battery_percent,
        )

    def _bad_bytes(self, link: LinkState) -> str:
        """The offending bytes, while they are what is wrong."""
        if link is not LinkState.WRONG_DATA or not self._is_garbage_newest:
            return ""
        return readable_bytes(self._garbage.first_bytes) if self._garbage is not None else ""

    def _link(self, now_s: float, age_s: float) -> tuple[LinkState, str]:
        """The state and what is wrong with it; empty words when samples come and change."""
        if not self._is_connected:
            return LinkState.NOT_CONNECTED, self._why_not
        newest_s = self._newest_s
        if newest_s is not None and age_s <= self._trip_level_s:
            return LinkState.RECEIVING, ""
        if newest_s is not None and self._is_frozen(newest_s, now_s):
            return LinkState.WRONG_DATA, f"frozen on one value for {_span(age_s)}: {_RESTART}"
        since_s = self._connected_s if newest_s is None else newest_s
        if self._garbage is not None and self._is_garbage_newest:
            if now_s - self._garbage_s <= RECENT_S:
                return LinkState.WRONG_DATA, _garbage_trouble(self._garbage, now_s - since_s)
            since_s = self._garbage_s
        return LinkState.NO_DATA, f"no data for {_span(now_s - since_s)}: {_SILENCE_REMEDY}"

    def _is_frozen(self, newest_s: float, now_s: float) -> bool:
        """Named by what lasted longer: two equal readings before a silence are no frozen sensor."""
        silent_s = now_s - newest_s
        changed_s = newest_s if self._changed_s is None else self._changed_s
        return silent_s <= self._trip_level_s and silent_s <= newest_s - changed_s

    def _rate_trouble(self, now_s: float, rate_hz: float) -> str:
        if not self._rate.is_measured(now_s) and self._jump:
            return f"{self._jump}: {_RESTART}, or wait {RATE_SPAN_S:g} s"
        if not self._rate.is_measured(now_s):
            return f"rate not known yet: wait {RATE_SPAN_S:g} s"
        limits = f"{self._rate_min_hz:g} to {self._rate_max_hz:g} Hz wanted"
        if self._garbage is not None and now_s - self._garbage_s <= RECENT_S:
            remedy = f"unreadable data in between ({self._garbage.reason}), check the radio"
        else:
            remedy = "set the sensor to 100 Hz or check the radio"
        return f"{rate_hz:.0f} Hz measured, {limits}: {remedy}"


def _garbage_trouble(garbage: Garbage, span_s: float) -> str:
    remedy = _REMEDIES[type(garbage)]
    return f"{_KINDS[type(garbage)]} for {_span(span_s)} ({garbage.reason}): {remedy}"


def _span(span_s: float) -> str:
    """A time for a person: milliseconds while they matter."""
    return f"{max(0.0, span_s) * 1000:.0f} ms" if span_s < 10 else f"{span_s:.0f} s"
