"""The recorder: takes what happens in the cell and writes one session file, whatever the disk does.

    any thread: put() -> backlog -> recorder's thread: step() every 50 ms -> chunk -> disk (0.8 s)

The cell never waits for it. A disk that is slow costs plot data, one that fails costs nothing until
the backlog is full: the records since the last confirmed chunk go into the next file, so that two
files can hold the same records at their seam, and none is missing.
"""

import logging
import secrets
import threading
from collections.abc import Callable, Mapping
from datetime import UTC, datetime
from pathlib import Path

from gestureapp.cell.records import Json, Record, Topic
from gestureapp.clock import Clock
from gestureapp.errors import WorkerError
from gestureapp.recording.backlog import Backlog, Dropped, Entry
from gestureapp.recording.mcap_file import (
    Anchor,
    McapFile,
    OpenFile,
    explain,
    open_new,
)
from gestureapp.worker import Worker

log = logging.getLogger(__name__)

STEP_S = 0.05
"""Short, so that a step has few records only and holds the interpreter lock for less than 1 ms."""
CATCH_UP_S = 0.01
"""Between steps while more waits: some 10,000 records a second, and others get their turn."""
BATCH = 100
"""Records a step, at 12 us each."""
SYNC_S = 0.5
"""A chunk's age when it goes to the disk. A disk that is slow to confirm takes some 0.2 s more;
what a killed process loses stays below a second."""
STALL_S = 2.0
"""A write that takes longer than this is told to the person and put in the record."""
RETRY_MIN_S = 1.0
RETRY_MAX_S = 30.0
"""The first and the longest pause before a new file is tried."""


class SessionWriter:
    """Records one session; a :data:`gestureapp.cell.records.Recorder`.

    Made and stopped by its owner, fed from any thread. Its own thread, ``recorder``, does the rest.

    Args:
        folder: Under it, ``sessions/YYYY-MM-DDTHH-MM-SSZ_<6 hex>.mcap`` is written.
        clock: Monotonic seconds, the clock of the records' ``t_s``.
        wall_clock: Seconds since the epoch; read once for each file.
        metadata: What the file says of the session: mode, person, sensors, model, settings.
        backlog: Where records wait; its limits bound the memory.
        open_file: How a file is made.
    """

    def __init__(
        self,
        folder: Path,
        clock: Clock,
        wall_clock: Clock,
        metadata: Mapping[str, str],
        *,
        backlog: Backlog | None = None,
        open_file: OpenFile = open_new,
    ) -> None:
        self._folder = folder / "sessions"
        self._clock = clock
        self._wall_clock = wall_clock
        self._metadata = dict(metadata)
        self._backlog = backlog if backlog is not None else Backlog()
        self._open_file = open_file
        self._worker = Worker("recorder", self._run, self._on_worker_error)
        self._has_started = False
        self._is_closed = False
        # Below: written by the recorder's thread, read by any.
        self._path: Path | None = None
        self._failure = ""
        self._busy_since_s: float | None = None
        # Below: the recorder's thread only.
        self._file: McapFile | None = None
        self._unconfirmed: list[Entry] = []
        self._sync_at_s = 0.0
        self._retry_at_s = float("-inf")
        self._retry_pause_s = RETRY_MIN_S
        self._failed_at_s: float | None = None
        self._continues: Path | None = None
        self._told = Dropped()

    def __call__(self, record: Record) -> None:
        """The same as :meth:`put`."""
        self.put(record)

    def put(self, record: Record) -> None:
        """Take a record at once; any thread, never blocks. After the end it is only counted."""
        if self._is_closed:
            self._backlog.count_dropped(record)
        else:
            self._backlog.put(record)

    def start(self) -> None:
        """Start the recorder's thread. Once only; records put before are kept."""
        self._has_started = True
        self._worker.start()

    def stop(self, wait_s: float = 3.0) -> None:
        """Write what waits and finish the file; idempotent.

        Waits at most ``wait_s`` for a disk that does not take it: ``status`` then says so.
        """
        if not self._worker.stop(wait_s):
            log.warning("%s", self.status)
        if not self._has_started:
            self._is_closed = True

    @property
    def path(self) -> Path | None:
        """The file that is being written or was written last; None before the first."""
        return self._path

    @property
    def n_dropped(self) -> int:
        """Records that did not reach the disk, since the start."""
        return self._backlog.dropped.n_all

    @property
    def dropped(self) -> Dropped:
        """The same, plot data and decisions apart."""
        return self._backlog.dropped

    @property
    def is_recording(self) -> bool:
        """The file is open and the disk keeps up."""
        is_well = self._worker.error is None and not self._failure and not self._is_closed
        return is_well and self._path is not None and self._stalled_s() == 0.0

    @property
    def status(self) -> str:
        """One line for the window: where the session is recorded, or why not and what to do."""
        if self._worker.error is not None:
            return f"Not recording: {self._worker.error}. Start the application again to record."
        failure, stalled_s = self._failure, self._stalled_s()
        lost = _lost_text(self._backlog.dropped)
        if failure:
            return f"Not recording: {failure}.{lost}"
        if stalled_s:
            return (
                f"Recording stalls: the disk has taken nothing for {stalled_s:.0f} s; "
                f"check the disk of {self._folder}.{lost}"
            )
        if self._path is None:
            return "Recording starts." if self._has_started else "Not recording: not started yet."
        return f"{'Recorded' if self._is_closed else 'Recording'} to {self._path}.{lost}"

    def _stalled_s(self) -> float:
        """How long the disk has taken nothing, once that is too long; else 0."""
        busy_since_s = self._busy_since_s
        if busy_since_s is None:
            return 0.0
        busy_s = self._clock() - busy_since_s
        return busy_s if busy_s > STALL_S else 0.0

    # The recorder's thread.

    def step(self) -> bool:
        """Write the next records, and the chunk when it is due. The recorder's thread only.

        Returns:
            Whether more can be written at once.
        """
        if self._file is None and not self._open():
            return False
        entries = self._backlog.take(BATCH)
        self._unconfirmed += entries
        self._guarded(lambda: self._write(entries))
        return len(entries) == BATCH and self._file is not None

    def close(self) -> None:
        """Write all that waits and finish the file. The recorder's thread only; idempotent."""
        if self._is_closed:
            return
        self._is_closed = True
        # Twice: what a file that fails at its very end did not take has one chance in another.
        if not self._finish() and not self._finish():
            self._give_up_rest()

    def _run(self, stopping: threading.Event) -> None:
        pause_s = 0.0
        while not stopping.wait(pause_s):
            pause_s = CATCH_UP_S if self.step() else STEP_S
        self.close()

    def _finish(self) -> bool:
        """Write what waits and end the file; returns whether nothing is left over."""
        self._retry_at_s = float("-inf")
        while self.step():
            pass
        self.step()  # the recorder's own line on what it has just seen
        file = self._file
        if file is not None and self._guarded(file.finish):
            self._file = None
            self._unconfirmed.clear()
        return not len(self._backlog)

    def _write(self, entries: list[Entry]) -> None:
        file = self._file
        if file is None:
            return
        for _, record in entries:
            if not file.write(record):
                self._backlog.count_dropped(record)
                log.error("a record of %s cannot be written as JSON", record.topic.value)
        now_s = self._clock()
        if now_s >= self._sync_at_s:
            file.sync()
            self._unconfirmed.clear()
            self._sync_at_s = self._clock() + SYNC_S

    def _open(self) -> bool:
        """Make the next file, unless it is too early to try again."""
        now_s = self._clock()
        if now_s < self._retry_at_s:
            return False
        before_s = self._clock()
        wall_s = self._wall_clock()
        # Whole microseconds: a float that counts seconds since 1970 has no more.
        anchor = Anchor(round(wall_s * 1e6) * 1000, (before_s + self._clock()) / 2)
        stamp = datetime.fromtimestamp(wall_s, UTC).strftime("%Y-%m-%dT%H-%M-%SZ")
        path = self._folder / f"{stamp}_{secrets.token_hex(3)}.mcap"
        metadata = dict(self._metadata)
        if self._continues is not None:
            metadata["continues"] = self._continues.name
        return self._guarded(lambda: self._make(path, anchor, metadata), path)

    def _make(self, path: Path, anchor: Anchor, metadata: Mapping[str, str]) -> None:
        file = McapFile(path, anchor, metadata, self._open_file)
        self._file = file
        if self._failed_at_s is not None:
            silent_s = self._clock() - self._failed_at_s
            self._tell(f"The record was interrupted for {silent_s:.1f} s: {self._failure}.")
        self._path = path
        self._failure = ""
        self._failed_at_s = None
        self._retry_pause_s = RETRY_MIN_S
        self._sync_at_s = self._clock() + SYNC_S
        log.info("recording to %s", path)

    def _guarded(self, work: Callable[[], None], path: Path | None = None) -> bool:
        """Do something with the disk: time it, and turn its failure into words and a retry."""
        started_s = self._clock()
        self._busy_since_s = started_s
        try:
            work()
        except OSError as error:
            self._on_disk_error(error, path)
            return False
        finally:
            self._busy_since_s = None
        self._tell_of_stall(self._clock() - started_s)
        return True

    def _tell_of_stall(self, busy_s: float) -> None:
        """Put in the record that the disk was slow, or that something was dropped meanwhile."""
        if busy_s > STALL_S:
            self._tell(f"The disk took nothing for {busy_s:.1f} s.")
        elif self._backlog.dropped != self._told and len(self._backlog) < BATCH:
            self._tell("The record has a gap.")

    def _tell(self, text: str) -> None:
        """Add a line to the record. It says what was dropped since the last such line."""
        dropped = self._backlog.dropped
        new = Dropped(
            dropped.n_plot - self._told.n_plot, dropped.n_decisions - self._told.n_decisions
        )
        self._told = dropped
        text += _lost_text(new)
        log.warning("%s", text)
        if self._file is not None:
            fields: Mapping[str, Json] = {"text": text, "is_alarm": new.n_all > 0}
            self._backlog.put(Record(Topic.EVENT, self._clock(), fields))

    def _on_disk_error(self, error: OSError, path: Path | None) -> None:
        now_s = self._clock()
        file, self._file = self._file, None
        if file is not None:
            file.abandon()
            self._continues = file.path if file.has_chunk else self._continues
            self._path = self._continues
        self._backlog.restore(self._unconfirmed)
        self._unconfirmed = []
        if self._failed_at_s is None:
            self._failed_at_s = now_s
        self._retry_at_s = now_s + self._retry_pause_s
        where = path or (file.path if file is not None else self._folder)
        self._failure = str(explain(where, error)).rstrip(".")
        log.warning("not recording: %s; next try in %.0f s", self._failure, self._retry_pause_s)
        self._retry_pause_s = min(2 * self._retry_pause_s, RETRY_MAX_S)

    def _give_up_rest(self) -> None:
        """Count what waits for a disk that takes nothing at the very end."""
        while entries := self._backlog.take(BATCH):
            for _, record in entries:
                self._backlog.count_dropped(record)

    def _on_worker_error(self, error: WorkerError) -> None:
        self._is_closed = True
        file, self._file = self._file, None
        if file is not None:
            file.abandon()
        log.error("%s", error)


def _lost_text(dropped: Dropped) -> str:
    """What was dropped, as a sentence with a space before it; empty when nothing was."""
    parts = []
    if dropped.n_plot:
        parts.append(f"{dropped.n_plot} samples")
    if dropped.n_decisions:
        parts.append(f"{dropped.n_decisions} decisions")
    return f" Not recorded: {' and '.join(parts)}." if parts else ""
