"""A person's database with a few takes of each gesture."""

from pathlib import Path

import numpy as np

from gestureapp.recording.take_store import NewTake, TakeStore
from gestureapp.recording.take_values import Judgement, Verdict
from gestureapp.simulation.takes import make_takes

PERSON = "Ana"
N_TAKES = 6
LATE_SAMPLES = 40


def fill(data: Path) -> None:
    """Six takes of each gesture; the fourth of X+ is 0.4 s late, the fifth has a gap."""
    made = make_takes(1, N_TAKES, 3, practised=True)
    store = TakeStore(data, PERSON)
    for i, label in enumerate(made.labels):
        accel_g = np.array(made.accel_g(i))
        number = i % N_TAKES + 1
        verdict = Verdict.GAP if label == "X+" and number == 5 else Verdict.GOOD
        if label == "X+" and number == 4:
            accel_g = np.roll(accel_g, LATE_SAMPLES, axis=0)
        times_s = (np.arange(len(accel_g)) - int(made.activation[i]) + 0.3) / 100.0
        words = "gap of 43 ms" if verdict is Verdict.GAP else "good"
        judgement = Judgement(verdict, words)
        store.add(NewTake(label, "2026-11-23 10:00", 1.8e9 + i, judgement, times_s, accel_g))
    store.close()
