"""The demo cell: two sensors, an arm in each, and an NX100, each a process of its own."""

import contextlib
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from types import TracebackType
from typing import Self

import gestureapp
from gestureapp.children import child_command
from gestureapp.clock import Clock, monotonic
from gestureapp.config import PersonSettings, RobotSettings, SensorSettings, Settings
from gestureapp.errors import GestureAppError
from gestureapp.recording.sensor_records import SensorRecord, save_record
from gestureapp.sensing.values import Side
from gestureapp.simulation.child import EmulatorProcess
from gestureapp.simulation.operator import OperatorClient
from gestureapp.simulation.operator_plan import Timing
from gestureapp.simulation.sensor import DEMO_SEED, DEMO_SESSION

HOST = "127.0.0.1"

READY_WITHIN_S = 15.0
"""Deadline for all three; a warm machine needs about half a second."""

MODEL = Path(gestureapp.__file__).resolve().parent.parent / "resources" / "demo" / "model.json"
"""Trained from the takes of the person who wears the emulated sensors."""


@dataclass(frozen=True, slots=True)
class DemoOptions:
    """What the demo cell is made of.

    Attributes:
        left_protocol: Of the left sensor.
        right_protocol: Of the right sensor.
        seed: Which trained operator wears them.
        session: On which day.
        nx100_arguments: More arguments for ``simulate nx100``, as ``("--log", "FILE")``.
        program: The command that runs the application; empty means this very program.
    """

    left_protocol: str = "adxl330"
    right_protocol: str = "csv"
    seed: int = DEMO_SEED
    session: int = DEMO_SESSION
    nx100_arguments: tuple[str, ...] = ()
    program: tuple[str, ...] = ()


class DemoCell:
    """Three emulators and the virtual operator. Owned by the thread that starts it.

    Attributes:
        options: As given.
        left: The left sensor's process.
        right: The right sensor's process.
        nx100: The controller's process.
        operator: The virtual operator's hands.
    """

    left: EmulatorProcess
    right: EmulatorProcess
    nx100: EmulatorProcess
    operator: OperatorClient

    def __init__(self, options: DemoOptions | None = None, clock: Clock = monotonic) -> None:
        self.options = DemoOptions() if options is None else options
        self._clock = clock
        self._opened = contextlib.ExitStack()
        self._children: list[EmulatorProcess] = []

    def start(self) -> None:
        """Start everything and wait until it listens. Once only.

        Raises:
            WorkerError: an emulator cannot be started, ended, or was not ready in time. Then none
                is left behind.
        """
        deadline_s = self._clock() + READY_WITHIN_S
        try:
            self.left = self._spawn("left sensor emulator", self._sensor_arguments(Side.LEFT))
            self.right = self._spawn("right sensor emulator", self._sensor_arguments(Side.RIGHT))
            nx100 = ["nx100", "--port", "0", *self.options.nx100_arguments]
            self.nx100 = self._spawn("NX100 emulator", nx100)
            # While they start: the person's arms, which brings numpy here, too.
            timing = self._timing()
            for child in self._children:
                child.wait_ready(deadline_s, self._clock)
        except GestureAppError:
            self.close()
            raise
        self.operator = OperatorClient(
            (HOST, self.left.control_port),
            (HOST, self.right.control_port),
            timing,
            self._clock,
            trouble=lambda: self.problem,
        )
        self._opened.callback(self.operator.close)
        self.operator.start()

    def close(self) -> None:
        """End the operator and all three processes. Idempotent."""
        for child in self._children:
            child.ask_to_end()
        self._opened.close()

    def settings(self, base: Settings | None = None) -> Settings:
        """The settings of a cell that works on these emulators; the site's are kept from ``base``.

        The robot's field, speeds and frame are kept as well; its address is this machine's, and the
        emulated arm has no tool.
        """
        base = Settings() if base is None else base
        return replace(
            base,
            left=SensorSettings(self._url(self.left), self.options.left_protocol, "demo left"),
            right=SensorSettings(self._url(self.right), self.options.right_protocol, "demo right"),
            robot=_at(base.robot, self.nx100.port),
            person=PersonSettings("Demo operator", MODEL),
            is_simulation=True,
        )

    @property
    def problem(self) -> str:
        """Empty while all run; else which emulator ended, and how."""
        troubles = [f"{c.name}: {c.problem}" for c in self._children if c.problem]
        return "; ".join(troubles)

    def __enter__(self) -> Self:
        """Start."""
        self.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """End."""
        self.close()

    def _spawn(self, name: str, arguments: Sequence[str]) -> EmulatorProcess:
        command = [*(self.options.program or child_command()), "simulate", *arguments]
        child = EmulatorProcess(name, [*command, "--exit-with-stdin"])
        self._children.append(child)
        self._opened.callback(child.close)
        return child

    def _sensor_arguments(self, side: Side) -> list[str]:
        options = self.options
        protocol = options.left_protocol if side is Side.LEFT else options.right_protocol
        return [
            *("sensor", "--arm", side.value, "--port", "0", "--control-port", "0"),
            *("--protocol", protocol, "--seed", str(options.seed)),
            *("--session", str(options.session)),
        ]

    def _timing(self) -> Timing:
        from gestureapp.simulation.wearer import person_of

        return Timing.of(person_of(self.options.seed, self.options.session, is_practised=True))

    @staticmethod
    def _url(child: EmulatorProcess) -> str:
        return f"socket://{HOST}:{child.port}"


def _at(robot: RobotSettings, port: int) -> RobotSettings:
    return replace(robot, host=HOST, port=port, tool=0, tool_mm=(0.0, 0.0, 0.0))


def keep_fresh_records(data: Path, settings: Settings, wall_s: float) -> None:
    """Keep for both sensors, by their names, that they were calibrated just now.

    The emulated ones are as their data sheets say, so that a demo can be armed at once.

    Args:
        data: The data folder.
        settings: Of a cell that works on emulators.
        wall_s: Now, seconds since the epoch.

    Raises:
        RecordingError: the data folder cannot be written to.
    """
    for sensor in (settings.left, settings.right):
        record = SensorRecord(sensor.name, calibrated_wall_s=wall_s, verdict="emulated")
        save_record(data, record)
