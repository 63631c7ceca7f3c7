"""The verdict on a take: what an honest person does passes, what is grossly wrong is named."""

import numpy as np
import pytest

from gestureapp.gestures import LABELS, is_held
from gestureapp.guided.likeness import ENOUGH, Likeness
from gestureapp.guided.values import Quality
from gestureapp.guided.verdict import EARLY_S, GAP_S, LATE_S, LEVEL_DEG, SATURATED_G, judge
from gestureapp.recording.take_values import Judgement, Take, Verdict
from gestureapp.simulation.arm import RightArm
from gestureapp.simulation.people import Person, draw_person, practised_person
from gestureapp.simulation.takes import make_person_takes

GOOD = Judgement(Verdict.GOOD, "good")
MOVED = [label for label in LABELS if not is_held(label)]
HELD = [label for label in LABELS if is_held(label)]
TIMES_S = np.arange(-50, 100) / 100.0 + 0.005
PRACTISED = practised_person(3)


def take_of(number: int, label: str, accel_g, judgement=GOOD) -> Take:
    return Take(number, label, "s", 0.0, judgement, False, False, TIMES_S, np.asarray(accel_g))


def takes_of(person: Person, n: int) -> list[Take]:
    readings = make_person_takes(person, n)
    return [take_of(k, LABELS[k // n], accel_g) for k, accel_g in enumerate(readings)]


def performed(label: str, start_s: float, person=PRACTISED, number=1) -> np.ndarray:
    """Readings of an arm that begins so long after the activation."""
    arm = RightArm(person, number)
    arm.perform(label, 10.0 + start_s)
    rng = np.random.default_rng(number)
    return person.right_sensor.read(arm.accel_at(10.0 + TIMES_S), rng)


def verdict_on(label: str, accel_g, times_s=TIMES_S, others=()) -> Judgement:
    return judge(label, times_s, accel_g, others, Likeness())


def turned(accel_g, axis: int, angle_deg: float):
    """Every reading of a sensor that is turned about X (0) or Y (1)."""
    c, s = np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))
    matrix = np.array([[1, 0, 0], [0, c, -s], [0, s, c]])
    if axis == 1:
        matrix = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    return accel_g @ matrix


@pytest.mark.parametrize("person", [PRACTISED, draw_person(5, 0), draw_person(5, 3)])
def test_nearly_all_honest_takes_are_good(person):
    takes, likeness = takes_of(person, 12), Likeness()
    found = [judge(t.label, t.times_s, t.accel_g, takes, likeness).is_good for t in takes]
    assert np.mean(found) > 0.95


@pytest.mark.parametrize("label", LABELS)
def test_a_resting_hand_is_named(label):
    arm = RightArm(PRACTISED, 1)
    words = verdict_on(label, arm.accel_at(10.0 + TIMES_S))
    assert words.verdict is Verdict.NO_MOVEMENT
    assert words.words == ("no posture: the hand is level" if is_held(label) else "no movement")


@pytest.mark.parametrize("label", MOVED)
@pytest.mark.parametrize(
    ("start_s", "verdict"),
    [
        (-EARLY_S - 0.03, Verdict.TOO_EARLY),
        (-EARLY_S + 0.03, Verdict.GOOD),
        (0.0, Verdict.GOOD),
        (LATE_S - 0.03, Verdict.GOOD),
        (LATE_S + 0.03, Verdict.TOO_LATE),
        (0.3, Verdict.TOO_LATE),
    ],
)
def test_the_onset_has_to_lie_about_the_activation(label, start_s, verdict):
    judgement = verdict_on(label, performed(label, start_s))
    assert judgement.verdict is verdict
    if verdict is Verdict.TOO_LATE:
        assert judgement.words.startswith("too late by ")
        told_s = float(judgement.words.split()[3]) / 1000.0
        assert told_s == pytest.approx(start_s, abs=0.03)


@pytest.mark.parametrize("label", HELD)
@pytest.mark.parametrize(
    ("start_s", "verdict"),
    [(-0.6, Verdict.GOOD), (-0.45, Verdict.GOOD), (0.0, Verdict.TOO_LATE), (0.3, Verdict.TOO_LATE)],
)
def test_a_posture_has_to_be_there_at_the_activation(label, start_s, verdict):
    assert verdict_on(label, performed(label, start_s)).verdict is verdict


@pytest.mark.parametrize("label", HELD)
def test_a_posture_that_was_given_up_came_too_early(label):
    arm = RightArm(PRACTISED, 1)
    arm.perform(label, 8.0)
    arm.rest(9.0)
    judgement = verdict_on(label, arm.accel_at(10.0 + TIMES_S))
    assert judgement == Judgement(Verdict.TOO_EARLY, "too early: no longer held")


@pytest.mark.parametrize("label", MOVED)
@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("sign", [-1, 1])
def test_a_movement_begins_level(label, axis, sign):
    accel_g = turned(performed(label, 0.0), axis, sign * (LEVEL_DEG + 8.0))
    judgement = verdict_on(label, accel_g)
    assert judgement.verdict is Verdict.NOT_LEVEL
    assert judgement.words.endswith("° before it")
    assert verdict_on(label, turned(performed(label, 0.0), axis, sign * 5.0)).is_good


@pytest.mark.parametrize("first", [0, 20, 50, 70, 147])
def test_samples_that_are_missing_anywhere_are_a_gap(first):
    kept = np.delete(np.arange(150), np.arange(first, min(first + 4, 150)))
    judgement = verdict_on("X+", performed("X+", 0.0)[kept], TIMES_S[kept])
    assert judgement.verdict is Verdict.GAP
    assert judgement.words in ("gap of 50 ms", "gap of 45 ms", "gap of 40 ms", "gap of 35 ms")


def test_a_gap_is_told_as_long_as_it_is_and_a_short_one_is_none():
    times_s = TIMES_S.copy()
    times_s[60:] += 0.033 - 1e-9
    assert verdict_on("X+", performed("X+", 0.0), times_s).words == "gap of 43 ms"
    times_s = TIMES_S.copy()
    times_s[60:] += GAP_S - 0.011
    assert verdict_on("X+", performed("X+", 0.0), times_s).is_good


def test_no_samples_at_all_are_a_gap():
    empty = verdict_on("X+", np.zeros((0, 3)), np.zeros(0))
    assert empty == Judgement(Verdict.GAP, "gap of 1500 ms")


@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_a_reading_at_the_end_of_the_range_is_saturated(axis, sign):
    accel_g = performed("X+", 0.0)
    accel_g[70, axis] = sign * SATURATED_G
    assert verdict_on("X+", accel_g) == Judgement(Verdict.SATURATED, "saturated")
    accel_g[70, axis] = sign * (SATURATED_G - 0.01)
    assert verdict_on("X+", accel_g).verdict is not Verdict.SATURATED


@pytest.mark.parametrize(("person", "share"), [(PRACTISED, 0.99), (draw_person(5, 2), 0.8)])
def test_another_gesture_is_named_once_there_are_takes_to_compare_with(person, share):
    takes, likeness = takes_of(person, 10), Likeness()
    words = [
        (take.label, judge(asked, take.times_s, take.accel_g, takes, likeness).words)
        for take in takes_of(person, 1)
        for asked in LABELS
        if asked != take.label and is_held(asked) is is_held(take.label)
    ]
    assert np.mean([said == f"looks like {shown}" for shown, said in words]) > share


def test_the_first_takes_of_a_gesture_are_not_those_of_another():
    takes = [take for take in takes_of(PRACTISED, 10) if take.label != "X+"]
    shown = [take for take in takes_of(PRACTISED, 10) if take.label == "Y+"]
    likeness = Likeness()
    words = [judge("X+", t.times_s, t.accel_g, takes, likeness).words for t in shown]
    assert words.count("looks like Y+") >= 3
    honest = [take for take in takes_of(PRACTISED, 10) if take.label == "X+"]
    assert all(judge("X+", t.times_s, t.accel_g, takes, likeness).is_good for t in honest)


@pytest.mark.parametrize("shown", HELD)
@pytest.mark.parametrize("asked", LABELS)
def test_a_posture_is_known_by_gravity_from_the_first_take_on(shown, asked):
    accel_g = performed(shown, -0.5)
    wanted = GOOD if asked == shown else Judgement(Verdict.UNLIKE, f"looks like {shown}")
    assert verdict_on(asked, accel_g) == wanted


def test_with_too_few_takes_nothing_is_compared():
    takes = list(takes_of(PRACTISED, ENOUGH - 1))
    accel_g = performed("Y+", 0.0)
    assert judge("X+", TIMES_S, accel_g, takes, Likeness()).is_good


def test_only_takes_that_count_are_compared_with():
    bad = Judgement(Verdict.GAP, "gap of 43 ms")
    takes = [take_of(t.id, t.label, t.accel_g, bad) for t in takes_of(PRACTISED, 10)]
    assert judge("X+", TIMES_S, performed("Y+", 0.0), takes, Likeness()).is_good


def test_a_take_that_is_like_no_other_is_unlike_the_others():
    takes = takes_of(PRACTISED, 10)
    judgement = judge("X+", TIMES_S, turned(performed("X+", 0.0), 0, 60.0), takes, Likeness())
    assert not judgement.is_good
    wild = performed("X+", 0.0)
    wild[60:90] += np.sin(np.arange(30))[:, None] * 1.2
    wild = np.clip(wild, -2.9, 2.9)
    assert judge("X+", TIMES_S, wild, takes, Likeness()).verdict is Verdict.UNLIKE


def test_the_quality_mark_says_how_alike_takes_are():
    def marks(person: Person, n: int) -> set[Quality]:
        return set(Likeness().qualities(takes_of(person, n)).values())

    assert set(Likeness().qualities([]).values()) == {Quality.NONE}
    assert marks(PRACTISED, ENOUGH - 1) == {Quality.FEW}
    assert marks(PRACTISED, 20) == {Quality.GOOD}
    assert Quality.GOOD in marks(draw_person(5, 1), 20)
    assert marks(draw_person(5, 1), 20) & {Quality.FAIR, Quality.POOR}


def test_the_mark_follows_what_is_taken_out():
    likeness, takes = Likeness(), takes_of(PRACTISED, 20)
    before = likeness.qualities(takes)["X+"]
    wild = [take_of(1000 + k, "X+", performed("Y-", 0.0, number=k)) for k in range(30)]
    assert likeness.qualities(takes + wild)["X+"] is not before
    assert likeness.qualities(takes)["X+"] is before
