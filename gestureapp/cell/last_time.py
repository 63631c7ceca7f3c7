"""What the guardian did when no application could show it: told once, at the next start."""

import contextlib
import logging
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from gestureapp.robot.acts import Unseen, find_unseen

log = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True)
class LastTime:
    """A stop of an earlier run that nobody has been shown yet.

    Attributes:
        text: One line for a person, with the path of the guardian's log.
        key: Of this stop, in the file of what was shown.
        shown_file: That file.
    """

    text: str
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
    return LastTime(_words(unseen, guardian_log), unseen.key, shown_file)


def _words(unseen: Unseen, guardian_log: Path) -> str:
    when = time.strftime("%H:%M:%S on %d %B %Y", time.localtime(unseen.stop.wall_s))
    why = " ".join(unseen.stop.text.split())
    told = f"Last time the guardian stopped the robot: {why}, at {when}; {unseen.outcome}"
    return f"{told} ({guardian_log})"


def _lines(guardian_log: Path) -> Iterator[str]:
    for path in (guardian_log.with_name(f"{guardian_log.name}.1"), guardian_log):
        with contextlib.suppress(OSError), path.open(encoding="utf-8", errors="replace") as file:
            yield from file


def _shown(file: Path) -> str:
    try:
        return file.read_text(encoding="utf-8", errors="replace").strip()
    except OSError:
        return ""
