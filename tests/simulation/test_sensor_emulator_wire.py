"""The emulator's encoders against the product's decoders, which share no code."""

import random
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gestureapp.sensing.protocols import protocol
from gestureapp.sensing.values import DecoderEvent, Frame
from gestureapp.simulation.sensor_wire import (
    COUNTER_SPAN,
    ENCODERS,
    LINES,
    cut,
    encode_adxl330,
    encode_binary,
    encode_csv,
    encode_identity,
    encode_witmotion,
    garbage_like,
)

COUNTERS = st.integers(0, COUNTER_SPAN - 1)
HALF_STEP_G = {
    "csv": 0.5e-4,
    "adxl330": 0.5 * 3.0 / 1024 / 0.3,
    "witmotion": 0.5 / 2048,
    "binary": 0.5 * 0.0005,
}


def accel(limit_g: float) -> st.SearchStrategy[tuple[float, float, float]]:
    axis = st.floats(-limit_g, limit_g)
    return st.tuples(axis, axis, axis)


def decoded(name: str, data: bytes) -> list[DecoderEvent]:
    decoder = protocol(name).new_decoder()
    # The decoder may distrust what comes first: the stream was joined in the middle.
    primed = ENCODERS[name](0, (0.0, 0.0, 1.0))
    decoder.feed(primed)
    return [*decoder.feed(data), *decoder.end()]


@pytest.mark.parametrize("name", sorted(ENCODERS))
@settings(deadline=None)
@given(number=st.integers(1, 100), accel_g=accel(4.5))
def test_a_decoded_line_says_what_was_encoded_within_half_a_step(name, number, accel_g):
    line = ENCODERS[name](number, accel_g)
    frames = [event for event in decoded(name, line) if isinstance(event, Frame)]
    assert [frame.counter for frame in frames] == [None if name == "witmotion" else number]
    read_g = protocol(name).to_nominal_g(frames[0].raw)
    assert read_g == pytest.approx(accel_g, abs=HALF_STEP_G[name] * 1.001)


@settings(deadline=None)
@given(number=COUNTERS)
def test_the_running_number_is_the_first_field(number):
    assert encode_csv(number, (0.5, -0.25, 1.0)) == b"%d,0.5000,-0.2500,1.0000\n" % number
    assert encode_adxl330(number, (0.0, 1.0, -1.0)) == b"%d,512,614,410\r\n" % number


def test_a_csv_line_may_leave_the_running_number_out():
    line = encode_csv(None, (0.1, 0.2, 0.3))
    assert line == b"0.1000,0.2000,0.3000\n"
    assert decoded("csv", line)[-1] == Frame(None, (0.1, 0.2, 0.3))


@settings(deadline=None)
@given(accel_g=accel(1e6))
def test_a_reading_beyond_the_converter_stays_at_its_rail(accel_g):
    counts = [int(field) for field in encode_adxl330(None, accel_g).split(b",")]
    assert all(0 <= count <= 1023 for count in counts)
    for count, value_g in zip(counts, accel_g, strict=True):
        if abs(value_g) > 5.0:
            assert count == (1023 if value_g > 0 else 0)


@pytest.mark.parametrize("name", sorted(ENCODERS))
@settings(deadline=None)
@given(number=COUNTERS, accel_g=accel(3.0), seed=st.integers(0, 999))
def test_a_cut_frame_has_lost_its_end_and_a_cut_line_a_field(name, number, accel_g, seed):
    whole = ENCODERS[name](number, accel_g)
    rest = cut(name, whole, random.Random(seed))
    assert 0 < len(rest) < len(whole)
    if name in LINES:
        assert rest.count(b",") < whole.count(b",")
        rest = rest.rstrip(b"\r\n")
    assert whole.startswith(rest)


@pytest.mark.parametrize(
    ("data", "shown"),
    [
        (
            encode_csv(258, (0.0, -0.5, 1.0)),
            "32 35 38 2c 30 2e 30 30 30 30 2c 2d 30 2e 35 30 30 30 2c 31 2e 30 30 30 30 0a",
        ),
        (
            encode_adxl330(258, (0.0, -0.5, 1.0)),
            "32 35 38 2c 35 31 32 2c 34 36 31 2c 36 31 34 0d 0a",
        ),
        (encode_witmotion(None, (0.0, -0.5, 1.0))[:11], "55 51 00 00 00 fc 00 08 c4 09 77"),
        (
            encode_binary(258, (0.0, -0.5, 1.0), 80),
            "05 01 01 02 01 01 08 18 fc d0 07 50 49 92 00",
        ),
        (encode_identity("arm 7"), "0a 01 02 61 72 6d 20 37 17 47 00"),
    ],
)
def test_the_bytes_are_those_of_the_documentation(data: bytes, shown: str):
    assert data.hex(" ") == shown
    page = (Path(__file__).parents[2] / "docs" / "sensors.md").read_text()
    assert shown in " ".join(page.replace("`", "").replace("|", "").split())


@settings(deadline=None)
@given(accel_g=accel(1e6))
@pytest.mark.parametrize("name", ["witmotion", "binary"])
def test_a_reading_beyond_sixteen_bits_stays_at_their_end(name, accel_g):
    (frame,) = (
        event for event in decoded(name, ENCODERS[name](7, accel_g)) if type(event) is Frame
    )
    for count, value_g in zip(frame.raw, accel_g, strict=True):
        if abs(value_g) > 16.5:
            assert count == (32767 if value_g > 0 else -32768)


@settings(deadline=None)
@given(seed=st.integers(0, 99))
def test_garbage_is_as_long_as_the_line(seed):
    line = encode_csv(7, (0.0, 0.0, 1.0))
    garbage = garbage_like(line, random.Random(seed))
    assert len(garbage) == len(line)
    assert garbage != line
