"""A small cell for the window: real sample stores, snapshots set by the test, calls noted."""

import os
from collections.abc import Callable, Iterator
from dataclasses import replace
from math import pi, sin
from pathlib import Path
from types import SimpleNamespace

import pytest

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

from gestureapp.cell.snapshot import (
    Blocker,
    CellState,
    EventLine,
    RecordingView,
    RobotView,
    Snapshot,
)
from gestureapp.config import SensorSettings, Settings
from gestureapp.gestures import LABELS
from gestureapp.recognition.values import NO_GESTURE, Candidate, Recognition
from gestureapp.robot.values import Direction, Pose, PoseIncrement, RobotStatus
from gestureapp.sensing.calibration import Calibration
from gestureapp.sensing.posture import BUILT_IN, LeftPostures
from gestureapp.sensing.store import SampleStore
from gestureapp.sensing.values import ArmPosture, LinkState, Sample, Side, StreamHealth
from gestureapp.simulation.prompts import Prompt
from ui.main_window import MainWindow

NOW_S = 1000.0
REMOTE_AND_SERVO = RobotStatus(data_1=0xC0, data_2=0x40)


def healthy(side: Side) -> StreamHealth:
    return StreamHealth(
        side=side,
        link=LinkState.RECEIVING,
        is_alive=True,
        is_valid=True,
        is_freq_ok=True,
        reason="",
        age_s=0.004,
        rate_hz=100.2,
        worst_gap_s=0.014,
        n_samples=12000,
        n_bad=0,
        n_lost=0,
    )


def recognised(label: str, activation_id: int = 1) -> Recognition:
    outputs = tuple(Candidate(each, 0.93 if each == label else 0.04) for each in LABELS)
    used = (NOW_S - 0.5, NOW_S - 0.48, NOW_S - 0.478)
    return Recognition(activation_id, label, "", outputs, *used, thresholds=(0.5,))


def followed(label: str | None, confidence: float, reason: str = "") -> Recognition:
    """An answer of the recogniser that follows the movement from its onset."""
    shares = {label or "Y+": confidence, "RZ+": 0.41, NO_GESTURE: 0.02}
    outputs = tuple(Candidate(each, shares.get(each, 0.0)) for each in (*LABELS, NO_GESTURE))
    used = (NOW_S - 0.54, NOW_S - 0.48, NOW_S - 0.478)
    return Recognition(
        3, label, reason, outputs, *used, onset_s=NOW_S - 0.54, thresholds=(0.95, 0.6)
    )


def not_recognised() -> Recognition:
    shares = {"X+": 0.48, "RY-": 0.41}
    outputs = tuple(Candidate(each, shares.get(each, 0.03)) for each in LABELS)
    return Recognition(
        2,
        None,
        "no clear gesture",
        outputs,
        NOW_S - 0.5,
        NOW_S - 0.48,
        NOW_S - 0.478,
        thresholds=(0.5,),
    )


def ready() -> Snapshot:
    return Snapshot(
        t_s=NOW_S,
        state=CellState.READY,
        sentence="Hold the arm button for one second to arm.",
        blockers=(),
        can_arm=True,
        is_stop_unconfirmed=False,
        left=healthy(Side.LEFT),
        right=healthy(Side.RIGHT),
        posture=ArmPosture.STOP,
        trip_level_s=0.1,
        recognition=None,
        direction=None,
        robot=RobotView(
            is_connected=True,
            text="NX100 at 127.0.0.1:5000",
            status=REMOTE_AND_SERVO,
            pose=Pose(700.0, 100.0, 300.0, 180.0, 0.0, 0.0),
            pose_age_s=0.02,
        ),
        events=(),
        is_simulation=True,
        recording=RecordingView(
            True, "2026-11-22_10-15-03.mcap", "Recording to sessions/2026-11-22_10-15-03.mcap."
        ),
        person="Operator 1",
        model="operator-1.json, 360 takes",
    )


def blocked(n: int = 4) -> Snapshot:
    some = (
        Blocker("left_sensor", "Left sensor: not connected", "Switch it on, or check its port."),
        Blocker(
            "left_posture",
            "The left arm was not seen in the stop posture for 0.5 s",
            "Hold the left forearm level for a moment.",
        ),
        Blocker("servo", "Servo power is off", "Press Servo on, or switch it on at the pendant."),
        Blocker("remote", "The robot is not in remote mode", "Turn the pendant's key to REMOTE."),
    )
    blockers = tuple(replace(some[i % 4], id=f"{some[i % 4].id}_{i}") for i in range(n))
    left = replace(
        healthy(Side.LEFT),
        link=LinkState.NOT_CONNECTED,
        is_alive=False,
        is_valid=False,
        is_freq_ok=False,
        rate_hz=0.0,
        age_s=float("inf"),
        reason="/dev/rfcomm0 does not exist: switch the sensor on and pair it",
    )
    return replace(
        ready(),
        state=CellState.NOT_READY,
        sentence="Four things stand against arming; each is listed with its remedy.",
        blockers=blockers,
        can_arm=False,
        left=left,
    )


def moving(label: str = "X+", share: float = 0.4) -> Snapshot:
    start = Pose(600.0, 100.0, 300.0, 180.0, 0.0, 0.0)
    if label.startswith("R"):
        increment = PoseIncrement(drx_deg=58.0)
        now = replace(start, rx_deg=180.0 + 58.0 * share - 360.0)
    else:
        increment = PoseIncrement(dx_mm=535.3)
        now = replace(start, x_mm=600.0 + 535.3 * share)
    base = ready()
    robot = replace(
        base.robot,
        pose=now,
        start=start,
        increment=increment,
        limited_by="outer sphere",
        speed="100.0 mm/s",
    )
    return replace(
        base,
        state=CellState.MOVING,
        sentence="The robot moves. Move the left arm out of the start posture to stop.",
        can_arm=False,
        posture=ArmPosture.START,
        recognition=recognised(label),
        direction=Direction(0, 1, label.startswith("R")),
        robot=robot,
        events=tuple(events(7)),
    )


def events(n: int) -> Iterator[EventLine]:
    texts = (
        "Armed by the operator",
        "Start posture taken: activated",
        "Recognised X+ with certainty 0.93",
        "Robot moves 535.3 mm along X+",
        "Stopped: left sensor silent for 104 ms, limit 100 ms",
        "STOP pressed",
        "The robot stands",
    )
    for i in range(n):
        text = texts[i % len(texts)]
        yield EventLine(NOW_S + i, 1.8e9 + i + 0.0625, text, is_alarm="Stopped" in text)


class FakeCell:
    """Implements ``CellControls``; the test sets ``shown`` and reads ``calls``."""

    def __init__(self, shown: Snapshot) -> None:
        self.settings = Settings(is_simulation=True)
        self.postures = BUILT_IN
        self.left = SampleStore()
        self.right = SampleStore()
        self.shown = shown
        self.failure: Exception | None = None
        self.calls: list[str] = []
        self.whys: list[str] = []
        self.n_ticks = 0
        self.n_polls = 0
        self.clock: Callable[[], float] | None = None

    def fill(self, until_s: float = NOW_S, span_s: float = 10.0, rate_hz: float = 100.0) -> None:
        n = int(span_s * rate_hz)
        for i in range(n):
            t_s = until_s - span_s + i / rate_hz
            wave = sin(2 * pi * 0.7 * t_s)
            self.left.append(Sample(t_s, i, (-0.2 + 0.1 * wave, 0.15 * wave, 1.0)))
            self.right.append(Sample(t_s, i, (1.4 * wave**5, 0.4 * wave, 1.0 - 0.5 * wave**3)))

    def snapshot(self) -> Snapshot:
        self.n_polls += 1
        if self.failure is not None:
            raise self.failure
        return self.shown if self.clock is None else replace(self.shown, t_s=self.clock())

    def gui_tick(self) -> None:
        self.n_ticks += 1

    def arm(self) -> None:
        self.calls.append("arm")

    def disarm(self) -> None:
        self.calls.append("disarm")

    def stop(self, why: str = "STOP was pressed") -> None:
        self.calls.append("stop")
        self.whys.append(why)

    def servo_on(self) -> None:
        self.calls.append("servo_on")

    def servo_off(self) -> None:
        self.calls.append("servo_off")

    def use_model(self, path: Path | None, problem: str = "", person: str = "") -> None:
        self.calls.append(f"use_model {path} {problem}".strip())

    def hold_arming(self, why: str) -> None:
        self.calls.append(why or "arming free")

    def use_sensor(self, side: Side, settings: SensorSettings) -> None:
        self.calls.append(f"use_sensor {side.value} {settings.port}")

    def use_calibration(self, side: Side, calibration: Calibration) -> None:
        self.calls.append(f"use_calibration {side.value}")

    def judge_sensor(self, side: Side, problem: str, remedy: str = "") -> None:
        self.calls.append(f"judge_sensor {side.value} {problem}".strip())

    def use_postures(self, postures: LeftPostures, problem: str = "", remedy: str = "") -> None:
        self.postures = postures
        self.calls.append(f"use_postures {problem}".strip())

    def use_settings(self, settings: Settings) -> None:
        self.settings = settings
        self.calls.append("use_settings")

    def begin_stop_test(self, label: str) -> None:
        self.calls.append(f"begin_stop_test {label}")

    def release_stop_test(self) -> None:
        self.calls.append("release_stop_test")

    def shutdown(self) -> None:
        self.calls.append("shutdown")


class FakeOperator:
    """Implements ``VirtualOperator`` by noting what was asked."""

    def __init__(self) -> None:
        self.done: list[str] = []

    def left_start(self) -> None:
        self.done.append("left_start")

    def left_stop(self) -> None:
        self.done.append("left_stop")

    def gesture(self, label: str) -> None:
        self.done.append(label)

    def right_rest(self) -> None:
        self.done.append("right_rest")

    def follow(self, prompt: Prompt) -> None:
        self.done.append(f"follow {prompt.label or 'nothing'}")

    def lay(self, side: Side, position: str) -> None:
        self.done.append(f"lay {side.value} {position}")

    def silence_left(self) -> None:
        self.done.append("silence_left")

    def restore_sensors(self) -> None:
        self.done.append("restore_sensors")

    def describe(self) -> str:
        return f"last asked: {self.done[-1]}" if self.done else "left arm: stop, right arm: rest"


class SteppingClock:
    """Goes on by the same step at each reading: time passes only as somebody looks."""

    def __init__(self, step_s: float) -> None:
        self.now_s = NOW_S
        self.step_s = step_s

    def __call__(self) -> float:
        self.now_s += self.step_s
        return self.now_s


@pytest.fixture
def scenes() -> SimpleNamespace:
    """The moments that tests set, by name: test files cannot import this one."""
    return SimpleNamespace(
        ready=ready,
        blocked=blocked,
        moving=moving,
        recognised=recognised,
        not_recognised=not_recognised,
        followed=followed,
        events=events,
        healthy=healthy,
        now_s=NOW_S,
    )


@pytest.fixture
def cell() -> FakeCell:
    cell = FakeCell(ready())
    cell.fill()
    return cell


@pytest.fixture
def operator() -> FakeOperator:
    return FakeOperator()


@pytest.fixture
def clock() -> SteppingClock:
    return SteppingClock(0.05)


@pytest.fixture
def window(qtbot, cell, operator, clock) -> Iterator[MainWindow]:
    window = MainWindow(cell, operator, clock)
    qtbot.addWidget(window)
    window.resize(1366, 768)
    window.show()
    window.poll()
    yield window
    window.close()
