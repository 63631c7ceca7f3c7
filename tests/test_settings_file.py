"""Settings come from layers of TOML; what is wrong in them is reported and never used."""

from dataclasses import replace

import pytest
from hypothesis import given, settings

from gestureapp.config import (
    DriveMode,
    SensorSettings,
    Settings,
    SiteSettings,
)
from gestureapp.errors import ConfigError
from gestureapp.settings_check import RANGES, named_values
from gestureapp.settings_file import (
    default_settings_text,
    read_settings,
    settings_text,
)
from tests.made_settings import ALLOWED


@pytest.fixture
def layer(tmp_path):
    """Writes a settings file of this name; gives its path."""

    def write(text, name="site.toml"):
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        return path

    return write


def _site(text):
    return f"schema = 1\n{text}\n"


# What comes out when nothing is wrong.


def test_without_files_the_built_in_settings_hold(tmp_path):
    assert read_settings([]) == (Settings(), [])
    assert read_settings([tmp_path / "absent.toml"]) == (Settings(), [])


def test_the_default_text_gives_the_default_settings_back(layer):
    assert read_settings([layer(default_settings_text())]) == (Settings(), [])


def test_the_default_text_explains_every_setting_with_unit_and_range():
    lines = default_settings_text().split("\n")
    for name, owner, _ in named_values(Settings()):
        table, _, setting = name.partition(".")
        start = lines.index(f"[{table}]")
        at = next(i for i in range(start, len(lines)) if lines[i].startswith(f"{setting} = "))
        assert lines[at - 1].startswith("# "), f"{name} has no description"
        if (owner, setting) in RANGES:
            assert "Allowed: " in " ".join(lines[at - 2 : at])
    text = default_settings_text()
    assert "Allowed: 0.05 to" in text
    assert "Allowed: 1 to 250 mm/s." in text
    assert 'One of: "hold_to_run", "start_stop".' in text.replace("\n# ", " ")
    assert all(len(line) <= 100 for line in lines)


def test_later_layers_lie_over_earlier_ones(layer):
    site = layer(_site('[robot]\nhost = "10.0.0.2"\ntool = 3\n[left]\nport = "COM3"'))
    user = layer(_site('[left]\nport = "COM7"\n[person]\nname = "Ada"'), "user.toml")
    loaded, found = read_settings([site, user])
    assert found == []
    assert (loaded.robot.host, loaded.robot.tool) == ("10.0.0.2", 3)
    assert (loaded.left.port, loaded.person.name) == ("COM7", "Ada")
    assert loaded.right == SensorSettings()


def test_every_kind_of_value_is_taken(layer):
    path = layer(
        _site(
            '[site]\ndrive_mode = "start_stop"\nstop_on_right_lost = false\nposture_debounce = 5\n'
            'trip_level_s = 0.2\n[left]\nname = "blue"\n[robot]\ntool_mm = [0, -0.5, 25]\n'
            "speed_mm_s = 50\n"
            'rx_range_deg = [90, 270.5]\n[person]\nmodel = "ada.json"'
        )
    )
    loaded, found = read_settings([path])
    assert found == []
    assert loaded.site == replace(
        SiteSettings(),
        drive_mode=DriveMode.START_STOP,
        stop_on_right_lost=False,
        posture_debounce=5,
        trip_level_s=0.2,
    )
    assert (loaded.left.name, loaded.robot.tool_mm) == ("blue", (0.0, -0.5, 25.0))
    assert isinstance(loaded.robot.speed_mm_s, float)
    assert loaded.robot.rx_range_deg == (90.0, 270.5)
    assert loaded.person.model == path.parent / "ada.json"


def test_the_file_named_by_hand_is_the_top_layer(layer):
    site = layer(_site("[robot]\ntool = 3\nframe = 0"))
    named = layer(_site("[robot]\ntool = 4"), "mine.toml")
    loaded, found = read_settings([site], named)
    assert found == []
    assert (loaded.robot.tool, loaded.robot.frame) == (4, 0)


def test_a_byte_order_mark_and_windows_lines_are_read(tmp_path):
    path = tmp_path / "site.toml"
    path.write_bytes(b"\xef\xbb\xbfschema = 1\r\n[robot]\r\ntool = 3\r\ntoool = 4\r\n")
    loaded, found = read_settings([path])
    assert loaded.robot.tool == 3
    assert [(finding.setting, finding.line) for finding in found] == [("robot.toool", 4)]


@settings(max_examples=50, deadline=None)
@given(made=ALLOWED)
def test_any_allowed_settings_survive_being_written_and_read(tmp_path_factory, made):
    path = tmp_path_factory.getbasetemp() / "any.toml"
    path.write_text(settings_text(made), encoding="utf-8")
    assert read_settings([path]) == (made, [])


# What is wrong in a file.


@pytest.mark.parametrize(
    ("table", "name", "low", "high", "step"),
    [
        ("site", "trip_level_s", 0.05, 0.3, 0.001),
        ("site", "control_limit_s", 0.1, 0.5, 0.001),
        ("site", "gui_limit_s", 0.2, 1.0, 0.001),
        ("site", "posture_debounce", 1, 20, 1),
        ("robot", "speed_mm_s", 1.0, 250.0, 0.1),
        ("robot", "speed_deg_s", 0.5, 30.0, 0.1),
        ("robot", "margin_mm", 1.0, 200.0, 0.1),
        ("robot", "port", 1, 65535, 1),
        ("robot", "tool", 0, 23, 1),
        ("robot", "frame", 0, 1, 1),
    ],
)
def test_limits_are_allowed_and_what_lies_beyond_is_not(layer, table, name, low, high, step):
    for value in (low, high):
        loaded, found = read_settings([layer(_site(f"[{table}]\n{name} = {value}"))])
        assert found == []
        assert getattr(getattr(loaded, table), name) == value
    for value in (low - step, high + step):
        loaded, found = read_settings([layer(_site(f"[{table}]\n{name} = {value}"))])
        assert loaded == Settings()
        assert [(one.setting, one.line) for one in found] == [(f"{table}.{name}", 3)]
        assert f"allowed is {low:g} to {high:g}" in found[0].text


@pytest.mark.parametrize(
    ("setting", "words"),
    [
        ("[robot]\nspeed_mm_s = 'fast'", "allowed is a number"),
        ("[robot]\nspeed_mm_s = true", "allowed is a number"),
        ("[robot]\nspeed_mm_s = nan", "allowed is a finite number"),
        ("[robot]\nspeed_mm_s = inf", "allowed is a finite number"),
        ("[robot]\nspeed_mm_s = 1" + "0" * 400, "allowed is a finite number"),
        ("[robot]\nspeed_mm_s = 1979-05-27", "allowed is a number"),
        ("[robot]\ntool = 1.0", "allowed is a whole number"),
        ("[robot]\ntool = true", "allowed is a whole number"),
        ("[robot]\nhost = 5", "allowed is a text in quotes"),
        ("[robot]\nhost = 'robot.cell'", "give the controller's IP address"),
        ("[robot]\nhost.name = 'x'", "allowed is a text in quotes"),
        ("[site]\nstop_on_right_lost = 1", "allowed is true or false"),
        ("[site]\ndrive_mode = 'fly'", 'allowed is "hold_to_run" or "start_stop"'),
        ("[robot]\ntool_mm = [0, 0]", "allowed is a list of 3 numbers"),
        ("[robot]\ntool_mm = [0, 0, 'x']", "allowed is a number"),
        ("[robot]\nyaw_deg = 45", "allowed is 0, 90, 180 or -90 deg"),
        ("[robot]\ntool_mm = 1.0", "allowed is a list of 3 numbers"),
        ("[robot]\nrx_range_deg = [90, 90]", "first number must be below the second"),
        ("[person]\nmodel = 5", "the name of a file"),
    ],
)
def test_a_wrong_value_is_reported_with_its_line_and_not_used(layer, setting, words):
    path = layer(_site(setting))
    loaded, found = read_settings([path])
    assert loaded == Settings()
    assert len(found) == 1
    assert words in found[0].text
    assert "is used" in found[0].text
    assert (found[0].file, found[0].line) == (path, 3)
    assert str(found[0]).startswith(f"{path}, line 3: ")
    assert "\n" not in str(found[0])
    assert len(found[0].text) < 250


def test_a_wrong_value_of_the_user_keeps_the_sites(layer):
    site = layer(_site("[robot]\nspeed_mm_s = 50"))
    user = layer(_site("[robot]\nspeed_mm_s = 'x'"), "user.toml")
    loaded, found = read_settings([site, user])
    assert loaded.robot.speed_mm_s == 50.0
    assert found[0].text.endswith("50.0 is used")


@pytest.mark.parametrize(
    ("text", "setting", "line", "words"),
    [
        ("[robot]\nhost = ''\nsped_mm_s = 1", "robot.sped_mm_s", 4, "did you mean speed_mm_s?"),
        ("[robbot]\ntool = 1", "robbot", 2, "did you mean robot?"),
        ("speed = 1", "speed", 2, "unknown"),
        ("\n# c\n[site]\nzzz = '''\n\n'''\nyyyy = 1", "site.yyyy", 8, "unknown"),
        ("[left]\nport = ''\n[left.sub]\nx = 1", "left.sub", 4, "unknown"),
        ("left.prt = 'COM1'", "left.prt", 2, "did you mean port?"),
        ("left = { prt = 'COM1' }", "left.prt", 2, "did you mean port?"),
        ("left = 5", "left", 2, "must be a table"),
        ("[[left]]\nport = 'x'", "left", 2, "must be a table"),
        ('["left"]\n"p rt" = 1', "left.p rt", 3, "unknown"),
        ("is_simulation = true", "is_simulation", 2, "unknown"),
        ("[robot]\nlist = [\n 1,\n 2,\n]\ntol = 1", "robot.tol", 7, "did you mean tool?"),
    ],
)
def test_an_unknown_key_is_reported_with_its_line(layer, text, setting, line, words):
    loaded, found = read_settings([layer(_site(text))])
    assert loaded == Settings()
    by_name = {finding.setting: finding for finding in found}
    assert by_name[setting].line == line
    assert words in by_name[setting].text


def test_every_wrong_thing_is_reported_at_once(layer):
    path = layer(_site("[robot]\ntool = 99\nport = 0\n[site]\nx = 1\n[left]\nport = 3"))
    _, found = read_settings([path])
    assert [(one.setting, one.line) for one in found] == [
        ("robot.tool", 3),
        ("robot.port", 4),
        ("site.x", 6),
        ("left.port", 8),
    ]


@pytest.mark.parametrize(
    ("text", "setting", "line"),
    [
        ("[robot]\nint_radius_mm = 1300", "robot.int_radius_mm", 3),
        ("[robot]\next_radius_mm = 400", "robot.ext_radius_mm", 3),
        ("[robot]\next_radius_mm = 600\nint_radius_mm = 600", "robot.int_radius_mm", 4),
        ("[site]\nposture_enter_deg = 40", "site.posture_enter_deg", 3),
        ("[site]\nrate_max_hz = 50", "site.rate_max_hz", 3),
        ("[robot]\nfloor_mm = 1000", "robot.floor_mm", 3),
    ],
)
def test_two_values_that_do_not_fit_leave_those_below(layer, text, setting, line):
    loaded, found = read_settings([layer(_site(text))])
    assert loaded == Settings()
    assert [(one.setting, one.line) for one in found] == [(setting, line)]
    assert "must be below" in found[0].text


def test_a_missing_schema_is_reported_and_taken_as_ours(layer):
    loaded, found = read_settings([layer("[robot]\ntool = 2\n")])
    assert loaded.robot.tool == 2
    assert [one.setting for one in found] == ["schema"]
    assert "schema = 1" in found[0].text


@pytest.mark.parametrize(
    ("port", "words"),
    [
        (r"/dev/\u0000a", "has characters that cannot be printed; take them out"),
        ("/dev/" + "a" * 300, "is too long; allowed are 200 characters"),
    ],
)
def test_a_port_that_no_system_can_open_is_one_line_and_not_used(layer, port, words):
    file = layer(_site(f'[left]\nport = "{port}"'))
    loaded, (finding,) = read_settings([file])
    assert loaded.left.port == ""
    assert (finding.setting, finding.line, finding.is_refused) == ("left.port", 3, False)
    assert words in finding.text


@pytest.mark.parametrize("digits", ["9" * 400, "-" + "9" * 400, "0x" + "f" * 9000])
@pytest.mark.parametrize(
    "name",
    [
        "site.posture_debounce",
        "site.calibration_days",
        "robot.yaw_deg",
        "robot.speed_mm_s",
        "robot.supervision_input",
        "robot.keep_outs",
        "left.port",
        "training.n_takes",
        "new.name",
    ],
)
def test_a_number_of_hundreds_of_digits_is_one_line(layer, name, digits):
    table, _, key = name.partition(".")
    loaded, (finding,) = read_settings([layer(_site(f"[{table}]\n{key} = {digits}"))])
    assert loaded == Settings()
    assert finding.line in (2, 3)
    assert len(str(finding)) < 400
    assert "\n" not in str(finding)


def test_a_schema_of_hundreds_of_digits_is_one_line(layer):
    with pytest.raises(ConfigError, match="this application reads schema 1"):
        read_settings([layer("schema = 0x" + "f" * 9000)])
