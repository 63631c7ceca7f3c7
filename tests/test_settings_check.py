"""One table says what settings are allowed: for files and for the command line."""

import math
from dataclasses import replace

import pytest

from gestureapp.config import RobotSettings, Settings
from gestureapp.settings_check import PAIRS, RANGES, check_settings, named_values
from gestureapp.settings_narrowing import NARROWER


def test_the_built_in_settings_are_allowed_themselves():
    assert check_settings(Settings()) == []
    assert check_settings(Settings(), Settings()) == []


def test_every_number_has_a_range_and_every_range_a_number():
    has_number = {
        (owner, name.partition(".")[2])
        for name, owner, value in named_values(Settings())
        if not isinstance(value, bool) and isinstance(value, int | float | tuple)
    }
    assert set(RANGES) == has_number


def test_pairs_and_narrowing_limits_name_real_settings():
    names = {name for name, _, _ in named_values(Settings())}
    assert set(NARROWER) <= names
    assert {name for pair in PAIRS for name in pair} <= names


def test_command_line_overrides_are_checked_by_the_same_table():
    wild = replace(
        Settings(),
        robot=replace(RobotSettings(), speed_mm_s=251.0, int_radius_mm=1300.0, margin_mm=math.nan),
    )
    found = {finding.setting: str(finding) for finding in check_settings(wild)}
    assert set(found) == {"robot.speed_mm_s", "robot.int_radius_mm", "robot.margin_mm"}
    assert found["robot.speed_mm_s"] == (
        "robot.speed_mm_s: 251.0 is not allowed; allowed is 1 to 250 mm/s"
    )
    faster = replace(Settings(), robot=replace(RobotSettings(), speed_mm_s=150.0))
    assert check_settings(faster) == []
    assert [one.setting for one in check_settings(faster, Settings())] == ["robot.speed_mm_s"]


@pytest.mark.parametrize(
    ("host", "is_simulation", "is_fine"),
    [
        ("127.0.0.1", True, True),
        ("", True, True),
        ("192.0.2.10", False, True),
        ("192.0.2.10", True, False),
        ("localhost", True, False),
    ],
)
def test_a_simulation_opens_no_address_outside_this_machine(
    host: str, is_simulation: bool, is_fine: bool
):
    settings = Settings(robot=RobotSettings(host=host), is_simulation=is_simulation)
    found = [str(finding) for finding in check_settings(settings)]
    words = f"robot.host: '{host}' is not this machine, and a simulation opens nothing else"
    assert found == ([] if is_fine else [f"{words}; use 127.0.0.1"])


@pytest.mark.parametrize("number", [22010, 22020, 23280])
def test_the_supervised_input_begins_a_byte_and_a_site_that_has_one_keeps_it(number):
    supervised = replace(Settings(), robot=RobotSettings(supervision_input=number))
    assert check_settings(supervised) == []
    assert check_settings(supervised, Settings()) == []
    (kept,) = check_settings(Settings(), supervised)
    assert "allowed is nothing but" in str(kept)
    (wrong,) = check_settings(
        replace(Settings(), robot=RobotSettings(supervision_input=number + 1))
    )
    assert str(wrong).endswith("allowed is 0, or a multiple of 10, 22010 to 23280")
