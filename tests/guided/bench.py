"""A simulated person with two sensors and a clock in the hand, in front of guided training."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from gestureapp.config import Settings
from gestureapp.guided.desk import Desk
from gestureapp.guided.values import GuidedSnapshot, Phase
from gestureapp.recognition.values import Recognition
from gestureapp.sensing.posture import BUILT_IN
from gestureapp.sensing.store import SampleStore
from gestureapp.sensing.stream import StreamTracker
from gestureapp.sensing.values import (
    ArmPosture,
    Connected,
    Disconnected,
    Sample,
    Side,
    StreamHealth,
)
from gestureapp.simulation.arm import LeftArm, RightArm, start_seen_after_s
from gestureapp.simulation.people import Person, practised_person

RATE_HZ = 100.0
LOOK_TICKS = 4
WALL_S = 1_800_000_000.0


@dataclass(frozen=True)
class Picture:
    left: StreamHealth
    right: StreamHealth
    recognition: Recognition | None = None
    person: str = ""


class SensedArms:
    """The sensors of a cell without its robot; samples come as the bench lets them."""

    def __init__(self, settings: Settings) -> None:
        self.settings, self.postures = settings, BUILT_IN
        self.left, self.right = SampleStore(), SampleStore()
        site = settings.site
        self.trackers = {
            side: StreamTracker(side, site.trip_level_s, site.rate_min_hz, site.rate_max_hz)
            for side in Side
        }
        self.now_s = 0.0
        self.recognition: Recognition | None = None
        self.person = ""

    def snapshot(self) -> Picture:
        left, right = (self.trackers[side].health(self.now_s) for side in (Side.LEFT, Side.RIGHT))
        return Picture(left, right, self.recognition, self.person)


class Bench:
    """Guided training's desk with a person before it. Time passes only in ``run``.

    Attributes:
        desk: What the guided thread would drive.
        silent: Sensors that send nothing.
        is_idle: The person does nothing.
        slips: By the number of the answer, from 0, how it is done instead of what was asked.
    """

    def __init__(self, data: Path, person: Person | None = None, settings: Settings | None = None):
        self.now_s = 1000.0
        self.person = person or practised_person(3)
        self.arms = SensedArms(settings or Settings())
        self.right = RightArm(self.person, 1)
        self.left = LeftArm(self.person, 1)
        self.silent: set[Side] = set()
        self.is_idle = False
        self.slips: dict[int, Callable[[str, float], None]] = {}
        self.n_answers = 0
        self._rng = np.random.default_rng(1)
        self._seq = 0
        self._ahead: list[tuple[list[float], list[float]]] = []
        self._seen_after_s = start_seen_after_s(self.person)
        self._answered_s = 0.0
        self._lower_s = np.inf
        for side in Side:
            self.arms.trackers[side].event(self.now_s, Connected("here"))
        self.desk = Desk(
            self.arms,
            data,
            lambda: self.now_s,
            lambda: WALL_S + self.now_s,
        )
        self.run(1.0)

    @property
    def picture(self) -> GuidedSnapshot:
        return self.desk.picture

    def lose(self, side: Side) -> None:
        self.silent.add(side)
        self.arms.trackers[side].event(self.now_s, Disconnected("pulled out"))

    def restore(self, side: Side) -> None:
        self.silent.discard(side)
        self.arms.trackers[side].event(self.now_s, Connected("here"))

    def run(self, span_s: float) -> None:
        for _ in range(round(span_s * RATE_HZ)):
            self.tick()

    def run_until(self, condition: Callable[[GuidedSnapshot], bool], limit_s: float = 120.0):
        """Let time pass until the picture is so; fails after the limit."""
        for _ in range(round(limit_s * RATE_HZ)):
            if condition(self.picture):
                return
            self.tick()
        raise AssertionError(f"it did not become so in {limit_s} s: {self.picture}")

    def run_batch(self) -> None:
        """Start a batch and let the person do it to its end."""
        self.desk.start()
        self.tick()
        self.run_until(lambda picture: picture.phase is Phase.IDLE)

    def tick(self) -> None:
        """One sample of each arm; the person looks up every ``LOOK_TICKS`` of them."""
        if not self._ahead:
            if not self.is_idle:
                self._follow(self.picture)
            self._ahead = self._next_readings()
        self.now_s += 1.0 / RATE_HZ
        self.arms.now_s = self.now_s
        left_g, right_g = self._ahead.pop(0)
        self._send(Side.LEFT, self.arms.left, left_g)
        self._send(Side.RIGHT, self.arms.right, right_g)
        self.desk.step()

    def perform(self, label: str, activation_s: float) -> None:
        """What the person does with the right arm for an activation at this time."""
        slip = self.slips.get(self.n_answers, self.right.perform_for)
        self.n_answers += 1
        slip(label, activation_s)

    def rest(self, label: str, activation_s: float) -> None:
        """Nothing, whatever is asked."""

    def asked(self, picture: GuidedSnapshot) -> str:
        return picture.trying.asked or picture.label

    def _follow(self, picture: GuidedSnapshot) -> None:
        """Do what is asked for: at the beat, or with the left arm."""
        if self.now_s >= self._lower_s:
            self.left.take(ArmPosture.STOP, self.now_s)
            self.right.rest(self.now_s)
            self._lower_s = np.inf
        label = self.asked(picture)
        if not label:
            return
        lead_s = self.right.lead_s(label)
        if np.isfinite(picture.next_beat_s):
            if picture.next_beat_s - self.now_s <= lead_s + 0.1:
                self._answer(label, picture.next_beat_s)
        elif self._is_wanted(picture) and self.now_s > self._answered_s + 1.6:
            wait_s = max(lead_s, self._seen_after_s) + 0.3
            if picture.posture is ArmPosture.STOP and self.right.is_at_rest(self.now_s):
                self._answer(label, self.now_s + wait_s)
                self.left.take(ArmPosture.START, self.now_s + wait_s - self._seen_after_s)

    def _is_wanted(self, picture: GuidedSnapshot) -> bool:
        return picture.phase is Phase.WAITING or bool(picture.trying.asked)

    def _answer(self, label: str, activation_s: float) -> None:
        if activation_s > self._answered_s + 0.5:
            self._answered_s = activation_s
            self._lower_s = activation_s + 0.6
            self.perform(label, activation_s)

    def _next_readings(self) -> list[tuple[list[float], list[float]]]:
        """What both sensors read until the person looks up again, left and right."""
        times_s = self.now_s + np.arange(1, LOOK_TICKS + 1) / RATE_HZ
        person, rng = self.person, self._rng
        for arm in (self.left, self.right):
            arm.accel_g(self.now_s)  # lets it forget what is long over
        left_g = person.left_sensor.read(self.left.accel_at(times_s), rng)
        right_g = person.right_sensor.read(self.right.accel_at(times_s), rng)
        return list(zip(left_g.tolist(), right_g.tolist(), strict=True))

    def _send(self, side: Side, store: SampleStore, accel_g: list[float]) -> None:
        if side in self.silent:
            return
        self._seq += 1
        x, y, z = accel_g
        sample = Sample(self.now_s, self._seq, (x, y, z))
        store.append(sample)
        self.arms.trackers[side].sample(sample)
