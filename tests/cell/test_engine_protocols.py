"""The running cell with sensors that speak binary and WitMotion's frames, read from the log."""

from pathlib import Path

import pytest

from gestureapp.cell.snapshot import CellState
from gestureapp.simulation.nx100_values import EndReason
from tests.cell.bench import HOME, Bench

pytestmark = pytest.mark.process


@pytest.mark.parametrize("protocols", [("binary", "witmotion"), ("witmotion", "binary")])
def test_a_gesture_moves_the_tool_and_the_left_arm_stops_it_in_any_protocol(
    tmp_path: Path, protocols: tuple[str, str]
):
    with Bench(tmp_path, protocols=protocols) as bench:
        bench.move("X+")
        bench.until(lambda _: bench.nx100.pose().x_mm > HOME.x_mm + 10)
        bench.operator.left_stop()
        bench.reach(CellState.ARMED)
        assert bench.motion_end().name == EndReason.HOLD.value
        health = (bench.now.left, bench.now.right)
    said = {one.identity: one.battery_percent for one in health}
    side = "left" if protocols[0] == "binary" else "right"
    assert said == {f"emulated {side}": 80.0, "": None}
    assert [one.n_bad for one in health] == [0, 0]
