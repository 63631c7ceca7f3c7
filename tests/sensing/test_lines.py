"""The line splitter: ends, limits, memory."""

from hypothesis import given
from hypothesis import strategies as st

from gestureapp.sensing.lines import FIRST_BYTES, MAX_LINE_BYTES, LineSplitter
from gestureapp.sensing.values import Garbage


def lines_of(data: bytes) -> list[bytes | Garbage]:
    return LineSplitter().feed(data)


def test_lf_cr_and_crlf_each_end_a_line():
    assert [line for line in lines_of(b"a\nb\rc\r\n") if line] == [b"a", b"b", b"c"]


def test_a_line_without_its_end_is_held_back_until_the_end_of_the_stream():
    splitter = LineSplitter()
    assert splitter.feed(b"abc") == []
    assert splitter.end() == b"abc"
    assert splitter.end() == b""


def test_the_longest_line_passes_and_one_byte_more_is_garbage():
    longest = b"x" * (MAX_LINE_BYTES - 1)
    assert lines_of(longest + b"\n") == [longest]
    (garbage, rest) = lines_of(longest + b"x\n")
    assert isinstance(garbage, Garbage)
    assert garbage.n_bytes == MAX_LINE_BYTES
    assert rest == b""


def test_the_rest_of_a_line_that_was_too_long_is_never_a_line():
    first, rest, line = lines_of(b"x" * MAX_LINE_BYTES + b"1,2,3\n0,0,1\n")
    assert isinstance(first, Garbage)
    assert isinstance(rest, Garbage)
    assert rest.first_bytes == b"1,2,3"
    assert line == b"0,0,1"


def test_an_endless_line_is_told_about_and_memory_stays_bounded():
    splitter = LineSplitter()
    dropped = 0
    for _ in range(1000):
        for garbage in splitter.feed(b"z" * 777):
            assert isinstance(garbage, Garbage)
            assert len(garbage.first_bytes) == FIRST_BYTES
            dropped += garbage.n_bytes
    held = splitter.end()
    assert len(held) < MAX_LINE_BYTES
    assert dropped + len(held) == 777_000


@given(st.lists(st.sampled_from([b"a", b"\n", b"\r", b"0,0,1", b"q" * 50]), max_size=40))
def test_no_byte_is_lost_or_made_up(pieces: list[bytes]):
    data = b"".join(pieces)
    splitter = LineSplitter()
    lines = [line for piece in pieces for line in splitter.feed(piece)]
    n_held = len(splitter.end())
    n_lines = sum(line.n_bytes if isinstance(line, Garbage) else len(line) for line in lines)
    n_ends = data.count(b"\n") + data.count(b"\r")
    assert n_lines + n_ends + n_held == len(data)
