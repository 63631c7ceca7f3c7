"""Files of takes that are not as they should be, as a person at the command line meets them."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from gestureapp import cli
from gestureapp.recognition.takes import save_takes
from gestureapp.simulation.demo import MODEL
from gestureapp.simulation.takes import make_takes

Run = Callable[..., tuple[int, str, list[str]]]


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str]) -> Run:
    """Runs a command in this process; gives exit code, output and the lines of error output."""

    def run_command(*arguments: object) -> tuple[int, str, list[str]]:
        code = cli.main([str(argument) for argument in arguments])
        heard = capsys.readouterr()
        return code, heard.out, heard.err.splitlines()

    return run_command


@pytest.mark.parametrize("preset", ["default", "paper"])
def test_a_gesture_called_none_is_refused_with_its_file_before_the_training(
    run: Run, tmp_path: Path, preset: str
):
    path = tmp_path / "named.npz"
    made = make_takes(1, 5, 7, gestures=("X+", "Y-"))
    save_takes(path, replace(made, labels=("wave",) * 5 + ("none",) * 5))

    code, _, (line,) = run("train", path, "-o", tmp_path / "m.json", "--preset", preset)

    assert code == cli.FAILED
    assert line.startswith(f"gestureapp: {path}: holds takes of a gesture called 'none'")
    assert "rename it" in line


def test_takes_in_another_unit_are_refused_by_all_commands_with_the_remedy(
    run: Run, tmp_path: Path
):
    path, made = tmp_path / "ms2.npz", make_takes(1, 2, 7)
    save_takes(path, replace(made, samples=made.samples * 9.80665))

    for arguments in (
        ("train", path, "-o", tmp_path / "m.json"),
        ("evaluate", MODEL, path),
        ("benchmark", "recognition", "--takes", path),
    ):
        code, out, (line,) = run(*arguments)
        assert (code, out) == (cli.FAILED, "")
        assert "m/s2; divide them by 9.80665" in line


def test_a_model_of_the_papers_kind_is_said_to_be_for_another_rate(run: Run, tmp_path: Path):
    model, paths = tmp_path / "m.json", {}
    for rate_hz in (50.0, 100.0):
        paths[rate_hz] = tmp_path / f"{rate_hz:g}.npz"
        save_takes(paths[rate_hz], make_takes(1, 5, 7, rate_hz=rate_hz, gestures=("X+", "Y-")))
    assert run("train", paths[50.0], "-o", model, "--preset", "small")[0] == cli.FINE

    assert run("evaluate", model, paths[50.0])[2] == []
    code, out, (line,) = run("evaluate", model, paths[100.0])

    assert (code, out.startswith("Gesture")) == (cli.FINE, True)
    assert line.startswith(f"gestureapp: {model}: the model was trained at 50 Hz")
    assert "these takes are at 100 Hz" in line


def test_a_model_that_follows_the_movement_is_for_any_rate(run: Run, tmp_path: Path):
    path = tmp_path / "200.npz"
    save_takes(path, make_takes(1, 2, 7, rate_hz=200.0))

    assert run("evaluate", MODEL, path)[2] == []
