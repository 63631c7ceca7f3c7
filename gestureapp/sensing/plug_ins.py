"""Protocols from other packages: found by entry point, tried once, and kept from doing harm.

A package names a ``Protocol`` in the entry point group ``gestureapp.protocols``, as shown in
``docs/sensors.md``. A plug-in is somebody else's code: whatever it raises, here or while it
decodes, becomes one line, and no thread ends by it.
"""

import math
import re
from collections.abc import Collection, Iterable
from dataclasses import replace
from importlib.metadata import EntryPoint, entry_points

from gestureapp.sensing.decoder import Decoder
from gestureapp.sensing.lines import FIRST_BYTES
from gestureapp.sensing.protocols import Protocol
from gestureapp.sensing.values import DecoderEvent, Frame, Garbage

GROUP = "gestureapp.protocols"

NAME_MAX = 40
_NAME = re.compile(r"[a-z0-9][a-z0-9_.-]*")
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
    except Exception as error:  # somebody else's code may raise anything
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
        return f"its name {name!r} is not of small letters, digits, '_', '.', '-'; rename it"
    if name in taken:
        return f"{name!r} is a built-in protocol; rename it"
    if not isinstance(given.words, str) or not given.words.strip():
        return "its words are missing; say what it is"
    limit_g = given.limit_g
    is_number = isinstance(limit_g, int | float) and not isinstance(limit_g, bool)
    if not (is_number and math.isfinite(limit_g) and limit_g > 0):
        return f"its limit_g {limit_g!r} is no acceleration; give the sensor's range in g"
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
        except Exception:  # somebody else's code; the reader tells of the value
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
        except Exception as error:  # somebody else's code may raise anything
            return self._failed(data, error)

    def end(self) -> list[DecoderEvent]:
        """What the plug-in's decoder makes of the end of the stream."""
        try:
            return [] if self._decoder is None else _checked(self._decoder.end())
        except Exception as error:  # as above
            return self._failed(b"", error)

    def _failed(self, data: bytes, error: Exception) -> list[DecoderEvent]:
        self._decoder = None
        reason = f"the plug-in {self._given.name!r} failed with {_shown(error)}"
        return [Garbage(len(data), data[:FIRST_BYTES], reason)]


def _checked(events: object) -> list[DecoderEvent]:
    """The list as it is.

    Raises:
        TypeError: it is no list of events.
    """
    if not isinstance(events, list):
        raise TypeError(f"a {type(events).__name__} instead of a list of events")
    for event in events:
        if not isinstance(event, DecoderEvent):
            raise TypeError(f"a {type(event).__name__} instead of an event")
        if isinstance(event, Frame):
            _vector(event.raw)
            if not isinstance(event.counter, int | None):
                raise TypeError(f"running number {event.counter!r} instead of a whole number")
    return events


def _vector(given: object) -> tuple[float, float, float]:
    """Three numbers.

    Raises:
        TypeError: it is something else.
    """
    if isinstance(given, tuple) and len(given) == 3:
        x, y, z = given
        if all(isinstance(value, int | float) for value in given):
            return float(x), float(y), float(z)
    raise TypeError(f"{given!r} instead of three numbers")


def _words(point: EntryPoint) -> str:
    package = "" if point.dist is None else f" of {point.dist.name}"
    return f"{point.name!r}{package} ({point.value})"


def _shown(error: Exception) -> str:
    """The error in one line of bounded length."""
    text = " ".join(str(error).split())[:120]
    return f"{type(error).__name__}: {text}" if text else type(error).__name__
