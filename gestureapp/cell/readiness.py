"""What stands against arming: every blocker, with the measured value and the remedy. Pure.

Unknown counts as not ready.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass

from gestureapp.cell.controls import SETUP_OPEN
from gestureapp.cell.fitness import FIT, NOT_CALIBRATED, Judgement
from gestureapp.cell.snapshot import MODEL_BLOCKER, SETUP_BLOCKER, Blocker
from gestureapp.robot.gate import STATUS_MAX_AGE_S, find_foreign_tool, robot_blocker
from gestureapp.robot.values import Position, Refusal, RobotStatus
from gestureapp.robot.workspace import FieldOfOperation, find_outside
from gestureapp.sensing.values import StreamHealth

_REMEDIES = {
    "no_status": "wait, or check the cable to the controller",
    "alarm": "clear the alarm on the pendant, then press Servo on",
    "error": "clear the error on the pendant",
    "teach": "turn the pendant's key to REMOTE",
    "not_remote": "turn the pendant's key to REMOTE and switch command remote on",
    "not_play": "select play mode on the pendant",
    "servo_off": "press Servo on",
    "held": "release the hold on the pendant or the input",
    "running": "wait until the robot stands",
    "move_kept": "press Servo off, which discards that move; then Servo on, and arm",
    "supervision": "check the ladder and that the controller takes IOWRITE; see resources/nx100",
}


@dataclass(frozen=True, slots=True)
class Facts:
    """What readiness is judged by, at one moment.

    Attributes:
        left: Health of the left stream.
        right: Health of the right stream.
        stop_seen_s: How long the left arm has been in the stop posture; None when it is not.
        stop_wanted_s: How long it has to be.
        model_problem: Why the model cannot be armed with; empty when it can.
        is_link_open: The controller has taken the session.
        link_text: The line's own words.
        status: Last RSTATS, or None.
        status_age_s: How old that is.
        position: Last RPOSC, or None.
        pose_age_s: How old that is.
        field: Where the tool may go.
        tool: Number of the tool that the settings have.
        model_remedy: What to do about the model.
        lock: Why arming is locked out at all, or empty.
        left_fit: What setting up says of the left sensor.
        right_fit: The same of the right one.
        postures_fit: The same of the left arm's postures.
        hindrances: What the guardian knows to stand against it and no status shows.
        link_remedy: What to do about the line, where the guardian knows; else empty.
    """

    left: StreamHealth
    right: StreamHealth
    stop_seen_s: float | None
    stop_wanted_s: float
    model_problem: str
    is_link_open: bool
    link_text: str
    status: RobotStatus | None
    status_age_s: float
    position: Position | None
    pose_age_s: float
    field: FieldOfOperation
    tool: int
    model_remedy: str = "train a model, or choose another file"
    lock: str = ""
    left_fit: Judgement = NOT_CALIBRATED
    right_fit: Judgement = NOT_CALIBRATED
    postures_fit: Judgement = FIT
    link_remedy: str = ""
    hindrances: tuple[Refusal, ...] = ()


def find_blockers(facts: Facts) -> tuple[Blocker, ...]:
    """Everything that stands against arming now, in the order in which a person would mend it."""
    return (*_sensor_blockers(facts), *_own_blockers(facts), *_robot_blockers(facts))


def _sensor_blockers(facts: Facts) -> Iterator[Blocker]:
    for health, fit in ((facts.left, facts.left_fit), (facts.right, facts.right_fit)):
        if fit.problem:
            side = health.side.value
            text = f"{side} sensor: {fit.problem}"
            yield Blocker(f"{side}_unfit", text, fit.remedy or "Setup, step Sensors")
        if not health.is_ok:
            side = health.side.value
            cause, colon, remedy = health.reason.rpartition(": ")
            if not colon:
                cause, remedy = health.reason, "check the sensor and its port"
            yield Blocker(f"{side}_sensor", f"{side} sensor: {cause}", remedy)
    if facts.postures_fit.problem:
        remedy = facts.postures_fit.remedy or "Setup, step Calibrate"
        yield Blocker("postures", facts.postures_fit.problem, remedy)
    if facts.left.is_ok and (facts.stop_seen_s is None or facts.stop_seen_s < facts.stop_wanted_s):
        text = "left arm is not in the stop posture"
        if facts.stop_seen_s is not None:
            seen_s = math.floor(facts.stop_seen_s * 10) / 10  # else it could read as enough
            times = f"{seen_s:.1f} s, {facts.stop_wanted_s:g} s are needed"
            text = f"left arm is in the stop posture for {times}"
        yield Blocker("left_stop", text, "hold the left arm still in the stop posture")


def _own_blockers(facts: Facts) -> Iterator[Blocker]:
    if facts.lock:
        name = SETUP_BLOCKER if facts.lock == SETUP_OPEN else "lock"
        yield Blocker(name, facts.lock, "go back to Operate")
    if facts.model_problem:
        yield Blocker(MODEL_BLOCKER, facts.model_problem, facts.model_remedy)


def _robot_blockers(facts: Facts) -> Iterator[Blocker]:
    if not facts.is_link_open and facts.link_remedy:
        yield Blocker("robot_link", facts.link_text, facts.link_remedy)
        return
    if not facts.is_link_open:
        remedy = "check the address, the cable and the controller's Ethernet function"
        yield Blocker("robot_link", f"the robot does not answer: {facts.link_text}", remedy)
        return
    if facts.status_age_s > STATUS_MAX_AGE_S:
        text = f"the robot's state is {facts.status_age_s:.1f} s old"
        yield Blocker("robot_link", text, _REMEDIES["no_status"])
        return
    refusal = robot_blocker(facts.status, ignore_own_hold=True)
    if refusal is not None:
        cause = refusal.text.partition(": ")[0]
        yield Blocker("robot_state", cause, _REMEDIES.get(refusal.reason, refusal.text))
    for refusal in facts.hindrances:
        yield Blocker(refusal.reason, refusal.text, _REMEDIES[refusal.reason])
    if facts.position is None:
        yield Blocker("robot_pose", "the robot has not told its position", "wait a moment")
    elif facts.pose_age_s > STATUS_MAX_AGE_S:
        text = f"the robot's position is {facts.pose_age_s:.1f} s old"
        yield Blocker("robot_pose", text, _REMEDIES["no_status"])
    elif (foreign := find_foreign_tool(facts.position, facts.tool)) is not None:
        cause = foreign.text.partition(": ")[0]
        yield Blocker("robot_pose", cause, "select that tool on the pendant")
    elif (outside := find_outside(facts.position, facts.field)) is not None:
        remedy = "move the tool back into the field with the pendant"
        yield Blocker("robot_pose", outside.text, remedy)
