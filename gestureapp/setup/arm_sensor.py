"""One arm's sensor: who it is, what is kept of it, and whether it may be armed with."""

import math
from dataclasses import dataclass, replace
from datetime import datetime
from pathlib import Path
from typing import Final

from gestureapp.cell.controls import CellControls
from gestureapp.config import SensorSettings, SiteSettings
from gestureapp.recording.sensor_records import (
    LinkRecord,
    SensorRecord,
    judge_record,
    load_record,
    save_record,
)
from gestureapp.sensing.calibration import NOMINAL, Calibration
from gestureapp.sensing.port_list import SystemPort
from gestureapp.sensing.values import LinkState, Side, StreamHealth
from gestureapp.setup.fit import mg_words
from gestureapp.setup.link_test import link_problem
from gestureapp.setup.sides import SWAPPED
from gestureapp.setup.values import LinkTestView, Remedy, SensorCard

IDENTITY_WITHIN_S: Final = 1.5
"""A sensor that says who it is does so once a second."""
ADOPTED_AFTER_S: Final = 2.5
"""So long after its first sample a newly chosen sensor is remembered as this arm's."""

_CHOOSE: Final = ("no sensor is chosen", "choose its port: Setup, Sensors")


@dataclass(frozen=True, slots=True)
class Known:
    """Who a sensor is.

    Attributes:
        id: What its calibration is kept under.
        name: What a person calls it.
        stays: The id stays with the sensor, whatever port it is on.
        is_from_wire: The sensor said so itself.
    """

    id: str = ""
    name: str = ""
    stays: bool = False
    is_from_wire: bool = False


def identify(identity: str, settings: SensorSettings, port: SystemPort | None) -> Known:
    """Who is there: what the sensor says wins over what the system knows, and that over names.

    Args:
        identity: What the sensor calls itself; empty when it does not.
        settings: Of its reader.
        port: The port as the system lists it, if it does.
    """
    named = settings.name
    if identity:
        return Known(identity, named or identity, stays=True, is_from_wire=True)
    if port is not None and port.sensor_id:
        return Known(port.sensor_id, named or port.name, stays=True)
    if named:
        return Known(named, named)
    return Known(settings.port, port.name if port is not None else settings.port)


class ArmSensor:
    """What setting up knows of one arm's sensor. Owned by the setup thread.

    Args:
        side: Which arm.
        cell: Is told calibration and judgement, whenever they change.
        data: The data folder.

    Attributes:
        known: Who it is.
        record: What is kept of it.
        trouble: Why what is kept cannot be read or written; empty when it can.
        raw: While set, its samples are not corrected at all, or only with this: it is measured.
        problem: Why it must not be armed with, as told to the cell last.
        remedy: What to do about that.
        act: The button that does it.
    """

    def __init__(self, side: Side, cell: CellControls, data: Path) -> None:
        self.side, self._cell, self._data = side, cell, data
        self.known = Known()
        self.record = SensorRecord("")
        self.trouble = ""
        self.raw: Calibration | None = None
        self.problem, self.remedy = _CHOOSE
        self.act = Remedy.FIND
        self._told: tuple[str, str] | None = None
        self._used = NOMINAL
        self._port = ""
        self._receiving_s: float | None = None

    @property
    def settings(self) -> SensorSettings:
        """Of its reader."""
        both = self._cell.settings
        return both.left if self.side is Side.LEFT else both.right

    def is_seen(self, now_s: float) -> bool:
        """It has sent for so long that whoever it is would have said so."""
        since_s = self._receiving_s
        return since_s is not None and now_s - since_s >= ADOPTED_AFTER_S

    def look(self, now_s: float, health: StreamHealth, port: SystemPort | None) -> None:
        """Find out who is there now, and fetch what is kept of it."""
        self._follow(now_s, health)
        known = identify(health.identity, self.settings, port)
        if self._is_silent_yet(now_s) and self.known.is_from_wire and not known.is_from_wire:
            return
        if known.id != self.known.id or (known.id and not self.record.sensor_id):
            self.record, self.trouble = load_record(self._data, known.id)
        self.known = known

    def judge(self, wall_s: float, wrong_sides: tuple[str, str]) -> None:
        """Tell the cell how its samples are corrected, and whether it may be armed with.

        Args:
            wall_s: Seconds since the epoch.
            wrong_sides: What is wrong with who is on which arm, and the remedy.
        """
        used = self.record.used if self.raw is None else self.raw
        if used != self._used:
            self._used = used
            self._cell.use_calibration(self.side, used)
        self.act, (self.problem, self.remedy) = self._judged(wall_s, wrong_sides)
        if self._told != (self.problem, self.remedy):
            self._told = (self.problem, self.remedy)
            self._cell.judge_sensor(self.side, self.problem, self.remedy)

    def keep(self, record: SensorRecord) -> None:
        """Keep what was found out about it.

        Raises:
            RecordingError: it cannot be written; nothing has changed then.
        """
        kept = replace(record, sensor_id=self.known.id)
        save_record(self._data, kept)
        self.record, self.trouble = kept, ""

    def with_link(self, view: LinkTestView) -> SensorRecord:
        """What is kept of it, with these figures of the link."""
        link = LinkRecord(
            wall_s=view.outcome.wall_s,
            rate_hz=view.rate_hz,
            jitter_s=view.jitter_s,
            worst_gap_s=view.worst_gap_s,
            lowest_trip_s=view.lowest_trip_s,
            n_lost=view.n_lost,
            n_bad=view.n_bad,
            port=self.settings.port,
            protocol=self.settings.protocol,
        )
        return replace(self.record, link=link)

    def card(self, health: StreamHealth, advice: tuple[str, ...], wall_s: float) -> SensorCard:
        """For the window."""
        settings = self.settings
        return SensorCard(
            side=self.side,
            port=settings.port,
            protocol=settings.protocol,
            sensor_id=self.known.id,
            name=self.known.name,
            health=health,
            advice=advice,
            bad_bytes=health.bad_bytes,
            calibration=calibration_words(self.record, wall_s),
            level=level_words(self.record, wall_s),
            link=link_words(self._link(), wall_s),
            problem=self.problem,
            remedy=self.remedy,
            act=self.act,
        )

    def _link(self) -> LinkRecord | None:
        """The last link test, if it was of what the sensor is read through now."""
        link, settings = self.record.link, self.settings
        if link is None or (link.port, link.protocol) != (settings.port, settings.protocol):
            return None
        return link

    def _follow(self, now_s: float, health: StreamHealth) -> None:
        if self._port != self.settings.port:
            self._port, self._receiving_s, self.known = self.settings.port, None, Known()
        if health.link is not LinkState.RECEIVING:
            self._receiving_s = None
        elif self._receiving_s is None:
            self._receiving_s = now_s

    def _is_silent_yet(self, now_s: float) -> bool:
        """It has not sent for so long that it would have said who it is."""
        since_s = self._receiving_s
        return since_s is None or now_s - since_s < IDENTITY_WITHIN_S

    def _judged(
        self, wall_s: float, wrong_sides: tuple[str, str]
    ) -> tuple[Remedy, tuple[str, str]]:
        """The button that helps; what is wrong, and the remedy in words."""
        site: SiteSettings = self._cell.settings.site
        if not self.settings.port:
            return Remedy.FIND, _CHOOSE
        if self.raw is not None:
            words = ("it is being calibrated", "finish it, or end it: Setup, Calibrate")
            return Remedy.CALIBRATE, words
        if wrong_sides[0]:
            return (Remedy.SWAP if wrong_sides[0] == SWAPPED else Remedy.FIND), wrong_sides
        if self.trouble:
            cause, _, remedy = self.trouble.rpartition("; ")
            return Remedy.CALIBRATE, (cause, remedy)
        found = judge_record(self.record, wall_s, site)
        if found[0]:
            return Remedy.CALIBRATE, found
        link = self._link()
        lowest_s = math.nan if link is None else link.lowest_trip_s
        found = link_problem(lowest_s, site.trip_level_s)
        return (Remedy.TEST_LINK if found[0] else Remedy.NONE), found


def calibration_words(record: SensorRecord, wall_s: float) -> str:
    """How a sensor was calibrated and when."""
    if not record.is_calibrated:
        return "not calibrated"
    within = f", within {mg_words(record.worst_mg)}" if record.worst_mg else ""
    return f"calibrated {day_words(record.calibrated_wall_s, wall_s)}{within}"


def level_words(record: SensorRecord, wall_s: float) -> str:
    """The last level check."""
    level = record.level
    if level is None:
        return ""
    when = day_words(level.wall_s, wall_s)
    return f"{'level' if level.is_level else 'not level'}, {level.off_deg:.1f} degrees, {when}"


def link_words(link: LinkRecord | None, wall_s: float) -> str:
    """The last link test; None where there was none of this port and protocol."""
    if link is None:
        return "link not tested"
    carries = f"carries {link.lowest_trip_s * 1000:.0f} ms"
    return f"link tested {day_words(link.wall_s, wall_s)}, {carries}"


def day_words(then_s: float, now_s: float) -> str:
    """A day as a person says it, in this machine's time zone: ``today``, ``on 3 March 2026``."""
    then, now = (datetime.fromtimestamp(wall_s).astimezone() for wall_s in (then_s, now_s))
    days = (now.date() - then.date()).days
    near = {0: f"today at {then:%H:%M}", 1: f"yesterday at {then:%H:%M}"}
    return near.get(days, f"on {then.day} {then:%B %Y}")
