"""What stands in a guardian's log can be read back, whatever else stands there."""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gestureapp.robot import messages as m
from gestureapp.robot.acts import Act, Did, act_of, find_unseen, read_act
from gestureapp.robot.values import Pose, StopReason

TIMES = st.floats(0.0, 1e10)
ACTS = st.builds(
    Act, st.sampled_from(Did), st.text(), TIMES, TIMES, st.text(), st.text(), st.booleans(), TIMES
)
LEFT = "left sensor silent for 104 ms"


def a(did, t_s=100.0, **what):
    return Act(did, "7", 1.8e9 + t_s, t_s, **what)


STARTED, ENDED = a(Did.STARTED, 1.0), a(Did.ENDED, 200.0)
STOPPING = a(Did.STOPPING, 100.0, text=LEFT, reason="left sensor silent", could_move=True)
STANDS = a(Did.STANDS, 100.12, seen_s=0.12)
UNCONFIRMED = a(Did.UNCONFIRMED, 101.0)


def gone(seen_s, t_s=110.0):
    return a(Did.GONE, t_s, text="its window connection ended", could_move=True, seen_s=seen_s)


def found(*acts):
    return find_unseen(f"2026-11-23 14:03:12,345 WARNING {act.line}\n" for act in acts)


MOVES, ARRIVED = a(Did.MOVES, 90.0, could_move=True), a(Did.ARRIVED, 95.0)


def test_a_guardian_that_ended_with_its_application_while_the_robot_moved_is_told():
    unseen = found(STARTED, MOVES)
    assert unseen is not None
    assert (unseen.stop, unseen.outcome.partition(":")[0]) == (MOVES, "nothing stopped it here")
    assert found(STARTED, MOVES, ARRIVED) is None
    assert found(STARTED, MOVES, STOPPING, STANDS) is None


def test_a_guardian_that_was_replaced_while_the_robot_moved_is_no_news():
    follower = [replace(act, run="8") for act in (STARTED, STOPPING, STANDS, ENDED)]
    assert found(STARTED, MOVES, *follower) is None


@given(ACTS)
def test_an_act_is_one_line_and_comes_back_from_it(act):
    assert len(act.line.splitlines()) == 1
    assert read_act(f"2026-11-23 14:03:12,345 INFO {act.line}\n") == act


@given(ACTS, st.data())
def test_a_line_that_was_cut_off_is_no_act(act, data):
    cut = data.draw(st.integers(0, len(act.line) - 1))
    assert read_act(act.line[:cut]) is None


@given(st.lists(st.text() | ACTS.map(lambda act: act.line)), st.text())
def test_rubbish_is_survived(lines, rubbish):
    find_unseen([*lines, rubbish, f"\t{rubbish}"])


@pytest.mark.parametrize(
    "field",
    ['"wall_s": 1e999', '"wall_s": NaN', '"t_s": "x"', '"did": "nothing"', '"seen_s": -1'],
)
def test_values_that_no_guardian_writes_are_no_act(field):
    name = field.partition(":")[0]
    start = STARTED.line.index(name)
    end = min(i for i in (STARTED.line.find(c, start) for c in ",}") if i > 0)
    assert read_act(STARTED.line) is not None
    assert read_act(STARTED.line[:start] + field + STARTED.line[end:]) is None


def test_a_stop_after_the_application_was_last_alive_was_not_seen():
    unseen = found(STARTED, STOPPING, STANDS, gone(seen_s=99.9), ENDED)
    assert unseen is not None
    assert unseen.stop == STOPPING
    assert unseen.outcome == "standstill confirmed after 0.12 s"


def test_a_stop_that_the_application_outlived_was_seen():
    assert found(STARTED, STOPPING, STANDS, gone(seen_s=100.05), ENDED) is None
    assert found(STARTED, STOPPING, STANDS) is None


def test_a_goodbye_leaves_nothing_to_tell():
    goodbye = replace(gone(seen_s=99.0), could_move=False)
    assert found(STARTED, STOPPING, STANDS, goodbye, ENDED) is None


def test_a_robot_that_could_not_move_and_the_left_arms_own_stop_are_no_news():
    idle = replace(STOPPING, could_move=False)
    own = replace(STOPPING, reason=StopReason.LEFT_ARM.value)
    assert found(STARTED, gone(seen_s=99.9), idle, STANDS, ENDED) is None
    assert found(STARTED, gone(seen_s=99.9), own, STANDS, ENDED) is None


@pytest.mark.parametrize(
    ("acts", "outcome"),
    [
        ((gone(seen_s=99.9),), "no standstill is noted"),
        ((), "no standstill is noted"),
        ((gone(seen_s=99.9), ENDED), "the robot did not confirm that it stands"),
        ((UNCONFIRMED, gone(99.9), ENDED), "the robot did not confirm that it stands"),
        ((UNCONFIRMED, gone(99.9), STANDS, ENDED), "standstill confirmed after 0.12 s"),
    ],
)
def test_what_became_of_the_stop_is_told(acts, outcome):
    unseen = found(STARTED, STOPPING, *acts)
    assert unseen is not None
    assert unseen.outcome == outcome


def test_of_several_guardians_the_newest_stop_is_told():
    later = [
        replace(act, run="8", wall_s=act.wall_s + 500.0)
        for act in (STARTED, STOPPING, STANDS, gone(seen_s=99.9))
    ]
    unseen = found(*later, STARTED, STOPPING, gone(seen_s=99.9), STANDS)
    assert unseen is not None
    assert unseen.stop.run == "8"
    assert unseen.key != found(STARTED, STOPPING, gone(99.9), STANDS).key


def test_only_stops_are_acts_among_the_words_to_the_application():
    pose = Pose(1.0, 2.0, 3.0, 4.0, 5.0, 6.0)
    reason = StopReason.LEFT_SILENT
    told = [
        m.StopAsked(reason, LEFT, 100.0),
        m.StopConfirmed(reason, 0.12, pose),
        m.StopUnconfirmed(reason, "no answer"),
        m.Armed(),
        m.Notice("x"),
    ]
    acts = [act_of(message, "7", 5.0, could_move=True) for message in told]
    assert [act and act.did for act in acts] == [
        *(Did.STOPPING, Did.STANDS, Did.UNCONFIRMED, None, None)
    ]
    assert acts[0] == Act(Did.STOPPING, "7", 5.0, 100.0, LEFT, reason.value, True)
    assert acts[1].seen_s == 0.12
