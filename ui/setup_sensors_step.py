"""Sensors: where each arm's sensor is, how its stream is, and what to do when it is not well."""

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QWidget

from gestureapp.cell.controls import CellControls
from gestureapp.cell.snapshot import Snapshot
from gestureapp.sensing.values import Side
from gestureapp.setup.controls import SetupControls
from gestureapp.setup.values import SetupSnapshot


class SetupSensorsStep(QWidget):
    """Both arms' sensors. GUI thread only.

    Signals:
        calibration_wanted: The person wants to calibrate the sensor of this ``Side``.
    """

    calibration_wanted = Signal(Side)

    def __init__(
        self, cell: CellControls, setup: SetupControls, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.setObjectName("setupSensorsStep")
        self._cell, self._setup = cell, setup

    def show_snapshot(self, setup: SetupSnapshot, cell: Snapshot) -> None:
        """Show another moment."""

    def leave(self) -> None:
        """The step goes out of sight."""
