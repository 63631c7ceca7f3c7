"""Messages between application and guardian: all survive the line, no rubbish raises."""

import json
import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gestureapp.robot import messages as m
from gestureapp.robot.arm import ArmLimits
from gestureapp.robot.gate import Limits
from gestureapp.robot.obstacles import Column, KeepOut
from gestureapp.robot.values import (
    Caps,
    Direction,
    Pose,
    PoseIncrement,
    Position,
    Posture,
    Refusal,
    StopReason,
)
from gestureapp.robot.workspace import FieldOfOperation

FIELD = FieldOfOperation(1200.0, 500.0, 20.0, ((120.0, 240.0), (-60.0, 60.0), (-90.0, 90.0)), 2.0)
WHOLE_FIELD = replace(
    FIELD,
    floor_mm=-300.0,
    column=Column(350.0, 800.0),
    keep_outs=(
        KeepOut("Tisch \u00e4", (1.0, 2.0, 3.0), (4.0, 5.0, 6.0)),
        KeepOut("b", (-9.0, -9.0, -9.0), (0.0, 0.0, 0.0)),
    ),
    arm=ArmLimits((0.0, 0.0, 9.5), ((-170.0, 170.0),) * 6, 10.0, 10.0, 15.0, 100.0),
)
LIMITS = Limits(FIELD, 100.0, 10.0, 1, 0, True, 0.1, 0.2, 0.5)
POSE = Pose(1.0, 2.0, 3.0, 4.0, 5.0, 6.0)
REFUSAL = Refusal("held", "the robot is held", "1", "2")
ALL = [
    m.Start("t", "10.0.0.2", 80, LIMITS, "/x.log"),
    m.Start("t", "10.0.0.2", 80, replace(LIMITS, field=WHOLE_FIELD), ""),
    m.Listening(4711),
    m.Hello("t", m.Role.WINDOW),
    m.Beat(1.0, True, False, 2.0, float("-inf")),
    m.Arm(),
    m.Disarm(),
    m.Propose(3, Direction(2, -1, True), 4.5),
    m.Propose(4, Direction(0, 1, False), 4.5, Caps(20.0, 10.0)),
    m.Stop(StopReason.STOP_PRESSED, "text\nwith a line \u00e9", 1.5),
    m.ServoOn(),
    m.ServoOff(),
    m.Bye(),
    m.LinkReport(True, "x"),
    m.StatusReport(1.0, 194, 64, (4416, 1)),
    m.StatusReport(1.0, 194, 64, ()),
    m.PoseReport(1.0, Position(POSE, Posture(33), 23)),
    m.Armed(),
    m.ArmRefused(REFUSAL),
    m.Disarmed(),
    m.CommandSent(1, 2.0, POSE, PoseIncrement(dx_mm=3.0), "outer sphere", 100.0, False),
    m.CommandAccepted(1, 2.0),
    m.CommandRefused(1, REFUSAL),
    m.MotionEnded(1, POSE),
    m.StopAsked(StopReason.LEFT_ARM, "x", 1.0),
    m.StopConfirmed(StopReason.LEFT_ARM, 0.2, POSE),
    m.StopUnconfirmed(StopReason.LINK_LOST, "x"),
    m.HoldReleased(),
    m.Hindrances((REFUSAL, REFUSAL)),
    m.Hindrances(()),
    m.Notice("x"),
]


def said(name, **fields):
    return json.dumps({"is": name, **fields}).encode()


@pytest.mark.parametrize("message", ALL, ids=lambda message: type(message).__name__)
def test_every_message_is_one_line_and_comes_back_as_it_was(message):
    line = m.encode(message)

    assert line.count(b"\n") == 1
    assert line.endswith(b"\n")
    assert m.decode(line) == message


@pytest.mark.parametrize("message", ALL, ids=lambda message: type(message).__name__)
def test_a_message_with_a_field_too_many_or_too_few_is_none(message):
    fields = json.loads(m.encode(message))
    assert m.decode(json.dumps({**fields, "more": 1}).encode()) is None
    for name in fields:
        less = {key: value for key, value in fields.items() if key != name}
        assert m.decode(json.dumps(less).encode()) is None


@pytest.mark.parametrize(
    "line",
    [
        b"",
        b"{",
        b"[]",
        b"null",
        b'"Beat"',
        b"\xff\xfe",
        said("Nothing"),
        b'{"is": ["Beat"]}',
        b'{"is": {}}',
        said("PoseReport", t_s=1.0, position=None),
        said("PoseReport", t_s=1.0, position="pose"),
        said("PoseReport", t_s="1", position=[1, 2]),
        said("Propose", activation_id=True, direction=None, t_s=0.0),
        said("Propose", activation_id=1.0, direction=None, t_s=0.0),
        said(
            "Propose",
            activation_id=1,
            direction={"axis": 3, "sign": 1, "is_rotation": False},
            t_s=0,
        ),
        said("Stop", reason="because", text="", asked_s=0.0),
        said("Stop", reason=["STOP pressed"], text="", asked_s=0.0),
        said("StatusReport", t_s=0.0, data_1=1, data_2=1, alarms="12"),
        said("StatusReport", t_s=0.0, data_1=1, data_2=1, alarms=[1.5]),
        said("CommandAccepted", activation_id=1, t_s=math.nan),
        said("CommandAccepted", activation_id=1, t_s=10**400),
        said("CommandAccepted", activation_id=1, t_s=None),
        said("Listening", port="80"),
        b'{"is": "Listening", "port": ' + b"9" * 5000 + b"}",
        b"[" * 100_000,
    ],
)
def test_what_cannot_be_read_is_none(line):
    assert m.decode(line) is None


@pytest.mark.parametrize(
    ("name", "value"),
    [("frame", 10**400), ("speed_mm_s", 251.0), ("trip_level_s", 0.4), ("tool", 1.5), ("field", 1)],
)
def test_a_start_with_limits_out_of_bounds_is_none(name, value):
    fields = json.loads(m.encode(ALL[0]))
    fields["limits"][name] = value

    assert m.decode(json.dumps(fields).encode()) is None


def test_a_range_needs_both_its_ends():
    fields = json.loads(m.encode(ALL[0]))
    fields["limits"]["field"]["ranges_deg"][1] = [0.0]

    assert m.decode(json.dumps(fields).encode()) is None


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("column", 5),
        ("column", {"radius_mm": 350.0}),
        ("column", {"radius_mm": 0.0, "top_mm": 1.0}),
        ("keep_outs", None),
        ("keep_outs", [None]),
        ("keep_outs", [{"label": "x", "low_mm": [1.0, 1.0, 1.0], "high_mm": [0.0, 2.0, 2.0]}]),
        ("arm", []),
        ("floor_mm", None),
        ("floor_mm", 2000.0),
    ],
)
def test_a_start_whose_field_cannot_be_read_is_none(name, value):
    limits = replace(LIMITS, field=replace(WHOLE_FIELD, ceiling_mm=1000.0))
    fields = json.loads(m.encode(m.Start("t", "10.0.0.2", 80, limits, "")))
    fields["limits"]["field"][name] = value

    assert m.decode(json.dumps(fields).encode()) is None


def test_a_whole_number_is_taken_where_a_float_is_wanted():
    assert m.decode(said("CommandAccepted", activation_id=1, t_s=2)) == m.CommandAccepted(1, 2.0)


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=5), inner),
    max_leaves=8,
)


@given(st.sampled_from(ALL), st.data())
def test_a_message_with_any_field_replaced_is_a_message_or_none(message, data):
    fields = json.loads(m.encode(message))
    name = data.draw(st.sampled_from(sorted(fields)))
    fields[name] = data.draw(JSON)

    decoded = m.decode(json.dumps(fields).encode())

    if decoded is not None:
        assert m.decode(m.encode(decoded)) == decoded


@given(st.binary(max_size=60) | JSON.map(lambda value: json.dumps(value).encode()))
def test_any_line_is_a_message_or_none(line):
    assert m.decode(line) is None


@pytest.mark.parametrize("cut", range(1, 40, 3))
def test_a_line_cut_short_is_none(cut):
    assert m.decode(m.encode(ALL[3])[:-cut]) is None or cut == 1


def test_what_no_message_can_hold_is_a_bug_and_not_sent():
    with pytest.raises(TypeError, match="bytes"):
        m.encode(m.Notice(b"x"))
