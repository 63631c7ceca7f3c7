"""The sensors' protocols by name. Pure."""

import difflib
from collections.abc import Callable
from dataclasses import dataclass

from gestureapp.errors import ConfigError
from gestureapp.sensing import adxl330, csv_lines
from gestureapp.sensing.decoder import Decoder, LineDecoder


@dataclass(frozen=True, slots=True)
class Protocol:
    """How one kind of sensor speaks.

    Attributes:
        name: As in the settings.
        words: What it is, for a person.
        new_decoder: Makes the decoder of one connection.
        to_nominal_g: Raw values of a frame to g, before the calibration of the particular sensor.
        limit_g: What the sensor can physically give on an axis; more is impossible, never a sample.
    """

    name: str
    words: str
    new_decoder: Callable[[], Decoder]
    to_nominal_g: Callable[[tuple[float, float, float]], tuple[float, float, float]]
    limit_g: float


PROTOCOLS: tuple[Protocol, ...] = (
    Protocol(
        name="csv",
        words="one line a sample, in g: ax,ay,az or n,ax,ay,az",
        new_decoder=lambda: LineDecoder(csv_lines.parse_csv, csv_lines.EXPECTED),
        to_nominal_g=csv_lines.csv_to_g,
        limit_g=csv_lines.LIMIT_G,
    ),
    Protocol(
        name="adxl330",
        words="ADXL330 at 3.0 V, one line a sample, in 10-bit counts: n,x,y,z",
        new_decoder=lambda: LineDecoder(adxl330.parse_adxl330, adxl330.EXPECTED),
        to_nominal_g=adxl330.adxl330_to_g,
        limit_g=adxl330.LIMIT_G,
    ),
)

_BY_NAME = {known.name: known for known in PROTOCOLS}


def protocol(name: str) -> Protocol:
    """Return the protocol with this name.

    Raises:
        ConfigError: there is none; the text names the known ones and the likeliest.
    """
    found = _BY_NAME.get(name)
    if found is not None:
        return found
    near = difflib.get_close_matches(name.strip().lower(), _BY_NAME, n=1)
    hint = f"did you mean {near[0]!r}? " if near else ""
    known = ", ".join(sorted(_BY_NAME))
    raise ConfigError("sensor.protocol", name, f"no such protocol; {hint}known are: {known}")
