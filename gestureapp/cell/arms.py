"""What the two arms' sensors say: the health of both streams, and the left arm's posture. Pure."""

from collections.abc import Iterable, Iterator

from gestureapp.cell import events as e
from gestureapp.cell.fitness import Judgement
from gestureapp.cell.inputs import SensorTold
from gestureapp.config import SiteSettings
from gestureapp.sensing.posture import BUILT_IN, LeftPostures, PostureDetector
from gestureapp.sensing.stream import StreamTracker
from gestureapp.sensing.values import ArmPosture, Sample, Side, StreamHealth

OTHER = Judgement("another sensor answers", "wait a moment; else Setup, step Sensors")
POSTURE_FORGOTTEN_S = 0.5
"""A left arm not heard for this long is in no posture; the watchdog has acted long before."""


class Arms:
    """Both streams and the posture. Owned by the control thread."""

    def __init__(self, site: SiteSettings) -> None:
        self._trackers = {side: _tracker(side, site) for side in Side}
        self._detector = _detector(site, BUILT_IN)
        self._judged = dict.fromkeys(Side, "")
        """Who answered when setting up judged the sensor; empty for one that does not say."""

    def use(self, site: SiteSettings, postures: LeftPostures, renewed: Iterable[Side]) -> None:
        """Judge by these from now on, and these sensors anew. Only while nothing may move.

        The left arm is in no posture until it shows one.
        """
        for tracker in self._trackers.values():
            tracker.set_limits(site.trip_level_s, site.rate_min_hz, site.rate_max_hz)
        for side in renewed:
            self._trackers[side] = _tracker(side, site)
        self._detector = _detector(site, postures)

    @property
    def posture(self) -> ArmPosture:
        """What the left arm says."""
        return self._detector.posture

    def left(self, sample: Sample) -> e.LeftPosture | None:
        """Take a sample of the left arm; the new posture if it has changed."""
        self._trackers[Side.LEFT].sample(sample)
        before = self._detector.posture
        posture = self._detector.feed(sample.accel_g)
        return e.LeftPosture(sample.t_s, posture) if posture is not before else None

    def right(self, sample: Sample) -> None:
        """Take a sample of the right arm."""
        self._trackers[Side.RIGHT].sample(sample)

    def told(self, told: SensorTold) -> None:
        """Take whatever else a reader tells."""
        self._trackers[told.side].event(told.t_s, told.event)

    def health(self, side: Side, now_s: float) -> StreamHealth:
        """How a stream is."""
        return self._trackers[side].health(now_s)

    def note_judged(self, side: Side, now_s: float) -> None:
        """Setting up has judged the sensor that answers there now."""
        self._judged[side] = self.health(side, now_s).identity

    def fit_of(self, side: Side, judgement: Judgement, now_s: float) -> Judgement:
        """The judgement on a side's sensor: none holds for another one that answers there."""
        return OTHER if self._is_other(side, now_s) and not judgement.problem else judgement

    def lost(self, now_s: float) -> Iterator[e.StreamLost]:
        """The streams that are not usable now, and why."""
        for side in Side:
            health = self.health(side, now_s)
            if not health.is_ok:
                yield e.StreamLost(now_s, side, f"{side.value} sensor: {health.reason}")
            elif self._is_other(side, now_s):
                yield e.StreamLost(now_s, side, f"{side.value} sensor: {OTHER.problem}")

    def _is_other(self, side: Side, now_s: float) -> bool:
        identity = self.health(side, now_s).identity
        return bool(identity) and identity != self._judged[side]

    def last_left_s(self, now_s: float) -> float:
        """When the newest valid sample of the left arm came; minus infinity without one."""
        counts_s = self._trackers[Side.LEFT].last_valid_s(now_s)
        return float("-inf") if counts_s is None else counts_s

    def forget_posture(self, now_s: float) -> e.LeftPosture | None:
        """Of a left arm that is not heard any more nobody knows the posture."""
        age_s = self.health(Side.LEFT, now_s).age_s
        if age_s <= POSTURE_FORGOTTEN_S or self.posture is ArmPosture.NEITHER:
            return None
        self._detector.reset()
        return e.LeftPosture(now_s, ArmPosture.NEITHER)


def _tracker(side: Side, site: SiteSettings) -> StreamTracker:
    return StreamTracker(side, site.trip_level_s, site.rate_min_hz, site.rate_max_hz)


def _detector(site: SiteSettings, postures: LeftPostures) -> PostureDetector:
    angles_deg = (site.posture_enter_deg, site.posture_leave_deg)
    return PostureDetector(*angles_deg, site.posture_debounce, postures)
