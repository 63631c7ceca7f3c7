"""A protocol of a plug-in: lines like ``A7 x=-12 y=4 z=998``, a running number and mg."""

import re

from gestureapp.sensing.decoder import LineDecoder
from gestureapp.sensing.protocols import Protocol
from gestureapp.sensing.values import Frame

_LINE = re.compile(rb"A(\d{1,5}) x=(-?\d{1,5}) y=(-?\d{1,5}) z=(-?\d{1,5})")


def parse(line: bytes) -> Frame | None:
    """Read one line without its end; None when it is no frame."""
    match = _LINE.fullmatch(line)
    if match is None:
        return None
    number, x, y, z = (int(field) for field in match.groups())
    return Frame(number, (float(x), float(y), float(z)))


PROTOCOL = Protocol(
    name="milli-g",
    words="lines with a running number, in mg: A7 x=-12 y=4 z=998",
    new_decoder=lambda: LineDecoder(parse, "A7 x=-12 y=4 z=998"),
    to_nominal_g=lambda raw: (raw[0] / 1000, raw[1] / 1000, raw[2] / 1000),
    limit_g=8.0,
)
