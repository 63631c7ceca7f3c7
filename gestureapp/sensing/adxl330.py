"""The ``adxl330`` protocol: ``n,x,y,z``, 10-bit counts of a 3.0 V supply. Pure."""

import re

from gestureapp.sensing.values import Frame

EXPECTED = "n,x,y,z with counts 0 to 1023"

MAX_COUNTS = 1023

SUPPLY_V = 3.0
ZERO_G_V = 1.5
SENSITIVITY_V_PER_G = 0.3
"""Source: the paper, section II, and the ADXL330 data sheet, table 1: 300 mV/g, 1.5 V, at 3 V."""

COUNTS_PER_V = 1024 / SUPPLY_V
"""A 10-bit converter has 1024 steps over its reference, which is the supply."""

ZERO_G_COUNTS = ZERO_G_V * COUNTS_PER_V
"""512."""

COUNTS_PER_G = SENSITIVITY_V_PER_G * COUNTS_PER_V
"""102.4."""

LIMIT_G = 4.9
"""The amplifier swings between about 0.1 and 2.8 V (-4.7 to +4.3 g); the rails would be 5 g.

A reading at a rail is thus a broken wire, a lost supply or a jump, never an acceleration.
"""

_COUNTS = rb"[ \t]*(\d{1,4})[ \t]*"
_LINE = re.compile(rb"[ \t]*(\d{1,10})[ \t]*," + rb",".join([_COUNTS] * 3))


def parse_adxl330(line: bytes) -> Frame | None:
    """Read one line without its end; raw values are counts. None when it is no frame."""
    match = _LINE.fullmatch(line)
    if match is None:
        return None
    number, x, y, z = (int(field) for field in match.groups())
    if max(x, y, z) > MAX_COUNTS:
        return None
    return Frame(number, (float(x), float(y), float(z)))


def adxl330_to_g(raw: tuple[float, float, float]) -> tuple[float, float, float]:
    """Counts to g by the nominal zero and sensitivity; a particular sensor may be 10 % off."""
    x, y, z = raw
    return (
        (x - ZERO_G_COUNTS) / COUNTS_PER_G,
        (y - ZERO_G_COUNTS) / COUNTS_PER_G,
        (z - ZERO_G_COUNTS) / COUNTS_PER_G,
    )
