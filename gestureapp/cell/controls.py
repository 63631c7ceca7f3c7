"""What a window may ask of the cell: the whole surface between the engine and the Qt shell."""

from pathlib import Path
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

    def use_model(self, path: Path | None, problem: str = "", person: str = "") -> None:
        """Recognise with another model, as soon as nothing may move.

        Args:
            path: A model file, or None when the person has none but the settings'. When it cannot
                be used, nothing can be armed, and it is said why.
            problem: Why it is out of date, so that nothing can be armed with it; empty when not.
            person: Whose arms it is for; empty when the model says so itself.
        """

    def hold_for_training(self, is_open: bool) -> None:
        """Training is open, or closed again. While it is open nothing can be armed.

        What is armed is disarmed; what moves is stopped as by ``disarm``.
        """

    def shutdown(self) -> None:
        """Stop and disarm the robot, close the record, end all threads and children. Idempotent."""
