"""The emulated sensor as a pure model: ticks in, lines out, the time in the test's hand."""

from dataclasses import dataclass, field

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gestureapp.sensing.values import Side
from gestureapp.simulation.sensor_model import (
    BURST_MAX,
    ArmAction,
    Emission,
    Fault,
    FaultKind,
    SensorModel,
    Verb,
)
from gestureapp.simulation.sensor_wire import COUNTER_SPAN

PUSH = ArmAction(Verb.PERFORM, "X+")
LIFT = ArmAction(Verb.PERFORM, "Z+")


@dataclass
class RampArm:
    """Reads its time as x, so that every sample differs; notes what it was told and when."""

    begun: list[tuple[ArmAction, float]] = field(default_factory=list)
    asked_s: list[float] = field(default_factory=list)

    def accel_g(self, t_s: float) -> tuple[float, float, float]:
        self.asked_s.append(t_s)
        return (t_s / 100.0, 0.0, 1.0)

    def begin(self, action: ArmAction, t_s: float) -> None:
        self.begun.append((action, t_s))


def sensor(**options) -> tuple[SensorModel, RampArm]:
    arm = RampArm()
    return SensorModel(Side.RIGHT, arm, **options), arm


def ticks(model: SensorModel, first: int, count: int) -> list[Emission]:
    return [line for n in range(first, first + count) for line in model.tick(n / 100.0)]


def test_every_tick_gives_one_line_with_the_next_running_number():
    model, _ = sensor()
    lines = ticks(model, 0, 5)
    assert [line.counter for line in lines] == [0, 1, 2, 3, 4]
    assert lines[3].data == b"3,0.0003,0.0000,1.0000\n"


def test_the_running_number_starts_anew_after_sixteen_bits():
    model, _ = sensor(_counter=65_534)
    assert [line.counter for line in ticks(model, 0, 3)] == [65_535, 0, 1]


def test_a_scheduled_gesture_reaches_the_arm_before_its_time_and_with_it():
    model, arm = sensor()
    model.tick(0.0)
    assert model.schedule(PUSH, 0.055, 0.0) == 0.055
    ticks(model, 1, 4)
    assert arm.begun == []
    assert model.scheduled_s == 0.055
    ticks(model, 5, 1)
    assert arm.begun == [(PUSH, 0.055)]
    assert model.doing == PUSH


def test_the_newest_wish_replaces_one_that_waits():
    model, arm = sensor()
    model.schedule(PUSH, 0.5, 0.0)
    model.schedule(LIFT, 0.3, 0.1)
    ticks(model, 11, 60)
    assert arm.begun == [(LIFT, 0.3)]


@settings(deadline=None)
@given(st.lists(st.tuples(st.floats(-5.0, 5.0), st.floats(0.0, 0.5)), max_size=20))
def test_no_action_begins_before_a_time_that_was_already_sampled(steps):
    model, arm = sensor()
    now_s = 0.0
    for ahead_s, pause_s in steps:
        now_s += pause_s
        model.schedule(PUSH, now_s + ahead_s, now_s)
        sampled_s = max(arm.asked_s, default=float("-inf"))
        assert all(t_s >= sampled_s for _, t_s in arm.begun[-1:] if model.scheduled_s is None)
        model.tick(now_s)
    assert arm.asked_s == sorted(arm.asked_s)


@pytest.mark.parametrize("kind", [FaultKind.SILENT, FaultKind.UNPLUGGED])
def test_a_silent_sensor_sends_nothing_and_its_running_number_goes_on(kind):
    model, _ = sensor()
    ticks(model, 0, 3)
    model.set_fault(Fault(kind), 0.03)
    assert ticks(model, 3, 10) == []
    assert model.is_unplugged is (kind is FaultKind.UNPLUGGED)
    model.set_fault(Fault(), 0.13)
    assert ticks(model, 13, 1)[0].counter == 13


@pytest.mark.parametrize("jump", [-2, 1000, 70_000])
def test_a_running_number_that_jumps_goes_on_from_there(jump):
    model, _ = sensor()
    ticks(model, 0, 5)
    model.set_fault(Fault(FaultKind.JUMP, jump=jump), 0.05)
    expected = [(5 + jump + n) % COUNTER_SPAN for n in range(3)]
    assert [line.counter for line in ticks(model, 5, 3)] == expected


@pytest.mark.parametrize("counts_on", [True, False])
def test_a_frozen_sensor_repeats_its_last_value(counts_on):
    model, _ = sensor()
    last = ticks(model, 0, 3)[-1]
    model.set_fault(Fault(FaultKind.FROZEN, counts_on=counts_on), 0.03)
    lines = ticks(model, 3, 4)
    assert {line.accel_g for line in lines} == {last.accel_g}
    assert [line.counter for line in lines] == ([3, 4, 5, 6] if counts_on else [2, 2, 2, 2])


def test_a_spike_says_forty_g_in_csv_and_the_rail_in_counts():
    lines = {}
    for protocol in ("csv", "adxl330"):
        model, _ = sensor(protocol=protocol)
        model.set_fault(Fault(FaultKind.SPIKE), 0.0)
        lines[protocol] = ticks(model, 0, 1)[0].data
    assert lines == {"csv": b"0,40.0000,40.0000,40.0000\n", "adxl330": b"0,1023,1023,1023\r\n"}


def test_a_slow_sensor_asks_for_a_longer_period():
    model, _ = sensor()
    assert model.period_s == pytest.approx(0.01)
    model.set_fault(Fault(FaultKind.SLOW, rate_hz=20.0), 0.0)
    assert model.period_s == pytest.approx(0.05)


def test_a_fault_with_a_length_ends_by_itself():
    model, _ = sensor()
    model.set_fault(Fault(FaultKind.SILENT, seconds=0.05), 0.0)
    assert [line.counter for line in ticks(model, 0, 10)] == [5, 6, 7, 8, 9]
    assert model.fault.kind is FaultKind.NONE


def test_a_stall_loses_its_lines_or_gives_them_in_one_burst():
    lost, _ = sensor()
    lost.set_fault(Fault(FaultKind.STALL, seconds=0.05), 0.0)
    assert [line.counter for line in ticks(lost, 0, 7)] == [5, 6]
    burst, _ = sensor()
    burst.set_fault(Fault(FaultKind.STALL, seconds=0.05, is_burst=True), 0.0)
    assert ticks(burst, 0, 5) == []
    assert [line.counter for line in burst.tick(0.05)] == [0, 1, 2, 3, 4, 5]


def test_a_long_stall_keeps_only_the_newest_lines():
    model, _ = sensor()
    model.set_fault(Fault(FaultKind.STALL, seconds=20.0, is_burst=True), 0.0)
    assert ticks(model, 0, 2000) == []
    burst = model.tick(20.0)
    assert [line.counter for line in burst] == list(range(2000 - BURST_MAX, 2001))


@pytest.mark.parametrize("kind", [FaultKind.GARBAGE, FaultKind.TRUNCATED])
def test_a_garbled_line_differs_from_the_one_that_was_meant(kind):
    good, bad = sensor()[0], sensor()[0]
    bad.set_fault(Fault(kind), 0.0)
    pairs = zip(ticks(good, 0, 50), ticks(bad, 0, 50), strict=True)
    assert all(meant.data != sent.data for meant, sent in pairs)
