"""Emulators that outlive the application, the application under test, and hands for both."""

import contextlib
import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from types import TracebackType
from typing import Self

from gestureapp.benchmark.controller_log import ControllerLog
from gestureapp.benchmark.faults.application import Application
from gestureapp.clock import monotonic
from gestureapp.config import Settings
from gestureapp.errors import WorkerError
from gestureapp.sensing.values import Side
from gestureapp.settings_file import settings_text
from gestureapp.simulation.control_link import ControlLink
from gestureapp.simulation.demo import HOST, DemoCell, DemoOptions, keep_fresh_records
from gestureapp.simulation.operator_plan import Timing
from gestureapp.simulation.wearer import person_of

LOOK_S = 0.004
"""How often the harness looks; figures come from the logs, not from these looks."""
READY_WITHIN_S = 25.0
SETTLED_S = 0.2
"""After this the robot has its full speed."""
FRESH_S = 3.0
"""A move younger than this has way enough left for the next fault; along Y it lasts 8 s."""
TRIES = 5
"""A gesture may be misheard, and a busy machine may stop the robot on the way."""
HOME_MM = {"x": 800.0, "y": 0.0, "z": 300.0}
ASTRAY_MM = 60.0
"""A misheard gesture leads away from the line along Y: the tool is put back by hand."""

State = dict[str, object]


class Rig:
    """Everything a fault is tried on. Made, used and closed by one thread.

    Args:
        folder: For the sessions, the guardian's log and the controller's.
        program: The command that runs the application with its window.

    Attributes:
        folder: As given.
        log: The controller's own.
        settings: Of the application under test.
        sensors: The sensor emulators' control lines.
        pendant: The controller's.
        demo: The emulators and the virtual operator.
        beside: What runs beside the application during a fault; closed when it is mended.
        n_surprises: Stops that nobody asked for; it was armed again after them.
    """

    def __init__(self, folder: Path, program: Sequence[str]) -> None:
        self.folder = folder
        self.n_surprises = 0
        self._program = tuple(program)
        self._config = folder / "cell.toml"
        self._opened = contextlib.ExitStack()
        self._application: Application | None = None
        self.beside = contextlib.ExitStack()

    def __enter__(self) -> Self:
        """Start the emulators; the application is started when it is needed."""
        with contextlib.ExitStack() as opened:
            log_file = self.folder / "nx100.jsonl"
            arguments = ("--control-port", "0", "--log", str(log_file))
            self.demo = opened.enter_context(DemoCell(DemoOptions(nx100_arguments=arguments)))
            self.settings = replace(self.demo.settings(Settings()), is_simulation=False)
            keep_fresh_records(self.folder, self.settings, time.time())
            self._config.write_text(settings_text(self.settings), "utf-8")
            self.log = ControllerLog(log_file)
            self.sensors = {
                Side.LEFT: opened.enter_context(_link(self.demo.left.control_port, "left sensor")),
                Side.RIGHT: opened.enter_context(
                    _link(self.demo.right.control_port, "right sensor")
                ),
            }
            self.pendant = opened.enter_context(_link(self.demo.nx100.control_port, "NX100"))
            opened.callback(self.end_application)
            opened.callback(self.beside.close)
            self._opened = opened.pop_all()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """End the application, then the emulators."""
        self._opened.close()

    # The application.

    @property
    def application(self) -> Application:
        """The one that runs; it is started when there is none."""
        if self._application is None:
            self._application = Application(self._program, self._config, self.folder)
        return self._application

    def end_application(self) -> None:
        """End it, however it is; the next use starts another. Idempotent."""
        application, self._application = self._application, None
        if application is not None:
            application.close()

    @property
    def now(self) -> State:
        """What its window shows."""
        return self.application.ask("state")

    @property
    def newest_session(self) -> Path:
        """The session file that was begun last.

        Raises:
            WorkerError: there is none.
        """
        files = (self.folder / "sessions").glob("*.mcap")
        newest = max(files, key=lambda file: file.stat().st_mtime_ns, default=None)
        if newest is None:
            raise WorkerError("application", f"has recorded nothing under {self.folder}")
        return newest

    def wait(self, is_so: Callable[[State], object], limit_s: float) -> bool:
        """Look at the window until something is so; whether it was within the limit."""
        return until(lambda: is_so(self.now), limit_s)

    # What a person does.

    def fault(self, side: Side, kind: str, **options: object) -> float:
        """Bring a sensor into a fault.

        Returns:
            When the last sample before it was sent.
        """
        link, asked_s = self.sensors[side], monotonic()
        link.ask({"do": "fault", "kind": kind, **options})
        rows = link.ask({"do": "log", "count": 50})["log"]
        assert isinstance(rows, list)
        return max(float(row["sent_s"]) for row in rows if row["sent_s"] <= asked_s)

    def robot_fault(self, kind: str, **options: object) -> float:
        """Bring the controller or its line into a fault. Returns when."""
        at_s = monotonic()
        self.pendant.ask({"do": "fault", "kind": kind, **options})
        return at_s

    def arm(self) -> None:
        """Mend what stands against it as a person would, then arm, with the robot released.

        Raises:
            WorkerError: it does not arm; the text says what stands against it.
        """
        self.robot_fault("none")
        for side in Side:
            self.sensors[side].ask({"do": "fault", "kind": "none"})
        self.demo.operator.left_stop()
        self.demo.operator.right_rest()
        if not self.wait(self._press_for_arming, READY_WITHIN_S):
            now = self.now
            text = f"not armed: {now['sentence']} {now['blockers']}"
            raise WorkerError("application", text)

    def move(self) -> None:
        """Have the robot moving at its full speed along Y, with way enough left.

        Raises:
            WorkerError: it does not move.
        """
        for _ in range(TRIES):
            if self._is_under_way():
                return
            self.arm()
            asked_s = monotonic()
            self.demo.operator.gesture("Y+" if self._tool_mm()[1] < 0.0 else "Y-")
            self.wait(lambda s: s["state"] in ("MOVING", "STOPPED"), 4.0)
            if self.until_log(lambda: self.log.is_moving, 1.0):
                begun_s = max(self.log.starts_s[-1], asked_s)
                time.sleep(max(0.0, begun_s + SETTLED_S - monotonic()))
                continue
            self.n_surprises += 1
        raise WorkerError("application", f"does not move: {self.now['sentence']}")

    def until_log(self, is_so: Callable[[], object], limit_s: float) -> bool:
        """Read the controller's log until something is so; whether it was within the limit."""

        def look() -> object:
            self.log.read()
            return is_so()

        return until(look, limit_s)

    @property
    def timing(self) -> Timing:
        """Of the person who wears the sensors."""
        options = self.demo.options
        return Timing.of(person_of(options.seed, options.session, is_practised=True))

    def _is_under_way(self) -> bool:
        self.log.read()
        if self._application is None or not self.log.is_moving:
            return False
        age_s = monotonic() - self.log.starts_s[-1]
        return SETTLED_S <= age_s <= FRESH_S and self.now["state"] == "MOVING"

    def _press_for_arming(self, now: State) -> bool:
        """One look and one press towards it; whether it is armed and free."""
        if now["state"] == "ARMED":
            return not now["is_held"]
        if any("servo power" in text for text in _texts(now["blockers"])):
            self.application.ask("servo_on")
        elif now["can_arm"]:
            self._put_home()
            self.application.ask("arm")
            self.wait(lambda s: s["state"] == "ARMED" or s["can_arm"], 3.0)
        return False

    def _tool_mm(self) -> list[float]:
        pose = self.pendant.ask({"do": "state"})["pose"]
        assert isinstance(pose, list)
        return pose

    def _put_home(self) -> None:
        x_mm, y_mm, z_mm, *angles = self._tool_mm()
        off = (x_mm - HOME_MM["x"], y_mm / 10.0, z_mm - HOME_MM["z"])
        if max(map(abs, off)) > ASTRAY_MM or abs(angles[1]) + abs(angles[2]) > 1.0:
            self.pendant.ask({"do": "pose", **HOME_MM, "rx": 180.0, "ry": 0.0, "rz": 0.0})
            self.wait(lambda s: s["can_arm"], 2.0)


def until(is_so: Callable[[], object], limit_s: float) -> bool:
    """Look again and again until something is so; whether it was within the limit."""
    until_s = monotonic() + limit_s
    while not is_so():
        if monotonic() > until_s:
            return False
        time.sleep(LOOK_S)
    return True


def _link(port: int, name: str) -> ControlLink:
    return ControlLink(f"{name} emulator", HOST, port)


def _texts(value: object) -> list[str]:
    return [str(item) for item in value] if isinstance(value, list) else []
