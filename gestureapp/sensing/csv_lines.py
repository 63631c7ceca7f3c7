"""The ``csv`` protocol: ``ax,ay,az`` or ``n,ax,ay,az``, in g, one line a sample. Pure."""

import math
import re

from gestureapp.sensing.values import Frame

EXPECTED = "ax,ay,az or n,ax,ay,az in g"

LIMIT_G = 16.0
"""The widest range of the usual digital accelerometers; beyond it no such sensor reads."""

# Stricter than float(): no nan, inf, hexadecimal, underscores or digits beyond ASCII.
_DECIMAL = rb"[ \t]*([+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d{1,3})?)[ \t]*"
_LINE = re.compile(rb"(?:[ \t]*(\d{1,10})[ \t]*,)?" + rb",".join([_DECIMAL] * 3))


def parse_csv(line: bytes) -> Frame | None:
    """Read one line without its end; raw values are in g. None when it is no frame."""
    match = _LINE.fullmatch(line)
    if match is None:
        return None
    number = match[1]
    raw = (float(match[2]), float(match[3]), float(match[4]))
    if not all(map(math.isfinite, raw)):  # 1e999 has the form of a number
        return None
    return Frame(None if number is None else int(number), raw)


def csv_to_g(raw: tuple[float, float, float]) -> tuple[float, float, float]:
    """The identity: this protocol speaks g."""
    return raw
