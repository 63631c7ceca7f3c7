"""The page on settings has every key, from the same source as the application."""

from pathlib import Path

from gestureapp.settings_edit import N_BACKUPS
from gestureapp.settings_text import default_settings_text
from gestureapp.setup.lock import FIRST_WAIT_S, LONGEST_WAIT_S, OPEN_FOR_S, PIN_DIGITS

PAGE = (Path(__file__).parent.parent / "docs" / "settings.md").read_text(encoding="utf-8")


def test_the_page_has_every_setting_as_the_application_explains_it():
    _, _, block = PAGE.partition("```toml\n")
    hint = "put the output of `gestureapp config defaults` into docs/settings.md"
    assert block.removesuffix("```\n") == default_settings_text(), hint


def test_the_page_has_the_figures_of_the_pin_and_the_backups():
    words = " ".join(PAGE.split())
    assert f"a PIN of {PIN_DIGITS[0]} to {PIN_DIGITS[1]} digits" in words
    assert (OPEN_FOR_S, N_BACKUPS) == (600, 10)
    assert "it holds for ten minutes" in words
    assert "the last ten." in words
    assert f"of {FIRST_WAIT_S:g} s at first and twice as long each time" in words
    assert f"up to {LONGEST_WAIT_S / 60:g} minutes" in words
