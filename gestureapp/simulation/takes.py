"""Takes by simulated people, as their sensors would have sent them. Pure."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from gestureapp.gestures import LABELS
from gestureapp.recognition.takes import TakeSet
from gestureapp.recording.take_values import AFTER_S, BEFORE_S
from gestureapp.simulation.accelerometer import quantised
from gestureapp.simulation.arm import RightArm
from gestureapp.simulation.people import Person, draw_person, practised_person

_ACTIVATION_S = 2.0
_DRAW_TAKES = 4


def make_takes(
    people: int,
    takes: int,
    seed: int,
    session: int = 1,
    rate_hz: float = 100.0,
    practised: bool = False,
    gestures: Sequence[str] = LABELS,
) -> TakeSet:
    """Let simulated people repeat gestures.

    Args:
        people: How many people; the seed alone fixes who they are.
        takes: Takes of each gesture by each person.
        seed: Which set of people.
        session: Which day; fresh takes with that day's drift.
        rate_hz: Sample rate.
        practised: Trained operators instead of ordinary people.
        gestures: Labels of those to repeat.

    Raises:
        ValueError: a number is not positive, the rate is not between 20 and 1000 Hz, or the
            gestures are none, unknown, or named twice.
    """
    if people < 1 or takes < 1 or session < 1 or seed < 0:
        raise ValueError("people, takes and session must be at least 1, and the seed at least 0")
    if not 20.0 <= rate_hz <= 1000.0:
        raise ValueError(f"the rate must lie between 20 and 1000 Hz, found {rate_hz}")
    _check_gestures(gestures)
    draw = practised_person if practised else draw_person
    parts: list[NDArray[np.float64]] = []
    labels: list[str] = []
    users: list[str] = []
    for index in range(people):
        person = draw(seed, index, session)
        parts += make_person_takes(person, takes, rate_hz, gestures)
        labels += [label for label in gestures for _ in range(takes)]
        users += [person.name] * (takes * len(gestures))
    return TakeSet(
        samples=np.concatenate(parts),
        offsets=np.cumsum([0, *(len(part) for part in parts)]),
        labels=tuple(labels),
        activation=np.full(len(labels), round(BEFORE_S * rate_hz)),
        user=tuple(users),
        session=(str(session),) * len(labels),
        rate_hz=rate_hz,
    )


def make_person_takes(
    person: Person, takes: int, rate_hz: float = 100.0, gestures: Sequence[str] = LABELS
) -> list[NDArray[np.float64]]:
    """One person's readings, shape (k, 3) in g: all takes of the first gesture, then of the next.

    They come in the steps of the converter behind the sensor, 9.8 mg.

    The right sensor's samples fall at random between those of the left, so the first of them at or
    after the activation is up to one sample late, as in the cell.
    """
    rng = np.random.default_rng([person.seed, person.index, person.session, _DRAW_TAKES])
    n_before, n_after = round(BEFORE_S * rate_hz), round(AFTER_S * rate_hz)
    ticks = np.arange(-n_before, n_after, dtype=np.float64)
    readings = []
    for number, label in enumerate(label for label in gestures for _ in range(takes)):
        arm = RightArm(person, number)
        arm.perform_for(label, _ACTIVATION_S)
        times_s = _ACTIVATION_S + (ticks + rng.uniform()) / rate_hz
        readings.append(quantised(person.right_sensor.read(arm.accel_at(times_s), rng)))
    return readings


def _check_gestures(gestures: Sequence[str]) -> None:
    unknown = [label for label in gestures if label not in LABELS]
    if not gestures or unknown or len(set(gestures)) != len(gestures):
        found = ", ".join(gestures) or "none"
        raise ValueError(f"gestures must be some of {', '.join(LABELS)}, each once; found {found}")
