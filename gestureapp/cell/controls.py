"""What a window may ask of the cell: the whole surface between the engine and the Qt shell."""

from typing import Protocol

from gestureapp.cell.events import STOP_WORDS
from gestureapp.cell.snapshot import Snapshot
from gestureapp.config import Settings
from gestureapp.sensing.store import SampleStore


class CellControls(Protocol):
    """The running cell, seen from the window's thread. No call blocks.

    Attributes:
        settings: What the cell was started with.
        left: The left arm's newest samples, for plots.
        right: The right arm's.
    """

    settings: Settings
    left: SampleStore
    right: SampleStore

    def snapshot(self) -> Snapshot:
        """The newest frozen picture of the cell; polled at the display rate."""

    def gui_tick(self) -> None:
        """The window's timer has run. When it does not for too long, the robot is stopped."""

    def arm(self) -> None:
        """The operator has held the arm button long enough."""

    def disarm(self) -> None:
        """The operator takes the permission back; a running move is stopped."""

    def stop(self, why: str = STOP_WORDS) -> None:
        """STOP was pressed, or ``why`` else. Goes straight to the guardian, past every queue."""

    def servo_on(self) -> None:
        """The operator asks for servo power; taken only while not armed."""

    def servo_off(self) -> None:
        """The operator asks for servo power to go off; taken only while not armed."""

    def shutdown(self) -> None:
        """Stop and disarm the robot, close the record, end all threads and children. Idempotent."""
