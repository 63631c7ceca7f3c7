"""An emulated sensor's wearer: a simulated arm and the errors of the accelerometer on it. Pure.

The sensor can also be taken off and laid on a table, as for its calibration.
"""

import numpy as np

from gestureapp.sensing.values import ArmPosture, Side
from gestureapp.simulation.arm import LeftArm, RightArm
from gestureapp.simulation.laid import Laid
from gestureapp.simulation.people import Person, draw_person, practised_person
from gestureapp.simulation.sensor_model import ArmAction, Verb, Wearer
from gestureapp.simulation.sensor_wire import Accel


class LeftWearer:
    """The left arm: takes postures. Owned by the emulator's loop."""

    def __init__(self, person: Person, seed: int) -> None:
        self._arm = LeftArm(person, seed)
        self._sensor = person.left_sensor
        self._rng = np.random.default_rng([seed, 1])
        self._laid: Laid | None = None

    def accel_g(self, t_s: float) -> Accel:
        """What the sensor reads, in g."""
        truth = self._laid.accel_g(t_s) if self._laid else self._arm.accel_g(t_s)
        x, y, z = self._sensor.read(np.array(truth), self._rng).tolist()
        return x, y, z

    def begin(self, action: ArmAction, t_s: float) -> None:
        """Take a posture, or lay the sensor down; anything else means stop."""
        self._laid = Laid.by(action, t_s)
        if self._laid is not None:
            return
        start = action == ArmAction(Verb.TAKE, ArmPosture.START.value)
        self._arm.take(ArmPosture.START if start else ArmPosture.STOP, t_s)


class RightWearer:
    """The right arm: makes gestures. Owned by the emulator's loop."""

    def __init__(self, person: Person, seed: int) -> None:
        self._arm = RightArm(person, seed)
        self._sensor = person.right_sensor
        self._rng = np.random.default_rng([seed, 2])
        self._laid: Laid | None = None

    def accel_g(self, t_s: float) -> Accel:
        """What the sensor reads, in g."""
        truth = self._laid.accel_g(t_s) if self._laid else self._arm.accel_g(t_s)
        x, y, z = self._sensor.read(np.array(truth), self._rng).tolist()
        return x, y, z

    def begin(self, action: ArmAction, t_s: float) -> None:
        """Perform a gesture, or lay the sensor down; anything else means rest."""
        self._laid = Laid.by(action, t_s)
        if self._laid is not None:
            return
        if action.verb is Verb.PERFORM:
            self._arm.perform(action.what, t_s, action.hold_s, action.back_s)
        else:
            self._arm.rest(t_s)


def person_of(seed: int, session: int, is_practised: bool) -> Person:
    """The first person of a seed, trained operator or not, on the day ``session``."""
    draw = practised_person if is_practised else draw_person
    return draw(seed, session=session)


def wearer_of(side: Side, person: Person, seed: int) -> Wearer:
    """This person's arm on that side; ``seed`` is the chance in how gestures and noise vary."""
    return LeftWearer(person, seed) if side is Side.LEFT else RightWearer(person, seed)
