"""A sensor calibrated from the bytes it sends, in each protocol, by a radio that sends bursts."""

import json

import numpy as np
import pytest

from gestureapp.recording.sensor_records import SensorRecord
from gestureapp.sensing.calibration import NOMINAL, accel_of
from gestureapp.sensing.protocols import BUILT_IN
from gestureapp.sensing.values import Frame, Side
from gestureapp.setup.fit import UP
from gestureapp.setup.level import LevelCheck
from gestureapp.setup.six_positions import SixPositions
from gestureapp.setup.values import Check, Position
from gestureapp.simulation.accelerometer import adxl330
from gestureapp.simulation.sensor_control import StreamRecord, answer_command
from gestureapp.simulation.sensor_model import SensorModel
from gestureapp.simulation.sensor_wire import ENCODERS
from gestureapp.simulation.wearer import person_of, wearer_of
from tests.setup.lying import turn

BURST = 7
"""Samples a burst: 70 ms between two of them."""


class Wire:
    """One part of the simulation, laid down by hand; what it sends is decoded as in the cell."""

    def __init__(self, protocol, seed):
        self.part = adxl330(np.random.default_rng(seed))
        self.rng = np.random.default_rng(seed + 1)
        self.protocol, self.encode = protocol, ENCODERS[protocol.name]
        self.decoder = protocol.new_decoder()
        self.calibration, self.now_s, self.number = NOMINAL, 50.0, 0

    def lies(self, machine, up, seconds):
        for _ in range(round(seconds * 100 / BURST)):
            self.now_s += BURST / 100
            truth = np.tile(np.asarray(up, float), (BURST, 1))
            sent = b"".join(self.bytes_of(one) for one in self.part.read(truth, self.rng))
            frames = [one for one in self.decoder.feed(sent) if isinstance(one, Frame)]
            read = [accel_of(frame, self.protocol, self.calibration) for frame in frames]
            rows = np.array([(self.now_s, *one) for one in read]).reshape(-1, 4)
            machine.step(self.now_s, rows)
        return machine.view

    def bytes_of(self, accel_g):
        self.number += 1
        return self.encode(self.number, tuple(float(value) for value in accel_g))


@pytest.mark.parametrize("protocol", BUILT_IN, ids=lambda protocol: protocol.name)
@pytest.mark.parametrize("seed", [1, 2])
def test_six_positions_then_a_level_check_from_real_bytes(protocol, seed):
    wire, machine = Wire(protocol, seed), SixPositions(Side.LEFT)
    rng = np.random.default_rng(seed)
    for position in Position:
        wire.lies(machine, rng.normal(0.0, 0.8, 3), 0.07)
        view = wire.lies(machine, turn(rng.normal(0.0, 0.5, 3)) @ np.array(UP[position]), 2.2)
    assert view.outcome.check is Check.PASSED, view
    assert view.worst_mg < 5.0
    record = machine.record(SensorRecord("a"), 1e9)
    for truth in rng.standard_normal((30, 3)):
        unit = truth / np.linalg.norm(truth)
        corrected = record.used.applied(tuple(wire.part.without_noise(unit)))
        assert np.linalg.norm(corrected) == pytest.approx(1.0, abs=0.02)

    wire.calibration = record.used
    check = LevelCheck(Side.LEFT, record)
    assert wire.lies(check, turn((1.0, 0.5, 0.0)) @ [0, 0, 1.0], 2.5).outcome.check is Check.PASSED
    used = check.record(1e9 + 60).used
    level = used.applied(tuple(wire.part.without_noise(turn((1.0, 0.5, 0.0)) @ [0, 0, 1.0])))
    assert level == pytest.approx((0, 0, 1), abs=0.006)


class Emulated:
    """An emulated sensor that is asked to lie down, its bytes decoded as in the cell."""

    def __init__(self, side, protocol):
        self.now_s = 100.0
        wearer = wearer_of(side, person_of(3, 1, is_practised=True), 3)
        self.model = SensorModel(side, wearer, protocol.name)
        self.protocol, self.decoder = protocol, protocol.new_decoder()

    def ask(self, **command):
        line = json.dumps(command).encode()
        assert answer_command(self.model, line, self.now_s, StreamRecord())["ok"]

    def runs(self, machine, seconds, calibration=NOMINAL):
        for _ in range(round(seconds * 10)):
            sent = b""
            for _ in range(10):
                self.now_s += 0.01
                sent += b"".join(line.data for line in self.model.tick(self.now_s))
            frames = [one for one in self.decoder.feed(sent) if isinstance(one, Frame)]
            read = [accel_of(frame, self.protocol, calibration) for frame in frames]
            rows = np.array([(self.now_s, *one) for one in read]).reshape(-1, 4)
            machine.step(self.now_s, rows)
        return machine.view


@pytest.mark.parametrize("side", Side)
@pytest.mark.parametrize("protocol", BUILT_IN, ids=lambda protocol: protocol.name)
def test_an_emulated_sensor_that_is_laid_down_six_times_is_calibrated(side, protocol):
    sensor, machine = Emulated(side, protocol), SixPositions(side)
    assert sensor.runs(machine, 3.0).wanted is Position.Z_UP  # it is worn: not still, or not flat
    for position in Position:
        sensor.ask(do="lie", position=position.value, askew_deg=0.5)
        view = sensor.runs(machine, 3.2)
    assert view.outcome.check is Check.PASSED, view
    record = machine.record(SensorRecord("a"), 1e9)
    check = LevelCheck(side, record)
    sensor.ask(do="lie", position="z-up", askew_deg=5.0)
    view = sensor.runs(check, 3.5, record.used)
    assert view.outcome.check is Check.FAILED
    assert view.off_deg == pytest.approx(5.0, abs=1.0)


def test_a_worn_sensor_is_worn_again_after_it_has_lain():
    sensor, machine = Emulated(Side.LEFT, BUILT_IN[0]), SixPositions(Side.LEFT)
    sensor.ask(do="lie", position="x-down")
    assert sensor.runs(machine, 3.0).sentence.startswith("X down is done")
    sensor.ask(do="take", posture="stop")
    sensor.runs(machine, 1.0)
    x, _, z = sensor.model.wearer.accel_g(sensor.now_s)
    assert abs(x) < 0.3 < 0.8 < z
