"""A sensor calibrated from the bytes it sends, in each protocol, by a radio that sends bursts."""

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
from gestureapp.simulation.sensor_wire import ENCODERS
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
