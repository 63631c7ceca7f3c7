"""Sensors on real ports in front of setting up: seen, lost, found again, swapped, tested."""

import math
from dataclasses import replace
from pathlib import Path

import pytest
import serial

from gestureapp.cell.snapshot import CellState
from gestureapp.config import RobotSettings, SensorSettings, Settings
from gestureapp.recording.sensor_records import LinkRecord, SensorRecord, load_record, save_record
from gestureapp.sensing.calibration import NOMINAL
from gestureapp.sensing.values import LinkState, Side
from gestureapp.setup.desk import NOT_ARMED
from gestureapp.setup.values import Check, Remedy
from gestureapp.simulation.sensor_wire import Accel, encode_binary, encode_identity
from tests.setup.bench import SetupBench

L, R = Side.LEFT, Side.RIGHT


def calibrate_both(bench: SetupBench) -> None:
    """Both were calibrated just now, under the ids that their cards show."""
    for side in Side:
        arm = bench.desk.sensors.arms[side]
        arm.keep(SensorRecord(arm.known.id, calibrated_wall_s=bench.wall_s))
    bench.run(0.1)


def binary(name: str):
    """A sensor that says who it is once a second."""

    def encode(number: int | None, accel_g: Accel) -> bytes:
        said = encode_identity(name) if number is not None and number % 100 == 0 else b""
        return said + encode_binary(number, accel_g)

    return encode


def wear(bench: SetupBench, left: str, right: str) -> None:
    """Both sensors speak binary under these names from now on."""
    with bench.reopening(L, R):
        for side, name in ((L, left), (R, right)):
            bench.sensors[side].encode = binary(name)
            settings = replace(getattr(bench.cell.settings, side.value), protocol="binary")
            bench.cell.use_sensor(side, settings)
    bench.run(0.1)
    bench.connect()
    bench.run(3.0)


def test_a_card_says_where_a_sensor_is_and_how_it_sends(bench: SetupBench):
    bench.run(2.5)
    card = bench.card()
    assert card.health.link is LinkState.RECEIVING
    assert card.health.rate_hz == pytest.approx(100, abs=2)
    assert (card.port, card.protocol) == (bench.sensors[L].port.url, "csv")
    assert card.sensor_id == bench.sensors[L].port.url
    assert card.advice == ()
    assert (card.calibration, card.problem, card.act) == (
        "not calibrated",
        "not calibrated",
        Remedy.CALIBRATE,
    )


def test_a_sensor_that_nobody_calibrated_blocks_and_one_that_is_does_not(bench: SetupBench):
    assert bench.judged() == "not calibrated"
    calibrate_both(bench)
    assert bench.judged() == ""
    assert bench.card().calibration.startswith("calibrated today")


def test_unplugged_and_plugged_in_again(bench: SetupBench):
    port = bench.sensors[L].port
    port.unplug()
    bench.wait(lambda: bench.card().health.link is LinkState.NOT_CONNECTED)
    assert bench.card().advice == (
        f"{port.url} is not there: plug the receiver in, or choose another port.",
    )
    port.plug()
    bench.connect()
    bench.run(2.5)
    assert bench.card().health.link is LinkState.RECEIVING
    assert bench.card().advice == ()


def test_a_port_that_another_program_has_says_so(bench: SetupBench):
    port = bench.sensors[L].port
    port.unplug()
    bench.wait(lambda: bench.card().health.link is LinkState.NOT_CONNECTED)
    port.plug()
    other = serial.Serial(port.url, exclusive=True)
    try:
        said = ("In use by another program: close that program.",)
        bench.wait(lambda: bench.card().advice == said)
        assert "is in use by another program" in bench.card().health.reason
    finally:
        other.close()
    bench.wait(lambda: bench.card().health.link is not LinkState.NOT_CONNECTED)


def test_a_wrong_protocol_shows_what_came(bench: SetupBench):
    with bench.reopening(L):
        bench.cell.use_sensor(L, replace(bench.cell.settings.left, protocol="adxl330"))
    bench.run_until(lambda: bench.card().health.link is LinkState.WRONG_DATA)
    assert bench.card().bad_bytes.endswith(",0.0000,1.0000")
    bench.run(2.5)
    assert "another protocol" in bench.card().advice[0]


def test_sensors_in_use_are_listed_when_nothing_else_is_found(bench: SetupBench):
    bench.desk.find_sensors()
    bench.run(0.1)
    finding = bench.picture.finding
    assert finding.sentence.startswith("2 sensors are in use already. No other port is free")
    assert [found.port.url for found in finding.found] == [
        bench.sensors[side].port.url for side in Side
    ]
    assert all("Hz; in use" in found.text for found in finding.found)


def test_damaged_files_are_one_line_each(tmp_path: Path):
    data = tmp_path / "data"
    data.mkdir()
    for name in ("sides.json", "stop-test.json"):
        (data / name).write_text("{")
    at = RobotSettings(host="127.0.0.1", port=4711)
    made = SetupBench(tmp_path, replace(Settings(), robot=at))
    try:
        made.desk.step()
        assert [line.split(":")[0] for line in made.cell.told] == [
            "sides.json is damaged",
            "stop-test.json is damaged",
        ]
        assert "sides.json is damaged" in made.picture.trouble
    finally:
        made.close()


def test_the_other_arms_port_is_called_so(bench: SetupBench):
    right = bench.sensors[Side.RIGHT].port.url
    bench.cell.use_sensor(Side.LEFT, SensorSettings(right))
    bench.wait(lambda: any("the right arm's port" in text for text in bench.card().advice))
    assert "press Swap" in bench.card().advice[0]


def test_silence_is_told_from_a_missing_port(bench: SetupBench):
    bench.sensors[L].is_on = False
    bench.run(2.5)
    assert bench.card().health.link is LinkState.NO_DATA
    assert bench.card().advice[0].startswith("Out of range or off")


def test_choosing_a_port_is_remembered_and_used_at_once(bench: SetupBench):
    left, new = bench.sensors[L].port.url, "socket://127.0.0.1:9"
    bench.desk.choose_port(R, new, "csv")
    assert bench.remembered == [{"right.port": new, "right.protocol": "csv", "right.name": ""}]
    assert (bench.cell.settings.left.port, bench.cell.settings.right.port) == (left, new)


def test_the_other_arm_s_port_is_refused_until_that_arm_has_another(bench: SetupBench):
    left, right = (bench.sensors[side].port.url for side in (L, R))
    bench.desk.choose_port(R, left, "csv")
    bench.run(0.1)
    assert "the left arm reads it: press Swap" in bench.picture.trouble
    assert bench.remembered == []
    assert bench.cell.settings.right.port == right
    bench.desk.choose_port(L, "socket://127.0.0.1:9", "csv")
    bench.desk.choose_port(R, left, "csv")
    bench.run(0.1)
    assert bench.picture.trouble == ""
    assert bench.cell.settings.right.port == left


def test_one_port_for_both_arms_is_never_armed_with_wherever_it_comes_from(bench: SetupBench):
    calibrate_both(bench)
    right = bench.cell.settings.right
    bench.cell.use_sensor(R, bench.cell.settings.left)  # as files read at the start may have it
    bench.desk.step()
    assert {bench.judged(side) for side in Side} == {"both arms read the same port"}
    assert bench.card(R).act is Remedy.FIND
    bench.cell.use_sensor(R, right)
    bench.desk.step()
    assert {bench.judged(side) for side in Side} == {""}


def test_an_unknown_protocol_is_refused_in_words(bench: SetupBench):
    before = bench.cell.settings
    bench.desk.choose_port(L, "socket://127.0.0.1:9", "morse")
    bench.run(0.1)
    assert "no such protocol" in bench.picture.trouble
    assert bench.cell.settings.left == before.left


def test_what_a_sensor_calls_itself_wins_and_its_calibration_goes_with_it(bench: SetupBench):
    save_record(bench.folder / "data", SensorRecord("wrist A", calibrated_wall_s=bench.wall_s))
    wear(bench, "wrist A", "wrist B")
    assert bench.card().sensor_id == "wrist A"
    assert (bench.judged(L), bench.judged(R)) == ("", "not calibrated")


def test_swapped_sensors_are_noticed_and_one_press_cures_it(bench: SetupBench):
    wear(bench, "wrist A", "wrist B")
    calibrate_both(bench)
    assert (bench.judged(L), bench.judged(R)) == ("", "")
    wear(bench, "wrist B", "wrist A")
    assert bench.judged(L) == bench.judged(R) == "the sensors are swapped"
    assert bench.card().act is Remedy.SWAP
    ports = bench.cell.settings.left.port, bench.cell.settings.right.port
    with bench.reopening(L, R):
        bench.desk.swap_sensors()
    assert (bench.cell.settings.right.port, bench.cell.settings.left.port) == ports
    bench.run(0.1)
    bench.connect()
    bench.run(3.0)
    assert (bench.card(L).sensor_id, bench.card(R).sensor_id) == ("wrist A", "wrist B")
    assert (bench.judged(L), bench.judged(R)) == ("", "")


def test_swapping_twice_before_the_cell_has_taken_it_is_no_change(bench: SetupBench):
    before = bench.cell.settings
    bench.cell.is_busy = True
    bench.desk.swap_sensors()
    bench.desk.step()
    bench.desk.swap_sensors()
    bench.cell.take()
    bench.desk.step()
    assert bench.cell.settings == before
    bench.desk.swap_sensors()
    assert bench.cell.settings.left == before.right


def test_two_sensors_of_one_name_are_not_armed_with(bench: SetupBench):
    wear(bench, "sensor", "sensor")
    assert bench.judged(L) == bench.judged(R) == "both sensors have the same name"


def test_the_right_one_shaken_swaps_the_two(bench: SetupBench):
    bench.sensors[R].accel_g = lambda t_s: (math.sin(25.0 * t_s), 0.0, 1.0)
    ports = bench.cell.settings.left.port, bench.cell.settings.right.port
    bench.desk.begin_shake()
    bench.desk.step()
    assert bench.picture.shake.is_on
    bench.run_until(lambda: not bench.picture.shake.is_on, 5.0)
    assert "swapped" in bench.picture.shake.sentence
    assert (bench.cell.settings.right.port, bench.cell.settings.left.port) == ports


def test_the_left_one_shaken_changes_nothing(bench: SetupBench):
    bench.sensors[L].accel_g = lambda t_s: (math.sin(25.0 * t_s), 0.0, 1.0)
    settings = bench.cell.settings
    bench.desk.begin_shake()
    bench.run_until(lambda: not bench.desk.measuring.shake.is_on, 5.0)
    assert bench.cell.settings == settings
    assert "rightly" in bench.picture.shake.sentence


@pytest.mark.parametrize("state", [CellState.ARMED, CellState.MOVING, CellState.STOPPING])
def test_nothing_changes_sides_while_armed(bench: SetupBench, state: CellState):
    bench.cell.state = state
    settings = bench.cell.settings
    bench.desk.swap_sensors()
    bench.desk.choose_port(L, "loop://", "csv")
    bench.desk.begin_calibration(L)
    bench.desk.begin_shake()
    bench.desk.step()
    assert bench.cell.settings == settings
    assert bench.picture.trouble == NOT_ARMED
    assert bench.picture.shake.sentence == NOT_ARMED
    assert not bench.desk.measuring.is_on


def test_no_hour_that_strikes_makes_a_sensor_unfit_while_armed(bench: SetupBench):
    calibrate_both(bench)
    bench.cell.state = CellState.MOVING
    bench.wall_s += 400 * 86_400
    bench.desk.step()
    assert bench.judged() == ""
    bench.cell.state = CellState.READY
    bench.desk.step()
    assert "days ago" in bench.judged()


def test_a_link_is_tested_kept_and_refused_until_the_level_is_raised(bench: SetupBench):
    calibrate_both(bench)
    bench.desk.begin_link_test(L)
    bench.run(10.0)
    bench.sensors[L].is_on = False
    bench.run(0.09)
    bench.sensors[L].is_on = True
    bench.run_until(lambda: bench.picture.link_test.outcome.check is not Check.RUNNING, 25.0)
    view = bench.picture.link_test
    assert view.outcome.check is Check.FAILED
    assert view.worst_gap_s == pytest.approx(0.1, abs=0.015)
    assert (
        bench.judged()
        == f"link carries {view.lowest_trip_s * 1000:.0f} ms at best, trip level is 100 ms"
    )
    assert bench.card().act is Remedy.TEST_LINK
    record, _ = load_record(bench.folder / "data", bench.card().sensor_id)
    assert record.link is not None
    assert record.link.lowest_trip_s == view.lowest_trip_s
    assert (record.link.port, record.link.protocol) == (bench.card().port, "csv")
    lowest_ms = round(view.lowest_trip_s * 1000)
    assert bench.card().link.startswith("link tested today at ")
    assert bench.card().link.endswith(f", carries {lowest_ms} ms")
    settings = bench.cell.settings
    bench.cell.use_settings(replace(settings, site=replace(settings.site, trip_level_s=0.15)))
    bench.desk.step()
    assert bench.judged() == ""


@pytest.mark.parametrize("other", [{"port": "/dev/ttyUSB9"}, {"protocol": "adxl330"}])
def test_a_link_counts_as_untested_behind_another_port_or_in_another_protocol(
    bench: SetupBench, other: dict[str, str]
):
    calibrate_both(bench)
    assert bench.card().link == "link not tested"
    assert bench.judged() == ""
    arm = bench.desk.sensors.arms[L]
    slow = LinkRecord(bench.wall_s, 99.0, 0.01, 0.2, 0.22, 0, 0, bench.card().port, "csv")
    arm.keep(replace(arm.record, link=slow))
    bench.desk.step()
    assert "link carries 220 ms at best" in bench.judged()
    arm.keep(replace(arm.record, link=replace(slow, **other)))
    bench.desk.step()
    assert bench.card().link == "link not tested"
    assert bench.judged() == ""


def test_six_positions_are_taken_and_the_sensor_can_be_armed_with(bench: SetupBench):
    axes = [(0, 0, 1), (0, 0, -1), (1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0)]
    bench.desk.begin_calibration(L)
    bench.desk.step()
    assert bench.judged() == "it is being calibrated"
    for x, y, z in axes:
        bench.sensors[L].accel_g = lambda t_s, x=x, y=y, z=z: (
            1.05 * x + 0.02 + 0.001 * (round(t_s * 100) % 3),
            y + 0.001 * (round(t_s * 100) % 5),
            z - 0.001 * (round(t_s * 100) % 7),
        )
        bench.run(2.5)
    bench.run_until(lambda: not bench.picture.calibration.is_on, 5.0)
    view = bench.picture.calibration
    assert view.outcome.check is Check.PASSED, view
    assert view.outcome.wall_s == pytest.approx(bench.wall_s, abs=6.0)
    bench.desk.step()
    assert bench.judged() == ""
    assert bench.cell.calibrations[L] != NOMINAL
    assert bench.cell.calibrations[L].matrix[0][0] == pytest.approx(1 / 1.05, abs=0.005)
    bench.run(0.2)
    assert bench.cell.left.tail(0.05)[-1, 2] == pytest.approx(-1.0, abs=0.02)


def test_a_calibration_that_is_ended_leaves_the_one_before(bench: SetupBench):
    calibrate_both(bench)
    bench.desk.begin_calibration(L)
    bench.run(0.2)
    assert bench.judged() == "it is being calibrated"
    bench.desk.look(False)
    bench.desk.step()
    assert bench.judged() == ""
    assert not bench.picture.calibration.is_on


def test_a_level_check_needs_a_calibration_and_is_kept(bench: SetupBench):
    bench.desk.begin_level_check(L)
    bench.desk.step()
    assert bench.picture.level.outcome.check is Check.FAILED
    calibrate_both(bench)
    bench.desk.begin_level_check(L)
    bench.run_until(lambda: bench.picture.level.outcome.check is Check.PASSED, 5.0)
    bench.desk.step()
    assert bench.card().level.startswith("level, 0.")
