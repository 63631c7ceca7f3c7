"""What is kept of a sensor: calibration, level check, link test; one file below ``<data>/sensors``.

A file that is damaged, foreign or from a newer version makes the sensor count as not calibrated: it
is told in one line and stays where it is until a new calibration is kept, then under another name.
"""

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Final

from gestureapp.config import SiteSettings
from gestureapp.recognition.fields import count_in, number_in, object_in, table_in, text_in
from gestureapp.recording.kept_json import read_kept, write_kept
from gestureapp.recording.people import plain_name
from gestureapp.sensing.calibration import NOMINAL, Calibration, Matrix, Vector

SENSORS_FOLDER: Final = "sensors"
_KIND: Final = "gestureapp sensor"
_SCHEMA: Final = 1
_DAY_S: Final = 86_400.0
_HOUR_S: Final = 3600.0
AHEAD_S: Final = 60.0
"""A date this far in the future is a clock that was set right; farther, nobody knows its age."""

_LARGEST: Final = 10.0
"""No entry of a calibration that was ever kept is larger; see ``six_positions`` for its limits."""

_LAST_WALL_S: Final = 253_402_300_799.0
"""The end of the year 9999: what lies beyond is no date."""

_CALIBRATE: Final = "calibrate it: Setup, Calibrate, six positions"
_LEVEL: Final = "lay it on something level and check it: Setup, Calibrate, Level check"


@dataclass(frozen=True, slots=True)
class LevelRecord:
    """The last level check.

    Attributes:
        wall_s: When, seconds since the epoch.
        is_level: It passed.
        off_deg: How far from level it read with its six positions' calibration.
        off_mg: How far from 1 g.
        used: The calibration that is used from then on: that of the six positions, turned and
            scaled until the sensor read level.
    """

    wall_s: float
    is_level: bool
    off_deg: float
    off_mg: float
    used: Calibration = NOMINAL


@dataclass(frozen=True, slots=True)
class LinkRecord:
    """The last link test's figures, as ``LinkTestView`` has them, and what they were measured of.

    Attributes:
        wall_s: When.
        port: Through which; of another one they say nothing.
        protocol: In which; likewise.
    """

    wall_s: float
    rate_hz: float
    jitter_s: float
    worst_gap_s: float
    lowest_trip_s: float
    n_lost: int = 0
    n_bad: int = 0
    port: str = ""
    protocol: str = ""


@dataclass(frozen=True, slots=True)
class SensorRecord:
    """One sensor, whatever port it is on.

    Attributes:
        sensor_id: What it calls itself, or what its port is called.
        calibration: Of the six positions.
        calibrated_wall_s: When, seconds since the epoch; 0 when it never was.
        before_mg: Distance from 1 g, root of the mean square over the positions, as it came.
        after_mg: The same with the calibration.
        worst_mg: The worst of the positions with the calibration.
        verdict: In words.
        level: The last level check since the calibration; None when there was none.
        link: The last link test; None when there was none.
    """

    sensor_id: str
    calibration: Calibration = NOMINAL
    calibrated_wall_s: float = 0.0
    before_mg: float = 0.0
    after_mg: float = 0.0
    worst_mg: float = 0.0
    verdict: str = ""
    level: LevelRecord | None = None
    link: LinkRecord | None = None

    @property
    def is_calibrated(self) -> bool:
        """It was, at some time."""
        return self.calibrated_wall_s > 0.0

    @property
    def used(self) -> Calibration:
        """What its readings are to be corrected with now."""
        is_level = self.level is not None and self.level.is_level
        return self.level.used if self.level is not None and is_level else self.calibration


def record_path(data: Path, sensor_id: str) -> Path:
    """The file of this sensor, whether or not it is there."""
    return data / SENSORS_FOLDER / f"{plain_name(sensor_id, 'sensor')}.json"


def save_record(data: Path, record: SensorRecord) -> None:
    """Keep what is known of a sensor.

    Raises:
        DiskFull: no room is left there; what was kept before is as it was.
        RecordingError: it cannot be written; what was kept before is as it was.
    """
    write_kept(record_path(data, record.sensor_id), _KIND, _SCHEMA, asdict(record))


def load_record(data: Path, sensor_id: str) -> tuple[SensorRecord, str]:
    """What is known of a sensor, and what is wrong with the file; an empty record where none is.

    Nothing is raised: a file that cannot be used is one line for a person, and the sensor counts
    as not calibrated.
    """
    path = record_path(data, sensor_id)
    nothing = SensorRecord(sensor_id)
    try:
        content = read_kept(path, _KIND, _SCHEMA)
        if content is None:
            return nothing, ""
        record = _record_in(content)
        if record.sensor_id != sensor_id:
            raise ValueError(f"is that of another sensor, {record.sensor_id[:40]!r}")
    except ValueError as error:
        return nothing, f"{path.name} {error}; calibrate the sensor anew"
    return record, ""


def judge_record(record: SensorRecord, now_wall_s: float, site: SiteSettings) -> tuple[str, str]:
    """Why a sensor must not be armed with, and the remedy; two empty texts when nothing is.

    Args:
        record: What is known of it.
        now_wall_s: Seconds since the epoch.
        site: Says how long a calibration and a level check hold.
    """
    if not record.is_calibrated:
        return "not calibrated", _CALIBRATE
    age_s = now_wall_s - record.calibrated_wall_s
    if not -AHEAD_S <= age_s < math.inf:
        return (
            "calibrated in the future by this computer's clock",
            f"set the clock, or {_CALIBRATE}",
        )
    if age_s > site.calibration_days * _DAY_S:
        days, limit = math.floor(age_s / _DAY_S), site.calibration_days
        return f"calibrated {days} days ago, {limit} are allowed", _CALIBRATE
    return _judge_level(record, now_wall_s, site)


def _judge_level(record: SensorRecord, now_wall_s: float, site: SiteSettings) -> tuple[str, str]:
    """The six positions count as a check: the sensor has just lain in all of them."""
    level = record.level
    if level is not None and not level.is_level:
        return f"{level.off_deg:.1f} degrees off level", f"{_LEVEL}; if it lies well, {_CALIBRATE}"
    if not site.level_check_hours:
        return "", ""
    age_s = now_wall_s - (record.calibrated_wall_s if level is None else level.wall_s)
    if not -AHEAD_S <= age_s < math.inf:
        return "checked for level in the future by this computer's clock", _LEVEL
    if age_s > site.level_check_hours * _HOUR_S:
        hours, limit = math.floor(age_s / _HOUR_S), site.level_check_hours
        return f"level checked {hours} hours ago, {limit:g} are allowed", _LEVEL
    return "", ""


def _record_in(content: Mapping[str, object]) -> SensorRecord:
    """Raises ``ValueError`` with a line on what cannot be used."""
    return SensorRecord(
        sensor_id=text_in(content, "sensor_id"),
        calibration=_calibration_in(content, "calibration"),
        calibrated_wall_s=wall_s_in(content, "calibrated_wall_s"),
        before_mg=number_in(content, "before_mg"),
        after_mg=number_in(content, "after_mg"),
        worst_mg=number_in(content, "worst_mg"),
        verdict=text_in(content, "verdict"),
        level=None if content.get("level") is None else _level_in(object_in(content, "level")),
        link=None if content.get("link") is None else _link_in(object_in(content, "link")),
    )


def _level_in(content: Mapping[str, object]) -> LevelRecord:
    is_level = content.get("is_level")
    if not isinstance(is_level, bool):
        raise ValueError("'is_level' must be true or false")
    return LevelRecord(
        wall_s=wall_s_in(content, "wall_s"),
        is_level=is_level,
        off_deg=number_in(content, "off_deg"),
        off_mg=number_in(content, "off_mg"),
        used=_calibration_in(content, "used"),
    )


def _link_in(content: Mapping[str, object]) -> LinkRecord:
    return LinkRecord(
        wall_s=wall_s_in(content, "wall_s"),
        rate_hz=number_in(content, "rate_hz"),
        jitter_s=number_in(content, "jitter_s"),
        worst_gap_s=number_in(content, "worst_gap_s"),
        lowest_trip_s=number_in(content, "lowest_trip_s"),
        n_lost=count_in(content, "n_lost"),
        n_bad=count_in(content, "n_bad"),
        port=text_in(content, "port") if "port" in content else "",  # none in older files
        protocol=text_in(content, "protocol") if "protocol" in content else "",
    )


def _calibration_in(content: Mapping[str, object], name: str) -> Calibration:
    table = object_in(content, name)
    matrix = table_in(table, "matrix", 2)
    offset_g = vector_in(table, "offset_g")
    if matrix.shape != (3, 3) or not (abs(matrix) <= _LARGEST).all():
        raise ValueError("'matrix' must be 3 by 3 finite numbers")
    rows = [vector_in({"row": list(row)}, "row") for row in matrix.tolist()]
    found: Matrix = (rows[0], rows[1], rows[2])
    return Calibration(offset_g, found)


def wall_s_in(content: Mapping[str, object], name: str) -> float:
    """The date under this name, seconds since the epoch; ``ValueError`` when it is none."""
    wall_s = number_in(content, name)
    if not 0.0 <= wall_s <= _LAST_WALL_S:
        raise ValueError(f"'{name}' is no date")
    return wall_s


def vector_in(content: Mapping[str, object], name: str) -> Vector:
    """Three finite numbers of moderate size under this name; ``ValueError`` when they are not."""
    table = table_in(content, name, 1)
    if table.shape != (3,) or not (abs(table) <= _LARGEST).all():
        raise ValueError(f"'{name}' must be 3 finite numbers")
    x, y, z = (float(value) for value in table)
    return x, y, z
