"""Writes the sounds of guided training as WAV files beside this one: ``python make.py``.

Short tones with soft ends, 16 bit, one channel: a tick for the beat, a rising pair for a take that
counts, a falling pair for one that does not.
"""

import io
import struct
import wave
from math import exp, pi, sin
from pathlib import Path

HERE = Path(__file__).resolve().parent
RATE_HZ = 22_050
_LOUDNESS = 0.5
_RISE_S = 0.003

TONES: dict[str, tuple[tuple[float, float], ...]] = {
    "beat": ((1320.0, 0.05),),
    "take-good": ((880.0, 0.07), (1320.0, 0.11)),
    "take-bad": ((330.0, 0.12), (247.0, 0.18)),
}
"""Of each file: pitch in Hz and length in s, one after the other."""


def wav_of(name: str) -> bytes:
    """The sound of this name as the bytes of a WAV file.

    Raises:
        KeyError: there is no such sound.
    """
    samples = [value for pitch_hz, length_s in TONES[name] for value in _tone(pitch_hz, length_s)]
    out = io.BytesIO()
    with wave.open(out, "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(RATE_HZ)
        file.writeframes(struct.pack(f"<{len(samples)}h", *samples))
    return out.getvalue()


def _tone(pitch_hz: float, length_s: float) -> list[int]:
    """One tone that begins and ends softly, with an octave for brightness."""
    values = []
    for i in range(round(length_s * RATE_HZ)):
        t_s = i / RATE_HZ
        ends = min(1.0, t_s / _RISE_S, (length_s - t_s) / _RISE_S) * exp(-3.0 * t_s / length_s)
        wave_ = sin(2 * pi * pitch_hz * t_s) + 0.25 * sin(4 * pi * pitch_hz * t_s)
        values.append(round(32767 * _LOUDNESS * ends * wave_ / 1.25))
    return values


def main() -> None:
    """Write them all."""
    for name in TONES:
        (HERE / f"{name}.wav").write_bytes(wav_of(name))


if __name__ == "__main__":
    main()
