"""The sensors' protocols by name: four that are built in, and what plug-ins add."""

import difflib
import functools
import logging
from collections.abc import Callable
from dataclasses import dataclass

from gestureapp.errors import ConfigError
from gestureapp.sensing import adxl330, binary, csv_lines, witmotion
from gestureapp.sensing.decoder import Decoder, LineDecoder

log = logging.getLogger(__name__)


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


BUILT_IN: tuple[Protocol, ...] = (
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
    Protocol(
        name="witmotion",
        words="WitMotion sensors such as the BWT901CL, set to 16 g and 100 Hz",
        new_decoder=witmotion.WitmotionDecoder,
        to_nominal_g=witmotion.witmotion_to_g,
        limit_g=witmotion.LIMIT_G,
    ),
    Protocol(
        name="binary",
        words="sensors with our firmware: checked frames, with name and battery",
        new_decoder=binary.BinaryDecoder,
        to_nominal_g=binary.binary_to_g,
        limit_g=binary.LIMIT_G,
    ),
)


def protocols() -> tuple[Protocol, ...]:
    """Every protocol there is: the built-in ones, then those of the plug-ins by name.

    The first call imports the plug-ins; any thread.
    """
    return _known()[0]


def plug_in_findings() -> tuple[str, ...]:
    """What was wrong with plug-ins, one line each with cause and remedy; they are left out."""
    return _known()[1]


def protocol(name: str) -> Protocol:
    """Return the protocol with this name.

    Raises:
        ConfigError: there is none; the text names the known ones and the likeliest.
    """
    by_name = {known.name: known for known in BUILT_IN}
    if name not in by_name:  # nothing foreign is imported for what is built in
        by_name = {known.name: known for known in protocols()}
    found = by_name.get(name)
    if found is not None:
        return found
    near = difflib.get_close_matches(name.strip().lower(), by_name, n=1)
    hint = f"did you mean {near[0]!r}? " if near else ""
    known = ", ".join(sorted(by_name))
    raise ConfigError("sensor.protocol", name, f"no such protocol; {hint}known are: {known}")


@functools.cache
def _known() -> tuple[tuple[Protocol, ...], tuple[str, ...]]:
    # Late: plug-ins import this module, and most cells have none.
    from gestureapp.sensing.plug_ins import installed_plug_ins

    added, findings = installed_plug_ins({known.name for known in BUILT_IN})
    for finding in findings:
        log.info("%s", finding)  # the command line says it aloud
    return (*BUILT_IN, *added), findings
