"""How alike takes are: to their own gesture's others, and to other gestures. Pure.

A take is compared as a curve of its three readings over 0.6 s, placed at the onset of its movement
(at its activation where gravity shows the gesture), so that being early or late, which has verdicts
of its own, makes no difference here. The centre of a gesture is the median of its good takes.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final

import numpy as np

from gestureapp.gestures import LABELS, is_held
from gestureapp.guided.motion import curve_of, distance_g, onset_s
from gestureapp.guided.values import Quality
from gestureapp.recording.take_values import F64, Take

ENOUGH: Final = 5
"""Good takes of a gesture that say what it is like."""
NEARER: Final = 1.5
"""Another gesture has to be nearer by this factor. Of the honest takes of twenty ordinary simulated
people it takes 1.1 % for unlike the others (at 1.3 and 1.15: 1.5 and 2.0 %), most of them from few
people whose turns about Z look like movements to the side. To refuse many of those would hide from
the training what it has to tell apart. Of takes that show another gesture 99.1 % are caught, by
this verdict or those before it (99.4 and 99.7 %)."""
CLOSE: Final = 0.8
"""As long as a gesture has too few takes, one that lies so close to another's centre, in its usual
distances, shows that one: so a batch of the wrong gesture is noticed within its first takes. With a
larger number honest takes are refused first, and a gesture's centre comes to lie askew."""
FAR: Final = 4.0
"""So many times the usual distance from its own centre is unlike the others; 0.4 % of the honest
takes of ordinary simulated people are (2.5 times: 4 %)."""
LEAST_G: Final = 0.08
"""The usual distance counts as no less: who repeats a gesture like a machine may vary it a bit."""
GOOD_SHARE: Final = 0.2
FAIR_SHARE: Final = 0.4
"""Takes are alike, or differ, when their usual distance is below this share of the gesture's size.
Movements of practised simulated people have 10 to 19 %, of ordinary ones 18 to 60 % (median 34 %);
postures have 1 to 13 %."""
_LEVEL: Final = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, slots=True)
class Centre:
    """What a gesture's good takes are like.

    Attributes:
        curve: Their median, shape (n, 3), in g.
        usual_g: The median distance of a take from it.
        size_g: How far the median is from a level hand at rest.
    """

    curve: F64
    usual_g: float
    size_g: float


class Likeness:
    """Compares takes; remembers their curves, as samples never change. Owned by one thread."""

    def __init__(self) -> None:
        self._curves: dict[int, F64] = {}
        self._centres: dict[str, tuple[tuple[int, ...], Centre]] = {}

    def oddness(self, label: str, times_s: F64, accel_g: F64, takes: Iterable[Take]) -> str:
        """What is odd about a take of this gesture, in words; empty when nothing is.

        Args:
            label: What was asked for.
            times_s: From the activation.
            accel_g: The readings then.
            takes: The person's takes so far; those that count are compared with.
        """
        centres = self.centres(takes)
        own = centres.pop(label, None)
        if not centres or (own is None and len(centres) < 2):
            return ""
        curve = _placed(label, times_s, accel_g)
        away_g = {name: distance_g(curve, centre.curve) for name, centre in centres.items()}
        nearest = min(away_g, key=lambda name: away_g[name])
        if own is None:
            is_other = away_g[nearest] < CLOSE * max(centres[nearest].usual_g, LEAST_G)
            return f"looks like {nearest}" if is_other else ""
        own_g = distance_g(curve, own.curve)
        if own_g > NEARER * away_g[nearest]:
            return f"looks like {nearest}"
        return "unlike the others" if own_g > FAR * max(own.usual_g, LEAST_G) else ""

    def qualities(self, takes: Iterable[Take]) -> dict[str, Quality]:
        """The quality mark of every gesture."""
        takes = tuple(takes)
        marks = dict.fromkeys(LABELS, Quality.NONE)
        marks |= {take.label: Quality.FEW for take in takes if take.counts}
        return marks | {name: _mark(centre) for name, centre in self.centres(takes).items()}

    def centres(self, takes: Iterable[Take]) -> dict[str, Centre]:
        """The centre of every gesture of which there are enough good takes."""
        good: dict[str, list[Take]] = {}
        for take in takes:
            if take.counts:
                good.setdefault(take.label, []).append(take)
        return {
            name: self._centre(name, those) for name, those in good.items() if len(those) >= ENOUGH
        }

    def _centre(self, label: str, takes: list[Take]) -> Centre:
        ids = tuple(take.id for take in takes)
        known = self._centres.get(label)
        if known is None or known[0] != ids:
            curves = np.stack([self._curve(take) for take in takes])
            median = np.median(curves, axis=0)
            usual_g = float(np.median([distance_g(curve, median) for curve in curves]))
            size_g = distance_g(median, np.broadcast_to(_LEVEL, median.shape))
            known = self._centres[label] = ids, Centre(median, usual_g, size_g)
        return known[1]

    def _curve(self, take: Take) -> F64:
        curve = self._curves.get(take.id)
        if curve is None:
            curve = self._curves[take.id] = _placed(take.label, take.times_s, take.accel_g)
        return curve


def _placed(label: str, times_s: F64, accel_g: F64) -> F64:
    start_s = 0.0 if is_held(label) else onset_s(times_s, accel_g)
    return curve_of(times_s, accel_g, 0.0 if np.isnan(start_s) else start_s)


def _mark(centre: Centre) -> Quality:
    share = centre.usual_g / max(centre.size_g, LEAST_G)
    if share < GOOD_SHARE:
        return Quality.GOOD
    return Quality.FAIR if share < FAIR_SHARE else Quality.POOR
