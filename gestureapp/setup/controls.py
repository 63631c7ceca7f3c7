"""What a window may ask of setting up: the whole surface between its thread and the shell."""

from collections.abc import Mapping
from typing import Protocol

from gestureapp.recording.person_profile import Handedness
from gestureapp.sensing.values import Side
from gestureapp.setup.site_values import PersonRow, SettingRow
from gestureapp.setup.snapshot import SetupSnapshot


class SetupControls(Protocol):
    """Sensors, calibration, robot, settings and people, seen from the window's thread.

    No call blocks for long. Everything that would change what may move is taken at rest only, and
    said in words when it is not.
    """

    def snapshot(self) -> SetupSnapshot:
        """The newest frozen picture; polled at the display rate."""

    def look(self, is_open: bool) -> None:
        """Setting up is in sight, or no longer. While it is, nothing can be armed.

        The cell's ``hold_arming`` is called before this returns, in the caller's thread: what a
        window holds arming for after that is not let go again by this.
        """

    # Sensors.

    def protocols(self) -> tuple[tuple[str, str], ...]:
        """Name and description of every protocol there is, built-in and plugged in."""

    def choose_port(self, side: Side, port: str, protocol: str) -> None:
        """Read this arm's sensor from there from now on, and remember it."""

    def find_sensors(self) -> None:
        """Try every port and protocol, and list what sends."""

    def stop_finding(self) -> None:
        """End that."""

    def begin_shake(self) -> None:
        """Ask for the left sensor to be shaken, and swap the two if it was the other one."""

    def end_shake(self) -> None:
        """End that; nothing changes."""

    def swap_sensors(self) -> None:
        """The left sensor is the right one, and the other way round."""

    def begin_link_test(self, side: Side) -> None:
        """Measure the link for 30 s."""

    def end_link_test(self) -> None:
        """End it before its time; nothing is kept."""

    # Calibration and postures.

    def begin_calibration(self, side: Side) -> None:
        """Ask for the six positions."""

    def end_calibration(self) -> None:
        """End it before its time; the calibration there was stays."""

    def begin_level_check(self, side: Side) -> None:
        """Check for 2 s that the sensor reads level where it lies."""

    def begin_postures(self) -> None:
        """Record the chosen person's stop posture, then the start posture."""

    def end_postures(self) -> None:
        """End it before its time; what there was stays."""

    def forget_postures(self) -> None:
        """Use the built-in postures for this person."""

    # The robot.

    def choose_robot(self, host: str, port: int) -> str:
        """Connect to this controller from now on, reading only until somebody arms; remember it.

        Returns:
            What is wrong with the address, or empty.
        """

    def begin_stop_test(self, label: str) -> None:
        """The button is held: arm, then move 20 mm slowly this way (``X+`` ...), to be stopped."""

    def release_stop_test(self) -> None:
        """The button was let go: what moves is stopped."""

    # Settings.

    def settings(self) -> tuple[SettingRow, ...]:
        """Every setting with value, meaning, range and origin, in the order of the file."""

    def check_settings(self, changes: Mapping[str, object]) -> Mapping[str, str]:
        """What ``change_settings`` would say to these; nothing is changed, and no file touched."""

    def change_settings(self, changes: Mapping[str, object]) -> Mapping[str, str]:
        """Change these, write them to the user's file, and use them once nothing may move.

        Args:
            changes: New values by dotted name, as a settings file would hold them.

        Returns:
            What is wrong, by name, with the allowed range; empty when all were taken. Then nothing
            at all is changed.
        """

    def open_lock(self, pin: str) -> None:
        """Give the PIN: settings that bear on motion can be changed for ten minutes."""

    def close_lock(self) -> None:
        """Lock them again."""

    def set_pin(self, pin: str) -> str:
        """Set the PIN, or take it away with an empty one; only while open.

        Returns:
            Why not, or empty.
        """

    # People.

    def people(self) -> tuple[PersonRow, ...]:
        """Everybody who has a folder here."""

    def choose_person(self, name: str) -> str:
        """Use this person's model and postures once nothing may move; a new name is new here.

        Returns:
            Why not, or empty.
        """

    def set_handedness(self, name: str, handedness: Handedness) -> str:
        """Note which hand shows the gestures. Returns why not, or empty."""
