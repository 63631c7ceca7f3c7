"""A limit on motion that was asked for and is not understood lets nothing start."""

import pytest

from gestureapp.config import KeepOutSettings, RobotSettings, Settings
from gestureapp.errors import SettingsRefused
from gestureapp.settings_check import check_settings
from gestureapp.settings_file import load_settings, read_settings
from gestureapp.settings_words import shown


@pytest.fixture
def path(tmp_path):
    return tmp_path / "site.toml"


def refused(path, text):
    """The lines with which a file of this text is refused."""
    path.write_text(f"schema = 1\n{text}\n", encoding="utf-8")
    with pytest.raises(SettingsRefused) as caught:
        load_settings([path])
    return str(caught.value).splitlines()


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        (
            "[robot]\nfloor_mm = 200\nceiling_mm = 100",
            3,
            "robot.floor_mm: 200.0 must be below robot.ceiling_mm = 100.0; correct it, or take it "
            "out: then -300.0 is used",
        ),
        ("[robot]\nspeed_mm_s = 251", 3, "allowed is 1 to 250 mm/s; correct it"),
        ("[robot]\nsupervision_input = 22011", 3, "allowed is 0, or a multiple of 10"),
        ("[robot]\nflor_mm = 3", 3, "robot.flor_mm: unknown (did you mean floor_mm?); correct it"),
        ("[robot]\nkeepouts = 3", 3, "unknown (did you mean keep_outs?); correct it"),
        ("[joints]\ns_range_deg = [170, -170]", 3, "first number must be below the second"),
        ("[joints]\nwrist_margin_deg = 0.0", 3, "allowed is 1 to 60 deg; correct it"),
        ("[site]\ntrip_level_s = 1", 3, "allowed is 0.05 to 0.3 s; correct it"),
        ("[site]\ntrip_level = 0.1", 3, "did you mean trip_level_s?"),
        ("[robbot]\nfloor_mm = 3", 2, "robbot: unknown (did you mean robot?)"),
        ("joints = 3", 2, "joints: must be a table; write [joints]"),
        ("floor_mm = 3", 2, "floor_mm: unknown; correct it, or take it out"),
        ('"left\\n" = 3', 2, "unknown (did you mean left?)"),
    ],
)
def test_what_bears_on_motion_and_is_wrong_is_one_line_and_no_start(path, text, line, words):
    (told,) = refused(path, text)
    assert told.startswith(f"{path}, line {line}: ")
    assert words in told


@pytest.mark.parametrize(
    "text", ["[left]\nprt = ''", "left = 3", "[right]\nport = 3", "[person]\nmodel = 5"]
)
def test_what_does_not_bear_on_motion_is_told_and_started_with(path, text):
    path.write_text(f"schema = 1\n{text}\n")
    loaded, found = load_settings([path])
    assert loaded == Settings()
    assert len(found) == 1


def test_everything_that_is_wrong_is_listed_before_the_refusal(path):
    text = "[robot]\nfloor_mm = 1\nceiling_mm = 0\ntol = 1\n[left]\nprt = ''\n[joints]\nx = 1"
    *lines, end = refused(path, text)
    assert [line.partition(": ")[0] for line in lines] == [
        f"{path}, line {number}" for number in (3, 5, 7, 9)
    ]
    assert end.startswith("not started: ")


def test_the_users_file_is_refused_as_the_sites_is(path, tmp_path):
    user = tmp_path / "user.toml"
    user.write_text("schema = 1\n[robot]\nspeed_mm_s = 200\n")
    for files, named in (([path, user], None), ([], user)):
        with pytest.raises(SettingsRefused, match=r"user.toml, line 3: .* at most 100.0 mm/s"):
            load_settings(files, named)


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        (
            "floor_mm = 80\nceiling_mm = 120",
            3,
            "robot.floor_mm: 80.0 leaves no room to robot.ceiling_mm = 120.0; more than 2 times "
            "robot.margin_mm = 20.0 mm must lie between them; ",
        ),
        ("ceiling_mm = -260", 3, "robot.ceiling_mm: robot.floor_mm = -300.0 leaves no room to"),
        ("int_radius_mm = 1160", 3, "robot.int_radius_mm: 1160.0 leaves no room to"),
        ("margin_mm = 200\next_radius_mm = 900", 4, "robot.margin_mm = 200.0 mm must lie between"),
        ("margin_mm = 4\nfloor_mm = 0\nceiling_mm = 9\nint_radius_mm = 1300", 6, "must be below"),
        ("margin_mm = 0\nfloor_mm = 0\nceiling_mm = 9", 3, "allowed is 1 to 200 mm"),
    ],
)
def test_a_field_without_room_is_one_finding(path, text, line, words):
    (told,) = refused(path, f"[robot]\n{text}")
    assert told.startswith(f"{path}, line {line}: ")
    assert words in told
    loaded, _ = read_settings([path])
    assert check_settings(loaded) == []


def test_a_field_with_little_room_is_one(path):
    path.write_text("schema = 1\n[robot]\nmargin_mm = 5\nfloor_mm = 0\nceiling_mm = 10.1\n")
    assert load_settings([path])[1] == []


def test_boxes_are_checked_without_a_file_as_well():
    boxes = (
        KeepOutSettings("table", (0.0, 0.0, 0.0), (1.0, 1.0, 1.0)),
        KeepOutSettings("post", (0.0, 0.0, 2.0), (1.0, 1.0, 1.0)),
    )
    (found,) = check_settings(Settings(robot=RobotSettings(keep_outs=boxes)))
    assert str(found).startswith("robot.keep_outs: box 2 'post', low_mm: [0.0, 0.0, 2.0] is not")
    (found,) = check_settings(Settings(robot=RobotSettings(keep_outs=boxes[:1] * 9)))
    assert str(found) == "robot.keep_outs: 9 are too many; allowed are 8"


def test_no_item_is_cut_in_the_middle():
    assert shown([1, 2.5, "x", True]) == "[1, 2.5, 'x', true]"
    assert shown([1, 2, 3, 4, 5]) == "[1, 2, 3, 4, …]"
    assert shown([-1.2534567890123e-05] * 4) == ("[-1.2534567890123e-05, -1.2534567890123e-05, …]")
    assert shown([[1, 2], {"x": 1}]) == "[[…], a table]"
    assert shown({"x": "long" * 40}) == "a table"
