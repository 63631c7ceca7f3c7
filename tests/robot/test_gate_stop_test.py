"""The gate and a stop test: never longer, never faster, never with the left arm raised."""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gestureapp.robot.gate import TEST_MOST, Command, Proposal, decide
from gestureapp.robot.values import (
    Caps,
    Direction,
    Pose,
    Position,
    Posture,
    Refusal,
    RobotStatus,
    StopReason,
)
from tests.robot.gate_view import LIMITS, NOW_S
from tests.robot.gate_view import VIEW as MOVABLE

VIEW = replace(MOVABLE, is_left_start=False, is_left_stop=True)
CAPS = Caps(20.0, 10.0)
ANY_CAP = st.one_of(
    st.floats(allow_nan=True, allow_infinity=True), st.sampled_from([0.1, 1.0, 20.0, 20.001])
)


def decided(caps=CAPS, view=VIEW, limits=LIMITS, direction=None):
    forward = direction or Direction(0, 1, is_rotation=False)
    return decide(Proposal(7, forward, NOW_S, caps), view, limits, NOW_S)


def refused(**how):
    decision = decided(**how)
    return decision.reason if isinstance(decision, Refusal) else None


def test_a_stop_test_is_as_long_and_as_fast_as_it_asks():
    command = decided()
    assert isinstance(command, Command)
    assert command.permit.request.data.startswith("0,10.0,1,20.000,0.000,0.000,0.00,0.00,0.00,")
    assert command.plan.limited_by == "length of a stop test"
    assert command.duration_s == 2.0


def test_the_other_way_it_has_the_other_sign():
    command = decided(direction=Direction(1, -1, is_rotation=False))
    assert isinstance(command, Command)
    assert command.permit.request.data.startswith("0,10.0,1,0.000,-20.000,0.000,")


@pytest.mark.parametrize(
    ("caps", "starts"),
    [
        (Caps(19.999, 10.0), "0,10.0,1,19.999,"),
        (Caps(20.001, 10.0), "0,10.0,1,20.000,"),
        (Caps(1e9, 10.0), "0,10.0,1,20.000,"),
        (Caps(1.0, 10.0), "0,10.0,1,1.000,"),
        (Caps(20.0, 19.9), "0,19.9,1,20.000,"),
        (Caps(20.0, 20.1), "0,20.0,1,20.000,"),
        (Caps(20.0, 1e9), "0,20.0,1,20.000,"),
        (Caps(20.0, 0.1), "0,0.1,1,20.000,"),
    ],
)
def test_caps_narrow_a_stop_test_and_never_widen_it(caps: Caps, starts: str):
    command = decided(caps)
    assert isinstance(command, Command)
    assert command.permit.request.data.startswith(starts)


def test_the_sites_own_speed_holds_where_it_is_lower():
    command = decided(limits=replace(LIMITS, speed_mm_s=5.0))
    assert isinstance(command, Command)
    assert command.speed == 5.0


def test_the_fields_own_edge_holds_where_it_is_nearer():
    near = Position(Pose(1130.0, 0.0, 300.0, 180.0, 0.0, 0.0), Posture(1), 0)
    command = decided(view=replace(VIEW, position=near))
    assert isinstance(command, Command)
    assert command.plan.length < 20.0
    assert command.plan.limited_by == "outer sphere"


@pytest.mark.parametrize(
    ("how", "reason"),
    [
        ({"direction": Direction(2, 1, is_rotation=True)}, "stop_test"),
        ({"caps": Caps(0.999, 10.0)}, "stop_test"),
        ({"caps": Caps(-20.0, 10.0)}, "stop_test"),
        ({"caps": Caps(float("nan"), 10.0)}, "stop_test"),
        ({"caps": Caps(20.0, 0.099)}, "stop_test"),
        ({"caps": Caps(20.0, float("nan"))}, "stop_test"),
        ({"view": replace(VIEW, is_left_stop=False)}, "left_not_stop"),
        ({"view": replace(VIEW, is_left_stop=False, is_left_start=True)}, "left_not_stop"),
        ({"view": replace(VIEW, left_s=NOW_S - 0.126)}, "left_silent"),
        ({"view": replace(VIEW, is_armed=False)}, "not_armed"),
        ({"view": replace(VIEW, latch=StopReason.STOP_TEST)}, "latched"),
        ({"view": replace(VIEW, last_activation_id=7)}, "activation_used"),
        ({"view": replace(VIEW, is_moving=True)}, "busy"),
        ({"view": replace(VIEW, status=RobotStatus(0xC2, 0x00))}, "servo_off"),
    ],
)
def test_what_stands_against_a_stop_test(how, reason: str):
    assert refused(**how) == reason


def test_a_move_that_is_no_stop_test_still_needs_the_start_posture():
    assert refused(caps=None) == "left_not_start"


@given(length_mm=ANY_CAP, speed_mm_s=ANY_CAP, site_mm_s=st.floats(0.1, 250.0))
def test_whatever_is_asked_no_stop_test_is_longer_or_faster(length_mm, speed_mm_s, site_mm_s):
    limits = replace(LIMITS, speed_mm_s=site_mm_s)
    command = decided(Caps(length_mm, speed_mm_s), limits=limits)
    if isinstance(command, Refusal):
        assert not (length_mm >= 1.0 and speed_mm_s >= 0.1)
        return
    sent = [float(field) for field in command.permit.request.data.split(",")]
    assert 0.0 < sent[1] <= min(speed_mm_s, site_mm_s, TEST_MOST.speed_mm_s)
    assert 0.0 < sent[3] <= min(length_mm, TEST_MOST.length_mm)
    assert sent[4:9] == [0.0] * 5
