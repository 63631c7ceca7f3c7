"""A stop that no application could show is told at the next start, once."""

import os
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import pytest

from gestureapp.cell.last_time import find_last_time
from gestureapp.cell.snapshot import CellState
from gestureapp.children import child_environment
from gestureapp.recording.sensor_records import SensorRecord, save_record
from gestureapp.robot.acts import Act, Did
from gestureapp.robot.values import StopReason
from gestureapp.running import running_cell
from tests.cell.bench import Bench
from tests.cell.conftest import wait_until

APPLICATION = """
import sys, time
from pathlib import Path
from gestureapp.cell.snapshot import CellState
from gestureapp.running import running_cell
from gestureapp.settings_file import load_settings
settings, found = load_settings([Path(sys.argv[1])])
assert not found, found
with running_cell(settings, Path(sys.argv[2])) as running:
    is_told = False
    while True:
        running.cell.gui_tick()
        snapshot = running.cell.snapshot()
        if snapshot.can_arm and not is_told:
            running.cell.arm()
        if snapshot.state is CellState.ARMED and not is_told:
            is_told = True
            print("armed", flush=True)
        time.sleep(0.01)
"""
LIMIT_S = 15.0
STOP = Act(Did.STOPPING, "7", 1.8e9, 100.0, "left sensor silent", "left sensor silent", True)
GONE = Act(Did.GONE, "7", 1.8e9, 110.0, "its window connection ended", could_move=True)
STANDS = Act(Did.STANDS, "7", 1.8e9, 0.0, seen_s=0.12)


def write(path: Path, *lines: str | Act) -> None:
    texts = [f"x WARNING {line.line}" if isinstance(line, Act) else line for line in lines]
    path.write_text("".join(f"{text}\n" for text in texts), encoding="utf-8")


def test_it_tells_an_operator_what_happened_and_whoever_looks_further_the_cause(tmp_path: Path):
    log = tmp_path / "guardian.log"
    write(log, "rubbish", STOP, STANDS, GONE, '{"cut off')
    told = find_last_time(log)
    assert told is not None
    when = time.strftime("%H:%M:%S on %d %B %Y", time.localtime(1.8e9))
    assert told.text == (
        f"At {when} the left sensor fell silent while the robot could move. "
        "The robot was stopped and stood after 0.12 s. Look at the robot before you arm."
    )
    assert told.event == f"last run: the robot was stopped at {when[:8]}"
    cause, path = told.details.splitlines()
    assert cause == f"left sensor silent, at {when}; standstill confirmed after 0.12 s"
    assert path == str(log.absolute())


@pytest.mark.parametrize("after", [(GONE,), (GONE, Act(Did.ENDED, "7", 1.8e9, 120.0))])
def test_a_stop_that_was_not_confirmed_is_said_to_be_so_first(tmp_path: Path, after):
    log = tmp_path / "guardian.log"
    write(log, STOP, *after)
    told = find_last_time(log)
    assert told is not None
    assert told.text.startswith("IT IS NOT CONFIRMED THAT THE ROBOT STOPPED. At ")
    assert told.text.endswith("Look at the robot before you arm.")
    assert told.event.endswith(", not confirmed")


@pytest.mark.parametrize("reason", [reason.value for reason in StopReason if reason.is_latched])
def test_no_internal_word_reaches_the_operator(tmp_path: Path, reason: str):
    log = tmp_path / "guardian.log"
    write(log, replace(STOP, reason=reason, text="its window connection ended"), STANDS, GONE)
    told = find_last_time(log)
    assert told is not None
    for word in ("guardian", "application", "connection ended"):
        assert word not in told.text


def test_a_reason_of_another_version_is_told_in_its_own_words(tmp_path: Path):
    log = tmp_path / "guardian.log"
    write(log, replace(STOP, reason="not known here", text="the moon"), STANDS, GONE)
    told = find_last_time(log)
    assert told is not None
    assert "this happened: the moon, while the robot could move" in told.text


def test_a_move_that_nobody_was_left_to_stop_is_told_as_such(tmp_path: Path):
    log = tmp_path / "guardian.log"
    write(log, Act(Did.MOVES, "7", 1.8e9, 100.0, "increment 3, limited by outer sphere"))
    told = find_last_time(log)
    assert told is not None
    assert told.text.startswith("NOTHING HERE STOPPED THE ROBOT. At ")
    assert "increment" not in told.text
    assert "stopped" not in told.event


def test_what_was_shown_is_not_told_again_and_a_new_stop_is(tmp_path: Path):
    log = tmp_path / "guardian.log"
    write(log, STOP, STANDS, GONE)
    first, again = find_last_time(log), find_last_time(log)
    assert first is not None
    assert first == again
    first.note_shown()
    assert find_last_time(log) is None
    write(log, STOP, GONE)
    assert find_last_time(log) is not None


def test_the_older_log_is_read_as_well(tmp_path: Path):
    write(tmp_path / "guardian.log.1", STOP, STANDS)
    write(tmp_path / "guardian.log", GONE)
    assert find_last_time(tmp_path / "guardian.log") is not None


@pytest.mark.parametrize("content", [None, b"", b"\xff\xfe\x00" * 99, b"\t{}\n\t[]\n"])
def test_a_log_that_is_missing_or_damaged_tells_nothing(tmp_path: Path, content: bytes | None):
    log = tmp_path / "guardian.log"
    if content is not None:
        log.write_bytes(content)
    assert find_last_time(log) is None


def test_a_folder_that_takes_no_file_only_has_it_told_once_more(tmp_path: Path):
    log = tmp_path / "guardian.log"
    write(log, STOP, GONE)
    (tmp_path / "guardian.shown").mkdir()
    told = find_last_time(log)
    assert told is not None
    told.note_shown()
    assert find_last_time(log) == told


def settings_of(bench: Bench, folder: Path) -> Path:
    s = bench.settings
    file = folder / "cell.toml"
    file.write_text(
        f'schema = 1\n[left]\nport = "{s.left.port}"\n[right]\nport = "{s.right.port}"\n'
        f'[robot]\nhost = "{s.robot.host}"\nport = {s.robot.port}\n'
        f'[person]\nname = "Test"\nmodel = "{s.person.model}"\n'
        "[site]\ntrip_level_s = 0.3\ncontrol_limit_s = 0.5\ngui_limit_s = 1.0\n"
    )
    return file


@pytest.mark.process
@pytest.mark.skipif(os.name == "nt", reason="kill -9")
def test_an_application_killed_while_moving_is_told_of_at_the_next_start(tmp_path: Path):
    folder = tmp_path / "data"
    folder.mkdir()
    with Bench(tmp_path) as bench:
        bench.until(lambda s: s.robot.is_connected)
        for port in (bench.settings.left.port, bench.settings.right.port):
            save_record(folder, SensorRecord(port, calibrated_wall_s=time.time()))
        bench.cell.shutdown()  # the emulators are for the other application
        program = [
            sys.executable,
            "-c",
            APPLICATION,
            str(settings_of(bench, tmp_path)),
            str(folder),
        ]
        child = subprocess.Popen(program, stdout=subprocess.PIPE, env=child_environment())
        try:
            assert child.stdout is not None
            bench.operator.left_stop()
            bench.operator.right_rest()
            assert child.stdout.readline() == b"armed\n"
            bench.operator.gesture("X+")
            assert wait_until(bench.nx100.is_running, LIMIT_S)
        finally:
            child.send_signal(signal.SIGKILL)
            child.wait(LIMIT_S)
            assert child.stdout is not None
            child.stdout.close()
        assert wait_until(lambda: not bench.nx100.is_running(), LIMIT_S)
        log = folder / "guardian.log"
        assert wait_until(lambda: '"did": "ended"' in log.read_text(), LIMIT_S)

        with running_cell(bench.settings, folder) as running:
            told = running.last_time
            assert told is not None
            assert " the program ended while the robot could move. " in told.text
            assert "The robot was stopped and stood after 0." in told.text
            lines = lambda: running.cell.snapshot().events  # noqa: E731
            assert wait_until(lambda: told.event in [line.text for line in lines()], LIMIT_S)
            assert not any(line.is_alarm for line in lines() if line.text == told.event)
            assert running.cell.snapshot().state is CellState.NOT_READY
            told.note_shown()
        with running_cell(bench.settings, folder) as running:
            assert running.last_time is None
