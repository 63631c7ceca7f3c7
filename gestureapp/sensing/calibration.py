"""A frame's raw values to g: nominal scale, limit, then the sensor's own errors. Pure."""

from gestureapp.config import SensorSettings
from gestureapp.sensing.lines import FIRST_BYTES
from gestureapp.sensing.protocols import Protocol
from gestureapp.sensing.values import Frame, Impossible

Vector = tuple[float, float, float]

_AXES = "XYZ"


def calibrate(nominal_g: Vector, settings: SensorSettings) -> Vector:
    """Take offset, then gain, out of a reading: (nominal - offset) * gain, axis by axis, in g."""
    (x, y, z), (ox, oy, oz), (kx, ky, kz) = nominal_g, settings.offset, settings.gain
    return ((x - ox) * kx, (y - oy) * ky, (z - oz) * kz)


def accel_of(frame: Frame, protocol: Protocol, settings: SensorSettings) -> Vector | Impossible:
    """The calibrated acceleration in a frame, in g; or why no sensor can have measured it.

    The limit is the sensor's, so it is held against the nominal value, before the calibration.
    """
    nominal_g = protocol.to_nominal_g(frame.raw)
    for axis, value_g in zip(_AXES, nominal_g, strict=True):
        if not abs(value_g) <= protocol.limit_g:
            shown = ",".join(f"{raw:g}" for raw in frame.raw).encode()[:FIRST_BYTES]
            reason = f"{value_g:.1f} g on {axis}, the sensor can give {protocol.limit_g:g} g"
            return Impossible(0, shown, reason)
    return calibrate(nominal_g, settings)
