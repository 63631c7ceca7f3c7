"""The emulated arm's encoder readings. Pure.

The pulses per degree of an HP6 are published nowhere that we found; ours are inventions inside the
range other Motomans have (450 to 2400), so RPOSJ of the emulator is consistent with its position
but does not carry over to a real robot.
"""

from gestureapp.robot.hp6 import Joints

PULSES_PER_DEG: Joints = (1341.0, 1341.0, 1341.0, 1000.0, 1000.0, 622.0)


def pulses(joints: Joints) -> tuple[int, ...]:
    """Give the six encoder readings of joint angles in degrees."""
    return tuple(round(j * per_deg) for j, per_deg in zip(joints, PULSES_PER_DEG, strict=True))
