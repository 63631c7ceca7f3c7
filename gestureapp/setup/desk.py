"""What the setup thread drives: sensors, measurements, robot and people, and their one picture.

No thread of its own, and its clocks are passed in: tests hold the time in their hand.
"""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Final

from gestureapp.cell.controls import CellControls
from gestureapp.cell.snapshot import CellState, Snapshot
from gestureapp.clock import Clock
from gestureapp.errors import GestureAppError
from gestureapp.recording.person_profile import Handedness
from gestureapp.sensing.protocols import protocols
from gestureapp.sensing.values import LinkState, Side, StreamHealth
from gestureapp.setup.finding import Finder, found_in_use
from gestureapp.setup.measuring import Measuring
from gestureapp.setup.people_desk import PeopleDesk, PeopleSource, start_stop_arm
from gestureapp.setup.port_watch import PortWatch
from gestureapp.setup.robot_desk import RobotDesk
from gestureapp.setup.sensors import Remember, Sensors
from gestureapp.setup.snapshot import SetupSnapshot
from gestureapp.setup.values import Check, FoundSensor, PortChoice, PosturesView, SensorCard

AT_REST: Final = (CellState.NOT_READY, CellState.READY, CellState.STOPPED)
"""Nothing may move: only then sensors change sides."""
NOT_ARMED: Final = "Not while the cell is armed: disarm first."


class Desk:
    """What the thread owns. No thread of its own.

    Args:
        cell: That is set up.
        data: The data folder.
        remember: Keeps settings for the next start.
        source: What training knows of people.
        clock: Monotonic seconds.
        wall_clock: Seconds since the epoch.
        watch: Looks at the ports.
        finder: Tries ports.

    Attributes:
        picture: The newest; any thread.
        people: Everybody who has a folder here.
        sensors: Both arms'.
        measuring: What is under way.
    """

    def __init__(
        self,
        cell: CellControls,
        data: Path,
        remember: Remember,
        source: PeopleSource,
        clock: Clock,
        wall_clock: Clock,
        watch: PortWatch | None = None,
        finder: Finder | None = None,
    ) -> None:
        self._cell, self._clock, self._wall_clock = cell, clock, wall_clock
        self.sensors = Sensors(cell, data, remember, watch)
        self.people = PeopleDesk(cell, data, source)
        self.measuring = Measuring(
            cell, self.sensors.arms, data, self._shaken, self._postures_changed
        )
        self._robot = RobotDesk(cell, data)
        self._finder = finder or Finder(clock, protocols)
        self._is_open = False
        self._trouble = ""
        self.picture = self._draw(cell.snapshot(), clock())

    @property
    def is_busy(self) -> bool:
        """Something is measured: every tick counts."""
        return self.measuring.is_on

    @property
    def is_open(self) -> bool:
        """Somebody looks."""
        return self._is_open

    def step(self) -> None:
        """One tick: look at the cell, let what is measured go on, draw the picture."""
        now_s, wall_s = self._clock(), self._wall_clock()
        picture = self._cell.snapshot()
        health = _health(picture)
        is_at_rest = picture.state in AT_REST
        if self.measuring.is_on and not is_at_rest:
            self.measuring.end()
        self.measuring.step(now_s, wall_s, health)
        self.sensors.look(now_s, wall_s, health, is_open=self._is_open, is_at_rest=is_at_rest)
        self.people.follow(picture.person, wall_s)
        self.picture = self._draw(picture, now_s)

    def close(self) -> None:
        """End everything that is under way. Idempotent."""
        self._finder.stop()
        self.measuring.end()

    def look(self, is_open: bool) -> None:
        """Somebody looks, or nobody does any more: then nothing is measured or searched."""
        self._is_open = is_open
        if is_open:
            self.people.look(self._wall_clock())
        else:
            self.close()

    def say(self, trouble: str) -> None:
        """Show what went wrong, until something else is wished for."""
        self._trouble = trouble

    # Wishes on sensors.

    def choose_port(self, side: Side, port: str, protocol: str) -> None:
        """Read this arm's sensor from there from now on."""
        if self._refuse():
            return
        self._finder.stop()
        self._try(lambda: self.sensors.choose(side, port.strip(), protocol))

    def find_sensors(self) -> None:
        """Try every port that the cell does not read."""
        self.measuring.end()
        self._finder.start(self.sensors.free_ports(), self._in_use())

    def stop_finding(self) -> None:
        """End that."""
        self._finder.stop()

    def begin_shake(self) -> None:
        """Ask for the left sensor to be shaken."""
        if self._is_armed():
            self.measuring.refuse_shake(NOT_ARMED)
        else:
            self.measuring.begin_shake(self._clock(), self._start_stop_arm())

    def swap_sensors(self) -> None:
        """The left sensor is the right one from now on."""
        if not self._refuse():
            self._try(self.sensors.swap)

    def begin_link_test(self, side: Side) -> None:
        """Measure this arm's link."""
        health = _health(self._cell.snapshot())[side]
        self.measuring.begin_link_test(side, self._clock(), health)

    def begin_calibration(self, side: Side) -> None:
        """Ask for the six positions."""
        if not self._refuse():
            self.measuring.begin_calibration(side, self._clock())

    def begin_level_check(self, side: Side) -> None:
        """Check that the sensor reads level."""
        self.measuring.begin_level_check(side)

    def begin_postures(self) -> None:
        """Record the chosen person's postures."""
        self.measuring.begin_postures(self.people.person, self._start_stop_arm())

    def forget_postures(self) -> None:
        """Use the built-in postures."""
        self.measuring.end_postures()
        self._trouble = self.people.forget_postures()
        self._postures_changed()

    # Wishes on people.

    def choose_person(self, name: str) -> None:
        """Use this person's model and postures."""
        self._try(lambda: self.people.choose(name))
        self.people.look(self._wall_clock())

    def set_handedness(self, name: str, handedness: Handedness) -> None:
        """Note which hand shows the gestures."""
        self._trouble = self.people.set_handedness(name, handedness)
        self.people.look(self._wall_clock())

    # Parts.

    def _shaken(self, side: Side) -> None:
        if side is Side.RIGHT:
            self.swap_sensors()
        else:
            self.sensors.confirm()

    def _postures_changed(self) -> None:
        self.people.use_postures()
        self.people.look(self._wall_clock())

    def _is_armed(self) -> bool:
        return self._cell.snapshot().state not in AT_REST

    def _refuse(self) -> bool:
        """Say that this is not done now, if it is not."""
        is_armed = self._is_armed()
        self._trouble = NOT_ARMED if is_armed else ""
        return is_armed

    def _try(self, act: Callable[[], None]) -> None:
        try:
            act()
        except GestureAppError as error:
            self._trouble = str(error)
        else:
            self._trouble = ""

    def _postures(self) -> PosturesView:
        """What is being recorded, or what came of it as long as it is the same person."""
        recorded, person = self.measuring.postures, self.people.person
        is_newest = recorded.outcome.check is not Check.NOT_RUN and recorded.person == person
        if not is_newest:
            return self.people.postures_view()
        if recorded.is_on:
            return recorded
        kept = self.people.postures_view()
        return replace(recorded, problem=kept.problem, remedy=kept.remedy)

    def _in_use(self) -> tuple[FoundSensor, ...]:
        """What sends already, from the cards: its port is not free to be tried."""
        ports = {port.url: port for port in self.sensors.ports()}
        cards = (self.picture.left, self.picture.right)
        return tuple(
            found_in_use(card, ports.get(card.port) or PortChoice(card.port, card.port))
            for card in cards
            if card.port and card.health.link is LinkState.RECEIVING
        )

    def _start_stop_arm(self) -> str:
        return start_stop_arm(self.people.handedness)

    def _card(self, side: Side, health: StreamHealth, wall_s: float) -> SensorCard:
        card = self.sensors.card(side, health, wall_s)
        if self.people.handedness is Handedness.RIGHT:
            return card
        return replace(card, arm="right" if side is Side.LEFT else "left")

    def _draw(self, picture: Snapshot, now_s: float) -> SetupSnapshot:
        health, wall_s = _health(picture), self._wall_clock()
        robot, stop_test = self._robot.look(picture)
        measuring = self.measuring
        troubles = (self._trouble, self.sensors.trouble, self._robot.trouble)
        return SetupSnapshot(
            t_s=now_s,
            left=self._card(Side.LEFT, health[Side.LEFT], wall_s),
            right=self._card(Side.RIGHT, health[Side.RIGHT], wall_s),
            robot=robot,
            ports=self.sensors.ports(),
            finding=self._finder.view,
            shake=measuring.shake,
            link_test=measuring.link_test,
            calibration=measuring.calibration,
            level=measuring.level,
            postures=self._postures(),
            stop_test=stop_test,
            trouble="; ".join(text for text in troubles if text),
        )


def _health(picture: Snapshot) -> dict[Side, StreamHealth]:
    return {Side.LEFT: picture.left, Side.RIGHT: picture.right}
