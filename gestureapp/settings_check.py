"""Whether settings can be used: ranges, pairs that belong together, limits that may only narrow.

Pure. What is wrong comes out as findings, all of them at once; nothing is raised.
"""

import ipaddress
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields, is_dataclass
from pathlib import Path
from typing import Any, Final

from gestureapp.config import (
    BEAT_RANGE_S,
    N_TAKES_RANGE,
    YAWS_DEG,
    JointSettings,
    KeepOutSettings,
    RobotSettings,
    SensorSettings,
    Settings,
    SiteSettings,
    TrainingSettings,
)
from gestureapp.robot.address import is_loopback
from gestureapp.robot.nx100 import NETWORK_INPUTS
from gestureapp.settings_narrowing import NARROWER, why_wider
from gestureapp.settings_words import shown, unit_text

MAX_KEEP_OUTS: Final = 8
MAX_NAME_CHARS: Final = 30
"""Of a keep-out: it stands in the window beside its box."""

MAX_PORT_CHARS: Final = 200
"""Of a sensor's port, its protocol and its name: no device and no address is longer."""

LOCK_TABLE: Final = "lock"
PIN_KEY: Final = "lock.pin_hash"
"""What a settings file has of the site's PIN; no setting, as it is shown and recorded nowhere."""

_OTHER_TABLES: Final = ("left", "right", "person", "training", "schema", LOCK_TABLE)
"""Nothing in them limits motion."""


@dataclass(frozen=True, slots=True)
class Range:
    """Lowest and highest value allowed, both included; of each element where there are several."""

    low: float
    high: float

    def __contains__(self, value: float) -> bool:
        """Not so NaN, nor what is infinite; a whole number may have any number of digits."""
        return self.low <= value <= self.high

    def __str__(self) -> str:
        return f"{self.low:g} to {self.high:g}"


def bears_on_motion(name: str) -> bool:
    """Whether a setting of this name, known or not, may be meant to limit motion."""
    return name.strip("'\"").partition(".")[0] not in _OTHER_TABLES


@dataclass(frozen=True, slots=True)
class SettingsFinding:
    """One thing that is wrong with the settings; ``str()`` of it is one line for a person.

    Attributes:
        setting: Dotted name, ``robot.speed_mm_s``.
        text: What is wrong, what is allowed, and the remedy or what is used instead.
        file: Where it stands; None when it is in no file.
        line: Line in that file, from 1; None when it is in no file, or could not be told.
        cause: The text without the remedy, for beside the field of a form; empty where the text has
            none.
    """

    setting: str
    text: str
    file: Path | None = None
    line: int | None = None
    cause: str = ""

    def __str__(self) -> str:
        line = "" if self.line is None else f", line {self.line}"
        where = "" if self.file is None else f"{self.file}{line}: "
        return f"{where}{self.setting}: {self.text}"

    @property
    def is_refused(self) -> bool:
        """Whether nothing is started with it: it bears on motion, or nobody knows on what."""
        return bears_on_motion(self.setting)


RANGES: Final[Mapping[tuple[type, str], Range]] = {
    (SiteSettings, "trip_level_s"): Range(0.05, 0.3),
    (SiteSettings, "control_limit_s"): Range(0.1, 0.5),
    (SiteSettings, "gui_limit_s"): Range(0.2, 1.0),
    # Sensors send at 100 Hz; below 20 a window says nothing, above 1000 no port keeps up.
    (SiteSettings, "rate_min_hz"): Range(20.0, 1000.0),
    (SiteSettings, "rate_max_hz"): Range(20.0, 1000.0),
    (SiteSettings, "posture_enter_deg"): Range(5.0, 44.0),
    (SiteSettings, "posture_leave_deg"): Range(5.0, 44.0),
    (SiteSettings, "posture_debounce"): Range(1, 20),
    (SiteSettings, "stop_seen_s"): Range(0.1, 5.0),
    (SiteSettings, "calibration_days"): Range(1, 730),
    (SiteSettings, "level_check_hours"): Range(0.0, 168.0),
    (RobotSettings, "port"): Range(1, 65535),
    (RobotSettings, "ext_radius_mm"): Range(100.0, 1378.5),
    (RobotSettings, "int_radius_mm"): Range(100.0, 1378.5),
    (RobotSettings, "margin_mm"): Range(1.0, 200.0),
    # The outermost lie beyond every place of the tool: no floor, no ceiling.
    (RobotSettings, "floor_mm"): Range(-1500.0, 1500.0),
    (RobotSettings, "ceiling_mm"): Range(-1500.0, 1500.0),
    (RobotSettings, "column_radius_mm"): Range(0.0, 1000.0),
    (RobotSettings, "column_top_mm"): Range(-1500.0, 1500.0),
    (RobotSettings, "keep_outs"): Range(-3000.0, 3000.0),
    (RobotSettings, "speed_mm_s"): Range(1.0, 250.0),
    (RobotSettings, "speed_deg_s"): Range(0.5, 30.0),
    # A tool that points down reads Rx = 180, so a range about it passes 180: up to a full turn.
    (RobotSettings, "rx_range_deg"): Range(-360.0, 360.0),
    # Beyond a right angle the same orientation is read back as other angles.
    (RobotSettings, "ry_range_deg"): Range(-90.0, 90.0),
    (RobotSettings, "rz_range_deg"): Range(-360.0, 360.0),
    (RobotSettings, "margin_deg"): Range(0.1, 45.0),
    (RobotSettings, "frame"): Range(0, 1),
    (RobotSettings, "yaw_deg"): Range(min(YAWS_DEG), max(YAWS_DEG)),
    (RobotSettings, "tool"): Range(0, 23),
    (RobotSettings, "supervision_input"): Range(0, NETWORK_INPUTS[-1]),
    # Slower, and a ladder's timer would let a robot run for long; faster, and moves would wait.
    (RobotSettings, "supervision_hz"): Range(2.0, 10.0),
    (RobotSettings, "tool_mm"): Range(-1000.0, 1000.0),
    (TrainingSettings, "n_takes"): Range(*N_TAKES_RANGE),
    (TrainingSettings, "beat_s"): Range(*BEAT_RANGE_S),
    (JointSettings, "s_range_deg"): Range(-180.0, 180.0),
    (JointSettings, "l_range_deg"): Range(-180.0, 180.0),
    (JointSettings, "u_range_deg"): Range(-180.0, 180.0),
    # What the controller tells of R and T is unique up to a full turn either way.
    (JointSettings, "r_range_deg"): Range(-360.0, 360.0),
    (JointSettings, "b_range_deg"): Range(-180.0, 180.0),
    (JointSettings, "t_range_deg"): Range(-360.0, 360.0),
    (JointSettings, "margin_deg"): Range(1.0, 30.0),
    (JointSettings, "wrist_margin_deg"): Range(1.0, 60.0),
    (JointSettings, "elbow_margin_deg"): Range(1.0, 60.0),
    (JointSettings, "shoulder_margin_mm"): Range(1.0, 500.0),
}
"""Every number has one (a test sees to it)."""

PAIRS: Final[tuple[tuple[str, str], ...]] = (
    ("robot.int_radius_mm", "robot.ext_radius_mm"),
    ("robot.floor_mm", "robot.ceiling_mm"),
    ("site.posture_enter_deg", "site.posture_leave_deg"),
    ("site.rate_min_hz", "site.rate_max_hz"),
)
"""The first must be below the second."""

MARGINS: Final[Mapping[str, str]] = {
    "robot.int_radius_mm": "robot.margin_mm",
    "robot.floor_mm": "robot.margin_mm",
}
"""By the first of a pair: more than two of these lie between, or there is no room to move."""


def check_settings(settings: Settings, site: Settings | None = None) -> list[SettingsFinding]:
    """Everything that is wrong with these settings.

    Args:
        settings: As they would be used, after command-line overrides for instance.
        site: The settings whose motion limits hold; None where there are none yet.
    """
    found = [
        SettingsFinding(name, text)
        for name, owner, value in named_values(settings)
        if (text := why_out_of_range(owner, name.rpartition(".")[2], value))
    ]
    values = {name: value for name, _, value in named_values(settings)}
    found += [
        SettingsFinding(low, why_not_below(values, low, high)) for low, high in bad_pairs(values)
    ]
    if text := why_not_simulated(settings):
        found.append(SettingsFinding("robot.host", text))
    if site is not None:
        limits = {name: value for name, _, value in named_values(site)}
        wider = {name: why_wider(name, values[name], limits[name]) for name in NARROWER}
        found += [SettingsFinding(name, text) for name, text in wider.items() if text]
    return found


def named_values(settings: Settings) -> Iterator[tuple[str, type, Any]]:
    """Every setting of every table: dotted name, the dataclass it stands in, value."""
    for table in fields(settings):
        values = getattr(settings, table.name)
        if is_dataclass(values):
            for setting in fields(values):
                yield f"{table.name}.{setting.name}", type(values), getattr(values, setting.name)


def why_out_of_range(owner: type, name: str, value: object) -> str:
    """What is wrong with one value by itself, and what is allowed; empty when nothing is."""
    if owner is SensorSettings:
        return _why_no_line(value)
    if (owner, name) == (RobotSettings, "host"):
        return _why_no_address(value)
    if (owner, name) == (RobotSettings, "supervision_input"):
        return _why_no_input(value)
    if (owner, name) == (RobotSettings, "yaw_deg"):
        return _why_no_yaw(value)
    allowed = RANGES.get((owner, name))
    if allowed is None:
        return ""
    if (owner, name) == (RobotSettings, "keep_outs") and isinstance(value, tuple):
        return why_no_keep_outs(value, allowed)
    numbers = value if isinstance(value, tuple) else (value,)
    if not all(isinstance(n, int | float) and n in allowed for n in numbers):
        return f"{shown(value)} is not allowed; allowed is {allowed}{unit_text(name)}"
    if name.endswith("_range_deg") and not numbers[0] < numbers[1]:
        return f"{shown(value)} is no range; the first number must be below the second"
    return ""


def _why_no_line(text: object) -> str:
    """No system call takes a text with a NUL, a lone surrogate, or a longer part of a path."""
    if not isinstance(text, str) or not text.isprintable():
        return f"{shown(text)} has characters that cannot be printed; take them out"
    if len(text.encode()) > MAX_PORT_CHARS:
        return f"{shown(text)} is too long; allowed are {MAX_PORT_CHARS} characters"
    return ""


def _why_no_yaw(yaw_deg: object) -> str:
    if yaw_deg in YAWS_DEG:
        return ""
    allowed = ", ".join(map(str, YAWS_DEG[:-1]))
    return f"{shown(yaw_deg)} is not allowed; allowed is {allowed} or {YAWS_DEG[-1]} deg"


def _why_no_input(number: object) -> str:
    if number == 0 or (isinstance(number, int) and number in NETWORK_INPUTS):
        return ""
    first, last = NETWORK_INPUTS[0], NETWORK_INPUTS[-1]
    return f"{shown(number)} is not allowed; allowed is 0, or a multiple of 10, {first} to {last}"


def why_no_keep_outs(boxes: tuple[KeepOutSettings, ...], allowed: Range) -> str:
    """What is wrong with boxes to keep out of, and what is allowed; empty when nothing is."""
    if len(boxes) > MAX_KEEP_OUTS:
        return f"{len(boxes)} are too many; allowed are {MAX_KEEP_OUTS}"
    for i, box in enumerate(boxes):
        key, text = wrong_in_keep_out(box, allowed)
        if text:
            return f"{keep_out_label(i, box.name)}, {key}: {text}"
    return ""


def wrong_in_keep_out(box: KeepOutSettings, allowed: Range) -> tuple[str, str]:
    """The key of a box that is wrong and what is wrong with it; two empty texts when nothing is."""
    if text := _why_no_name(box.name):
        return "name", text
    for key, corner in (("low_mm", box.low_mm), ("high_mm", box.high_mm)):
        if not all(number in allowed for number in corner):
            return key, f"{shown(corner)} is not allowed; allowed is {allowed} mm"
    if not all(low < high for low, high in zip(box.low_mm, box.high_mm, strict=True)):
        rule = "each number of low_mm must be below that of high_mm"
        return "low_mm", f"{shown(box.low_mm)} is not below high_mm = {shown(box.high_mm)}; {rule}"
    return "", ""


def keep_out_label(index: int, name: object) -> str:
    """Which box it is, for a person: its place in its list, and its name if that is one."""
    is_name = isinstance(name, str) and not _why_no_name(name)
    return f"box {index + 1} {shown(name)}" if is_name else f"box {index + 1}"


def _why_no_name(name: str) -> str:
    if len(name) > MAX_NAME_CHARS:
        return (
            f"{shown(name)} is too long ({len(name)} characters); allowed are 1 to {MAX_NAME_CHARS}"
        )
    if not name.strip() or not name.isprintable():
        return f"{shown(name)} is no name; give one of 1 to {MAX_NAME_CHARS} characters"
    return ""


def _why_no_address(host: object) -> str:
    """A name would have to be looked up by the guardian, while a stop waits for the line."""
    try:
        is_address = host in ("", "localhost") or bool(ipaddress.ip_address(str(host)))
    except ValueError:
        is_address = False
    return "" if is_address else f"{shown(host)} is no address; give the controller's IP address"


def why_not_simulated(settings: Settings) -> str:
    """Why these cannot be a simulation's: its robot is on this machine. Empty when they can."""
    host = settings.robot.host
    if not settings.is_simulation or not host or is_loopback(host):
        return ""
    return f"{shown(host)} is not this machine, and a simulation opens nothing else; use 127.0.0.1"


def bad_pairs(values: Mapping[str, Any]) -> list[tuple[str, str]]:
    """The pairs whose first value is not below the second, or leaves no room below it."""
    return [pair for pair in PAIRS if why_not_below(values, *pair)]


def why_not_below(values: Mapping[str, Any], low: str, high: str) -> str:
    """What is wrong with such a pair; empty when nothing is."""
    if not values[low] < values[high]:
        return f"{shown(values[low])} must be below {high} = {shown(values[high])}"
    margin = MARGINS.get(low)
    if margin is None or not values[low] + 2 * values[margin] >= values[high]:
        return ""
    between = f"more than 2 times {margin} = {shown(values[margin])}{unit_text(margin)}"
    text = f"{shown(values[low])} leaves no room to {high} = {shown(values[high])}"
    return f"{text}; {between} must lie between them"
