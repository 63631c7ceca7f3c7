"""A controller that goes on with an interrupted move: seen once, then led to servo off."""

import pytest

from gestureapp.robot import messages as m
from gestureapp.robot.values import StopReason


@pytest.fixture
def resuming(cell):
    cell.robot.resumes = True
    return cell


def stop_and_go_back(cell, reason=StopReason.STOP_PRESSED):
    cell.move()
    cell.stop(reason)
    cell.posture = "stop"
    cell.until(lambda: not cell.supervisor.is_stopping)
    cell.run(0.3)


def went_on(cell):
    return [x for x in cell.heard(m.StopAsked) if x.reason is StopReason.UNEXPECTED_MOTION]


def see_it_go_on(cell):
    """Stopped, armed again, and the rest of the move runs for a moment."""
    stop_and_go_back(cell)
    cell.say(m.Arm())
    cell.until(lambda: went_on(cell))
    cell.until(lambda: not cell.supervisor.is_stopping)


def recover(cell):
    cell.say(m.ServoOff())
    cell.until(lambda: not cell.heard(m.Hindrances)[-1].refusals)
    cell.say(m.ServoOn())
    cell.run(0.6)


def refusal_of(cell):
    cell.told.clear()
    cell.say(m.Arm())
    (denied,) = cell.heard(m.ArmRefused)
    return denied.refusal.reason


def test_arming_never_releases_a_move_that_is_known_to_be_kept(resuming):
    see_it_go_on(resuming)
    pose = resuming.robot.pose
    resuming.forget()

    for _ in range(5):
        assert refusal_of(resuming) == "move_kept"
        resuming.run(0.5)
    assert "HOLD 0" not in resuming.asked()
    assert resuming.robot.pose == pose


@pytest.mark.parametrize("discard", ["servo", "key"])
def test_servo_off_or_teach_discards_it_and_the_way_is_free(resuming, discard):
    see_it_go_on(resuming)
    if discard == "servo":
        recover(resuming)
    else:
        resuming.robot.data_1 ^= 0x60
        resuming.robot.rest = None
        resuming.run(0.5)
        assert refusal_of(resuming) == "teach"
        resuming.robot.data_1 ^= 0x60
        resuming.run(0.5)
    resuming.arm()
    resuming.run(1.0)

    assert resuming.supervisor.is_armed
    assert not resuming.robot.is_running


def test_twenty_stops_are_recovered_and_the_robot_goes_on_by_itself_once(resuming):
    for _ in range(20):
        stop_and_go_back(resuming, StopReason.LEFT_ARM)
        if resuming.supervisor.is_armed:
            resuming.until(lambda: not resuming.supervisor.is_armed)
        resuming.until(lambda: not resuming.supervisor.is_stopping)
        resuming.told[:] = [item for item in resuming.told if isinstance(item[1], m.Hindrances)]
        recover(resuming)
        resuming.arm()
        resuming.told.clear()

    reasons = [item.message.reason for item in resuming.story if is_stop(item)]
    assert reasons.count(StopReason.UNEXPECTED_MOTION) == 1
    assert reasons.count(StopReason.LEFT_ARM) == 20


def is_stop(item):
    return isinstance(getattr(item, "message", None), m.StopAsked)


def test_twenty_stops_of_a_controller_that_forgets_need_no_servo_off(cell):
    for _ in range(20):
        stop_and_go_back(cell, StopReason.LEFT_ARM)
        assert cell.supervisor.is_armed
        cell.until(lambda: not cell.robot.is_held)
        cell.forget_told()

    assert "SVON 0" not in cell.asked()


def test_after_the_left_arms_own_stop_permission_ends_where_moves_are_kept(resuming):
    see_it_go_on(resuming)
    recover(resuming)
    resuming.arm()
    resuming.forget()
    stop_and_go_back(resuming, StopReason.LEFT_ARM)

    kinds = [type(message) for _, message in resuming.told]
    assert kinds.index(m.Disarmed) < kinds.index(m.StopConfirmed)
    assert "HOLD 0" not in resuming.asked()


def test_a_move_that_came_to_its_end_leaves_nothing(resuming):
    see_it_go_on(resuming)
    recover(resuming)
    resuming.arm()
    resuming.told.clear()
    resuming.move()
    resuming.until(lambda: resuming.heard(m.MotionEnded))
    resuming.posture = "stop"
    resuming.stop(StopReason.STOP_PRESSED)
    resuming.until(lambda: not resuming.supervisor.is_stopping)
    resuming.run(0.3)
    resuming.arm()


def test_servo_off_is_taken_only_disarmed_and_standing(cell):
    cell.move()
    cell.say(m.ServoOff())
    cell.run(0.2)

    assert "SVON 0" not in cell.asked()
    assert cell.heard(m.Notice)[0].text.startswith("servo power was not switched off")


def test_a_rest_that_runs_while_the_next_gesture_is_decided_is_seen_by_the_position(resuming):
    """RSTATS is left out then; the position is not."""
    resuming.move()
    resuming.robot.start_s = 0.1
    resuming.posture = "neither"
    resuming.until(lambda: resuming.heard(m.StopConfirmed))
    resuming.posture = "stop"
    resuming.until(lambda: resuming.heard(m.HoldReleased))
    resuming.posture = "start"
    took_s = resuming.until(lambda: went_on(resuming))

    assert took_s < 0.2
