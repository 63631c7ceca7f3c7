"""Settings as they are typed: whatever the value, typing it gives it back; rubbish is refused."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gestureapp.config import KeepOutSettings, RobotSettings
from gestureapp.setup.site_values import SettingRow
from tests.ui.setup_bench import every_setting
from ui.facing_view import TURNS, robot_axis
from ui.setting_values import NotReadable, edited_robot, in_words, typed_value, value_text

FINITE = st.floats(-1e6, 1e6).map(lambda x: float(f"{x:.6g}"))
CORNER = st.tuples(FINITE, FINITE, FINITE)
NAMES = st.text(st.characters(codec="utf-8", categories=("L", "N")), min_size=1, max_size=30)
BOXES = st.lists(st.fixed_dictionaries({"name": NAMES, "low_mm": CORNER, "high_mm": CORNER}))
ROWS = {row.name: row for row in every_setting()}


def row_of(value: object, name: str = "robot.any") -> SettingRow:
    return SettingRow(name, "", value, "", "", "built-in", False)


def tuples(value: object) -> object:
    """Lists and tuples are the same to a settings file."""
    if isinstance(value, list | tuple):
        return tuple(tuples(each) for each in value)
    return {key: tuples(each) for key, each in value.items()} if isinstance(value, dict) else value


@pytest.mark.parametrize("name", ROWS)
def test_every_built_in_value_is_read_back_as_it_was(name):
    row = ROWS[name]
    assert tuples(typed_value(row, value_text(row))) == tuples(row.value)


@given(st.one_of(FINITE, st.integers(-(10**9), 10**9), st.booleans(), CORNER))
def test_what_is_typed_is_what_was_shown(value):
    row = row_of(value)
    again = typed_value(row, value_text(row))
    assert tuples(again) == tuples(value)
    assert isinstance(value, tuple) or type(again) is type(value)


@given(BOXES)
def test_boxes_are_read_back_as_they_were(boxes):
    row = row_of(boxes, "robot.keep_outs")
    assert tuples(typed_value(row, value_text(row))) == tuples(boxes)


@given(st.sampled_from(list(ROWS.values())), st.text(max_size=40))
def test_rubbish_is_refused_in_one_line_or_read(row, text):
    try:
        read = typed_value(row, text)
    except NotReadable as error:
        said = str(error)
    else:
        said = repr(read)
    assert len(said.splitlines()) == 1


def test_a_comma_may_stand_for_the_point_of_a_number():
    assert typed_value(row_of(1.5), "2,5") == 2.5


def test_the_picture_is_of_the_settings_with_what_was_typed():
    boxes = [{"name": "table", "low_mm": [1, 2, 3], "high_mm": [4, 5, 6]}]
    changes = {"robot.floor_mm": -50.0, "robot.keep_outs": boxes, "site.trip_level_s": 0.2}
    robot = edited_robot(ROWS.values(), changes)
    table = KeepOutSettings("table", (1, 2, 3), (4, 5, 6))
    assert (robot.floor_mm, robot.keep_outs) == (-50.0, (table,))
    assert edited_robot(ROWS.values(), {}) == RobotSettings()


@pytest.mark.parametrize("turn", TURNS)
def test_the_operators_axes_stay_right_handed(turn):
    order = ("X+", "Y+", "X-", "Y-")
    forward, left = order.index(robot_axis("X+", turn)), order.index(robot_axis("Y+", turn))
    assert left == (forward + 1) % 4
    assert robot_axis("X-", turn) == order[(forward + 2) % 4]


@pytest.mark.parametrize(("turn", "axis"), [(0, "X+"), (90, "Y+"), (180, "X-"), (-90, "Y-")])
def test_forward_is_where_the_operator_faces(turn, axis):
    assert robot_axis("X+", turn) == axis


def test_a_message_has_the_words_of_the_fields():
    text = "900 must be below robot.ext_radius_mm = 800; site.drive_mode is start_stop"
    assert in_words(text) == (
        "900 must be below \u201cOuter sphere\u201d = 800; \u201cDrive mode\u201d is start and stop"
    )
