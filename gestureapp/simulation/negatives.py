"""Things an arm does that are no gesture: what a recogniser must not take for one. Pure.

They are courses of the specific force, not of an arm's joints. Sizes and durations are assumptions,
wide on purpose, unless a source stands with them.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gestureapp.recognition.takes import TakeSet
from gestureapp.recording.take_values import AFTER_S, BEFORE_S
from gestureapp.simulation.accelerometer import quantised
from gestureapp.simulation.worn import STANDARD_GRAVITY, TREMOR_HZ

F64 = NDArray[np.float64]

SATURATION_G = 3.6
"""Where an ADXL330 ends: its datasheet promises 3 g and gives 3.6 g as typical."""
OBLIQUE = float(np.cos(np.radians(40.0)))
"""A direction that is further than this from every axis is nobody's gesture."""
_LEVEL_RAD = float(np.radians(4.0))
_BEGIN_S, _BEGIN_SPREAD_S = -0.010, 0.060
_NOISE_G = 0.003
_TREMOR_PARTS = 4


@dataclass(frozen=True, slots=True)
class _Scene:
    """One take in the making: times around the activation, gravity, begin, a direction, chance."""

    t: F64
    gravity: F64
    begin_s: float
    direction: F64
    rng: np.random.Generator

    def phase(self) -> float:
        return float(self.rng.uniform(0.0, 2.0 * np.pi))


def make_negatives(count: int, seed: int, rate_hz: float = 100.0) -> TakeSet:
    """Takes of what is no gesture, each kind in turn; the labels are the kinds.

    Args:
        count: How many in all.
        seed: Of all chance.
        rate_hz: Sample rate.
    """
    n_before, n_after = round(BEFORE_S * rate_hz), round(AFTER_S * rate_hz)
    t = np.arange(-n_before, n_after, dtype=np.float64) / rate_hz
    rng = np.random.default_rng([seed, round(rate_hz)])
    labels = [KINDS[number % len(KINDS)] for number in range(count)]
    samples = [_make(label, t, rng) for label in labels]
    return TakeSet(
        samples=np.concatenate(samples) if samples else np.zeros((0, 3)),
        offsets=np.arange(count + 1) * len(t),
        labels=tuple(labels),
        activation=np.full(count, n_before),
        rate_hz=rate_hz,
    )


def _make(kind: str, t: F64, rng: np.random.Generator) -> F64:
    roll, pitch = rng.normal(0.0, _LEVEL_RAD, 2)
    level = np.array([-np.sin(pitch), np.sin(roll), np.cos(pitch) * np.cos(roll)])
    scene = _Scene(
        t=t,
        gravity=np.tile(level, (len(t), 1)),
        begin_s=float(rng.normal(_BEGIN_S, _BEGIN_SPREAD_S)),
        direction=_direction(rng),
        rng=rng,
    )
    reading = _SHAPES[kind](scene) + _tremor(scene) + rng.normal(0.0, _NOISE_G, (len(t), 3))
    return quantised(np.clip(reading, -SATURATION_G, SATURATION_G))


def _bump(scene: _Scene) -> F64:
    """An elbow or a hand knocked against something: a blow and its ringing."""
    uniform = scene.rng.uniform
    blow_s, size_g = uniform(0.01, 0.05), uniform(0.4, 3.0)
    ringing_hz, fading_s = uniform(10.0, 25.0), uniform(0.02, 0.08)
    since = scene.t - scene.begin_s
    after = np.maximum(since - blow_s, 0.0)
    blow = np.where((since > 0.0) & (since < blow_s), np.sin(np.pi * since / blow_s), 0.0)
    ringing = 0.6 * np.sin(2.0 * np.pi * ringing_hz * after) * np.exp(-after / fading_s)
    return scene.gravity + size_g * (blow - ringing)[:, None] * scene.direction


def _fall(scene: _Scene) -> F64:
    """The arm drops: weightless for 0.2 to 0.5 s, then it lands."""
    uniform, t = scene.rng.uniform, scene.t
    end_s = scene.begin_s + uniform(0.2, 0.5)
    weightless = np.clip((t - scene.begin_s) / uniform(0.02, 0.06), 0.0, 1.0) * (t < end_s)
    landing = np.where((t > end_s) & (t < end_s + 0.04), uniform(1.5, 3.5), 0.0)
    drag = weightless[:, None] * scene.rng.normal(0.0, 0.08, 3)
    return scene.gravity * (1.0 - weightless[:, None]) + landing[:, None] * scene.direction + drag


def _scratch(scene: _Scene) -> F64:
    """The hand goes to the head in 0.4 to 0.8 s and scratches there at 3 to 6 Hz."""
    uniform, t = scene.rng.uniform, scene.t
    duration_s, end_rad = uniform(0.4, 0.8), np.radians(uniform(60.0, 130.0))
    start_s = scene.begin_s - uniform(0.0, 0.7)
    turned = end_rad * _smooth_step((t - start_s) / duration_s)
    heading, side = uniform(-0.6, 0.6), scene.rng.choice([1.0, 1.0, -1.0])
    gravity = np.stack(
        [side * np.sin(turned) * np.cos(heading), np.sin(turned) * np.sin(heading), np.cos(turned)],
        axis=1,
    )
    lift = _reach(t, start_s, duration_s, uniform(0.2, 0.5))
    there = t > start_s + 0.9 * duration_s
    course = np.sin(2.0 * np.pi * uniform(3.0, 6.0) * (t - start_s - duration_s))
    scratching = course * there * uniform(0.25, 0.8)
    return gravity * (1.0 + lift[:, None]) + scratching[:, None] * scene.direction


def _walk(scene: _Scene) -> F64:
    """The person walks: 1.5 to 2.3 steps a second with two harmonics, sideways half as often.

    Source of the cadence: Winter, Biomechanics and Motor Control of Human Movement.
    """
    uniform = scene.rng.uniform
    turns, first = 2.0 * np.pi * uniform(1.5, 2.3) * scene.t, scene.phase()
    up = np.sin(turns + first) + 0.5 * np.sin(2.0 * turns + scene.phase())
    up += 0.3 * np.sin(3.0 * turns + scene.phase())
    aside = uniform(0.2, 0.7) * np.sin(0.5 * turns + first)
    forward = uniform(0.2, 0.8) * np.sin(turns + scene.phase())
    return scene.gravity + uniform(0.12, 0.4) * np.stack([forward, aside, up], axis=1)


def _oblique(scene: _Scene) -> F64:
    """A reach as quick as a gesture, in a direction that is none."""
    direction = scene.direction
    while np.abs(direction).max() >= OBLIQUE:
        direction = _direction(scene.rng)
    uniform = scene.rng.uniform
    push = _reach(scene.t, scene.begin_s, uniform(0.34, 0.58), uniform(0.16, 0.35))
    return scene.gravity + push[:, None] * direction


def _shake(scene: _Scene) -> F64:
    """The hand is shaken at 3 to 7 Hz."""
    uniform = scene.rng.uniform
    since = scene.t - (scene.begin_s - uniform(0.0, 0.4))
    course = np.sin(2.0 * np.pi * uniform(3.0, 7.0) * since + scene.phase())
    size_g = uniform(0.3, 1.5) * np.clip(since / 0.05, 0.0, 1.0)
    return scene.gravity + (size_g * course)[:, None] * scene.direction


def _settle(scene: _Scene) -> F64:
    """The record begins with a tilted hand, or while the reading still settles."""
    uniform, t = scene.rng.uniform, scene.t - scene.t[0]
    away = scene.direction * uniform(0.1, 0.45)
    share = np.ones_like(t) if uniform() < 0.3 else np.exp(-t / uniform(0.02, 0.3))
    noise = scene.rng.normal(0.0, uniform(0.005, 0.05), (len(t), 3)) * (t < 0.2)[:, None]
    reading: F64 = scene.gravity + share[:, None] * away + noise
    return reading


def _drift(scene: _Scene) -> F64:
    """The hand is moved somewhere else at leisure: twice as slowly as a gesture or more."""
    uniform = scene.rng.uniform
    begin_s = scene.begin_s - uniform(0.0, 0.5)
    push = _reach(scene.t, begin_s, uniform(0.7, 1.4), uniform(0.1, 0.4))
    return scene.gravity + push[:, None] * scene.direction


_SHAPES: dict[str, Callable[[_Scene], F64]] = {
    "bump": _bump,
    "fall": _fall,
    "scratch": _scratch,
    "walk": _walk,
    "oblique": _oblique,
    "shake": _shake,
    "settle": _settle,
    "drift": _drift,
}
KINDS: Sequence[str] = tuple(_SHAPES)
"""Labels of what is no gesture."""


def _direction(rng: np.random.Generator) -> F64:
    drawn = rng.normal(size=3)
    unit: F64 = drawn / np.linalg.norm(drawn)
    return unit


def _smooth_step(share: F64) -> F64:
    """Way of the smoothest reach, 0 to 1. Source: Flash and Hogan, J. Neurosci. 5 (1985) 1688."""
    u = np.clip(share, 0.0, 1.0)
    way: F64 = u**3 * (10.0 - 15.0 * u + 6.0 * u**2)
    return way


def _reach(t: F64, begin_s: float, duration_s: float, reach_m: float) -> F64:
    """Acceleration of the same reach in g."""
    u = np.clip((t - begin_s) / duration_s, 0.0, 1.0)
    push: F64 = 60.0 * u * (1.0 - u) * (1.0 - 2.0 * u) * reach_m / duration_s**2 / STANDARD_GRAVITY
    return push


def _tremor(scene: _Scene) -> F64:
    rate_hz = scene.rng.uniform(*TREMOR_HZ, (3, _TREMOR_PARTS))
    phase = scene.rng.uniform(0.0, 2.0 * np.pi, (3, _TREMOR_PARTS))
    size_g = scene.rng.uniform(0.004, 0.015) / np.sqrt(2.0)
    waves = np.sin(2.0 * np.pi * rate_hz * scene.t[:, None, None] + phase)
    tremor: F64 = size_g * waves.sum(axis=2)
    return tremor
