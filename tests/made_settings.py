"""Any settings that are allowed, for property tests."""

from dataclasses import fields, replace
from enum import Enum
from pathlib import Path

from hypothesis import strategies as st

from gestureapp.config import (
    YAWS_DEG,
    PersonSettings,
    RobotSettings,
    SensorSettings,
    Settings,
    SiteSettings,
    TrainingSettings,
)
from gestureapp.robot.nx100 import NETWORK_INPUTS
from gestureapp.settings_check import PAIRS, RANGES, check_settings

_TEXT = st.text(st.characters(codec="utf-8"), max_size=20)
_LINE = st.text(st.characters(codec="utf-8", exclude_categories=("C", "Z")), max_size=20)
"""What a port, a protocol and a sensor's name may be."""


def _numbers(owner, name, value):
    allowed = RANGES[owner, name]
    if name == "supervision_input":
        return st.sampled_from([0, *NETWORK_INPUTS])
    if name == "yaw_deg":
        return st.sampled_from(YAWS_DEG)
    if isinstance(value, int):
        return st.integers(int(allowed.low), int(allowed.high))
    one = st.floats(allowed.low, allowed.high)
    if not isinstance(value, tuple):
        return one
    several = st.tuples(*[one] * len(value))
    if name.endswith("_range_deg"):
        return several.map(sorted).map(tuple).filter(lambda pair: pair[0] < pair[1])
    return several


def values(owner, name, value):
    if isinstance(value, bool):
        return st.booleans()
    if isinstance(value, Enum):
        return st.sampled_from(type(value))
    if name == "host":
        return st.sampled_from(["", "localhost"]) | st.ip_addresses().map(str)
    if isinstance(value, str):
        return _LINE if owner is SensorSettings else _TEXT
    if value is None:
        return st.none() | st.just(Path('/models/Ådá \\ "x" \x7f.json'))
    return _numbers(owner, name, value)


def _tables(owner):
    built_in = {field.name: field.default for field in fields(owner)}
    kinds = {name: values(owner, name, value) for name, value in built_in.items()}
    return st.builds(owner, **kinds)


def _in_order(made):
    """The same settings with the two values of every pair the right way round, and room between."""
    for low, high in PAIRS:
        table = low.partition(".")[0]
        names = [name.partition(".")[2] for name in (low, high)]
        values = sorted(getattr(getattr(made, table), name) for name in names)
        own = replace(getattr(made, table), **dict(zip(names, values, strict=True)))
        made = replace(made, **{table: own})
    robot = made.robot
    room = min(robot.ext_radius_mm - robot.int_radius_mm, robot.ceiling_mm - robot.floor_mm)
    return replace(made, robot=replace(robot, margin_mm=min(robot.margin_mm, room / 3)))


ALLOWED = (
    st.builds(
        Settings,
        left=_tables(SensorSettings),
        right=_tables(SensorSettings),
        site=_tables(SiteSettings),
        robot=_tables(RobotSettings),
        person=_tables(PersonSettings),
        training=_tables(TrainingSettings),
    )
    .map(_in_order)
    .filter(lambda made: not check_settings(made))
)
