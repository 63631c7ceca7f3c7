"""A demo cell with its window, driven by a script, and the truth that the emulators logged."""

import contextlib
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from gestureapp.benchmark.controller_log import ControllerLog
from gestureapp.cell.snapshot import CellState, Snapshot
from gestureapp.children import child_command, start_beside
from gestureapp.clock import monotonic
from gestureapp.config import Settings
from gestureapp.errors import WorkerError
from gestureapp.running import RunningCell, running_cell
from gestureapp.simulation.control_link import ControlLink
from gestureapp.simulation.demo import HOST, DemoOptions
from gestureapp.window_port import OpenWindow, WindowHands
from gestureapp.worker import Worker

LOOK_S = 0.004
"""How often the script looks at the cell; figures come from the logs, not from these looks."""


class Stage:
    """What a script works with: the cell, the virtual operator, the window's STOP.

    Attributes:
        running: The demo cell.
        hands: Presses the window.
        n_surprises: Stops that nobody asked for; the script arms again after them.
    """

    def __init__(self, running: RunningCell, hands: WindowHands) -> None:
        assert running.operator is not None
        assert running.demo is not None
        self.running, self.hands = running, hands
        self.operator, self.demo = running.operator, running.demo
        self.n_surprises = 0

    @property
    def now(self) -> Snapshot:
        """The cell as it is."""
        return self.running.cell.snapshot()

    def wait(self, is_so: Callable[[Snapshot], bool], limit_s: float) -> bool:
        """Look until something is so; whether it was within the limit."""
        until_s = monotonic() + limit_s
        while not is_so(self.now):
            if monotonic() > until_s:
                return False
            time.sleep(LOOK_S)
        return True

    def arm(self) -> None:
        """Bring the left arm to the stop posture and arm.

        Raises:
            WorkerError: it does not arm; the text says what stands against it.
        """
        if self.now.state is CellState.ARMED:
            return
        self.operator.restore_sensors()
        self.operator.left_stop()
        if not self.wait(lambda s: s.can_arm, 20.0):
            raise WorkerError("benchmark", f"not ready: {[b.text for b in self.now.blockers]}")
        self.running.cell.arm()
        if not self.wait(lambda s: s.state is CellState.ARMED, 5.0):
            raise WorkerError("benchmark", f"not armed: {self.now.sentence}")

    def move(self, label: str) -> bool:
        """Make a gesture; whether the robot moves for it."""
        self.arm()
        self.operator.gesture(label)
        is_moving = self.wait(lambda s: s.state in (CellState.MOVING, CellState.STOPPED), 5.0)
        if self.now.state is CellState.STOPPED:
            self.n_surprises += 1
        return is_moving and self.now.state is CellState.MOVING

    def free(self) -> bool:
        """Stop by the left arm and wait until the next gesture can be made."""
        self.operator.left_stop()
        is_free = self.wait(_is_free, 5.0)
        if self.now.state is CellState.STOPPED:
            self.n_surprises += 1
        return is_free

    def sent(self, control_port: int, count: int) -> dict[int, float]:
        """When a sensor emulator had written its last samples, by their running number."""
        with ControlLink("sensor emulator", HOST, control_port) as link:
            rows = link.ask({"do": "log", "count": count})["log"]
        assert isinstance(rows, list)
        return {row["n"]: row["sent_s"] for row in rows}


@dataclass(frozen=True, slots=True)
class Truth:
    """What is left after a run.

    Attributes:
        session: The recorded session.
        log: What the controller emulator received and did.
    """

    session: Path
    log: ControllerLog


def perform(script: Callable[[Stage], None], open_window: OpenWindow, folder: Path) -> Truth:
    """Run a script on a demo cell with its window drawn.

    Args:
        script: What is done with it, in a thread of its own.
        open_window: Opens the window.
        folder: For the session and the controller's log; they are read afterwards.

    Raises:
        GestureAppError: the cell could not be started, or the script could not go on.
    """
    log_file = folder / "nx100.jsonl"
    demo = DemoOptions(nx100_arguments=("--log", str(log_file)))
    troubles: list[WorkerError] = []
    with running_cell(Settings(), folder, demo) as running:

        def driver(hands: WindowHands) -> None:
            try:
                script(Stage(running, hands))
            except WorkerError as error:
                troubles.append(error)
            finally:
                hands.close()

        open_window(running, None, driver)
    if troubles:
        raise troubles[0]
    session = running.recorder.path
    assert session is not None
    log = ControllerLog(log_file)
    log.read()
    return Truth(session, log)


@contextlib.contextmanager
def training_beside(takes: Path | None) -> Iterator[None]:
    """Keep a training child busy with the paper preset, over and over; nothing without takes."""
    if takes is None:
        yield
        return
    model = takes.with_suffix(".json")
    command = [*child_command("train", str(takes), "-o", str(model)), "--preset", "paper"]

    def train(stopping: threading.Event) -> None:
        while not stopping.is_set():
            with start_beside(command) as child:
                while child.poll() is None:
                    if stopping.wait(0.05):
                        child.kill()

    worker = Worker("training beside", train)
    worker.start()
    try:
        yield
    finally:
        worker.stop(10.0)


def _is_free(snapshot: Snapshot) -> bool:
    status = snapshot.robot.status
    is_held = status is None or status.is_held or status.is_running
    return snapshot.state is CellState.STOPPED or (
        snapshot.state is CellState.ARMED and not is_held
    )
