"""Boxes to keep out of: read from every layer, never dropped, whatever is wrong with them."""

import pytest

from gestureapp.cell.limits import limits_of
from gestureapp.config import KeepOutSettings, Settings
from gestureapp.errors import SettingsRefused
from gestureapp.robot import messages as m
from gestureapp.settings_check import check_settings
from gestureapp.settings_file import load_settings, read_settings, settings_text

TABLE = """
[[robot.keep_outs]]
name = "table"
low_mm = [600, -500, -300]
high_mm = [1200, 500, -100]
"""
POST = """
[[robot.keep_outs]]
name = "post"
low_mm = [-100, 700, -300]
high_mm = [100, 900, 1000]
"""
THE_TABLE = KeepOutSettings("table", (600.0, -500.0, -300.0), (1200.0, 500.0, -100.0))
THE_POST = KeepOutSettings("post", (-100.0, 700.0, -300.0), (100.0, 900.0, 1000.0))


@pytest.fixture
def layer(tmp_path):
    def write(text, name="site.toml"):
        path = tmp_path / name
        path.write_text(f"schema = 1\n{text}", encoding="utf-8")
        return path

    return write


def test_boxes_are_read_written_and_read_again(layer):
    loaded, found = read_settings([layer(TABLE + POST)])
    assert (found, loaded.robot.keep_outs) == ([], (THE_TABLE, THE_POST))

    again = layer(settings_text(loaded).partition("schema = 1")[2], "again.toml")
    assert read_settings([again]) == (loaded, [])


def test_boxes_reach_the_guardian(layer):
    loaded, _ = read_settings([layer(TABLE + POST)])
    start = m.Start("token", "", 80, limits_of(loaded), "")

    assert m.decode(m.encode(start)) == start
    assert [box.label for box in start.limits.field.keep_outs] == ["table", "post"]


def test_a_later_layer_adds_boxes_and_takes_none_away(layer):
    site, user = layer(TABLE), layer(POST + TABLE, "user.toml")
    loaded, found = read_settings([site, user])
    assert (found, loaded.robot.keep_outs) == ([], (THE_TABLE, THE_POST))

    empty = layer("[robot]\nkeep_outs = []", "empty.toml")
    loaded, found = read_settings([site, empty])
    assert (found, loaded.robot.keep_outs) == ([], (THE_TABLE,))
    wider = check_settings(Settings(), loaded)
    assert [one.setting for one in wider] == ["robot.keep_outs"]


LIST = """
[robot]
keep_outs = [  # low, high
  { name = "table", low_mm = [600, -500, -300], high_mm = [1200, 500, -100] },
  { name = "post", low_mm = [
    -100, 700], high_mm = [100, 900, 1000] },
]
"""
TOO_LONG = "a name that is longer than thirty"
NOT_THREE = "low_mm: [600, -500] is not allowed; allowed is a list of 3 numbers, mm: [x, y, z]"


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        (TABLE + POST.replace("[100, 900", "[-100, 900"), 10, "box 2 'post', low_mm: [-100.0, "),
        (TABLE.replace("1200", "3001"), 6, "high_mm: [3001.0, 500.0, -100.0] is not allowed"),
        (TABLE.replace("600", "nan"), 5, "box 1 'table', low_mm: [nan, -500, -300] is not allowed"),
        (TABLE.replace('"table"', '""'), 4, "box 1, name: '' is no name"),
        (TABLE.replace('"table"', "5"), 4, "box 1, name: 5 is not allowed; allowed is a text"),
        (TABLE.replace("table", TOO_LONG), 4, f"name: '{TOO_LONG}' is too long (33 characters)"),
        (TABLE.replace("name", "nam"), 4, "box 1, nam: unknown (did you mean name?)"),
        (TABLE.partition("high_mm")[0], 3, "box 1 'table', high_mm: missing; a box is"),
        (TABLE.replace("[600, -500, -300]", "[600, -500]"), 5, f"box 1 'table', {NOT_THREE}"),
        (TABLE + POST + "size_mm = 5", 12, "box 2 'post', size_mm: unknown"),
        (LIST, 7, "box 2 'post', low_mm: [-100, 700] is not allowed"),
        ("[robot]\nkeep_outs = 5", 3, "robot.keep_outs: 5 is not allowed; allowed is a list"),
        ("[robot]\nkeep_outs = [5]", 3, "box 1: 5 is not allowed; allowed is { name ="),
        ("".join(TABLE.replace("table", f"t{i}") for i in range(9)), 43, "allowed are 8"),
    ],
)
def test_a_box_that_is_wrong_is_named_and_refused_with_its_line(layer, text, line, words):
    path = layer(text)
    with pytest.raises(SettingsRefused) as caught:
        load_settings([path])
    assert str(caught.value).startswith(f"{path}, line {line}: robot.keep_outs: ")
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)
    loaded, (found,) = read_settings([path])
    assert str(found) == str(caught.value)
    assert check_settings(loaded) == []


def test_every_wrong_box_is_told(layer):
    wrong = (TABLE + POST + TABLE).replace("-300]", "-300, 0]")
    _, found = read_settings([layer(wrong)])
    assert [one.line for one in found] == [5, 10, 15]
