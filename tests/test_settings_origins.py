"""Of every value it is told where it comes from; of the PIN, which file has it."""

from pathlib import Path

import pytest

from gestureapp.config import Settings
from gestureapp.settings_check import named_values
from gestureapp.settings_file import DAMAGED_PIN, load_settings, read_layers


@pytest.fixture
def layer(tmp_path: Path):
    def write(text: str, name: str = "site.toml") -> Path:
        path = tmp_path / name
        path.write_text(f"schema = 1\n{text}\n", encoding="utf-8")
        return path

    return write


def test_every_value_has_an_origin(layer):
    names = {name for name, _, _ in named_values(Settings())}
    assert set(read_layers([]).origins) == names
    assert {str(origin) for origin in read_layers([]).origins.values()} == {"built-in"}
    assert set(read_layers([layer("[robot]\ntool = 1")]).origins) == names


def test_the_topmost_layer_that_gave_it_is_named_with_its_line(layer):
    site = layer("[robot]\ntool = 3\nspeed_mm_s = 150\nmargin_mm = 25")
    user = layer("\n[robot]\nspeed_mm_s = 90", "settings.toml")
    named = layer("[robot]\nmargin_mm = 30", "cell.toml")
    origins = read_layers([site, user], named).origins
    assert str(origins["robot.tool"]) == "site.toml, line 3"
    assert str(origins["robot.speed_mm_s"]) == "settings.toml, line 4"
    assert str(origins["robot.margin_mm"]) == "--config cell.toml, line 3"


def test_a_value_that_is_not_used_is_nobodys_origin(layer):
    site = layer("[robot]\nspeed_mm_s = 80\next_radius_mm = 1000")
    user = layer("[robot]\nspeed_mm_s = 90\nint_radius_mm = 999", "settings.toml")
    layers = read_layers([site, user])
    assert len(layers.findings) == 2
    assert str(layers.origins["robot.speed_mm_s"]) == "site.toml, line 3"
    assert str(layers.origins["robot.int_radius_mm"]) == "built-in"
    assert str(layers.origins["robot.ext_radius_mm"]) == "site.toml, line 4"


def test_the_sites_pin_holds_and_another_has_no_effect(layer):
    site = layer("[lock]\npin_hash = 'aaa'")
    user = layer("[lock]\npin_hash = 'bbb'", "settings.toml")
    named = layer("[lock]\npin_hash = 'ccc'", "cell.toml")
    layers = read_layers([site, user], named)
    assert (layers.pin.pin_hash, str(layers.pin.origin)) == ("aaa", "site.toml, line 3")
    assert [finding.line for finding in layers.findings] == [3, 3]
    assert "has no effect here: the PIN is that of the site's" in layers.findings[0].text
    assert read_layers([user.parent / "absent.toml", user]).pin.pin_hash == "bbb"


@pytest.mark.parametrize(
    "wrong", ["[lock]\npin_hash = 5", "[lock]\npin_hash = ''", "lock.pin_hash = []", "lock = 3"]
)
def test_a_pin_that_is_none_counts_as_one_that_nobody_knows(layer, wrong):
    layers = read_layers([layer(wrong)])
    assert layers.pin.pin_hash == DAMAGED_PIN


def test_an_unknown_key_beside_the_pin_is_told_and_stops_nothing(layer):
    settings, (found,) = load_settings([layer("[lock]\npin_hsh = 1")])
    assert settings == Settings()
    assert found.text == "unknown (did you mean pin_hash?); it is left out"
