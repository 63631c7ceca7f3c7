"""Control without a thread: the clock in hand, simulated arms, a guardian that obeys."""

import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
import pytest

from gestureapp.cell import events as e
from gestureapp.cell.control import TICK_S, Control
from gestureapp.cell.ear import open_model
from gestureapp.cell.fitness import FIT
from gestureapp.cell.inputs import (
    GuardianPort,
    GuardianSaid,
    Input,
    SampleCame,
    SensorJudged,
    SensorTold,
)
from gestureapp.cell.records import Record, Topic
from gestureapp.cell.snapshot import CellState
from gestureapp.clock import monotonic
from gestureapp.config import SensorSettings, Settings
from gestureapp.errors import GuardianLost
from gestureapp.robot import messages as m
from gestureapp.robot.leftover import KeptMoves
from gestureapp.robot.values import Pose, PoseIncrement, Position, Posture, StopReason
from gestureapp.sensing.calibration import Calibration
from gestureapp.sensing.values import ArmPosture, Connected, Sample, Side
from gestureapp.simulation.arm import LeftArm, RightArm, start_seen_after_s
from gestureapp.simulation.demo import MODEL
from gestureapp.simulation.people import practised_person
from gestureapp.simulation.sensor import DEMO_SEED, DEMO_SESSION

START_POSE = Pose(800.0, 0.0, 300.0, 180.0, 0.0, 0.0)
REMOTE_PLAY, SERVO_ON = 0xC0, 0x40
STANDSTILL_S = 0.15


def wait_until(is_so: Callable[[], object], limit_s: float = 5.0, step_s: float = 0.01) -> bool:
    """Look again and again until it is so. Returns whether it was, within the limit."""
    deadline_s = monotonic() + limit_s
    while not is_so():
        if monotonic() > deadline_s:
            return False
        time.sleep(step_s)
    return True


@dataclass
class ScriptedGuardian:
    """Answers as the guardian does: permission, one open command, a stop that is confirmed.

    Attributes:
        heard: What was sent to it, heartbeats left out.
        beats: The heartbeats.
        is_mute: Answers nothing, as one that hangs.
        refuses: Refuses every proposal with this text.
        confirms: Confirms stops.
    """

    heard: list[m.ToGuardian] = field(default_factory=list)
    beats: list[m.Beat] = field(default_factory=list)
    is_mute: bool = False
    is_dismissed: bool = False
    refuses: str = ""
    confirms: bool = True
    moving_id: int | None = None
    _now_s: float = 0.0
    _armed: bool = False
    _stop: tuple[float, StopReason] | None = None
    _said: list[m.FromGuardian] = field(default_factory=list)

    def send(self, message: m.ToGuardian) -> None:
        if isinstance(message, m.Beat):
            self.beats.append(message)
            return
        self.heard.append(message)
        match message:
            case m.Arm():
                self._armed = True
                self._said.append(m.Armed())
            case m.Disarm():
                self._lose_permission()
            case m.Propose():
                self._propose(message)
            case m.Stop():
                self.stop(message.reason, message.text)

    def dismiss(self) -> None:
        self.is_dismissed = True

    def stop(self, reason: StopReason, text: str) -> None:
        """Stop, whoever asks: as the supervisor, permission first, then the reason."""
        if reason.is_latched:
            self._lose_permission()
        if self._stop is None or (reason.is_latched and not self._stop[1].is_latched):
            self._stop = (self._now_s, reason)
            self._said.append(m.StopAsked(reason, text, self._now_s))

    def end_move(self) -> None:
        """The increment has come to its end."""
        assert self.moving_id is not None
        self._said.append(m.MotionEnded(self.moving_id, START_POSE))
        self.moving_id = None

    def say(self, message: m.FromGuardian) -> None:
        self._said.append(message)

    def messages(self, now_s: float) -> list[m.FromGuardian]:
        """What it says until this time."""
        self._now_s = now_s
        if self.is_mute:
            self._said.clear()
            return []
        self._confirm(now_s)
        said, self._said = self._said, []
        if round(now_s / TICK_S) % 10 == 0:
            running = 0x08 if self.moving_id is not None else 0
            said.append(m.StatusReport(now_s, REMOTE_PLAY | running, SERVO_ON, ()))
            said.append(m.PoseReport(now_s, Position(START_POSE, Posture(1), 0)))
        return said

    def of(self, kind: type[m.ToGuardian]) -> list[m.ToGuardian]:
        return [message for message in self.heard if isinstance(message, kind)]

    def _propose(self, message: m.Propose) -> None:
        if self.refuses:
            refusal = m.Refusal("field", self.refuses)
            self._said.append(m.CommandRefused(message.activation_id, refusal))
            return
        self.moving_id = message.activation_id
        increment = PoseIncrement(dx_mm=300.0)
        self._said += [
            m.CommandSent(
                self.moving_id, self._now_s, START_POSE, increment, "the field", 100.0, False
            ),
            m.CommandAccepted(self.moving_id, self._now_s),
        ]

    def _confirm(self, now_s: float) -> None:
        if self._stop is not None and self.confirms and now_s - self._stop[0] >= STANDSTILL_S:
            reason, self._stop, self.moving_id = self._stop[1], None, None
            self._said.append(m.StopConfirmed(reason, STANDSTILL_S, START_POSE))

    def _lose_permission(self) -> None:
        if self._armed:
            self._armed = False
            self._said.append(m.Disarmed())


@dataclass
class ReaderNotes:
    """Implements ``ReaderPort`` by noting what was asked."""

    used: list[SensorSettings] = field(default_factory=list)
    calibrations: list[Calibration] = field(default_factory=list)

    def use(self, settings: SensorSettings) -> None:
        self.used.append(settings)

    def set_calibration(self, calibration: Calibration) -> None:
        self.calibrations.append(calibration)


class Desk:
    """Control with everything around it in the test's hand. The time moves only in ``run``.

    Attributes:
        control: What is tested.
        guardians: Every guardian started, the newest last.
        records: Everything recorded.
        changes: Each sample of a side goes through it; what is None is not received.
        rates_hz: Samples a second of each side.
    """

    def __init__(self, settings: Settings | None = None) -> None:
        settings = Settings() if settings is None else settings
        self.settings = replace(settings, robot=replace(settings.robot, host="10.0.0.2"))
        person = practised_person(DEMO_SEED, session=DEMO_SESSION)
        self.person = person
        self.now_s = 1000.0
        self.guardians: list[ScriptedGuardian] = []
        self.started_with: list[Settings] = []
        self.started_knowing: list[KeptMoves] = []
        self.records: list[Record] = []
        self.trouble = ""
        self.changes: dict[Side, Callable[[Sample], Sample | None]] = {}
        self.rates_hz = {Side.LEFT: 100.0, Side.RIGHT: 100.0}
        self._arms = {Side.LEFT: LeftArm(person, 1), Side.RIGHT: RightArm(person, 1)}
        self._sensors = {Side.LEFT: person.left_sensor, Side.RIGHT: person.right_sensor}
        self._rng = np.random.default_rng(3)
        self._seq = dict.fromkeys(Side, 0)
        self._due_s = {Side.LEFT: self.now_s, Side.RIGHT: self.now_s + 0.005}
        self.readers = {side: ReaderNotes() for side in Side}
        self.control = Control(
            settings=self.settings,
            model=open_model(MODEL),
            start_guardian=self._start_guardian,
            readers=self.readers,
            gui_seen_s=lambda: self.now_s,
            record=self.records.append,
            clock=lambda: self.now_s,
            wall_clock=lambda: 1.8e9 + self.now_s,
        )
        for side in Side:
            self.press(SensorJudged(side, FIT))
            self.control.handle(SensorTold(self.now_s, side, Connected("test")), self.now_s)

    @property
    def guardian(self) -> ScriptedGuardian:
        return self.guardians[-1]

    @property
    def state(self) -> CellState:
        return self.control.state.state

    @property
    def left(self) -> LeftArm:
        arm = self._arms[Side.LEFT]
        assert isinstance(arm, LeftArm)
        return arm

    def run(self, span_s: float, until: CellState | None = None) -> bool:
        """Let time pass, at most until the cell is in a state. Returns whether it is."""
        end_s = self.now_s + span_s
        while self.now_s < end_s and (until is None or self.state is not until):
            self._turn()
        return self.state is until

    def press(self, event: Input) -> None:
        self.control.handle(event, self.now_s)

    def press_guardian(self, message: m.FromGuardian) -> None:
        """The guardian says this now."""
        self.control.handle(GuardianSaid(message), self.now_s)

    def ready(self) -> "Desk":
        assert self.run(4.0, CellState.READY), self.control.state
        return self

    def armed(self) -> "Desk":
        self.ready()
        self.press(e.ArmPressed(self.now_s))
        assert self.run(0.5, CellState.ARMED), self.control.state
        return self

    def gesture(self, label: str = "X+") -> None:
        """Both arms together, as an operator does."""
        lead_s = start_seen_after_s(self.person) + 0.6
        right = self._arms[Side.RIGHT]
        assert isinstance(right, RightArm)
        right.perform_for(label, self.now_s + lead_s)
        self.left.take(ArmPosture.START, self.now_s + 0.6)

    def moving(self) -> "Desk":
        self.armed()
        self.gesture()
        assert self.run(2.0, CellState.MOVING), self.control.state
        return self

    def of(self, topic: Topic) -> list[Record]:
        return [record for record in self.records if record.topic is topic]

    def _start_guardian(self, settings: Settings, kept: KeptMoves) -> GuardianPort:
        self.started_with.append(settings)
        self.started_knowing.append(kept)
        if self.trouble:
            raise GuardianLost(self.trouble)
        self.guardians.append(ScriptedGuardian())
        self.guardian.say(m.LinkReport(True, "127.0.0.1:80"))
        return self.guardian

    def _turn(self) -> None:
        self.now_s = round(self.now_s + TICK_S / 2, 6)
        for side in Side:
            if self.now_s >= self._due_s[side]:
                self._due_s[side] += 1.0 / self.rates_hz[side]
                self._sample(side)
        if self.guardians:
            for message in self.guardian.messages(self.now_s):
                self.control.handle(GuardianSaid(message), self.now_s)
        if round(self.now_s / (TICK_S / 2)) % 2 == 0:
            self.control.tick(self.now_s)

    def _sample(self, side: Side) -> None:
        true_g = np.array(self._arms[side].accel_g(self.now_s))
        x, y, z = self._sensors[side].read(true_g, self._rng).tolist()
        sample: Sample | None = Sample(self.now_s, self._seq[side], (x, y, z))
        self._seq[side] += 1
        if side in self.changes and sample is not None:
            sample = self.changes[side](sample)
        if sample is not None:
            self.control.handle(SampleCame(side, sample), self.now_s)


@pytest.fixture
def desk() -> Desk:
    return Desk()


@pytest.fixture
def make_desk() -> Callable[..., Desk]:
    """Makes a desk with another site: ``make_desk(stop_on_right_lost=False)``."""

    def make(**site: object) -> Desk:
        settings = Settings()
        return Desk(replace(settings, site=replace(settings.site, **site)))  # type: ignore[arg-type]

    return make


@pytest.fixture
def until() -> Callable[..., bool]:
    return wait_until
