"""The stop path, an open move, a release and the clocks by themselves, in exact times."""

from dataclasses import replace

import pytest

from gestureapp.robot import messages as m
from gestureapp.robot import nx100
from gestureapp.robot.commands import Commands
from gestureapp.robot.gate import GateView, Proposal, decide
from gestureapp.robot.motion import START_LIMIT_S, Motion, Reached, StoppedShort
from gestureapp.robot.nx100 import Done, Failure
from gestureapp.robot.permission import Permission
from gestureapp.robot.release import Release
from gestureapp.robot.stopping import STILL_APART_S, Standstill, StopPath, is_same_place
from gestureapp.robot.values import Direction, Pose, Position, Posture, RobotStatus, StopReason
from gestureapp.robot.watchdog import IDLE_TICK_S, TICK_S, next_look_s

POSE = Pose(800.0, 0.0, 300.0, 180.0, 0.0, 0.0)
IDLE, RUNNING = RobotStatus(0xC2, 0x40), RobotStatus(0xCA, 0x40)
HERE = Position(POSE, Posture(1), 0)
READ_POSE = nx100.read_pose()
VIEW = GateView(
    True, None, False, False, False, 0, IDLE, 0.0, HERE, 0.0, 0.0, True, False, True
)  # fmt: skip


def at(x_mm):
    return replace(HERE, pose=replace(POSE, x_mm=x_mm))


def stopping(reason=StopReason.STOP_PRESSED, now_s=0.0):
    path = StopPath()
    path.ask(reason, now_s)
    return path


def tell(path, request, answer, now_s):
    path.sent(request, now_s)
    path.answered(request, answer, now_s)


def held(path, now_s=0.0):
    tell(path, nx100.HOLD_ON, Done(), now_s)


def test_what_was_asked_before_the_stop_says_nothing_about_standing():
    path = stopping()
    path.answered(nx100.READ_STATUS, IDLE, 0.0)
    held(path)
    for t_s in (0.1, 0.2):
        tell(path, READ_POSE, HERE, t_s)
    assert path.check(0.2) is None

    tell(path, nx100.READ_STATUS, IDLE, 0.2)
    assert path.check(0.2) == Standstill(StopReason.STOP_PRESSED, 0.2, POSE)


def test_two_equal_positions_are_a_standstill_only_some_time_apart():
    path = stopping()
    held(path)
    tell(path, nx100.READ_STATUS, IDLE, 0.0)
    tell(path, READ_POSE, HERE, 0.0)
    tell(path, READ_POSE, HERE, STILL_APART_S - 0.001)
    assert path.check(0.5) is None

    tell(path, READ_POSE, HERE, STILL_APART_S)
    assert path.check(0.5).pose == POSE


def test_a_robot_that_moves_on_after_it_seemed_to_stand_does_not_stand():
    path = stopping()
    held(path)
    for t_s in (0.0, 0.1):
        tell(path, READ_POSE, HERE, t_s)
    tell(path, READ_POSE, at(x_mm=801.0), 0.2)
    tell(path, nx100.READ_STATUS, IDLE, 0.2)
    assert path.check(0.2) is None

    tell(path, READ_POSE, at(x_mm=801.0), 0.3)
    assert path.check(0.3).pose.x_mm == 801.0


def test_a_robot_that_still_creeps_does_not_stand():
    path = stopping()
    held(path)
    tell(path, nx100.READ_STATUS, IDLE, 0.0)
    for i in range(9):
        tell(path, READ_POSE, at(x_mm=800.0 + 0.06 * i), 0.1 * i)
        assert path.check(0.1 * i) is None


def test_a_running_bit_takes_back_what_seemed_to_stand():
    path = stopping()
    held(path)
    for t_s in (0.0, 0.1):
        tell(path, READ_POSE, HERE, t_s)
    tell(path, nx100.READ_STATUS, RUNNING, 0.1)
    tell(path, nx100.READ_STATUS, IDLE, 0.2)

    assert path.check(0.2) is None


@pytest.mark.parametrize("again", ["held", "status", "pose"])
def test_after_a_lost_link_everything_has_to_be_read_again(again):
    path = stopping()
    held(path)
    tell(path, nx100.READ_STATUS, IDLE, 0.0)
    tell(path, READ_POSE, HERE, 0.0)
    path.link_broken()
    assert path.next_request(0.1, 1) == nx100.HOLD_ON
    if again != "held":
        held(path, 0.1)
    else:
        tell(path, nx100.HOLD_ON, Failure(2100, "x"), 0.1)
    if again != "status":
        tell(path, nx100.READ_STATUS, IDLE, 0.1)
    if again != "pose":
        tell(path, READ_POSE, HERE, 0.1)

    assert path.check(0.2) is None


def test_nothing_that_is_answered_without_a_stop_counts():
    path = StopPath()
    held(path)

    assert path.check(9.0) is None
    assert not path.is_active


def test_a_stop_with_a_latched_reason_says_so_once():
    path = stopping(StopReason.LEFT_ARM)

    assert not path.ask(StopReason.LEFT_ARM, 0.1)
    assert path.ask(StopReason.LINK_LOST, 0.2)
    assert not path.ask(StopReason.STOP_PRESSED, 0.3)
    assert path.reason is StopReason.LINK_LOST
    assert path.asked_s == 0.0


@pytest.mark.parametrize(
    ("change", "is_same"),
    [
        ({"x_mm": 800.049}, True),
        ({"x_mm": 800.051}, False),
        ({"ry_deg": 0.049}, True),
        ({"ry_deg": -0.051}, False),
        ({"rx_deg": -180.0}, True),
        ({"rx_deg": -179.96}, True),
        ({"rx_deg": -179.94}, False),
    ],
)
def test_the_same_place_is_within_a_standing_robots_read_back(change, is_same):
    assert is_same_place(
        Pose(800.0, 0.0, 0.0, 180.0, 0.0, 0.0), replace(POSE, z_mm=0.0, **change)
    ) is (is_same)


# An open move.


@pytest.fixture
def motion(limits):
    command = decide(Proposal(1, Direction(0, 1, is_rotation=False), 0.0), VIEW, limits, 0.0)
    moving = Motion(command, 0.0)
    moving.accepted(0.0)
    return moving


def test_a_status_from_before_the_acceptance_says_nothing(limits):
    command = decide(Proposal(1, Direction(0, 1, is_rotation=False), 0.0), VIEW, limits, 0.0)
    moving = Motion(command, 0.0)
    moving.note_status(RUNNING, 0.0)
    assert moving.check(99.0) is None
    moving.accepted(0.5)
    moving.note_status(RUNNING, 0.4)
    moving.note_status(IDLE, 0.6)
    moving.note_pose(POSE, 0.6)

    assert moving.check(0.6) is None  # not seen running, not yet overdue to start


def test_the_position_must_have_been_asked_after_the_robot_was_idle(motion):
    motion.note_status(RUNNING, 0.1)
    motion.note_pose(POSE, 0.2)
    motion.note_status(IDLE, 3.5)
    assert motion.check(3.5) is None

    motion.note_pose(motion.command.plan.end, 3.5)
    assert motion.check(3.5) == Reached(motion.command.plan.end)


def test_a_robot_that_runs_again_has_not_ended(motion):
    motion.note_status(IDLE, 0.1)
    motion.note_status(RUNNING, 0.2)
    motion.note_pose(POSE, 0.3)

    assert motion.check(9.0 - 1.0) is None


@pytest.mark.parametrize(
    ("asked_s", "is_over"), [(START_LIMIT_S - 0.001, False), (START_LIMIT_S, True)]
)
def test_a_move_never_began_when_it_is_idle_after_the_time_to_start(motion, asked_s, is_over):
    motion.note_status(IDLE, asked_s)
    motion.note_pose(POSE, asked_s)

    assert isinstance(motion.check(5.0), StoppedShort) is is_over


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"x_mm": 1141.895 - 0.49}, None),
        ({"x_mm": 1141.895 - 0.51}, "the robot stands 0.5 mm before the end"),
        ({"x_mm": 1141.895, "rx_deg": -179.81}, None),
        ({"x_mm": 1141.895, "rx_deg": -179.79}, "the robot stands 0.2 deg before the end"),
    ],
)
def test_the_end_is_reached_within_what_the_controller_reads_back(motion, change, text):
    motion.note_status(RUNNING, 0.1)
    motion.note_status(IDLE, 3.5)
    motion.note_pose(replace(POSE, **change), 3.6)

    assert getattr(motion.check(3.6), "text", None) == text


def test_an_answer_to_a_move_that_is_no_longer_open_is_nothing():
    assert Commands().answered(Done(), 0.0) is None


# Permission, release, clocks.


def test_permission_that_nobody_asked_for_is_not_given():
    permission = Permission()

    assert permission.settle(None, 0.0) is None
    assert not permission.is_armed
    assert permission.give_up("x") is None
    assert permission.lose() is None


def test_a_release_goes_position_hold_off_state_and_says_once_that_it_is_done():
    release = Release()
    release.begin()
    assert not release.may_begin(9.0)
    assert release.next_request(1) == READ_POSE
    release.answered(nx100.READ_ALARMS, nx100.Alarms(()), 0.0)
    release.answered(READ_POSE, HERE, 0.0)
    assert release.next_request(1) == nx100.HOLD_OFF
    release.answered(nx100.HOLD_OFF, Done(), 1.0)
    assert release.is_watching(1.499)
    assert not release.is_watching(1.5)
    assert release.next_request(1) == nx100.READ_STATUS
    release.answered(nx100.READ_STATUS, IDLE, 1.1)

    assert (release.take_done(), release.take_done()) == (True, False)
    assert release.next_request(1) is None
    assert release.may_begin(1.1)


def test_the_clocks_are_looked_at_when_the_next_watchdog_is_due(limits):
    beat = m.Beat(left_s=10.0, is_left_start=False, is_left_stop=True, control_s=10.0, gui_s=10.0)

    assert next_look_s(beat, limits, 10.0, may_move=False) == 10.0 + IDLE_TICK_S
    assert next_look_s(None, limits, 10.0, may_move=True) == 10.0 + TICK_S
    assert next_look_s(beat, limits, 10.0, may_move=True) == 10.0 + TICK_S
    assert 10.125 < next_look_s(beat, limits, 10.124, may_move=True) < 10.126
    assert next_look_s(beat, limits, 11.0, may_move=True) == 11.0 + TICK_S


def test_servo_power_asked_for_just_before_arming_is_not_sent(cell):
    cell.until(lambda: not cell.supervisor._exchange.can_send)
    cell.say(m.ServoOn())
    cell.say(m.Arm())
    cell.run(0.2)

    assert cell.supervisor.is_armed
    assert "SVON 1" not in cell.asked()
    assert "was not sent" in cell.heard(m.Notice)[0].text
