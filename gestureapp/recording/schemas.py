"""What stands in a session file: one JSON Schema per topic, and record <-> message bytes. Pure.

A message is the record's fields plus ``t_s``, the monotonic time of the record in seconds. An event
that has a ``t_s`` of its own keeps it; the record's time then stands in ``record_t_s``.
"""

import json
import math
from collections.abc import Mapping
from typing import Any, Final

from gestureapp.cell.records import Json, Record, Topic

FORMAT_VERSION: Final = 1
"""Raised when an older reader would misread the file."""
PROFILE: Final = "gestureapp"
"""Stands in the MCAP header: these are ours."""
METADATA_NAME: Final = "session"
"""The metadata record that says where, when, by whom and with what settings."""

TIME_KEY: Final = "t_s"
RECORD_TIME_KEY: Final = "record_t_s"
OPEN_TOPICS: Final = frozenset({Topic.INPUT, Topic.COMMAND})
"""Topics whose fields the cell chooses. Infinity and NaN are kept there as ``{"number": "NaN"}``
(JSON has no number for them), because a replay needs them; on the other topics they become null."""

_NUMBER_KEY: Final = "number"
_NON_FINITE: Final = {"Infinity": math.inf, "-Infinity": -math.inf, "NaN": math.nan}

Schema = Mapping[str, Json]


def _field(kind: str | list[str], text: str) -> dict[str, Json]:
    types: Json = kind if isinstance(kind, str) else list(kind)
    return {"type": types, "description": text}


def _number(text: str) -> dict[str, Json]:
    return _field(["number", "null"], text)


def _schema(title: str, properties: Mapping[str, Json], optional: tuple[str, ...] = ()) -> Schema:
    required: list[Json] = [name for name in properties if name not in optional]
    return {
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": title,
        "type": "object",
        "properties": {
            TIME_KEY: _field("number", "monotonic clock of the recording machine, s"),
            RECORD_TIME_KEY: _field("number", "the record's own time where t_s is the event's, s"),
            **properties,
        },
        "required": [TIME_KEY, *required],
    }


def _accel(side: str) -> Schema:
    return _schema(
        f"{side} arm, one calibrated sample",
        {
            "seq": _field("integer", "running number within the stream, from 0, without gaps"),
            "ax_g": _number("specific force along X, g"),
            "ay_g": _number("specific force along Y, g"),
            "az_g": _number("specific force along Z, g; +1 when level and at rest"),
            "counter": _field(["integer", "null"], "the sensor's own running number"),
        },
    )


_WORDS_AND_FIELDS = {"type": _field("string", "kind of event; the other fields are its own")}

SCHEMAS: Final[Mapping[Topic, Schema]] = {
    Topic.LEFT_ACCEL: _accel("Left"),
    Topic.RIGHT_ACCEL: _accel("Right"),
    Topic.GARBAGE: _schema(
        "Bytes from a sensor that were no frame",
        {
            "side": _field("string", "left or right"),
            "n_bytes": _field("integer", "bytes dropped"),
            "first_bytes": _field("string", "the first of them, hexadecimal"),
            "reason": _field("string", "what was expected instead"),
        },
    ),
    Topic.INPUT: _schema("An event that went into the cell machine", _WORDS_AND_FIELDS),
    Topic.STATE: _schema(
        "The cell's state after a change",
        {
            "state": _field("string", "the one word on the screen"),
            "sentence": _field("string", "what to do next, or why it stopped"),
            "activation_id": _field(["integer", "null"], "which activation it belongs to"),
        },
    ),
    Topic.RECOGNITION: _schema(
        "What was made of one activation",
        {
            "activation_id": _field("integer", "which activation it answers"),
            "label": _field(["string", "null"], "the gesture; null when not recognised"),
            "reason": _field("string", "empty with a label, else why there is none"),
            "outputs": {
                **_field("object", "confidence of every candidate, 0 to 1"),
                "additionalProperties": _field(["number", "null"], "confidence, 0 to 1"),
            },
            "window_start_s": _number("receive time of the first sample used, s"),
            "window_end_s": _number("receive time of the last sample used, s"),
            "decided_s": _number("when the answer was there, s"),
            "onset_s": _number("when the right arm's movement began, s; null when not looked for"),
            "activation_s": _number("when the left arm started, s"),
            "thresholds": {
                **_field("array", "confidence an answer needed: at once, then in the end"),
                "items": _field("number", "0 to 1"),
            },
        },
        optional=("onset_s", "thresholds", "activation_s"),
    ),
    Topic.COMMAND: _schema("Asked of, let through or refused by the guardian", _WORDS_AND_FIELDS),
    Topic.ROBOT: _schema(
        "What the robot answered",
        {
            "data_1": _field(["integer", "null"], "first byte of RSTATS"),
            "data_2": _field(["integer", "null"], "second byte of RSTATS"),
            **{f"{axis}_mm": _number(f"tool position {axis.upper()}, mm") for axis in "xyz"},
            **{f"r{axis}_deg": _number(f"tool angle R{axis}, degrees") for axis in "xyz"},
            "type": _field(["integer", "null"], "posture of the arm, the bits of RPOSC's Type"),
            "tool": _field(["integer", "null"], "number of the tool whose point that is"),
        },
        optional=(
            *("data_1", "data_2", "x_mm", "y_mm", "z_mm", "rx_deg", "ry_deg", "rz_deg"),
            *("type", "tool"),
        ),
    ),
    Topic.SETTINGS: _schema(
        "What setting up has changed; it holds from now on",
        {
            "changes": _field("object", "new values by dotted name: robot.speed_mm_s"),
        },
    ),
    Topic.EVENT: _schema(
        "The cell's story for a person",
        {
            "text": _field("string", "one line"),
            "is_alarm": _field("boolean", "somebody has to act"),
        },
    ),
}
"""Every topic has one; the file registers them all, whether or not anything is written to them."""


def schema_name(topic: Topic) -> str:
    """Name of the topic's schema in the file: ``gestureapp.LeftAccel``."""
    return f"{PROFILE}." + "".join(word.title() for word in topic.name.split("_"))


def encode_record(record: Record) -> bytes | None:
    """Turn a record into the bytes of its message: compact JSON, ASCII, valid under RFC 8259.

    Returns:
        The bytes, or None when the fields cannot be JSON at all (they contain themselves).
    """
    key = RECORD_TIME_KEY if TIME_KEY in record.fields else TIME_KEY
    message = {key: record.t_s, **record.fields}
    try:
        return _STRICT.encode(message).encode("ascii")
    except (TypeError, ValueError, RecursionError):
        # Rare: a number without a JSON form, or a type the encoder does not know. Clean it, once.
        return _encode_cleaned(message, record.topic in OPEN_TOPICS)


def decode_record(topic: Topic, data: bytes) -> Record | None:
    """Turn a message's bytes back into the record that was put, or None when they are not one."""
    try:
        message = json.loads(data)
    except (ValueError, RecursionError):
        return None
    if not isinstance(message, dict):
        return None
    key = RECORD_TIME_KEY if RECORD_TIME_KEY in message else TIME_KEY
    t_s = message.pop(key, None)
    if isinstance(t_s, bool) or not isinstance(t_s, int | float):
        return None
    fields = _restored(message) if topic in OPEN_TOPICS else message
    return Record(topic, float(t_s), fields)


_STRICT = json.JSONEncoder(separators=(",", ":"), allow_nan=False)


def _encode_cleaned(message: Mapping[str, object], keep_non_finite: bool) -> bytes | None:
    try:
        return _STRICT.encode(_cleaned(message, keep_non_finite)).encode("ascii")
    except (TypeError, ValueError, RecursionError):
        return None


def _cleaned(value: Any, keep_non_finite: bool) -> Json:  # noqa: ANN401 - whatever a caller put there
    """A copy with only what JSON knows: numpy scalars as numbers, the unknown as its text."""
    if value is None or isinstance(value, bool | int | str):
        return value
    if isinstance(value, float):
        return _finite_or_text(value, keep_non_finite)
    if isinstance(value, Mapping):
        return {str(key): _cleaned(item, keep_non_finite) for key, item in value.items()}
    if isinstance(value, list | tuple | set | frozenset):
        return [_cleaned(item, keep_non_finite) for item in value]
    if hasattr(value, "tolist"):  # numpy, without importing it here
        return _cleaned(value.tolist(), keep_non_finite)
    return str(value)


def _finite_or_text(value: float, keep_non_finite: bool) -> Json:
    if math.isfinite(value):
        return value
    if not keep_non_finite:
        return None
    name = "NaN" if math.isnan(value) else "Infinity" if value > 0 else "-Infinity"
    return {_NUMBER_KEY: name}


def _restored(value: Any) -> Any:  # noqa: ANN401 - any JSON value
    if isinstance(value, dict):
        if value.keys() == {_NUMBER_KEY} and value[_NUMBER_KEY] in _NON_FINITE:
            return _NON_FINITE[value[_NUMBER_KEY]]
        return {key: _restored(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_restored(item) for item in value]
    return value
