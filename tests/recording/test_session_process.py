"""A recorder in a process of its own: killed, and stopped by a limit of the system."""

import os
import signal
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

from gestureapp.errors import RecordingInvalid
from gestureapp.recording.session_reader import read_session

resource = pytest.importorskip("resource", reason="limits of a process, POSIX only")

ROOT = Path(__file__).parents[2]
pytestmark = pytest.mark.process

WRITE_FOREVER = """
    import sys, time
    from pathlib import Path
    from gestureapp.cell.records import Record, Topic
    from gestureapp.clock import monotonic
    from gestureapp.recording.session_writer import SessionWriter

    writer = SessionWriter(Path(sys.argv[1]), monotonic, time.time, {})
    writer.start()
    for line in sys.stdin:
        now_s = monotonic()
        writer.put(Record(Topic.EVENT, now_s, {"text": line.strip(), "is_alarm": False}))
        print(now_s, writer.status, flush=True)
    writer.stop()
    print(writer.status, flush=True)
"""


@pytest.fixture
def child(tmp_path):
    """A process that records one event for each line it is given; ended with the test."""
    started = []

    def start(**how):
        process = subprocess.Popen(
            [sys.executable, "-c", textwrap.dedent(WRITE_FOREVER), str(tmp_path)],
            cwd=ROOT,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
            **how,
        )
        started.append(process)
        return process

    yield start
    for process in started:
        process.kill()
        process.wait(20.0)
        process.stdin.close()
        process.stdout.close()


def _say(process, text):
    process.stdin.write(text + "\n")
    process.stdin.flush()
    return process.stdout.readline().split(" ", 1)


def test_a_killed_process_loses_the_last_second_at_most(child, tmp_path, wait_for):
    process = child()
    put_at_s = {}

    def two_chunks_are_there():
        number = len(put_at_s)
        put_at_s[number] = float(_say(process, str(number))[0])
        files = list((tmp_path / "sessions").glob("*.mcap"))
        return bool(files) and files[0].stat().st_size > 0 and _n_chunks(files[0]) >= 2

    wait_for(two_chunks_are_there)
    process.send_signal(signal.SIGKILL)
    process.wait(20.0)
    session = read_session(next((tmp_path / "sessions").glob("*.mcap")))
    texts = [int(found.record.fields["text"]) for found in session.records()]
    assert texts == list(range(len(texts)))
    lost_s = max(put_at_s.values()) - put_at_s[texts[-1]]
    assert 0 < len(texts) <= len(put_at_s)
    assert lost_s < 3.0, "about a second, with room for a busy machine"
    assert "not closed" in str(session.incomplete)


def _n_chunks(path):
    try:
        return len(read_session(path).chunks)
    except RecordingInvalid:  # its header is not there yet
        return 0


def _texts(folder):
    """The events on the disk by now, in files that are whole, cut off or just being made."""
    paths = [path for path in (folder / "sessions").glob("*.mcap") if _n_chunks(path)]
    found = [found.record for path in paths for found in read_session(path).records()]
    return {record.fields["text"] for record in found}


def test_a_real_limit_of_the_system_is_explained_and_the_record_goes_on(child, tmp_path, wait_for):
    limit = (24_000, 24_000)
    process = child(preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, limit))
    incompressible = [os.urandom(8_000).hex() for _ in range(3)]
    for text in incompressible:
        _say(process, text)
        wait_for(lambda text=text: text in _texts(tmp_path))
    process.stdin.close()
    assert "Recorded to" in process.stdout.read()
    files = sorted((tmp_path / "sessions").glob("*.mcap"))
    assert len(files) == 2
    assert all(path.stat().st_size <= limit[0] for path in files)
    texts = _texts(tmp_path)
    assert texts > set(incompressible)
    assert any("larger than this account may write" in text for text in texts)
