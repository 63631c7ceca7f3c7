"""The settings of guided training: checked, and nothing that stops a start."""

from pathlib import Path

import pytest

from gestureapp.config import Settings, TrainingSettings
from gestureapp.settings_file import load_settings


def load(tmp_path: Path, text: str):
    file = tmp_path / "settings.toml"
    file.write_text(f"schema = 1\n[training]\n{text}\n")
    return load_settings([file])


def test_they_are_read(tmp_path: Path):
    settings, found = load(tmp_path, "n_takes = 12\nbeat_s = 2.0")
    assert settings.training == TrainingSettings(n_takes=12, beat_s=2.0)
    assert found == []


@pytest.mark.parametrize(
    ("line", "allowed"),
    [
        ("n_takes = 4", "5 to 200"),
        ("n_takes = 201", "5 to 200"),
        ("beat_s = 1.0", "1.1 to 5"),
        ("beat_s = 5.1", "1.1 to 5"),
        ("n_takes = 7.5", "a whole number"),
        ("beats = 3", "unknown (did you mean beat_s?)"),
    ],
)
def test_what_is_wrong_is_told_and_the_built_in_value_holds(tmp_path: Path, line, allowed):
    settings, found = load(tmp_path, line)
    assert settings == Settings()
    (finding,) = found
    assert allowed in str(finding)
    assert finding.line == 3
    assert not finding.is_refused
