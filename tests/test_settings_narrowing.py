"""A later layer narrows what limits motion; no combination of layers ends wider than the site's."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gestureapp.config import DriveMode, Settings
from gestureapp.settings_check import bears_on_motion, check_settings, named_values
from gestureapp.settings_edit import edited
from gestureapp.settings_file import read_settings, settings_text
from gestureapp.settings_narrowing import FREE_OF_BUILT_IN, NARROWER, NO_LIMITS
from tests.made_settings import ALLOWED, values


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


def test_whatever_bears_on_motion_has_a_narrower_side_or_a_reason_why_not():
    names = {name for name, _, _ in named_values(Settings()) if bears_on_motion(name)}
    assert names == set(NARROWER) | set(NO_LIMITS)
    assert not set(NARROWER) & set(NO_LIMITS)
    assert set(FREE_OF_BUILT_IN) <= set(NARROWER)


@settings(max_examples=50, deadline=None)
@given(site=ALLOWED, user=ALLOWED)
def test_a_user_file_never_widens_what_the_site_allows(tmp_path_factory, site, user):
    folder = tmp_path_factory.getbasetemp()
    (folder / "s.toml").write_text(settings_text(site), encoding="utf-8")
    (folder / "u.toml").write_text(settings_text(user), encoding="utf-8")
    loaded, found = read_settings([folder / "s.toml", folder / "u.toml"])
    assert check_settings(loaded, site) == []
    assert loaded.robot.speed_mm_s == min(site.robot.speed_mm_s, user.robot.speed_mm_s)
    assert loaded.site.trip_level_s == min(site.site.trip_level_s, user.site.trip_level_s)
    widened = {finding.setting for finding in check_settings(user, site)}
    assert widened <= {finding.setting for finding in found}


def _some_of_a_file():
    """Some keys with values of their kind, allowed by themselves or not."""
    made = {
        name: values(owner, name.partition(".")[2], value)
        for name, owner, value in named_values(Settings())
        if name in NARROWER or name in NO_LIMITS
    }
    wild = {"robot.speed_mm_s": st.floats(-10, 400), "site.trip_level_s": st.floats(-1, 1)}
    return st.fixed_dictionaries({}, optional=made | wild)


@settings(max_examples=100, deadline=None)
@given(layers=st.lists(_some_of_a_file(), min_size=3, max_size=3))
def test_no_combination_of_layers_ends_wider_than_the_sites(tmp_path_factory, layers):
    folder = tmp_path_factory.getbasetemp()
    files = [folder / f"layer-{i}.toml" for i in range(3)]
    for file, changes in zip(files, layers, strict=True):
        file.write_bytes(edited(file, None, changes))
    by_site, _ = read_settings(files[:1])
    by_user, _ = read_settings(files[:2])
    loaded, _ = read_settings(files[:2], files[2])
    for limits in (by_site, by_user):
        # A mode that nobody below has chosen is free; see the test of drive modes.
        free = {name for name in FREE_OF_BUILT_IN if limits == by_user or name not in layers[0]}
        assert {one.setting for one in check_settings(loaded, limits)} <= free


def test_the_drive_mode_is_free_until_the_site_has_chosen(layer):
    site, user = layer(_site("")), layer(_site('[site]\ndrive_mode = "start_stop"'), "user.toml")
    assert read_settings([site, user])[0].site.drive_mode is DriveMode.START_STOP
    site = layer(_site('[site]\ndrive_mode = "hold_to_run"'))
    loaded, (found,) = read_settings([site, user])
    assert loaded.site.drive_mode is DriveMode.HOLD_TO_RUN
    assert "'start_stop' is wider than the site allows; allowed is nothing but" in found.text
    site = layer(_site('[site]\ndrive_mode = "start_stop"'))
    user = layer(_site('[site]\ndrive_mode = "hold_to_run"'), "user.toml")
    loaded, found = read_settings([site, user])
    assert (loaded.site.drive_mode, found) == (DriveMode.HOLD_TO_RUN, [])


@pytest.mark.parametrize(
    ("table", "name", "site", "wider", "narrower"),
    [
        ("site", "trip_level_s", "0.15", "0.16", "0.14"),
        ("site", "control_limit_s", "0.3", "0.31", "0.29"),
        ("site", "gui_limit_s", "0.6", "0.61", "0.59"),
        ("site", "stop_on_right_lost", "true", "false", "true"),
        ("robot", "ext_radius_mm", "1100", "1100.1", "1099.9"),
        ("robot", "int_radius_mm", "600", "599.9", "600.1"),
        ("robot", "margin_mm", "30", "29.9", "30.1"),
        ("robot", "margin_deg", "5", "4.9", "5.1"),
        ("robot", "floor_mm", "-200", "-200.1", "-199.9"),
        ("robot", "ceiling_mm", "900", "900.1", "899.9"),
        ("robot", "column_radius_mm", "400", "0", "401"),
        ("robot", "column_top_mm", "700", "699", "701"),
        ("joints", "s_range_deg", "[-90, 90]", "[-91, 90]", "[-90, 89]"),
        ("joints", "u_range_deg", "[-90, 95]", "[-90, 96]", "[-80, 80]"),
        ("joints", "margin_deg", "12", "11", "13"),
        ("joints", "wrist_margin_deg", "12", "11", "13"),
        ("joints", "elbow_margin_deg", "12", "11", "13"),
        ("joints", "shoulder_margin_mm", "120", "119", "121"),
        ("robot", "speed_mm_s", "150", "150.1", "149.9"),
        ("robot", "speed_deg_s", "12", "12.1", "11.9"),
        ("robot", "rx_range_deg", "[130, 230]", "[129, 230]", "[131, 229]"),
        ("robot", "ry_range_deg", "[-30, 30]", "[-30, 31]", "[-30, 30]"),
        ("robot", "rz_range_deg", "[-30, 30]", "[-90, 90]", "[0, 1]"),
    ],
)
def test_a_later_layer_may_narrow_a_motion_limit_and_not_widen_it(
    layer, table, name, site, wider, narrower
):
    base = layer(_site(f"[{table}]\n{name} = {site}"))
    by_site, found = read_settings([base])
    assert found == []
    user = layer(_site(f"[{table}]\n{name} = {wider}"), "user.toml")
    loaded, found = read_settings([base, user])
    assert loaded == by_site
    assert [(one.file, one.setting, one.line) for one in found] == [(user, f"{table}.{name}", 3)]
    assert "wider than the site allows" in found[0].text
    assert read_settings([base], user) == (loaded, found)
    user = layer(_site(f"[{table}]\n{name} = {narrower}"), "user.toml")
    assert read_settings([base, user])[1] == []
    assert f"{table}.{name}" in NARROWER


def test_an_absent_site_file_leaves_the_built_in_limits_to_the_user(layer, tmp_path):
    user = layer(_site("[robot]\nspeed_mm_s = 200"), "user.toml")
    loaded, found = read_settings([tmp_path / "absent.toml", user])
    assert loaded.robot.speed_mm_s == 100.0
    assert "at most 100.0 mm/s" in found[0].text
