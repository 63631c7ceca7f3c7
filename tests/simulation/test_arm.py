from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gestureapp.config import SiteSettings
from gestureapp.gestures import GESTURES, LABELS, Kind
from gestureapp.sensing.posture import PostureDetector
from gestureapp.sensing.values import ArmPosture
from gestureapp.simulation.accelerometer import SATURATION_G, Accelerometer, adxl330
from gestureapp.simulation.arm import (
    HOLD_S,
    RETURN_PEAK_G,
    LeftArm,
    RightArm,
    start_seen_after_s,
)
from gestureapp.simulation.motion import PEAK_ACCELERATION
from gestureapp.simulation.people import draw_people, draw_person, practised_person

LEVEL = np.array([0.0, 0.0, 1.0])
MOVEMENTS = [g for g in GESTURES if g.kind is Kind.MOVEMENT]
HELD = [g for g in GESTURES if g.kind is Kind.POSTURE and g.axis != 2]


def ideal_person():
    """Somebody without tremor, tilt or error, whose sensors sit perfectly."""
    return replace(
        draw_person(1),
        reach_m=(0.3, 0.3, 0.3),
        duration_s=0.4,
        wrist_keeps_level=1.0,
        yaw_radius_m=0.15,
        yaw_rad=1.0,
        yaw_s=0.4,
        turn_rad=np.pi / 2,
        bank=0.0,
        tilt_rad=(0.0,) * 6,
        skew_rad=(0.0,) * 6,
        variation=0.0,
        tilt_spread_rad=0.0,
        skew_spread_rad=0.0,
        level_rad=(0.0, 0.0),
        level_spread_rad=0.0,
        sway_rad=0.0,
        tremor_g=0.0,
        strap_rad=(0.0, 0.0, 0.0),
        left_strap_rad=(0.0, 0.0, 0.0),
        left_turn_rad=np.pi / 2,
        offset_s=0.0,
        offset_spread_s=0.0,
    )


def reading(arm, start_s, stop_s, step_s=0.001):
    times_s = np.arange(start_s, stop_s, step_s)
    return times_s, arm.accel_at(times_s)


def test_an_ideal_hand_at_rest_reads_one_g_up():
    assert RightArm(ideal_person(), 0).accel_g(3.0) == pytest.approx((0.0, 0.0, 1.0))


@pytest.mark.parametrize("wanted", MOVEMENTS, ids=lambda g: g.label)
def test_a_movement_first_accelerates_along_its_axis_and_then_brakes(wanted):
    arm = RightArm(ideal_person(), 0)
    arm.perform(wanted.label, 1.0)

    _, accel = reading(arm, 1.0, 1.4)

    along = (accel - LEVEL)[:, wanted.axis] * wanted.sign
    peak_g = PEAK_ACCELERATION * 0.3 / 0.4**2 / 9.80665
    assert along[:100].max() == pytest.approx(peak_g, rel=0.25)
    assert along[20:150].min() > 0.1
    assert along[260:380].max() < -0.1


@pytest.mark.parametrize("wanted", [g for g in MOVEMENTS if g.axis != 2], ids=lambda g: g.label)
def test_the_acceleration_integrates_to_the_reach_and_to_standstill(wanted):
    arm = RightArm(ideal_person(), 0)
    arm.perform(wanted.label, 1.0)

    _, accel = reading(arm, 1.0, 1.4, 0.0001)

    speed = np.cumsum((accel - LEVEL) * 9.80665, axis=0) * 0.0001
    way = speed.sum(axis=0)[wanted.axis] * 0.0001
    assert np.abs(speed[-1]).max() < 1e-3
    assert way == pytest.approx(wanted.sign * 0.3, rel=0.01)


@pytest.mark.parametrize(
    ("label", "held"),
    [("RX+", (0, 1, 0)), ("RX-", (0, -1, 0)), ("RY+", (1, 0, 0)), ("RY-", (-1, 0, 0))],
)
def test_a_held_turn_shows_gravity_with_the_sign_of_the_paper(label, held):
    arm = RightArm(ideal_person(), 0)
    arm.perform(label, 1.0)

    assert arm.accel_g(20.0) == pytest.approx(held, abs=1e-9)


@pytest.mark.parametrize(("label", "sign"), [("RZ+", 1), ("RZ-", -1)])
def test_a_turn_about_z_shows_tangential_and_centripetal_acceleration(label, sign):
    arm = RightArm(ideal_person(), 0)
    arm.perform(label, 1.0)

    _, accel = reading(arm, 1.0, 1.4)

    tangential_g = PEAK_ACCELERATION * 0.15 * 1.0 / 0.4**2 / 9.80665
    centripetal_g = 0.15 * (1.875 * 1.0 / 0.4) ** 2 / 9.80665
    assert (sign * accel[:200, 1]).max() == pytest.approx(tangential_g, rel=0.01)
    assert accel[:, 0].min() == pytest.approx(-centripetal_g, rel=0.01)
    assert np.allclose(accel[:, 2], 1.0)


def test_after_a_movement_the_hand_holds_and_then_comes_back_too_slowly_to_be_a_gesture():
    arm = RightArm(ideal_person(), 0)
    arm.perform("X+", 1.0)

    _, held = reading(arm, 1.4, 1.4 + HOLD_S)
    _, back = reading(arm, 1.4 + HOLD_S, 5.0)

    assert np.abs(held - LEVEL).max() < 1e-9
    assert 0.5 * RETURN_PEAK_G < np.abs(back - LEVEL).max() < 1.1 * RETURN_PEAK_G
    assert arm.is_at_rest(5.0)


def test_a_posture_is_held_until_rest_is_asked_for():
    arm = RightArm(ideal_person(), 0)
    arm.perform("RY-", 1.0)

    assert arm.accel_g(60.0) == pytest.approx((-1.0, 0.0, 0.0))
    assert not arm.is_at_rest(60.0)
    arm.rest(60.0)

    assert arm.accel_g(62.0) == pytest.approx((0.0, 0.0, 1.0))
    assert arm.is_at_rest(62.0)


@pytest.mark.parametrize("label", ["X+", "RX-", "RZ+"])
def test_a_hand_that_repeats_a_gesture_holds_it_and_is_back_in_the_time_given(label):
    arm = RightArm(ideal_person(), 0)
    arm.perform(label, 1.0, hold_s=0.5, back_s=0.6)
    end_s = 1.0 + (0.4 if label != "RX-" else ideal_person().turn_s)

    _, held = reading(arm, end_s, end_s + 0.5)
    assert np.abs(np.diff(held, axis=0)).max() < 1e-9
    assert not arm.is_at_rest(end_s + 0.8)
    assert arm.is_at_rest(end_s + 1.1 + 0.01)


def test_a_movement_after_a_turn_about_z_reads_as_without_it():
    plain, turned = RightArm(ideal_person(), 0), RightArm(ideal_person(), 0)
    turned.perform("RZ+", 0.0)
    for arm in (plain, turned):
        arm.perform("X+", 1.0)

    assert np.allclose(reading(plain, 1.0, 1.4)[1], reading(turned, 1.0, 1.4)[1], atol=1e-9)


def test_a_new_gesture_replaces_one_that_has_not_begun():
    arm = RightArm(ideal_person(), 0)
    arm.perform("X+", 5.0)
    arm.perform("Y+", 4.0)

    _, accel = reading(arm, 4.0, 5.6)

    assert np.abs(accel[:, 0]).max() < 1e-9
    assert accel[:, 1].max() > 0.5


def test_an_unknown_gesture_is_a_key_error():
    with pytest.raises(KeyError):
        RightArm(ideal_person(), 0).perform("wave", 0.0)


orders = st.lists(
    st.tuples(st.sampled_from([*LABELS, "rest"]), st.floats(0.0, 3.0)), min_size=1, max_size=8
)


@settings(max_examples=25, deadline=None)
@given(orders, st.integers(0, 1000))
def test_no_order_at_any_moment_makes_the_reading_jump(todo, seed):
    arm, now_s = RightArm(draw_person(seed), 0), 0.0
    before = arm.accel_g(0.0)
    for what, wait_s in todo:
        now_s += wait_s
        before = arm.accel_g(now_s)
        arm.rest(now_s) if what == "rest" else arm.perform(what, now_s)
        assert np.allclose(arm.accel_g(now_s), before, atol=1e-9)

    _, accel = reading(arm, now_s, now_s + 3.0)

    assert np.all(np.isfinite(accel))
    assert np.abs(np.diff(accel, axis=0)).max() < 0.25


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 10_000), st.sampled_from(LABELS))
def test_asking_one_by_one_gives_the_same_as_all_at_once(seed, label):
    person = draw_person(seed)
    one, all_at_once = RightArm(person, 3), RightArm(person, 3)
    for arm in (one, all_at_once):
        arm.perform(label, 0.1)
    times_s = np.arange(0.0, 4.0, 0.05)

    single = [one.accel_g(float(t)) for t in times_s]

    assert np.allclose(single, all_at_once.accel_at(times_s), atol=1e-12)


@pytest.mark.parametrize("wanted", HELD, ids=lambda g: g.label)
def test_a_held_gesture_is_already_there_at_its_activation(wanted):
    person = draw_person(5)
    for seed in range(20):
        arm = RightArm(person, seed)
        start_s = arm.perform_for(wanted.label, 10.0)

        assert start_s == pytest.approx(10.0 - arm.lead_s(wanted.label))
        along = arm.accel_at(np.array([10.0, 10.03]))[:, 1 - wanted.axis] * wanted.sign
        assert along.min() > 0.7


def test_other_gestures_begin_around_the_activation_as_the_person_is_used_to():
    person = draw_person(5)
    offsets = [RightArm(person, seed).perform_for("X+", 10.0) - 10.0 for seed in range(400)]

    assert np.mean(offsets) == pytest.approx(person.offset_s, abs=person.offset_spread_s / 4)
    assert np.std(offsets) == pytest.approx(person.offset_spread_s, rel=0.15)
    assert RightArm(person, 0).lead_s("X+") >= -min(offsets)


def test_tremor_is_of_the_persons_size_and_of_8_to_12_hz():
    person = replace(ideal_person(), tremor_g=0.01)
    _, accel = reading(RightArm(person, 0), 0.0, 60.0, 0.01)

    spectrum = np.abs(np.fft.rfft(accel[:, 1])) ** 2
    hz = np.fft.rfftfreq(len(accel), 0.01)
    inside = spectrum[(hz > 7.9) & (hz < 12.1)].sum()
    assert accel[:, 1].std() == pytest.approx(0.01, rel=0.1)
    assert inside > 0.99 * spectrum.sum()


def test_gravity_leaks_into_a_movement_that_tilts_the_hand():
    tilted = replace(ideal_person(), tilt_rad=(0.0, -0.2, 0.0, 0.0, 0.0, 0.0))
    arm = RightArm(tilted, 0)
    arm.perform("X+", 1.0)

    assert arm.accel_g(1.5)[0] == pytest.approx(np.sin(0.2), abs=1e-9)


def test_a_strap_that_sits_askew_turns_every_reading():
    person = replace(ideal_person(), strap_rad=(0.0, 0.1, 0.0))

    x, y, z = RightArm(person, 0).accel_g(0.0)

    assert (x, y, z) == pytest.approx((-np.sin(0.1), 0.0, np.cos(0.1)))


def test_the_left_arm_reads_stop_level_and_start_with_minus_one_g_on_x():
    arm = LeftArm(ideal_person(), 0)
    assert arm.accel_g(0.0) == pytest.approx((0.0, 0.0, 1.0))

    arm.take(ArmPosture.START, 1.0)
    assert arm.accel_g(3.0) == pytest.approx((-1.0, 0.0, 0.0), abs=1e-9)
    arm.take(ArmPosture.NEITHER, 3.0)
    assert arm.accel_g(5.0) == pytest.approx((-np.sqrt(0.5), 0.0, np.sqrt(0.5)), abs=1e-9)
    arm.take(ArmPosture.STOP, 5.0)
    assert arm.accel_g(7.0) == pytest.approx((0.0, 0.0, 1.0), abs=1e-9)


def seen_start_s(person, seed):
    site = SiteSettings()
    detector = PostureDetector(
        site.posture_enter_deg, site.posture_leave_deg, site.posture_debounce
    )
    arm, rng = LeftArm(person, seed), np.random.default_rng(seed)
    arm.take(ArmPosture.START, 0.0)
    times_s = (np.arange(150) + rng.uniform()) / 100.0
    readings = person.left_sensor.read(arm.accel_at(times_s), rng)
    seen = [detector.feed(tuple(row)) is ArmPosture.START for row in readings.tolist()]
    return float(times_s[seen.index(True)])


@pytest.mark.parametrize("person", [*draw_people(3, 11), practised_person(7)])
def test_the_left_arms_start_is_seen_when_it_was_foretold(person):
    seen = [seen_start_s(person, seed) for seed in range(40)]

    assert np.mean(seen) == pytest.approx(start_seen_after_s(person), abs=0.01)
    assert np.std(seen) < 0.03


def test_an_accelerometer_scales_shifts_and_saturates():
    sensor = Accelerometer(offset_g=(0.1, 0.0, 0.0), gain=(1.1, 1.0, 1.0))
    rng = np.random.default_rng(0)

    assert sensor.read(np.array([1.0, -9.0, 0.0]), rng).tolist() == pytest.approx(
        [1.2, -SATURATION_G, 0.0]
    )


def test_the_noise_of_an_adxl330_is_that_of_its_data_sheet():
    rng = np.random.default_rng(0)
    sensor = adxl330(rng, bandwidth_hz=50.0)
    readings = sensor.read(np.zeros((20_000, 3)), rng)

    assert readings.std(axis=0) == pytest.approx([2.50e-3, 2.50e-3, 3.13e-3], rel=0.03)
    assert np.all(np.abs(np.array(sensor.gain) - 1.0) <= 0.1)
