"""An emulated sensor's wearer: a simulated arm and the errors of the accelerometer on it. Pure."""

import numpy as np

from gestureapp.sensing.values import ArmPosture, Side
from gestureapp.simulation.arm import LeftArm, RightArm
from gestureapp.simulation.people import Person, draw_person, practised_person
from gestureapp.simulation.sensor_model import ArmAction, Verb, Wearer
from gestureapp.simulation.sensor_wire import Accel


class LeftWearer:
    """The left arm: takes postures. Owned by the emulator's loop."""

    def __init__(self, person: Person, seed: int) -> None:
        self._arm = LeftArm(person, seed)
        self._sensor = person.left_sensor
        self._rng = np.random.default_rng([seed, 1])

    def accel_g(self, t_s: float) -> Accel:
        """What the sensor reads, in g."""
        x, y, z = self._sensor.read(np.array(self._arm.accel_g(t_s)), self._rng).tolist()
        return x, y, z

    def begin(self, action: ArmAction, t_s: float) -> None:
        """Take a posture; anything else means stop."""
        start = action == ArmAction(Verb.TAKE, ArmPosture.START.value)
        self._arm.take(ArmPosture.START if start else ArmPosture.STOP, t_s)


class RightWearer:
    """The right arm: makes gestures. Owned by the emulator's loop."""

    def __init__(self, person: Person, seed: int) -> None:
        self._arm = RightArm(person, seed)
        self._sensor = person.right_sensor
        self._rng = np.random.default_rng([seed, 2])

    def accel_g(self, t_s: float) -> Accel:
        """What the sensor reads, in g."""
        x, y, z = self._sensor.read(np.array(self._arm.accel_g(t_s)), self._rng).tolist()
        return x, y, z

    def begin(self, action: ArmAction, t_s: float) -> None:
        """Perform a gesture; anything else means rest."""
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
