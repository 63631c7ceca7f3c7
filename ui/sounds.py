"""The sounds of guided training: a tick on the beat, a tone for each take. Never in the way.

Qt's multimedia is not among what is installed, so the computer's own player plays the files. Where
there is none, or it cannot play, there is silence: whatever is heard is also seen.
"""

import logging
import shutil
import subprocess
import sys
from collections.abc import Sequence
from enum import Enum
from pathlib import Path

from PySide6.QtCore import QObject, Qt, QTimer
from PySide6.QtWidgets import QCheckBox, QWidget

from gestureapp.clock import Clock, monotonic
from gestureapp.guided.values import GuidedSnapshot, Pace, Phase

log = logging.getLogger(__name__)

FOLDER = Path(__file__).resolve().parent.parent / "resources" / "sounds"
PLAYERS: tuple[tuple[str, ...], ...] = (("pw-play",), ("paplay",), ("aplay", "-q"), ("afplay",))
"""Programs that play a file without a window, the best first: PipeWire, PulseAudio, ALSA, macOS."""
AT_ONCE_MAX = 3
"""More sounds at once are not started: the player hangs."""
GIVE_UP_AFTER = 3
"""A player that failed so often has no device to play on."""
AHEAD_S = 0.03
"""A player takes about so long to begin, so a beat's is started so much sooner."""


class Sound(Enum):
    """What can be heard; the value is the file's name."""

    BEAT = "beat"
    TAKE_GOOD = "take-good"
    TAKE_BAD = "take-bad"


class Sounds:
    """Plays sounds without waiting for them. GUI thread only.

    Args:
        players: Commands to choose the first from that is installed.

    Attributes:
        is_on: Whether anything is played.
    """

    def __init__(self, players: Sequence[tuple[str, ...]] = PLAYERS) -> None:
        self.is_on = True
        self._command = next((each for each in players if shutil.which(each[0])), None)
        self._playing: list[subprocess.Popen[bytes]] = []
        self._n_failed = 0

    def play(self, sound: Sound) -> None:
        """Begin a sound; nothing where it cannot be."""
        if not self.is_on:
            return
        path = str(FOLDER / f"{sound.value}.wav")
        if sys.platform == "win32":
            _play_on_windows(path)
            return
        self._reap()
        if self._command is None or len(self._playing) >= AT_ONCE_MAX:
            return
        try:
            self._playing.append(
                subprocess.Popen(
                    [*self._command, path],
                    stdin=subprocess.DEVNULL,
                    stdout=subprocess.DEVNULL,
                    stderr=subprocess.DEVNULL,
                )
            )
        except OSError as error:
            self._fall_silent(str(error))

    @property
    def n_playing(self) -> int:
        """Sounds under way."""
        self._reap()
        return len(self._playing)

    @property
    def can_play(self) -> bool:
        """There is a player, and it has not failed."""
        self._reap()
        return self._command is not None or sys.platform == "win32"

    def turn_on(self, is_on: bool) -> None:
        """Let sounds be heard, or not."""
        self.is_on = is_on

    def close(self) -> None:
        """End what is being played. Idempotent."""
        for child in self._playing:
            child.kill()
            child.wait()
        self._playing.clear()

    def _reap(self) -> None:
        for child in [each for each in self._playing if each.poll() is not None]:
            self._playing.remove(child)
            self._n_failed = self._n_failed + 1 if child.returncode else 0
            if self._n_failed >= GIVE_UP_AFTER:
                self._fall_silent(f"it ended with {child.returncode}")

    def _fall_silent(self, reason: str) -> None:
        if self._command is not None:
            log.info("no sounds: %s cannot play: %s", self._command[0], reason)
        self._command = None


class TrainingSounds(QObject):
    """Listens to what training shows and lets it be heard. GUI thread only.

    Args:
        sounds: Play.
        clock: Monotonic seconds, that of the snapshots.
        parent: Qt's.
    """

    def __init__(
        self, sounds: Sounds, clock: Clock = monotonic, parent: QObject | None = None
    ) -> None:
        super().__init__(parent)
        self._sounds = sounds
        self._clock = clock
        self._before = GuidedSnapshot()
        self._beat_s = float("inf")
        self._timer = QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.setTimerType(Qt.TimerType.PreciseTimer)
        self._timer.timeout.connect(lambda: sounds.play(Sound.BEAT))
        self.destroyed.connect(sounds.close)

    def show_snapshot(self, snapshot: GuidedSnapshot) -> None:
        """Another moment; called at the display rate while the recording is in sight."""
        before, self._before = self._before, snapshot
        self._wait_for_beat(snapshot)
        sound = sound_between(before, snapshot)
        if sound is not None:
            self._sounds.play(sound)

    def _wait_for_beat(self, snapshot: GuidedSnapshot) -> None:
        """The beat is known before it comes, so it need not wait for the next frame."""
        beat_s = snapshot.next_beat_s
        if beat_s == self._beat_s:
            return
        self._beat_s = beat_s
        self._timer.stop()
        wait_s = beat_s - AHEAD_S - self._clock()
        if 0.0 <= wait_s < 60.0:
            self._timer.start(round(wait_s * 1000.0))


class SoundBox(QCheckBox):
    """Lets a person have silence; not there where nothing could be heard anyway."""

    def __init__(self, sounds: Sounds, parent: QWidget | None = None) -> None:
        super().__init__("Sounds", parent)
        self.setObjectName("soundsOn")
        self.setAccessibleName("Beats and takes can be heard")
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setChecked(sounds.is_on)
        if not sounds.can_play:
            self.hide()
        self.toggled.connect(sounds.turn_on)


def sound_between(before: GuidedSnapshot, after: GuidedSnapshot) -> Sound | None:
    """What is to be heard when one moment follows another; the beats of a rhythm come by the clock.

    A tick with each number of a count-in, and with hands-free's activations; a tone for a take.
    """
    if after.person != before.person:
        return None
    known = {take.id for take in before.batch}
    new = [take for take in after.batch if take.id not in known]
    if new:
        return Sound.TAKE_GOOD if new[-1].judgement.is_good else Sound.TAKE_BAD
    if after.count_in and after.count_in != before.count_in:
        return Sound.BEAT
    is_begun = after.phase is Phase.TAKING and after.activation_s != before.activation_s
    return Sound.BEAT if is_begun and after.pace is Pace.HANDS_FREE else None


def _play_on_windows(path: str) -> None:
    if sys.platform == "win32":
        import winsound

        flags = winsound.SND_FILENAME | winsound.SND_ASYNC | winsound.SND_NODEFAULT
        try:
            winsound.PlaySound(path, flags)
        except RuntimeError as error:
            log.info("no sound: %s", error)
