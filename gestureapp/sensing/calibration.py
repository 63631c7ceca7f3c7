"""A frame's raw values to g: nominal scale, limit, then the sensor's own errors. Pure."""

from dataclasses import dataclass

from gestureapp.sensing.lines import FIRST_BYTES
from gestureapp.sensing.protocols import Protocol
from gestureapp.sensing.values import Frame, Impossible

Vector = tuple[float, float, float]
Matrix = tuple[Vector, Vector, Vector]

_IDENTITY: Matrix = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


@dataclass(frozen=True, slots=True)
class Calibration:
    """One sensor's own errors: the specific force is ``matrix`` times (nominal - ``offset_g``).

    Attributes:
        offset_g: Reading at zero g, x, y, z, in g of the nominal scale.
        matrix: Gain on the diagonal, cross-axis beside it, rows x, y, z.
    """

    offset_g: Vector = (0.0, 0.0, 0.0)
    matrix: Matrix = _IDENTITY

    def applied(self, nominal_g: Vector) -> Vector:
        """The specific force, x, y, z in g, behind a reading of the nominal scale."""
        (x, y, z), (ox, oy, oz) = nominal_g, self.offset_g
        x, y, z = x - ox, y - oy, z - oz
        (a, b, c), (d, e, f), (g, h, i) = self.matrix
        return (a * x + b * y + c * z, d * x + e * y + f * z, g * x + h * y + i * z)


NOMINAL = Calibration()
"""As the data sheet says: a particular ADXL330 may be 10 % off."""

_AXES = "XYZ"


def accel_of(frame: Frame, protocol: Protocol, calibration: Calibration) -> Vector | Impossible:
    """The calibrated acceleration in a frame, in g; or why no sensor can have measured it.

    The limit is the sensor's, so it is held against the nominal value, before the calibration.
    """
    nominal_g = protocol.to_nominal_g(frame.raw)
    for axis, value_g in zip(_AXES, nominal_g, strict=True):
        if not abs(value_g) <= protocol.limit_g:
            shown = ",".join(f"{raw:g}" for raw in frame.raw).encode()[:FIRST_BYTES]
            reason = f"{value_g:.1f} g on {axis}, the sensor can give {protocol.limit_g:g} g"
            return Impossible(0, shown, reason)
    return calibration.applied(nominal_g)
