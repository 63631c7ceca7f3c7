"""The rest of an interrupted move that a controller may keep, and how it is discarded. Pure.

Whether HOLD 0 goes on with an interrupted move is documented nowhere. A controller that does so is
seen once: the robot runs after a release, and is held again. From then on every interrupted move
counts as kept, its hold is not released, and nothing is armed until servo power was read back off
or the pendant in TEACH: both are expected to discard what is left of a move.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from gestureapp.robot.values import Refusal, RobotStatus

MOVE_KEPT = "move_kept"
_KEPT = Refusal(
    MOVE_KEPT,
    "the controller goes on with the interrupted move as soon as its hold is released",
)


@dataclass(frozen=True, slots=True)
class KeptMoves:
    """What one guardian has learned of a controller, for the next one.

    Attributes:
        goes_on: It was seen to go on with an interrupted move.
        is_kept: There is the rest of a move, or there may be.
    """

    goes_on: bool = False
    is_kept: bool = False

    def after(self, refusals: Sequence[Refusal]) -> "KeptMoves":
        """The same once a guardian has told what stands against arming."""
        is_kept = any(refusal.reason == MOVE_KEPT for refusal in refusals)
        return KeptMoves(self.goes_on or is_kept, is_kept)

    def unattended(self) -> "KeptMoves":
        """The same once a guardian has gone without a word: a move of its may have been cut off."""
        return KeptMoves(self.goes_on, self.goes_on)


class Leftover:
    """What the controller is taken to keep. Owned by the supervisor.

    Args:
        known: From a guardian before.

    Attributes:
        is_kept: There is the rest of a move; releasing the hold would run it.
    """

    def __init__(self, known: KeptMoves) -> None:
        self.is_kept = known.is_kept
        self._goes_on = known.goes_on

    @property
    def refusal(self) -> Refusal | None:
        """Why it stands against arming."""
        return _KEPT if self.is_kept else None

    def went_on(self) -> None:
        """The robot ran after a release: this controller keeps interrupted moves."""
        self._goes_on = self.is_kept = True

    def interrupted(self) -> None:
        """A move of ours was stopped before its end."""
        self.is_kept = self._goes_on

    def note_status(self, status: RobotStatus) -> None:
        """Servo power off, or the pendant in TEACH, discards it."""
        if status.is_teach or not status.is_servo_on:
            self.is_kept = False
