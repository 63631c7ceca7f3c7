"""Records become JSON messages that fit their schema, and come back as they were."""

import json
import math
from enum import Enum
from types import MappingProxyType

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gestureapp.cell.records import Record, Topic
from gestureapp.recording.schemas import OPEN_TOPICS, SCHEMAS, decode_record, encode_record

_TIMES = st.floats(allow_nan=False, allow_infinity=False)
_JSON = st.recursive(
    st.none() | st.booleans() | st.integers(-(2**53), 2**53) | st.text() | _TIMES,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(), inner, max_size=3),
    max_leaves=8,
)
_FIELDS = st.dictionaries(
    st.text().filter(lambda name: name != "record_t_s") | st.just("t_s"), _JSON, max_size=5
)
_CLOSED = st.sampled_from([topic for topic in Topic if topic not in OPEN_TOPICS])


def test_every_topic_has_a_schema_with_its_time():
    for topic in Topic:
        assert "t_s" in SCHEMAS[topic]["properties"]
        assert set(SCHEMAS[topic]["required"]) <= set(SCHEMAS[topic]["properties"])


@settings(deadline=None)
@given(_CLOSED, _TIMES, _FIELDS)
def test_a_record_comes_back_exactly_as_it_was_put(topic, t_s, fields):
    record = Record(topic, t_s, fields)
    assert decode_record(topic, encode_record(record)) == record


@settings(deadline=None)
@given(st.sampled_from(sorted(OPEN_TOPICS, key=str)), st.floats(allow_nan=False))
def test_an_input_keeps_infinity_for_the_replay(topic, age_s):
    record = Record(topic, 1.5, {"type": "health", "nested": [{"age_s": age_s}], "t_s": age_s})
    assert decode_record(topic, encode_record(record)) == record


def test_an_input_keeps_not_a_number():
    back = decode_record(Topic.INPUT, encode_record(Record(Topic.INPUT, 1.0, {"x": float("nan")})))
    assert math.isnan(back.fields["x"])


@pytest.mark.parametrize("value", [math.inf, -math.inf, math.nan])
def test_a_plotted_number_that_is_none_becomes_null(value):
    data = encode_record(Record(Topic.ROBOT, 1.0, {"x_mm": value}))
    assert json.loads(data)["x_mm"] is None


def test_an_event_with_a_time_of_its_own_keeps_both():
    record = Record(Topic.INPUT, 2.0, {"type": "sample", "t_s": 1.9})
    message = json.loads(encode_record(record))
    assert (message["t_s"], message["record_t_s"]) == (1.9, 2.0)
    assert decode_record(Topic.INPUT, json.dumps(message).encode()) == record


def test_numpy_enums_tuples_and_read_only_mappings_become_plain_json():
    class Colour(Enum):
        RED = "red"

    fields = {
        "number": np.float32(0.5),
        "array": np.arange(3),
        "pair": (1, 2),
        "mapping": MappingProxyType({"a": 1}),
        "enum": Colour.RED,
    }
    message = json.loads(encode_record(Record(Topic.INPUT, 1.0, fields)))
    assert message["number"] == 0.5
    assert message["array"] == [0, 1, 2]
    assert message["pair"] == [1, 2]
    assert message["mapping"] == {"a": 1}
    assert message["enum"] == "Colour.RED"


def test_fields_that_contain_themselves_are_refused_not_raised():
    fields: dict = {}
    fields["self"] = fields
    assert encode_record(Record(Topic.INPUT, 1.0, fields)) is None


@settings(deadline=None)
@given(st.binary())
def test_rubbish_is_no_record(data):
    back = decode_record(Topic.EVENT, data)
    assert back is None or isinstance(back.t_s, float)


@pytest.mark.parametrize(
    "data", [b"", b"[]", b"3", b"{}", b'{"t_s":null}', b'{"t_s":true}', b'{"t_s":"1"}', b"[" * 9999]
)
def test_json_without_a_time_is_no_record(data):
    assert decode_record(Topic.EVENT, data) is None
