"""How a cell loses its guardian, and how it ends: each test with a running cell of its own."""

import os
import signal
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from gestureapp.cell.engine import Cell
from gestureapp.cell.records import Topic
from gestureapp.cell.snapshot import Blocker, CellState
from gestureapp.config import PersonSettings, RobotSettings, Settings, SiteSettings
from gestureapp.errors import ConfigError
from gestureapp.recording.session_reader import SessionFile, read_session
from gestureapp.robot.values import RobotStatus
from gestureapp.simulation.demo import MODEL
from tests.cell.bench import Bench

S = CellState
Until = Callable[..., bool]


def has_ended(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return True
    return False


def stands_held(bench: Bench) -> bool:
    with bench.nx100.lock:
        status = RobotStatus(*bench.nx100.controller.status(bench.nx100.now_s()))
    return status.is_held_by_command and not status.is_running


@pytest.mark.process
@pytest.mark.logs_errors
def test_a_guardian_that_hangs_does_not_keep_stop_from_holding(tmp_path: Path):
    with Bench(tmp_path) as bench:
        bench.move()
        os.kill(bench.guardian_pid, signal.SIGSTOP)
        bench.cell.stop()
        bench.reach(S.STOPPING)
        bench.reach(S.STOPPED)
        assert stands_held(bench)


@pytest.mark.process
def test_shutting_down_while_moving_holds_the_robot_and_leaves_nothing(tmp_path: Path):
    with Bench(tmp_path) as bench:
        bench.move()
        pid = bench.guardian_pid
        bench.cell.shutdown()
        assert has_ended(pid)
        assert stands_held(bench)
        bench.cell.shutdown()
        bench.recorder.stop()
        path = bench.recorder.path
        assert path is not None
        session = read_session(path)
        assert states(session)[-1] == "STOPPED"
        assert "disarmed by the operator" in texts(session)


@pytest.mark.process
@pytest.mark.skipif(sys.platform != "linux", reason="no lock that tells its holder")
def test_a_second_cell_is_told_who_has_the_robot_and_gets_it_next(tmp_path: Path):
    with Bench(tmp_path) as bench:
        bench.until(lambda s: s.robot.is_connected)
        other = cell_of(replace(Settings(), robot=bench.settings.robot))
        other.start()
        try:
            bench.until(lambda _: blocker_of(other, "robot_link").remedy == "close that one")
            where = f"127.0.0.1:{bench.nx100.port}"
            assert blocker_of(other, "robot_link").text == (
                f"the robot at {where} is in use by another gestureapp (process {os.getpid()})"
            )
            bench.cell.shutdown()
            bench.until(lambda _: other.snapshot().robot.is_connected)
        finally:
            other.shutdown()


def blocker_of(cell: Cell, name: str) -> Blocker:
    found = {blocker.id: blocker for blocker in cell.snapshot().blockers}
    return found.get(name, Blocker(name, "", ""))


def states(session: SessionFile) -> list[str]:
    return [str(r.record.fields["state"]) for r in session.records({Topic.STATE})]


def texts(session: SessionFile) -> list[str]:
    return [str(r.record.fields["text"]) for r in session.records({Topic.EVENT})]


@pytest.mark.process
def test_the_session_file_has_all_of_it(tmp_path: Path):
    with Bench(tmp_path) as bench:
        bench.move("X+")
        bench.operator.left_stop()
        bench.reach(S.ARMED)
        bench.move("Z+")
        bench.cell.stop()
        bench.reach(S.STOPPED)
        moves = bench.moves()
        path = bench.recorder.path
    assert path is not None
    session = read_session(path)
    assert session.incomplete is None
    assert session.damage() == ()
    by_topic: dict[Topic, list[dict[str, object]]] = {topic: [] for topic in Topic}
    for item in session.records():
        by_topic[item.record.topic].append(dict(item.record.fields))
    assert [f["label"] for f in by_topic[Topic.RECOGNITION]] == ["X+", "Z+"]
    commands = by_topic[Topic.COMMAND]
    kinds = [str(f["type"]) for f in commands]
    assert kinds.count("CommandSent") == kinds.count("CommandAccepted") == moves == 2
    reasons = [f["reason"] for f in commands if f["type"] == "StopConfirmed"]
    assert reasons == ["left arm", "STOP pressed"]
    told = [str(f["state"]) for f in by_topic[Topic.STATE]]
    way = ["ARMED", "ACTIVATED", "MOVING", "STOPPING"]
    assert [s for s, last in zip(told, ["", *told], strict=False) if s != last][-9:] == [
        *way,
        *way,
        "STOPPED",
    ]
    for topic in (Topic.LEFT_ACCEL, Topic.RIGHT_ACCEL):
        numbers = [f["seq"] for f in by_topic[topic]]
        assert numbers == list(range(len(numbers)))
        assert len(numbers) > 200
    assert any(f.get("x_mm", 0) for f in by_topic[Topic.ROBOT])
    assert any(f.get("data_1") for f in by_topic[Topic.ROBOT])
    assert "STOP was pressed" in [f["text"] for f in by_topic[Topic.EVENT]]


def cell_of(settings: Settings) -> Cell:
    return Cell(settings, lambda record: None, lambda: "not recorded", None, time.time)


@pytest.mark.process
def test_a_cell_without_any_hardware_says_what_is_missing_and_ends_at_once(until: Until):
    cell = cell_of(Settings())
    cell.start()
    try:
        assert until(lambda: {b.id for b in cell.snapshot().blockers} >= {"robot_link"})
        snapshot = cell.snapshot()
        assert [b.id for b in snapshot.blockers] == [
            *("left_unfit", "left_sensor", "right_unfit", "right_sensor", "model", "robot_link")
        ]
        assert all(b.remedy for b in snapshot.blockers)
        assert snapshot.state is S.NOT_READY
        assert snapshot.robot.text == "no robot address is set"
        assert snapshot.recording == "not recorded"
        cell.arm()
        assert until(lambda: any("not armed" in e.text for e in cell.snapshot().events))
    finally:
        cell.shutdown()


def test_a_cell_that_was_never_started_can_be_shut_down():
    cell = cell_of(Settings())
    cell.stop()
    cell.shutdown()
    cell.shutdown()


@pytest.mark.parametrize(
    "settings",
    [
        replace(Settings(), robot=RobotSettings(speed_mm_s=5000.0)),
        replace(Settings(), robot=RobotSettings(ext_radius_mm=100.0, int_radius_mm=200.0)),
        replace(Settings(), site=SiteSettings(trip_level_s=3.0)),
        replace(Settings(), site=SiteSettings(posture_enter_deg=60.0)),
        Settings(robot=RobotSettings(host="192.0.2.10"), is_simulation=True),
    ],
    ids=["speed", "spheres", "trip level", "postures", "a demo at a robot"],
)
def test_settings_that_nobody_may_have_are_refused_in_one_line(settings: Settings):
    with pytest.raises(ConfigError) as caught:
        cell_of(settings)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (None, "No such file"),
        (b"\x00\x01", ""),
        (b'{"format": 1}', ""),
        (MODEL.read_bytes()[:500], ""),
    ],
    ids=["missing", "bytes", "another", "cut off"],
)
def test_a_model_that_cannot_be_used_stands_against_arming(
    tmp_path: Path, content: bytes | None, words: str
):
    path = tmp_path / "model.json"
    if content is not None:
        path.write_bytes(content)
    cell = cell_of(replace(Settings(), person=PersonSettings("Test", path)))
    problem = cell._control._ear.model.problem
    assert str(path) in problem
    assert words in problem
    cell.shutdown()
