"""The recorder keeps the cell going whatever the disk does, and says what happened."""

import errno
import itertools
import threading
from pathlib import Path

import pytest

from gestureapp.cell.records import Record, Topic
from gestureapp.recording.backlog import Backlog, Dropped
from gestureapp.recording.mcap_file import Anchor, explain
from gestureapp.recording.session_reader import read_session
from gestureapp.recording.session_writer import SessionWriter

WALL_S = 1_795_000_000.0


@pytest.fixture
def recorder(tmp_path, clock, disk):
    """A recorder without a thread, on a disk that does as it is told."""
    writer = SessionWriter(
        tmp_path,
        clock,
        lambda: WALL_S + clock(),
        {},
        backlog=Backlog(plot_mark=10, limit=500),
        open_file=disk.open,
    )
    yield writer
    disk.error, disk.room = 0, None
    writer.close()


@pytest.fixture
def live(tmp_path, disk):
    """A running recorder on that disk; its clock can be moved while it waits."""
    ticks = [1000.0]
    writer = SessionWriter(
        tmp_path,
        lambda: ticks[0],
        lambda: WALL_S,
        {},
        backlog=Backlog(plot_mark=10, limit=1000),
        open_file=disk.open,
    )
    writer.start()
    yield writer, ticks
    disk.error, disk.room = 0, None
    disk.gate.set()
    writer.stop(20.0)


def _all_records(folder):
    sessions = [read_session(path) for path in sorted((folder / "sessions").iterdir())]
    return [found.record for session in sessions for found in session.records()]


def _activations(records):
    return [r.fields["activation_id"] for r in records if r.topic is Topic.STATE]


def _events(records):
    return [r.fields for r in records if r.topic is Topic.EVENT]


def test_a_session_is_recorded_by_its_own_thread(tmp_path, decision, left, wait_for):
    writer = SessionWriter(tmp_path, lambda: 1000.0, lambda: WALL_S, {"person": "Ada"})
    assert "not started" in writer.status
    writer.put(decision(0, 1000.0))
    writer.start()
    wait_for(lambda: writer.path is not None)
    assert writer.status == f"Recording to {writer.path}."
    writer(left(1, 1000.1))
    writer.put(decision(2, 1000.2))
    writer.stop()
    writer.stop()
    assert writer.status == f"Recorded to {writer.path}."
    session = read_session(writer.path)
    assert session.incomplete is None
    assert session.metadata["person"] == "Ada"
    assert [found.record.t_s for found in session.records()] == [1000.0, 1000.1, 1000.2]
    assert writer.n_dropped == 0
    assert not [thread for thread in threading.enumerate() if thread.name == "recorder"]


def test_a_recorder_that_was_never_started_can_be_stopped(tmp_path, clock, decision):
    writer = SessionWriter(tmp_path, clock, clock, {})
    writer.stop()
    writer.put(decision(1, 1.0))
    assert writer.n_dropped == 1
    assert "not started" in writer.status
    assert not (tmp_path / "sessions").exists()


def test_what_comes_after_the_end_is_counted(tmp_path, clock, decision):
    writer = SessionWriter(tmp_path, clock, clock, {})
    writer.start()
    writer.stop(20.0)
    writer.put(decision(1, 1.0))
    assert writer.dropped == Dropped(0, 1)


def test_a_chunk_is_on_the_disk_before_it_is_a_second_old(recorder, clock, decision):
    recorder.step()
    recorder.put(decision(1, clock()))
    recorder.step()
    assert list(read_session(recorder.path).records()) == []
    clock.move(0.85)
    recorder.step()
    assert _activations(f.record for f in read_session(recorder.path).records()) == [1]


def test_more_records_than_one_step_takes_are_written_in_several(tmp_path, clock, decision):
    writer = SessionWriter(tmp_path, clock, clock, {})
    for number in range(250):
        writer.put(decision(number, clock()))
    assert [writer.step() for _ in range(3)] == [True, True, False]
    writer.close()
    assert _activations(_all_records(tmp_path)) == list(range(250))


@pytest.mark.parametrize(
    ("code", "words"),
    [
        (errno.ENOSPC, "no room is left on the disk; free some space"),
        (errno.EDQUOT, "no room is left on the disk; free some space"),
        (errno.EROFS, "writing is not permitted"),
        (errno.EACCES, "writing is not permitted"),
        (errno.ENOENT, "the folder cannot be made"),
        (errno.EFBIG, "larger than this account may write"),
        (errno.EIO, "check the disk"),
    ],
)
def test_a_disk_that_fails_is_explained_and_the_next_file_has_everything(
    recorder, disk, clock, decision, tmp_path, code, words
):
    recorder.step()
    recorder.put(decision(1, clock()))
    clock.move(1.0)
    recorder.step()
    disk.error = code
    recorder.put(decision(2, clock()))
    clock.move(1.0)
    recorder.step()
    assert recorder.status.startswith("Not recording: ")
    assert words in recorder.status
    assert "\n" not in recorder.status
    recorder.put(decision(3, clock()))
    disk.error = 0
    clock.move(1.0)
    recorder.step()
    assert recorder.status == f"Recording to {recorder.path}."
    recorder.close()
    records = _all_records(tmp_path)
    assert _activations(records) == [1, 2, 3]
    told = _events(records)
    assert len(told) == 1
    assert "interrupted for 1.0 s" in told[0]["text"]
    assert words in told[0]["text"]
    assert told[0]["is_alarm"] is False
    assert recorder.n_dropped == 0


def test_the_next_file_names_the_one_it_continues(recorder, disk, clock, decision, tmp_path):
    recorder.step()
    recorder.put(decision(1, clock()))
    clock.move(1.0)
    recorder.step()
    first = recorder.path
    disk.error = errno.EIO
    recorder.put(decision(2, clock()))
    clock.move(1.0)
    recorder.step()
    disk.error = 0
    clock.move(1.0)
    recorder.step()
    assert recorder.path != first
    assert read_session(recorder.path).metadata["continues"] == first.name
    assert "continues" not in read_session(first).metadata


def test_tries_come_later_and_later_and_leave_no_empty_files(recorder, disk, clock, tmp_path):
    disk.error = errno.ENOSPC
    tries = []

    def failing(path):
        tries.append(clock())
        return disk.open(path)

    recorder._open_file = failing
    for _ in range(100 * 8):
        recorder.step()
        clock.move(0.125)
    pauses = [later - earlier for earlier, later in itertools.pairwise(tries)]
    assert pauses == [1.0, 2.0, 4.0, 8.0, 16.0, 30.0, 30.0]
    assert list((tmp_path / "sessions").iterdir()) == []
    assert recorder.path is None


def test_a_folder_that_cannot_be_made_is_tried_again(tmp_path, clock, decision):
    (tmp_path / "sessions").write_text("in the way")
    writer = SessionWriter(tmp_path, clock, lambda: WALL_S, {})
    writer.put(decision(1, clock()))
    writer.step()
    assert "Not recording" in writer.status
    (tmp_path / "sessions").unlink()
    clock.move(1.0)
    writer.step()
    writer.close()
    assert _activations(_all_records(tmp_path)) == [1]


def test_while_the_disk_is_full_plot_data_goes_before_decisions(
    recorder, disk, clock, decision, left, tmp_path
):
    recorder.step()
    disk.room = 0
    clock.move(1.0)
    recorder.put(decision(0, clock()))
    recorder.step()
    for number in range(1, 16):
        recorder.put(left(number, clock()))
        recorder.put(decision(number, clock()))
    assert recorder.dropped.n_plot > 0
    assert recorder.dropped.n_decisions == 0
    assert "Not recorded: " in recorder.status
    disk.room = None
    clock.move(1.0)
    recorder.step()
    recorder.close()
    records = _all_records(tmp_path)
    assert _activations(records) == list(range(16))
    told = _events(records)
    assert f"Not recorded: {recorder.dropped.n_plot} samples." in told[-1]["text"]
    assert told[-1]["is_alarm"] is True


def test_a_disk_that_fills_inside_a_chunk_leaves_the_chunks_before_it(
    recorder, disk, clock, decision, tmp_path
):
    recorder.step()
    recorder.put(decision(1, clock()))
    clock.move(1.0)
    recorder.step()
    first = recorder.path
    disk.room = 40
    recorder.put(decision(2, clock()))
    clock.move(1.0)
    recorder.step()
    session = read_session(first)
    assert _activations(f.record for f in session.records()) == [1]
    assert session.incomplete is not None


def test_a_disk_that_fails_at_the_very_end_gets_one_more_file(
    recorder, disk, clock, decision, tmp_path
):
    recorder.step()
    recorder.put(decision(1, clock()))
    disk.room = 0
    opened = disk.open

    def open_with_room(path):
        disk.room = None
        return opened(path)

    recorder._open_file = open_with_room
    recorder.close()
    assert _activations(_all_records(tmp_path)) == [1]


def test_a_disk_that_is_full_to_the_end_costs_the_rest_and_says_so(
    recorder, disk, clock, decision, tmp_path
):
    recorder.step()
    disk.room = 0
    recorder.put(decision(1, clock()))
    recorder.close()
    assert recorder.dropped == Dropped(0, 1)
    assert "no room is left" in recorder.status
    assert "Not recorded: 1 decisions." in recorder.status


@pytest.mark.logs_errors
def test_a_record_that_is_no_json_is_counted_and_the_rest_is_written(
    recorder, clock, decision, tmp_path
):
    endless: dict = {}
    endless["self"] = endless
    recorder.put(Record(Topic.INPUT, clock(), endless))
    recorder.put(decision(1, clock()))
    recorder.step()
    recorder.close()
    records = _all_records(tmp_path)
    assert _activations(records) == [1]
    assert "gap. Not recorded: 1 decisions." in _events(records)[0]["text"]


def test_a_stalled_disk_holds_up_nobody_and_is_told_of(live, disk, left, decision, wait_for):
    writer, ticks = live
    wait_for(lambda: writer.path is not None)
    disk.gate.clear()
    writer.put(decision(0, ticks[0]))
    ticks[0] += 1.0
    assert disk.is_waiting.wait(20.0)
    for number in range(1, 31):
        writer.put(left(number, ticks[0]))
        writer.put(decision(number, ticks[0]))
    ticks[0] += 5.0
    assert "the disk has taken nothing for 5 s" in writer.status
    assert "samples" in writer.status
    assert writer.dropped.n_plot > 0
    disk.gate.set()
    wait_for(lambda: "stalls" not in writer.status)
    writer.stop(20.0)
    records = [found.record for found in read_session(writer.path).records()]
    assert _activations(records) == list(range(31))
    told = [event["text"] for event in _events(records)]
    assert len(told) == 1
    assert "The disk took nothing for 5.0 s." in told[0]
    assert f"Not recorded: {writer.dropped.n_plot} samples." in told[0]


def test_stopping_on_a_stalled_disk_returns_and_says_so(live, disk, decision, wait_for):
    writer, ticks = live
    wait_for(lambda: writer.path is not None)
    disk.gate.clear()
    writer.put(decision(0, ticks[0]))
    ticks[0] += 1.0
    assert disk.is_waiting.wait(20.0)
    ticks[0] += 3.0
    writer.stop(wait_s=0.01)
    assert "Recording stalls" in writer.status


@pytest.mark.logs_errors
def test_a_recorder_that_breaks_says_so_and_counts_the_rest(tmp_path, clock, decision, wait_for):
    def broken(path):
        raise RuntimeError("a bug")

    writer = SessionWriter(tmp_path, clock, lambda: WALL_S, {}, open_file=broken)
    writer.start()
    wait_for(lambda: "a bug" in writer.status)
    wait_for(lambda: not writer._worker.is_alive)
    writer.put(decision(1, 1.0))
    assert writer.n_dropped == 1
    assert "Not recording" in writer.status
    writer.stop()


def test_times_that_are_none_do_not_stop_the_record():
    anchor = Anchor(5, 1.0)
    assert [anchor.wall_at_ns(t_s) for t_s in (float("nan"), float("inf"), -1e9)] == [0, 0, 0]
    assert anchor.wall_at_ns(1e280) == 2**64 - 1
    assert anchor.wall_at_ns(2.0) == 1_000_000_005


def test_an_unknown_disk_error_is_explained_too():
    assert "check the disk" in str(explain(Path("/a/b.mcap"), OSError("odd")))
