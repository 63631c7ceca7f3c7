"""What stands against arming: every blocker, its remedy, their order; unknown is not ready."""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gestureapp.cell.controls import SETUP_OPEN, TRAINING_OPEN
from gestureapp.cell.fitness import FIT, NOT_CALIBRATED, Judgement
from gestureapp.cell.limits import field_of
from gestureapp.cell.readiness import Facts, find_blockers
from gestureapp.config import Settings
from gestureapp.robot.gate import STATUS_MAX_AGE_S
from gestureapp.robot.values import Pose, Position, Posture, Refusal, RobotStatus
from gestureapp.sensing.values import LinkState, Side, StreamHealth

REMOTE_PLAY, SERVO = 0xC0, 0x40


def healthy(side: Side) -> StreamHealth:
    return StreamHealth(
        side=side,
        link=LinkState.RECEIVING,
        is_alive=True,
        is_valid=True,
        is_freq_ok=True,
        reason="",
        age_s=0.004,
        rate_hz=100.0,
        worst_gap_s=0.012,
        n_samples=1000,
        n_bad=0,
        n_lost=0,
    )


HOME = Position(Pose(800.0, 0.0, 300.0, 180.0, 0.0, 0.0), Posture(1), 0)
READY = Facts(
    left=healthy(Side.LEFT),
    right=healthy(Side.RIGHT),
    stop_seen_s=0.5,
    stop_wanted_s=0.5,
    model_problem="",
    is_link_open=True,
    link_text="OK: NX Information Server",
    status=RobotStatus(REMOTE_PLAY, SERVO),
    status_age_s=0.1,
    position=HOME,
    pose_age_s=0.1,
    field=field_of(Settings()),
    tool=0,
    left_fit=FIT,
    right_fit=FIT,
)
SILENT = "no data for 450 ms: switch the sensor on, bring it closer"


def silent(side: Side) -> StreamHealth:
    return replace(healthy(side), is_alive=False, link=LinkState.NO_DATA, reason=SILENT)


@pytest.mark.parametrize("side", Side)
def test_a_sensor_that_nobody_has_judged_stands_against_arming(side: Side):
    (blocker,) = find_blockers(replace(READY, **{f"{side.value}_fit": NOT_CALIBRATED}))
    assert blocker.text == f"{side.value} sensor: not calibrated"
    assert blocker.remedy == "Setup, step Calibrate"


def test_facts_that_say_nothing_of_calibration_say_that_it_is_missing():
    unknown = {"left_fit", "right_fit"}
    facts = Facts(**{n: getattr(READY, n) for n in Facts.__slots__ if n not in unknown})
    assert [b.id for b in find_blockers(facts)] == ["left_unfit", "right_unfit"]


def test_postures_too_close_together_stand_against_arming():
    judgement = Judgement("stop and start are only 60 degrees apart", "record them again")
    (blocker,) = find_blockers(replace(READY, postures_fit=judgement))
    assert (blocker.id, blocker.text, blocker.remedy) == (
        "postures",
        judgement.problem,
        judgement.remedy,
    )


@pytest.mark.parametrize(("why", "name"), [(TRAINING_OPEN, "lock"), (SETUP_OPEN, "setup")])
def test_an_open_page_stands_against_arming(why: str, name: str):
    assert [(b.id, b.text) for b in find_blockers(replace(READY, lock=why))] == [(name, why)]


def test_nothing_stands_against_arming_when_all_is_well():
    assert find_blockers(READY) == ()


CASES = {
    "left silent": (replace(READY, left=silent(Side.LEFT)), "left_sensor", "no data for 450 ms"),
    "right silent": (
        replace(READY, right=silent(Side.RIGHT)),
        "right_sensor",
        "right sensor: no data",
    ),
    "not in stop": (replace(READY, stop_seen_s=None), "left_stop", "not in the stop posture"),
    "too short in stop": (replace(READY, stop_seen_s=0.31), "left_stop", "0.3 s, 0.5 s are needed"),
    "move kept": (
        replace(READY, hindrances=(Refusal("move_kept", "the controller goes on"),)),
        "move_kept",
        "goes on",
    ),
    "supervision": (
        replace(READY, hindrances=(Refusal("supervision", "it does not work"),)),
        "supervision",
        "does not work",
    ),
    "training": (replace(READY, lock="a training is running"), "lock", "a training is running"),
    "no model": (replace(READY, model_problem="no model is set"), "model", "no model is set"),
    "no link": (
        replace(READY, is_link_open=False, link_text="10.0.0.2:80: no route"),
        "robot_link",
        "the robot does not answer: 10.0.0.2:80: no route",
    ),
    "old status": (replace(READY, status_age_s=1.26), "robot_link", "1.3 s old"),
    "no status": (replace(READY, status=None), "robot_state", "has not told its state"),
    "alarm": (replace(READY, status=RobotStatus(REMOTE_PLAY, 0x50)), "robot_state", "alarm"),
    "error": (replace(READY, status=RobotStatus(REMOTE_PLAY, 0x60)), "robot_state", "error"),
    "teach": (replace(READY, status=RobotStatus(0xA0, SERVO)), "robot_state", "TEACH"),
    "local": (replace(READY, status=RobotStatus(0x40, SERVO)), "robot_state", "command remote"),
    "no play": (replace(READY, status=RobotStatus(0x80, SERVO)), "robot_state", "play mode"),
    "servo off": (replace(READY, status=RobotStatus(REMOTE_PLAY, 0)), "robot_state", "servo power"),
    "held": (replace(READY, status=RobotStatus(REMOTE_PLAY, 0x42)), "robot_state", "held"),
    "input": (replace(READY, status=RobotStatus(REMOTE_PLAY, 0x44)), "robot_state", "held"),
    "running": (replace(READY, status=RobotStatus(0xC8, SERVO)), "robot_state", "running"),
    "no pose": (replace(READY, position=None), "robot_pose", "has not told its position"),
    "other tool": (
        replace(READY, position=replace(HOME, tool=2)),
        "robot_pose",
        "tells the position of tool 2, the settings have tool 0",
    ),
    "old pose": (replace(READY, pose_age_s=1.26), "robot_pose", "position is 1.3 s old"),
    "outside": (
        replace(READY, position=replace(HOME, pose=replace(HOME.pose, x_mm=1300.0, z_mm=0.0))),
        "robot_pose",
        "1300",
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_each_thing_stands_alone_with_what_was_found_and_a_remedy(case):
    facts, name, words = CASES[case]
    (blocker,) = find_blockers(facts)
    assert blocker.id == name
    assert words in blocker.text
    assert blocker.remedy
    assert blocker.remedy not in blocker.text


def test_a_hold_by_command_is_released_by_arming_and_stands_against_nothing():
    assert find_blockers(replace(READY, status=RobotStatus(REMOTE_PLAY, SERVO | 0x08))) == ()


def test_on_the_limits_it_is_still_ready():
    at_limit = replace(
        READY, status_age_s=STATUS_MAX_AGE_S, pose_age_s=STATUS_MAX_AGE_S, stop_seen_s=0.5
    )
    assert find_blockers(at_limit) == ()


def test_they_come_in_the_order_in_which_a_person_would_mend_them():
    facts = replace(
        READY,
        left=silent(Side.LEFT),
        right=silent(Side.RIGHT),
        model_problem="no model is set",
        lock="a training is running",
        status=RobotStatus(REMOTE_PLAY, 0),
        position=None,
    )
    assert [blocker.id for blocker in find_blockers(facts)] == [
        *("left_sensor", "right_sensor", "lock", "model", "robot_state", "robot_pose")
    ]


def test_without_a_link_the_robot_is_named_once_and_not_what_nobody_can_know():
    facts = replace(READY, is_link_open=False, status=None, position=None)
    assert [blocker.id for blocker in find_blockers(facts)] == ["robot_link"]


def test_the_posture_of_a_silent_left_arm_is_no_second_blocker():
    facts = replace(READY, left=silent(Side.LEFT), stop_seen_s=None)
    assert [blocker.id for blocker in find_blockers(facts)] == ["left_sensor"]


def test_the_streams_own_remedy_is_shown_and_its_cause_only_once():
    (blocker,) = find_blockers(replace(READY, left=silent(Side.LEFT)))
    assert blocker.text == "left sensor: no data for 450 ms"
    assert blocker.remedy == "switch the sensor on, bring it closer"


def test_a_port_with_colons_in_its_name_keeps_its_name():
    reason = "nobody answers at 127.0.0.1:5001: check address and port"
    left = replace(silent(Side.LEFT), link=LinkState.NOT_CONNECTED, reason=reason)
    (blocker,) = find_blockers(replace(READY, left=left))
    assert blocker.text == "left sensor: nobody answers at 127.0.0.1:5001"
    assert blocker.remedy == "check address and port"


def test_a_cause_with_a_colon_stays_whole_and_one_without_remedy_gets_a_general_one():
    reason = "sensor.local: no host has this name: check the address"
    (blocker,) = find_blockers(replace(READY, left=replace(silent(Side.LEFT), reason=reason)))
    assert blocker.text == "left sensor: sensor.local: no host has this name"
    assert blocker.remedy == "check the address"
    (blocker,) = find_blockers(replace(READY, left=replace(silent(Side.LEFT), reason="gone")))
    assert (blocker.text, blocker.remedy) == ("left sensor: gone", "check the sensor and its port")


def test_what_nobody_knows_yet_counts_as_not_ready():
    unheard = Facts(
        left=replace(silent(Side.LEFT), reason="not opened yet: check the port in the settings"),
        right=replace(silent(Side.RIGHT), reason="not opened yet: check the port in the settings"),
        stop_seen_s=None,
        stop_wanted_s=0.5,
        model_problem="no model is set for this person",
        is_link_open=False,
        link_text="not connected yet",
        status=None,
        status_age_s=float("inf"),
        position=None,
        pose_age_s=float("inf"),
        field=READY.field,
        tool=0,
    )
    names = {blocker.id for blocker in find_blockers(unheard)}
    unfit = {"left_unfit", "right_unfit"}
    assert names == unfit | {"left_sensor", "right_sensor", "model", "robot_link"}


@given(st.floats(0.0, 0.5, exclude_max=True))
def test_the_time_in_the_stop_posture_never_reads_as_enough(seen_s: float):
    (blocker,) = find_blockers(replace(READY, stop_seen_s=seen_s))
    told = blocker.text.removeprefix("left arm is in the stop posture for ")
    seen, needed = told.removesuffix(" are needed").split(", ")
    assert float(seen.removesuffix(" s")) <= seen_s
    assert seen != needed
