"""The sentence under the one word: what to do next, or why nothing moves."""

from dataclasses import replace

import pytest

from gestureapp.cell.machine_state import MachineState
from gestureapp.cell.snapshot import Blocker, CellState
from gestureapp.cell.words import sentence
from gestureapp.config import DriveMode

S = CellState
HOLD, PAPER = DriveMode.HOLD_TO_RUN, DriveMode.START_STOP
BLOCKER = Blocker("servo", "servo power is off", "press Servo on")
BASE = MachineState(note="recognised X+")

SENTENCES = [
    (replace(BASE, state=S.NOT_READY, note=""), HOLD, ""),
    (replace(BASE, state=S.NOT_READY, note="disarmed"), HOLD, "Disarmed."),
    (
        replace(BASE, state=S.NOT_READY, note="", blockers=(BLOCKER,)),
        HOLD,
        "1 thing stands against arming.",
    ),
    (
        replace(BASE, state=S.NOT_READY, note="disarmed", blockers=(BLOCKER, BLOCKER)),
        HOLD,
        "Disarmed. 2 things stand against arming.",
    ),
    (replace(BASE, state=S.READY, note=""), HOLD, "Hold Arm for one second."),
    (replace(BASE, state=S.READY, note="not armed: busy"), HOLD, "Not armed: busy"),
    (replace(BASE, state=S.READY, arming_since_s=1.0), HOLD, "Arming…"),
    (
        replace(BASE, state=S.ARMED, note="", is_left_rested=True),
        HOLD,
        "Take the start posture with the left arm and make a gesture with the right.",
    ),
    (
        replace(BASE, state=S.ARMED, note="no movement of the right arm"),
        HOLD,
        "No movement of the right arm. Bring the left arm to the stop posture first.",
    ),
    (replace(BASE, state=S.ACTIVATED), HOLD, "Watching the right arm."),
    (replace(BASE, state=S.ACTIVATED, proposed_s=0.0), HOLD, "Recognised X+. Asking the robot."),
    (
        replace(BASE, state=S.MOVING),
        HOLD,
        "Recognised X+. Move the left arm out of the start posture to stop.",
    ),
    (
        replace(BASE, state=S.MOVING),
        PAPER,
        "Recognised X+. Bring the left arm to the stop posture to stop.",
    ),
    (
        replace(BASE, state=S.STOPPING, note="STOP was pressed"),
        HOLD,
        "STOP was pressed. Waiting until the robot is read back to stand.",
    ),
    (
        replace(BASE, state=S.STOPPING, note="STOP was pressed", is_stop_unconfirmed=True),
        HOLD,
        "STOP was pressed. The robot has not confirmed that it stands; the stop is repeated.",
    ),
    (
        replace(BASE, state=S.STOPPED, note="STOP was pressed"),
        HOLD,
        "STOP was pressed. The robot stands. Hold Arm for one second.",
    ),
    (
        replace(BASE, state=S.STOPPED, note="STOP was pressed", blockers=(BLOCKER,)),
        HOLD,
        "STOP was pressed. The robot stands. Clear what stands against arming, then hold Arm.",
    ),
    (
        replace(BASE, state=S.STOPPED, note="STOP was pressed", arming_since_s=1.0),
        HOLD,
        "STOP was pressed. The robot stands. Arming…",
    ),
]


@pytest.mark.parametrize(("state", "mode", "words"), SENTENCES)
def test_the_sentence_says_what_to_do_next(state: MachineState, mode: DriveMode, words: str):
    assert sentence(state, mode) == words


def test_every_state_has_a_sentence():
    assert {state.state for state, _, _ in SENTENCES} == set(CellState)
