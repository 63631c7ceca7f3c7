"""What is put into a session comes out of its file: by our reader, by plain mcap, and cut off."""

import json
import re
import struct
import zlib

import pytest
import zstandard
from hypothesis import given, settings
from hypothesis import strategies as st
from mcap.reader import make_reader
from mcap.writer import Writer

from gestureapp import __version__
from gestureapp.cell.records import Record, Topic
from gestureapp.errors import RecordingIncomplete, RecordingInvalid
from gestureapp.recording.schemas import METADATA_NAME, PROFILE, SCHEMAS
from gestureapp.recording.session_reader import read_session
from gestureapp.recording.session_writer import SessionWriter

WALL_S = 1_795_000_000.25
METADATA = {"mode": "simulation", "person": "Ada Ångström", "model": "3f2a", "settings": "a = 1\n"}
ONE_OF_EACH = [
    Record(
        Topic.LEFT_ACCEL,
        1000.01,
        {"seq": 0, "ax_g": 0.1, "ay_g": 0.2, "az_g": 1.0, "counter": None},
    ),
    Record(
        Topic.RIGHT_ACCEL, 1000.02, {"seq": 0, "ax_g": 0.1, "ay_g": 0.2, "az_g": 1.0, "counter": 7}
    ),
    Record(
        Topic.GARBAGE,
        1000.03,
        {"side": "left", "n_bytes": 3, "first_bytes": "00ff10", "reason": "no number"},
    ),
    Record(Topic.INPUT, 1000.04, {"type": "health", "age_s": float("inf"), "t_s": 1000.0399}),
    Record(
        Topic.STATE, 1000.05, {"state": "ARMED", "sentence": "Raise it.", "activation_id": None}
    ),
    Record(
        Topic.RECOGNITION,
        1000.06,
        {
            "activation_id": 1,
            "label": None,
            "reason": "two outputs",
            "outputs": {"X+": 0.51, "X-": 0.6},
            "window_start_s": 1000.0,
            "window_end_s": 1000.02,
            "decided_s": 1000.021,
        },
    ),
    Record(Topic.COMMAND, 1000.07, {"type": "refused", "reason": "not_armed"}),
    Record(Topic.ROBOT, 1000.08, {"data_1": 194, "data_2": None, "x_mm": 712.5}),
    Record(Topic.SETTINGS, 1000.085, {"changes": {"robot.speed_mm_s": 80.0}}),
    Record(Topic.EVENT, 1000.09, {"text": "Stopped by the left arm.", "is_alarm": False}),
]


@pytest.fixture
def record_file(tmp_path, clock):
    """Writes these batches, one chunk each, without a thread; gives the file."""

    def make(*batches, finish=True):
        writer = SessionWriter(tmp_path, clock, lambda: WALL_S, METADATA)
        writer.step()
        for batch in batches:
            for record in batch:
                writer.put(record)
            clock.move(1.0)
            writer.step()
        if finish:
            writer.close()
        else:
            writer._file.abandon()
        return writer.path

    return make


@pytest.fixture
def three_chunks(record_file, left):
    """A finished file of three chunks with five samples each."""
    batches = [[left(5 * k + i, 1000.0 + k + i / 10) for i in range(5)] for k in range(3)]
    return record_file(*batches)


def _session_or_line(path):
    """The session, or the line that says why there is none. Anything else that is raised fails."""
    try:
        return read_session(path)
    except RecordingInvalid as error:
        return str(error)


def _seqs(session):
    return [found.record.fields["seq"] for found in session.records()]


def test_every_kind_of_record_comes_back_exactly(record_file):
    session = read_session(record_file(ONE_OF_EACH))
    assert {record.topic for record in ONE_OF_EACH} == set(Topic)
    assert [found.record for found in session.records()] == ONE_OF_EACH
    assert session.incomplete is None
    assert session.damage() == ()


def test_the_wall_time_of_a_record_is_the_anchor_and_the_monotonic_difference(record_file):
    session = read_session(record_file(ONE_OF_EACH))
    for found in session.records():
        assert found.wall_s == pytest.approx(WALL_S + found.record.t_s - 1000.0, abs=1e-6)
    assert session.start_wall_s == pytest.approx(WALL_S + 0.01, abs=1e-6)
    assert session.end_wall_s == pytest.approx(WALL_S + 0.09, abs=1e-6)


def test_records_can_be_chosen_by_topic(record_file):
    session = read_session(record_file(ONE_OF_EACH))
    topics = {Topic.ROBOT, Topic.EVENT}
    assert {found.record.topic for found in session.records(topics)} == topics


def test_the_metadata_says_what_was_given_and_when_it_began(record_file):
    metadata = read_session(record_file(ONE_OF_EACH)).metadata
    assert metadata.items() >= METADATA.items()
    assert metadata["application_version"] == __version__
    assert metadata["format"] == "1"
    assert metadata["start_wall"] == "2026-11-18T11:06:40.250+00:00"
    assert int(metadata["start_wall_ns"]) == 1_795_000_000_250_000_000
    assert float(metadata["start_monotonic_s"]) == 1000.0


def test_the_name_says_when_and_sorts_by_time(record_file, tmp_path):
    path = record_file(ONE_OF_EACH)
    assert path.parent == tmp_path / "sessions"
    assert re.fullmatch(r"2026-11-18T11-06-40Z_[0-9a-f]{6}\.mcap", path.name)


def test_plain_mcap_finds_every_topic_with_its_schema_and_both_times(record_file):
    with record_file(ONE_OF_EACH).open("rb") as stream:
        reader = make_reader(stream, validate_crcs=True)
        summary = reader.get_summary()
        channels = {channel.topic: channel for channel in summary.channels.values()}
        messages = list(reader.iter_messages(log_time_order=False))
        metadata = [found for found in reader.iter_metadata() if found.name == METADATA_NAME]
    assert set(channels) == {topic.value for topic in Topic}
    for topic in Topic:
        channel = channels[topic.value]
        schema = summary.schemas[channel.schema_id]
        assert channel.message_encoding == "json"
        assert schema.encoding == "jsonschema"
        assert json.loads(schema.data) == SCHEMAS[topic]
    assert len(metadata) == 1
    for record, (_, channel, message) in zip(ONE_OF_EACH, messages, strict=True):
        assert channel.topic == record.topic.value
        assert message.publish_time == round(record.t_s * 1e9)
        expected_ns = 1_795_000_000_250_000_000 + round((record.t_s - 1000.0) * 1e9)
        assert message.log_time == expected_ns
        assert set(SCHEMAS[record.topic]["required"]) <= set(json.loads(message.data))
    assert [message.sequence for _, _, message in messages] == list(range(1, len(ONE_OF_EACH) + 1))


def test_messages_have_the_types_their_schemas_say(record_file):
    python = {
        "number": (int, float),
        "integer": int,
        "string": str,
        "boolean": bool,
        "object": dict,
        "null": type(None),
    }
    with record_file(ONE_OF_EACH).open("rb") as stream:
        for _, channel, message in make_reader(stream).iter_messages():
            schema = SCHEMAS[Topic(channel.topic)]
            for name, value in json.loads(message.data).items():
                kinds = schema["properties"].get(name, {}).get("type", list(python))
                kinds = [kinds] if isinstance(kinds, str) else kinds
                assert any(isinstance(value, python[kind]) for kind in kinds), name


def test_a_file_cut_anywhere_gives_all_complete_chunks_and_says_what_is_missing(
    three_chunks, tmp_path
):
    whole = three_chunks.read_bytes()
    ends = [place.offset + place.length for place in read_session(three_chunks).chunks]
    cut = tmp_path / "cut.mcap"
    n_unreadable = 0
    for n_bytes in range(0, len(whole), 13):
        cut.write_bytes(whole[:n_bytes])
        session = _session_or_line(cut)
        if isinstance(session, str):
            n_unreadable += 1
            assert n_bytes < ends[0]
            assert "\n" not in session
            continue
        n_complete = sum(end <= n_bytes for end in ends)
        assert _seqs(session) == list(range(5 * n_complete))
        assert isinstance(session.incomplete, RecordingIncomplete)
        assert "\n" not in str(session.incomplete)
    assert n_unreadable < ends[0] / 13


def test_a_file_cut_inside_a_chunk_says_how_many_seconds_are_missing(three_chunks):
    place = read_session(three_chunks).chunks[-1]
    whole = three_chunks.read_bytes()
    three_chunks.write_bytes(whole[: place.offset + place.length - 1])
    session = read_session(three_chunks)
    assert "readable from 11:06:40 to 11:06:41 UTC" in str(session.incomplete)
    assert "the last 1.0 s are missing" in str(session.incomplete)


def test_a_file_that_was_never_closed_gives_all_its_chunks(record_file, left):
    path = record_file([left(0, 1000.0)], [left(1, 1001.0)], finish=False)
    session = read_session(path)
    assert _seqs(session) == [0, 1]
    assert "not closed" in str(session.incomplete)


def test_a_damaged_chunk_is_passed_over_and_told_of(three_chunks):
    place = read_session(three_chunks).chunks[1]
    data = bytearray(three_chunks.read_bytes())
    data[place.offset + place.length - 3] ^= 0xFF
    three_chunks.write_bytes(data)
    session = read_session(three_chunks)
    found = session.damage()
    assert _seqs(session) == [*range(5), *range(10, 15)]
    assert len(found) == 1
    assert "passed over" in found[0].text
    assert (found[0].start_wall_s, found[0].end_wall_s) == (
        place.start_ns / 10**9,
        place.end_ns / 10**9,
    )


def test_the_names_of_the_topics_survive_a_damaged_first_chunk(three_chunks):
    place = read_session(three_chunks).chunks[0]
    data = bytearray(three_chunks.read_bytes())
    data[place.offset + 60] ^= 0xFF
    three_chunks.write_bytes(data)
    assert _seqs(read_session(three_chunks)) == list(range(5, 15))


@settings(max_examples=60, deadline=None)
@given(data=st.data())
def test_any_changed_bytes_give_records_or_one_clear_line(tmp_path_factory, data):
    path = tmp_path_factory.getbasetemp() / "changed.mcap"
    whole = _small_file(tmp_path_factory)
    changed = bytearray(whole)
    for _ in range(data.draw(st.integers(1, 4))):
        at = data.draw(st.integers(0, len(whole) - 1))
        changed[at] = data.draw(st.integers(0, 255))
    path.write_bytes(changed)
    session = _session_or_line(path)
    if isinstance(session, str):
        assert "\n" not in session
        return
    told = []
    for found in session.records(on_damage=told.append):
        assert found.record.topic in set(Topic)
    assert all("\n" not in damage.text for damage in told)


_SMALL: list[bytes] = []


def _small_file(tmp_path_factory) -> bytes:
    if not _SMALL:
        writer = SessionWriter(tmp_path_factory.mktemp("small"), lambda: 1000.0, lambda: WALL_S, {})
        for record in ONE_OF_EACH:
            writer.put(record)
        writer.close()
        _SMALL.append(writer.path.read_bytes())
    return _SMALL[0]


@settings(max_examples=60, deadline=None)
@given(rubbish=st.binary(max_size=400), with_magic=st.booleans())
def test_rubbish_is_refused_in_one_line(tmp_path_factory, rubbish, with_magic):
    path = tmp_path_factory.getbasetemp() / "rubbish.mcap"
    path.write_bytes((b"\x89MCAP0\r\n" if with_magic else b"") + rubbish)
    with pytest.raises(RecordingInvalid) as caught:
        read_session(path)
    assert "\n" not in str(caught.value)


def _foreign(path, profile, metadata):
    with path.open("wb") as stream:
        writer = Writer(stream)
        writer.start(profile)
        if metadata is not None:
            writer.add_metadata(METADATA_NAME, metadata)
        writer.finish()


@pytest.mark.parametrize(
    ("profile", "metadata", "words"),
    [
        ("ros2", None, "another application"),
        (PROFILE, None, "description of the session"),
        (PROFILE, {"format": "2"}, "format '2' and this version reads 1"),
        (PROFILE, {"format": "x" * 1000}, "and this version reads 1"),
        (PROFILE, {}, "format '' and this version reads 1"),
    ],
)
def test_files_that_are_not_ours_or_newer_are_refused_by_name(tmp_path, profile, metadata, words):
    path = tmp_path / "foreign.mcap"
    _foreign(path, profile, metadata)
    with pytest.raises(RecordingInvalid, match=words):
        read_session(path)


def test_empty_missing_and_unreadable_files_are_refused(tmp_path):
    empty = tmp_path / "empty.mcap"
    empty.touch()
    with pytest.raises(RecordingInvalid, match="empty"):
        read_session(empty)
    with pytest.raises(RecordingInvalid, match="No such file"):
        read_session(tmp_path / "absent.mcap")
    with pytest.raises(RecordingInvalid, match="not a file"):
        read_session(tmp_path)


def test_a_file_that_vanishes_while_it_is_read_is_told_of(three_chunks):
    session = read_session(three_chunks)
    three_chunks.unlink()
    with pytest.raises(RecordingInvalid, match="No such file"):
        next(session.records())


def test_a_chunk_that_claims_to_be_huge_is_passed_over(three_chunks):
    place = read_session(three_chunks).chunks[2]
    data = bytearray(three_chunks.read_bytes())
    data[place.offset + 16 : place.offset + 24] = struct.pack("<Q", 2**62)
    three_chunks.write_bytes(data)
    assert _seqs(read_session(three_chunks)) == list(range(10))


def test_a_message_that_is_no_json_is_passed_over(tmp_path):
    path = tmp_path / "odd.mcap"
    with path.open("wb") as stream:
        writer = Writer(stream)
        writer.start(PROFILE)
        writer.add_metadata(METADATA_NAME, {"format": "1"})
        ours = writer.register_channel(Topic.EVENT.value, "json", 0)
        other = writer.register_channel("/unknown", "json", 0)
        writer.add_message(ours, log_time=1, publish_time=1, data=b"\xff{")
        writer.add_message(other, log_time=2, publish_time=2, data=b'{"t_s":1}')
        writer.add_message(ours, log_time=3, publish_time=3, data=b'{"t_s":1.5,"text":"x"}')
        writer.finish()
    records = [found.record for found in read_session(path).records()]
    assert records == [Record(Topic.EVENT, 1.5, {"text": "x"})]


def test_chunks_are_compressed_and_have_a_checksum(three_chunks):
    place = read_session(three_chunks).chunks[0]
    with three_chunks.open("rb") as stream:
        stream.seek(place.offset)
        chunk = place.parse(stream.read(place.length))
    assert chunk.compression == "zstd"
    assert len(chunk.data) < chunk.uncompressed_size
    assert zlib.crc32(zstandard.decompress(chunk.data)) == chunk.uncompressed_crc
