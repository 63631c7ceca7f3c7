"""Setting up as the window sees it: wishes in, a frozen picture out, one thread in between.

The thread may wait for the system and for the disk; the window's never does.
"""

import logging
import queue
import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Final

from gestureapp.cell.controls import SETUP_OPEN, CellControls
from gestureapp.clock import Clock, monotonic
from gestureapp.errors import WorkerError
from gestureapp.recording.person_profile import Handedness
from gestureapp.sensing.protocols import protocols
from gestureapp.sensing.values import Side
from gestureapp.setup.desk import Desk
from gestureapp.setup.people_desk import PeopleSource
from gestureapp.setup.settings_desk import SettingsDesk
from gestureapp.setup.site_values import PersonRow, SettingRow
from gestureapp.setup.snapshot import SetupSnapshot
from gestureapp.worker import Worker

log = logging.getLogger(__name__)

TICK_S: Final = 0.02
"""While something is measured."""
OPEN_TICK_S: Final = 0.1
"""While somebody looks."""
IDLE_TICK_S: Final = 0.25
"""Otherwise: often enough to notice a sensor that is not the one it was."""
ENDING_LIMIT_S: Final = 5.0

Wish = Callable[[Desk], None]
"""What the window asks of the thread."""


class Setup:
    """Setting up with its thread; implements ``SetupControls``.

    Args:
        cell: That is set up.
        data: The data folder.
        settings: Reads and writes the settings files; has changed ones used.
        source: What training knows of people.
        clock: Monotonic seconds.
        wall_clock: Seconds since the epoch.
    """

    def __init__(
        self,
        cell: CellControls,
        data: Path,
        settings: SettingsDesk,
        source: PeopleSource | None = None,
        clock: Clock = monotonic,
        wall_clock: Clock = time.time,
    ) -> None:
        self._cell, self._settings = cell, settings
        people = source or PeopleSource()
        self._desk = Desk(cell, data, settings.use_sensors, people, clock, wall_clock)
        self._wishes: queue.SimpleQueue[Wish] = queue.SimpleQueue()
        self._is_open = False
        self._worker = Worker("setup", self._run, self._ended)

    def start_thread(self) -> None:
        """Start the thread. Once only."""
        self._worker.start()

    def shutdown(self) -> None:
        """End the thread and whatever is under way; nothing of it is kept. Idempotent."""
        self._worker.stop(ENDING_LIMIT_S)

    def snapshot(self) -> SetupSnapshot:
        """The newest frozen picture; polled at the display rate."""
        picture, error = self._desk.picture, self._worker.error
        lock, findings = self._settings.lock, self._settings.findings
        trouble = picture.trouble if error is None else _words(error)
        return replace(picture, lock=lock, findings=findings, trouble=trouble)

    def look(self, is_open: bool) -> None:
        """Setting up is in sight, or no longer; while it is, nothing can be armed."""
        if is_open is not self._is_open:
            self._is_open = is_open
            self._cell.hold_arming(SETUP_OPEN if is_open else "")
        self._wishes.put(lambda desk: desk.look(is_open))

    # Sensors.

    def protocols(self) -> tuple[tuple[str, str], ...]:
        """Name and description of every protocol there is, built-in and plugged in."""
        return tuple((known.name, known.words) for known in protocols())

    def choose_port(self, side: Side, port: str, protocol: str) -> None:
        """Read this arm's sensor from there from now on, and remember it."""
        self._wishes.put(lambda desk: desk.choose_port(side, port, protocol))

    def find_sensors(self) -> None:
        """Try every port and protocol, and list what sends."""
        self._wishes.put(Desk.find_sensors)

    def stop_finding(self) -> None:
        """End that."""
        self._wishes.put(Desk.stop_finding)

    def begin_shake(self) -> None:
        """Ask for the left sensor to be shaken, and swap the two if it was the other one."""
        self._wishes.put(Desk.begin_shake)

    def end_shake(self) -> None:
        """End that; nothing changes."""
        self._wishes.put(lambda desk: desk.measuring.end_shake())

    def swap_sensors(self) -> None:
        """The left sensor is the right one, and the other way round."""
        self._wishes.put(Desk.swap_sensors)

    def begin_link_test(self, side: Side) -> None:
        """Measure the link for 30 s."""
        self._wishes.put(lambda desk: desk.begin_link_test(side))

    def end_link_test(self) -> None:
        """End it before its time; nothing is kept."""
        self._wishes.put(lambda desk: desk.measuring.end_link_test())

    # Calibration and postures.

    def begin_calibration(self, side: Side) -> None:
        """Ask for the six positions."""
        self._wishes.put(lambda desk: desk.begin_calibration(side))

    def end_calibration(self) -> None:
        """End it before its time; the calibration there was stays."""
        self._wishes.put(lambda desk: desk.measuring.end_calibration())

    def begin_level_check(self, side: Side) -> None:
        """Check for 2 s that the sensor reads level where it lies."""
        self._wishes.put(lambda desk: desk.begin_level_check(side))

    def begin_postures(self) -> None:
        """Record the chosen person's stop posture, then the start posture."""
        self._wishes.put(Desk.begin_postures)

    def end_postures(self) -> None:
        """End it before its time; what there was stays."""
        self._wishes.put(lambda desk: desk.measuring.end_postures())

    def forget_postures(self) -> None:
        """Use the built-in postures for this person."""
        self._wishes.put(Desk.forget_postures)

    # The robot.

    def choose_robot(self, host: str, port: int) -> str:
        """Connect to this controller from now on; remember it. Returns what is wrong, or empty."""
        wrong = self.change_settings({"robot.host": host, "robot.port": port})
        return "; ".join(wrong.values())

    def begin_stop_test(self, label: str) -> None:
        """The button is held: arm, then move 20 mm slowly this way, to be stopped."""
        self._cell.begin_stop_test(label)

    def release_stop_test(self) -> None:
        """The button was let go: what moves is stopped."""
        self._cell.release_stop_test()

    # Settings.

    def settings(self) -> tuple[SettingRow, ...]:
        """Every setting with value, meaning, range and origin, in the order of the file."""
        return self._settings.settings()

    def check_settings(self, changes: Mapping[str, object]) -> Mapping[str, str]:
        """What ``change_settings`` would say to these; nothing is changed."""
        return self._settings.check_settings(changes)

    def change_settings(self, changes: Mapping[str, object]) -> Mapping[str, str]:
        """Change these, write them to the user's file, and use them once nothing may move."""
        return self._settings.change_settings(changes)

    def open_lock(self, pin: str) -> None:
        """Give the PIN: settings that bear on motion can be changed for ten minutes."""
        self._wishes.put(lambda desk: self._settings.open_lock(pin))

    def close_lock(self) -> None:
        """Lock them again."""
        self._settings.close_lock()

    def set_pin(self, pin: str) -> str:
        """Set the PIN, or take it away with an empty one. Returns why not, or empty.

        What the disk says against it stands in the picture's ``lock``.
        """
        if not (why_not := self._settings.why_not_pin(pin)):
            self._wishes.put(lambda desk: self._pin_set(pin))
        return why_not

    # People.

    def people(self) -> tuple[PersonRow, ...]:
        """Everybody who has a folder here."""
        return self._desk.people.rows

    def choose_person(self, name: str) -> str:
        """Use this person's model and postures once nothing may move. Returns why not, or empty."""
        why_not = self._desk.people.why_not(name)
        if not why_not:
            self._wishes.put(lambda desk: desk.choose_person(name))
        return why_not

    def set_handedness(self, name: str, handedness: Handedness) -> str:
        """Note which hand shows the gestures. Returns why not, or empty."""
        people = self._desk.people
        why_not = people.why_not(name) or people.why_not_hand(name)
        if not why_not:
            self._wishes.put(lambda desk: desk.set_handedness(name, handedness))
        return why_not

    # The thread.

    def _pin_set(self, pin: str) -> None:
        self._settings.set_pin(pin)

    def _run(self, stopping: threading.Event) -> None:
        desk = self._desk
        try:
            while not stopping.is_set():
                self._grant(_wait_s(desk))
                desk.step()
        finally:
            desk.close()

    def _grant(self, wait_s: float) -> None:
        """Wait for a wish at most so long, and fulfil it."""
        try:
            wish = self._wishes.get(timeout=wait_s)
        except queue.Empty:
            return
        try:
            wish(self._desk)
        except Exception as error:  # one wish that fails must not take all the others with it
            log.exception("a wish of setting up failed")
            self._desk.say(f"that failed ({type(error).__name__}); the log says more, try again")

    def _ended(self, error: WorkerError) -> None:
        """Nobody sees any more whether the sensors are still the same: unknown is not ready."""
        for side in Side:
            self._cell.judge_sensor(side, _words(error), "restart the application")


def _wait_s(desk: Desk) -> float:
    if desk.is_busy:
        return TICK_S
    return OPEN_TICK_S if desk.is_open else IDLE_TICK_S


def _words(error: WorkerError) -> str:
    return f"{error}; restart the application"
