"""Settings that are wrong, as a person meets them who starts the application."""

import sys
from pathlib import Path

import pytest

from gestureapp import cli
from gestureapp.running import RunningCell
from tests.cell.conftest import wait_until

LIMITS = "schema = 1\n[robot]\nfloor_mm = 200\nceiling_mm = 100\n"


def test_a_limit_that_is_not_understood_lets_no_window_open(tmp_path: Path, capsys):
    def open_window(_: RunningCell, __: float | None) -> int:
        raise AssertionError("no window without the limits asked for")

    config = tmp_path / "cell.toml"
    config.write_text(LIMITS)
    arguments = ["--config", str(config), "--data-dir", str(tmp_path)]
    assert cli.main(arguments, open_window) == cli.FAILED
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"gestureapp: {config}, line 3: robot.floor_mm: 200.0 must be below")
    config.write_text(LIMITS + "flor_mm = 3\n[left]\nprt = 1\n")
    assert cli.main(arguments, open_window) == cli.FAILED
    lines = capsys.readouterr().err.splitlines()
    assert [line.split(": ")[2] for line in lines[:-1]] == [
        "robot.floor_mm",
        "robot.flor_mm",
        "left.prt",
    ]
    assert lines[-1].startswith("gestureapp: not started: ")


def test_a_refused_start_is_shown_where_there_is_no_terminal(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    shown: list[str] = []
    config = tmp_path / "cell.toml"
    config.write_text(f"{LIMITS}flor_mm = 3\n")

    def start(*more: str) -> int:
        arguments = ["--config", str(config), "--data-dir", str(tmp_path), *more]
        return cli.main(arguments, lambda running, seconds: 0, shown.append)

    assert start() == cli.FAILED
    assert [text.count("\n") for text in shown] == [2]
    assert start("--exit-after", "2") == cli.FAILED
    assert start("evaluate", "absent.json", "absent.npz") == cli.FAILED
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    assert start() == cli.FAILED
    assert len(shown) == 1


def test_what_is_wrong_and_does_not_bear_on_motion_is_told_in_the_window(tmp_path: Path, capsys):
    config = tmp_path / "cell.toml"
    config.write_text("schema = 1\n[left]\nprt = 'COM1'\n")
    told = f"{config}, line 3: left.prt: unknown (did you mean port?); it is left out"

    def open_window(running: RunningCell, _: float | None) -> int:
        def is_told() -> bool:
            events = running.cell.snapshot().events
            return [(event.text, event.is_alarm) for event in events].count((told, False)) == 1

        return 0 if wait_until(is_told) else 5

    arguments = ["--config", str(config), "--data-dir", str(tmp_path)]
    assert cli.main(arguments, open_window) == cli.FINE
    assert capsys.readouterr().err == f"gestureapp: {told}\n"
