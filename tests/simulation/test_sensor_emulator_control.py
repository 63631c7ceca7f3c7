"""The control language: every line gets an answer in words, whatever stands in it."""

import json

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gestureapp.sensing.values import Side
from gestureapp.simulation.sensor_control import SentLine, StreamRecord, answer_command
from gestureapp.simulation.sensor_model import ArmAction, FaultKind, SensorModel, Verb


class StillArm:
    def __init__(self) -> None:
        self.begun: list[tuple[ArmAction, float]] = []

    def accel_g(self, t_s: float) -> tuple[float, float, float]:
        return (0.0, 0.0, 1.0)

    def begin(self, action: ArmAction, t_s: float) -> None:
        self.begun.append((action, t_s))


def model_of(side: Side) -> SensorModel:
    return SensorModel(side, StillArm())


def ask(model: SensorModel, command: object, record: StreamRecord | None = None) -> dict:
    line = command if isinstance(command, bytes) else json.dumps(command).encode()
    return answer_command(model, line, 100.0, record or StreamRecord())


def test_a_gesture_begins_now_or_at_the_time_asked_for():
    model = model_of(Side.RIGHT)
    assert ask(model, {"do": "perform", "label": "RZ-"}) == {"ok": True, "at_s": 100.0}
    later = {"do": "perform", "label": "X+", "at_s": 100.5}
    assert ask(model, later) == {"ok": True, "at_s": 100.5}
    assert model.wearer.begun == [(ArmAction(Verb.PERFORM, "RZ-"), 100.0)]
    assert model.scheduled_s == 100.5


def test_how_long_a_gesture_is_held_and_how_quickly_it_ends_reaches_the_arm():
    model = model_of(Side.RIGHT)
    assert ask(model, {"do": "perform", "label": "RX+", "hold_s": 1.5, "back_s": 0.6})["ok"]
    assert model.wearer.begun == [(ArmAction(Verb.PERFORM, "RX+", 1.5, 0.6), 100.0)]


def test_a_time_that_has_passed_means_now():
    answer = ask(model_of(Side.LEFT), {"do": "take", "posture": "start", "at_s": 3})
    assert answer == {"ok": True, "at_s": 100.0}


def test_rest_lowers_the_left_arm_and_levels_the_right():
    left, right = model_of(Side.LEFT), model_of(Side.RIGHT)
    assert ask(left, {"do": "rest"})["ok"]
    assert ask(right, {"do": "rest"})["ok"]
    assert left.wearer.begun[0][0] == ArmAction(Verb.TAKE, "stop")
    assert right.wearer.begun[0][0] == ArmAction(Verb.REST)


@pytest.mark.parametrize(
    ("side", "command", "words"),
    [
        (Side.RIGHT, b"{", "not JSON"),
        (Side.RIGHT, b"\xff\xfe", "not JSON"),
        (Side.RIGHT, b"[" * 5000, "not JSON"),
        (Side.RIGHT, [1], "not a JSON object"),
        (Side.RIGHT, {}, "'do' is missing"),
        (Side.RIGHT, {"do": 3}, "'do' is missing or not a text"),
        (Side.RIGHT, {"do": "dance"}, "unknown word 'dance'"),
        (Side.RIGHT, {"do": "perform"}, "'label' is missing"),
        (Side.RIGHT, {"do": "perform", "label": "Q"}, "no gesture 'Q'"),
        (Side.RIGHT, {"do": "perform", "label": "X+", "back_s": 0.0}, "'back_s' = 0.0 is not"),
        (Side.RIGHT, {"do": "perform", "label": "X+", "hold_s": -1}, "'hold_s' = -1 is not"),
        (Side.LEFT, {"do": "perform", "label": "X+"}, "belong to the right arm"),
        (Side.RIGHT, {"do": "take", "posture": "start"}, "belong to the left arm"),
        (Side.LEFT, {"do": "take", "posture": "neither"}, "no posture 'neither'"),
        (Side.LEFT, {"do": "rest", "at_s": "soon"}, "'at_s' is not a number"),
        (Side.LEFT, {"do": "rest", "at_s": True}, "'at_s' is not a number"),
        (Side.LEFT, {"do": "rest", "at_s": float("nan")}, "'at_s' = nan is not between"),
        (Side.LEFT, {"do": "rest", "at_s": 1e9}, "is not between"),
        (Side.LEFT, b'{"do":"rest","at_s":1' + b"0" * 400 + b"}", "is not between"),
        (Side.LEFT, {"do": "lie"}, "'position' is missing"),
        (Side.LEFT, {"do": "lie", "position": "up"}, "no position 'up': one of z-up"),
        (Side.LEFT, {"do": "lie", "position": "z-up", "askew_deg": 90}, "'askew_deg' = 90"),
        (Side.LEFT, {"do": "fault", "kind": "tired"}, "no fault 'tired'"),
        (Side.LEFT, {"do": "fault", "kind": "stall"}, "a stall needs its seconds"),
        (Side.LEFT, {"do": "fault", "kind": "slow", "rate_hz": 0}, "'rate_hz' = 0"),
        (Side.LEFT, {"do": "fault", "kind": "frozen", "counts_on": 1}, "not true or false"),
        (Side.LEFT, {"do": "log", "count": 0}, "'count' = 0"),
    ],
)
def test_a_command_that_cannot_be_done_is_refused_in_words(side, command, words):
    model = model_of(side)
    answer = ask(model, command)
    assert answer["ok"] is False
    assert words in answer["error"]
    assert model.wearer.begun == []
    assert model.fault.kind is FaultKind.NONE


@pytest.mark.parametrize("kind", list(FaultKind))
def test_every_fault_can_be_set_and_ended(kind):
    model = model_of(Side.LEFT)
    assert ask(model, {"do": "fault", "kind": kind.value, "seconds": 5}) == {
        "ok": True,
        "fault": kind.value,
    }
    assert model.fault.kind is kind
    assert ask(model, {"do": "fault", "kind": "none"})["ok"]
    assert model.fault.kind is FaultKind.NONE


def test_the_log_gives_the_last_lines_oldest_first():
    lines = tuple(SentLine(float(n), n, (0.0, 0.0, 1.0)) for n in range(10))
    answer = ask(model_of(Side.LEFT), {"do": "log", "count": 3}, StreamRecord(lines))
    assert [line["n"] for line in answer["log"]] == [7, 8, 9]
    assert answer["log"][0] == {"sent_s": 7.0, "n": 7, "accel_g": [0.0, 0.0, 1.0]}


def test_the_state_says_what_the_sensor_does():
    model = model_of(Side.RIGHT)
    ask(model, {"do": "perform", "label": "Y-"})
    ask(model, {"do": "fault", "kind": "slow", "rate_hz": 25})
    state = ask(model, {"do": "state"}, StreamRecord((), True, 7, 2, 1))
    assert state["doing"] == "perform Y-"
    assert state["fault"] == "slow"
    assert state["rate_hz"] == 25.0
    assert (state["n_sent"], state["n_dropped"], state["n_overruns"]) == (7, 2, 1)


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner),
    max_leaves=6,
)
WORDS = st.sampled_from(["perform", "rest", "take", "fault", "log", "state"])
KEYS = st.sampled_from(["label", "at_s", "posture", "kind", "seconds", "rate_hz", "count", "burst"])


@settings(deadline=None)
@given(side=st.sampled_from(Side), word=WORDS, rest=st.dictionaries(KEYS, JSON))
def test_any_values_are_survived_and_answered(side, word, rest):
    answer = ask(model_of(side), {**rest, "do": word})
    assert json.loads(json.dumps(answer))["ok"] in (True, False)


@settings(deadline=None)
@given(st.binary(max_size=60))
def test_any_bytes_are_answered(line):
    assert answer_command(model_of(Side.LEFT), line, 0.0, StreamRecord())["ok"] in (True, False)
