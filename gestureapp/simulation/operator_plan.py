"""How a trained operator moves both arms for a gesture: timed orders to the emulators. Pure."""

import random
from dataclasses import dataclass, field

from gestureapp.gestures import Kind, gesture
from gestureapp.sensing.values import ArmPosture, Side
from gestureapp.simulation.arm import TURN_BACK_S, RightArm, home_after_s, start_seen_after_s
from gestureapp.simulation.people import Person

LEAD_S = 0.05
"""Orders with a time are given this far ahead, so that both reach their emulators before it."""

STOP_HELD_S = 0.6
"""How long the stop posture is held before the next start: the cell wants to see it for 0.5 s."""

SAID_AHEAD_S = 0.7
"""A gesture that begins later than this is announced as waiting."""

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
class Timing:
    """A person's times that a gesture with both arms needs, in s.

    Attributes:
        start_seen_s: From the left arm's start of turning until it is seen in START.
        left_turn_s: Duration of the left arm's turn.
        home_after_s: From the start of a movement until the right hand is back at rest.
        held_lead_s: A roll or pitch begins this long before the activation.
        offset_s: Mean onset of the right arm after the activation; negative is early.
        offset_spread_s: Standard deviation of it.
    """

    start_seen_s: float
    left_turn_s: float
    home_after_s: float
    held_lead_s: float
    offset_s: float
    offset_spread_s: float

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
        )


@dataclass(slots=True)
class OperatorPlan:
    """Knows what both arms were told and says what to tell them next. Owned by one thread.

    Attributes:
        timing: Of the person whose arms these are.
        rng: Chance in the coordination of the arms.
        left: What the left arm was told last, in words.
        right: What the right arm was told last, in words.
    """

    timing: Timing
    rng: random.Random = field(default_factory=random.Random)
    left: str = "in stop"
    right: str = "at rest"
    _left_up_s: float | None = None
    """When the left arm begins or began to turn to START; None while it is lowered."""
    _left_seen_down_s: float = float("-inf")
    """From when on the left arm has been in STOP for long enough."""
    _right_begins_s: float = float("-inf")
    _right_is_turned: bool = False
    _right_home_s: float = float("-inf")
    _home_before_s: float = float("-inf")
    """When the hand is home if the gesture that was ordered last does not begin."""

    def left_start(self, now_s: float) -> list[Order]:
        """Raise the left arm now."""
        self.left = "raised: start"
        self._left_up_s = now_s
        return [Order(Side.LEFT, {"do": "take", "posture": ArmPosture.START.value})]

    def left_stop(self, now_s: float) -> list[Order]:
        """Lower the left arm now; a right hand that is turned or has not begun goes to rest."""
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

    def gesture(self, label: str, now_s: float) -> list[Order]:
        """Make a gesture with both arms, as soon as they are free for it.

        A raised left arm is lowered first and held in stop long enough to be seen; the right hand
        goes back to rest first. Roll and pitch are held before the left arm rises; everything else
        begins at the moment the left arm is seen in START, plus the person's own offset.

        Raises:
            KeyError: no gesture has this label.
        """
        wanted = gesture(label)
        self._forget_unbegun(now_s)
        orders = self._lower_left(now_s) if self._is_left_up(now_s) else []
        if self._right_is_turned:
            orders += self.right_rest(now_s)
        ready_s = max(now_s + LEAD_S, self._right_home_s)
        left_s = max(now_s + LEAD_S, self._left_seen_down_s)
        if wanted.kind is Kind.POSTURE and wanted.axis != 2:
            activation_s = max(left_s + self.timing.start_seen_s, ready_s + self.timing.held_lead_s)
            right_s = activation_s - self.timing.held_lead_s
        else:
            offset_s = self.rng.gauss(self.timing.offset_s, self.timing.offset_spread_s)
            activation_s = max(left_s + self.timing.start_seen_s, ready_s - offset_s)
            right_s = activation_s + offset_s
        left_s = activation_s - self.timing.start_seen_s
        self._left_up_s, self._right_begins_s = left_s, right_s
        self._right_is_turned = wanted.kind is Kind.POSTURE
        self._home_before_s = self._right_home_s
        if not self._right_is_turned:
            self._right_home_s = right_s + self.timing.home_after_s
        self.left, self.right = "raised: start", f"{label}, {wanted.words}"
        start = ArmPosture.START.value
        return [
            *orders,
            Order(Side.LEFT, {"do": "take", "posture": start, "at_s": left_s}),
            Order(Side.RIGHT, {"do": "perform", "label": label, "at_s": right_s}),
        ]

    def words(self, now_s: float) -> str:
        """What both arms do, or will do and when."""
        wait_s = max(self._left_up_s or now_s, self._right_begins_s) - now_s
        if wait_s > SAID_AHEAD_S:
            return f"In {wait_s:.0f} s, when both arms are free: {self.right}"
        return f"Left arm {self.left}; right arm {self.right}"

    def _forget_unbegun(self, now_s: float) -> None:
        """A gesture that is replaced before it begins keeps nobody from home."""
        if now_s < self._right_begins_s:
            self._right_home_s = self._home_before_s

    def _is_left_up(self, now_s: float) -> bool:
        """Whether the left arm is up or will be before another order can reach it."""
        return self._left_up_s is not None and self._left_up_s <= now_s + LEAD_S

    def _lower_left(self, now_s: float) -> list[Order]:
        if self._is_left_up(now_s):
            down_s = now_s + self.timing.left_turn_s * LEFT_DOWN_FACTOR
            self._left_seen_down_s = down_s + STOP_HELD_S
        self.left = "lowered: stop"
        self._left_up_s = None
        return [Order(Side.LEFT, {"do": "take", "posture": ArmPosture.STOP.value})]
