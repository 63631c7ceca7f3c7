"""The virtual operator follows prompts: real arms in manual time, and the machine that asks."""

import random
from collections import Counter
from dataclasses import dataclass, field, replace
from itertools import pairwise
from math import inf

import numpy as np
import pytest

from gestureapp.config import SiteSettings
from gestureapp.gestures import LABELS
from gestureapp.guided.batch import Batch
from gestureapp.guided.likeness import Likeness
from gestureapp.guided.values import GuidedSnapshot, Pace
from gestureapp.guided.verdict import judge
from gestureapp.recording.take_values import Verdict
from gestureapp.sensing.posture import PostureDetector
from gestureapp.sensing.values import ArmPosture, Side
from gestureapp.simulation.operator_plan import OperatorPlan, Timing
from gestureapp.simulation.prompts import CLUMSY_SHARE, NOTHING, Prompt, PromptFollower
from gestureapp.simulation.sensor_control import StreamRecord, answer_command
from gestureapp.simulation.sensor_model import SensorModel
from gestureapp.simulation.wearer import person_of, wearer_of
from ui.prompts import prompt_of

STEP_S = 0.01
LOOK_EVERY = 3
"""The screen is looked at 33 times a second."""


class NeverClumsy(random.Random):
    def random(self) -> float:
        return 1.0


@dataclass
class Room:
    """One person's two arms, the machine that asks for takes, and time in steps of 10 ms."""

    person: object = field(default_factory=lambda: person_of(7, 2, is_practised=True))
    chance: random.Random = field(default_factory=NeverClumsy)
    now_s: float = 1000.0

    def __post_init__(self) -> None:
        site = SiteSettings()
        self.sensors = {
            side: SensorModel(side, wearer_of(side, self.person, 3), rng=random.Random(1))
            for side in Side
        }
        plan = OperatorPlan(Timing.of(self.person), random.Random(1))
        self.follower = PromptFollower(plan, self.chance)
        self.posture = PostureDetector(
            site.posture_enter_deg, site.posture_leave_deg, site.posture_debounce
        )
        self.right: list[tuple[float, tuple[float, float, float]]] = []

    def step(self, batch: Batch | None, prompt: Prompt) -> float | None:
        self.now_s += STEP_S
        sent = {side: sensor.tick(self.now_s) for side, sensor in self.sensors.items()}
        self.right.append((self.now_s, sent[Side.RIGHT][-1].accel_g))
        before = self.posture.posture
        now = self.posture.feed(sent[Side.LEFT][-1].accel_g)
        if batch is not None and now is not before:
            batch.left(self.now_s, now)
        taken = batch.tick(self.now_s, None) if batch is not None else None
        if len(self.right) % LOOK_EVERY == 0:
            for order in self.follower.orders(prompt, self.now_s):
                line = str(order.command).replace("'", '"').encode()
                answer = answer_command(self.sensors[order.side], line, self.now_s, StreamRecord())
                assert answer["ok"], answer
        return taken

    def record(
        self, label: str, pace: Pace, n_takes: int, beat_s: float = 1.5
    ) -> tuple[list[float], float]:
        """Activations of so many takes, and how long they took without the count-in."""
        for _ in range(100):
            self.step(None, NOTHING)
        batch = Batch(pace, beat_s, n_takes, self.now_s, self.posture.posture)
        began_s, activations = self.now_s + 3.0, []
        while len(activations) < n_takes:
            assert self.now_s < began_s + 5.0 * n_takes, f"{len(activations)} takes of {label}"
            shown = GuidedSnapshot(
                phase=batch.phase,
                pace=pace,
                beat_s=batch.beat_s,
                label=label,
                next_beat_s=batch.next_beat_s,
            )
            taken = self.step(batch, prompt_of(shown))
            if taken is not None:
                activations.append(taken)
        return activations, self.now_s - began_s

    def around(self, at_s: float) -> list[tuple[float, tuple[float, float, float]]]:
        return [(t - at_s, a) for t, a in self.right if -0.5 <= t - at_s <= 1.0]


STRONGEST = {"X": 0, "Y": 1, "Z": 2}


def strongest(room: Room, label: str, at_s: float) -> float:
    """The first strong reading of a gesture along its axis, signed, and without gravity."""
    axis = STRONGEST[label[-2]]
    values = [a[axis] - (axis == 2) for t, a in room.around(at_s) if -0.1 <= t <= 0.2]
    return max(values, key=abs)


@pytest.mark.parametrize("label", ["X+", "X-", "Y+", "Y-", "Z+", "Z-"])
@pytest.mark.parametrize("pace", Pace)
def test_a_movement_begins_with_its_activation(label, pace):
    room = Room()
    activations, _ = room.record(label, pace, 3)
    sign = 1 if label[-1] == "+" else -1
    for at_s in activations:
        assert sign * strongest(room, label, at_s) > 0.4


@pytest.mark.parametrize(
    ("label", "axis", "reads_g"), [("RX+", 1, 1), ("RX-", 1, -1), ("RY+", 0, 1), ("RY-", 0, -1)]
)
@pytest.mark.parametrize("pace", Pace)
def test_a_posture_is_held_when_its_activation_comes(label, axis, reads_g, pace):
    room = Room()
    activations, _ = room.record(label, pace, 3)
    for at_s in activations:
        held = [a[axis] for t, a in room.around(at_s) if 0.0 <= t <= 0.1]
        assert all(reads_g * value > 0.8 for value in held)


@pytest.mark.parametrize("label", LABELS)
def test_the_hand_is_level_again_before_the_next_hands_free_take(label):
    room = Room()
    activations, _ = room.record(label, Pace.HANDS_FREE, 3)
    lead_s = Timing.of(room.person).held_lead_s if label[:2] in ("RX", "RY") else 0.1
    for at_s in activations:
        quiet = [a for t, a in room.right if -lead_s - 0.1 <= t - at_s <= -lead_s]
        assert all(abs(x) < 0.15 and abs(y) < 0.15 and abs(z - 1) < 0.15 for x, y, z in quiet)


@pytest.mark.parametrize("label", LABELS)
@pytest.mark.parametrize("pace", Pace)
def test_a_take_that_is_not_clumsy_is_judged_good(label, pace):
    room = Room()
    activations, _ = room.record(label, pace, 3)
    for at_s in activations:
        times_s = np.array([t for t, _ in room.around(at_s)])
        accel_g = np.array([a for _, a in room.around(at_s)])
        assert judge(label, times_s, accel_g, (), Likeness()).is_good


class AlwaysClumsy(random.Random):
    """Every take is clumsy in the same way."""

    slip = "late"

    def random(self) -> float:
        return 0.0

    def choice(self, seq):
        return self.slip if self.slip in seq else seq[0]


@pytest.mark.parametrize("slip", ["late", "not at all"])
@pytest.mark.parametrize("label", ["X+", "RX+", "RZ+"])
@pytest.mark.parametrize("pace", Pace)
def test_a_clumsy_take_is_judged_bad_for_what_it_is(label, slip, pace):
    chance = AlwaysClumsy()
    chance.slip = slip
    room = Room(chance=chance)
    (at_s,), _ = room.record(label, pace, 1)
    times_s = np.array([t for t, _ in room.around(at_s)])
    accel_g = np.array([a for _, a in room.around(at_s)])
    judged = judge(label, times_s, accel_g, (), Likeness())
    assert judged.verdict is (Verdict.TOO_LATE if slip == "late" else Verdict.NO_MOVEMENT)


def test_a_session_of_twelve_times_thirty_takes_lasts_less_than_fifteen_minutes():
    room = Room()
    seconds = {label: room.record(label, Pace.HANDS_FREE, 4)[1] for label in LABELS}
    assert 9 * 60 < 7.5 * sum(seconds.values()) + 36 * 3.0 < 15 * 60, seconds


def test_a_beat_is_met_every_time():
    room = Room()
    activations, lasted_s = room.record("Z+", Pace.RHYTHM, 10)
    steps = [b - a for a, b in pairwise(activations)]
    assert steps == [pytest.approx(1.5)] * 9
    assert lasted_s < 10 * 1.5 + 0.2


def test_nobody_moves_when_nothing_is_asked_for():
    room = Room()
    for _ in range(200):
        room.step(None, NOTHING)
    assert all(abs(x) < 0.1 and abs(y) < 0.1 for _, (x, y, _) in room.right)


def test_a_raised_arm_goes_down_when_the_prompt_goes_away():
    room = Room()
    asked = Prompt("X+", is_waiting=True)
    while room.posture.posture is not ArmPosture.START:
        room.step(None, asked)
    for _ in range(100):
        room.step(None, NOTHING)
    assert room.posture.posture is ArmPosture.STOP


def test_a_trial_is_done_once_for_each_time_it_is_asked_for():
    room = Room(chance=random.Random(0))
    began, heard = 0, 0
    asked = Prompt("X+", is_waiting=True, is_trial=True)
    for _ in range(1200):
        before = room.posture.posture
        room.step(None, replace(asked, number=heard))
        if room.posture.posture is ArmPosture.START and before is not ArmPosture.START:
            began += 1
            heard += 1
    assert began in (5, 6, 7)
    assert room.follower.slip == ""


class Beats:
    """A follower that is shown beat after beat, without arms."""

    def __init__(self, seed: int) -> None:
        timing = Timing.of(person_of(7, 2, is_practised=True))
        plan = OperatorPlan(timing, random.Random(1))
        self.follower = PromptFollower(plan, random.Random(seed))

    def slips(self, n: int, prompt: Prompt) -> list[str]:
        done = []
        for number in range(n):
            beat_s = 10.0 + 1.5 * number
            orders = self.follower.orders(replace(prompt, beat_s=beat_s), beat_s - 0.05)
            again = self.follower.orders(replace(prompt, beat_s=beat_s), beat_s - 0.02)
            assert again == []
            slip = self.follower.slip
            labels = [order.command["label"] for order in orders]
            assert {
                "": labels == [prompt.label],
                "late": labels == [prompt.label],
                "not at all": labels == [],
                "another gesture": prompt.label not in labels and len(labels) == 1,
            }[slip]
            done.append(slip)
        return done


ON_BEAT = Prompt("RZ-", every_s=1.5)


def test_about_one_take_in_fifteen_is_clumsy_in_each_of_three_ways():
    counted = Counter(Beats(5).slips(3000, ON_BEAT))
    assert 1 - counted[""] / 3000 == pytest.approx(CLUMSY_SHARE, abs=0.015)
    assert set(counted) == {"", "late", "not at all", "another gesture"}


def test_the_seed_says_which_takes_are_clumsy():
    assert Beats(5).slips(200, ON_BEAT) == Beats(5).slips(200, ON_BEAT)
    assert Beats(5).slips(200, ON_BEAT) != Beats(6).slips(200, ON_BEAT)


def test_nobody_is_clumsy_in_a_trial():
    assert set(Beats(5).slips(300, replace(ON_BEAT, is_trial=True))) == {""}


def test_a_beat_that_is_far_away_is_waited_for():
    follower = Beats(5).follower
    assert follower.orders(replace(ON_BEAT, beat_s=20.0), 18.0) == []
    assert follower.orders(replace(ON_BEAT, beat_s=inf), 20.0) == []
