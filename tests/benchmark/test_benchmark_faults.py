"""The faults' table and JSON, the names of the faults, and the controller's log as it grows."""

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gestureapp.benchmark import measure_faults
from gestureapp.benchmark.controller_log import ControllerLog
from gestureapp.benchmark.faults import run_faults
from gestureapp.benchmark.faults.scenario import Expected, Outcome
from gestureapp.benchmark.faults.scenarios import SCENARIOS
from gestureapp.benchmark.faults.table import FaultReport, FaultRow
from gestureapp.errors import ConfigError

KILL = next(s for s in SCENARIOS if s.name == "kill")
COLLECTING = next(s for s in SCENARIOS if s.expected is Expected.MOVES_NOT)
FINE = Outcome(12.0, 112.0, "application gone", ())
LINES = [
    {"t_s": 1.0, "event": "bytes", "direction": "in", "connection": 2, "text": "HOSTCTRL_REQUEST"},
    {"t_s": 1.5, "event": "motion_start", "reason": "", "pose": []},
    {"t_s": 2.0, "event": "request", "connection": 2, "request": "HOLD", "data": "1"},
    {"t_s": 3.0, "event": "motion_end", "reason": "hold", "pose": []},
]
TEXT = b"".join(json.dumps(line).encode("ascii") + b"\n" for line in LINES)


def test_every_fault_has_a_name_of_its_own():
    assert len({scenario.name for scenario in SCENARIOS}) == len(SCENARIOS)


def test_the_table_shows_median_and_worst_and_aim_and_says_when_nothing_moves():
    rows = [FaultRow(KILL, [FINE, Outcome(20.0, 130.0, "", ())]), FaultRow(COLLECTING, [FINE])]
    first, second = FaultReport(rows, 0).as_table().splitlines()[4:6]
    assert "| 2 | 16.0 ms | 20.0 ms | 20 ms | 121.0 ms | 130.0 ms |" in first
    assert "| nothing moves |  |" in second


def test_every_row_has_as_many_cells_as_the_head():
    empty = Outcome(None, None, "", ("could not be tried",))
    rows = [FaultRow(KILL, [FINE]), FaultRow(KILL, [empty]), FaultRow(COLLECTING, [FINE])]
    table = [line for line in FaultReport(rows, 0).as_table().splitlines() if line.startswith("|")]
    assert {line.count("|") for line in table} == {table[0].count("|")}


def test_a_problem_in_any_trial_is_told_and_makes_the_report_not_fine():
    report = FaultReport([FaultRow(KILL, [FINE, Outcome(None, None, "", ("it moves",))])], 0)
    assert not report.is_fine
    assert report.as_table().endswith("* kill: it moves")
    assert report.as_json()["rows"][0]["problems"] == ["it moves"]
    assert FaultReport([FaultRow(KILL, [FINE])], 0).is_fine


def test_a_fault_that_there_is_not_is_refused_before_anything_is_started():
    with pytest.raises(ConfigError, match="is none of kill"):
        run_faults(1, ["kil"], ["no such program"])


def test_without_a_window_it_says_so():
    with pytest.raises(ConfigError, match="needs the window"):
        measure_faults(1, (), None)


@given(st.lists(st.integers(0, len(TEXT)), max_size=6).map(sorted))
def test_a_log_read_in_any_pieces_gives_the_same(tmp_path_factory, cuts):
    file = tmp_path_factory.mktemp("log") / "nx100.jsonl"
    log = ControllerLog(file)
    for end in [*cuts, len(TEXT)]:
        file.write_bytes(TEXT[:end])
        log.read()
    hold = log.first("HOLD", "1", 0.5)
    assert (hold.connection, hold.first_s, hold.last_s) == (2, 1.0, 2.0)
    assert log.first("HOLD", "1", 1.1) is None
    assert (log.starts_s, log.ends_s, log.end_after(2.5)) == ([1.5], [3.0], 3.0)
    assert not log.is_moving
