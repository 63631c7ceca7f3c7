"""Calibrate: six positions of each sensor, the level check, and the left arm's postures."""

from PySide6.QtWidgets import QWidget

from gestureapp.cell.snapshot import Snapshot
from gestureapp.sensing.values import Side
from gestureapp.setup.controls import SetupControls
from gestureapp.setup.values import SetupSnapshot


class CalibrateStep(QWidget):
    """One sensor, or the postures, at a time. GUI thread only."""

    def __init__(self, setup: SetupControls, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("setupCalibrateStep")
        self._setup = setup
        self._side = Side.LEFT

    def show_snapshot(self, setup: SetupSnapshot, cell: Snapshot) -> None:
        """Show another moment."""

    def choose_side(self, side: Side) -> None:
        """Show this arm's sensor."""
        self._side = side

    def leave(self) -> None:
        """The step goes out of sight."""
