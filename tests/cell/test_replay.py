"""What went into the machine stands in the record, and gives the same decisions again."""

from typing import get_args, get_type_hints

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gestureapp.cell import events as e
from gestureapp.cell.machine import DECISION_LIMIT_S, step
from gestureapp.cell.machine_state import MachineState, Rules
from gestureapp.cell.records import Record, Topic, fields_of
from gestureapp.cell.snapshot import Blocker, CellState
from gestureapp.cell.words import sentence
from gestureapp.recording.schemas import decode_record, encode_record
from gestureapp.robot.values import StopReason
from gestureapp.sensing.values import ArmPosture, Side

S = CellState
EVENTS = {kind.__name__: kind for kind in get_args(e.Event)}


def event_of(fields) -> e.Event:
    """The event that a record of topic ``/cell/input`` was made from."""
    values = dict(fields)
    kind = EVENTS[values.pop("type")]
    hints = get_type_hints(kind)
    for name, value in values.items():
        if hints[name] in (ArmPosture, Side, StopReason):
            values[name] = hints[name](value)
        elif name == "blockers":
            values[name] = tuple(Blocker(**each) for each in value)
    return kind(**values)


def through_the_file(record: Record) -> Record:
    data = encode_record(record)
    assert data is not None
    again = decode_record(record.topic, data)
    assert again is not None
    return again


def shown(s: MachineState) -> tuple[object, ...]:
    return s.state, s.note, s.is_stop_unconfirmed


def replayed(records, rules) -> tuple[list[tuple[object, ...]], list[e.Effect]]:
    """States and effects that the recorded inputs lead to."""
    state, told, effects = MachineState(), [], []
    for record in records:
        if record.topic is not Topic.INPUT:
            continue
        before = state
        state, new = step(state, event_of(through_the_file(record).fields), rules)
        effects += new
        if shown(state) != shown(before):
            told.append((state.state.value, state.activation_id, sentence(state, rules.drive_mode)))
    return told, effects


def a_day(desk) -> None:
    """One gesture ended by the left arm, one by STOP, a lost guardian, a lost sensor."""
    desk.moving()
    desk.run(0.3)
    desk.left.take(ArmPosture.STOP, desk.now_s)
    assert desk.run(1.5, S.ARMED)
    desk.run(1.0)
    desk.gesture("Z+")
    assert desk.run(2.0, S.MOVING)
    desk.press(e.StopPressed(desk.now_s))
    assert desk.run(1.0, S.STOPPED)
    desk.left.take(ArmPosture.STOP, desk.now_s)
    desk.run(4.0)
    desk.press(e.GuardianGone(desk.now_s, "the guardian process has ended"))
    assert desk.run(1.0, S.STOPPED)
    desk.press(e.ArmPressed(desk.now_s))
    assert desk.run(0.5, S.ARMED)
    desk.left.take(ArmPosture.START, desk.now_s)
    assert desk.run(1.0, S.ACTIVATED)
    assert desk.run(DECISION_LIMIT_S, S.ARMED)
    desk.changes[Side.LEFT] = lambda _: None
    assert desk.run(1.0, S.STOPPED)


def test_the_recorded_inputs_give_the_same_states_proposals_and_stops(desk):
    a_day(desk)
    told, effects = replayed(desk.records, Rules())
    recorded = [
        (r.fields["state"], r.fields["activation_id"], r.fields["sentence"])
        for r in desk.of(Topic.STATE)
    ]
    assert told == recorded
    commands = [r.fields for r in desk.of(Topic.COMMAND)]
    proposed = [c["activation_id"] for c in commands if c["type"] == "Propose"]
    stops = [(c["reason"], c["text"]) for c in commands if c["type"] == "Stop"]
    assert [x.activation_id for x in effects if isinstance(x, e.SendProposal)] == proposed
    assert [(x.reason.value, x.text) for x in effects if isinstance(x, e.SendStop)] == stops
    assert len(proposed) == 2
    assert len(stops) >= 4


def test_what_the_machine_says_stands_in_the_record_in_its_order(desk):
    a_day(desk)
    _, effects = replayed(desk.records, Rules())
    said = [x.text for x in effects if isinstance(x, e.Say)]
    assert [r.fields["text"] for r in desk.of(Topic.EVENT)] == said


def test_a_recorded_time_is_the_events_own(desk):
    a_day(desk)
    for record in desk.of(Topic.INPUT):
        again = through_the_file(record)
        assert again.t_s == record.t_s == again.fields["t_s"]


TIMES = st.floats(0.0, 1e6)
WORDS = st.text(max_size=20)
BLOCKERS = st.lists(st.builds(Blocker, WORDS, WORDS, WORDS), max_size=3).map(tuple)


@pytest.mark.parametrize("kind", get_args(e.Event), ids=lambda kind: kind.__name__)
@given(data=st.data())
def test_every_event_survives_the_record(kind, data):
    hints = get_type_hints(kind)
    fields = {
        name: WORDS if h is str else BLOCKERS if name == "blockers" else st.from_type(h)
        for name, h in hints.items()
    }
    event = data.draw(st.builds(kind, **(fields | {"t_s": TIMES})))
    record = through_the_file(Record(Topic.INPUT, event.t_s, fields_of(event)))
    assert event_of(record.fields) == event
