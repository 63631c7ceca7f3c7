"""What setting up has changed, and what of it still waits until nothing may move. Pure."""

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace

from gestureapp.cell.fitness import FIT, Fitness, Judgement, why_overlapping
from gestureapp.cell.inputs import (
    ArmingHeld,
    CalibrationChosen,
    PosturesChosen,
    ReaderPort,
    SensorChosen,
    SensorJudged,
    SettingsChosen,
    SetupInput,
)
from gestureapp.cell.limits import limits_of
from gestureapp.cell.records import Json, Record, Recorder, Topic, plain
from gestureapp.config import RobotSettings, SensorSettings, Settings
from gestureapp.sensing.calibration import Calibration
from gestureapp.sensing.posture import BUILT_IN
from gestureapp.sensing.values import Side

_TABLES = ("site", "robot", "joints", "training")
"""What ``use_settings`` changes; sensors and person have calls of their own."""


@dataclass(frozen=True, slots=True)
class Taken:
    """What has changed.

    Attributes:
        has_settings: Of site, robot or joints.
        is_guardian_concerned: The limits or the controller's address: a guardian has them for good.
        is_other_robot: The address.
        sensors: Which are read from elsewhere now.
    """

    has_settings: bool
    is_guardian_concerned: bool
    is_other_robot: bool
    sensors: tuple[Side, ...]


class Adjustments:
    """Settings, postures and judgements in use, and what waits. Owned by the control thread.

    Args:
        settings: At first.
        readers: Of both sensors.
        record: Takes every change.

    Attributes:
        settings: In use.
        postures: In use.
        fitness: What setting up says of sensors and postures.
        hold: Why nothing can be armed, as something is open beside it; or empty.
    """

    def __init__(
        self, settings: Settings, readers: Mapping[Side, ReaderPort], record: Recorder
    ) -> None:
        self.settings, self.postures = settings, BUILT_IN
        self.fitness = Fitness()
        self.hold = ""
        self._readers, self._record = readers, record
        self._sensors: dict[Side, SensorSettings] = {}
        self._calibrations: dict[Side, Calibration] = {}
        self._postures_judged = FIT
        self._next_settings: Settings | None = None
        self._next_postures: PosturesChosen | None = None

    def note(self, item: SetupInput, now_s: float) -> bool:
        """Take what holds at once, and keep what waits. Returns whether to disarm."""
        match item:
            case ArmingHeld():
                before, self.hold = self.hold, item.why
                return bool(item.why) and item.why != before
            case SensorJudged():
                return self.fitness.judge(item.side, item.judgement)
            case CalibrationChosen():
                self._calibrations[item.side] = item.calibration
            case SensorChosen():
                self._sensors[item.side] = item.settings
            case PosturesChosen():
                self._next_postures = item
            case SettingsChosen():
                self._next_settings = item.settings
        return False

    def take(self, now_s: float) -> Taken | None:
        """Take what waits; only while nothing may move. None when nothing did."""
        chosen, postures, sensors = self._next_settings, self._next_postures, self._sensors
        calibrations, self._calibrations = self._calibrations, {}
        for side, calibration in calibrations.items():
            self._readers[side].set_calibration(calibration)
            self._tell({f"{side.value}.calibration": plain(calibration)}, now_s)
        if chosen is None and postures is None and not sensors:
            return None
        self._next_settings, self._next_postures, self._sensors = None, None, {}
        before = self.settings
        after = before if chosen is None else with_limits_of(before, chosen)
        for side, settings in sensors.items():
            self._readers[side].use(settings)
            is_left = side is Side.LEFT
            after = replace(after, left=settings) if is_left else replace(after, right=settings)
        self.settings = after
        if postures is not None:
            self.postures, self._postures_judged = postures.postures, postures.judgement
            self._tell({"left.postures": plain(postures.postures)}, now_s)
        self._judge_postures()
        changes = _changes(before, after)
        if changes:
            self._tell(changes, now_s)
        is_other_robot = address_of(before.robot) != address_of(after.robot)
        return Taken(
            has_settings=any(not n.startswith(("left.", "right.")) for n in changes),
            is_guardian_concerned=is_other_robot or limits_of(before) != limits_of(after),
            is_other_robot=is_other_robot,
            sensors=tuple(sensors),
        )

    def _judge_postures(self) -> None:
        """Anew with every change: other angles may be too wide for the same postures."""
        judgement = self._postures_judged
        overlapping = why_overlapping(self.postures, self.settings.site)
        if overlapping and not judgement.problem:
            judgement = Judgement(overlapping, "Setup, step Calibrate: record the postures again")
        self.fitness.postures = judgement if judgement.problem else FIT

    def _tell(self, changes: Mapping[str, Json], now_s: float) -> None:
        self._record(Record(Topic.SETTINGS, now_s, {"changes": changes}))


def address_of(robot: RobotSettings) -> str:
    """Of the controller: ``HOST:PORT``."""
    return f"{robot.host}:{robot.port}"


def with_limits_of(settings: Settings, chosen: Settings) -> Settings:
    """These settings with the chosen tables of what may move, and how training goes."""
    return replace(
        settings,
        site=chosen.site,
        robot=chosen.robot,
        joints=chosen.joints,
        training=chosen.training,
    )


def _changes(before: Settings, after: Settings) -> dict[str, Json]:
    found: dict[str, Json] = {}
    for table in ("left", "right", *_TABLES):
        old, new = getattr(before, table), getattr(after, table)
        for setting in fields(new):
            value = getattr(new, setting.name)
            if value != getattr(old, setting.name):
                found[f"{table}.{setting.name}"] = plain(value)
    return found
