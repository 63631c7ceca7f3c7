"""``gestureapp config``: settings in a terminal, without a window."""

import json
from pathlib import Path

import pytest

from gestureapp import cli
from gestureapp.config import Settings
from gestureapp.settings_check import named_values
from gestureapp.settings_text import default_settings_text


@pytest.fixture
def user(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Where the user's settings file is; not there yet."""
    monkeypatch.setenv("XDG_CONFIG_DIRS", str(tmp_path / "etc"))
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "home"))
    folder = tmp_path / "home" / "gestureapp"
    folder.mkdir(parents=True)
    return folder / "settings.toml"


def test_show_prints_every_value_with_unit_range_and_origin(user: Path, tmp_path: Path, capsys):
    user.write_text("schema = 1\n[robot]\nspeed_mm_s = 80\n[left]\nprt = 1\n")
    named = tmp_path / "cell.toml"
    named.write_text("schema = 1\n[robot]\ntool = 3\n")
    assert cli.main(["config", "show", "--config", str(named)]) == cli.FINE
    lines = capsys.readouterr().out.splitlines()
    of = {line.split()[0]: line for line in lines if line}
    assert {name for name, _, _ in named_values(Settings())} <= set(of)
    assert of["robot.speed_mm_s"].endswith(" 1 to 250")
    assert " 80.0 mm/s " in of["robot.speed_mm_s"]
    assert " settings.toml, line 3 " in of["robot.speed_mm_s"]
    assert " --config cell.toml, line 3 " in of["robot.tool"]
    assert " built-in " in of["robot.margin_mm"]
    assert lines[-1].startswith(f"{user}, line 5: left.prt: unknown")


def test_show_as_json_says_the_same(user: Path, capsys):
    user.write_text(
        "schema = 1\n[robot]\nspeed_mm_s = 80\nspede = 1\n[lock]\npin_hash = 'secret'\n"
    )
    assert cli.main(["config", "show", "--json"]) == cli.FINE
    out = capsys.readouterr().out
    told = json.loads(out)
    speed = next(one for one in told["settings"] if one["name"] == "robot.speed_mm_s")
    assert speed == {
        "name": "robot.speed_mm_s",
        "value": 80.0,
        "unit": "mm/s",
        "allowed": "1 to 250",
        "origin": "settings.toml, line 3",
        "file": str(user),
        "line": 3,
    }
    (finding,) = told["findings"]
    assert (finding["setting"], finding["line"], finding["stops_the_start"]) == (
        "robot.spede",
        4,
        True,
    )
    assert "secret" not in out


def test_check_fails_when_anything_is_wrong_and_says_what(user: Path, capsys):
    assert cli.main(["config", "check"]) == cli.FINE
    assert capsys.readouterr().out == "nothing is wrong\n"
    user.write_text("schema = 1\n[robot]\nspeed_mm_s = 300\n")
    assert cli.main(["config", "check"]) == cli.FAILED
    assert capsys.readouterr().out.startswith(f"{user}, line 3: robot.speed_mm_s: 300")
    user.write_text("schema = 1\n[joints]\ns_range_deg = [0, 1]\n")
    assert cli.main(["config", "check"]) == cli.FAILED
    assert "a range of a joint must be wider than its margins" in capsys.readouterr().out
    user.write_text("schema = \n")
    assert cli.main(["config", "check"]) == cli.FAILED
    assert "line 1: not TOML" in capsys.readouterr().err


def test_path_says_which_files_there_are(user: Path, tmp_path: Path, capsys):
    user.write_text("schema = 1\n")
    assert cli.main(["config", "path"]) == cli.FINE
    site = tmp_path / "etc" / "gestureapp" / "site.toml"
    lines = [line.split(maxsplit=1) for line in capsys.readouterr().out.splitlines()]
    assert lines == [["site", f"not there  {site}"], ["user", f"there      {user}"]]


def test_the_file_named_before_the_command_holds_as_well(user: Path, tmp_path: Path, capsys):
    named = tmp_path / "cell.toml"
    named.write_text("schema = 1\n[robot]\ntool = 3\n")
    arguments = ["--config", str(named), "config", "path"]
    assert cli.main(arguments, lambda running, seconds: 0) == cli.FINE
    assert capsys.readouterr().out.splitlines()[-1].split() == ["--config", "there", str(named)]


def test_the_built_in_settings_can_be_had_as_a_file(capsys):
    assert cli.main(["config", "defaults"]) == cli.FINE
    assert capsys.readouterr().out == default_settings_text()


def test_a_number_of_hundreds_of_digits_is_shown_as_one_finding(user: Path, capsys):
    user.write_text(f"schema = 1\n[site]\ncalibration_days = {'9' * 400}\n")
    assert cli.main(["config", "show"]) == cli.FINE
    heard = capsys.readouterr()
    assert heard.err == ""
    last = heard.out.splitlines()[-1]
    assert last.startswith(f"{user}, line 3: site.calibration_days: 999")
    assert "… is not allowed; allowed is 1 to 730 days" in last
