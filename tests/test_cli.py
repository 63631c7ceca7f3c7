"""The command line as a person and a script meet it: exit codes, one line, no traceback."""

import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from gestureapp import cli
from gestureapp.children import child_command, child_environment
from gestureapp.recognition.takes import load_takes
from gestureapp.running import RunningCell
from gestureapp.simulation.demo import MODEL

LIMIT_S = 30.0
Run = Callable[..., tuple[int, str, str]]


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str]) -> Run:
    """Runs a command in this process; gives exit code, output and error output."""

    def run_command(*arguments: object) -> tuple[int, str, str]:
        try:
            code = cli.main([str(argument) for argument in arguments])
        except SystemExit as end:
            code = int(end.code or 0)
        heard = capsys.readouterr()
        return code, heard.out, heard.err

    return run_command


@pytest.fixture(scope="module")
def takes(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("takes") / "takes.npz"
    command = ["simulate", "takes", str(path), "--takes", "5", "--seed", "7", "--practised"]
    assert cli.main(command) == cli.FINE
    return path


def one_line(err: str) -> str:
    """The one line of an error, which names the program and has no traceback."""
    (line,) = err.splitlines()
    assert line.startswith("gestureapp: ")
    assert "Traceback" not in line
    return line


def test_takes_of_some_gestures_at_another_rate_are_made(run: Run, tmp_path: Path):
    path = tmp_path / "some.npz"
    asked = ("--gestures", "RZ-,X+", "--rate-hz", "50", "--takes", "2")
    code, _, err = run("simulate", "takes", path, *asked)
    assert (code, err) == (cli.FINE, "")
    takes = load_takes(path)
    assert takes.labels == ("RZ-", "RZ-", "X+", "X+")
    assert (takes.rate_hz, len(takes.samples)) == (50.0, 4 * 75)


def test_takes_are_trained_and_evaluated(run: Run, takes: Path, tmp_path: Path):
    model = tmp_path / "model.json"
    code, out, err = run("train", takes, "-o", model)
    assert (code, err) == (cli.FINE, "")
    assert "60 takes" in out
    code, out, err = run("evaluate", model, takes)
    assert (code, err) == (cli.FINE, "")
    assert out.splitlines()[0].split() == ["Gesture", "recognised", "wrong", "rejected"]
    assert [line.split()[0] for line in out.splitlines()[1:13]][:2] == ["X+", "X-"]


def test_the_json_forms_are_one_object(run: Run, takes: Path, tmp_path: Path):
    model = tmp_path / "model.json"
    code, out, _ = run("train", takes, "-o", model, "--json", "--seed", "3")
    trained = json.loads(out)
    assert (code, trained["model"]) == (cli.FINE, str(model))
    assert trained["training"]["n_takes"] == 60
    assert trained["cross_validation"]["n"] == 60
    assert trained["cross_validation"]["folds"].startswith("by time: 5 blocks")
    assert trained["left_out"] == 0
    assert len(trained["labels"]) == 12
    code, out, _ = run("evaluate", model, takes, "--json")
    evaluated = json.loads(out)
    assert (code, evaluated["n"]) == (cli.FINE, 60)
    assert sum(map(sum, evaluated["confusion"])) == 60
    assert [len(row) for row in evaluated["confusion"]] == [13] * 12
    shares = [evaluated[name] for name in ("recognised", "wrong", "rejected")]
    assert sum(shares) == pytest.approx(1.0)
    assert set(evaluated["per_gesture"]) == set(evaluated["labels"])
    assert 0.0 < evaluated["decision_ms"]["median"] <= evaluated["decision_ms"]["p95"] < 250.0


@pytest.mark.parametrize("labels", [("up", "down"), ("a", "b", "c", "d")])
def test_other_gestures_at_another_rate_with_short_takes_are_trained_and_what_is_short_is_said(
    run: Run, tmp_path: Path, labels: tuple[str, ...]
):
    rng = np.random.default_rng(4)
    parts, names = [], []
    for k, label in enumerate(labels):
        for number in range(8):
            parts.append(rng.normal([0.0, 0.0, 1.0], 0.03, (3 + 4 * number, 3)))
            parts[-1][:, k % 3] += 1.0 if k < 3 else -1.0
            names.append(label)
    parts.append(np.ones((2, 3)))
    path, model = tmp_path / "takes.npz", tmp_path / "model.json"
    np.savez(
        path,
        samples=np.concatenate(parts),
        offsets=np.cumsum([0, *map(len, parts)]),
        labels=np.array([*names, labels[0]]),
        rate_hz=np.array(50.0),
    )

    code, out, err = run("train", path, "-o", model, "--json")
    assert code == cli.FINE
    assert "1 take ends before the third sample" in one_line(err)
    assert (json.loads(out)["left_out"], json.loads(out)["labels"]) == (1, sorted(labels))
    code, out, err = run("evaluate", model, path, "--json")
    assert code == cli.FINE
    assert "1 take ends before the third sample" in one_line(err)
    assert json.loads(out)["recognised"] > 0.9


def test_takes_that_cannot_be_divided_as_asked_are_one_line(run: Run, takes: Path, tmp_path: Path):
    code, _, err = run("train", takes, "-o", tmp_path / "m.json", "--folds", "session")
    assert code == cli.FAILED
    assert "all takes have the same session; divide by time" in one_line(err)


def test_the_shipped_model_is_evaluated_on_a_fresh_day(run: Run, tmp_path: Path):
    path = tmp_path / "fresh.npz"
    run("simulate", "takes", path, "--takes", "5", "--seed", "7", "--session", "3", "--practised")
    code, out, _ = run("evaluate", MODEL, path, "--json")
    assert code == cli.FINE
    confusion = json.loads(out)["confusion"]
    assert sum(row[i] for i, row in enumerate(confusion)) >= 57


@pytest.fixture
def damaged(tmp_path: Path, takes: Path) -> dict[str, Path]:
    files = {
        "missing": tmp_path / "missing",
        "folder": tmp_path,
        "empty": tmp_path / "empty",
        "rubbish": tmp_path / "rubbish",
        "cut takes": tmp_path / "cut.npz",
        "cut model": tmp_path / "cut.json",
        "another json": tmp_path / "another.json",
    }
    files["empty"].write_bytes(b"")
    files["rubbish"].write_bytes(bytes(range(256)) * 20)
    files["cut takes"].write_bytes(takes.read_bytes()[:3000])
    files["cut model"].write_bytes(MODEL.read_bytes()[:1500])
    files["another json"].write_text('{"a": [1, 2, {"b": null}]}')
    return files


KINDS = ["missing", "folder", "empty", "rubbish", "cut takes", "cut model", "another json"]


@pytest.mark.parametrize("kind", KINDS)
def test_takes_that_cannot_be_read_are_one_line(
    run: Run, damaged: dict[str, Path], tmp_path: Path, kind: str
):
    for arguments in (
        ("train", damaged[kind], "-o", tmp_path / "new.json"),
        ("evaluate", MODEL, damaged[kind]),
    ):
        code, out, err = run(*arguments)
        assert (code, out) == (cli.FAILED, "")
        assert str(damaged[kind]) in one_line(err)
    assert not (tmp_path / "new.json").exists()


@pytest.mark.parametrize("kind", KINDS)
def test_a_model_that_cannot_be_read_is_one_line(
    run: Run, damaged: dict[str, Path], takes: Path, kind: str
):
    code, out, err = run("evaluate", damaged[kind], takes)
    assert (code, out) == (cli.FAILED, "")
    assert str(damaged[kind]) in one_line(err)


def test_where_a_model_is_to_go_is_looked_at_before_the_training(
    run: Run, takes: Path, tmp_path: Path
):
    for out in (tmp_path, tmp_path / "nowhere" / "model.json"):
        code, _, err = run("train", takes, "-o", out, "--preset", "paper")
        assert code == cli.FAILED
        assert "name one in a folder that exists" in one_line(err)


@pytest.mark.parametrize(
    "arguments",
    [
        ("simulate", "takes", "OUT.npz", "--people", "0"),
        ("simulate", "takes", "OUT.npz", "--takes", "-1"),
        ("train", "x.npz"),
        ("train", "x.npz", "-o", "y.json", "--seed", "-1"),
        ("train", "x.npz", "-o", "y.json", "--seed", "99999999999"),
        ("train", "x.npz", "-o", "y.json", "--preset", "best"),
        ("train", "x.npz", "-o", "y.json", "--folds", "luck"),
        ("evaluate", "x.json"),
        ("simulate", "sensor", "--arm", "third", "--port", "0"),
        ("simulate", "sensor", "--arm", "left", "--port", "many"),
        ("simulate", "nx100", "--segments", "none"),
        ("benchmark", "stop", "--seconds", "soon"),
        ("benchmark", "stop", "--seconds", "-1"),
        ("benchmark", "stop", "--seconds", "nan"),
        ("fly",),
        (),
    ],
    ids=" ".join,
)
def test_wrong_usage_is_2_and_says_what_is_wrong(run: Run, arguments: tuple[str, ...]):
    code, out, err = run(*arguments)
    assert (code, out) == (cli.USAGE, "")
    assert "Traceback" not in err
    assert err.splitlines()[-1].startswith("gestureapp")


@pytest.mark.parametrize(
    "arguments",
    [
        ("simulate", "takes", "/nowhere/out.npz"),
        ("simulate", "sensor", "--arm", "left", "--port", "70000"),
        ("simulate", "sensor", "--arm", "left", "--port", "0", "--protocol", "x-io"),
        ("simulate", "sensor", "--arm", "left", "--port", "0", "--rate-hz", "nan"),
        ("simulate", "sensor", "--arm", "left", "--port", "0", "--seed", "-1"),
        ("simulate", "nx100", "--port", "0", "--log", "/nowhere/log"),
    ],
    ids=" ".join,
)
def test_what_cannot_be_done_is_1_and_one_line(run: Run, arguments: tuple[str, ...]):
    code, out, err = run(*arguments)
    assert (code, out) == (cli.FAILED, "")
    one_line(err)


def test_without_torch_training_names_it_and_the_remedy(
    run: Run, takes: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setitem(sys.modules, "torch", None)
    code, _, err = run("train", takes, "-o", tmp_path / "model.json")
    assert code == cli.FAILED
    assert "gestureapp[training]" in one_line(err)


def test_the_application_says_which_settings_file_is_missing(tmp_path: Path, capsys):
    def open_window(_: RunningCell, __: float | None) -> int:
        raise AssertionError("no window without settings")

    missing = tmp_path / "site.toml"
    code = cli.main(["--config", str(missing), "--data-dir", str(tmp_path)], open_window)
    assert code == cli.FAILED
    assert str(missing) in one_line(capsys.readouterr().err)


def test_a_data_folder_that_is_a_file_is_one_line(tmp_path: Path, capsys):
    place = tmp_path / "file"
    place.write_text("")
    code = cli.main(["--data-dir", str(place)], lambda running, seconds: 0)
    assert code == cli.FAILED
    assert "--data-dir" in one_line(capsys.readouterr().err)


def test_the_windows_exit_code_is_the_programs(tmp_path: Path):
    seen: list[float | None] = []

    def open_window(running: RunningCell, seconds: float | None) -> int:
        assert running.operator is None
        assert running.cell.snapshot().state.value == "NOT READY"
        seen.append(seconds)
        return 7

    arguments = ["--data-dir", str(tmp_path), "--exit-after", "2.5"]
    assert cli.main(arguments, open_window) == 7
    assert seen == [2.5]


def start(*arguments: str) -> subprocess.Popen[str]:
    pipe = subprocess.PIPE
    return subprocess.Popen(
        child_command(*arguments),
        stdin=pipe,
        stdout=pipe,
        stderr=pipe,
        text=True,
        env=child_environment(),
    )


@pytest.mark.process
@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("nx100", "--port", "0", "--control-port", "0"), ["control on", "listening on"]),
        (("nx100", "--port", "0"), ["listening on"]),
        (
            ("sensor", "--arm", "left", "--port", "0", "--control-port", "0"),
            ["control on", "listening on"],
        ),
        (("sensor", "--arm", "right", "--port", "0", "--protocol", "adxl330"), ["listening on"]),
    ],
    ids=lambda value: " ".join(value),
)
def test_an_emulator_prints_where_it_listens_and_ends_with_its_input(
    arguments: tuple[str, ...], words: list[str]
):
    with start("simulate", *arguments, "--exit-with-stdin") as process:
        assert process.stdout is not None
        lines = [process.stdout.readline() for _ in words]
        assert [line.rsplit(" ", 1)[0] for line in lines] == words
        assert all(int(line.rsplit(":", 1)[1]) > 0 for line in lines)
        out, err = process.communicate(timeout=LIMIT_S)
    assert (process.returncode, out, err) == (0, "", "")


@pytest.mark.process
def test_a_guardian_started_by_hand_says_so():
    with start("guardian") as process:
        out, err = process.communicate("hello\n", timeout=LIMIT_S)
    assert (process.returncode, out) == (cli.USAGE, "")
    assert err == "guardian: it is started by the application, not by hand\n"


@pytest.mark.process
def test_output_that_nobody_reads_any_more_is_no_error_in_words(takes: Path):
    reading, writing = os.pipe()
    os.close(reading)
    command = child_command("evaluate", str(MODEL), str(takes))
    with os.fdopen(writing, "wb") as gone:
        done = subprocess.run(
            command,
            stdout=gone,
            stderr=subprocess.PIPE,
            timeout=LIMIT_S,
            env=child_environment(),
            check=False,
        )
    assert (done.returncode, done.stderr) == (cli.FAILED, b"")


HEAVY = ("torch", "PySide6", "pyqtgraph", "shiboken6")


def imported_by(program: str) -> set[str]:
    """Which of the heavy packages a program has imported at its end."""
    tail = f"\nimport sys; print('HEAVY', *(n for n in {HEAVY} if n in sys.modules))"
    done = subprocess.run(
        [sys.executable, "-c", program + tail],
        capture_output=True,
        text=True,
        timeout=LIMIT_S,
        env=child_environment(),
        check=True,
        stdin=subprocess.DEVNULL,
    )
    (line,) = [line for line in done.stdout.splitlines() if line.startswith("HEAVY")]
    return set(line.split()[1:])


def call(*arguments: str) -> str:
    return f"from gestureapp import cli\ncli.main({list(arguments)!r})"


@pytest.mark.process
def test_no_command_but_the_window_needs_qt_and_none_but_training_torch(takes: Path):
    for arguments in (
        ("evaluate", str(MODEL), str(takes)),
        ("simulate", "nx100", "--port", "0", "--exit-with-stdin"),
        ("simulate", "sensor", "--arm", "left", "--port", "0", "--exit-with-stdin"),
        ("guardian",),
    ):
        assert imported_by(call(*arguments)) == set(), arguments


@pytest.mark.process
def test_the_operating_process_imports_neither_torch_nor_qt_before_a_window_opens():
    assert imported_by("import ui.__main__, gestureapp.running, gestureapp.cell.engine") == set()


@pytest.mark.process
def test_the_guardian_imports_nothing_outside_the_standard_library():
    program = (
        "import gestureapp.robot.guardian, sys\n"
        "std = sys.stdlib_module_names | {'gestureapp', '__main__'}\n"
        "rest = {n.split('.')[0] for n in sys.modules} - set(std)\n"
        "print('REST', *sorted(n for n in rest if not n.startswith(('_', 'sitecustomize'))))"
    )
    done = subprocess.run(
        [sys.executable, "-c", program],
        capture_output=True,
        text=True,
        timeout=LIMIT_S,
        env=child_environment(),
        check=True,
    )
    assert done.stdout == "REST\n"
