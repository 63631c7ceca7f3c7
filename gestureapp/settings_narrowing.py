"""What limits motion and may only be narrowed by a later layer than the site's. Pure."""

from collections.abc import Callable, Mapping
from typing import Any, Final

from gestureapp.config import DriveMode
from gestureapp.settings_words import shown, unit_text


def _at_most(new: Any, below: Any) -> bool:  # noqa: ANN401 - a number of the setting's type
    return bool(new <= below)


def _at_least(new: Any, below: Any) -> bool:  # noqa: ANN401
    return bool(new >= below)


def _at_most_if_any(new: Any, below: Any) -> bool:  # noqa: ANN401
    return below == 0 or bool(0 < new <= below)


def _the_same_or_none(new: Any, below: Any) -> bool:  # noqa: ANN401
    return below in (0, new)


def _inside(new: Any, below: Any) -> bool:  # noqa: ANN401 - a low and a high value
    return bool(below[0] <= new[0] and new[1] <= below[1])


def _with_all(new: Any, below: Any) -> bool:  # noqa: ANN401 - keep-outs
    return set(below) <= set(new)


def _as_held(new: Any, below: Any) -> bool:  # noqa: ANN401 - drive modes
    return new is DriveMode.HOLD_TO_RUN or below is not DriveMode.HOLD_TO_RUN


NARROWER: Final[Mapping[str, tuple[Callable[[Any, Any], bool], str]]] = {
    "site.drive_mode": (_as_held, "nothing but"),
    "site.trip_level_s": (_at_most, "at most"),
    "site.control_limit_s": (_at_most, "at most"),
    "site.gui_limit_s": (_at_most, "at most"),
    "site.stop_on_right_lost": (_at_least, "nothing but"),
    "site.calibration_days": (_at_most, "at most"),
    "site.level_check_hours": (_at_most_if_any, "above 0 and at most"),
    "site.rate_min_hz": (_at_least, "at least"),
    "site.rate_max_hz": (_at_most, "at most"),
    "site.stop_seen_s": (_at_least, "at least"),
    "robot.ext_radius_mm": (_at_most, "at most"),
    "robot.int_radius_mm": (_at_least, "at least"),
    "robot.margin_mm": (_at_least, "at least"),
    "robot.margin_deg": (_at_least, "at least"),
    "robot.floor_mm": (_at_least, "at least"),
    "robot.ceiling_mm": (_at_most, "at most"),
    "robot.column_radius_mm": (_at_least, "at least"),
    "robot.column_top_mm": (_at_least, "at least"),
    "robot.keep_outs": (_with_all, "more than"),
    "robot.speed_mm_s": (_at_most, "at most"),
    "robot.speed_deg_s": (_at_most, "at most"),
    "robot.supervision_input": (_the_same_or_none, "nothing but"),
    "robot.supervision_hz": (_at_least, "at least"),
    "robot.rx_range_deg": (_inside, "a range inside"),
    "robot.ry_range_deg": (_inside, "a range inside"),
    "robot.rz_range_deg": (_inside, "a range inside"),
    **{f"joints.{axis}_range_deg": (_inside, "a range inside") for axis in "slurbt"},
    "joints.margin_deg": (_at_least, "at least"),
    "joints.wrist_margin_deg": (_at_least, "at least"),
    "joints.elbow_margin_deg": (_at_least, "at least"),
    "joints.shoulder_margin_mm": (_at_least, "at least"),
}
"""What limits motion: a later layer may set it narrower than the site, never wider."""

NO_LIMITS: Final[Mapping[str, str]] = {
    "site.posture_enter_deg": "wider finds the stop sooner, and the start, too",
    "site.posture_leave_deg": "the same",
    "site.posture_debounce": "fewer samples find the stop sooner, and the start, too",
    "robot.host": "which robot, not how far it goes",
    "robot.port": "the same",
    "robot.frame": "a fact of the cell, compared with what the controller tells",
    "robot.tool": "a fact of the cell, compared with what the controller tells",
    "robot.yaw_deg": "where the operator stands, not how far the robot goes",
    "robot.tool_mm": "a fact of the tool: what is true is neither narrower nor wider",
}
"""Every other setting of those tables, with why it has no narrower side (a test sees to it)."""

FREE_OF_BUILT_IN: Final = ("site.drive_mode",)
"""What is built in narrows nothing here: a file may choose until the site's own has chosen."""


def narrowed_words(name: str, limit: object) -> str:
    """What the site's layer leaves of a number's range, in words; empty where it says nothing."""
    if name not in NARROWER or isinstance(limit, bool) or not isinstance(limit, int | float):
        return ""
    return f"{NARROWER[name][1]} {limit:g}"


def why_wider(name: str, new: object, limit: object) -> str:
    """Why a later layer may not set this value; empty when it may."""
    if name not in NARROWER:
        return ""
    is_narrower, words = NARROWER[name]
    if is_narrower(new, limit):
        return ""
    unit = unit_text(name)
    return f"{shown(new)} is wider than the site allows; allowed is {words} {shown(limit)}{unit}"
