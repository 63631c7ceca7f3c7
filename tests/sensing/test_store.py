"""The ring of newest samples, read from where somebody left off."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from gestureapp.sensing.store import SampleStore
from gestureapp.sensing.values import Sample


def append(store: SampleStore, number: int) -> None:
    store.append(Sample(number / 100.0, number, (float(number), 0.0, 1.0)))


@given(st.lists(st.integers(0, 9), max_size=20))
def test_who_reads_in_time_gets_every_sample_once(bursts):
    store, count, got = SampleStore(10), 0, []
    for burst in bursts:
        for _ in range(burst):
            append(store, store.count)
        rows, count = store.since(count)
        got += rows[:, 1].tolist()
    assert got == [float(number) for number in range(sum(bursts))]


def test_who_reads_too_late_gets_what_is_still_there():
    store = SampleStore(10)
    for number in range(25):
        append(store, number)
    rows, count = store.since(3)
    assert count == 25
    assert rows[-1, 1] == 24.0
    assert np.all(np.diff(rows[:, 1]) == 1.0)
    assert len(rows) >= 9


def test_nothing_new_is_no_rows():
    store = SampleStore(10)
    assert store.since(0)[0].shape == (0, 4)
    append(store, 0)
    assert store.since(1)[0].shape == (0, 4)
    assert store.tail(1.0).shape == (1, 4)
