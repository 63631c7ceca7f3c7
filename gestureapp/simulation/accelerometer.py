"""What an ADXL330 makes of a true specific force: offset, gain error, noise, saturation. Pure.

A line of the ``adxl330`` protocol can carry whole counts only; ``quantised`` gives what arrives.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gestureapp.simulation.sensor_wire import (
    ADXL330_STEPS,
    ADXL330_SUPPLY_V,
    ADXL330_V_PER_G,
)

F64 = NDArray[np.float64]

COUNTS_PER_G = ADXL330_V_PER_G * ADXL330_STEPS / ADXL330_SUPPLY_V
"""102.4."""

NOISE_G_SQRT_HZ = (280e-6, 280e-6, 350e-6)
"""Noise density of X, Y and Z in g per root hertz. Source: ADXL330 data sheet rev. A, table 1."""
SATURATION_G = 3.6
"""Typical measurement range; 3 g is its lowest. Source: as above."""
GAIN_LIMIT = 0.10
"""Sensitivity 270 to 330 mV/g around 300 mV/g. Source: as above, and the paper, II.A."""
GAIN_SPREAD = 0.04
"""Standard deviation assumed for parts inside that limit."""
OFFSET_SPREAD_G = 0.02
"""What is left of the zero-g bias of a part, some tenths of a volt at 0.3 V/g, after it has been
zeroed: 1 mg/K of drift (data sheet) makes 20 mg between a cold and a warm room."""


@dataclass(frozen=True, slots=True)
class Accelerometer:
    """One accelerometer as it came from the factory and was zeroed.

    Attributes:
        offset_g: Reading at zero g, per axis.
        gain: Reading per g, per axis; 1 is nominal.
        noise_g: Standard deviation of the noise of one reading, per axis.
    """

    offset_g: tuple[float, float, float] = (0.0, 0.0, 0.0)
    gain: tuple[float, float, float] = (1.0, 1.0, 1.0)
    noise_g: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def read(self, accel_g: F64, rng: np.random.Generator) -> F64:
        """Turn true specific force, shape (n, 3) or (3,), into readings of the same shape, in g."""
        noise = rng.standard_normal(accel_g.shape) * np.array(self.noise_g)
        return _clipped(self._scaled(accel_g) + noise)

    def without_noise(self, accel_g: F64) -> F64:
        """What ``read`` gives on average, within the range."""
        return _clipped(self._scaled(accel_g))

    def _scaled(self, accel_g: F64) -> F64:
        scaled: F64 = accel_g * np.array(self.gain) + np.array(self.offset_g)
        return scaled


def quantised(accel_g: F64) -> F64:
    """Readings as the 10-bit converter behind the sensor gives them: in steps of 9.8 mg."""
    rounded: F64 = np.rint(accel_g * COUNTS_PER_G) / COUNTS_PER_G
    return rounded


def adxl330(rng: np.random.Generator, bandwidth_hz: float = 50.0) -> Accelerometer:
    """Draw one part.

    Args:
        rng: Decides which part it is.
        bandwidth_hz: Of its output filter; half of the paper's 100 Hz. The noise of a reading is
            the density times the root of 1.6 times this. Source: data sheet, "Setting the
            bandwidth".
    """
    gain = 1.0 + np.clip(rng.normal(0.0, GAIN_SPREAD, 3), -GAIN_LIMIT, GAIN_LIMIT)
    offset = rng.normal(0.0, OFFSET_SPREAD_G, 3)
    noise = np.array(NOISE_G_SQRT_HZ) * np.sqrt(1.6 * bandwidth_hz)
    return Accelerometer(_triple(offset), _triple(gain), _triple(noise))


def _triple(values: F64) -> tuple[float, float, float]:
    x, y, z = (float(v) for v in values)
    return x, y, z


def _clipped(accel_g: F64) -> F64:
    clipped: F64 = np.clip(accel_g, -SATURATION_G, SATURATION_G)
    return clipped
