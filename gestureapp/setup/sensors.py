"""Both arms' sensors: which is where, who belongs on which arm, whether they may be armed with."""

from collections.abc import Callable, Mapping
from pathlib import Path

from gestureapp.cell.controls import CellControls
from gestureapp.config import SensorSettings, Settings
from gestureapp.errors import ConfigError, GestureAppError
from gestureapp.sensing.ports import is_same_port
from gestureapp.sensing.values import Side, StreamHealth
from gestureapp.settings_check import why_out_of_range
from gestureapp.settings_values import short
from gestureapp.setup.arm_sensor import ArmSensor
from gestureapp.setup.port_watch import PortWatch
from gestureapp.setup.sides import SAME_PORT, Sides, find_swapped, load_sides, save_sides
from gestureapp.setup.values import PortChoice, SensorCard

Remember = Callable[[Mapping[str, object]], Mapping[str, str]]
"""Has these settings used, by dotted name, and writes them into the user's file; else why not."""


class Sensors:
    """Follows both sensors. Owned by the setup thread.

    Args:
        cell: Whose sensors.
        data: The data folder.
        remember: Keeps a chosen port for the next start, and has it used.
        watch: Looks at the ports.

    Attributes:
        arms: Each arm's sensor.
        trouble: Why something could not be kept; empty when everything was.
    """

    def __init__(
        self, cell: CellControls, data: Path, remember: Remember, watch: PortWatch | None = None
    ) -> None:
        self._cell, self._data, self._remember = cell, data, remember
        self._watch = watch or PortWatch()
        self.arms = {side: ArmSensor(side, cell, data) for side in Side}
        self._sides, damage = load_sides(data)
        if damage:
            cell.tell(damage)
        self._judged_s = 0.0
        self._asked: dict[Side, SensorSettings] = {}
        self._to_tell: list[tuple[dict[Side, SensorSettings], str]] = []
        self.trouble = damage

    def look(
        self,
        now_s: float,
        wall_s: float,
        health: dict[Side, StreamHealth],
        *,
        is_open: bool,
        is_at_rest: bool = True,
    ) -> None:
        """Find out who is there, and tell the cell what may be armed with.

        Args:
            now_s: Monotonic clock.
            wall_s: Seconds since the epoch.
            health: Of each arm's stream.
            is_open: Somebody watches.
            is_at_rest: Nothing may move. Otherwise nothing gets out of date: no hour that strikes
                stops a robot on its way, but a sensor that is not the one it was does.
        """
        self._judged_s = wall_s if is_at_rest else self._judged_s
        streams = {side: (self._port_of(side), health[side]) for side in Side}
        self._watch.look(now_s, streams, is_open=is_open)
        for side, arm in self.arms.items():
            self._wanted(side)
            arm.look(now_s, health[side], self._watch.port(self._port_of(side)))
        self._tell()
        self._adopt(now_s)
        wrong_sides = self._wrong_sides()
        for arm in self.arms.values():
            arm.judge(self._judged_s, wrong_sides)

    def card(self, side: Side, health: StreamHealth, wall_s: float) -> SensorCard:
        """One arm's sensor for the window."""
        return self.arms[side].card(health, self._watch.advice[side], wall_s)

    def ports(self) -> tuple[PortChoice, ...]:
        """Of this machine, and those that are in use."""
        return self._watch.choices(tuple(self._port_of(side) for side in Side))

    def free_ports(self) -> tuple[PortChoice, ...]:
        """Those that can be tried without taking one from the cell."""
        return self._watch.free(tuple(self._port_of(side) for side in Side))

    def choose(self, side: Side, port: str, protocol: str) -> None:
        """Read this arm's sensor from there, and remember it; who is there then belongs there.

        Raises:
            ConfigError: there is no such protocol, this is no text for a port, or the other arm
                reads it.
        """
        if why := self._why_not(side, port):
            raise ConfigError(f"{side.value}.port", short(port), why)
        known = next((found for found in self.ports() if found.url == port), None)
        before = self.arms[side].settings
        name = before.name if before.port == port else ""
        said = f"{side.value} sensor: {known.name if known else port}, {protocol}"
        self._use({side: SensorSettings(port, protocol, name)}, said)
        self._sides = self._sides.assigned(side, "")
        self._save_sides()

    def swap(self) -> None:
        """The left sensor is the right one from now on, and the other way round."""
        left, right, seen = self._wanted(Side.LEFT), self._wanted(Side.RIGHT), self._seen()
        self._use({Side.LEFT: right, Side.RIGHT: left}, "left and right sensor are swapped")
        self._sides = seen.swapped()
        self._save_sides()

    def confirm(self) -> None:
        """They are assigned rightly as they are: a person has shown it."""
        self._sides, self.trouble = self._seen(), ""
        self._save_sides()

    def _why_not(self, side: Side, port: str) -> str:
        other = Side.RIGHT if side is Side.LEFT else Side.LEFT
        if is_same_port(port, self._wanted(other).port):
            choose = f"choose another port, or another one for the {other.value} arm first"
            return f"the {other.value} arm reads it: press Swap, {choose}"
        return why_out_of_range(SensorSettings, "port", port)

    def _wrong_sides(self) -> tuple[str, str]:
        """What is wrong with who is on which arm, and the remedy."""
        if is_same_port(self._port_of(Side.LEFT), self._port_of(Side.RIGHT)):
            return SAME_PORT, "choose another port for one of them: Setup, Sensors"
        return find_swapped(self._sides, self._seen())

    def _wanted(self, side: Side) -> SensorSettings:
        """What was asked for last: the cell takes it a moment later."""
        used = sensor_of(self._cell.settings, side)
        wanted = self._asked.get(side, used)
        if wanted == used:
            self._asked.pop(side, None)
        return wanted

    def _port_of(self, side: Side) -> str:
        return sensor_of(self._cell.settings, side).port

    def _seen(self) -> Sides:
        left, right = (self.arms[side].known for side in (Side.LEFT, Side.RIGHT))
        return Sides(left.id if left.stays else "", right.id if right.stays else "")

    def _adopt(self, now_s: float) -> None:
        """A sensor that was never seen belongs on the arm where it is seen first."""
        seen, sides = self._seen(), self._sides
        for side, arm in self.arms.items():
            who = seen.of(side)
            is_known = who in (sides.left, sides.right) or seen.left == seen.right
            if who and not is_known and arm.is_seen(now_s):
                sides = sides.assigned(side, who)
        if sides != self._sides:
            self._sides = sides
            self._save_sides()

    def _tell(self) -> None:
        """Tell of what was chosen once it is in force; what was taken back before is not told."""
        waiting = []
        for chosen, said in self._to_tell:
            if all(self._cell_has(side, settings) for side, settings in chosen.items()):
                self._cell.tell(said)
            elif all(self._asked.get(side) == settings for side, settings in chosen.items()):
                waiting.append((chosen, said))
        self._to_tell = waiting

    def _cell_has(self, side: Side, settings: SensorSettings) -> bool:
        return side not in self._asked and sensor_of(self._cell.settings, side) == settings

    def _use(self, chosen: dict[Side, SensorSettings], said: str) -> None:
        """What cannot be written, as a file named at the start has it, is used until the end."""
        changes = {
            f"{side.value}.{name}": getattr(settings, name)
            for side, settings in chosen.items()
            for name in ("port", "protocol", "name")
        }
        wrong = self._remember(changes)
        self._asked |= chosen
        self._to_tell.append((chosen, said))
        self.trouble = ""
        if wrong and not self._cell.settings.is_simulation:
            why = "; ".join(dict.fromkeys(wrong.values()))
            self.trouble = f"used until the end, but not remembered: {why}"

    def _save_sides(self) -> None:
        try:
            save_sides(self._data, self._sides)
        except GestureAppError as error:
            self.trouble = f"which sensor is on which arm is not remembered: {error}"


def sensor_of(settings: Settings, side: Side) -> SensorSettings:
    """The settings of one arm's sensor."""
    return settings.left if side is Side.LEFT else settings.right
