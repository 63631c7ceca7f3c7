"""``witmotion`` and ``binary`` through their decoders: real bytes in, events out, any faults."""

import itertools
import random
import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gestureapp.sensing.protocols import protocol
from gestureapp.sensing.values import (
    Battery,
    CounterGap,
    CounterJump,
    DecoderEvent,
    Frame,
    Garbage,
    Identity,
    Repeated,
)
from gestureapp.simulation.sensor_wire import (
    encode_binary,
    encode_identity,
    encode_witmotion,
)

NAMES = ["witmotion", "binary"]
HELD_MAX_BYTES = 256
"""No decoder may keep more than this between two calls."""

LOST_MAX = {"witmotion": 1, "binary": 2}
"""Frames lost by one flipped byte, wherever it is."""

STREAM_FRAMES = 40

REGAINED_MAX = 3
"""So many frames at most are lost behind rubbish until all are found again."""


def sent(name: str, number: int) -> bytes:
    """One frame whose x says its number."""
    if name == "witmotion":
        return encode_witmotion(None, (number / 2048, -0.25, 1.0))[:11]
    return encode_binary(number, (number * 0.0005, -0.25, 1.0))


def stream(name: str, first: int = 1, count: int = STREAM_FRAMES) -> bytes:
    return b"".join(sent(name, number) for number in range(first, first + count))


def decode(name: str, data: bytes) -> list[DecoderEvent]:
    decoder = protocol(name).new_decoder()
    return decoder.feed(data) + decoder.end()


def frames(events: list[DecoderEvent]) -> list[Frame]:
    return [event for event in events if isinstance(event, Frame)]


def found(events: list[DecoderEvent]) -> list[int]:
    """The numbers that x says; every other field must be as sent."""
    seen = frames(events)
    assert {frame.raw[1:] for frame in seen} <= {(-512.0, 2048.0), (-500.0, 2000.0)}
    return [int(frame.raw[0]) for frame in seen]


def garbage(events: list[DecoderEvent]) -> list[Garbage]:
    return [event for event in events if isinstance(event, Garbage)]


rubbish = st.one_of(
    st.binary(max_size=300),
    st.lists(st.sampled_from([0x00, 0x01, 0x51, 0x52, 0x55, 0xFF]), max_size=200).map(bytes),
    st.lists(
        st.sampled_from(
            [stream("witmotion", 1, 3), stream("binary", 1, 3), encode_identity("x"), b"\x00", b"U"]
        ),
        max_size=8,
    ).map(b"".join),
)


@pytest.mark.parametrize(
    ("data", "raw"),
    [
        ("55 51 00 00 00 fc 00 08 c4 09 77", (0.0, -1024.0, 2048.0)),
        ("55 51 ff 7f 00 80 ff ff 00 00 a2", (32767.0, -32768.0, -1.0)),
    ],
)
def test_a_witmotion_frame_is_read_as_its_data_sheet_says(data: str, raw: tuple[float, ...]):
    assert decode("witmotion", bytes.fromhex(data) + b"U")[:1] == [Frame(None, raw)]


def test_other_frames_of_the_witmotion_family_are_passed_over():
    data = encode_witmotion(None, (0.5, 0.0, 1.0)) * 3
    assert decode("witmotion", data) == [Frame(None, (1024.0, 0.0, 2048.0))] * 3


def test_a_frame_with_a_wrong_checksum_is_garbage_that_says_so():
    wrong = bytes.fromhex("55 51 00 00 00 fc 00 08 c4 09 78")
    events = decode("witmotion", stream("witmotion", 1, 2) + wrong + stream("witmotion", 3, 2))
    (told,) = garbage(events)
    assert told == Garbage(11, wrong, "checksum 78 in a frame that adds up to 77")
    assert found(events) == [1, 2, 3, 4]


def test_a_stream_of_something_else_is_told_every_32_bytes():
    events = decode("witmotion", b"0.01,0.02,1.00\n" * 20)
    assert [event.n_bytes for event in garbage(events)[:3]] == [32, 32, 32]
    assert "55 51" in garbage(events)[0].reason


def test_the_newest_bluetooth_frames_of_that_maker_are_not_taken_for_these():
    ble = bytes.fromhex("55 61 35 ff 59 ff 0a 08 00 00 00 00 00 00 b9 fc 00 00 00 00")
    assert frames(decode("witmotion", ble * 50)) == []


def test_by_chance_a_right_checksum_makes_no_frame_without_a_header_behind_it():
    chance = bytes.fromhex("55 51 00 00 00 fc 00 08 c4 09 77")
    assert frames(decode("witmotion", b"\x01\x02" + chance + b"\x03" * 40)) == []


def test_the_same_after_frames_that_were_good():
    chance = bytes.fromhex("55 51 00 00 00 fc 00 08 c4 09 77")
    data = stream("witmotion", 1, 3) + b"\x01" + chance + b"\x03" * 40
    assert found(decode("witmotion", data)) == [1, 2, 3]


@pytest.mark.parametrize(
    ("kind", "is_ours"), [(0x4F, False), (0x50, True), (0x5F, True), (0x60, False)]
)
def test_the_witmotion_family_is_of_sixteen_kinds(kind: int, is_ours: bool):
    frame = bytes([0x55, kind, *range(8)])
    frame += bytes([sum(frame) % 256])
    data = stream("witmotion", 1, 2) + frame + stream("witmotion", 3, 2)
    assert bool(garbage(decode("witmotion", data))) is not is_ours
    assert found(decode("witmotion", data)) == [1, 2, 3, 4]


@pytest.mark.parametrize(("n_bytes", "is_told"), [(10, False), (11, True), (19, True)])
def test_less_than_a_frame_at_the_begin_is_the_rest_of_one(n_bytes: int, is_told: bool):
    events = decode("witmotion", b"\x01" * n_bytes + stream("witmotion", 1, 2))
    assert [event.n_bytes for event in garbage(events)] == ([n_bytes] if is_told else [])


def test_each_piece_of_garbage_has_a_reason_of_its_own():
    wrong = bytes.fromhex("55 51 00 00 00 fc 00 08 c4 09 78")
    good = [stream("witmotion", n, 2) for n in (1, 3, 5)]
    events = decode("witmotion", good[0] + wrong + good[1] + b"\x01\x02" + good[2])
    reasons = [event.reason for event in garbage(events)]
    assert [reason.split()[0] for reason in reasons] == ["checksum", "expected"]


def test_witmotion_counts_are_sixteen_g_at_full_scale():
    to_g = protocol("witmotion").to_nominal_g
    assert to_g((2048.0, -2048.0, -32768.0)) == (1.0, -1.0, -16.0)


def test_a_binary_sample_is_read_as_documented():
    data = bytes.fromhex("00 05 01 01 02 01 01 08 18 fc d0 07 50 49 92 00")
    assert decode("binary", data) == [Battery(80.0), Frame(258, (0.0, -1000.0, 2000.0))]
    assert protocol("binary").to_nominal_g((0.0, -1000.0, 2000.0)) == (0.0, -0.5, 1.0)


def test_a_name_is_read_as_documented_and_told_once():
    data = bytes.fromhex("0a 01 02 61 72 6d 20 37 17 47 00")
    assert decode("binary", data * 3 + encode_identity("Ärmel")) == [
        Identity("arm 7"),
        Identity("Ärmel"),
    ]


def test_the_battery_is_told_when_it_changes_and_never_when_unknown():
    percents = [255, 80, 80, 79, 255, 79, 0]
    data = b"".join(encode_binary(n, (0, 0, 1), p) for n, p in enumerate(percents))
    told = [event.percent for event in decode("binary", data) if isinstance(event, Battery)]
    assert told == [80.0, 79.0, 0.0]


@pytest.mark.parametrize("value", [-32768, 32767])
def test_the_ends_of_the_scale_are_beyond_what_a_sensor_gives(value: int):
    known = protocol("binary")
    assert abs(known.to_nominal_g((float(value), 0.0, 0.0))[0]) > known.limit_g


def packed(content: bytes) -> bytes:
    """A frame with a right CRC around any content, written out bit by bit."""
    crc = 0xFFFF
    for byte in content:
        for bit in range(7, -1, -1):
            crc = (crc << 1) ^ (0x1021 if (crc >> 15) ^ (byte >> bit & 1) else 0)
            crc &= 0xFFFF
    coded = b"".join(
        bytes([len(block) + 1]) + block
        for block in (content + struct.pack("<H", crc)).split(b"\x00")
    )
    return coded + b"\x00"


@pytest.mark.parametrize(
    ("frame", "reason"),
    [
        (packed(b"\x02\x01" + bytes(9)), "version 2 of this protocol, known is 1"),
        (packed(b"\x01\x01" + bytes(8)), "a sample of 8 bytes, expected 9"),
        (packed(b"\x01\x01" + bytes(8) + b"\x65"), "battery 101 %, expected 0 to 100 or 255"),
        (packed(b"\x01"), "a frame of 3 bytes is too short"),
        (packed(b"\x01\x02"), "a name is 1 to 20 bytes of printable UTF-8"),
        (packed(b"\x01\x02" + b"x" * 21), "a name is 1 to 20 bytes of printable UTF-8"),
        (packed(b"\x01\x02\xff\xfe"), "a name is 1 to 20 bytes of printable UTF-8"),
        (packed(b"\x01\x02a\nb"), "a name is 1 to 20 bytes of printable UTF-8"),
        (b"\x09\x01\x02\x00", "expected a COBS frame: a count in it points beyond its end"),
        (b"\x05\x01\x01\x02\x01\x01\x08\x18\xfc\xd0\x07\x51\x49\x92\x00", "CRC 9249 in a frame"),
    ],
)
def test_a_binary_frame_that_is_wrong_says_why(frame: bytes, reason: str):
    (event,) = decode("binary", b"\x00" + frame)
    assert type(event) is Garbage
    assert event.reason.startswith(reason)
    assert event.first_bytes == frame[:-1]


def test_kinds_of_frames_that_are_not_known_are_passed_over():
    data = b"\x00" + packed(b"\x01\x77" + bytes(60)) + stream("binary", 1, 2)
    assert [type(event) for event in decode("binary", data)] == [Frame, Frame]


def test_lost_repeated_and_jumping_numbers_are_told():
    numbers = [65_534, 65_535, 0, 0, 3, 40_000]
    events = decode("binary", b"".join(encode_binary(n, (0, 0, 1)) for n in numbers))
    others = [event for event in events if not isinstance(event, Frame)]
    assert [type(event) for event in others] == [Repeated, CounterGap, CounterJump]
    assert others[1] == CounterGap(2)


def test_a_connection_that_ends_inside_a_frame_gives_garbage_not_a_sample():
    for name in NAMES:
        data = stream(name, 1, 3)
        (told,) = garbage(decode(name, data[:-1]))
        assert "ended inside" in told.reason
        assert found(decode(name, data[:-1])) == [1, 2]


@pytest.mark.parametrize("name", NAMES)
def test_a_connection_that_ends_before_its_first_whole_frame_is_no_fault(name: str):
    for n_bytes in range(len(sent(name, 1))):
        assert decode(name, sent(name, 1)[-n_bytes - 1 : -1]) == []


@pytest.mark.parametrize("name", NAMES)
def test_beginning_anywhere_in_a_good_stream_gives_only_what_was_sent_and_no_garbage(name: str):
    data = stream(name, 1, 6)
    for start in range(3 * len(sent(name, 1))):
        decoder = protocol(name).new_decoder()
        events = decoder.feed(data[start:])
        numbers = found(events)
        assert len(events) == len(numbers), (start, events)
        assert numbers == list(range(numbers[0], 7))
        assert numbers[0] <= start // len(sent(name, 1)) + 2


@given(rubbish, st.sampled_from(NAMES), st.data())
def test_any_split_of_the_bytes_gives_the_same_events(noise: bytes, name: str, data: st.DataObject):
    wire = noise + stream(name, 1, 3) + noise + encode_identity("a") + stream(name, 9, 2) + noise
    cuts = data.draw(st.lists(st.integers(0, len(wire)), max_size=8).map(sorted))
    split = protocol(name).new_decoder()
    events: list[DecoderEvent] = []
    for start, stop in itertools.pairwise([0, *cuts, len(wire)]):
        events += split.feed(wire[start:stop])
    assert events + split.end() == decode(name, wire)


@pytest.mark.parametrize("name", NAMES)
def test_one_byte_at_a_time_gives_the_same_events(name: str):
    wire = random.Random(1).randbytes(2000) + stream(name) + b"\x55\x51"
    split = protocol(name).new_decoder()
    events = [event for byte in wire for event in split.feed(bytes([byte]))]
    assert events + split.end() == decode(name, wire)


@given(rubbish, st.sampled_from(NAMES))
def test_frames_after_any_rubbish_are_found_again(noise: bytes, name: str):
    """All but the first: rubbish can end inside what looks like a frame."""
    numbers = [int(frame.raw[0]) for frame in frames(decode(name, noise + stream(name, 1000)))]
    wanted = range(1000 + REGAINED_MAX, 1000 + STREAM_FRAMES)
    assert numbers[-len(wanted) :] == list(wanted)


@pytest.mark.parametrize("name", NAMES)
def test_every_single_flipped_bit_loses_no_more_than_stated_and_makes_no_sample(name: str):
    data = stream(name, 1, 8)
    for at in range(len(data)):
        for bit in range(8):
            wire = bytearray(data)
            wire[at] ^= 1 << bit
            numbers = found(decode(name, bytes(wire) + stream(name, 9, 2)))
            lost = set(range(1, 11)) - set(numbers)
            is_begin = at < 2 * len(sent(name, 1))  # the first is taken when a second follows
            assert len(lost) <= LOST_MAX[name] + is_begin, (at, bit, numbers)
            assert numbers == sorted(set(numbers)), (at, bit)


def cuts(name: str) -> list[tuple[int, list[DecoderEvent]]]:
    """Every cut of 1 to 20 bytes in three frames of twelve: frames touched, and the events."""
    data, size = stream(name, 1, 12), len(sent(name, 1))
    return [
        (
            (start + n_cut - 1) // size - start // size + 1,
            decode(name, data[:start] + data[start + n_cut :]),
        )
        for start in range(2 * size, 5 * size)
        for n_cut in range(1, 21)
    ]


def test_a_cut_in_binary_frames_loses_what_it_touches_and_one_beside_it():
    for touched, events in cuts("binary"):
        assert 12 - len(found(events)) <= touched + 1, events


def test_a_cut_in_witmotion_frames_is_seen_but_for_one_in_256():
    n_wrong = 0
    for touched, events in cuts("witmotion"):
        right = [frame for frame in frames(events) if frame.raw[1:] == (-512.0, 2048.0)]
        n_wrong += len(right) < len(frames(events))
        assert 12 - len(right) <= touched + 2, events
    assert n_wrong <= 0.01 * len(cuts("witmotion"))


@given(rubbish, st.sampled_from(NAMES))
def test_no_bytes_whatever_make_a_decoder_raise_or_keep_much(noise: bytes, name: str):
    decoder = protocol(name).new_decoder()
    events: list[DecoderEvent] = []
    for _ in range(20):
        events += decoder.feed(noise)
    assert sum(len(kept) for kept in held(decoder)) <= HELD_MAX_BYTES
    assert all(len(event.first_bytes) <= 32 for event in garbage(events))
    decoder.end()
    assert sum(len(kept) for kept in held(decoder)) == 0


def held(thing: object) -> list[bytearray]:
    """All byte arrays in an object and in those of ours that it has."""
    kept = []
    for value in vars(thing).values():
        if isinstance(value, bytearray):
            kept.append(value)
        elif type(value).__module__.startswith("gestureapp."):
            kept += held(value)
    return kept


@pytest.mark.parametrize("name", NAMES)
def test_an_endless_stream_without_a_frame_is_told_about(name: str):
    decoder = protocol(name).new_decoder()
    assert garbage(decoder.feed(b"\x33" * 1000))


def test_hours_of_random_bytes_make_next_to_no_samples():
    noise = random.Random(5).randbytes(2_000_000)
    assert len(frames(decode("binary", noise))) == 0
    assert len(frames(decode("witmotion", noise))) <= 1
