"""A cell with everything around it: its folders, its recorder, its emulators, its end."""

import contextlib
import os
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from gestureapp import __version__
from gestureapp.cell.snapshot import CellState
from gestureapp.config import PersonSettings, RobotSettings, Settings
from gestureapp.errors import ConfigError, GestureAppError, RobotInUse
from gestureapp.guided.values import TrainingPhase
from gestureapp.recording.session_reader import read_session
from gestureapp.recording.take_store import NewTake, TakeStore
from gestureapp.recording.take_values import Judgement, Verdict
from gestureapp.robot.lock import AddressLock
from gestureapp.running import (
    RunningCell,
    data_folder,
    describe,
    running_cell,
    settings_files,
)
from gestureapp.simulation.demo import DemoOptions
from gestureapp.simulation.takes import make_takes
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
        running.setup.look(True)
        assert wait_until(lambda: not is_ready(), 5.0)
        assert [blocker.text for blocker in cell.snapshot().blockers] == ["setup is open"]
        cards = running.setup.snapshot()
        assert (cards.left.sensor_id, cards.right.sensor_id) == ("demo left", "demo right")
        running.setup.look(False)
        assert wait_until(is_ready, 5.0)
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


def keep_simulated_takes(data: Path, person: str, session: int = 1) -> None:
    """Eight takes of each gesture by the practised person of the demo, in the person's database."""
    takes = make_takes(1, 8, seed=7, session=session, practised=True)
    times_s = np.arange(-50, 100) * 0.01 + 0.002
    with contextlib.closing(TakeStore(data, person)) as store:
        for number, label in enumerate(takes.labels):
            good = Judgement(Verdict.GOOD, "")
            accel_g = takes.accel_g(number)
            store.add(NewTake(label, f"day {session}", 1e9 + number, good, times_s, accel_g))


def model_blockers(running: RunningCell) -> list[str]:
    return [b.text for b in running.cell.snapshot().blockers if b.id == "model"]


@pytest.mark.process
def test_a_model_trained_here_is_used_at_once_and_after_a_restart_until_the_takes_change(
    tmp_path: Path,
):
    ana = replace(Settings(), person=PersonSettings("Ana", None))
    keep_simulated_takes(tmp_path, "Ana")
    with running_cell(ana, tmp_path) as running:
        assert wait_until(lambda: model_blockers(running) == ["no model is set for this person"])
        running.guided.open("Ana")
        running.trainer.start()
        is_over = (TrainingPhase.DONE, TrainingPhase.FAILED)
        assert wait_until(lambda: running.trainer.view().phase in is_over, 60.0)
        assert running.trainer.view().phase is TrainingPhase.DONE, running.trainer.view().text
        assert wait_until(lambda: not model_blockers(running))
        words = "Ana, 12 gestures, not tried live"
        assert wait_until(lambda: running.cell.snapshot().model.startswith(words))
        running.guided.open("Bea")  # another's model is not for these arms
        assert wait_until(lambda: model_blockers(running) == ["no model is set for Bea"])
        assert running.cell.snapshot().person == "Bea"
        running.guided.open("Ana")
        assert wait_until(lambda: running.cell.snapshot().model.startswith(words))
        assert model_blockers(running) == []

    with running_cell(ana, tmp_path) as running:
        assert wait_until(lambda: running.cell.snapshot().model.startswith(words))
        running.guided.open("Ana")
        assert wait_until(lambda: running.trainer.view().result is not None)
        running.guided.exclude(running.guided.takes()[0].id)
        out_of_date = ["the takes have changed since the model was trained"]
        assert wait_until(lambda: model_blockers(running) == out_of_date)
        running.guided.undo()
        assert wait_until(lambda: not model_blockers(running))
        running.guided.exclude(running.guided.takes()[0].id)
        assert wait_until(lambda: model_blockers(running) == out_of_date)

    with running_cell(ana, tmp_path) as running:
        assert wait_until(lambda: model_blockers(running) == out_of_date)

    with running_cell(Settings(), tmp_path) as running:  # who was chosen last is taken then
        assert wait_until(lambda: running.cell.snapshot().person == "Ana")
        assert model_blockers(running) == out_of_date
