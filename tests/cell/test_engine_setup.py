"""Setting up a running cell: other settings, sensors, postures and controllers, on real bytes."""

import os
from collections.abc import Iterator
from dataclasses import replace

import pytest

from gestureapp.cell.snapshot import CellState
from gestureapp.config import SensorSettings
from gestureapp.errors import ConfigError
from gestureapp.sensing.calibration import NOMINAL, Calibration
from gestureapp.sensing.posture import BUILT_IN, LeftPostures
from gestureapp.sensing.values import ArmPosture, LinkState, Side
from gestureapp.simulation.nx100 import Nx100Emulator
from tests.cell.bench import Bench

S = CellState


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Bench]:
    """One running cell for all tests here; each leaves it as it found it."""
    with Bench(tmp_path_factory.mktemp("cell")) as running:
        running.until(lambda s: s.robot.is_connected)
        yield running


@pytest.fixture
def own(tmp_path) -> Iterator[Bench]:
    """A cell of the test's own: another guardian means other threads."""
    with Bench(tmp_path) as running:
        running.until(lambda s: s.robot.is_connected)
        yield running


def use_robot(bench, **changes: object) -> None:
    """Use other settings of the robot, and wait until another guardian is connected."""
    settings = bench.cell.settings
    pid = bench.guardian_pid
    bench.cell.use_settings(replace(settings, robot=replace(settings.robot, **changes)))
    bench.until(lambda s: bench.guardian_pid != pid and s.robot.is_connected)
    with pytest.raises(ProcessLookupError):
        os.kill(pid, 0)


def blockers(snapshot) -> set[str]:
    return {blocker.id for blocker in snapshot.blockers}


def test_other_settings_are_used_by_another_guardian(own):
    use_robot(own, speed_mm_s=37.5)
    assert own.cell.settings.robot.speed_mm_s == 37.5
    snapshot = own.move("X+")
    assert snapshot.robot.speed == "37.5 mm/s"
    own.cell.disarm()
    own.reach(S.STOPPED)


def test_other_settings_wait_until_nothing_may_move(own):
    own.move("X+")
    pid, settings = own.guardian_pid, own.cell.settings
    own.cell.use_settings(replace(settings, robot=replace(settings.robot, speed_mm_s=20.0)))
    own.rest(0.3)
    assert own.now.state is S.MOVING
    assert (own.guardian_pid, own.cell.settings) == (pid, settings)
    own.cell.stop()
    own.until(lambda s: own.guardian_pid != pid and s.robot.is_connected)
    assert own.cell.settings.robot.speed_mm_s == 20.0


def test_settings_that_contradict_each_other_change_nothing(bench):
    settings, pid = bench.cell.settings, bench.guardian_pid
    for wrong in ({"int_radius_mm": 1300.0}, {"speed_mm_s": 251.0}, {"supervision_input": 7}):
        with pytest.raises(ConfigError):
            bench.cell.use_settings(replace(settings, robot=replace(settings.robot, **wrong)))
    bench.rest(0.2)
    assert (bench.guardian_pid, bench.cell.settings) == (pid, settings)


def test_another_controller_is_only_read_until_somebody_arms(own):
    with Nx100Emulator() as other:
        use_robot(own, port=other.port)
        snapshot = own.until(lambda s: s.robot.position is not None and s.robot.status is not None)
        assert "NX Information Server" in snapshot.robot.banner
        own.rest(0.7)
        asked = {request.name for request in other.log.requests()}
        assert asked <= {"CONNECT", "RSTATS", "RPOSC", "RALARM"}


def test_without_an_answer_nothing_can_be_armed(own):
    settings = own.cell.settings
    free_port = 9  # nobody listens there
    own.cell.use_settings(replace(settings, robot=replace(settings.robot, port=free_port)))
    snapshot = own.until(lambda s: "127.0.0.1:9" in s.robot.text or "refused" in s.robot.text)
    assert not snapshot.robot.is_connected
    assert "robot_link" in blockers(snapshot)
    assert not snapshot.can_arm
    use_robot(own, port=settings.robot.port)


def test_a_sensor_is_read_from_elsewhere_once_nothing_moves(bench):
    own = bench.cell.settings.right
    bench.arm()
    bench.cell.use_sensor(Side.RIGHT, SensorSettings("/dev/nothing", "csv", "spare"))
    bench.rest(0.3)
    assert bench.now.state is S.ARMED
    assert bench.cell.settings.right == own
    bench.cell.disarm()
    bench.until(lambda s: s.right.link is LinkState.NOT_CONNECTED)
    assert "right_sensor" in blockers(bench.now)
    assert bench.cell.settings.right.name == "spare"
    bench.cell.use_sensor(Side.RIGHT, own)
    bench.until(lambda s: s.right.is_ok)


def test_an_unknown_protocol_is_refused_to_the_caller(bench):
    with pytest.raises(ConfigError, match="no such protocol"):
        bench.cell.use_sensor(Side.LEFT, SensorSettings("loop://", "morse"))


def test_a_calibration_holds_for_the_samples_from_now_on(bench):
    bench.until(lambda s: s.left.is_ok)
    half = ((0.5, 0.0, 0.0), (0.0, 0.5, 0.0), (0.0, 0.0, 0.5))
    bench.cell.use_calibration(Side.LEFT, Calibration(matrix=half))
    bench.until(lambda s: abs(bench.cell.left.tail(0.02)[-1][3]) < 0.7)
    bench.cell.use_calibration(Side.LEFT, NOMINAL)
    bench.until(lambda s: abs(bench.cell.left.tail(0.02)[-1][3]) > 0.7)


def test_a_sensor_found_unfit_disarms_and_blocks(bench):
    bench.arm()
    bench.cell.judge_sensor(Side.RIGHT, "swapped with the left one", "Setup, step Sensors")
    snapshot = bench.until(lambda s: s.state is S.NOT_READY and "right_unfit" in blockers(s))
    (blocker,) = (b for b in snapshot.blockers if b.id == "right_unfit")
    assert blocker.text == "right sensor: swapped with the left one"
    assert blocker.remedy == "Setup, step Sensors"
    bench.cell.judge_sensor(Side.RIGHT, "")
    bench.arm()
    bench.cell.disarm()


def test_a_persons_own_postures_are_followed(bench):
    bench.operator.left_stop()
    bench.until(lambda s: s.posture is ArmPosture.STOP)
    upside_down = LeftPostures(stop=(0.0, 0.0, -1.0), start=(0.0, 1.0, 0.0))
    bench.cell.use_postures(upside_down)
    bench.until(lambda s: s.posture is ArmPosture.NEITHER and "left_stop" in blockers(s))
    assert bench.cell.postures == upside_down
    bench.cell.use_postures(BUILT_IN)
    bench.until(lambda s: s.posture is ArmPosture.STOP)


def test_postures_that_cannot_be_told_apart_block(bench):
    close = LeftPostures(stop=(0.0, 0.0, 1.0), start=(-0.6, 0.0, 0.8))
    bench.cell.use_postures(close)
    snapshot = bench.until(lambda s: "postures" in blockers(s))
    (blocker,) = (b for b in snapshot.blockers if b.id == "postures")
    assert "only 37 degrees apart; more than 65 are needed" in blocker.text
    bench.cell.use_postures(BUILT_IN, "recorded by somebody else", "record them again")
    bench.until(lambda s: "recorded by somebody else" in {b.text for b in s.blockers})
    bench.cell.use_postures(BUILT_IN)
    bench.until(lambda s: "postures" not in blockers(s))
