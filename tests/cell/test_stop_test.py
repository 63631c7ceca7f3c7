"""The stop test on emulated hardware: real guardian, real bytes, the controller's own log."""

import math
import time
from collections.abc import Iterator

import pytest

from gestureapp.cell.controls import SETUP_OPEN, TRAINING_OPEN
from gestureapp.cell.snapshot import CellState, Snapshot
from gestureapp.clock import monotonic
from tests.cell.bench import Bench

S = CellState


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Bench]:
    """One running cell for all tests here; each begins with ``set_up``."""
    with Bench(tmp_path_factory.mktemp("cell")) as running:
        running.until(lambda s: s.robot.is_connected)
        yield running


def set_up(bench) -> None:
    """Ready but for the open setup, as on its page; the controller's log begins anew."""
    bench.cell.hold_arming("")
    bench.arm()
    bench.n_before, bench.began_s = bench.moves(), time.time()
    bench.cell.hold_arming(SETUP_OPEN)
    bench.until(lambda s: [b.id for b in s.blockers] == ["setup"])


def is_done(bench, snapshot: Snapshot) -> bool:
    result = snapshot.stop_test
    return result is not None and result.phase == "done" and result.wall_s > bench.began_s


def ended(bench) -> Snapshot:
    return bench.until(lambda s: is_done(bench, s))


def assert_disarmed(bench, n_moves: int) -> None:
    """Nobody is armed, and at most one increment of at most 20 mm has come, along one axis."""
    snapshot = bench.until(lambda s: s.state in (S.NOT_READY, S.READY, S.STOPPED))
    assert not snapshot.can_arm
    moves = [request.text.split(",") for request in bench.nx100.log.requests("IMOV")]
    moves = moves[bench.n_before :]
    assert len(moves) == n_moves
    for fields in moves:
        speed = float(fields[1])
        lengths = sorted(abs(float(field)) for field in fields[3:9])
        assert speed <= 20.0
        assert lengths[:-1] == [0.0] * 5
        assert 1.0 <= lengths[-1] <= 20.0


def test_stop_is_measured_from_the_press_to_standstill(bench):
    set_up(bench)
    bench.cell.begin_stop_test("X+")
    bench.reach(S.MOVING)
    bench.rest(0.5)
    pressed_s = monotonic()
    bench.cell.stop()
    result = ended(bench).stop_test
    stood = bench.motion_end()
    assert result is not None
    assert result.is_measured
    assert stood.t_s - pressed_s - 0.01 <= result.took_s < 1.0
    assert 0.0 <= result.ran_on_mm < 5.0
    assert result.wall_s > 1e9
    assert f"{result.took_s * 1000:.0f} ms after STOP was pressed" in result.text
    assert bench.now.state is S.STOPPED
    assert_disarmed(bench, 1)


def test_without_stop_it_ends_after_20_mm_disarmed(bench):
    set_up(bench)
    before = bench.nx100.pose()
    bench.cell.begin_stop_test("Z+")
    result = ended(bench).stop_test
    assert result is not None
    assert not result.is_measured
    assert "STOP was not pressed" in result.text
    assert bench.nx100.pose().z_mm - before.z_mm == pytest.approx(20.0, abs=0.1)
    assert_disarmed(bench, 1)


def test_letting_the_button_go_stops_it_unmeasured(bench):
    set_up(bench)
    bench.cell.begin_stop_test("Y-")
    bench.reach(S.MOVING)
    bench.cell.release_stop_test()
    snapshot = ended(bench)
    assert snapshot.state is S.STOPPED
    assert snapshot.stop_test is not None
    assert math.isnan(snapshot.stop_test.took_s)
    assert "let go" in snapshot.stop_test.text
    assert_disarmed(bench, 1)


def test_the_left_arm_that_leaves_the_stop_posture_stops_it_latched(bench):
    set_up(bench)
    bench.cell.begin_stop_test("X+")
    bench.reach(S.MOVING)
    bench.operator.left_start()
    snapshot = ended(bench)
    assert snapshot.state is S.STOPPED
    assert snapshot.stop_test is not None
    assert not snapshot.stop_test.is_measured
    assert_disarmed(bench, 1)


def test_a_silent_left_sensor_stops_it(bench):
    set_up(bench)
    bench.cell.begin_stop_test("X+")
    bench.reach(S.MOVING)
    bench.operator.silence_left()
    assert ended(bench).state is S.STOPPED
    assert_disarmed(bench, 1)


def test_a_button_let_go_before_the_move_moves_nothing(bench):
    set_up(bench)
    bench.cell.begin_stop_test("X+")
    bench.reach(S.ARMED)
    bench.cell.release_stop_test()
    ended(bench)
    bench.rest(1.0)
    assert_disarmed(bench, 0)


def test_the_training_stands_against_it(bench):
    set_up(bench)
    bench.cell.hold_arming(TRAINING_OPEN)
    bench.until(lambda s: [b.id for b in s.blockers] == ["lock"])
    bench.cell.begin_stop_test("X+")
    before = bench.now.stop_test
    bench.rest(1.0)
    assert bench.now.stop_test is before
    assert_disarmed(bench, 0)


def test_a_stop_that_comes_with_the_end_of_the_move_measures_nothing(bench):
    set_up(bench)
    bench.cell.begin_stop_test("X+")
    bench.until(lambda s: s.state is S.MOVING)
    bench.until(lambda _: bench.nx100.is_running())
    bench.until(lambda _: not bench.nx100.is_running())
    bench.cell.stop()

    result = ended(bench).stop_test

    assert not result.is_measured
    assert_disarmed(bench, n_moves=1)


def test_without_an_open_setup_there_is_no_stop_test(bench):
    bench.cell.hold_arming("")
    bench.arm()
    bench.cell.disarm()
    bench.n_before, bench.began_s = bench.moves(), time.time()
    bench.until(lambda s: s.can_arm)
    bench.cell.begin_stop_test("X+")
    bench.rest(1.5)
    assert bench.moves() == bench.n_before


def test_leaving_the_setup_ends_the_test(bench):
    set_up(bench)
    bench.cell.begin_stop_test("X+")
    bench.until(lambda s: s.state is S.MOVING)
    bench.cell.hold_arming("")

    snapshot = ended(bench)
    assert "setup is not open" in snapshot.stop_test.text
    assert snapshot.state is S.STOPPED
    assert bench.moves() == bench.n_before + 1
