"""What the guardian did when no application could show it: told once, at the next start."""

import contextlib
import logging
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from gestureapp.robot.acts import Did, Unseen, find_unseen
from gestureapp.robot.values import StopReason

log = logging.getLogger(__name__)

_CAUSES = {
    StopReason.STOP_PRESSED.value: "STOP was pressed",
    StopReason.LEFT_SILENT.value: "the left sensor fell silent",
    StopReason.RIGHT_LOST.value: "the right sensor was lost",
    StopReason.COMPUTER_STALLED.value: "the computer stood still",
    StopReason.APPLICATION_STALLED.value: "the program stood still",
    StopReason.WINDOW_STALE.value: "the window froze",
    StopReason.APPLICATION_GONE.value: "the program ended",
    StopReason.LINK_LOST.value: "the connection to the robot was lost",
    StopReason.ROBOT_ALARM.value: "the robot reported an alarm",
    StopReason.ROBOT_CHANGED.value: "the robot was held or switched elsewhere",
    StopReason.UNEXPECTED_MOTION.value: "the robot moved without a command",
    StopReason.CELL_FAULT.value: "a part of the program failed",
    StopReason.DISARMED.value: "the program was disarmed",
    StopReason.STOP_TEST.value: "a stop test ended",
}
_LOOK = "Look at the robot before you arm."


@dataclass(frozen=True, slots=True)
class LastTime:
    """A stop of an earlier run that nobody has been shown yet.

    Attributes:
        text: For the operator: what happened, whether the robot stood, what to do.
        event: The same in a few words, for the cell's story.
        details: For whoever looks for the cause: the guardian's own words and its log.
        key: Of this stop, in the file of what was shown.
        shown_file: That file.
    """

    text: str
    event: str
    details: str
    key: str
    shown_file: Path

    def note_shown(self) -> None:
        """A person has it before their eyes: it is not told again."""
        try:
            self.shown_file.write_text(f"{self.key}\n", encoding="utf-8")
        except OSError as error:  # then it is told once more
            log.warning("%s: %s", self.shown_file, error.strerror)


def find_last_time(guardian_log: Path) -> LastTime | None:
    """What is still to be told of earlier runs, or None. Damaged and missing files tell nothing.

    Args:
        guardian_log: Of the guardians; the older one has ``.1`` after its name.
    """
    unseen = find_unseen(_lines(guardian_log))
    shown_file = guardian_log.with_suffix(".shown")
    if unseen is None or unseen.key == _shown(shown_file):
        return None
    text, event, details = _words(unseen, guardian_log.absolute())
    return LastTime(text, event, details, unseen.key, shown_file)


def _words(unseen: Unseen, guardian_log: Path) -> tuple[str, str, str]:
    """For the operator, for the cell's story, and for whoever looks for the cause."""
    then = time.localtime(unseen.stop.wall_s)
    when, day = time.strftime("%H:%M:%S", then), time.strftime("%d %B %Y", then)
    why = " ".join(unseen.stop.text.split())
    details = f"{why}, at {when} on {day}; {unseen.outcome}\n{guardian_log}"
    if unseen.stop.did is Did.MOVES:
        told = f"At {when} on {day} a move began, and the program ended before the move did."
        event = f"last run: the program ended during a move begun at {when}"
        return f"NOTHING HERE STOPPED THE ROBOT. {told} {_LOOK}", event, details
    cause = _CAUSES.get(unseen.stop.reason, f"this happened: {why},")
    told = f"At {when} on {day} {cause} while the robot could move."
    if unseen.stood_after_s is None:
        event = f"last run: the robot was to be stopped at {when}, not confirmed"
        return f"IT IS NOT CONFIRMED THAT THE ROBOT STOPPED. {told} {_LOOK}", event, details
    stood = f"The robot was stopped and stood after {unseen.stood_after_s:.2f} s."
    return f"{told} {stood} {_LOOK}", f"last run: the robot was stopped at {when}", details


def _lines(guardian_log: Path) -> Iterator[str]:
    for path in (guardian_log.with_name(f"{guardian_log.name}.1"), guardian_log):
        with contextlib.suppress(OSError), path.open(encoding="utf-8", errors="replace") as file:
            yield from file


def _shown(file: Path) -> str:
    try:
        return file.read_text(encoding="utf-8", errors="replace").strip()
    except OSError:
        return ""
