"""The sounds of training: which one when, by a real player, and silence where there is none."""

import importlib.util
import os
import sys
import wave
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

from PySide6.QtWidgets import QWidget

from gestureapp.guided.values import GuidedSnapshot, Pace, Phase
from gestureapp.recording.take_values import Judgement, Take, Verdict
from ui.sounds import FOLDER, GIVE_UP_AFTER, Sound, SoundBox, Sounds, TrainingSounds, sound_between

RESTING = GuidedSnapshot(person="Ana", phase=Phase.WAITING, label="X+")


def take(number: int, verdict: Verdict = Verdict.GOOD) -> Take:
    judgement = Judgement(verdict, verdict.value)
    times_s, accel_g = np.zeros(1), np.zeros((1, 3))
    return Take(number, "X+", "2026-11-24", 0.0, judgement, False, False, times_s, accel_g)


def test_each_number_of_a_count_in_ticks_once():
    three, two = replace(RESTING, count_in=3), replace(RESTING, count_in=2)
    assert sound_between(RESTING, three) is Sound.BEAT
    assert sound_between(three, three) is None
    assert sound_between(three, two) is Sound.BEAT
    assert sound_between(replace(RESTING, count_in=1), RESTING) is None


@pytest.mark.parametrize(
    ("verdict", "sound"),
    [(Verdict.GOOD, Sound.TAKE_GOOD), (Verdict.TOO_LATE, Sound.TAKE_BAD)],
)
def test_a_take_sounds_as_it_was_judged(verdict, sound):
    before = replace(RESTING, batch=(take(1),))
    after = replace(RESTING, batch=(take(1), take(2, verdict)))
    assert sound_between(before, after) is sound
    assert sound_between(after, after) is None
    assert sound_between(after, before) is None


def test_an_activation_by_the_left_arm_ticks_and_a_beat_waits_for_its_own_time():
    taking = replace(RESTING, phase=Phase.TAKING, activation_s=5.0)
    assert sound_between(RESTING, taking) is Sound.BEAT
    rhythm = replace(RESTING, pace=Pace.RHYTHM)
    assert sound_between(rhythm, replace(taking, pace=Pace.RHYTHM)) is None


def test_opening_a_person_makes_no_sound():
    assert sound_between(GuidedSnapshot(), replace(RESTING, batch=(take(1),))) is None


def player(tmp_path: Path, text: str) -> tuple[str, ...]:
    script = tmp_path / "player.py"
    script.write_text(f"import sys, pathlib\n{text}\n", encoding="utf-8")
    return (sys.executable, str(script))


def noting(tmp_path: Path) -> tuple[tuple[str, ...], Path]:
    heard = tmp_path / "heard.txt"
    text = f"open({str(heard)!r}, 'a').write(pathlib.Path(sys.argv[1]).name + '\\n')"
    return player(tmp_path, text), heard


def test_the_first_player_that_is_there_plays_the_file(tmp_path, qtbot):
    command, heard = noting(tmp_path)
    sounds = Sounds([("no-such-player",), command])
    sounds.play(Sound.TAKE_BAD)
    qtbot.waitUntil(lambda: heard.exists() and heard.read_text() == "take-bad.wav\n", timeout=9000)
    sounds.close()


def test_a_beat_is_heard_at_its_time(tmp_path, qtbot):
    command, heard = noting(tmp_path)
    sounds = Sounds([command])
    training = TrainingSounds(sounds, clock=lambda: 100.0)
    training.show_snapshot(replace(RESTING, pace=Pace.RHYTHM, next_beat_s=100.05))
    qtbot.waitUntil(lambda: heard.exists() and heard.read_text() == "beat.wav\n", timeout=9000)
    sounds.close()


def test_a_beat_that_is_called_off_is_not_heard(tmp_path, qtbot):
    command, heard = noting(tmp_path)
    sounds = Sounds([command])
    training = TrainingSounds(sounds, clock=lambda: 100.0)
    training.show_snapshot(replace(RESTING, pace=Pace.RHYTHM, next_beat_s=100.2))
    training.show_snapshot(replace(RESTING, phase=Phase.PAUSED))
    qtbot.wait(300)
    assert not heard.exists()
    sounds.close()


def test_who_wants_silence_has_it(tmp_path):
    command, _ = noting(tmp_path)
    sounds = Sounds([command])
    sounds.is_on = False
    sounds.play(Sound.BEAT)
    assert sounds.n_playing == 0


def test_a_person_can_have_silence_by_a_box_that_is_there_when_there_is_a_player(tmp_path, qtbot):
    command, _ = noting(tmp_path)
    sounds = Sounds([command])
    host = QWidget()
    qtbot.addWidget(host)
    box, none = SoundBox(sounds, host), SoundBox(Sounds([("no-such-player",)]), host)
    host.show()
    assert box.isVisible()
    assert not none.isVisible()
    box.click()
    assert not sounds.is_on
    box.click()
    assert sounds.is_on


def test_there_is_silence_without_a_player():
    sounds = Sounds([("no-such-player",)])
    sounds.play(Sound.BEAT)
    assert sounds.n_playing == 0
    assert not sounds.can_play


def test_a_player_that_cannot_play_is_asked_no_more(tmp_path, qtbot):
    sounds = Sounds([player(tmp_path, "sys.exit(1)")])
    for _ in range(GIVE_UP_AFTER):
        sounds.play(Sound.BEAT)
    qtbot.waitUntil(lambda: not sounds.can_play, timeout=9000)
    sounds.close()


def test_closing_ends_a_player_that_hangs(tmp_path):
    sounds = Sounds([player(tmp_path, "import time; time.sleep(60)")])
    for _ in range(10):
        sounds.play(Sound.BEAT)
    assert sounds.n_playing == 3
    sounds.close()
    assert sounds.n_playing == 0


@pytest.fixture(scope="module")
def script():
    spec = importlib.util.spec_from_file_location("make_sounds", FOLDER / "make.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("sound", Sound)
def test_a_file_is_what_the_script_makes_now_short_and_not_clipped(script, sound):
    path = FOLDER / f"{sound.value}.wav"
    assert path.read_bytes() == script.wav_of(sound.value)
    with wave.open(str(path)) as file:
        assert file.getnframes() / file.getframerate() < 0.4
        samples = np.frombuffer(file.readframes(file.getnframes()), "<i2")
    assert 8_000 < np.abs(samples).max() < 32_000
    assert abs(int(samples[-1])) < 1_000
