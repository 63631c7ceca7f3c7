"""The emulated controller's model: held in the hand by a manual time."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gestureapp.robot import hp6
from gestureapp.robot.values import Pose, PoseIncrement, Posture
from gestureapp.simulation.controller import Controller
from gestureapp.simulation.nx100_values import (
    JOINT_RANGES_DEG,
    LIMIT_ALARM,
    Code,
    ControllerOptions,
    EndReason,
    Hold,
    Mode,
    MotionEnded,
    MotionStarted,
    Move,
)

DELAY_S = 0.004
UP_100 = Move(0, 100.0, 1, PoseIncrement(dz_mm=100.0))

lengths = st.floats(-150.0, 150.0).filter(lambda x: abs(x) > 1e-3)
speeds = st.floats(1.0, 1500.0)
moments = st.floats(0.0, 1.0)


def controller(**options):
    return Controller(ControllerOptions(**options), 0.0)


def end_of(model):
    """Let the move run out; its end event."""
    while model.next_event_s < math.inf:
        model.advance(model.next_event_s)
    return next(e for e in reversed(model.take_events()) if isinstance(e, MotionEnded))


def test_controller_starts_with_the_status_recorded_on_a_real_one():
    assert controller().status(0.0) == (194, 64)


def test_running_bit_is_up_from_the_start_delay_to_the_end():
    model = controller()
    assert model.move(UP_100, 0.0) is Code.OK
    assert model.status(0.003)[0] == 194
    assert model.status(0.005)[0] == 202
    assert model.status(1.0)[0] == 202
    assert model.status(1.2)[0] == 194


def test_move_takes_length_over_speed_plus_one_ramp():
    model = controller()
    model.move(UP_100, 10.0)
    model.advance(20.0)
    started, ended = model.take_events()
    assert started == MotionStarted(10.0 + DELAY_S, Pose(800.0, 0.0, 300.0, 180.0, 0.0, 0.0))
    assert ended.t_s - started.t_s == pytest.approx(100.0 / 100.0 + 100.0 / 1000.0)
    assert ended.reason is EndReason.DONE


@given(lengths, lengths, lengths, speeds)
def test_move_ends_exactly_at_the_increment(dx, dy, dz, speed):
    model = controller()
    model.move(Move(0, speed, 1, PoseIncrement(dx, dy, dz)), 0.0)
    pose = end_of(model).pose
    assert pose == Pose(800.0 + dx, dy, 300.0 + dz, 180.0, 0.0, 0.0)
    assert model.pose(1e6) == pose


@given(lengths, speeds, moments, moments)
def test_position_never_goes_back_overshoots_or_outruns_the_speed(length, speed, one, other):
    model, whole_s = controller(), abs(length) / speed + speed / 1000.0 + 0.1
    model.move(Move(0, speed, 1, PoseIncrement(dy_mm=length)), 0.0)
    early_s, late_s = sorted((one * whole_s, other * whole_s))
    early, late = abs(model.pose(early_s).y_mm), abs(model.pose(late_s).y_mm)
    assert 0.0 <= early <= late <= abs(length)
    assert late - early <= speed * (late_s - early_s) * (1 + 1e-6) + 1e-6


@given(lengths, speeds, moments)
def test_hold_stops_on_the_path_within_the_braking_distance(length, speed, moment):
    model = controller()
    model.move(Move(0, speed, 1, PoseIncrement(dx_mm=length)), 0.0)
    hold_s = DELAY_S + moment * (abs(length) / speed)
    before = model.pose(hold_s)
    if not model.is_running(hold_s):
        return
    model.command_hold(True, hold_s)
    ended = end_of(model)
    further = (ended.pose.x_mm - before.x_mm) * math.copysign(1.0, length)
    assert -1e-9 <= further <= speed**2 / 2000.0 + 1e-6
    assert ended.t_s - hold_s <= speed / 1000.0 + 1e-6
    assert abs(ended.pose.x_mm - 800.0) <= abs(length) + 1e-9
    assert ended.pose.position_mm[1:] == (0.0, 300.0)
    assert model.is_servo_on
    assert model.status(ended.t_s) == (194, 72)


def test_hold_before_the_start_delay_is_over_keeps_the_arm_still():
    model = controller()
    model.move(UP_100, 0.0)
    model.command_hold(True, 0.001)
    model.advance(10.0)
    assert model.take_events() == []
    assert model.pose(10.0).z_mm == 300.0


def test_released_hold_discards_the_rest_by_default():
    model = controller()
    model.move(UP_100, 0.0)
    model.command_hold(True, 0.5)
    model.command_hold(False, 2.0)
    model.advance(10.0)
    assert [type(e) for e in model.take_events()] == [MotionStarted, MotionEnded]
    assert 340.0 < model.pose(10.0).z_mm < 360.0
    assert model.move(UP_100, 10.0) is Code.OK


@pytest.mark.parametrize("release_s", [0.51, 2.0], ids=["while slowing down", "at standstill"])
def test_released_hold_goes_on_with_the_rest_where_the_controller_does_that(release_s):
    model = controller(resumes_after_hold=True)
    model.move(UP_100, 0.0)
    model.command_hold(True, 0.5)
    model.command_hold(False, release_s)
    model.advance(20.0)
    kinds = [type(e) for e in model.take_events()]
    assert kinds == [MotionStarted, MotionEnded, MotionStarted, MotionEnded]
    assert model.pose(20.0).z_mm == pytest.approx(400.0)


def test_rest_waits_until_the_last_hold_is_released():
    model = controller(resumes_after_hold=True)
    model.move(UP_100, 0.0)
    model.command_hold(True, 0.5)
    model.set_hold(Hold.EXTERNAL, True, 1.0)
    model.command_hold(False, 2.0)
    assert model.next_event_s == math.inf
    model.set_hold(Hold.EXTERNAL, False, 3.0)
    assert end_of(model).pose.z_mm == pytest.approx(400.0)


def test_move_held_before_it_began_is_whole_when_it_goes_on():
    model = controller(resumes_after_hold=True)
    model.move(UP_100, 0.0)
    model.set_hold(Hold.PENDANT, True, 0.001)
    model.set_hold(Hold.PENDANT, False, 5.0)
    assert not model.is_running(5.001)
    assert end_of(model).pose.z_mm == 400.0


def test_rest_is_gone_after_servo_off_even_where_holds_resume():
    model = controller(resumes_after_hold=True)
    model.move(UP_100, 0.0)
    model.command_hold(True, 0.5)
    model.command_servo(False, 2.0)
    model.command_servo(True, 3.0)
    model.command_hold(False, 4.0)
    assert model.next_event_s == math.inf


def test_servo_off_stops_at_once():
    model = controller()
    model.move(UP_100, 0.0)
    at = model.pose(0.5)
    model.command_servo(False, 0.5)
    (_, ended) = model.take_events()
    assert ended == MotionEnded(0.5, at, EndReason.SERVO_OFF)
    assert model.status(0.5) == (194, 0)


def test_leaving_play_slows_down_and_forgets_the_rest():
    model = controller(resumes_after_hold=True)
    model.move(UP_100, 0.0)
    model.command_hold(True, 0.5)
    model.set_mode(Mode.TEACH, 0.51)
    assert end_of(model).reason is EndReason.MODE
    model.set_mode(Mode.PLAY, 2.0)
    model.command_hold(False, 3.0)
    assert not model.is_running(3.1)


@pytest.mark.parametrize(
    ("hinder", "code"),
    [
        (lambda m: m.set_remote(False, 0.0), Code.NOT_REMOTE),
        (lambda m: m.set_mode(Mode.TEACH, 0.0), Code.MODE),
        (lambda m: m.raise_alarm(4100, 0, 0.0), Code.ALARM),
        (lambda m: m.raise_error(2060, 0, 0.0), Code.ALARM),
        (lambda m: m.set_hold(Hold.PENDANT, True, 0.0), Code.PENDANT_HOLD),
        (lambda m: m.set_hold(Hold.EXTERNAL, True, 0.0), Code.EXTERNAL_HOLD),
        (lambda m: m.command_hold(True, 0.0), Code.COMMAND_HOLD),
        (lambda m: m.set_servo(False, 0.0), Code.SERVO_OFF),
        (lambda m: m.move(UP_100, 0.0), Code.MOVING),
    ],
)
def test_move_is_refused_with_the_code_of_its_hindrance(hinder, code):
    model = controller()
    hinder(model)
    assert model.move(UP_100, 0.001) is code


def test_second_move_leaves_the_first_one_alone():
    model = controller()
    model.move(UP_100, 0.0)
    assert model.move(Move(0, 50.0, 1, PoseIncrement(dx_mm=9.0)), 0.5) is Code.MOVING
    assert end_of(model).pose.position_mm == (800.0, 0.0, 400.0)


def test_leaving_the_reach_is_an_alarm_that_reset_and_servo_on_recover():
    model = controller()
    assert model.move(Move(0, 200.0, 1, PoseIncrement(dx_mm=900.0)), 0.0) is Code.OK
    ended = end_of(model)
    assert ended.reason is EndReason.ALARM
    x, _, z = hp6.wrist_mm(ended.pose)
    stretched = hp6.LOWER_ARM_MM + hp6.ELBOW_TO_WRIST_MM
    assert math.hypot(x - hp6.SHOULDER_OUT_MM, z) == pytest.approx(stretched, abs=1e-3)
    assert model.status(ended.t_s) == (194, 0x10)
    back, t_s = Move(0, 200.0, 1, PoseIncrement(dx_mm=-50.0)), ended.t_s + 1.0
    assert model.move(back, t_s) is Code.ALARM
    assert model.command_servo(True, t_s) is Code.ALARM
    assert model.reset(t_s) is Code.OK
    assert model.move(back, t_s) is Code.SERVO_OFF
    assert model.command_servo(True, t_s) is Code.OK
    assert model.move(back, t_s) is Code.OK
    assert end_of(model).reason is EndReason.DONE


@pytest.mark.parametrize(
    ("increment", "posture"),
    [
        (PoseIncrement(drz_deg=-355.0), 17),  # T, which turned more than half a turn
        (PoseIncrement(dry_deg=-120.0), 1),  # through a straight wrist
        (PoseIncrement(dx_mm=-700.0), 1),  # the forearm against the lower arm
        (PoseIncrement(dy_mm=1500.0), 1),  # stretched
    ],
)
def test_a_joint_at_its_limit_is_an_alarm_on_the_way(increment, posture):
    start = Pose(800.0, 0.0, 300.0, 180.0, 0.0, 0.0)
    model = controller(joint_ranges_deg=(*JOINT_RANGES_DEG[:5], (-300.0, 300.0)))
    assert model.move(Move(1, 100.0, 1, increment), 0.0) is Code.OK

    ended = end_of(model)

    assert ended.reason is EndReason.ALARM
    assert ended.pose != start
    assert model.alarms == [(LIMIT_ALARM, 0)]
    assert not model.is_servo_on
    assert hp6.posture_of(model.joints(ended.t_s)) == Posture(posture)
    # The joints are those of the place, not of where the move would have led.
    at = hp6.tool_pose(model.joints(ended.t_s))
    assert at.position_mm == pytest.approx(ended.pose.position_mm, abs=1e-6)
    t_s = ended.t_s + 1.0
    back = PoseIncrement(
        *(-part / 50 for part in (*increment.translation_mm, *increment.rotation_deg))
    )
    assert model.move(Move(1, 100.0, 1, back), t_s) is Code.ALARM
    assert model.reset(t_s) is Code.OK
    assert model.command_servo(True, t_s) is Code.OK
    assert model.move(Move(1, 100.0, 1, back), t_s) is Code.OK
    assert end_of(model).reason is EndReason.DONE


def test_rotation_by_class_1_takes_angle_over_speed():
    model = controller()
    model.move(Move(1, 10.0, 1, PoseIncrement(drx_deg=20.0)), 0.0)
    model.advance(60.0)
    started, ended = model.take_events()
    assert ended.t_s - started.t_s == pytest.approx(20.0 / 10.0 + 10.0 / 400.0)
    assert ended.pose == Pose(800.0, 0.0, 300.0, -160.0, 0.0, 0.0)


def test_rotation_by_class_0_is_not_limited_by_its_speed():
    model = controller()
    model.move(Move(0, 1.0, 1, PoseIncrement(drz_deg=90.0)), 0.0)
    assert end_of(model).t_s < 1.5


def test_servo_comes_on_after_its_delay():
    model = controller(servo_on_delay_s=0.4)
    model.command_servo(False, 0.0)
    model.command_servo(True, 1.0)
    assert model.status(1.39)[1] == 0
    assert model.status(1.41)[1] == 64


def test_user_frame_turns_the_increment():
    model = controller(user_frames={1: Pose(100.0, 0.0, 0.0, 0.0, 0.0, 90.0)})
    assert model.move(Move(0, 50.0, 2, PoseIncrement(dx_mm=10.0)), 0.0) is Code.OK
    assert end_of(model).pose.position_mm == pytest.approx((800.0, 10.0, 300.0))
    in_user = model.pose_in(2, 100.0)
    assert isinstance(in_user, Pose)
    assert in_user.position_mm == pytest.approx((10.0, -700.0, 300.0))
    assert model.move(Move(0, 50.0, 3, PoseIncrement(dx_mm=10.0)), 100.0) is Code.USER_FRAME


def test_ladder_holds_when_its_input_stops_changing_and_lets_go_when_it_changes():
    model = controller(ladder_s=0.5)
    model.advance(100.0)
    assert model.holds is Hold.NONE
    model.write_inputs(22010, [1], 100.0)
    model.write_inputs(22010, [1], 100.4)
    assert model.status(100.49)[1] == 64
    assert model.status(100.51)[1] == 68
    model.write_inputs(22010, [0], 101.0)
    assert model.status(101.0)[1] == 64


def test_arm_is_put_elsewhere_only_at_standstill():
    model = controller()
    model.move(UP_100, 0.0)
    assert not model.set_pose(Pose(700.0, 0.0, 0.0, 180.0, 0.0, 0.0), 0.5)
    assert model.set_pose(Pose(700.0, 0.0, 0.0, 190.0, 0.0, 0.0), 5.0)
    assert model.pose(5.0) == Pose(700.0, 0.0, 0.0, -170.0, 0.0, 0.0)


@settings(max_examples=60)
@given(
    st.lists(
        st.tuples(
            st.sampled_from(
                ["move", "hold", "free", "off", "on", "teach", "play", "alarm", "reset"]
            ),
            st.floats(0.0, 0.4),
        ),
        max_size=30,
    ),
    st.booleans(),
)
def test_no_sequence_makes_the_arm_jump_or_its_events_disagree(steps, resumes):
    model, t_s = controller(resumes_after_hold=resumes), 0.0
    pose, moving = model.pose(0.0), False
    for word, wait_s in steps:
        {
            "move": lambda t: model.move(Move(0, 250.0, 1, PoseIncrement(dz_mm=60.0)), t),
            "hold": lambda t: model.command_hold(True, t),
            "free": lambda t: model.command_hold(False, t),
            "off": lambda t: model.command_servo(False, t),
            "on": lambda t: model.command_servo(True, t),
            "teach": lambda t: model.set_mode(Mode.TEACH, t),
            "play": lambda t: model.set_mode(Mode.PLAY, t),
            "alarm": lambda t: model.raise_alarm(4100, 0, t),
            "reset": lambda t: model.reset(t),
        }[word](t_s)
        assert model.pose(t_s).z_mm == pytest.approx(pose.z_mm, abs=1e-9)
        t_s += wait_s
        after = model.pose(t_s)
        assert 0.0 <= after.z_mm - pose.z_mm <= 250.0 * wait_s + 1e-6
        pose = after
        for event in model.take_events():
            assert isinstance(event, MotionStarted) is not moving
            moving = not moving
        assert model.is_running(t_s) is moving
        if moving:
            assert model.is_servo_on
