"""The ``csv`` protocol: ``ax,ay,az`` or ``n,ax,ay,az``, in g, one line a sample. Pure."""

import re

from gestureapp.sensing.values import Frame

EXPECTED = "ax,ay,az or n,ax,ay,az in g"

LIMIT_G = 16.0
"""The widest range of the usual digital accelerometers; beyond it no such sensor reads."""

# Stricter than float(): no nan, inf, hexadecimal, underscores or digits beyond ASCII.
_DECIMAL = rb"[ \t]*([+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d{1,2})?)[ \t]*"
_LINE = re.compile(rb"(?:[ \t]*(\d{1,10})[ \t]*,)?" + rb",".join([_DECIMAL] * 3))


def parse_csv(line: bytes) -> Frame | None:
    """Read one line without its end; raw values are in g. None when it is no frame."""
    match = _LINE.fullmatch(line)
    if match is None:
        return None
    number, x, y, z = match.groups()
    return Frame(None if number is None else int(number), (float(x), float(y), float(z)))


def csv_to_g(raw: tuple[float, float, float]) -> tuple[float, float, float]:
    """The identity: this protocol speaks g."""
    return raw
