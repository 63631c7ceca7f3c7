"""Both line protocols through their decoders: real bytes in, events out."""

import random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gestureapp.sensing.counter import MAX_MISSED
from gestureapp.sensing.protocols import protocol
from gestureapp.sensing.values import (
    CounterGap,
    CounterJump,
    DecoderEvent,
    Frame,
    Garbage,
    Repeated,
)

NAMES = ["csv", "adxl330"]

rubbish = st.one_of(
    st.binary(max_size=300),
    st.text("0123456789.,+-eE \t\r\n", max_size=200).map(str.encode),
    st.text("0123456789,\n", max_size=200).map(str.encode),
)


def decode(name: str, data: bytes) -> list[DecoderEvent]:
    """Everything in a stream that begins at a line's beginning, its end included."""
    decoder = protocol(name).new_decoder()
    return decoder.feed(b"\n" + data) + decoder.end()


def frames(events: list[DecoderEvent]) -> list[Frame]:
    return [event for event in events if isinstance(event, Frame)]


def garbage(events: list[DecoderEvent]) -> list[Garbage]:
    return [event for event in events if isinstance(event, Garbage)]


def numbers(*counters: int) -> list[DecoderEvent]:
    """Events of csv lines with these running numbers, frames shown by their number only."""
    return decode("csv", b"".join(b"%d,0,0,1\n" % counter for counter in counters))


@pytest.mark.parametrize(
    ("line", "counter", "raw"),
    [
        (b"0.01,-0.02,0.98", None, (0.01, -0.02, 0.98)),
        (b"17,0.01,-0.02,0.98", 17, (0.01, -0.02, 0.98)),
        (b" 17 ,\t0.5 , -1. ,+.25 ", 17, (0.5, -1.0, 0.25)),
        (b"1e-2,2.5E1,-1e0", None, (0.01, 25.0, -1.0)),
        (b"1,2,3", None, (1.0, 2.0, 3.0)),
        (b"4294967295,0,0,1", 4294967295, (0.0, 0.0, 1.0)),
    ],
)
def test_csv_line_becomes_a_frame(line: bytes, counter: int | None, raw: tuple[float, ...]):
    assert decode("csv", line + b"\r\n") == [Frame(counter, raw)]


@pytest.mark.parametrize(
    "line",
    [
        b"nan,0,1",
        b"0,inf,1",
        b"0,0,-Infinity",
        b"0x1,0,1",
        b"1_0,0,1",
        b"0,0",
        b"0,0,1,0,1",
        b"1.5,0,0,1",
        b"-1,0,0,1",
        b"0,,1",
        b",,",
        b"0;0;1",
        b"0,0,1 g",
        b"0,0,1e999",
        b"12345678901,0,0,1",
        "٣,0,1".encode(),
        b"0,0,1\x00",
        b" ",
        b"--1,0,0",
        b"1 2,0,0",
    ],
)
def test_csv_line_that_is_no_sample_is_garbage_with_its_bytes(line: bytes):
    (event,) = decode("csv", line + b"\n")
    assert type(event) is Garbage
    assert event.first_bytes == line
    assert event.n_bytes == len(line)
    assert "ax,ay,az" in event.reason


def test_adxl330_line_becomes_a_frame_of_counts():
    assert decode("adxl330", b"65535,512,410, 1023\r\n") == [Frame(65535, (512.0, 410.0, 1023.0))]


@pytest.mark.parametrize(
    "line",
    [b"1,512,512,1024", b"512,512,614", b"1,512,512,-1", b"1,512.0,512,614", b"1,1,1,1,1", b"a"],
)
def test_adxl330_line_that_is_no_frame_is_garbage(line: bytes):
    (event,) = decode("adxl330", line + b"\n")
    assert type(event) is Garbage
    assert event.first_bytes == line


@pytest.mark.parametrize(
    ("counts", "g"), [(512, 0.0), (614.4, 1.0), (409.6, -1.0), (0, -5.0), (204.8, -3.0)]
)
def test_adxl330_counts_are_300_mv_per_g_around_half_the_supply(counts: float, g: float):
    assert protocol("adxl330").to_nominal_g((counts, 512, 512))[0] == pytest.approx(g)


def test_empty_lines_are_nothing():
    assert decode("csv", b"\r\n\r\n\n\r") == []


@pytest.mark.parametrize(
    ("start", "found"),
    [
        (b".98\n", []),
        (b"02,0.98\n", []),
        (b"8,-0.02,0.98\n", []),
        (b"\xff\xfe\n", []),
        (b"34,0.01,-0.02,0.98\n", [Frame(None, (0.01, -0.02, 0.98))]),
    ],
)
def test_a_first_line_that_may_be_cut_is_no_fault_and_no_wrong_sample(
    start: bytes, found: list[DecoderEvent]
):
    decoder = protocol("csv").new_decoder()
    assert decoder.feed(start) == found
    assert decoder.feed(b"1235,0,0,1\n") == [Frame(1235, (0.0, 0.0, 1.0))]


def test_a_cut_running_number_makes_no_gap():
    decoder = protocol("adxl330").new_decoder()
    events = decoder.feed(b"4,512,512,614\n1235,512,512,614\n1236,512,512,614\n")
    assert [type(event) for event in events] == [Frame, Frame, Frame]


@given(st.integers(0, 60), st.sampled_from(NAMES))
def test_beginning_anywhere_in_a_good_stream_gives_only_samples_that_were_sent(
    start: int, name: str
):
    stream = b"".join(b"%d,510,509,614\r\n" % n for n in range(995, 1005))
    decoder = protocol(name).new_decoder()
    events = decoder.feed(stream[start:]) + decoder.end()
    assert {event.raw for event in frames(events)} == {(510.0, 509.0, 614.0)}
    assert len(frames(events)) == len(events)
    assert len(events) >= stream[start:].count(b"\r\n") - 1


def test_an_endless_first_line_is_told_about():
    decoder = protocol("csv").new_decoder()
    assert garbage(decoder.feed(b"U" * 1000))


def test_end_of_stream_makes_an_unfinished_line_garbage_not_a_sample():
    decoder = protocol("csv").new_decoder()
    decoder.feed(b"\n1,0,0,1\n2,0,0,1.2")
    (event,) = decoder.end()
    assert isinstance(event, Garbage)
    assert event.first_bytes == b"2,0,0,1.2"
    assert decoder.end() == []


def test_a_missing_number_is_a_gap_before_the_frame_that_follows():
    assert numbers(1, 2, 5) == [
        Frame(1, (0, 0, 1)),
        Frame(2, (0, 0, 1)),
        CounterGap(2),
        Frame(5, (0, 0, 1)),
    ]


@pytest.mark.parametrize("top", [1 << 8, 1 << 16, 1 << 32])
def test_a_counter_of_any_width_wraps_without_a_loss(top: int):
    assert len(frames(numbers(top - 2, top - 1, 0, 1))) == len(numbers(top - 2, top - 1, 0, 1))


@pytest.mark.parametrize("top", [1 << 8, 1 << 16, 1 << 32])
def test_frames_lost_over_a_wrap_are_counted(top: int):
    assert CounterGap(4) in numbers(top - 2, top - 1, 4)


@pytest.mark.parametrize("last", [150, 5000, 70000, 1 << 31, (1 << 32) + 5])
def test_a_sensor_that_starts_anew_has_lost_nothing(last: int):
    events = numbers(last - 1, last, 0, 1, 2)
    assert len(frames(events)) == len(events) == 5


@pytest.mark.parametrize(
    ("missed", "told"), [(1, True), (MAX_MISSED, True), (MAX_MISSED + 1, False)]
)
def test_a_jump_of_more_than_a_minute_is_a_restart_not_a_loss(missed: int, told: bool):
    assert (CounterGap(missed) in numbers(10, 11 + missed)) is told


@pytest.mark.parametrize(("before", "now"), [(10, 12 + MAX_MISSED), (5000, 4500), (5000, 4999)])
def test_a_number_that_neither_a_loss_nor_a_restart_explains_is_a_jump(before: int, now: int):
    assert CounterJump(before, now) in numbers(before - 1, before, now)


@pytest.mark.parametrize("top", [1000, 1024, 9999])
def test_a_counter_of_an_odd_width_wraps_without_a_jump(top: int):
    events = numbers(top - 2, top - 1, 0, 1)
    assert len(frames(events)) == len(events) == 4


def test_a_frame_that_comes_twice_is_no_sample():
    first, again, next_one = numbers(7, 7, 8)
    assert isinstance(first, Frame)
    assert isinstance(again, Repeated)
    assert "7" in again.reason
    assert isinstance(next_one, Frame)


@given(st.lists(st.integers(0, 1 << 33), min_size=1, max_size=30))
def test_no_sequence_of_numbers_makes_a_giant_loss(counters: list[int]):
    events = numbers(*counters)
    gaps = [event.missed for event in events if isinstance(event, CounterGap)]
    assert all(1 <= missed <= MAX_MISSED for missed in gaps)
    assert len(frames(events)) + len(garbage(events)) == len(counters)


@given(rubbish, st.sampled_from(NAMES), st.data())
def test_any_split_of_the_bytes_gives_the_same_events(noise: bytes, name: str, data: st.DataObject):
    stream = noise + b"\r\n7,0,0,1\r\n8,1,0,1\r" + noise + b"\n9,0,1,1"
    cuts = data.draw(st.lists(st.integers(0, len(stream)), max_size=8).map(sorted))
    whole, split = protocol(name).new_decoder(), protocol(name).new_decoder()
    expected = whole.feed(stream) + whole.end()
    events: list[DecoderEvent] = []
    for start, stop in zip([0, *cuts], [*cuts, len(stream)], strict=True):
        events += split.feed(stream[start:stop])
    assert events + split.end() == expected


@pytest.mark.parametrize("name", NAMES)
def test_one_byte_at_a_time_gives_the_same_events(name: str):
    stream = random.Random(1).randbytes(2000) + b"\n1,2,3,4\r\n2,2,3,4\n3,3,"
    whole, split = protocol(name).new_decoder(), protocol(name).new_decoder()
    events = [event for byte in stream for event in split.feed(bytes([byte]))]
    assert events + split.end() == whole.feed(stream) + whole.end()


@given(rubbish, st.sampled_from(NAMES))
def test_a_valid_line_after_any_rubbish_is_decoded(noise: bytes, name: str):
    decoder = protocol(name).new_decoder()
    decoder.feed(noise + b"\n")
    # The rubbish may by chance have held a frame with this very number.
    events = decoder.feed(b"31337,1,2,3\r\n31338,4,5,6\r\n")
    assert frames(events)[-1] == Frame(31338, (4.0, 5.0, 6.0))


@given(st.floats(-16, 16), st.floats(-16, 16), st.floats(-16, 16), st.integers(0, 65535))
def test_csv_gives_back_the_numbers_that_were_written(x: float, y: float, z: float, n: int):
    (event,) = decode("csv", f"{n},{x:.4f},{y:.6f},{z:.3e}\n".encode())
    assert isinstance(event, Frame)
    assert event.counter == n
    assert event.raw == (float(f"{x:.4f}"), float(f"{y:.6f}"), float(f"{z:.3e}"))
