"""Whose arm is simulated: how a person moves, and how a day differs from the next. Pure.

A seed alone fixes who the people are; the session's number fixes that day's drift.
"""

from dataclasses import dataclass, replace

import numpy as np

from gestureapp.simulation.accelerometer import Accelerometer, adxl330
from gestureapp.simulation.worn import SENSOR_BEFORE_WRIST_M

Triple = tuple[float, float, float]

WRIST_SHARE = (0.1, 0.4)
"""Share of a turn about Z that comes from the wrist, from person to person."""

_DRAW_PERSON = 1
_DRAW_DAY = 2
_DRAW_PRACTISED = 3


@dataclass(frozen=True, slots=True)
class Person:
    """How somebody makes gestures, on one day. Lengths in m, angles in rad, times in s.

    Attributes:
        name: ``p1``, ``p2`` …
        seed: The set of people this one is from.
        index: Number within the set, from 0.
        session: Which day this is, from 1.
        reach_m: Distance of the movements along X, Y and Z.
        duration_s: Duration of a movement.
        forearm_m: Elbow to sensor; the hand rises and sinks on an arc of this radius.
        wrist_keeps_level: Share of the forearm's swing that the wrist takes back, 0 to 1.
        yaw_radius_m: From the axis of a turn about Z (between elbow and wrist, see
            ``draw_person``) to the sensor.
        yaw_rad: Angle of a turn about Z.
        yaw_s: Duration of it.
        turn_rad: Angle of a turn about X or Y; few people reach a right angle.
        turn_s: Duration of it.
        bank: Roll that comes with a turn about Z, as a share of its angle.
        tilt_rad: Roll and pitch that come with a movement along X, Y, Z in the positive direction;
            six numbers, roll and pitch for each axis.
        skew_rad: Error of a movement's direction, two angles for each axis; six numbers.
        variation: Relative spread of reach, angle and duration from take to take.
        tilt_spread_rad: Spread of the tilts from take to take.
        skew_spread_rad: Spread of the directions from take to take.
        level_rad: Roll and pitch of a hand that its owner believes to be level.
        level_spread_rad: Spread of that from take to take.
        sway_rad: Slow wandering of the resting hand's tilt, root mean square.
        tremor_g: Tremor, root mean square per axis.
        strap_rad: Rotation of the right sensor on the arm, about X, Y, Z.
        left_strap_rad: The same of the left one.
        offset_s: Mean time from the activation to the onset of the right arm; negative is early.
        offset_spread_s: Standard deviation of it.
        left_turn_s: Duration of the left arm's turn from stop to start.
        left_turn_rad: Angle of it.
        left_radius_m: From the axis that the left hand turns about (near the sensor) to the sensor.
        right_sensor: The right accelerometer.
        left_sensor: The left accelerometer.
    """

    name: str
    seed: int
    index: int
    session: int
    reach_m: Triple
    duration_s: float
    forearm_m: float
    wrist_keeps_level: float
    yaw_radius_m: float
    yaw_rad: float
    yaw_s: float
    turn_rad: float
    turn_s: float
    bank: float
    tilt_rad: tuple[float, ...]
    skew_rad: tuple[float, ...]
    variation: float
    tilt_spread_rad: float
    skew_spread_rad: float
    level_rad: tuple[float, float]
    level_spread_rad: float
    sway_rad: float
    tremor_g: float
    strap_rad: Triple
    left_strap_rad: Triple
    offset_s: float
    offset_spread_s: float
    left_turn_s: float
    left_turn_rad: float
    left_radius_m: float
    right_sensor: Accelerometer
    left_sensor: Accelerometer


def draw_person(seed: int, index: int = 0, session: int = 1) -> Person:
    """One ordinary person: number ``index`` of the set ``seed``, on the day ``session``.

    Sources: body lengths from Winter, Biomechanics and Motor Control of Human Movement, table 4.1
    (forearm 0.146 and half the hand 0.055 of 1.55 to 1.95 m); physiological tremor of 8 to 12 Hz
    after Elble and Koller, Tremor (1990), with 5 to 15 mg assumed for an arm held out; 15 to 45 ms
    of spread between the arms is the range that the project's requirements name. Assumptions: reach
    and duration (quick gestures of a hand's length or two, whose acceleration peaks at 0.4 to 1.6
    g), and tilts, skews and straps of a few degrees (what an elastic strap and a person without a
    spirit level allow).

    Turns about Z: a wrist turns a flat hand by some 20 degrees to the thumb's side and 35 to the
    other (Boone and Azen, Normal range of motion of joints in male subjects, J. Bone Joint Surg.
    61-A (1979) 756), so most of 45 to 75 degrees is the forearm swung sideways about the elbow, by
    turning the upper arm. With a share w from the wrist, the sensor moves as on a circle of radius
    (1 - w) forearm + w (sensor before wrist): 0.2 to 0.35 m. As the whole forearm moves, it takes
    0.42 to 0.62 s (assumed; the peak at the sensor is then like that of a movement).
    """
    return _on_day(_draw_habit(seed, index, session), 1.0)


def practised_person(seed: int, index: int = 0, session: int = 1) -> Person:
    """A trained operator: as ``draw_person``, but quick, straight, level and in time.

    The right arm starts a little before the activation and within about 6 ms of its habit; a turn
    about Z is made on the spot, the elbow giving way to the outside, so that its axis stands close
    to the wrist and it is clearly weaker than a movement to the side; the sensors sit where they
    were fixed with care and have been calibrated. For the demonstration.
    """
    rng = np.random.default_rng([seed, index, _DRAW_PRACTISED])
    uniform, normal = rng.uniform, rng.normal
    ordinary = _draw_habit(seed, index, session)
    trained = replace(
        ordinary,
        reach_m=(uniform(0.26, 0.32), uniform(0.26, 0.32), uniform(0.24, 0.30)),
        duration_s=uniform(0.38, 0.42),
        wrist_keeps_level=uniform(0.85, 0.95),
        yaw_radius_m=uniform(0.07, 0.08),
        yaw_rad=np.radians(uniform(55.0, 60.0)),
        yaw_s=uniform(0.34, 0.38),
        turn_rad=np.radians(uniform(82.0, 90.0)),
        turn_s=uniform(0.30, 0.36),
        bank=normal(0.0, 0.03),
        tilt_rad=tuple(np.radians(normal(0.0, 2.0, 6)).tolist()),
        skew_rad=tuple(np.radians(normal(0.0, 2.0, 6)).tolist()),
        variation=0.04,
        tilt_spread_rad=np.radians(1.0),
        skew_spread_rad=np.radians(2.0),
        level_rad=(np.radians(normal(0.0, 0.8)), np.radians(normal(0.0, 0.8))),
        level_spread_rad=np.radians(0.6),
        sway_rad=np.radians(0.3),
        tremor_g=0.005,
        strap_rad=_angles(rng, 0.8),
        left_strap_rad=_angles(rng, 0.8),
        offset_s=-0.030,
        offset_spread_s=0.006,
        left_turn_s=uniform(0.42, 0.46),
        left_turn_rad=np.radians(uniform(86.0, 92.0)),
        right_sensor=_calibrated(ordinary.right_sensor),
        left_sensor=_calibrated(ordinary.left_sensor),
    )
    return _on_day(trained, 0.3)


def draw_people(count: int, seed: int, session: int = 1) -> tuple[Person, ...]:
    """The first ``count`` ordinary people of the set ``seed``, on the day ``session``."""
    return tuple(draw_person(seed, index, session) for index in range(count))


def _draw_habit(seed: int, index: int, session: int) -> Person:
    rng = np.random.default_rng([seed, index, _DRAW_PERSON])
    uniform, normal = rng.uniform, rng.normal
    # In the order of the attributes: what is drawn later stays the same.
    reach_m = (uniform(0.20, 0.35), uniform(0.20, 0.35), uniform(0.16, 0.30))
    duration_s = uniform(0.36, 0.56)
    forearm_m = uniform(0.30, 0.38)
    return Person(
        name=f"p{index + 1}",
        seed=seed,
        index=index,
        session=session,
        reach_m=reach_m,
        duration_s=duration_s,
        forearm_m=forearm_m,
        wrist_keeps_level=uniform(0.6, 0.9),
        yaw_radius_m=_yaw_radius_m(forearm_m, uniform(*WRIST_SHARE)),
        yaw_rad=np.radians(uniform(45.0, 75.0)),
        yaw_s=uniform(0.42, 0.62),
        turn_rad=np.radians(uniform(70.0, 90.0)),
        turn_s=uniform(0.30, 0.45),
        bank=normal(0.0, 0.12),
        tilt_rad=tuple(np.radians(normal(0.0, 5.0, 6)).tolist()),
        skew_rad=tuple(np.radians(normal(0.0, 6.0, 6)).tolist()),
        variation=uniform(0.08, 0.14),
        tilt_spread_rad=np.radians(uniform(2.0, 5.0)),
        skew_spread_rad=np.radians(uniform(4.0, 8.0)),
        level_rad=(np.radians(normal(0.0, 2.5)), np.radians(normal(0.0, 2.5))),
        level_spread_rad=np.radians(uniform(1.0, 2.5)),
        sway_rad=np.radians(uniform(0.3, 1.0)),
        tremor_g=uniform(0.005, 0.015),
        strap_rad=_angles(rng, 3.0),
        left_strap_rad=_angles(rng, 3.0),
        offset_s=normal(-0.015, 0.015),
        offset_spread_s=uniform(0.015, 0.045),
        left_turn_s=uniform(0.42, 0.60),
        left_turn_rad=np.radians(uniform(80.0, 95.0)),
        left_radius_m=uniform(0.02, 0.05),
        right_sensor=adxl330(rng),
        left_sensor=adxl330(rng),
    )


def _yaw_radius_m(forearm_m: float, wrist_share: float) -> float:
    """From the axis of a turn about Z to the sensor, when the wrist makes this share of it."""
    return (1.0 - wrist_share) * forearm_m + wrist_share * SENSOR_BEFORE_WRIST_M


def _on_day(person: Person, scale: float) -> Person:
    """The same person with a day's strap, level, vigour and timing; scale 1 is ordinary."""
    rng = np.random.default_rng([person.seed, person.index, person.session, _DRAW_DAY])
    vigour = 1.0 + scale * rng.normal(0.0, 0.05)
    return replace(
        person,
        reach_m=_scaled(person.reach_m, vigour),
        duration_s=person.duration_s * (1.0 + scale * rng.normal(0.0, 0.04)),
        strap_rad=_moved(person.strap_rad, rng, 2.0 * scale),
        left_strap_rad=_moved(person.left_strap_rad, rng, 2.0 * scale),
        level_rad=(
            person.level_rad[0] + scale * np.radians(rng.normal(0.0, 1.0)),
            person.level_rad[1] + scale * np.radians(rng.normal(0.0, 1.0)),
        ),
        offset_s=person.offset_s + scale * rng.normal(0.0, 0.005),
    )


def _angles(rng: np.random.Generator, spread_deg: float) -> Triple:
    x, y, z = np.radians(rng.normal(0.0, spread_deg, 3)).tolist()
    return x, y, z


def _moved(angles: Triple, rng: np.random.Generator, spread_deg: float) -> Triple:
    dx, dy, dz = _angles(rng, spread_deg)
    return angles[0] + dx, angles[1] + dy, angles[2] + dz


def _scaled(values: Triple, factor: float) -> Triple:
    return values[0] * factor, values[1] * factor, values[2] * factor


def _calibrated(sensor: Accelerometer) -> Accelerometer:
    """The same part after a calibration that left a hundredth in gain and offset."""
    return replace(
        sensor,
        offset_g=_scaled(sensor.offset_g, 0.2),
        gain=(
            1.0 + (sensor.gain[0] - 1.0) * 0.2,
            1.0 + (sensor.gain[1] - 1.0) * 0.2,
            1.0 + (sensor.gain[2] - 1.0) * 0.2,
        ),
    )
