"""The shared base model: trained from simulated people and non-gestures, shipped as a resource.

It stands above simulation and training, which do not know each other. ``gestureapp train-base``
writes the files of ``resources/models``; nobody needs to but who changes the features or the
simulated people.
"""

from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from gestureapp import __version__
from gestureapp.clock import monotonic
from gestureapp.gestures import GESTURES, LABELS
from gestureapp.recognition.base import BASE, NEGATIVES
from gestureapp.recognition.base import GESTURES as GESTURES_FILE
from gestureapp.recognition.decision import EARLY_OF_OTHERS, Decision
from gestureapp.recognition.ensemble import Ensemble
from gestureapp.recognition.members import Progress, Steps, learn, new_layers, no_progress
from gestureapp.recognition.model_file import Model, TrainingRecord, save_model
from gestureapp.recognition.model_weights import KIND_ONSET
from gestureapp.recognition.movement import ONSET_G
from gestureapp.recognition.onset_views import (
    Variation,
    Views,
    gesture_views,
    joined,
    mirrored,
    negative_views,
    picked,
    streams_of,
)
from gestureapp.recognition.takes import TakeSet, save_takes
from gestureapp.recognition.window import INPUT_ONSET, N_INPUTS, inputs_of
from gestureapp.simulation.base_people import CROWDS, base_negatives, crowd_takes
from gestureapp.simulation.base_people import NEGATIVES as NEGATIVES_SEEN
from gestureapp.simulation.negatives import make_negatives

F32 = NDArray[np.float32]
F64 = NDArray[np.float64]
I64 = NDArray[np.int64]

SEED = 9100
PER_COPY, PER_NEGATIVE = 4, 6
AT_ONCE = 2000
"""Takes followed at once: memory."""
HIDDEN = (64, 32)
STEPS = Steps(count=3500, rate=4e-3, batch=1024, decay=1e-4)
VARIATION = Variation(tilt_deg=3.0, gain=0.03, offset_g=0.01, vigour=0.05)
NEGATIVES_SHIPPED = 480
"""Takes of non-gestures that every person's training is shown."""
GESTURES_SHIPPED = (40, 2)
"""People, and takes of each gesture by each: shown as "none" where a gesture was not taught."""
NEGATIVES_COUNT = 3
"""Views of non-gestures are shown so many times as often as they are many."""
OTHER_HAND = tuple(
    g.label if (g.axis == 1) == (g.label[0] == "R") else g.label[:-1] + "+-"[g.sign > 0]
    for g in GESTURES
)
"""What a gesture becomes in a mirror: left and right change places, and what turns with them."""
OTHER_OUTPUT = np.array([*(LABELS.index(label) for label in OTHER_HAND), len(LABELS)])
SMALLEST_SCALE = 0.05
"""Added to the spread of each input: one that hardly varies is not blown up."""
LOOKED_AT = 20_000
"""Views from which the inputs' mean and spread are taken."""


def train_base(seed: int = SEED, progress: Progress = no_progress) -> Ensemble:
    """Train it; minutes.

    Args:
        seed: Of the people and of all chance.
        progress: Called fifty times.
    """
    rng = np.random.default_rng([seed, 0])
    views, outputs = _gestures(seed, rng)
    none = joined([_views_of(takes, None, rng) for takes in base_negatives(seed)])
    moment = joined([views, none]).moment
    outputs = np.concatenate([outputs, np.full(len(none), len(LABELS))])
    shown = np.flatnonzero(outputs == len(LABELS))
    shown = np.concatenate([np.arange(len(outputs)), *[shown] * (NEGATIVES_COUNT - 1)])
    looked = inputs_of(picked(moment, rng.choice(shown, LOOKED_AT)))
    mean, scale = looked.mean(axis=0), looked.std(axis=0) + SMALLEST_SCALE

    def draw() -> tuple[F32, I64]:
        rows = rng.choice(shown, STEPS.batch)
        half = STEPS.batch // 2
        moments = [picked(moment, rows[:half]), mirrored(picked(moment, rows[half:]))]
        inputs = [inputs_of(VARIATION.vary(each, rng)) for each in moments]
        wanted = np.concatenate([outputs[rows[:half]], OTHER_OUTPUT[outputs[rows[half:]]]])
        scaled = (np.concatenate(inputs) - mean) / scale
        return scaled.astype(np.float32)[None], wanted[None]

    first = new_layers((N_INPUTS, *HIDDEN, len(LABELS) + 1), 1, rng)
    learned = learn(first, draw, STEPS, progress)
    return learned.as_ensemble(mean, scale)


def make_base(folder: Path, seed: int = SEED, progress: Progress = no_progress) -> Model:
    """Train the base and write the files of ``resources/models``.

    Raises:
        DiskFull: no room is left there.
        RecordingError: they cannot be written there.
    """
    begun_s = monotonic()
    takes = make_negatives(NEGATIVES_SHIPPED, seed)
    save_takes(folder / NEGATIVES.name, takes)
    save_takes(folder / GESTURES_FILE.name, shipped_gestures(seed))
    losses: list[float] = []

    def told(done: int, total: int, loss: float) -> None:
        losses.append(loss)
        progress(done, total, loss)

    ensemble = train_base(seed, told)
    n_people = sum(crowd.people for crowd in CROWDS)
    n_takes = sum(crowd.people * crowd.takes * len(LABELS) for crowd in CROWDS)
    record = TrainingRecord(
        preset="base",
        rule=f"cross-entropy in one cycle of Adam's steps, batches of {STEPS.batch}, mirrored",
        cycles=STEPS.count,
        learning_rate=STEPS.rate,
        seed=seed,
        n_takes=n_takes + sum(count for count, _ in NEGATIVES_SEEN),
        loss=losses[-1],
        duration_s=round(monotonic() - begun_s, 3),
        takes_from=f"{n_people} simulated people at 50, 100 and 200 Hz, and non-gestures",
    )
    model = Model(
        kind=KIND_ONSET,
        labels=LABELS,
        network=ensemble,
        person="",
        training=record,
        takes_fingerprint=takes.fingerprint(),
        app_version=__version__,
        created=datetime.now(UTC).isoformat(timespec="seconds"),
        input_words=INPUT_ONSET,
        decision=Decision(early=EARLY_OF_OTHERS),
    )
    save_model(folder / BASE.name, model)
    return model


def shipped_gestures(seed: int) -> TakeSet:
    """Takes of every gesture by the first of the base's ordinary people, nobody's name on them."""
    people, count = GESTURES_SHIPPED
    takes = crowd_takes(seed, 0)
    each = CROWDS[0].takes
    rows = [row for row in range(people * len(LABELS) * each) if row % each < count]
    return replace(takes.select(rows), user=())


def _gestures(seed: int, rng: np.random.Generator) -> tuple[Views, I64]:
    """Views of all crowds, and the output that each asks for."""
    found, outputs = [], []
    for number in range(len(CROWDS)):
        takes = crowd_takes(seed, number)
        views = _views_of(takes, PER_COPY, rng)
        column = np.array([LABELS.index(label) for label in takes.labels])
        found.append(views)
        outputs.append(column[views.take])
    return joined(found), np.concatenate(outputs)


def _views_of(takes: TakeSet, per_copy: int | None, rng: np.random.Generator) -> Views:
    """Of gestures ``per_copy`` views a copy; of non-gestures without."""
    found = []
    for begin in range(0, len(takes), AT_ONCE):
        rows = range(begin, min(begin + AT_ONCE, len(takes)))
        streams = streams_of(takes, rows)
        if per_copy is None:
            views = negative_views(streams, ONSET_G, PER_NEGATIVE, rng)
        else:
            views = gesture_views(streams, ONSET_G, per_copy, rng)
        found.append(Views(views.moment, views.take + begin))
    return joined(found)
