"""The running cell on a controller with a ladder that also goes on with interrupted moves."""

from collections.abc import Iterator
from dataclasses import replace

import pytest

from gestureapp.cell.snapshot import CellState, Snapshot
from gestureapp.simulation.nx100_log import What
from gestureapp.simulation.nx100_values import ControllerOptions, Hold
from tests.cell.bench import Bench

pytestmark = pytest.mark.process

LADDER_S = 2.0
"""Longer than a busy machine stands still."""


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Bench]:
    controller = ControllerOptions(ladder_s=LADDER_S, resumes_after_hold=True)
    folder = tmp_path_factory.mktemp("cell")
    with Bench(folder, controller=controller, supervision_input=22010) as running:
        running.until(lambda s: s.robot.is_connected)
        yield running


def blockers(snapshot: Snapshot) -> dict[str, str]:
    return {blocker.id: blocker.remedy for blocker in snapshot.blockers}


def test_the_window_leads_from_a_move_that_runs_on_to_the_next_one(bench):
    bench.move("X+")
    bench.cell.stop()
    bench.reach(CellState.STOPPED)
    bench.operator.left_stop()
    bench.operator.right_rest()
    bench.until(lambda s: s.can_arm)
    bench.cell.arm()
    stopped = bench.until(lambda s: "move_kept" in blockers(s))
    assert bench.motion_end().name == "hold"
    assert len(bench.nx100.log.events(What.MOTION_START)) == 2
    assert not stopped.can_arm
    assert "press Servo off" in blockers(stopped)["move_kept"]
    bench.cell.servo_off()
    bench.until(lambda s: "press Servo on" in blockers(s).get("robot_state", ""))
    bench.cell.servo_on()
    bench.until(lambda s: s.can_arm)
    bench.move("X-")
    assert len(bench.nx100.log.events(What.MOTION_START)) == 3
    bench.cell.stop()
    bench.reach(CellState.STOPPED)


def test_supervision_is_shown_and_its_input_changes_while_the_cell_runs(bench):
    assert bench.now.robot.supervision == "on, #22010, 5 Hz"
    bench.until(lambda s: s.robot.is_supervision_working)
    n = len(bench.nx100.log.requests("IOWRITE"))
    bench.until(lambda _: len(bench.nx100.log.requests("IOWRITE")) >= n + 4)
    assert {request.text for request in bench.nx100.log.requests("IOWRITE")} == {
        "22010,8,0",
        "22010,8,1",
    }
    assert Hold.EXTERNAL not in bench.nx100.controller.holds


def test_another_guardian_knows_of_a_move_that_would_run_on(tmp_path):
    with Bench(tmp_path, controller=ControllerOptions(resumes_after_hold=True)) as cell:
        cell.move("X+")
        cell.cell.stop()
        cell.reach(CellState.STOPPED)
        cell.operator.left_stop()
        cell.operator.right_rest()
        cell.until(lambda s: s.can_arm)
        cell.cell.arm()
        cell.until(lambda s: "move_kept" in blockers(s))
        n_moves = len(cell.nx100.log.events(What.MOTION_START))

        settings = cell.cell.settings
        slower = replace(settings, robot=replace(settings.robot, speed_mm_s=90.0))
        cell.cell.use_settings(slower)

        cell.until(lambda s: not s.robot.is_connected)
        cell.until(lambda s: s.robot.is_connected and "move_kept" in blockers(s))
        cell.rest(0.5)
        assert not cell.now.can_arm
        assert len(cell.nx100.log.events(What.MOTION_START)) == n_moves
