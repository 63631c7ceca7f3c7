"""What a window may ask of the cell: the whole surface between the engine and the Qt shell."""

from pathlib import Path
from typing import Protocol

from gestureapp.cell.events import STOP_WORDS
from gestureapp.cell.snapshot import Snapshot
from gestureapp.config import SensorSettings, Settings
from gestureapp.sensing.calibration import Calibration
from gestureapp.sensing.posture import LeftPostures
from gestureapp.sensing.store import SampleStore
from gestureapp.sensing.values import Side

TRAINING_OPEN, SETUP_OPEN = "training is open", "setup is open"
"""Why nothing can be armed while such a page is open; a stop test can begin beside setup."""


class CellControls(Protocol):
    """The running cell, seen from the window's thread. No call blocks.

    Attributes:
        left: The left arm's newest samples, for plots.
        right: The right arm's.
    """

    left: SampleStore
    right: SampleStore

    @property
    def settings(self) -> Settings:
        """In use now."""

    @property
    def postures(self) -> LeftPostures:
        """Of the left arm, in use now."""

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

    def hold_arming(self, why: str) -> None:
        """Something is open beside which nothing can be armed; an empty reason lets arm again.

        What is armed is disarmed; what moves is stopped as by ``disarm``.

        Args:
            why: ``TRAINING_OPEN``, ``SETUP_OPEN``, or empty.
        """

    def use_sensor(self, side: Side, settings: SensorSettings) -> None:
        """Read this arm's sensor from elsewhere, as soon as nothing may move.

        Raises:
            ConfigError: there is no such protocol.
        """

    def use_calibration(self, side: Side, calibration: Calibration) -> None:
        """Take this sensor's own errors out of the samples from now on."""

    def judge_sensor(self, side: Side, problem: str, remedy: str = "") -> None:
        """Say why this sensor must not be armed with; an empty problem means that it may be.

        A sensor that nobody has judged is not calibrated. One that is found unfit while the cell is
        armed disarms it.
        """

    def use_postures(self, postures: LeftPostures, problem: str = "", remedy: str = "") -> None:
        """Take these postures of the left arm, as soon as nothing may move.

        Args:
            postures: Of the person who wears the sensors.
            problem: Why they must not be armed with; empty when they may be.
            remedy: What to do about that.
        """

    def use_settings(self, settings: Settings) -> None:
        """Take the site's, robot's and joints' settings, as soon as nothing may move.

        The guardian is ended and another one started with them; until it has connected to the
        controller nothing can be armed. Sensors, person and simulation stay as they are.

        Raises:
            ConfigError: they contradict each other or a limit; then nothing is changed.
        """

    def begin_stop_test(self, label: str) -> None:
        """Arm, then move at most 20 mm slowly this way, to be stopped with STOP.

        Args:
            label: A movement, as the operator sees it: ``X+``.
        """

    def release_stop_test(self) -> None:
        """The button was let go: a stop test under way is stopped, not measured."""

    def tell(self, text: str) -> None:
        """One line for the cell's story, no alarm."""

    def shutdown(self) -> None:
        """Stop and disarm the robot, close the record, end all threads and children. Idempotent."""
