"""Training of the open person's model: a child process, and the model that comes of it.

One thread watches takes and model and listens to the child; the window's thread looks at the newest
picture and leaves wishes. The model there was stays until another one is whole.
"""

import contextlib
import queue
import shutil
import subprocess
import tempfile
import threading
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final, Protocol

from gestureapp.children import child_command, start_beside
from gestureapp.clock import Clock, monotonic
from gestureapp.errors import GestureAppError, WorkerError
from gestureapp.guided.trained import KnownModel, set_of
from gestureapp.guided.trained_words import missing_words
from gestureapp.guided.values import GuidedSnapshot, TrainingPhase, TrainingView
from gestureapp.recognition.model_file import load_model, save_model
from gestureapp.recognition.presets import Preset
from gestureapp.recognition.takes import TakeSet, save_takes
from gestureapp.recognition.training_job import Failed, Finished, Job, Progress, parse_answer
from gestureapp.recording.people import model_path
from gestureapp.recording.take_values import Take, sitting_of
from gestureapp.worker import Worker

LOOK_S: Final = 0.25
"""How often the takes are compared with the model."""
KEPT_LOSSES: Final = 200
ENDING_S: Final = 2.0
"""A child that was told to end has ended by then; one that hangs is killed."""
STARTING: Final = "the training process is starting"


class TakesSource(Protocol):
    """Whose takes are open; any thread."""

    def snapshot(self) -> GuidedSnapshot:
        """The newest picture."""

    def takes(self, label: str = "") -> tuple[Take, ...]:
        """The open person's, without the bin's."""


class Trainer:
    """Trains the open person's model; implements ``TrainerControls``.

    Args:
        source: Whose takes are open.
        data: The data folder.
        use_model: Has the cell recognise with a person's model file, or with none; with it why it
            is out of date or missing, and the person.
        clock: Monotonic seconds.
        command: Starts the training child.
    """

    def __init__(
        self,
        source: TakesSource,
        data: Path,
        use_model: Callable[[Path | None, str, str], None],
        clock: Clock = monotonic,
        command: Sequence[str] = (),
    ) -> None:
        self._source, self._data, self._clock = source, data, clock
        self._use_model = use_model
        self._command = list(command) or child_command("training-child")
        self._wishes: queue.SimpleQueue[tuple[Preset, int] | None] = queue.SimpleQueue()
        self._lock = threading.Lock()
        self._child: subprocess.Popen[bytes] | None = None
        self._is_cancelled = False
        self._known = KnownModel()
        self._view = TrainingView()
        self._worker = Worker("trainer", self._run, self._ended)

    def start_thread(self) -> None:
        """Start the thread. Once only."""
        self._worker.start()

    def shutdown(self) -> None:
        """End a training and the thread. Idempotent."""
        self._worker.stopping.set()
        self._end_child()
        self._wishes.put(None)
        self._worker.stop(ENDING_S + 1.0)

    def view(self) -> TrainingView:
        """The newest frozen picture; polled at the display rate."""
        return self._view

    def start(self, preset: Preset = Preset.DEFAULT, seed: int = 0) -> None:
        """Train from the takes that count now."""
        with self._lock:
            if self._view.phase is TrainingPhase.RUNNING:
                return
            self._is_cancelled = False
            self._show(TrainingPhase.RUNNING, STARTING)
        self._wishes.put((preset, seed))

    def cancel(self) -> None:
        """End the training; the model there was stays."""
        if self._view.phase is TrainingPhase.RUNNING:
            self._end_child()

    # The thread.

    def _ended(self, error: WorkerError) -> None:
        """Nobody sees any more whether a model still fits the takes."""
        self._use_model(None, f"{error}; restart the application", "")

    def _run(self, stopping: threading.Event) -> None:
        while not stopping.is_set():
            with contextlib.suppress(queue.Empty):
                wish = self._wishes.get(timeout=LOOK_S)
                if wish is not None:
                    self._train(*wish)
            self._look()

    def _look(self) -> None:
        """Compare the open person's model with the takes that count now."""
        picture = self._source.snapshot()
        if not self._known.look(self._data, picture, self._source.takes):
            return
        known = self._known
        with self._lock:  # a start in between must not be overwritten
            view = self._view
            if known.is_other_person and view.phase is not TrainingPhase.RUNNING:
                view = TrainingView()
            text = known.trouble if view.phase is TrainingPhase.IDLE else view.text
            self._view = replace(
                view, result=known.result, out_of_date=known.out_of_date, text=text
            )
        if known.result is not None:
            self._use_model(known.path, known.out_of_date, picture.person)
        elif picture.person:  # another's model is not for these arms, nor one that is gone
            self._use_model(None, known.trouble, picture.person)

    def _train(self, preset: Preset, seed: int) -> None:
        """One training, from the press to the written model."""
        begun_s = self._clock()
        self._look()
        person, takes = self._open_takes()
        if not person:
            self._end(TrainingPhase.FAILED, "nobody's takes are open: choose a person first")
            return
        chosen = set_of(takes, person)
        if missing := missing_words(chosen.labels):
            self._end(TrainingPhase.FAILED, missing)
            return
        try:
            folder = Path(tempfile.mkdtemp(prefix="gestureapp-training-"))
            try:
                self._train_in(folder, person, chosen, preset, seed, begun_s)
            finally:
                shutil.rmtree(folder, ignore_errors=True)
        except GestureAppError as error:
            self._end(TrainingPhase.FAILED, str(error))
        except OSError as error:
            where = f" ({error.filename})" if error.filename else ""
            text = f"the training could not be started: {error.strerror or error}{where}"
            self._end(TrainingPhase.FAILED, text)

    def _open_takes(self) -> tuple[str, tuple[Take, ...]]:
        """Whose takes are open, and they: asked again when another person came in between."""
        while True:
            before, takes = self._source.snapshot(), self._source.takes()
            if self._source.snapshot().person == before.person:
                return before.person, takes

    def _train_in(
        self, folder: Path, person: str, takes: TakeSet, preset: Preset, seed: int, begun_s: float
    ) -> None:
        n_sessions = len(set(map(sitting_of, takes.session)))
        sittings = "1 sitting" if n_sessions == 1 else f"{n_sessions} sittings"
        came_from = f"{len(takes)} takes of {person} in {sittings}"
        job = Job(folder / "takes.npz", folder / "model.json", preset, seed, came_from)
        save_takes(job.takes, takes)
        failure = self._have_trained(job)
        if self._is_cancelled or failure:
            phase = TrainingPhase.CANCELLED if self._is_cancelled else TrainingPhase.FAILED
            self._end(phase, "cancelled" if self._is_cancelled else failure)
            return
        model = load_model(job.out)
        took_s = round(self._clock() - begun_s, 3)
        record = replace(model.training, duration_s=took_s)
        save_model(model_path(self._data, person), replace(model, training=record, person=person))
        self._view = replace(self._view, done=1.0, remaining_s=0.0)
        self._look()
        self._show(TrainingPhase.DONE, f"{person}'s model is trained; it took {took_s:.1f} s")

    def _have_trained(self, job: Job) -> str:
        """Let a child do it and show its progress; why there is no model, or empty."""
        child = self._start_child()
        if child is None or child.stdin is None or child.stdout is None:
            return ""
        failure = "the training process ended without a word: train again"
        try:
            with contextlib.suppress(OSError):  # it has ended already, or was cancelled
                child.stdin.write(job.as_line())
                child.stdin.flush()
            for line in child.stdout:
                match parse_answer(line):
                    case Progress() as told:
                        self._show_progress(told)
                    case Finished():
                        failure = ""
                    case Failed() as told:
                        failure = told.text
        finally:
            with contextlib.suppress(OSError):
                child.stdin.close()
            child.wait()
            child.stdout.close()
            with self._lock:
                self._child = None
        return failure

    def _start_child(self) -> subprocess.Popen[bytes] | None:
        """The child; None when it was cancelled before.

        Raises:
            OSError: the system could not start it.
        """
        with self._lock:
            if self._is_cancelled or self._worker.stopping.is_set():
                self._is_cancelled = True
                return None
            self._child = start_beside(self._command, is_spoken_with=True)
            return self._child

    def _end_child(self) -> None:
        """Cancel: any thread; does not wait."""
        with self._lock:
            self._is_cancelled = True
            if self._child is not None:
                self._child.kill()

    def _show_progress(self, told: Progress) -> None:
        losses = (*self._view.losses, (told.done, told.loss))[-KEPT_LOSSES:]
        self._view = replace(
            self._view,
            done=told.done / told.total,
            remaining_s=told.remaining_s,
            losses=losses,
            text=f"pass {told.done:,} of {told.total:,}",
        )

    def _end(self, phase: TrainingPhase, text: str) -> None:
        """End without a new model."""
        kept = "; the model there was is kept" if self._known.result is not None else ""
        self._show(phase, f"{text}{kept}")

    def _show(self, phase: TrainingPhase, text: str) -> None:
        is_new = phase is TrainingPhase.RUNNING
        view = self._view
        self._view = replace(
            view,
            phase=phase,
            text=text,
            done=0.0 if is_new else view.done,
            remaining_s=float("nan") if phase is not TrainingPhase.DONE else 0.0,
            losses=() if is_new else view.losses,
        )
