"""The gate: just under, on and just over every limit, armed and not, every blocker, white list."""

import ast
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import gestureapp
from gestureapp.robot import nx100
from gestureapp.robot.gate import (
    AHEAD_S,
    POSE_MAX_AGE_S,
    PROPOSAL_MAX_AGE_S,
    STATUS_MAX_AGE_S,
    Command,
    Permit,
    Proposal,
    arm_blocker,
    decide,
    permit,
    robot_blocker,
)
from gestureapp.robot.values import (
    Direction,
    Refusal,
    RobotStatus,
    StopReason,
)
from tests.robot.gate_view import FORWARD, HOME, LIMITS, NOW_S, READY, REST, TICK_S, VIEW

PROPOSAL = Proposal(7, FORWARD, NOW_S)


def refused(view=VIEW, proposal=PROPOSAL, limits=LIMITS, now_s=NOW_S):
    decision = decide(proposal, view, limits, now_s)
    return decision.reason if isinstance(decision, Refusal) else None


def not_armed(view=REST, limits=LIMITS, now_s=NOW_S, *, ignore_own_hold=False):
    refusal = arm_blocker(view, limits, now_s, ignore_own_hold=ignore_own_hold)
    return None if refusal is None else refusal.reason


def test_a_move_with_everything_in_order_becomes_its_bytes():
    command = decide(PROPOSAL, VIEW, LIMITS, NOW_S)

    assert isinstance(command, Command)
    assert command.permit.request.name == "IMOV"
    assert command.permit.request.data.startswith("0,100.0,1,341.895,0.000,0.000,0.00,")
    assert command.duration_s == pytest.approx(3.41895)


def test_a_turn_has_the_turning_speed_and_class():
    turn = replace(PROPOSAL, direction=Direction(2, -1, is_rotation=True))

    command = decide(turn, VIEW, LIMITS, NOW_S)

    assert command.permit.request.data.startswith("1,10.0,1,0.000,0.000,0.000,0.00,0.00,-88.00,")
    assert command.speed == 10.0
    assert command.duration_s == pytest.approx(8.8)


def test_the_speed_told_is_the_one_that_is_sent():
    command = decide(PROPOSAL, VIEW, replace(LIMITS, speed_mm_s=99.97), NOW_S)

    assert command.speed == 99.9
    assert command.permit.request.data.split(",")[1] == "99.9"


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"is_armed": False}, "not_armed"),
        ({"latch": StopReason.STOP_PRESSED}, "latched"),
        ({"latch": StopReason.LINK_LOST, "is_armed": False}, "latched"),
        ({"is_stopping": True}, "busy"),
        ({"is_releasing": True}, "busy"),
        ({"is_moving": True}, "busy"),
        ({"last_activation_id": 7}, "activation_used"),
        ({"last_activation_id": 8}, "activation_used"),
        ({"status": None}, "no_status"),
        ({"position": None}, "pose_age"),
        ({"is_left_start": False}, "left_not_start"),
        ({"is_left_start": False, "is_left_stop": True}, "left_not_start"),
    ],
)
def test_everything_that_forbids_a_move_is_named(change, reason):
    assert refused(replace(VIEW, **change)) == reason


AGES = [
    ("status_s", STATUS_MAX_AGE_S, "status_age"),
    ("position_s", POSE_MAX_AGE_S, "pose_age"),
    ("left_s", LIMITS.trip_level_s, "left_silent"),
]


@pytest.mark.parametrize(("name", "limit_s", "reason"), AGES)
def test_every_reading_may_be_as_old_as_its_limit_and_no_older(name, limit_s, reason):
    for over_s, wanted in ((-1e-6, None), (1e-6, reason)):
        view = replace(VIEW, **{name: NOW_S - limit_s - over_s})
        assert refused(view) == wanted
        assert refused(replace(view, is_armed=False)) == "not_armed"


def test_a_left_sample_exactly_as_old_as_the_trip_level_still_counts():
    assert refused(replace(VIEW, left_s=NOW_S - 0.125)) is None
    assert refused(replace(VIEW, left_s=NOW_S - 0.125 - TICK_S)) == "left_silent"


@pytest.mark.parametrize("age_s", [-TICK_S, 0.0, PROPOSAL_MAX_AGE_S - 1e-6])
def test_a_proposal_is_taken_only_from_now_until_it_is_too_old(age_s):
    early = replace(PROPOSAL, t_s=NOW_S - age_s)

    assert refused(proposal=early) == ("proposal_age" if age_s < 0 else None)
    assert refused(proposal=replace(PROPOSAL, t_s=NOW_S - PROPOSAL_MAX_AGE_S - 1e-6)) == (
        "proposal_age"
    )


@pytest.mark.parametrize("name", ["status_s", "position_s"])
def test_a_reading_from_the_future_counts_for_nothing(name):
    assert refused(replace(VIEW, **{name: NOW_S + TICK_S})) is not None


@pytest.mark.parametrize(
    ("ahead_s", "reason"),
    [(AHEAD_S - 1e-6, None), (AHEAD_S + 1e-6, "left_silent"), (9, "left_silent")],
)
def test_a_left_sample_from_the_future_lets_nothing_through(ahead_s, reason):
    assert refused(replace(VIEW, left_s=NOW_S + ahead_s)) == reason
    assert not_armed(replace(REST, left_s=NOW_S + ahead_s)) == reason


def test_a_left_arm_never_heard_is_silent():
    assert refused(replace(VIEW, left_s=float("-inf"))) == "left_silent"
    refusal = arm_blocker(replace(REST, left_s=NOW_S - 0.25), LIMITS, NOW_S, ignore_own_hold=False)
    assert refusal.text == "left sensor silent for 0.250 s, limit 0.125 s"


def at(**pose):
    return replace(VIEW, position=replace(HOME, pose=replace(HOME.pose, **pose)))


def test_what_the_field_refuses_the_gate_refuses():
    assert refused(at(x_mm=1300.0)) == "outside_field"
    assert refused(at(x_mm=1150.0)) == "at_limit"


def test_a_position_of_another_tool_moves_nothing_and_arms_nothing():
    other = replace(HOME, tool=4)
    assert refused(replace(VIEW, position=other)) == "foreign_tool"
    assert not_armed(replace(REST, position=other)) == "foreign_tool"
    limits = replace(LIMITS, tool=4)
    assert refused(replace(VIEW, position=other), limits=limits) is None
    assert not_armed(replace(REST, position=other), limits=limits) is None
    refusal = decide(PROPOSAL, replace(VIEW, position=other), LIMITS, NOW_S)
    assert refusal.text == (
        "the controller tells the position of tool 4, the settings have tool 0: "
        "select that tool on the pendant"
    )


def test_outside_the_field_nothing_is_armed():
    outside = replace(HOME, pose=replace(HOME.pose, x_mm=1300.0))
    assert not_armed(replace(REST, position=outside)) == "outside_field"


@pytest.mark.parametrize("frame", [2, 3, 25])
def test_in_a_user_frame_nothing_moves_as_the_field_is_not_known_there(frame):
    limits = replace(LIMITS, frame=frame)

    assert refused(limits=limits) == "frame"
    assert not_armed(limits=limits) == "frame"
    assert refused(limits=replace(LIMITS, frame=0)) is None


BLOCKERS = [
    (0x00, 0x10, "alarm"),
    (0x00, 0x20, "error"),
    (0x20, 0x00, "teach"),
    (0x80, 0x00, "not_remote"),
    (0x40, 0x00, "not_play"),
    (0x00, 0x40, "servo_off"),
    (0x00, 0x02, "held"),
    (0x00, 0x04, "held"),
    (0x00, 0x08, "held"),
    (0x08, 0x00, "running"),
]


@pytest.mark.parametrize(("flip_1", "flip_2", "reason"), BLOCKERS)
def test_every_state_of_the_controller_that_forbids_a_move_is_named(flip_1, flip_2, reason):
    status = RobotStatus(READY.data_1 ^ flip_1, READY.data_2 ^ flip_2)

    assert robot_blocker(status).reason == reason
    assert refused(replace(VIEW, status=status)) == reason
    assert not_armed(replace(REST, status=status)) == reason


def test_only_our_own_hold_is_overlooked_and_only_on_request():
    own = replace(READY, data_2=READY.data_2 | 0x08)
    assert robot_blocker(own, ignore_own_hold=True) is None
    assert not_armed(replace(REST, status=own), ignore_own_hold=True) is None

    for foreign in (0x02, 0x04, 0x0A):
        held = replace(READY, data_2=READY.data_2 | foreign)
        assert robot_blocker(held, ignore_own_hold=True).reason == "held"


@given(st.integers(0, 255), st.integers(0, 255))
def test_a_status_is_free_only_with_every_bit_in_its_place(data_1, data_2):
    is_free = data_1 & 0xE8 == 0xC0 and data_2 & 0x7E == 0x40

    assert (robot_blocker(RobotStatus(data_1, data_2)) is None) is is_free


def test_with_everything_in_order_permission_is_given():
    assert not_armed() is None


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"is_link_open": False}, "no_link"),
        ({"is_stopping": True}, "busy"),
        ({"is_releasing": True}, "busy"),
        ({"is_moving": True}, "busy"),
        ({"status_s": float("-inf")}, "status_age"),
        ({"position_s": float("-inf")}, "status_age"),
        ({"status_s": NOW_S - STATUS_MAX_AGE_S - 1e-6}, "status_age"),
        ({"position_s": NOW_S - STATUS_MAX_AGE_S - 1e-6}, "status_age"),
        ({"status_s": NOW_S + TICK_S}, "status_age"),
        ({"status_s": NOW_S - STATUS_MAX_AGE_S + 1e-6}, None),
        ({"status": None}, "no_status"),
        ({"left_s": NOW_S - LIMITS.trip_level_s - TICK_S}, "left_silent"),
        ({"left_s": NOW_S - LIMITS.trip_level_s}, None),
        ({"is_left_stop": False}, "left_not_stop"),
        ({"is_left_stop": False, "is_left_start": True}, "left_not_stop"),
        ({"latch": StopReason.STOP_PRESSED}, None),
    ],
)
def test_everything_that_forbids_arming_is_named(change, reason):
    assert not_armed(replace(REST, **change)) == reason


READS = [nx100.READ_STATUS, nx100.READ_ALARMS, nx100.read_pose(), nx100.read_pose(0)]
STOPS = [nx100.HOLD_ON, nx100.SERVO_OFF]
VIEWS = st.builds(
    lambda **change: replace(VIEW, **change),
    is_armed=st.booleans(),
    is_stopping=st.booleans(),
    is_releasing=st.booleans(),
    is_moving=st.booleans(),
    is_link_open=st.booleans(),
    latch=st.sampled_from([None, *StopReason]),
)


@given(VIEWS)
def test_reads_and_stops_are_always_let_through(view):
    assert [permit(request, view, LIMITS) for request in READS + STOPS] == [
        Permit(request) for request in READS + STOPS
    ]


@given(VIEWS)
def test_servo_power_comes_on_only_disarmed_and_standing(view):
    is_let = isinstance(permit(nx100.SERVO_ON, view, LIMITS), Permit)

    is_busy = view.is_armed or view.is_moving or view.is_stopping
    assert is_let is (view.is_link_open and not is_busy)


@given(VIEWS)
def test_a_hold_is_released_only_at_standstill(view):
    is_let = isinstance(permit(nx100.HOLD_OFF, view, LIMITS), Permit)

    assert is_let is not (view.is_moving or view.is_stopping)


NAMES = "IMOV MOVL MOVJ PMOVJ START RESET CANCEL DELETE LOADV IOWRITE MODE HOLD SVON RSTATS"
COMMANDS = st.builds(
    nx100.Request, st.sampled_from(NAMES.split(" ")), st.none() | st.text(max_size=5)
)


@given(COMMANDS, VIEWS)
def test_what_is_not_on_the_white_list_is_never_let_through(request, view):
    listed = {nx100.SERVO_ON, nx100.HOLD_OFF, *READS, *STOPS}
    decision = permit(request, view, LIMITS)

    assert isinstance(decision, Permit) is (request in listed and decision == Permit(request))
    if request not in listed:
        assert decision.reason == "not_listed"


@given(
    VIEWS, st.sampled_from([0, 22010, 22040, 23280]), st.integers(22000, 23300), st.integers(0, 255)
)
def test_of_the_inputs_only_the_sites_own_is_written_and_only_with_0_or_1(view, own, first, value):
    limits = replace(LIMITS, supervision_input=own)
    written = {first, own} if own else {first}
    let = [
        n for n in written if isinstance(permit(nx100.write_input(n, value), view, limits), Permit)
    ]

    assert let == ([own] if own and value in (0, 1) else [])


@pytest.mark.parametrize("number", [1, 22000, 22011, 22018, 23288, 23290, -22010])
def test_an_input_that_begins_no_byte_is_no_limit(number):
    with pytest.raises(ValueError, match="multiple of 10 from 22010 to 23280"):
        replace(LIMITS, supervision_input=number)


BOUNDS = [
    ("supervision_hz", 2.0, 10.0),
    ("speed_mm_s", 0.1, 250.0),
    ("speed_deg_s", 0.1, 30.0),
    ("frame", 0, 25),
    ("tool", 0, 23),
    ("trip_level_s", 0.05, 0.3),
    ("control_limit_s", 0.05, 0.5),
    ("gui_limit_s", 0.1, 1.0),
]


@pytest.mark.parametrize(("name", "low", "high"), BOUNDS)
def test_every_limit_has_bounds_that_no_site_can_pass(name, low, high):
    step = 1 if isinstance(low, int) else 1e-9
    for inside in (low, high, low + step, high - step):
        assert getattr(replace(LIMITS, **{name: inside}), name) == inside
    for outside in (low - step, high + step, float("nan"), float("inf"), float("-inf")):
        with pytest.raises(ValueError, match=f"{name} = .*between {low} and {high}"):
            replace(LIMITS, **{name: outside})


def test_only_the_gate_makes_a_permit_and_only_the_supervisor_sends_one():
    root = Path(gestureapp.__file__).parent
    makers, senders = set(), set()
    for path in root.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if not isinstance(node, ast.Call):
                continue
            name = node.func.attr if isinstance(node.func, ast.Attribute) else None
            name = node.func.id if isinstance(node.func, ast.Name) else name
            if name == "Permit":
                makers.add(path.relative_to(root).as_posix())
            if name == "Exchange":
                senders.add(path.relative_to(root).as_posix())

    assert makers == {"robot/gate.py"}
    assert senders == {"robot/supervisor.py"}
