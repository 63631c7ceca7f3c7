"""Guided training as the window sees it: wishes in, a frozen picture out, one thread in between.

The thread reads what the sensors' readers keep, commits takes and thinks; the window's thread only
puts wishes into a queue and looks at the newest picture. It asks nothing of the robot.
"""

import queue
import threading
import time
from collections.abc import Callable
from concurrent.futures import Future
from concurrent.futures import TimeoutError as FutureTimeoutError
from dataclasses import replace
from pathlib import Path
from typing import Final

from gestureapp.clock import Clock, monotonic
from gestureapp.errors import RecordingError, WorkerError
from gestureapp.guided.arms import SensedCell
from gestureapp.guided.desk import Desk
from gestureapp.guided.sitting import Sitting
from gestureapp.guided.values import GuidedSnapshot, Pace, Phase
from gestureapp.recording.people import last_person, list_people
from gestureapp.recording.take_values import Take
from gestureapp.worker import Worker

TICK_S: Final = 0.01
"""While something is recorded or tried."""
IDLE_TICK_S: Final = 0.05
"""Otherwise: often enough for a level indicator, and hardly any work beside operation."""
OPEN_LIMIT_S: Final = 5.0
"""A person's database opens within some ten milliseconds; a disk that takes longer is told."""

Wish = Callable[[Desk], None]
"""What the window asks of the thread."""


class Guided:
    """Guided training with its thread; implements ``GuidedControls``.

    Args:
        cell: Whose sensors.
        data: The data folder.
        clock: Monotonic seconds.
        wall_clock: Seconds since the epoch.
        on_ended: Told in words when the thread has ended by an error: nobody sees any more whether
            a model still fits the takes.
    """

    def __init__(
        self,
        cell: SensedCell,
        data: Path,
        clock: Clock = monotonic,
        wall_clock: Clock = time.time,
        on_ended: Callable[[str], None] = lambda text: None,
    ) -> None:
        self._data = data
        self._desk = Desk(cell, data, clock, wall_clock)
        self._wishes: queue.SimpleQueue[Wish] = queue.SimpleQueue()
        self._worker = Worker("guided training", self._run, lambda error: on_ended(_ended(error)))

    def start_thread(self) -> None:
        """Start the thread. Once only."""
        self._worker.start()

    def shutdown(self) -> None:
        """End the thread; takes in progress are dropped, all others are kept. Idempotent."""
        self._worker.stop(OPEN_LIMIT_S)

    def snapshot(self) -> GuidedSnapshot:
        """The newest frozen picture; polled at the display rate."""
        picture, error = self._desk.picture, self._worker.error
        return picture if error is None else replace(picture, trouble=_ended(error))

    def people(self) -> tuple[str, ...]:
        """Names of everybody who has takes here."""
        return list_people(self._data)

    def last_person(self) -> str:
        """Whose takes were opened last, also in an earlier run; empty when nobody's were."""
        return last_person(self._data)

    def open(self, person: str) -> None:
        """Choose whose takes these are; a new name begins a new database.

        Raises:
            RecordingError: it cannot be opened or made; says why and what to do. Another person's
                takes stay open then.
        """
        self._ask_and_wait(lambda desk: desk.open(person))

    def close(self) -> None:
        """End the batch and put the person's database away. Idempotent."""
        self._ask_and_wait(Desk.close)

    def choose(self, label: str) -> None:
        """Record this gesture next; ends the batch under way."""
        self._ask(lambda sitting: sitting.choose(label))

    def set_pace(self, pace: Pace, beat_s: float) -> None:
        """What begins a take, from the next batch on; the time between two beats, 1.1 to 5.0 s."""
        self._wishes.put(lambda desk: desk.set_pace(pace, beat_s))

    def set_wanted(self, n_takes: int) -> None:
        """How many good takes of each gesture are wanted, 5 to 200."""
        self._wishes.put(lambda desk: desk.set_wanted(n_takes))

    def start(self) -> None:
        """Begin a batch of the chosen gesture: a count-in, then takes."""
        self._wishes.put(Desk.start)

    def pause(self) -> None:
        """Hold the batch; the take in progress is dropped."""
        self._ask(Sitting.pause)

    def go_on(self) -> None:
        """Go on after a pause, with a count-in."""
        self._wishes.put(Desk.go_on)

    def end_batch(self) -> None:
        """End the batch; what was taken is kept."""
        self._ask(Sitting.end_batch)

    def redo_last(self) -> None:
        """Put the last take of the batch into the bin: it is done again."""
        self._ask(Sitting.redo_last)

    def undo(self) -> None:
        """Take back the last change of the takes: a take, exclusion, move or deletion."""
        self._ask(Sitting.undo)

    def redo(self) -> None:
        """Do it again after all."""
        self._ask(Sitting.redo)

    def exclude(self, take_id: int, *, is_excluded: bool = True) -> None:
        """Take a take out of the training, or back in."""
        self._ask(lambda sitting: sitting.exclude(take_id, is_excluded=is_excluded))

    def move(self, take_id: int, label: str) -> None:
        """Say that a take shows another gesture."""
        self._ask(lambda sitting: sitting.move(take_id, label))

    def delete(self, take_id: int) -> None:
        """Put a take into the bin; ``undo`` gets it back."""
        self._ask(lambda sitting: sitting.delete(take_id))

    def takes(self, label: str = "") -> tuple[Take, ...]:
        """The takes of a gesture, or all, oldest first, without the bin's."""
        if self._desk.picture.phase is Phase.CLOSED:
            return ()
        takes = self._desk.takes
        return tuple(take for take in takes if take.label == label) if label else takes

    def start_trying(self, per_gesture: int = 5) -> None:
        """Ask for every gesture so often, in random order, and count what the model hears."""
        self._wishes.put(lambda desk: desk.start_trying(per_gesture))

    def stop_trying(self) -> None:
        """End it; what was counted is kept."""
        self._wishes.put(Desk.stop_trying)

    def keep_heard(self, number: int) -> None:
        """Keep the last activation as a take of its person; what comes of it is in ``heard``."""
        self._wishes.put(lambda desk: desk.keep_heard(number))

    # The thread.

    def _ask(self, act: Callable[[Sitting], None]) -> None:
        """Let the thread do something with the open takes, if any are."""

        def wish(desk: Desk) -> None:
            if desk.sitting is not None:
                act(desk.sitting)

        self._wishes.put(wish)

    def _ask_and_wait(self, wish: Wish) -> None:
        answer: Future[None] = Future()

        def answered(desk: Desk) -> None:
            try:
                wish(desk)
            except RecordingError as error:
                answer.set_exception(error)
            else:
                answer.set_result(None)

        if self._worker.error is not None:
            raise RecordingError(self._data, _ended(self._worker.error))
        if not self._worker.is_alive:
            return
        self._wishes.put(answered)
        try:
            answer.result(OPEN_LIMIT_S)
        except FutureTimeoutError as error:
            reason = f"the disk has not answered for {OPEN_LIMIT_S:g} s; check it, then try again"
            raise RecordingError(self._data, reason) from error

    def _run(self, stopping: threading.Event) -> None:
        try:
            while not stopping.is_set():
                self._grant(TICK_S if self._desk.is_busy else IDLE_TICK_S)
                self._desk.step()
        finally:
            self._desk.close()

    def _grant(self, wait_s: float) -> None:
        """Wait for a wish at most so long, and fulfil it."""
        try:
            wish = self._wishes.get(timeout=wait_s)
        except queue.Empty:
            return
        wish(self._desk)


def _ended(error: WorkerError) -> str:
    return f"{error}; every take so far is kept; restart the application"
