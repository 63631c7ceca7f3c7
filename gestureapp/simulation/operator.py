"""The virtual operator: turns buttons into what both emulated arms do. No call blocks."""

import random
import threading
from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from gestureapp.clock import Clock, monotonic
from gestureapp.errors import GestureAppError
from gestureapp.gestures import LABELS, gesture
from gestureapp.sensing.values import Side
from gestureapp.simulation.control_link import ControlLink
from gestureapp.simulation.operator_plan import OperatorPlan, Order, Timing
from gestureapp.simulation.prompts import NOTHING, Prompt, PromptFollower
from gestureapp.simulation.sensor_model import FaultKind
from gestureapp.worker import Worker

Address = tuple[str, int]
"""Host and port of an emulator's control port."""

CLUMSY_SEED = 4
"""Which takes are clumsy, and how, where no other seed is given: the same in every demo."""

WISHES_MAX = 64
"""More wishes than this are waiting only if an emulator hangs; the oldest are forgotten."""


@dataclass(frozen=True, slots=True)
class _Wish:
    """Something the panel asked for; a newer one of the same ``kind`` takes its place."""

    kind: str
    orders: Callable[[float], list[Order]]


class OperatorClient:
    """The virtual operator's hands. Start and close it from one thread; the actions from any.

    A thread of its own talks to the emulators. The newest wish wins: a gesture asked for while an
    earlier one still waits takes its place. Trouble never reaches the caller, it stands in
    ``describe``.
    """

    def __init__(
        self,
        left_control: Address,
        right_control: Address,
        timing: Timing,
        clock: Clock = monotonic,
        seed: int | None = None,
        trouble: Callable[[], str] = lambda: "",
    ) -> None:
        """Connect to nothing yet.

        Args:
            left_control: Control port of the left arm's sensor.
            right_control: Control port of the right arm's sensor.
            timing: Of the person whose arms these are.
            clock: Monotonic seconds, the emulators' own clock.
            seed: Chance in the coordination of the arms, and in which takes are clumsy; None
                takes fresh chance, and ``CLUMSY_SEED``.
            trouble: What else is wrong with the emulated cell, in words; empty when nothing is.
        """
        self._clock = clock
        self._trouble = trouble
        self._links = {
            Side.LEFT: ControlLink("left sensor emulator", *left_control),
            Side.RIGHT: ControlLink("right sensor emulator", *right_control),
        }
        self._plan = OperatorPlan(timing, random.Random(seed))
        clumsy = random.Random(CLUMSY_SEED if seed is None else seed)
        self._follower = PromptFollower(self._plan, clumsy)
        self._wishes: deque[_Wish] = deque(maxlen=WISHES_MAX)
        self._changed = threading.Condition()
        self._is_busy = False
        self._faults: dict[Side, str] = {}
        self._troubles: dict[Side, str] = {}
        self._worker = Worker("virtual operator", self._run)

    def start(self) -> None:
        """Start the thread. Once only."""
        self._worker.start()

    def close(self) -> None:
        """End the thread and the connections. Idempotent."""
        self._worker.stopping.set()
        with self._changed:
            self._changed.notify_all()
        self._worker.stop()

    def left_start(self) -> None:
        """The left arm takes the start posture."""
        self._want(_Wish("arms", self._plan.left_start))

    def left_stop(self) -> None:
        """The left arm takes the stop posture; a right hand that holds a turn goes to rest."""
        self._want(_Wish("arms", self._plan.left_stop))

    def gesture(self, label: str) -> None:
        """Make a gesture with both arms together.

        Raises:
            KeyError: no gesture has this label.
        """
        gesture(label)
        self._want(_Wish("arms", lambda now_s: self._plan.gesture(label, now_s)))

    def right_rest(self) -> None:
        """Let the right hand go back to rest."""
        self._want(_Wish("right arm", self._plan.right_rest))

    def follow(self, prompt: Prompt) -> None:
        """Do what stands on the screen; say it again at every refresh, and ``NOTHING`` at the end.

        A prompt that names no gesture is followed by nothing.
        """
        if prompt.label and prompt.label not in LABELS:
            prompt = NOTHING
        self._want(_Wish("prompt", lambda now_s: self._follower.orders(prompt, now_s)))

    def lay(self, side: Side, position: str) -> None:
        """Take a sensor off its arm and lay it down; its arm's next move wears it again.

        Args:
            side: Whose.
            position: ``z-up`` and so on, by the axis that points up.
        """
        order = Order(side, {"do": "lie", "position": position})
        self._want(_Wish(f"lay {side.value}", lambda _: [order]))

    def silence_left(self) -> None:
        """The left sensor sends nothing any more; its port stays open."""
        self.fault(Side.LEFT, FaultKind.SILENT)

    def restore_sensors(self) -> None:
        """End every fault of both sensors."""
        for side in Side:
            self.fault(side, FaultKind.NONE)

    def fault(self, side: Side, kind: FaultKind, **options: float | bool) -> None:
        """Bring a sensor into a fault; ``options`` as the control language has them."""
        command: Mapping[str, object] = {"do": "fault", "kind": kind.value, **options}
        order = Order(side, dict(command))
        self._want(_Wish(f"fault {side.value}", lambda _: [order]))

    def describe(self) -> str:
        """What both arms were told and what is wrong, in one line."""
        with self._changed:
            slip = self._follower.slip
            parts = [f"On purpose: {slip}"] if slip else []
            parts.append(self._plan.words(self._clock()))
            parts += [f"{side.value} sensor {kind}" for side, kind in self._faults.items()]
            trouble = self._trouble()
            if trouble:
                return trouble
            return "; ".join([*parts, *self._troubles.values()])

    def wait_idle(self, limit_s: float) -> bool:
        """Wait until all wishes have been passed on. Returns whether that was within the limit."""
        with self._changed:
            return self._changed.wait_for(
                lambda: not self._wishes and not self._is_busy, timeout=limit_s
            )

    def _want(self, wish: _Wish) -> None:
        with self._changed:
            for waiting in [w for w in self._wishes if w.kind == wish.kind]:
                self._wishes.remove(waiting)
            self._wishes.append(wish)
            self._changed.notify_all()

    def _run(self, stopping: threading.Event) -> None:
        try:
            while True:
                with self._changed:
                    self._is_busy = False
                    self._changed.notify_all()
                    self._changed.wait_for(lambda: stopping.is_set() or self._wishes)
                    if stopping.is_set():
                        return
                    self._is_busy = True
                    wish = self._wishes.popleft()
                    orders = wish.orders(self._clock())
                self._give(orders, stopping)
        finally:
            for link in self._links.values():
                link.close()

    def _give(self, orders: list[Order], stopping: threading.Event) -> None:
        for order in orders:
            if stopping.is_set():
                return
            try:
                self._links[order.side].ask(order.command)
            except GestureAppError as error:
                with self._changed:
                    self._troubles[order.side] = str(error)
                continue
            with self._changed:
                self._troubles.pop(order.side, None)
                self._note_fault(order)

    def _note_fault(self, order: Order) -> None:
        if order.command["do"] != "fault":
            return
        self._faults.pop(order.side, None)
        if order.command["kind"] != FaultKind.NONE.value:
            self._faults[order.side] = str(order.command["kind"])
