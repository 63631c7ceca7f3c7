"""What a trained operator tells both arms, and when. Pure: the time is in the test's hand."""

import random
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gestureapp.gestures import LABELS
from gestureapp.sensing.values import Side
from gestureapp.simulation.operator_plan import (
    LEAD_S,
    RIGHT_BACK_S,
    STOP_HELD_S,
    OperatorPlan,
    Order,
    Timing,
)
from gestureapp.simulation.people import practised_person

TIMING = Timing(
    start_seen_s=0.25,
    left_turn_s=0.32,
    home_after_s=2.5,
    held_lead_s=0.5,
    offset_s=-0.03,
    offset_spread_s=0.0,
    movement_s=0.4,
    turn_s=0.3,
    yaw_s=0.35,
)
HELD = ("RX+", "RX-", "RY+", "RY-")
MOVING = tuple(label for label in LABELS if label not in HELD)


def plan(**changes) -> OperatorPlan:
    return OperatorPlan(replace(TIMING, **changes), random.Random(1))


def orders_to(side: Side, orders: list[Order]) -> list[dict]:
    return [order.command for order in orders if order.side is side]


@pytest.mark.parametrize("label", MOVING)
def test_a_movement_begins_when_the_left_arm_is_seen_plus_the_offset(label):
    orders = plan().gesture(label, 10.0)
    (left,), (right,) = orders_to(Side.LEFT, orders), orders_to(Side.RIGHT, orders)
    assert left == {"do": "take", "posture": "start", "at_s": pytest.approx(10.0 + LEAD_S)}
    assert right["label"] == label
    assert right["at_s"] == pytest.approx(left["at_s"] + 0.25 - 0.03)


@pytest.mark.parametrize("label", HELD)
def test_a_held_turn_comes_before_the_left_arm_rises(label):
    orders = plan().gesture(label, 10.0)
    (left,), (right,) = orders_to(Side.LEFT, orders), orders_to(Side.RIGHT, orders)
    assert right["at_s"] == pytest.approx(10.0 + LEAD_S)
    assert left["at_s"] + 0.25 == pytest.approx(right["at_s"] + 0.5)


def test_a_raised_left_arm_is_lowered_and_held_before_the_next_gesture():
    operator = plan()
    operator.gesture("X+", 10.0)
    orders = operator.gesture("Y+", 12.0)
    down, up = orders_to(Side.LEFT, orders)
    assert down == {"do": "take", "posture": "stop"}
    assert up["at_s"] >= 12.0 + 0.32 + STOP_HELD_S


def test_a_left_arm_lowered_long_ago_need_not_wait():
    operator = plan()
    operator.gesture("X+", 10.0)
    operator.left_stop(12.0)
    (up,) = orders_to(Side.LEFT, operator.gesture("Y+", 20.0))
    assert up["at_s"] == pytest.approx(20.0 + LEAD_S)


def test_a_left_arm_lowered_just_now_is_held_for_the_rest_of_the_time():
    operator = plan()
    operator.gesture("X+", 10.0)
    operator.left_stop(12.0)
    (up,) = orders_to(Side.LEFT, operator.gesture("Y+", 12.5))
    assert 12.0 + 0.32 + STOP_HELD_S <= up["at_s"] < 12.5 + 0.32 + STOP_HELD_S


@pytest.mark.parametrize("label", [*HELD, "RZ+", "RZ-"])
def test_a_turned_hand_rests_when_the_left_arm_goes_back(label):
    operator = plan()
    operator.gesture(label, 10.0)
    assert orders_to(Side.RIGHT, operator.left_stop(13.0)) == [{"do": "rest"}]
    assert orders_to(Side.RIGHT, operator.left_stop(14.0)) == []


@pytest.mark.parametrize("label", [*HELD, "RZ-"])
def test_a_turned_hand_is_back_before_the_next_gesture(label):
    operator = plan()
    operator.gesture(label, 10.0)
    rest, perform = orders_to(Side.RIGHT, operator.gesture("Z+", 13.0))
    assert rest == {"do": "rest"}
    assert perform["at_s"] >= 13.0 + RIGHT_BACK_S


def test_a_movement_goes_back_by_itself_when_the_left_arm_is_lowered():
    operator = plan()
    operator.gesture("X+", 10.0)
    assert orders_to(Side.RIGHT, operator.left_stop(12.0)) == []


def test_lowering_the_left_arm_calls_off_a_gesture_that_has_not_begun():
    operator = plan()
    operator.gesture("X+", 10.0)
    orders = operator.left_stop(10.01)
    assert orders_to(Side.LEFT, orders) == [{"do": "take", "posture": "stop"}]
    assert orders_to(Side.RIGHT, orders) == [{"do": "rest"}]


def test_the_arms_can_be_moved_one_by_one():
    operator = plan()
    assert operator.left_start(5.0) == [Order(Side.LEFT, {"do": "take", "posture": "start"})]
    assert operator.right_rest(6.0) == [Order(Side.RIGHT, {"do": "rest"})]
    assert (operator.left, operator.right) == ("in start posture", "at rest")


def test_an_unknown_gesture_changes_nothing():
    operator = plan()
    operator.left_start(5.0)
    with pytest.raises(KeyError):
        operator.gesture("W+", 6.0)
    assert (operator.left, operator.right) == ("in start posture", "at rest")


WISH = st.one_of(
    st.sampled_from(LABELS), st.sampled_from(["left_start", "left_stop", "right_rest"])
)


@settings(deadline=None)
@given(st.lists(st.tuples(WISH, st.floats(0.0, 3.0)), min_size=1, max_size=25))
def test_whatever_was_asked_before_the_left_arm_rises_only_after_being_held_in_stop(wishes):
    operator = plan(offset_spread_s=0.006)
    now_s, lowered_s, up_s = 0.0, float("-inf"), float("inf")
    for wish, pause_s in wishes:
        now_s += pause_s
        if wish not in LABELS:
            getattr(operator, wish)(now_s)
            if wish == "left_start":
                up_s = now_s
            if wish == "left_stop" and up_s <= now_s:
                lowered_s = now_s
            up_s = float("inf") if wish == "left_stop" else up_s
            continue
        orders = operator.gesture(wish, now_s)
        *down, up = orders_to(Side.LEFT, orders)
        lowered_s = now_s if up_s <= now_s else lowered_s
        assert bool(down) or up_s > now_s
        assert up["at_s"] >= max(now_s + LEAD_S - 1e-9, lowered_s + 0.32 + STOP_HELD_S)
        assert orders_to(Side.RIGHT, orders)[-1]["at_s"] >= now_s + LEAD_S - 1e-9
        up_s = up["at_s"]


def test_the_times_are_those_of_the_person():
    person = practised_person(7)
    timing = Timing.of(person)
    assert timing.left_turn_s == person.left_turn_s
    assert 0.0 < timing.start_seen_s < person.left_turn_s + 0.1
    assert timing.held_lead_s > person.turn_s


def test_the_next_gesture_waits_until_the_right_hand_is_home_from_a_movement():
    hands = plan()
    (first,) = orders_to(Side.RIGHT, hands.gesture("Z+", 10.0))
    hands.left_stop(11.0)
    (second,) = orders_to(Side.RIGHT, hands.gesture("Z-", 11.1))
    assert second["at_s"] >= first["at_s"] + TIMING.home_after_s


def test_the_next_gesture_comes_at_once_when_the_right_hand_has_had_time():
    hands = plan()
    hands.gesture("Z+", 10.0)
    hands.left_stop(19.0)
    (second,) = orders_to(Side.RIGHT, hands.gesture("Z-", 20.0))
    assert second["at_s"] < 20.5


def test_gestures_that_are_replaced_before_they_begin_do_not_put_the_last_one_off():
    hands = plan()
    for n in range(8):
        (last,) = orders_to(Side.RIGHT, hands.gesture(MOVING[n % 2], 10.0 + 0.1 * n))
    assert last["at_s"] < 10.7 + 1.0


def test_a_gesture_that_has_to_wait_is_announced_as_waiting():
    hands = plan()
    hands.gesture("Z+", 10.0)
    hands.left_stop(11.0)
    hands.gesture("Z-", 11.1)
    assert hands.words(11.1).startswith("In 2 s")
    assert hands.words(13.5) == "Left arm in start posture; right arm Z-, push down"
