"""From STOP pressed, and from the left sensor's last sample, to HOLD at the controller."""

import tempfile
from collections.abc import Callable
from pathlib import Path

from gestureapp.benchmark.driven import Stage, Truth, perform
from gestureapp.benchmark.report import Report, Row
from gestureapp.cell.snapshot import CellState
from gestureapp.clock import monotonic
from gestureapp.config import SiteSettings
from gestureapp.window_port import OpenWindow

LABELS = ("X+", "X-")
MOVE_S = 0.2
TRIES = 10
"""A gesture may be misheard: so many are made for the first figure, however short the run."""
TRIP_MS = 1000 * SiteSettings().trip_level_s


def measure_stop(seconds: float, open_window: OpenWindow) -> Report:
    """STOP pressed with the mouse while moving; the left sensor silenced while moving."""
    pressed, silenced = _Script(seconds, _press), _Script(seconds, _silence)
    with tempfile.TemporaryDirectory() as name:
        truth = perform(pressed, open_window, Path(name))
        rows = _rows("STOP pressed", pressed, truth, 0.0, "99 % within 20 ms")
        truth = perform(silenced, open_window, Path(name))
    words = f"left sensor silent, beyond the trip level of {TRIP_MS:.0f} ms"
    rows += _rows(words, silenced, truth, TRIP_MS, "at most 20 ms")
    surprises = pressed.n_surprises + silenced.n_surprises
    return Report("A stop while moving", rows, [f"{surprises} unasked stops"])


def _press(stage: Stage) -> float:
    return stage.hands.press_stop()


def _silence(stage: Stage) -> float:
    """Silence the left sensor; when its last sample was written."""
    stage.operator.silence_left()
    stage.wait(lambda s: s.state is CellState.STOPPED, 5.0)
    return max(stage.sent(stage.demo.left.control_port, 1).values())


class _Script:
    """Move, stop, recover, and again."""

    def __init__(self, seconds: float, stop: Callable[[Stage], float]) -> None:
        self.begun_s: list[float] = []
        self.n_surprises = 0
        self._seconds = seconds
        self._stop = stop

    def __call__(self, stage: Stage) -> None:
        until_s, n_tried = monotonic() + self._seconds, 0
        while monotonic() < until_s or (not self.begun_s and n_tried < TRIES):
            n_tried += 1
            if stage.move(LABELS[len(self.begun_s) % 2]):
                stage.wait(lambda _: False, MOVE_S)
                if stage.now.state is CellState.MOVING:
                    self.begun_s.append(self._stop(stage))
                    stage.wait(lambda s: s.state is CellState.STOPPED, 5.0)
                    continue
            stage.free()
        self.n_surprises = stage.n_surprises


def _rows(words: str, script: _Script, truth: Truth, less_ms: float, aim: str) -> list[Row]:
    first, last, stands = [], [], []
    for begun_s in script.begun_s:
        hold = truth.log.first("HOLD", "1", begun_s)
        end_s = truth.log.end_after(begun_s)
        if hold is None or end_s is None:
            continue
        first.append(1000 * (hold.first_s - begun_s) - less_ms)
        last.append(1000 * (hold.last_s - begun_s) - less_ms)
        stands.append(1000 * (end_s - begun_s) - less_ms)
    return [
        Row(f"{words}: first byte of HOLD", "ms", tuple(first)),
        Row(f"{words}: whole HOLD", "ms", tuple(last), aim),
        Row(f"{words}: standstill in the emulator", "ms", tuple(stands)),
    ]
