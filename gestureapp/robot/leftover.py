"""The rest of an interrupted move that a controller may keep, and how it is discarded. Pure.

Whether HOLD 0 goes on with an interrupted move is documented nowhere. A controller that does so is
seen once: the robot runs after a release, and is held again. From then on every interrupted move
counts as kept, its hold is not released, and nothing is armed until servo power was read back off
or the pendant in TEACH: both are expected to discard what is left of a move.
"""

from gestureapp.robot.values import Refusal, RobotStatus

_KEPT = Refusal(
    "move_kept",
    "the controller goes on with the interrupted move as soon as its hold is released",
)


class Leftover:
    """What the controller is taken to keep. Owned by the supervisor.

    Attributes:
        is_kept: There is the rest of a move; releasing the hold would run it.
    """

    def __init__(self) -> None:
        self.is_kept = False
        self._goes_on = False

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
