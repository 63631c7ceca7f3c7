"""From the last sample that was needed to the IMOV at the controller."""

import tempfile
from pathlib import Path

from gestureapp.benchmark.driven import Stage, Truth, perform, training_beside
from gestureapp.benchmark.report import Report, Row
from gestureapp.cell.records import Topic
from gestureapp.clock import monotonic
from gestureapp.recording.session_reader import read_session
from gestureapp.window_port import OpenWindow

AIM = "99 % within 10 ms"
LABELS = ("X+", "X-")
ARRIVES_S = 0.5
"""An IMOV that the controller hears within this after the guardian sent one is that one."""
TRIES = 10
"""A gesture may be misheard: so many are made for the first figure, however short the run."""
MOVE_S = 0.15
"""How long each move goes on: long enough to be one, short enough for many of them."""


def measure_latency(seconds: float, open_window: OpenWindow) -> Report:
    """Both cases: the window drawing, and a training running beside it."""
    from gestureapp.recognition.takes import save_takes
    from gestureapp.simulation.takes import make_takes

    rows: list[Row] = []
    notes: list[str] = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        takes = folder / "takes.npz"
        save_takes(takes, make_takes(1, 30, 7))
        for words, beside in (("window drawing", None), ("with a training beside", takes)):
            with training_beside(beside):
                script = _Script(seconds)
                truth = perform(script, open_window, folder)
            rows += _rows(words, script, truth)
            notes.append(f"{words}: {script.n_moves} moves, {script.n_surprises} unasked stops")
    return Report("Last sample written to IMOV received", rows, notes)


class _Script:
    """One short move after the other, forth and back."""

    def __init__(self, seconds: float) -> None:
        self.sent_s: dict[int, float] = {}
        self.n_moves = 0
        self.n_surprises = 0
        self._seconds = seconds

    def __call__(self, stage: Stage) -> None:
        stage.arm()
        until_s, n_tried = monotonic() + self._seconds, 0
        while monotonic() < until_s or (not self.n_moves and n_tried < TRIES):
            n_tried += 1
            if stage.move(LABELS[self.n_moves % 2]):
                self.n_moves += 1
                stage.wait(lambda _: False, MOVE_S)
            self.sent_s |= stage.sent(stage.demo.right.control_port, 600)
            stage.free()
        self.n_surprises = stage.n_surprises


def _rows(words: str, script: _Script, truth: Truth) -> list[Row]:
    counters: dict[float, int] = {}
    ends: dict[int, tuple[float, float]] = {}
    commanded: list[tuple[int, float]] = []
    for read in read_session(truth.session).records():
        record, fields = read.record, read.record.fields
        if record.topic is Topic.RIGHT_ACCEL and fields["counter"] is not None:
            counters.setdefault(record.t_s, int(str(fields["counter"])))
        elif record.topic is Topic.RECOGNITION and fields["label"] is not None:
            times = (float(str(fields["window_end_s"])), float(str(fields["decided_s"])))
            ends[int(str(fields["activation_id"]))] = times
        elif record.topic is Topic.COMMAND and fields["type"] == "CommandSent":
            sent = (int(str(fields["activation_id"])), float(str(fields["t_s"])))
            commanded.append(sent)
    decided, first, last = [], [], []
    moves = [request for request in truth.log.requests if request.name == "IMOV"]
    for activation_id, commanded_s in commanded:
        window_end_s, decided_s = ends[activation_id]
        sent_s = script.sent_s.get(counters.get(window_end_s, -1))
        move = next((m for m in moves if 0 <= m.first_s - commanded_s < ARRIVES_S), None)
        if sent_s is not None and move is not None:
            decided.append(1000 * (decided_s - sent_s))
            first.append(1000 * (move.first_s - sent_s))
            last.append(1000 * (move.last_s - sent_s))
    return [
        Row(f"decision, {words}", "ms", tuple(decided)),
        Row(f"first byte of IMOV, {words}", "ms", tuple(first)),
        Row(f"whole IMOV, {words}", "ms", tuple(last), AIM),
    ]
