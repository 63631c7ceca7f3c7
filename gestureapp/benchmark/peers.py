"""Recognisers of public libraries beside ours: a support vector machine, and nearest neighbours.

They see what is best for them: the first 160 ms from the onset of the right arm's movement, and
answer when these are over, always with a gesture. Both libraries are the optional extra ``peers``.
"""

from collections.abc import Callable, Sequence
from importlib.util import find_spec

import numpy as np
from numpy.typing import NDArray

from gestureapp.recognition.movement import Follower
from gestureapp.recognition.onset_views import personal_onsets_g, streams_of
from gestureapp.recognition.takes import RATE_UNKNOWN_HZ, TakeSet

F64 = NDArray[np.float64]
Predict = Callable[[F64], Sequence[str]]
"""Windows, shape (n, STEPS, 3), to one gesture each."""

WINDOW_S = 0.160
"""The paper's response time."""
STEPS = 8
"""Readings in the window, one every 20 ms: the slowest sensor's rate."""
SVM_PENALTY = 10.0
DTW_BAND = 3
"""Readings that the two courses may be apart in time: 60 ms."""
NOT_INSTALLED = (
    "SVM and 1-NN DTW are left out: {} not installed here: pip install 'gestureapp[peers]'"
)
_LIBRARIES = {"sklearn": "scikit-learn", "dtaidistance": "dtaidistance"}


def missing_words() -> str:
    """Which library is not here and how to get it; empty when both are."""
    missing = [words for name, words in _LIBRARIES.items() if find_spec(name) is None]
    if not missing:
        return ""
    return NOT_INSTALLED.format(f"{' and '.join(missing)} {'is' if len(missing) == 1 else 'are'}")


def onset_level_g(seen: TakeSet) -> float:
    """How far from rest a movement has begun, learned from takes as our recogniser learns it."""
    return personal_onsets_g(streams_of(seen), [np.ones(len(seen), dtype=np.bool_)])[0]


def onsets_s(takes: TakeSet, level_g: float) -> F64:
    """When the right arm begins to move, from each take's begin; shape (takes,).

    The movement under way at the activation, or the first after it; a posture that is held then, or
    a take without movement, counts from the activation.

    Args:
        takes: Any.
        level_g: ``onset_level_g`` of the takes that were learned from.
    """
    return np.array([_onset_s(takes, i, level_g) for i in range(len(takes))])


def windows(takes: TakeSet, begin_s: F64) -> F64:
    """The readings of ``WINDOW_S`` from these times on, shape (takes, STEPS, 3), in g."""
    rate_hz = takes.rate_hz or RATE_UNKNOWN_HZ
    wanted_s = np.arange(STEPS) * WINDOW_S / STEPS
    found = np.zeros((len(takes), STEPS, 3))
    for i, begin in enumerate(begin_s.tolist()):
        accel = takes.accel_g(i)
        times_s = np.arange(len(accel)) / rate_hz
        for axis in range(3):
            found[i, :, axis] = np.interp(begin + wanted_s, times_s, accel[:, axis])
    return found


def learn_svm(seen: F64, labels: Sequence[str]) -> Predict:
    """A support vector machine with radial kernel on standardised readings (scikit-learn)."""
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import StandardScaler
    from sklearn.svm import SVC

    machine = make_pipeline(StandardScaler(), SVC(C=SVM_PENALTY, gamma="scale"))
    machine.fit(seen.reshape(len(seen), -1), list(labels))

    def predict(asked: F64) -> Sequence[str]:
        found: Sequence[str] = machine.predict(asked.reshape(len(asked), -1)).tolist()
        return found

    return predict


def learn_nearest(seen: F64, labels: Sequence[str]) -> Predict:
    """The nearest take by dynamic time warping within ``DTW_BAND`` (dtaidistance)."""
    from dtaidistance import dtw_ndim

    known = [np.ascontiguousarray(course) for course in seen]

    def nearest(course: F64) -> str:
        asked, least, found = np.ascontiguousarray(course), np.inf, 0
        for k, other in enumerate(known):
            away = dtw_ndim.distance(asked, other, window=DTW_BAND, max_dist=least, use_c=True)
            if away < least:
                least, found = away, k
        return labels[found]

    return lambda asked: [nearest(course) for course in asked]


def _onset_s(takes: TakeSet, index: int, level_g: float) -> float:
    rate_hz = takes.rate_hz or RATE_UNKNOWN_HZ
    activation = int(takes.activation[index])
    follower = Follower(level_g)
    for k, (x, y, z) in enumerate(takes.accel_g(index).tolist()):
        follower.feed(k / rate_hz, (x, y, z))
        if k < activation:
            continue
        if follower.is_moving:
            return follower.onset_s
        if follower.is_posture:
            break
    return activation / rate_hz
