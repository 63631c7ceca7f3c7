"""What a sensor puts on the wire: encoders from acceleration to the bytes of one frame. Pure.

Written from the protocols' description and from nothing else: the application's decoders are not
used here, so that a mistake they might share cannot hide.
"""

import random
import struct
from collections.abc import Callable

Accel = tuple[float, float, float]
"""Specific force x, y, z in g."""

Encoder = Callable[[int | None, Accel], bytes]
"""Running number (None: the frame has none) and acceleration in g to the bytes of one frame."""

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

WITMOTION_TEMPERATURE = 2500
"""25.00 degrees. Source: the makers' data sheet, hundredths of a degree."""

NAME_BYTES_MAX = 20
"""Longest name that the ``binary`` protocol carries."""


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


def encode_witmotion(_: int | None, accel_g: Accel) -> bytes:
    """Write what these sensors send for one moment: acceleration, turning rate and angle.

    There is no running number; rate and angle are those of a sensor that does not turn. A reading
    beyond the range of 16 g stays at its end.
    """
    counts = [_rail(value / 16.0 * 32768.0) for value in accel_g]
    frames = (
        (0x51, (*counts, WITMOTION_TEMPERATURE)),
        (0x52, (0, 0, 0, WITMOTION_TEMPERATURE)),
        (0x53, (0, 0, 0, 0)),
    )
    return b"".join(_witmotion_frame(kind, words) for kind, words in frames)


def encode_binary(counter: int | None, accel_g: Accel, battery: int = 255) -> bytes:
    """Write a sample of the ``binary`` protocol; without running number it is 0.

    Args:
        counter: Running number.
        accel_g: In g; a reading beyond the range, 16.4 g, stays at its end.
        battery: Percent, or 255 for unknown.
    """
    counts = [_rail(value / 0.0005) for value in accel_g]
    return _binary_frame(1, struct.pack("<HhhhB", counter or 0, *counts, battery))


def encode_identity(name: str) -> bytes:
    """Write what the sensor calls itself in the ``binary`` protocol, 1 to 20 bytes of UTF-8."""
    return _binary_frame(2, name.encode())


ENCODERS: dict[str, Encoder] = {
    "csv": encode_csv,
    "adxl330": encode_adxl330,
    "witmotion": encode_witmotion,
    "binary": encode_binary,
}
"""By the name that the application's decoder has."""

COUNTED = frozenset({"adxl330", "binary"})
"""Protocols whose frames always carry a running number."""

LINES = frozenset({"csv", "adxl330"})
"""Protocols of one line of text a sample."""


def cut(protocol: str, data: bytes, rng: random.Random) -> bytes:
    """Lose the end of a frame; of a line its last field, every other time the line end as well."""
    if protocol not in LINES:
        return data[: rng.randint(1, len(data) - 1)]
    body = data.rstrip(b"\r\n")
    kept = body[: rng.randint(1, max(1, body.rfind(b",")))]
    return kept + data[len(body) :] if rng.random() < 0.5 else kept


def garbage_like(data: bytes, rng: random.Random) -> bytes:
    """Random bytes, as many as the frame has."""
    return rng.randbytes(len(data))


def _adxl330_count(value_g: float) -> int:
    volts = ADXL330_ZERO_G_V + ADXL330_V_PER_G * value_g
    return round(volts / ADXL330_SUPPLY_V * ADXL330_STEPS)


def _line(counter: int | None, fields: list[str], end: bytes) -> bytes:
    if counter is not None:
        fields = [str(counter), *fields]
    return ",".join(fields).encode("ascii") + end


def _rail(count: float) -> int:
    """To the nearest count of 16 bits."""
    return min(max(round(count), -32768), 32767)


def _witmotion_frame(kind: int, words: tuple[int, ...]) -> bytes:
    body = bytes([0x55, kind]) + struct.pack("<4h", *words)
    return body + bytes([sum(body) % 256])


def _binary_frame(kind: int, body: bytes) -> bytes:
    content = bytes([1, kind]) + body
    return _cobs(content + struct.pack("<H", _crc16(content))) + b"\0"


def _crc16(data: bytes) -> int:
    """CRC-16 of polynomial 0x1021 that begins with 0xFFFF; of the text 123456789 it is 29B1."""
    crc = 0xFFFF
    for byte in data:
        crc ^= byte << 8
        for _ in range(8):
            crc = (crc << 1 ^ 0x1021) & 0xFFFF if crc & 0x8000 else crc << 1
    return crc


def _cobs(packet: bytes) -> bytes:
    """Replace the zeros of a packet of less than 254 bytes by the distance to the next."""
    return b"".join(bytes([len(block) + 1]) + block for block in packet.split(b"\0"))
