"""The operator's permission, how it is being given, the latch of a stop, and servo power. Pure."""

from gestureapp.robot import messages as m
from gestureapp.robot import nx100
from gestureapp.robot.nx100 import Request
from gestureapp.robot.values import Refusal, StopReason

ARMING_LIMIT_S = 2.0
"""Releasing a hold and reading the state back takes a few answers; longer means it fails."""


class Permission:
    """Whether the robot may move. Owned by the supervisor.

    Attributes:
        is_armed: The operator's permission.
        latch: The stop that has not been left yet, or None.
    """

    def __init__(self) -> None:
        self.is_armed = False
        self.latch: StopReason | None = None
        self._until_s: float | None = None

    @property
    def is_arming(self) -> bool:
        """It was asked for and is neither given nor refused."""
        return self._until_s is not None

    def ask(self, now_s: float) -> None:
        """Begin to arm."""
        self._until_s = now_s + ARMING_LIMIT_S

    def settle(self, refusal: Refusal | None, now_s: float) -> m.Armed | m.ArmRefused | None:
        """Give permission when nothing stands against it, refuse it when that lasts too long."""
        if self._until_s is None:
            return None
        if refusal is None:
            self._until_s = None
            self.is_armed = True
            self.latch = None
            return m.Armed()
        if now_s > self._until_s:
            self._until_s = None
            return m.ArmRefused(refusal)
        return None

    def give_up(self, text: str) -> m.ArmRefused | None:
        """End an arming that is under way."""
        if self._until_s is None:
            return None
        self._until_s = None
        return m.ArmRefused(Refusal("given_up", text))

    def lose(self) -> m.Disarmed | None:
        """Take it back, if it was given."""
        was_armed, self.is_armed = self.is_armed, False
        return m.Disarmed() if was_armed else None


class ServoWish:
    """Now or not at all: servo power never changes later, when nobody expects it.

    Attributes:
        request: SVON 1 or 0, waiting for the line; or None.
    """

    def __init__(self) -> None:
        self.request: Request | None = None

    def ask(self, request: Request, refusal: Refusal | None) -> m.Notice | None:
        """The operator asks; what stands against it is told."""
        self.request = request if refusal is None else None
        if refusal is None:
            return None
        word = "on" if request == nx100.SERVO_ON else "off"
        return m.Notice(f"servo power was not switched {word}: {refusal.text}")

    def cancel(self) -> None:
        """A stop goes before, or the line is lost."""
        self.request = None

    def take(self) -> Request | None:
        """What waits; it does not wait any more."""
        request, self.request = self.request, None
        return request
