"""How a trained operator moves both arms for a gesture: timed orders to the emulators. Pure."""

import random
from dataclasses import dataclass, field

from gestureapp.gestures import Gesture, Kind, gesture
from gestureapp.sensing.values import ArmPosture, Side
from gestureapp.simulation.arm import TURN_BACK_S, RightArm, home_after_s, start_seen_after_s
from gestureapp.simulation.people import Person

LEAD_S = 0.05
"""Orders with a time are given this far ahead, so that both reach their emulators before it."""

STOP_HELD_S = 0.6
"""How long the stop posture is held before the next start: the cell wants to see it for 0.5 s."""

SAID_AHEAD_S = 0.7
"""A gesture that begins later than this is announced as waiting."""

QUIET_S = 0.5
"""How long the hand rests between two gestures of a brisk repetition: what a take holds before its
activation is to show rest."""

LEFT_DOWN_FACTOR = 1.1
"""The left arm's turn may take a little longer than its mean."""

RIGHT_BACK_S = TURN_BACK_S * 1.25
"""After this long the right hand is back from a held turn."""


@dataclass(frozen=True, slots=True)
class Order:
    """One command for one emulator; ``command`` as ``sensor_control`` has it."""

    side: Side
    command: dict[str, object]


@dataclass(frozen=True, slots=True)
class Tempo:
    """How quickly gestures follow one another.

    Attributes:
        until_s: The end of a gesture is held until so long after the activation, then the hand goes
            back by itself; None holds a movement as usual and a posture until told.
        back_s: Duration of the way back, where ``until_s`` is given.
        stop_held_s: How long the left arm stays in stop before the next start.
    """

    until_s: float | None = None
    back_s: float = RIGHT_BACK_S
    stop_held_s: float = STOP_HELD_S


USUAL = Tempo()
"""As in operation: slowly back, so that nothing on the way looks like a gesture."""


@dataclass(frozen=True, slots=True)
class Timing:
    """A person's times that a gesture with both arms needs, in s.

    Attributes:
        start_seen_s: From the left arm's start of turning until it is seen in START.
        left_turn_s: Duration of the left arm's turn.
        home_after_s: From the start of a movement until the right hand is back at rest.
        held_lead_s: A roll or pitch begins this long before the activation.
        offset_s: Mean onset of the right arm after the activation; negative is early.
        offset_spread_s: Standard deviation of it.
        movement_s: Duration of a movement.
        turn_s: Duration of a turn about X or Y.
        yaw_s: Duration of a turn about Z.
    """

    start_seen_s: float
    left_turn_s: float
    home_after_s: float
    held_lead_s: float
    offset_s: float
    offset_spread_s: float
    movement_s: float
    turn_s: float
    yaw_s: float

    @classmethod
    def of(cls, person: Person) -> "Timing":
        """The times of this person."""
        return cls(
            start_seen_after_s(person),
            person.left_turn_s,
            home_after_s(person),
            RightArm(person).lead_s("RX+"),
            person.offset_s,
            person.offset_spread_s,
            person.duration_s,
            person.turn_s,
            person.yaw_s,
        )

    def starts_after_s(self, wanted: Gesture, rng: random.Random) -> float:
        """When the right arm begins, after the activation; negative is before it."""
        if _is_held(wanted):
            return -self.held_lead_s
        return rng.gauss(self.offset_s, self.offset_spread_s)

    def duration_s(self, wanted: Gesture) -> float:
        """How long the right arm moves."""
        if wanted.kind is Kind.MOVEMENT:
            return self.movement_s
        return self.turn_s if _is_held(wanted) else self.yaw_s


@dataclass(slots=True)
class OperatorPlan:
    """Knows what both arms were told and says what to tell them next. Owned by one thread.

    Attributes:
        timing: Of the person whose arms these are.
        rng: Chance in the coordination of the arms.
        left: What the left arm was told last, in words.
        right: What the right arm was told last, in words.
        activation_s: When the left arm will be, or was, seen in START for the last gesture.
    """

    timing: Timing
    rng: random.Random = field(default_factory=random.Random)
    left: str = "in stop"
    right: str = "at rest"
    activation_s: float = float("-inf")
    _left_up_s: float | None = None
    """When the left arm begins or began to turn to START; None while it is lowered."""
    _left_down_s: float = float("-inf")
    """From when on the left arm is in STOP."""
    _right_begins_s: float = float("-inf")
    _right_is_turned: bool = False
    _right_home_s: float = float("-inf")
    _home_before_s: float = float("-inf")
    """When the hand is home if the gesture that was ordered last does not begin."""

    def left_start(self, now_s: float) -> list[Order]:
        """The left arm takes the start posture now."""
        self.left = "in start posture"
        self._left_up_s = now_s
        return [Order(Side.LEFT, {"do": "take", "posture": ArmPosture.START.value})]

    def left_stop(self, now_s: float) -> list[Order]:
        """The left arm takes the stop posture; a right hand that is turned or waits rests."""
        orders = self._lower_left(now_s)
        if self._right_is_turned or now_s < self._right_begins_s:
            orders += self.right_rest(now_s)
        return orders

    def right_rest(self, now_s: float) -> list[Order]:
        """Let the right hand go back to rest now."""
        self._forget_unbegun(now_s)
        if self._right_is_turned and now_s >= self._right_begins_s:
            self._right_home_s = now_s + RIGHT_BACK_S
        self._right_is_turned = False
        self._right_begins_s = float("-inf")
        self.right = "at rest"
        return [Order(Side.RIGHT, {"do": "rest"})]

    def gesture(
        self, label: str, now_s: float, tempo: Tempo = USUAL, late_s: float = 0.0
    ) -> list[Order]:
        """Make a gesture with both arms, as soon as they are free for it.

        A raised left arm is lowered first and held in stop long enough to be seen; the right hand
        goes back to rest first. Roll and pitch are held before the left arm rises; everything else
        begins at the moment the left arm is seen in START, plus the person's own offset.

        Args:
            label: Which gesture.
            now_s: Monotonic time.
            tempo: How quickly the arms go back from it, and from the one before to it.
            late_s: The right arm begins only so long after the activation; 0 is as it should.

        Raises:
            KeyError: no gesture has this label.
        """
        wanted = gesture(label)
        self._forget_unbegun(now_s)
        orders = self._lower_left(now_s) if self._is_left_up(now_s) else []
        if self._right_is_turned:
            orders += self.right_rest(now_s)
        after_s = self.timing.starts_after_s(wanted, self.rng)
        ready_s = max(now_s + LEAD_S, self._right_home_s)
        left_s = max(now_s + LEAD_S, self._left_down_s + tempo.stop_held_s)
        self.activation_s = max(left_s + self.timing.start_seen_s, ready_s - after_s)
        left_s = self._left_up_s = self.activation_s - self.timing.start_seen_s
        self.left = "in start posture"
        return [
            *orders,
            Order(Side.LEFT, {"do": "take", "posture": ArmPosture.START.value, "at_s": left_s}),
            self._perform(wanted, self.activation_s, late_s or after_s, tempo),
        ]

    def on_beat(self, label: str, beat_s: float, tempo: Tempo, late_s: float = 0.0) -> list[Order]:
        """Make a gesture with the right arm alone, so that it fits a beat.

        Args:
            label: Which gesture.
            beat_s: When the beat comes, monotonic.
            tempo: How quickly the hand goes back from it.
            late_s: It begins only so long after the beat; 0 is as it should.

        Raises:
            KeyError: no gesture has this label.
        """
        wanted = gesture(label)
        self.activation_s = beat_s
        after_s = self.timing.starts_after_s(wanted, self.rng)
        return [self._perform(wanted, beat_s, late_s or after_s, tempo)]

    def lead_s(self, label: str) -> float:
        """How long before a beat the right arm may have to be told.

        Raises:
            KeyError: no gesture has this label.
        """
        timing = self.timing
        early_s = 4.0 * timing.offset_spread_s - timing.offset_s
        return LEAD_S + (timing.held_lead_s if _is_held(gesture(label)) else max(0.0, early_s))

    def words(self, now_s: float) -> str:
        """What both arms do, or will do and when."""
        wait_s = max(self._left_up_s or now_s, self._right_begins_s) - now_s
        if wait_s > SAID_AHEAD_S:
            return f"In {wait_s:.0f} s, when both arms are free: {self.right}"
        return f"Left arm {self.left}; right arm {self.right}"

    def _perform(self, wanted: Gesture, activation_s: float, after_s: float, tempo: Tempo) -> Order:
        """The right arm's part, and what will be known of it."""
        timing, right_s = self.timing, activation_s + after_s
        command: dict[str, object] = {"do": "perform", "label": wanted.label, "at_s": right_s}
        self._right_begins_s = right_s
        self._home_before_s = self._right_home_s
        self._right_is_turned = wanted.kind is Kind.POSTURE and tempo.until_s is None
        if tempo.until_s is not None:
            hold_s = max(0.0, tempo.until_s - after_s - timing.duration_s(wanted))
            command |= {"hold_s": hold_s, "back_s": tempo.back_s}
            ended_s = right_s + timing.duration_s(wanted) + hold_s
            self._right_home_s = ended_s + tempo.back_s + QUIET_S
        elif not self._right_is_turned:
            self._right_home_s = right_s + timing.home_after_s
        self.right = f"{wanted.label}, {wanted.words}"
        return Order(Side.RIGHT, command)

    def _forget_unbegun(self, now_s: float) -> None:
        """A gesture that is replaced before it begins keeps nobody from home."""
        if now_s < self._right_begins_s:
            self._right_home_s = self._home_before_s

    def _is_left_up(self, now_s: float) -> bool:
        """Whether the left arm is up or will be before another order can reach it."""
        return self._left_up_s is not None and self._left_up_s <= now_s + LEAD_S

    def _lower_left(self, now_s: float) -> list[Order]:
        if self._is_left_up(now_s):
            self._left_down_s = now_s + self.timing.left_turn_s * LEFT_DOWN_FACTOR
        self.left = "in stop posture"
        self._left_up_s = None
        return [Order(Side.LEFT, {"do": "take", "posture": ArmPosture.STOP.value})]


def _is_held(wanted: Gesture) -> bool:
    """Whether the gesture is there before the activation."""
    return wanted.kind is Kind.POSTURE and wanted.axis != 2
