"""Protocols from other packages: found by entry point, tried once, and kept from doing harm.

A package names a ``Protocol`` in the entry point group ``gestureapp.protocols``, as shown in
``docs/sensors.md``. A plug-in is somebody else's code: whatever it raises, here or while it
decodes, ``SystemExit`` too, becomes one line, and no thread ends by it. Only Ctrl+C goes through.
What its decoder gives is checked field by field, as what follows relies on it.
"""

import math
import re
import reprlib
from collections.abc import Collection, Iterable
from dataclasses import replace
from importlib.metadata import EntryPoint, entry_points

from gestureapp.sensing.counter import MAX_MISSED
from gestureapp.sensing.decoder import Decoder
from gestureapp.sensing.lines import FIRST_BYTES
from gestureapp.sensing.protocols import Protocol
from gestureapp.sensing.values import (
    Battery,
    CounterGap,
    CounterJump,
    DecoderEvent,
    Frame,
    Garbage,
    Identity,
)

GROUP = "gestureapp.protocols"

NAME_MAX = 40
"""Characters of a protocol's name, and of what a sensor calls itself."""
LINE_MAX = 120
"""Characters of what a plug-in says was wrong."""

_NAME = re.compile(r"[a-z0-9][a-z0-9_.-]*")
_MOST = (1 << 63) - 1
"""No sensor counts further."""
_NOWHERE = (math.nan, math.nan, math.nan)
"""No sensor can have measured that, so a frame with it becomes no sample."""


def installed_plug_ins(taken: Collection[str]) -> tuple[tuple[Protocol, ...], tuple[str, ...]]:
    """Load what the installed packages name; see ``load_plug_ins``."""
    return load_plug_ins(entry_points(group=GROUP), taken)


def load_plug_ins(
    points: Iterable[EntryPoint], taken: Collection[str]
) -> tuple[tuple[Protocol, ...], tuple[str, ...]]:
    """Import these entry points and keep those that are what they should be.

    Args:
        points: Of the group ``GROUP``.
        taken: Names that nobody may take: the built-in protocols'.

    Returns:
        The protocols by name, and one line of cause and remedy for each that was left out. Of two
        with one name both are left out: which one is meant cannot be known.
    """
    loaded: dict[str, list[tuple[EntryPoint, Protocol]]] = {}
    findings: list[str] = []
    for point in sorted(points, key=lambda point: (point.name, point.value)):
        found = _load(point, taken)
        if isinstance(found, str):
            findings.append(f"protocol plug-in {_words(point)} is not used: {found}")
        else:
            loaded.setdefault(found.name, []).append((point, found))
    for name, claims in loaded.items():
        if len(claims) > 1:
            both = " and ".join(_words(point) for point, _ in claims)
            findings.append(f"protocol {name!r} is not used: {both} both give it; remove one")
    single = [claims[0][1] for claims in loaded.values() if len(claims) == 1]
    return tuple(sorted(single, key=lambda known: known.name)), tuple(findings)


def _load(point: EntryPoint, taken: Collection[str]) -> Protocol | str:
    """The guarded protocol, or what is wrong and the remedy."""
    try:
        given = point.load()
        wrong = _wrong(given, taken) if isinstance(given, Protocol) else _no_protocol(given)
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # somebody else's code may raise anything, SystemExit too
        return f"it fails with {_shown(error)}; mend or remove the package"
    return wrong or _guarded(given)


def _no_protocol(given: object) -> str:
    return f"it gives a {type(given).__name__}, expected a gestureapp.sensing.protocols.Protocol"


def _wrong(given: Protocol, taken: Collection[str]) -> str:
    """What is wrong with it, or empty; tries decoder and scale once.

    Raises:
        Exception: whatever its code raises.
    """
    name = given.name
    if not (isinstance(name, str) and len(name) <= NAME_MAX and _NAME.fullmatch(name)):
        wrong = "is not of small letters, digits, '_', '.', '-'; rename it"
        return f"its name {reprlib.repr(name)} {wrong}"
    if name in taken:
        return f"{name!r} is a built-in protocol; rename it"
    if not isinstance(given.words, str) or not given.words.strip():
        return "its words are missing; say what it is"
    limit_g = given.limit_g
    is_number = isinstance(limit_g, int | float) and not isinstance(limit_g, bool)
    if not (is_number and math.isfinite(limit_g) and limit_g > 0):
        return (
            f"its limit_g {reprlib.repr(limit_g)} is no acceleration; give the sensor's range in g"
        )
    decoder = given.new_decoder()
    if not all(callable(getattr(decoder, method, None)) for method in ("feed", "end")):
        return "its decoder has no feed and end; see gestureapp.sensing.decoder.Decoder"
    if not isinstance(decoder.feed(b""), list) or not isinstance(decoder.end(), list):
        return "its decoder gives no list of events; see gestureapp.sensing.decoder.Decoder"
    _vector(given.to_nominal_g((0.0, 0.0, 0.0)))
    return ""


def _guarded(given: Protocol) -> Protocol:
    """The same, with what its code raises turned into garbage and impossible values."""

    def to_nominal_g(raw: tuple[float, float, float]) -> tuple[float, float, float]:
        try:
            return _vector(given.to_nominal_g(raw))
        except KeyboardInterrupt:
            raise
        except BaseException:  # somebody else's code; the reader tells of the value
            return _NOWHERE

    return replace(given, new_decoder=lambda: GuardedDecoder(given), to_nominal_g=to_nominal_g)


class GuardedDecoder:
    """A plug-in's decoder that cannot end the reader: what it raises is told, and it begins anew.

    Owned by the reader of one connection.

    Args:
        given: The plug-in's protocol.
    """

    def __init__(self, given: Protocol) -> None:
        self._given = given
        self._decoder: Decoder | None = None

    def feed(self, data: bytes) -> list[DecoderEvent]:
        """What the plug-in's decoder finds in these bytes."""
        try:
            if self._decoder is None:
                self._decoder = self._given.new_decoder()
            return _checked(self._decoder.feed(data))
        except KeyboardInterrupt:
            raise
        except BaseException as error:  # somebody else's code may raise anything
            return self._failed(data, error)

    def end(self) -> list[DecoderEvent]:
        """What the plug-in's decoder makes of the end of the stream."""
        try:
            return [] if self._decoder is None else _checked(self._decoder.end())
        except KeyboardInterrupt:
            raise
        except BaseException as error:  # as above
            return self._failed(b"", error)

    def _failed(self, data: bytes, error: BaseException) -> list[DecoderEvent]:
        self._decoder = None
        reason = f"the plug-in {self._given.name!r} failed with {_shown(error)}"
        return [Garbage(len(data), data[:FIRST_BYTES], reason)]


def _checked(events: object) -> list[DecoderEvent]:
    """The list, of events that are what they should be.

    Raises:
        TypeError: it is no list of events.
        ValueError: what one of them says cannot be.
    """
    if not isinstance(events, list):
        raise TypeError(f"a {type(events).__name__} instead of a list of events")
    return [_event(event) for event in events]


def _event(event: object) -> DecoderEvent:
    match event:
        case Frame(counter, raw):
            number = counter if counter is None else _whole(counter, 0, _MOST)
            return Frame(number, _vector(raw))
        case Garbage():
            return _garbage(event)
        case CounterGap(missed):
            return CounterGap(_whole(missed, 1, MAX_MISSED))
        case CounterJump(before, now):
            return CounterJump(_whole(before, 0, _MOST), _whole(now, 0, _MOST))
        case Identity(name):
            return Identity(_name(name))
        case Battery(percent):
            if not isinstance(percent, int | float) or not 0 <= percent <= 100:
                raise ValueError(f"battery {reprlib.repr(percent)} instead of 0 to 100 percent")
            return Battery(float(percent))
    raise TypeError(f"a {type(event).__name__} instead of an event")


def _whole(value: object, low: int, high: int) -> int:
    if type(value) is not int:
        raise TypeError(f"number {reprlib.repr(value)} instead of a whole number")
    if not low <= value <= high:
        raise ValueError(f"a whole number beyond {low} to {high}")
    return value


def _name(value: object) -> str:
    if not (isinstance(value, str) and 0 < len(value) <= NAME_MAX and value.isprintable()):
        raise ValueError(
            f"name {reprlib.repr(value)} instead of 1 to {NAME_MAX} printable characters"
        )
    return value


def _garbage(event: Garbage) -> Garbage:
    if not (isinstance(event.first_bytes, bytes) and isinstance(event.reason, str)):
        raise TypeError("garbage whose first bytes are no bytes, or whose reason is no text")
    return replace(
        event,
        n_bytes=_whole(event.n_bytes, 0, _MOST),
        first_bytes=event.first_bytes[:FIRST_BYTES],
        reason=_line(event.reason),
    )


def _line(text: str) -> str:
    """A text of anybody's as one line of bounded length."""
    line = " ".join(text[: 10 * LINE_MAX].split())
    return "".join(sign if sign.isprintable() else "?" for sign in line)[:LINE_MAX]


def _vector(given: object) -> tuple[float, float, float]:
    """Three numbers.

    Raises:
        TypeError: it is something else.
    """
    if isinstance(given, tuple) and len(given) == 3:
        x, y, z = given
        if all(isinstance(value, int | float) for value in given):
            return float(x), float(y), float(z)
    raise TypeError(f"{reprlib.repr(given)} instead of three numbers")


def _words(point: EntryPoint) -> str:
    package = "" if point.dist is None else f" of {point.dist.name}"
    return f"{point.name!r}{package} ({point.value})"


def _shown(error: BaseException) -> str:
    """The error in one line of bounded length."""
    try:
        text = _line(str(error))
    except Exception:  # even this is the plug-in's code
        text = ""
    return f"{type(error).__name__}: {text}" if text else type(error).__name__
