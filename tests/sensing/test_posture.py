"""The left arm's posture: what starts, what does not, what ends a start."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gestureapp.config import SiteSettings
from gestureapp.sensing.posture import QUIET_MAX_G, QUIET_MIN_G, PostureDetector
from gestureapp.sensing.values import ArmPosture

Vector = tuple[float, float, float]

SITE = SiteSettings()
LEVEL: Vector = (0.0, 0.0, 1.0)
TURNED: Vector = (-1.0, 0.0, 0.0)

axis_g = st.floats(-6, 6)
any_sample = st.tuples(axis_g, axis_g, axis_g)


def detector(debounce: int = SITE.posture_debounce) -> PostureDetector:
    return PostureDetector(SITE.posture_enter_deg, SITE.posture_leave_deg, debounce)


def turned(angle_deg: float, magnitude_g: float = 1.0) -> Vector:
    """An arm turned about Y by this angle from level; 90 is the start posture."""
    angle = math.radians(angle_deg)
    return (-magnitude_g * math.sin(angle), 0.0, magnitude_g * math.cos(angle))


def posture_after(arm: PostureDetector, *samples: Vector) -> ArmPosture:
    for sample in samples:
        arm.feed(sample)
    return arm.posture


def in_start() -> PostureDetector:
    arm = detector()
    assert posture_after(arm, *[TURNED] * SITE.posture_debounce) is ArmPosture.START
    return arm


def test_before_anything_is_seen_it_is_neither():
    assert detector().posture is ArmPosture.NEITHER


@pytest.mark.parametrize(("held", "posture"), [(LEVEL, "stop"), (TURNED, "start")])
def test_a_held_posture_is_taken_with_the_last_sample_of_the_debounce(held: Vector, posture: str):
    arm = detector(debounce=4)
    found = [arm.feed(held).value for _ in range(6)]
    assert found == ["neither"] * 3 + [posture] * 3


@pytest.mark.parametrize(
    "held",
    [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, -1.0), (0.0, 0.0, 0.0)],
)
def test_any_other_way_to_hold_the_arm_is_neither(held: Vector):
    assert posture_after(detector(), *[held] * 20) is ArmPosture.NEITHER


@pytest.mark.parametrize(
    ("angle_deg", "posture"),
    [(0, "stop"), (24.9, "stop"), (25.1, "neither"), (64.9, "neither"), (65.1, "start")],
)
def test_a_posture_is_entered_within_the_enter_angle(angle_deg: float, posture: str):
    assert posture_after(detector(), *[turned(angle_deg)] * 10).value == posture


@pytest.mark.parametrize(("angle_deg", "posture"), [(50.1, "start"), (49.9, "neither")])
def test_start_is_left_beyond_the_leave_angle(angle_deg: float, posture: str):
    assert posture_after(in_start(), *[turned(angle_deg)] * 10).value == posture


@pytest.mark.parametrize("came_from", [0.0, 90.0])
def test_a_steady_tilt_of_44_degrees_is_neither_wherever_it_came_from(came_from: float):
    arm = detector()
    posture_after(arm, *[turned(came_from)] * 10)
    assert posture_after(arm, *[turned(44)] * 10) is ArmPosture.NEITHER


def test_a_tilt_sideways_counts_like_any_other():
    angle = math.radians(30)
    sideways = (0.0, math.sin(angle), math.cos(angle))
    assert posture_after(detector(), *[sideways] * 10) is ArmPosture.NEITHER


@pytest.mark.parametrize("magnitude_g", [QUIET_MIN_G - 0.01, QUIET_MAX_G + 0.01, 3.0, 0.0])
def test_a_direction_with_the_wrong_magnitude_starts_nothing(magnitude_g: float):
    assert posture_after(detector(), *[turned(90, magnitude_g)] * 20) is ArmPosture.NEITHER


@pytest.mark.parametrize("magnitude_g", [QUIET_MIN_G + 0.01, QUIET_MAX_G - 0.01])
def test_an_arm_that_moves_a_little_still_shows_its_posture(magnitude_g: float):
    assert posture_after(detector(), *[turned(90, magnitude_g)] * 3) is ArmPosture.START


def test_one_loud_sample_begins_the_count_anew():
    arm = detector(debounce=3)
    loud = turned(90, 2.0)
    assert posture_after(arm, TURNED, TURNED, loud, TURNED, TURNED) is ArmPosture.NEITHER
    assert arm.feed(TURNED) is ArmPosture.START


def test_a_shake_ends_a_start():
    assert posture_after(in_start(), *[turned(90, 2.0)] * 3) is ArmPosture.NEITHER


def test_back_to_level_ends_a_start_as_a_stop():
    assert posture_after(in_start(), *[LEVEL] * 3) is ArmPosture.STOP


def test_a_single_stray_sample_does_not_end_a_start():
    assert posture_after(in_start(), LEVEL, LEVEL, TURNED) is ArmPosture.START


def test_reset_forgets_posture_and_count():
    arm = in_start()
    arm.reset()
    assert arm.posture is ArmPosture.NEITHER
    assert posture_after(arm, TURNED, TURNED) is ArmPosture.NEITHER


def test_no_number_is_no_posture():
    assert posture_after(in_start(), *[(math.nan, 0.0, 1.0)] * 3) is ArmPosture.NEITHER


@pytest.mark.parametrize(
    ("enter_deg", "leave_deg", "debounce"),
    [(0, 40, 3), (30, 20, 3), (45, 45, 3), (25, 40, 0), (math.nan, 40, 3), (25, math.nan, 3)],
)
def test_settings_that_cannot_work_are_refused(enter_deg: float, leave_deg: float, debounce: int):
    with pytest.raises(ValueError, match="posture"):
        PostureDetector(enter_deg, leave_deg, debounce)


@given(st.integers(2, 6), st.lists(any_sample, min_size=1, max_size=6), st.integers(1, 5))
def test_start_shown_for_less_than_the_debounce_never_starts(
    debounce: int, others: list[Vector], n_start: int
):
    arm = detector(debounce)
    n_start = min(n_start, debounce - 1)
    shake = [turned(90, QUIET_MAX_G + 0.5), *[TURNED] * n_start]
    for sample in shake * 10:
        assert arm.feed(sample) is not ArmPosture.START
    arm = detector(debounce)
    for _ in range(10):
        for sample in [*[TURNED] * n_start, LEVEL, *[s for s in others if s[0] > 0]]:
            assert arm.feed(sample) is not ArmPosture.START


@given(
    st.lists(any_sample.filter(lambda s: not QUIET_MIN_G <= math.hypot(*s) <= QUIET_MAX_G)),
)
def test_shaking_alone_never_shows_any_posture(samples: list[Vector]):
    assert posture_after(detector(debounce=1), *samples) is ArmPosture.NEITHER


@given(st.lists(st.sampled_from([LEVEL, TURNED, (1.0, 0.0, 0.0), turned(90, 3.0), turned(45)])))
def test_start_always_means_a_full_debounce_of_quiet_start_samples(samples: list[Vector]):
    arm = detector(debounce=3)
    for i, sample in enumerate(samples):
        before = arm.posture
        if arm.feed(sample) is ArmPosture.START and before is not ArmPosture.START:
            assert samples[i - 2 : i + 1] == [TURNED] * 3


@given(st.lists(any_sample, min_size=3, max_size=3))
def test_whatever_is_not_start_ends_a_start_within_the_debounce(samples: list[Vector]):
    limit = math.cos(math.radians(SITE.posture_leave_deg + 0.1))
    away = [s for s in samples if -s[0] < limit * math.hypot(*s)]
    away += [LEVEL] * (3 - len(away))
    assert posture_after(in_start(), *away) is not ArmPosture.START


@given(st.floats(26, 64), st.integers(1, 100))
def test_a_tilt_between_the_postures_is_neither_however_long(angle_deg: float, n: int):
    assert posture_after(detector(), *[turned(angle_deg)] * n) is ArmPosture.NEITHER


@given(st.floats(0, 360), st.floats(0, 24), st.floats(0.65, 1.35))
def test_start_is_taken_from_any_side_within_the_enter_angle(
    around_deg: float, off_deg: float, magnitude_g: float
):
    around, off = math.radians(around_deg), math.radians(off_deg)
    sample = (
        -magnitude_g * math.cos(off),
        magnitude_g * math.sin(off) * math.cos(around),
        magnitude_g * math.sin(off) * math.sin(around),
    )
    assert posture_after(detector(), *[sample] * 3) is ArmPosture.START
