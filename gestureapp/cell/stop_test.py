"""What a stop test measures: from the press of STOP to the standstill read back. Pure.

Times are on the clock that all processes of a machine share. The robot's place at the press lies
between two reads of its position and is taken on the straight line between them, in time; at the
speed of a stop test a read is 0.5 mm apart from the next.
"""

import math
from collections import deque
from dataclasses import replace
from typing import Final

from gestureapp.cell import events as e
from gestureapp.cell.machine_state import MachineState
from gestureapp.cell.snapshot import CellState, StopTestResult
from gestureapp.clock import Clock
from gestureapp.robot import messages as m
from gestureapp.robot.values import Caps, Pose, StopReason

TEST_CAPS: Final = Caps(length_mm=20.0, speed_mm_s=10.0)
"""Of a stop test: two seconds to press STOP in."""
LATE_MM: Final = 1.0
"""Nearer to the end of the increment nobody can tell whether STOP or the end came first: the robot
goes so far between two reads of its position."""
LATE: Final = "STOP came at the end of the move, so nothing was measured: press it sooner"
KEPT_READS: Final = 100
"""Positions are read every 50 ms at most: enough for a stop that takes its time."""

_PHASES: Final = {
    CellState.ARMED: ("arming", "The robot moves in a moment. Be ready to press STOP."),
    CellState.ACTIVATED: ("moving", "Press STOP now."),
    CellState.MOVING: ("moving", "Press STOP now."),
    CellState.STOPPING: ("stopping", "Waiting until the robot is read back to stand."),
}


class StopTests:
    """Follows the machine through a stop test. Owned by the control thread.

    Args:
        wall_clock: Seconds since the epoch.

    Attributes:
        result: Of the last or present one; None before the first.
    """

    def __init__(self, wall_clock: Clock) -> None:
        self.result: StopTestResult | None = None
        self._wall_clock = wall_clock
        self._pressed_s: float | None = None
        self._taken_s: float | None = None
        self._has_moved = False
        self._end_mm: tuple[float, ...] | None = None
        self._reads: deque[tuple[float, Pose]] = deque(maxlen=KEPT_READS)

    def forget(self) -> None:
        """Another robot: what was measured is of the one before."""
        self.result = None

    def guardian_said(self, message: m.FromGuardian, s: MachineState) -> None:
        """Take what the guardian tells, before the machine does; in any state."""
        match message:
            case m.PoseReport():
                self._reads.append((message.t_s, message.position.pose))
            case m.CommandSent() if s.test:
                i, start = message.increment, message.start.position_mm
                self._end_mm = (start[0] + i.dx_mm, start[1] + i.dy_mm, start[2] + i.dz_mm)
            case m.StopAsked() if s.test and message.reason is StopReason.STOP_PRESSED:
                self._taken_s = message.t_s
            case m.StopConfirmed() if s.test and self._is_measurable:
                assert self._taken_s is not None
                self._measure(self._taken_s + message.took_s, message.pose)

    def stepped(self, event: e.Event, before: MachineState, after: MachineState) -> None:
        """Take what the machine has made of an event."""
        if after.test and not before.test:
            self._begin(after)
        if isinstance(event, e.StopPressed) and before.test and self._pressed_s is None:
            self._pressed_s = event.t_s if event.text == e.STOP_WORDS else None
        if self.result is None or not (before.test or after.test):
            return
        self._has_moved = self._has_moved or after.state is CellState.MOVING
        if not after.test:
            self._end(after.note)
        elif after.state in _PHASES:
            phase, text = _PHASES[after.state]
            if phase != self.result.phase or text != self.result.text:
                self.result = replace(self.result, phase=phase, text=text)

    @property
    def _is_measurable(self) -> bool:
        """STOP was pressed while it moved, and the guardian has taken that up."""
        return self._has_moved and self._pressed_s is not None and self._taken_s is not None

    def _begin(self, s: MachineState) -> None:
        self._pressed_s, self._taken_s, self._has_moved = None, None, False
        self._end_mm = None
        text = "Asking for the permission. Keep the left arm in the stop posture."
        self.result = StopTestResult("arming", s.test, text=text)

    def _measure(self, stood_s: float, stood: Pose) -> None:
        if self.result is None or self._pressed_s is None:
            return
        end_mm = self._end_mm
        if end_mm is not None and math.dist(end_mm, stood.position_mm) < LATE_MM:
            self.result = replace(self.result, text=LATE)
            return
        at_press = self._place_at(self._pressed_s)
        ran_on_mm = math.nan if at_press is None else math.dist(at_press, stood.position_mm)
        took_s = stood_s - self._pressed_s
        self.result = replace(self.result, took_s=took_s, ran_on_mm=ran_on_mm)

    def _place_at(self, t_s: float) -> tuple[float, ...] | None:
        """Where the robot was, between the reads before and after; None without both."""
        before = next((read for read in reversed(self._reads) if read[0] <= t_s), None)
        after = next((read for read in self._reads if read[0] > t_s), None)
        if before is None or after is None:
            return None
        share = (t_s - before[0]) / (after[0] - before[0])
        pairs = zip(before[1].position_mm, after[1].position_mm, strict=True)
        return tuple(a + share * (b - a) for a, b in pairs)

    def _end(self, note: str) -> None:
        assert self.result is not None
        text = LATE if self.result.text == LATE else note or "ended"
        if self.result.is_measured:
            text = f"Stood {self.result.took_s * 1000:.0f} ms after STOP was pressed"
            ran_on_mm = self.result.ran_on_mm
            text += "." if math.isnan(ran_on_mm) else f", {ran_on_mm:.1f} mm farther on."
        wall_s = self._wall_clock()
        self.result = replace(self.result, phase="done", text=text, wall_s=wall_s)
