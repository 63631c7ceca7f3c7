"""What a sensor puts on the wire: encoders from acceleration to the bytes of one line. Pure.

Written from the protocols' description and from nothing else: the application's decoders are not
used here, so that a mistake they might share cannot hide.
"""

import random
from collections.abc import Callable

Accel = tuple[float, float, float]
"""Specific force x, y, z in g."""

Encoder = Callable[[int | None, Accel], bytes]
"""Running number (None: the line has none) and acceleration in g to one line with its line end."""

COUNTER_SPAN = 1 << 16
"""The running number has 16 bits, as a small microcontroller's: after 65535 comes 0."""

ADXL330_SUPPLY_V = 3.0
"""Supply and reference voltage. Source: the data sheet's typical operating point."""

ADXL330_ZERO_G_V = 1.5
"""Output at zero g: half the supply. Source: data sheet, zero g bias level."""

ADXL330_V_PER_G = 0.3
"""Sensitivity. Source: data sheet, 300 mV/g at 3 V."""

ADXL330_STEPS = 1 << 10
"""Steps of the 10-bit converter behind the sensor: code = volts / supply x 1024, to the nearest."""


def encode_csv(counter: int | None, accel_g: Accel) -> bytes:
    """Write ``n,ax,ay,az`` in g with four decimals; without running number ``ax,ay,az``."""
    fields = [f"{value:.4f}" for value in accel_g]
    return _line(counter, fields, b"\n")


def encode_adxl330(counter: int | None, accel_g: Accel) -> bytes:
    """Write ``n,x,y,z`` in counts of the 10-bit converter, as the sensor behind it can give them.

    A reading beyond the rails (about 5 g) stays at the rail, 0 or 1023.
    """
    top = ADXL330_STEPS - 1
    fields = [str(min(max(_adxl330_count(value), 0), top)) for value in accel_g]
    return _line(counter, fields, b"\r\n")


ENCODERS: dict[str, Encoder] = {"csv": encode_csv, "adxl330": encode_adxl330}
"""By the name that the application's decoder has."""


def cut_line(line: bytes, rng: random.Random) -> bytes:
    """Lose the end of a line, its last field at least; every other time the line end as well."""
    body = line.rstrip(b"\r\n")
    kept = body[: rng.randint(1, max(1, body.rfind(b",")))]
    return kept + line[len(body) :] if rng.random() < 0.5 else kept


def garbage_like(line: bytes, rng: random.Random) -> bytes:
    """Random bytes, as many as the line has."""
    return rng.randbytes(len(line))


def _adxl330_count(value_g: float) -> int:
    volts = ADXL330_ZERO_G_V + ADXL330_V_PER_G * value_g
    return round(volts / ADXL330_SUPPLY_V * ADXL330_STEPS)


def _line(counter: int | None, fields: list[str], end: bytes) -> bytes:
    if counter is not None:
        fields = [str(counter), *fields]
    return ",".join(fields).encode("ascii") + end
