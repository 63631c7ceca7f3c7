"""A whole cell for tests: emulators on real sockets, a real guardian process, a window's timer."""

import contextlib
import threading
import time
from collections.abc import Callable
from pathlib import Path
from types import TracebackType
from typing import Self

from gestureapp.cell.engine import Cell
from gestureapp.cell.records import Record
from gestureapp.cell.snapshot import CellState, Snapshot
from gestureapp.clock import monotonic
from gestureapp.config import PersonSettings, RobotSettings, SensorSettings, Settings, SiteSettings
from gestureapp.recording.session_writer import SessionWriter
from gestureapp.robot.values import Pose
from gestureapp.running import describe
from gestureapp.sensing.values import ArmPosture, Side
from gestureapp.simulation.demo import MODEL
from gestureapp.simulation.nx100 import Nx100Emulator
from gestureapp.simulation.nx100_log import LogEvent, What
from gestureapp.simulation.nx100_options import Fault, Nx100Options
from gestureapp.simulation.nx100_values import ControllerOptions
from gestureapp.simulation.operator import OperatorClient
from gestureapp.simulation.operator_plan import Timing
from gestureapp.simulation.sensor import DEMO_SEED, DEMO_SESSION, SensorEmulator, SensorOptions
from gestureapp.simulation.sensor_radio import DIRECT, RadioOptions
from gestureapp.simulation.wearer import person_of

HOME = Pose(800.0, 0.0, 300.0, 180.0, 0.0, 0.0)
TICK_S = 0.01
SITE = SiteSettings(trip_level_s=0.3, control_limit_s=0.5, gui_limit_s=1.0, stop_seen_s=0.2)
"""Wide limits: both emulators and the cell share one interpreter and a busy machine here."""


class Bench:
    """Everything in this process but the guardian. The test's own loop is the window.

    Attributes:
        nx100: The controller, with its log.
        sensors: Both sensors.
        operator: The hands.
        cell: What is tested.
        recorder: Writes the session.
    """

    def __init__(
        self,
        folder: Path,
        is_broken: threading.Event | None = None,
        controller: ControllerOptions | None = None,
        supervision_input: int = 0,
        protocols: tuple[str, str] = ("csv", "csv"),
        radio: RadioOptions = DIRECT,
    ) -> None:
        """Start it; once ``is_broken`` is set, what the control thread records raises."""
        self._opened = contextlib.ExitStack()
        enter = self._opened.enter_context
        options = Nx100Options(controller=controller or ControllerOptions())
        self.nx100 = enter(Nx100Emulator(options))
        speaks = dict(zip(Side, protocols, strict=True))
        self.sensors = {
            side: enter(
                SensorEmulator(
                    SensorOptions(side, control_port=0, protocol=speaks[side], radio=radio)
                )
            )
            for side in Side
        }
        timing = Timing.of(person_of(DEMO_SEED, DEMO_SESSION, is_practised=True))
        left, right = (("127.0.0.1", self.sensors[side].control_port) for side in Side)
        self.operator = OperatorClient(left, right, timing, seed=5)
        self.operator.start()
        self._opened.callback(self.operator.close)
        self.settings = Settings(
            left=self._sensor(Side.LEFT),
            right=self._sensor(Side.RIGHT),
            site=SITE,
            robot=RobotSettings(
                host="127.0.0.1", port=self.nx100.port, supervision_input=supervision_input
            ),
            person=PersonSettings("Test", MODEL),
        )
        self.recorder = SessionWriter(folder, monotonic, time.time, describe(self.settings))
        self.recorder.start()
        self._opened.callback(self.recorder.stop)

        def record(item: Record) -> None:
            if is_broken is not None and is_broken.is_set():
                assert threading.current_thread().name != "control", "broken by the test"
            self.recorder.put(item)

        self.cell = Cell(self.settings, record, lambda: self.recorder.status, None, time.time)
        self._opened.callback(self.cell.shutdown)
        self.cell.start()
        for side in Side:
            self.cell.judge_sensor(side, "")

    def _sensor(self, side: Side) -> SensorSettings:
        emulator = self.sensors[side]
        return SensorSettings(f"socket://127.0.0.1:{emulator.port}", emulator.options.protocol)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def close(self) -> None:
        """End everything. Idempotent."""
        self._opened.close()

    @property
    def now(self) -> Snapshot:
        return self.cell.snapshot()

    @property
    def guardian_pid(self) -> int:
        link = self.cell._link
        assert link is not None
        return link.pid

    def until(self, is_so: Callable[[Snapshot], object], limit_s: float = 6.0) -> Snapshot:
        """Be the window until it is so; fails at the limit with what the window shows."""
        deadline_s = monotonic() + limit_s
        while True:
            self.cell.gui_tick()
            snapshot = self.now
            if is_so(snapshot):
                return snapshot
            assert monotonic() < deadline_s, (
                f"still {snapshot.state.value}: {snapshot.sentence} {snapshot.blockers}"
            )
            time.sleep(TICK_S)

    def reach(self, state: CellState, limit_s: float = 6.0) -> Snapshot:
        """Be the window until the cell is in this state."""
        return self.until(lambda s: s.state is state, limit_s)

    def arm(self) -> Snapshot:
        """Mend what stands against it, as a person would, then arm with the tool at home."""
        self.operator.restore_sensors()
        self.operator.left_stop()
        self.operator.right_rest()
        self.nx100.fault(Fault())
        self.until(lambda s: s.state is not CellState.STOPPING)
        snapshot = self.until(self._is_armed, 15.0)
        self.nx100.place(HOME)
        self.settle()
        return snapshot

    def _is_armed(self, snapshot: Snapshot) -> bool:
        """Whether it is; presses Servo on and Arm as a person would, and again when refused.

        Stands in for setting up, too: a sensor that says who it is only now is judged anew.
        """
        for side in Side:
            if any(blocker.id == f"{side.value}_unfit" for blocker in snapshot.blockers):
                self.cell.judge_sensor(side, "")
        if any("servo power" in blocker.text for blocker in snapshot.blockers):
            self.cell.servo_on()
        if snapshot.can_arm:
            self.cell.arm()
        return snapshot.state is CellState.ARMED

    def settle(self) -> None:
        """Until the position read back is where the arm is and the state is known to be free."""
        pose = self.nx100.pose()
        self.until(lambda s: s.robot.pose == pose and s.posture is ArmPosture.STOP)

    def rest(self, span_s: float) -> None:
        """Be the window for so long, while nothing else is asked of anybody."""
        end_s = self.now.t_s + span_s
        self.until(lambda s: s.t_s > end_s, span_s + 2.0)

    def free(self) -> None:
        """Until the guardian has released its hold after the left arm's own stop."""
        self.until(lambda s: s.robot.status is not None and not s.robot.status.is_held)

    def move(self, label: str = "X+") -> Snapshot:
        """Armed or not: make the robot move, and wait until it does."""
        self.arm()
        self.free()
        self.operator.gesture(label)
        snapshot = self.reach(CellState.MOVING)
        self.until(lambda _: self.nx100.is_running())
        return snapshot

    def holds(self) -> int:
        """How often HOLD 1 has come."""
        return sum(request.text.strip() == "1" for request in self.nx100.log.requests("HOLD"))

    def moves(self) -> int:
        """How many increments have come."""
        return len(self.nx100.log.requests("IMOV"))

    def last(self, what: What) -> LogEvent:
        return self.nx100.log.events(what)[-1]

    def motion_end(self) -> LogEvent:
        """How the last motion ended, once the emulator has logged it."""
        log = self.nx100.log
        self.until(lambda _: len(log.events(What.MOTION_END)) == len(log.events(What.MOTION_START)))
        return self.last(What.MOTION_END)
