"""What the supervisor wants done, in its order: bytes, dropped links, words for the cell. Pure."""

from gestureapp.robot import messages as m
from gestureapp.robot.nx100 import Request
from gestureapp.robot.outputs import DropRobot, Output, ToApp, ToRobot
from gestureapp.robot.values import Refusal


class Outbox:
    """Collects outputs until the loop takes them. Owned by the supervisor.

    Attributes:
        link: The last word on the line to the controller.
        hindrances: What stands against arming, as last told.
    """

    def __init__(self) -> None:
        self.link = m.LinkReport(False, "not connected yet")
        self.hindrances: tuple[Refusal, ...] = ()
        self._outputs: list[Output] = []
        self._refused: dict[Request, str] = {}

    def take(self) -> list[Output]:
        """Everything since the last time, oldest first."""
        outputs, self._outputs = self._outputs, []
        return outputs

    def send(self, data: bytes) -> None:
        """Bytes for the controller, if there are any."""
        if data:
            self._outputs.append(ToRobot(data))

    def drop(self, reason: str) -> None:
        """The line to the controller cannot be trusted any more."""
        self._outputs.append(DropRobot(reason))
        self.tell_link(False, reason)

    def tell(self, *messages: m.FromGuardian | None) -> None:
        """Words for the application; None is nothing to say."""
        self._outputs += [ToApp(message) for message in messages if message is not None]

    def tell_link(self, is_open: bool, text: str, remedy: str = "") -> None:
        """The line to the controller is open, or why not and what to do about it."""
        self.link = m.LinkReport(is_open, text, remedy)
        self.tell(self.link)

    def tell_hindrances(self, *found: Refusal | None) -> None:
        """What stands against arming; told when it changes. None is nothing."""
        refusals = tuple(refusal for refusal in found if refusal is not None)
        if refusals != self.hindrances:
            self.hindrances = refusals
            self.tell(m.Hindrances(refusals))

    def tell_refused(self, request: Request, text: str) -> None:
        """The controller refuses a request: said once, until it takes it again."""
        if self._refused.get(request) != text:
            self._refused[request] = text
            self.tell(m.Notice(text))

    def forget_refused(self, request: Request) -> None:
        """The controller has taken it."""
        self._refused.pop(request, None)
