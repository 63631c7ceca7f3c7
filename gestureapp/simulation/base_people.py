"""The simulated people and non-gestures that the shared base model learns from. Pure.

Ordinary people at three rates, and people outside the ordinary: quicker, more crooked and less
steady than ``draw_person`` draws them, because real hands are. Evaluations draw their people from
other seeds.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from gestureapp.gestures import LABELS
from gestureapp.recognition.takes import TakeSet
from gestureapp.recording.take_values import BEFORE_S
from gestureapp.simulation.negatives import make_negatives
from gestureapp.simulation.people import Person, Triple, draw_person
from gestureapp.simulation.takes import make_person_takes


@dataclass(frozen=True, slots=True)
class Crowd:
    """People who are drawn alike.

    Attributes:
        people: How many.
        takes: Takes of each gesture by each.
        rate_hz: Sample rate.
        is_wide: Outside the ordinary.
    """

    people: int
    takes: int
    rate_hz: float
    is_wide: bool = False


CROWDS = (
    Crowd(150, 8, 100.0),
    Crowd(80, 5, 50.0),
    Crowd(80, 5, 200.0),
    Crowd(160, 4, 100.0, is_wide=True),
    Crowd(160, 4, 50.0, is_wide=True),
    Crowd(60, 4, 200.0, is_wide=True),
)
NEGATIVES = ((5000, 100.0), (1250, 50.0), (1250, 200.0))
"""How many takes of what is no gesture, at which rate."""


def crowd_takes(seed: int, number: int) -> TakeSet:
    """The takes of ``CROWDS[number]``.

    Args:
        seed: Which people; crowds of one seed share nobody.
        number: Index of the crowd.
    """
    crowd = CROWDS[number]
    parts, users = [], []
    for index in range(crowd.people):
        person = draw_person(seed + number, index)
        if crowd.is_wide:
            person = wide(person, np.random.default_rng([seed, number, index]))
        found = make_person_takes(person, crowd.takes, crowd.rate_hz)
        parts += found
        users += [person.name] * len(found)
    labels = tuple(label for label in LABELS for _ in range(crowd.takes)) * crowd.people
    return TakeSet(
        samples=np.concatenate(parts),
        offsets=np.cumsum([0, *(len(part) for part in parts)]),
        labels=labels,
        activation=np.full(len(labels), round(BEFORE_S * crowd.rate_hz)),
        user=tuple(users),
        rate_hz=crowd.rate_hz,
    )


def base_negatives(seed: int) -> Iterator[TakeSet]:
    """What is no gesture, at each rate."""
    for count, rate_hz in NEGATIVES:
        yield make_negatives(count, seed, rate_hz)


def wide(person: Person, rng: np.random.Generator) -> Person:
    """The same person, outside the ordinary: up to three times as quick, as crooked, as shaky."""
    uniform = rng.uniform
    reach = uniform(0.6, 1.2)
    x, y, z = person.reach_m
    return replace(
        person,
        duration_s=person.duration_s * uniform(0.35, 1.0),
        reach_m=(x * reach, y * reach, z * reach),
        yaw_s=person.yaw_s * uniform(0.5, 1.0),
        turn_s=person.turn_s * uniform(0.5, 1.2),
        skew_rad=_times(person.skew_rad, uniform(1.0, 1.8)),
        skew_spread_rad=person.skew_spread_rad * uniform(1.0, 1.8),
        tilt_rad=_times(person.tilt_rad, uniform(1.0, 2.0)),
        tilt_spread_rad=person.tilt_spread_rad * uniform(1.0, 2.0),
        variation=uniform(0.08, 0.2),
        tremor_g=uniform(0.005, 0.03),
        strap_rad=_strap(person.strap_rad, uniform(1.0, 3.0)),
    )


def _times(values: tuple[float, ...], factor: float) -> tuple[float, ...]:
    return tuple(value * factor for value in values)


def _strap(values: Triple, factor: float) -> Triple:
    return values[0] * factor, values[1] * factor, values[2] * factor
