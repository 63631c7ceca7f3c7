"""A sensor that is taken off its arm and laid on a table. Pure."""

import math
from dataclasses import dataclass
from typing import Final

from gestureapp.simulation.sensor_model import ArmAction, Verb
from gestureapp.simulation.sensor_wire import Accel

LAID_IN_S: Final = 0.8
"""From the hand to the table."""
_SHAKE_G: Final = 0.3
_SHAKE_HZ: Final = 4.0

LYING: Final[dict[str, Accel]] = {
    "z-up": (0.0, 0.0, 1.0),
    "z-down": (0.0, 0.0, -1.0),
    "x-up": (1.0, 0.0, 0.0),
    "x-down": (-1.0, 0.0, 0.0),
    "y-up": (0.0, 1.0, 0.0),
    "y-down": (0.0, -1.0, 0.0),
}
"""How it can lie, by the axis that points up, and what it then feels in g."""


@dataclass(frozen=True, slots=True)
class Laid:
    """Being laid down, then lying still.

    Attributes:
        began_s: When the hand began to.
        lies_g: What it feels once it lies.
    """

    began_s: float
    lies_g: Accel

    @classmethod
    def by(cls, action: ArmAction, t_s: float) -> "Laid | None":
        """What an action that begins now makes of it; None when it is worn from then on."""
        if action.verb is not Verb.LIE:
            return None
        return cls(t_s, _tilted(LYING[action.what], math.radians(action.askew_deg)))

    def accel_g(self, t_s: float) -> Accel:
        """True specific force in g."""
        left = 1.0 - min(1.0, max(0.0, (t_s - self.began_s) / LAID_IN_S))
        shake = _SHAKE_G * math.sin(2.0 * math.pi * _SHAKE_HZ * t_s)
        x, y, z = (value + left * (shake + 0.4 - 0.4 * value) for value in self.lies_g)
        return x, y, z


def _tilted(up: Accel, angle: float) -> Accel:
    """Turned by this angle towards the next axis: X towards Y, Y towards Z, Z towards X."""
    x, y, z = up
    c, s = math.cos(angle), math.sin(angle)
    return c * x + s * z, c * y + s * x, c * z + s * y
