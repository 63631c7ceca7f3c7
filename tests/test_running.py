"""A cell with everything around it: its folders, its recorder, its emulators, its end."""

import os
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from gestureapp import __version__
from gestureapp.cell.snapshot import CellState
from gestureapp.config import RobotSettings, Settings
from gestureapp.errors import ConfigError, GestureAppError, RobotInUse
from gestureapp.recording.session_reader import read_session
from gestureapp.robot.lock import AddressLock
from gestureapp.running import data_folder, describe, running_cell, settings_files
from gestureapp.simulation.demo import DemoOptions
from tests.cell.conftest import wait_until


def test_the_chosen_data_folder_is_made_with_its_parents(tmp_path: Path):
    assert data_folder(tmp_path / "a" / "b") == tmp_path / "a" / "b"
    assert (tmp_path / "a" / "b").is_dir()


def test_a_data_folder_below_a_file_is_refused_with_the_remedy(tmp_path: Path):
    (tmp_path / "file").write_text("")
    with pytest.raises(ConfigError, match="--data-dir"):
        data_folder(tmp_path / "file" / "data")


def test_without_a_choice_the_data_folder_is_the_users(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path))
    monkeypatch.setenv("LOCALAPPDATA", str(tmp_path))
    monkeypatch.setenv("HOME", str(tmp_path))
    assert tmp_path in data_folder().parents


def test_the_sites_settings_come_before_the_users():
    assert [path.name for path in settings_files()] == ["site.toml", "settings.toml"]


def test_a_sessions_metadata_has_every_setting_as_it_is_used():
    settings = replace(Settings(), robot=RobotSettings(host="10.0.0.2"), is_simulation=True)
    facts = describe(settings)
    assert facts["app_version"] == __version__
    assert facts["mode"] == "simulation"
    assert facts["robot.host"] == "10.0.0.2"
    assert facts["site.trip_level_s"] == "0.1"
    assert all(isinstance(value, str) for value in facts.values())
    assert describe(Settings())["mode"] == "live"


@pytest.mark.skipif(sys.platform != "linux", reason="abstract socket names")
def test_a_second_application_is_not_started_on_a_robot_that_another_one_has(tmp_path: Path):
    robot = RobotSettings(host="192.0.2.10", port=50000 + os.getpid() % 10000)
    first = AddressLock(robot.host, robot.port, os.getpid())
    assert first.take() is None
    words = rf"in use by another gestureapp \(process {os.getpid()}\): close that one"
    with (
        pytest.raises(RobotInUse, match=words),
        running_cell(replace(Settings(), robot=robot), tmp_path),
    ):
        pass
    first.give_back()
    assert list(tmp_path.iterdir()) == []


@pytest.mark.process
def test_a_demo_is_ready_by_itself_and_leaves_a_readable_session(tmp_path: Path):
    with running_cell(Settings(), tmp_path, DemoOptions()) as running:
        cell = running.cell

        def is_ready() -> bool:
            cell.gui_tick()
            return cell.snapshot().state is CellState.READY

        assert wait_until(is_ready, 15.0), cell.snapshot().blockers
        assert cell.snapshot().is_simulation
        assert running.operator is not None
        assert running.demo is not None
        pids = [running.demo.left.pid, running.demo.right.pid, running.demo.nx100.pid]
        link = cell._link
        assert link is not None
        pids.append(link.pid)
    for pid in pids:
        with pytest.raises(ProcessLookupError):
            os.kill(pid, 0)
    (path,) = (tmp_path / "sessions").iterdir()
    session = read_session(path)
    assert session.incomplete is None
    assert session.metadata["mode"] == "simulation"


@pytest.mark.process
def test_settings_that_cannot_be_used_leave_nothing_running(tmp_path: Path):
    settings = replace(Settings(), robot=RobotSettings(speed_mm_s=1e4))
    with pytest.raises(GestureAppError), running_cell(settings, tmp_path, DemoOptions()):
        raise AssertionError("it must not start")


@pytest.mark.process
def test_an_error_inside_still_ends_everything(tmp_path: Path):
    pids: list[int] = []

    def fail_inside() -> None:
        with running_cell(Settings(), tmp_path) as running:
            assert wait_until(lambda: running.cell._link is not None)
            link = running.cell._link
            assert link is not None
            pids.append(link.pid)
            raise ValueError("the window failed")

    with pytest.raises(ValueError, match="window"):
        fail_inside()
    with pytest.raises(ProcessLookupError):
        os.kill(pids[0], 0)
