"""Six positions, level check and postures driven from a stream's store, kept, and used."""

import numpy as np
import pytest

from gestureapp.config import SensorSettings, Settings
from gestureapp.recording.person_profile import load_profile
from gestureapp.recording.sensor_records import load_record, record_path
from gestureapp.sensing.calibration import NOMINAL
from gestureapp.sensing.store import SampleStore
from gestureapp.sensing.values import Sample, Side
from gestureapp.setup.arm_sensor import ArmSensor
from gestureapp.setup.fit import UP
from gestureapp.setup.measuring import Measuring
from gestureapp.setup.values import Check, Position
from tests.setup.lying import OFF, OFF_OFFSET_G, turn
from tests.setup.streams import health_of

WALL_S = 1_800_000_000.0


class Bench:
    """A sensor of the left arm that is laid down by hand, and what setting up makes of it."""

    def __init__(self, data):
        self.left, self.right = SampleStore(20_000), SampleStore(20_000)
        self.settings = Settings(left=SensorSettings("/dev/a"), right=SensorSettings("/dev/b"))
        self.used, self.judged = NOMINAL, ("", "")
        self.now_s, self.seq, self.who = 1000.0, 0, "WT-1"
        self.rng = np.random.default_rng(4)
        self.arms = {side: ArmSensor(side, self, data) for side in Side}
        self.measuring = Measuring(self, self.arms, data, lambda _: None, lambda: None)
        self.wait(0.2)

    def use_calibration(self, side, calibration):
        self.used = calibration if side is Side.LEFT else self.used

    def judge_sensor(self, side, problem, remedy=""):
        self.judged = (problem, remedy) if side is Side.LEFT else self.judged

    def wait(self, seconds, up=(0.0, 0.0, 1.0), jerk_g=0.0):
        for k in range(round(seconds * 100)):
            self.now_s += 0.01
            nominal = OFF @ np.asarray(up) + OFF_OFFSET_G + self.rng.normal(0, 0.003, 3)
            nominal = nominal + self.rng.normal(0, jerk_g, 3) if jerk_g else nominal
            read = self.used.applied(tuple(float(value) for value in nominal))
            self.left.append(Sample(self.now_s, self.seq, read))
            self.seq += 1
            if k % 10 == 9:
                self.tick()

    def tick(self):
        health = {side: health_of(side=side) for side in Side}
        health[Side.LEFT] = health_of(identity=self.who)
        for side, arm in self.arms.items():
            arm.look(self.now_s, health[side], None)
        self.measuring.step(self.now_s, WALL_S, health)
        for arm in self.arms.values():
            arm.judge(WALL_S, ("", ""))

    def lay(self, position):
        self.wait(0.5, jerk_g=0.6)
        self.wait(2.2, UP[position])

    def calibrate(self):
        self.measuring.begin_calibration(Side.LEFT, self.now_s)
        for position in Position:
            self.lay(position)


@pytest.fixture
def bench(tmp_path):
    return Bench(tmp_path)


def test_a_sensor_is_calibrated_kept_and_used_at_once(bench, tmp_path):
    assert bench.judged[0] == "not calibrated"
    bench.calibrate()
    assert bench.measuring.calibration.outcome.check is Check.PASSED
    assert bench.measuring.calibration.outcome.wall_s == WALL_S
    record, trouble = load_record(tmp_path, "WT-1")
    assert (trouble, record.calibrated_wall_s) == ("", WALL_S)
    bench.tick()
    assert bench.used == record.used != NOMINAL
    assert bench.judged == ("", "")


def test_while_it_is_calibrated_it_cannot_be_armed_with_and_comes_as_it_is(bench):
    bench.calibrate()
    bench.measuring.begin_calibration(Side.LEFT, bench.now_s)
    bench.wait(0.3)
    assert (bench.judged[0], bench.used) == ("it is being calibrated", NOMINAL)
    before = bench.arms[Side.LEFT].record
    bench.measuring.end_calibration()
    bench.tick()
    assert (bench.judged, bench.used) == (("", ""), before.used)


def test_a_sensor_that_is_changed_half_way_is_not_calibrated(bench, tmp_path):
    bench.measuring.begin_calibration(Side.LEFT, bench.now_s)
    for position in tuple(Position)[:4]:
        bench.lay(position)
    bench.who = "WT-2"
    bench.wait(0.2)
    view = bench.measuring.calibration
    assert (view.is_on, view.outcome.check) == (False, Check.FAILED)
    assert view.sentence.startswith("Another sensor answers there now")
    assert not list(tmp_path.glob("sensors/*"))
    assert bench.judged[0] == "not calibrated"


@pytest.mark.parametrize("what", ["level", "postures"])
def test_so_is_a_level_check_and_a_recording_of_postures(bench, tmp_path, what):
    bench.calibrate()
    if what == "level":
        bench.measuring.begin_level_check(Side.LEFT)
    else:
        bench.measuring.begin_postures("Ada")
    bench.wait(1.0)
    bench.who = "WT-2"
    bench.wait(5.0)
    assert getattr(bench.measuring, what).outcome.text.startswith("Another sensor")
    assert not bench.measuring.is_on
    assert load_record(tmp_path, "WT-1")[0].level is None
    assert load_profile(tmp_path, "Ada")[0].postures is None


def test_a_level_check_is_kept_and_used_and_a_failed_one_blocks(bench, tmp_path):
    bench.calibrate()
    bench.tick()
    bench.measuring.begin_level_check(Side.LEFT)
    bench.wait(2.5, turn((1.5, 0, 0)) @ [0, 0, 1])
    assert bench.measuring.level.outcome.check is Check.PASSED
    level = load_record(tmp_path, "WT-1")[0].level
    assert level.off_deg == pytest.approx(1.5, abs=0.2)
    bench.tick()
    assert (bench.used, bench.judged) == (level.used, ("", ""))
    bench.measuring.begin_level_check(Side.LEFT)
    bench.wait(2.5, turn((6.0, 0, 0)) @ [0, 0, 1])
    bench.tick()
    assert bench.judged[0] == "6.0 degrees off level"


def test_postures_are_kept_for_their_person(bench, tmp_path):
    bench.calibrate()
    bench.measuring.begin_postures("Ada")
    bench.wait(6.0)
    bench.wait(0.3, jerk_g=0.5)
    bench.wait(2.5, (-1.0, 0.0, 0.0))
    assert bench.measuring.postures.outcome.check is Check.PASSED
    profile, trouble = load_profile(tmp_path, "Ada")
    assert (trouble, profile.recorded_wall_s) == ("", WALL_S)
    assert profile.postures.start == pytest.approx((-1, 0, 0), abs=0.02)


def test_what_cannot_be_kept_is_told_and_not_used(bench, tmp_path):
    (tmp_path / "sensors").write_text("in the way")
    bench.calibrate()
    bench.tick()
    outcome = bench.measuring.calibration.outcome
    assert outcome.check is Check.FAILED
    assert "not kept" in outcome.text
    assert bench.used == NOMINAL


def test_a_damaged_file_blocks_until_it_is_calibrated_anew(bench, tmp_path):
    bench.calibrate()
    path = record_path(tmp_path, "WT-1")
    path.write_bytes(path.read_bytes()[:-40])
    again = Bench(tmp_path)
    assert "is damaged" in again.judged[0]
    assert again.judged[1] == "calibrate the sensor anew"
    again.calibrate()
    again.tick()
    assert again.judged == ("", "")
