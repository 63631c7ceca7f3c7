"""Simulated arms: gestures in, true specific force at the strapped-on sensor out. Pure.

Signs. Specific force in the sensor's axes (+X forward, +Y left, +Z up, right-handed), so a level
hand at rest reads (0, 0, 1). For turns about Y the paper (IV.B, figure 7) says which way is which:
RY- reads ax = -1 g and RY+ reads ax = +1 g; with right-handed axes and specific force RY+ is then
the *negative* right-handed turn about Y (fingers up). For RX the paper gives no sign; RX+ here is
the right-handed turn about X (left edge of the hand up) and reads ay = +1 g, RX- reads ay = -1 g.
RZ+ turns the hand to the left. The left arm's start posture reads ax = -1 g (paper, figure 8).
"""

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from gestureapp.config import SiteSettings
from gestureapp.gestures import Gesture, Kind, gesture, is_held
from gestureapp.sensing.posture import PostureDetector
from gestureapp.sensing.values import ArmPosture
from gestureapp.simulation.motion import (
    N_COORDINATES,
    PEAK_ACCELERATION,
    Coordinate,
    Motion,
    Submovement,
)
from gestureapp.simulation.people import Person
from gestureapp.simulation.worn import STANDARD_GRAVITY, WornSensor

F64 = NDArray[np.float64]
Triple = tuple[float, float, float]

HOLD_S = 0.7
"""How long the end point of a movement is held before the hand goes back by itself: past the end of
a take, which is 1.0 s after the activation."""
RETURN_PEAK_G = 0.06
"""Highest acceleration on the way back: well below what counts as a movement (0.15 g)."""
TURN_BACK_S = 1.2
"""Least duration of the way back from a posture; two to four times slower than the gesture."""
POSTURE_SETTLED_S = 0.15
"""A roll or pitch posture is held for at least this long when the activation comes (paper: it is a
static measurement)."""
_PHASES = 10
_RIGHT = 1
_LEFT = 2


class RightArm:
    """The right arm with its sensor. Owned by one thread; ask it with increasing times.

    Args:
        person: Whose arm it is.
        seed: Takes with the same person and seed are the same; None takes fresh chance.
    """

    def __init__(self, person: Person, seed: int | None = None) -> None:
        self.person = person
        self._rng = _chance(person, seed, _RIGHT)
        self._worn = WornSensor(person.strap_rad, person.tremor_g, person.sway_rad, self._rng)
        self._worn.yaw_radius_m = person.yaw_radius_m
        self._worn.swing_radius_m = person.forearm_m
        self._motion = Motion()
        self._home = np.zeros(N_COORDINATES)
        self._find_level(-math.inf)

    def perform(
        self, label: str, t_s: float, hold_s: float | None = None, back_s: float | None = None
    ) -> None:
        """Start the movement of a gesture at this time, now or later.

        What was asked for and has not begun by then (also the way back) is dropped. A movement is
        made along the hand's own axes, so it reads the same after a turn about Z. The hand goes
        back by itself after a movement; a posture is held until ``rest`` or the next gesture.

        Args:
            label: Which gesture.
            t_s: When it begins.
            hold_s: How long its end is held before the hand goes back by itself, also from a
                posture; None is the usual.
            back_s: Duration of the way back; None is slow.

        Raises:
            KeyError: no gesture has this label.
        """
        wanted = gesture(label)
        self._motion.cancel_from(t_s)
        part = self._plan(wanted, t_s)
        self._motion.add(part)
        if hold_s is None and wanted.kind is Kind.MOVEMENT:
            hold_s = HOLD_S
        if hold_s is not None:
            self._go_home(part.start_s + part.duration_s + hold_s, back_s)

    def perform_for(self, label: str, activation_s: float) -> float:
        """Start a gesture so that it fits an activation expected at this time.

        Roll and pitch postures are already held then; everything else begins at the activation plus
        this person's coordination offset, drawn anew each time.

        Returns:
            When the movement begins; it may lie ``lead_s`` before the activation.

        Raises:
            KeyError: no gesture has this label.
        """
        person = self.person
        if is_held(label):
            start_s = activation_s - self.lead_s(label)
        else:
            start_s = activation_s + self._rng.normal(person.offset_s, person.offset_spread_s)
        self.perform(label, start_s)
        return start_s

    def lead_s(self, label: str) -> float:
        """How long before the activation the right arm may have to begin; at least 0.

        A virtual operator calls ``perform_for`` no later than this before the activation.

        Raises:
            KeyError: no gesture has this label.
        """
        person = self.person
        if is_held(label):
            return person.turn_s * (1.0 + 3.0 * person.variation) + POSTURE_SETTLED_S
        return max(0.0, 4.0 * person.offset_spread_s - person.offset_s)

    def rest(self, t_s: float) -> None:
        """Go slowly back to a level rest from this time on.

        What was asked for and has not begun by then is dropped.
        """
        self._motion.cancel_from(t_s)
        self._go_home(t_s)

    def accel_g(self, t_s: float) -> Triple:
        """True specific force at the sensor at this time, in g.

        Times may not go back by more than 1 s.
        """
        self._motion.settle(t_s - 1.0)
        x, y, z = self.accel_at(np.array([t_s]))[0].tolist()
        return x, y, z

    def accel_at(self, times_s: F64) -> F64:
        """The same for times of shape (n,): shape (n, 3), in g."""
        return self._worn.accel(self._motion, times_s)

    def is_at_rest(self, t_s: float) -> bool:
        """Whether nothing moves at this time and the hand is level where it began."""
        q, v, _ = self._motion.at(np.array([t_s]))
        turned = q[0, Coordinate.ROLL : Coordinate.YAW + 1] - self._home[Coordinate.ROLL :]
        return bool(np.all(np.abs(v) < 1e-3) and np.all(np.abs(turned) < np.radians(5.0)))

    def _plan(self, wanted: Gesture, t_s: float) -> Submovement:
        person, goal = self.person, self._motion.goal
        size = 1.0 + np.clip(self._rng.normal(0.0, person.variation), -0.4, 0.4)
        pace = 1.0 + np.clip(self._rng.normal(0.0, person.variation), -0.3, 0.3)
        change = np.zeros(N_COORDINATES)
        change[Coordinate.ROLL :] = self._home[Coordinate.ROLL :] - goal[Coordinate.ROLL :]
        change[Coordinate.YAW] = 0.0
        if wanted.kind is Kind.MOVEMENT:
            change += self._translation(wanted, size, float(goal[Coordinate.YAW]))
            duration_s = person.duration_s * pace
        elif wanted.axis == 2:
            yaw = wanted.sign * person.yaw_rad * size
            change[Coordinate.YAW] = yaw
            change[Coordinate.ROLL] += person.bank * yaw + self._slip(person.tilt_spread_rad / 2)
            change[Coordinate.PITCH] += self._slip(person.tilt_spread_rad / 2)
            duration_s = person.yaw_s * pace
        else:
            change += self._turn(wanted, size)
            duration_s = person.turn_s * min(pace, 1.0 + 3.0 * person.variation)
        return Submovement(t_s, float(duration_s), tuple(change.tolist()))

    def _translation(self, wanted: Gesture, size: float, heading_rad: float) -> F64:
        """A step along one axis of the hand, with what a person adds to it unasked."""
        person, axis = self.person, wanted.axis
        length = wanted.sign * person.reach_m[axis] * size
        step = np.zeros(3)
        step[axis] = length
        for k, other in enumerate(a for a in range(3) if a != axis):
            error = person.skew_rad[2 * axis + k] + self._slip(person.skew_spread_rad)
            step[other] = length * math.tan(error)
        change = np.zeros(N_COORDINATES)
        c, s = math.cos(heading_rad), math.sin(heading_rad)
        change[Coordinate.X] = c * step[0] - s * step[1]
        change[Coordinate.Y] = s * step[0] + c * step[1]
        if axis == 2:
            swing = step[2] / person.forearm_m
            change[Coordinate.SWING] = swing
            change[Coordinate.PITCH] = -(1.0 - person.wrist_keeps_level) * swing
        else:
            change[Coordinate.Z] = step[2]
        tilt = person.tilt_rad[2 * axis : 2 * axis + 2]
        change[Coordinate.ROLL] += wanted.sign * tilt[0] + self._slip(person.tilt_spread_rad)
        change[Coordinate.PITCH] += wanted.sign * tilt[1] + self._slip(person.tilt_spread_rad)
        return change

    def _turn(self, wanted: Gesture, size: float) -> F64:
        """A turn about X or Y from level; the sign of RY is the paper's, see above."""
        person = self.person
        angle = wanted.sign * min(person.turn_rad * (1.0 + (size - 1.0) / 2.0), math.radians(100.0))
        change = np.zeros(N_COORDINATES)
        main, other = Coordinate.ROLL, Coordinate.PITCH
        if wanted.axis == 1:
            main, other, angle = other, main, -angle
        change[main] = angle
        change[other] = self._slip(2.0 * person.tilt_spread_rad)
        return change

    def _go_home(self, t_s: float, back_s: float | None = None) -> None:
        self._find_level(t_s)
        change = self._home - self._motion.goal
        way_m = (
            float(np.linalg.norm(change[:3]))
            + abs(change[Coordinate.SWING]) * self.person.forearm_m
        )
        way_m += abs(change[Coordinate.YAW]) * self.person.yaw_radius_m
        duration_s = _way_back_s(way_m) if back_s is None else back_s
        self._motion.add(Submovement(t_s, duration_s, tuple(change.tolist())))

    def _find_level(self, t_s: float) -> None:
        """Choose what this person takes for level next; at the very start, be there."""
        spread = self.person.level_spread_rad
        self._home[Coordinate.ROLL] = self.person.level_rad[0] + self._slip(spread)
        self._home[Coordinate.PITCH] = self.person.level_rad[1] + self._slip(spread)
        if math.isinf(t_s):
            self._motion.add(Submovement(-1e9, 1.0, tuple(self._home.tolist())))

    def _slip(self, spread: float) -> float:
        return float(self._rng.normal(0.0, spread))


class LeftArm:
    """The left arm with its sensor: level is stop, turned about Y with ax = -1 g is start.

    Owned by one thread; ask it with increasing times. Arguments as for ``RightArm``.
    """

    def __init__(self, person: Person, seed: int | None = None) -> None:
        self.person = person
        self._rng = _chance(person, seed, _LEFT)
        self._worn = _left_worn(person, self._rng)
        self._motion = Motion()

    def take(self, posture: ArmPosture, t_s: float) -> None:
        """Begin to turn into a posture at this time; NEITHER stops half way between the two.

        What was asked for and has not begun by then is dropped.
        """
        self._motion.cancel_from(t_s)
        spread = (
            self.person.variation / 4.0
        )  # the turn that both arms are timed by is well practised
        wiggle = spread * np.clip(self._rng.standard_normal(), -2.0, 2.0)
        self._motion.add(_left_turn(self.person, self._motion, posture, t_s, 1.0 + float(wiggle)))

    def accel_g(self, t_s: float) -> Triple:
        """True specific force at the sensor at this time, in g.

        Times may not go back by more than 1 s.
        """
        self._motion.settle(t_s - 1.0)
        x, y, z = self.accel_at(np.array([t_s]))[0].tolist()
        return x, y, z

    def accel_at(self, times_s: F64) -> F64:
        """The same for times of shape (n,): shape (n, 3), in g."""
        return self._worn.accel(self._motion, times_s)


def home_after_s(person: Person) -> float:
    """How long after the start of a movement the right hand is back at rest, at the latest."""
    longer = 1.0 + 3.0 * person.variation
    back_s = _way_back_s(max(person.reach_m) * longer)
    return person.duration_s * longer + HOLD_S + back_s


def start_seen_after_s(person: Person, rate_hz: float = 100.0) -> float:
    """From the moment the left arm begins to turn until its sensor shows the start posture.

    The mean over how the samples may fall, found with the detector that the cell uses, at its
    default angles and debounce, for a turn of this person's usual pace without tremor. A virtual
    operator adds this to the start of the left arm's turn to get the expected activation.
    """
    motion = Motion()
    motion.add(_left_turn(person, motion, ArmPosture.START, 0.0, 1.0))
    worn = _left_worn(replace(person, tremor_g=0.0, sway_rad=0.0), np.random.default_rng(0))
    n = math.ceil((2.0 * person.left_turn_s + 1.0) * rate_hz)
    seen_s = []
    for phase in (np.arange(_PHASES) + 0.5) / _PHASES:
        times_s = (np.arange(n) + phase) / rate_hz
        readings = person.left_sensor.without_noise(worn.accel(motion, times_s))
        seen_s.append(float(times_s[_first_start(readings)]))
    return float(np.mean(seen_s))


def _first_start(readings: F64) -> int:
    """Number of the first reading with which the start posture is seen; the last one if none is."""
    site = SiteSettings()
    detector = PostureDetector(
        site.posture_enter_deg, site.posture_leave_deg, site.posture_debounce
    )
    for number, (x, y, z) in enumerate(readings.tolist()):
        if detector.feed((x, y, z)) is ArmPosture.START:
            return number
    return len(readings) - 1


def _left_worn(person: Person, rng: np.random.Generator) -> WornSensor:
    worn = WornSensor(person.left_strap_rad, person.tremor_g, person.sway_rad, rng)
    worn.before_wrist_m = person.left_radius_m
    return worn


def _left_turn(
    person: Person, motion: Motion, posture: ArmPosture, t_s: float, pace: float
) -> Submovement:
    share = {ArmPosture.STOP: 0.0, ArmPosture.START: 1.0, ArmPosture.NEITHER: 0.5}[posture]
    change = np.zeros(N_COORDINATES)
    goal = share * person.left_turn_rad
    change[Coordinate.PITCH] = goal - motion.goal[Coordinate.PITCH]
    return Submovement(t_s, person.left_turn_s * pace, tuple(change.tolist()))


def _chance(person: Person, seed: int | None, side: int) -> np.random.Generator:
    if seed is None:
        return np.random.default_rng()
    return np.random.default_rng([person.seed, person.index, person.session, side, seed])


def _way_back_s(way_m: float) -> float:
    slow_s = math.sqrt(PEAK_ACCELERATION * way_m / (RETURN_PEAK_G * STANDARD_GRAVITY))
    return max(slow_s, TURN_BACK_S)
