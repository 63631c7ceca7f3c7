"""What a window may ask of guided training: the whole surface between its threads and the shell."""

from typing import Protocol

from gestureapp.guided.values import GuidedSnapshot, Pace, TrainingView
from gestureapp.recognition.presets import Preset
from gestureapp.recording.take_values import Take


class GuidedControls(Protocol):
    """Recording, judging and trying, seen from the window's thread. No call blocks for long."""

    def snapshot(self) -> GuidedSnapshot:
        """The newest frozen picture; polled at the display rate."""

    def people(self) -> tuple[str, ...]:
        """Names of everybody who has takes here."""

    def last_person(self) -> str:
        """Whose takes were opened last, also in an earlier run; empty when nobody's were."""

    def open(self, person: str) -> None:
        """Choose whose takes these are; a new name begins a new database.

        Raises:
            RecordingError: it cannot be opened or made; says why and what to do. Another person's
                takes stay open then.
        """

    def close(self) -> None:
        """End the batch and put the person's database away. Idempotent."""

    def choose(self, label: str) -> None:
        """Record this gesture next; ends the batch under way."""

    def set_pace(self, pace: Pace, beat_s: float) -> None:
        """What begins a take; the time between two beats, 1.1 to 5.0 s."""

    def set_wanted(self, n_takes: int) -> None:
        """How many good takes of each gesture are wanted, 5 to 200."""

    def start(self) -> None:
        """Begin a batch of the chosen gesture: a count-in, then takes."""

    def pause(self) -> None:
        """Hold the batch; the take in progress is dropped."""

    def go_on(self) -> None:
        """Go on after a pause, with a count-in."""

    def end_batch(self) -> None:
        """End the batch; what was taken is kept."""

    def redo_last(self) -> None:
        """Put the last take of the batch into the bin: it is done again."""

    def undo(self) -> None:
        """Take back the last change of the takes: a take, exclusion, move or deletion."""

    def redo(self) -> None:
        """Do it again after all."""

    def exclude(self, take_id: int, *, is_excluded: bool = True) -> None:
        """Take a take out of the training, or back in."""

    def move(self, take_id: int, label: str) -> None:
        """Say that a take shows another gesture."""

    def delete(self, take_id: int) -> None:
        """Put a take into the bin; ``undo`` gets it back."""

    def takes(self, label: str = "") -> tuple[Take, ...]:
        """The takes of a gesture, or all, oldest first, without the bin's."""

    def start_trying(self, per_gesture: int = 5) -> None:
        """Ask for every gesture so often, in random order, and count what the model hears."""

    def stop_trying(self) -> None:
        """End it; what was counted is kept."""

    def keep_heard(self, number: int) -> None:
        """Keep the last activation as a take of its person; what comes of it is in ``heard``.

        Args:
            number: ``Heard.number`` of the one that the person saw.
        """


class TrainerControls(Protocol):
    """Training of the chosen person's model in a child process. No call blocks."""

    def view(self) -> TrainingView:
        """The newest frozen picture; polled at the display rate."""

    def start(self, preset: Preset = Preset.DEFAULT, seed: int = 0) -> None:
        """Train from the takes that count now."""

    def cancel(self) -> None:
        """End the training; the model there was stays."""
