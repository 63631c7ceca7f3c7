"""One person's takes, open, with the batch under way: what the guided thread drives.

Owned by the guided thread; knows its clock only as an argument. Everything that may fail on the
disk ends in ``trouble``, a line for the person, and a pause; what was taken before stays.
"""

from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Final

from gestureapp.errors import RecordingError
from gestureapp.guided import order
from gestureapp.guided.arms import Arms
from gestureapp.guided.batch import Batch
from gestureapp.guided.likeness import Likeness
from gestureapp.guided.values import GestureProgress, Pace, Phase
from gestureapp.guided.verdict import judge
from gestureapp.guided.words import batch_sentence, idle_sentence
from gestureapp.recording.take_store import NewTake, TakeStore
from gestureapp.recording.take_values import F64, Take, confirmed, sitting_of
from gestureapp.sensing.values import ArmPosture

SAME_SITTING_S: Final = 1800.0
"""Who comes back sooner (after a break, a fault, a restart) still sits there with the sensors on:
takes of one sitting must not be split, or a model would be checked on what it has learned from."""


@dataclass(frozen=True, slots=True)
class Plan:
    """How to record, as the person has chosen it.

    Attributes:
        pace: What begins a take.
        beat_s: Time between two beats.
        wanted: Good takes of each gesture.
    """

    pace: Pace
    beat_s: float
    wanted: int


class Sitting:
    """A person's open database and the batch under way. Owned by the guided thread.

    Args:
        data: The data folder.
        person: Whose takes.
        plan: How to record.
        arms: Both arms.
        wall_s: Now, seconds since the epoch.

    Raises:
        RecordingError: the database cannot be opened; says why and what to do.

    Attributes:
        label: The gesture that is, or would be, recorded; empty when all is done.
        batch: The batch under way or the last one, or None.
        trouble: Takes cannot be kept, with cause and remedy; empty when they can.
        version: Grows with every change of the takes.
        takes: All, oldest first, without the bin's.
        batch_takes: Those of the batch.
        n_in_batch: Good ones of the batch.
        progress: Of every gesture.
        suggested: What to record next; empty when all is done.
    """

    def __init__(self, data: Path, person: str, plan: Plan, arms: Arms, wall_s: float) -> None:
        self._store = TakeStore(data, person)
        self._arms = arms
        self._plan = plan
        self._session = _session_of(self._store.takes(), wall_s)
        self._batch_ids: set[int] = set()
        self._batch_label = ""
        self._likeness = Likeness()
        self._good: dict[str, int] = {}
        self.batch: Batch | None = None
        self.trouble = self._store.damage
        self.version = 0
        self.progress: tuple[GestureProgress, ...] = ()
        self.suggested = ""
        self.takes: tuple[Take, ...] = ()
        self.batch_takes: tuple[Take, ...] = ()
        self.n_in_batch = 0
        self.label = ""
        self._count()

    @property
    def person(self) -> str:
        """Whose takes these are."""
        return self._store.person

    @property
    def undo_words(self) -> str:
        """What undo would take back; empty when nothing."""
        return self._store.undo_words

    @property
    def redo_words(self) -> str:
        """What redo would do again; empty when nothing."""
        return self._store.redo_words

    @property
    def phase(self) -> Phase:
        """Where the recording stands."""
        return Phase.IDLE if self.batch is None else self.batch.phase

    def sentence(self) -> str:
        """What to do now, or why it does not go on."""
        if self.batch is None or self.batch.is_over:
            return idle_sentence(self.label, self.suggested)
        return batch_sentence(self.batch, self.label, self._good[self.label])

    def close(self) -> None:
        """End the batch and put the database away. Idempotent."""
        self.end_batch()
        self._store.close()

    # The batch.

    def set_plan(self, plan: Plan) -> None:
        """Record like this from the next batch on."""
        self._plan = plan
        self._count()

    def choose(self, label: str) -> None:
        """Record this gesture next; ends the batch under way."""
        if label in self._good:
            self.end_batch()
            self.label = label

    def start(self, now_s: float) -> None:
        """Begin a batch of the chosen gesture."""
        if not self.label:
            return
        self.trouble = ""
        self._batch_ids, self._batch_label = set(), self.label
        self._count()
        size = order.batch_size(self._good[self.label], self._plan.wanted)
        pace, beat_s = self._plan.pace, self._plan.beat_s
        self.batch = Batch(pace, beat_s, size, now_s, self._arms.posture)

    def pause(self) -> None:
        """Hold the batch; the take in progress is dropped."""
        if self.batch is not None:
            self.batch.pause()

    def go_on(self, now_s: float) -> None:
        """Go on after a pause."""
        if self.batch is not None:
            self.trouble = ""
            self.batch.go_on(now_s)

    def end_batch(self) -> None:
        """End the batch; what was taken is kept."""
        if self.batch is not None:
            self.batch.end()

    # The takes.

    def redo_last(self) -> None:
        """Put the last take of the batch into the bin; its gesture is the chosen one again."""
        if self.batch_takes:
            self.delete(self.batch_takes[-1].id)
            self.label = self._batch_label

    def undo(self) -> None:
        """Take back the last change of the takes."""
        self._change(lambda store: store.undo())

    def redo(self) -> None:
        """Do it again after all."""
        self._change(lambda store: store.redo())

    def exclude(self, take_id: int, *, is_excluded: bool) -> None:
        """Take a take out of the training, or back in."""
        self._change(lambda store: store.exclude(take_id, is_excluded=is_excluded))

    def move(self, take_id: int, label: str) -> None:
        """Say that a take shows another gesture."""
        if label in self._good:
            self._change(lambda store: store.move(take_id, label))

    def delete(self, take_id: int) -> None:
        """Put a take into the bin."""
        self._change(lambda store: store.delete(take_id))

    def keep(self, label: str, samples: tuple[F64, F64], wall_s: float) -> Take | None:
        """Keep what was done outside a batch, judged like every take; None when the disk refuses.

        Args:
            label: What was done.
            samples: Times from the activation (k,), and (k, 3) in g.
            wall_s: When it was activated, seconds since the epoch.
        """
        take = self._add(label, confirmed(self._session), wall_s, samples)
        if take is not None:
            self._changed()
        return take

    # Time.

    def step(
        self, now_s: float, wall_s: float, postures: tuple[tuple[float, ArmPosture], ...]
    ) -> None:
        """Let time pass: ``postures`` of the left arm came since the last step."""
        batch = self.batch
        if batch is None or batch.is_over:
            return
        for t_s, posture in postures:
            batch.left(t_s, posture)
        lost = self._arms.lost(with_left=batch.pace is Pace.HANDS_FREE)
        activation_s = batch.tick(now_s, lost)
        if activation_s is not None:
            self._keep(activation_s, wall_s - (now_s - activation_s))
            self._prefer_suggestion()

    def _prefer_suggestion(self) -> None:
        """After a batch the next gesture is chosen already."""
        if self.phase is Phase.IDLE and self.suggested:
            self.label = self.suggested

    def _keep(self, activation_s: float, wall_s: float) -> None:
        take = self._add(self.label, self._session, wall_s, self._arms.cut(activation_s))
        if take is not None:
            self._batch_ids.add(take.id)
            self._changed()

    def _add(
        self, label: str, session: str, wall_s: float, samples: tuple[F64, F64]
    ) -> Take | None:
        judgement = judge(label, *samples, self.takes, self._likeness)
        try:
            return self._store.add(NewTake(label, session, wall_s, judgement, *samples))
        except RecordingError as error:
            self._fail(error)
            return None

    def _change(self, act: Callable[[TakeStore], object]) -> None:
        try:
            act(self._store)
        except RecordingError as error:
            self._fail(error)
        else:
            self._changed()

    def _changed(self) -> None:
        self.trouble = ""
        self.version += 1
        self._count()
        if self.batch is not None and not self.batch.is_over:
            self.batch.judged(self.n_in_batch)

    def _fail(self, error: RecordingError) -> None:
        self.trouble = str(error)
        self.pause()

    def _count(self) -> None:
        self.takes = tuple(take for take in self._store.takes() if not take.is_deleted)
        self.batch_takes = tuple(take for take in self.takes if take.id in self._batch_ids)
        self.n_in_batch = order.count_good(self.batch_takes).get(self._batch_label, 0)
        self._good = order.count_good(self.takes)
        qualities = self._likeness.qualities(self.takes)
        self.progress = order.progress(self._good, self._plan.wanted, qualities)
        self.suggested = order.suggest(self._good, self._plan.wanted)
        self.label = self.label or self.suggested


def _session_of(takes: tuple[Take, ...], wall_s: float) -> str:
    """The sitting that goes on, or a new one."""
    if takes and 0.0 <= wall_s - takes[-1].wall_s < SAME_SITTING_S:
        return sitting_of(takes[-1].session)
    return datetime.fromtimestamp(wall_s, UTC).isoformat(timespec="seconds")
