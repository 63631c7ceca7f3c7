"""Boxes to keep out of: read from every layer, never dropped, whatever is wrong with them."""

import pytest

from gestureapp.cell.engine import limits_of
from gestureapp.config import KeepOutSettings, Settings
from gestureapp.errors import ConfigError
from gestureapp.robot import messages as m
from gestureapp.settings_check import check_settings
from gestureapp.settings_file import load_settings, settings_text

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
    loaded, found = load_settings([layer(TABLE + POST)])
    assert (found, loaded.robot.keep_outs) == ([], (THE_TABLE, THE_POST))

    again = layer(settings_text(loaded).partition("schema = 1")[2], "again.toml")
    assert load_settings([again]) == (loaded, [])


def test_boxes_reach_the_guardian(layer):
    loaded, _ = load_settings([layer(TABLE + POST)])
    start = m.Start("token", "", 80, limits_of(loaded), "")

    assert m.decode(m.encode(start)) == start
    assert [box.label for box in start.limits.field.keep_outs] == ["table", "post"]


def test_a_later_layer_adds_boxes_and_takes_none_away(layer):
    site, user = layer(TABLE), layer(POST + TABLE, "user.toml")
    loaded, found = load_settings([site, user])
    assert (found, loaded.robot.keep_outs) == ([], (THE_TABLE, THE_POST))

    empty = layer("[robot]\nkeep_outs = []", "empty.toml")
    loaded, found = load_settings([site, empty])
    assert (found, loaded.robot.keep_outs) == ([], (THE_TABLE,))
    wider = check_settings(Settings(), loaded)
    assert [one.setting for one in wider] == ["robot.keep_outs"]


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        (TABLE + POST.replace("[100, 900", "[-100, 900"), 8, "'post' has the corners"),
        (TABLE.replace("1200", "3001"), 3, "-3000 to 3000 mm"),
        (TABLE.replace("600", "nan"), 3, "is not allowed"),
        (TABLE.replace('"table"', '""'), 3, "'' is no name"),
        (TABLE.replace('"table"', "5"), 3, "allowed is"),
        (TABLE.replace("name", "nam"), 3, "allowed is name ="),
        (TABLE.replace("[600, -500, -300]", "[600, -500]"), 3, "a list of 3 numbers"),
        (TABLE + POST + "size_mm = 5", 8, "allowed is name ="),
        ("[robot]\nkeep_outs = 5", 3, "allowed is name ="),
        ("".join(TABLE.replace("table", f"t{i}") for i in range(9)), 43, "9 are too many"),
    ],
)
def test_a_box_that_is_wrong_is_refused_with_its_line_and_not_left_out(layer, text, line, words):
    path = layer(text)
    with pytest.raises(ConfigError) as caught:
        load_settings([path])
    assert f"{path}, line {line}: " in str(caught.value)
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)
