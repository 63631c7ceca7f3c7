from dataclasses import asdict, replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gestureapp.simulation.people import draw_people, draw_person, practised_person

DAILY = ("session", "reach_m", "duration_s", "strap_rad", "left_strap_rad", "level_rad", "offset_s")


def test_a_seed_gives_the_same_people_and_another_seed_others():
    assert draw_people(3, 5) == draw_people(3, 5)
    assert draw_people(3, 5)[0] != draw_people(3, 6)[0]


def test_asking_for_more_people_does_not_change_the_first():
    assert draw_people(5, 9)[:2] == draw_people(2, 9)


def test_people_of_one_set_differ():
    people = draw_people(4, 5)

    assert len({person.duration_s for person in people}) == 4
    assert [person.name for person in people] == ["p1", "p2", "p3", "p4"]


@pytest.mark.parametrize("draw", [draw_person, practised_person])
def test_another_day_drifts_but_is_the_same_person(draw):
    first, second = draw(5, 0, 1), draw(5, 0, 2)

    changed = {name for name in asdict(first) if getattr(first, name) != getattr(second, name)}
    assert changed == set(DAILY)
    assert replace(second, **{name: getattr(first, name) for name in DAILY}) == first


def test_the_drift_of_a_day_is_of_degrees_and_milliseconds():
    days = [draw_person(5, 0, session) for session in range(1, 201)]

    strap_deg = np.degrees([person.strap_rad[0] for person in days])
    offsets_ms = np.array([person.offset_s for person in days]) * 1000.0
    assert np.std(strap_deg) == pytest.approx(2.0, rel=0.2)
    assert np.std(offsets_ms) == pytest.approx(5.0, rel=0.2)


@settings(max_examples=50, deadline=None)
@given(st.integers(0, 2**32), st.integers(0, 50), st.integers(1, 50))
def test_everybody_could_exist(seed, index, session):
    person = draw_person(seed, index, session)

    assert all(0.1 < reach < 0.5 for reach in person.reach_m)
    assert 0.25 < person.duration_s < 0.75
    assert 0.015 <= person.offset_spread_s <= 0.045
    assert abs(person.offset_s) < 0.15
    assert 0.9 <= min(person.right_sensor.gain) <= max(person.right_sensor.gain) <= 1.1


def peak_g(length_m: float, duration_s: float) -> float:
    """Of a minimum-jerk movement."""
    return 10.0 / np.sqrt(3.0) * length_m / duration_s**2 / 9.80665


@settings(max_examples=50, deadline=None)
@given(st.integers(0, 2**32), st.integers(0, 50))
def test_everybody_is_as_quick_as_hands_are_and_within_the_sensors_range(seed, index):
    person = draw_person(seed, index)

    assert all(0.15 < peak_g(reach, person.duration_s) < 3.0 for reach in person.reach_m)
    assert 0.1 < peak_g(person.yaw_radius_m * person.yaw_rad, person.yaw_s) < 2.0


@settings(max_examples=50, deadline=None)
@given(st.integers(0, 2**32), st.integers(0, 50))
def test_ordinary_people_turn_about_z_mostly_from_the_elbow(seed, index):
    person = draw_person(seed, index)

    assert 0.6 * person.forearm_m < person.yaw_radius_m < person.forearm_m
    assert practised_person(seed, index).yaw_radius_m < 0.1


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 2**32))
def test_a_practised_person_is_steadier_than_anybody(seed):
    practised, ordinary = practised_person(seed), draw_person(seed)

    assert practised.offset_spread_s == pytest.approx(0.006)
    assert -0.05 < practised.offset_s < 0.0
    assert practised.variation < ordinary.variation
    assert practised.tremor_g <= ordinary.tremor_g
