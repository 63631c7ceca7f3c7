"""The running cell on emulated hardware: real sockets, real threads, a real guardian process.

What the robot did is read from the emulated controller's own log. The test's loop is the window.
"""

import math
from collections.abc import Iterator
from dataclasses import replace

import pytest

from gestureapp.cell.snapshot import CellState, Snapshot
from gestureapp.robot.release import WATCH_S
from gestureapp.robot.values import RobotStatus
from gestureapp.sensing.values import Side
from gestureapp.simulation.nx100_log import What
from gestureapp.simulation.nx100_options import Fault as RobotFault
from gestureapp.simulation.nx100_options import FaultKind as RobotFaultKind
from gestureapp.simulation.nx100_values import EndReason, Hold
from gestureapp.simulation.sensor_model import FaultKind
from tests.cell.bench import HOME, Bench

pytestmark = pytest.mark.process

S = CellState


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Bench]:
    """One running cell for all tests here; each begins with ``arm`` or ``move``."""
    with Bench(tmp_path_factory.mktemp("cell")) as running:
        running.until(lambda s: s.robot.is_connected)
        yield running


def says(snapshot: Snapshot, words: str) -> bool:
    return words.lower() in snapshot.sentence.lower()


def stands_held(bench: Bench) -> bool:
    with bench.nx100.lock:
        status = RobotStatus(*bench.nx100.controller.status(bench.nx100.now_s()))
    return status.is_held_by_command and not status.is_running


def test_a_gesture_moves_the_tool_and_the_left_arm_stops_it_and_the_next_needs_no_arming(bench):
    bench.move("X+")
    bench.until(lambda _: bench.nx100.pose().x_mm > HOME.x_mm + 10)
    holds = bench.holds()
    bench.operator.left_stop()
    bench.reach(S.STOPPING)
    bench.reach(S.ARMED)
    ended = bench.motion_end()
    assert ended.name == EndReason.HOLD.value
    assert bench.holds() == holds + 1
    assert (ended.pose.y_mm, ended.pose.z_mm) == (HOME.y_mm, HOME.z_mm)
    assert HOME.x_mm + 10 < ended.pose.x_mm < 1200.0 - 20.0
    moves = bench.moves()
    bench.free()
    bench.operator.gesture("Y-")
    bench.reach(S.MOVING)
    bench.until(lambda _: bench.nx100.pose().y_mm < -1.0)
    assert bench.moves() == moves + 1
    bench.cell.stop()
    bench.reach(S.STOPPED)


def test_a_move_that_nobody_stops_ends_a_margin_short_of_the_field_and_leaves_the_cell_armed(bench):
    bench.arm()
    bench.free()
    bench.nx100.place(replace(HOME, x_mm=1100.0))
    bench.settle()
    bench.operator.gesture("X+")
    bench.reach(S.MOVING)
    bench.reach(S.ARMED)
    ended = bench.motion_end()
    assert ended.name == EndReason.DONE.value
    edge_mm = math.sqrt(1200.0**2 - HOME.z_mm**2)
    assert ended.pose.x_mm == pytest.approx(edge_mm - 20.0, abs=0.01)
    assert says(bench.now, "the end of the increment is reached")


def test_stop_latches_and_arming_again_works_ten_times(bench):
    for _ in range(10):
        bench.move("X+")
        moves, holds = bench.moves(), bench.holds()
        bench.cell.stop()
        snapshot = bench.reach(S.STOPPED)
        assert says(snapshot, "STOP was pressed. The robot stands.")
        assert stands_held(bench)
        assert bench.motion_end().name == EndReason.HOLD.value
        assert bench.holds() > holds
        bench.operator.left_stop()
        bench.until(lambda s: s.can_arm)
        assert bench.moves() == moves
        bench.arm()


def test_disarming_while_the_robot_moves_stops_it(bench):
    bench.move()
    bench.cell.disarm()
    assert says(bench.reach(S.STOPPED), "disarmed by the operator")
    assert stands_held(bench)


def test_an_armed_cell_is_disarmed_without_a_stop(bench):
    bench.arm()
    bench.cell.disarm()
    bench.until(lambda s: s.state in (S.NOT_READY, S.READY))
    bench.free()


LEFT_FAULTS = {
    FaultKind.SPIKE: "40.0 g on X",
    FaultKind.SLOW: "Hz measured, 70 to 230 Hz wanted",
}
"""Those that ``tests/faults`` does not have."""


@pytest.mark.parametrize("kind", LEFT_FAULTS, ids=lambda kind: kind.value)
def test_the_left_sensors_fault_stops_the_robot_and_is_named(bench, kind):
    bench.move()
    bench.operator.fault(Side.LEFT, kind)
    snapshot = bench.reach(S.STOPPED)
    assert says(snapshot, LEFT_FAULTS[kind])
    assert stands_held(bench)


@pytest.mark.parametrize(
    "kind", [RobotFaultKind.ERROR, RobotFaultKind.GARBAGE], ids=lambda kind: kind.value
)
def test_a_controllers_fault_while_moving_stops_the_robot_once_it_hears_again(bench, kind):
    bench.move()
    bench.nx100.fault(RobotFault(kind))
    snapshot = bench.until(lambda s: s.state is not S.MOVING, 8.0)
    assert snapshot.state in (S.STOPPING, S.STOPPED)
    bench.until(lambda s: s.state is S.STOPPED or s.is_stop_unconfirmed, 8.0)
    bench.nx100.fault(RobotFault())
    snapshot = bench.reach(S.STOPPED)
    assert not snapshot.is_stop_unconfirmed
    assert stands_held(bench)
    bench.arm()


def test_answers_that_come_in_pieces_keep_neither_the_move_nor_its_stop_from_working(bench):
    bench.arm()
    bench.nx100.fault(RobotFault(RobotFaultKind.PIECES, gap_s=0.001))
    bench.free()
    bench.operator.gesture("X+")
    bench.reach(S.MOVING)
    bench.nx100.fault(RobotFault(RobotFaultKind.PIECES))
    bench.cell.stop()
    bench.reach(S.STOPPED)
    assert stands_held(bench)


AT_REST_FAULTS = (
    RobotFaultKind.SILENT,
    RobotFaultKind.NG,
    RobotFaultKind.ERROR,
    RobotFaultKind.SLOW,
    RobotFaultKind.GARBAGE,
    RobotFaultKind.DROP,
)


def test_a_controllers_fault_at_rest_stands_against_arming_until_it_ends(bench):
    bench.arm()
    bench.cell.disarm()
    bench.rest(2 * WATCH_S)  # a link lost right after releasing a hold is a stop, as it may resume
    for kind in AT_REST_FAULTS:
        bench.reach(S.READY, 8.0)
        before = bench.last(What.OPEN).connection
        bench.nx100.fault(RobotFault(kind))
        if kind is RobotFaultKind.DROP:  # over before anybody can see it
            bench.until(lambda _, n=before: bench.last(What.OPEN).connection > n)
            continue
        snapshot = bench.reach(S.NOT_READY)
        assert {blocker.id for blocker in snapshot.blockers} <= {"robot_link", "robot_state"}
        assert all(blocker.text and blocker.remedy for blocker in snapshot.blockers)
        bench.nx100.fault(RobotFault())
    bench.reach(S.READY, 8.0)


def test_an_alarm_while_moving_is_named_and_stands_against_arming(bench):
    bench.move()
    bench.nx100.alarm(4107)
    snapshot = bench.reach(S.STOPPED)
    assert says(snapshot, "alarm")
    snapshot = bench.until(lambda s: "4107" in s.robot.text)
    assert "robot_state" in {blocker.id for blocker in snapshot.blockers}
    with bench.nx100.lock:
        bench.nx100.controller.reset(bench.nx100.now_s())
    bench.arm()


def test_a_hold_on_the_pendant_while_moving_is_told_as_such(bench):
    bench.move()
    bench.nx100.hold(Hold.PENDANT, True)
    assert says(bench.reach(S.STOPPED), "held by the pendant")
    bench.nx100.hold(Hold.PENDANT, False)
    bench.arm()
