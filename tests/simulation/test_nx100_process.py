"""The emulated NX100 as a process of its own: its line, its arguments, its end."""

import argparse
import os
import signal
import socket
import subprocess
import sys
from pathlib import Path

import pytest

import gestureapp
from gestureapp.errors import ConfigError
from gestureapp.robot.values import Pose
from gestureapp.simulation.nx100_options import FaultKind, Nx100Options, Second, Segments
from gestureapp.simulation.nx100_process import add_arguments, main, options_of, read_script

LIMIT_S = 20.0
HOME = Path(gestureapp.__file__).parent.parent


@pytest.fixture
def spawn():
    """Start emulator processes; all of them have ended afterwards."""
    started = []

    def start(*words):
        child = subprocess.Popen(
            [sys.executable, "-m", "gestureapp.simulation.nx100_process", "--port", "0", *words],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env={**os.environ, "PYTHONPATH": str(HOME)},
        )
        started.append(child)
        return child

    yield start
    for child in started:
        if child.poll() is None:
            child.kill()
        child.communicate()


def port_of(child, word="listening"):
    line = child.stdout.readline().decode()
    assert line.startswith(f"{word} on 127.0.0.1:")
    assert line.endswith("\n")
    return int(line.rpartition(":")[2])


def parsed(*words):
    parser = argparse.ArgumentParser()
    add_arguments(parser)
    return options_of(parser.parse_args(["--port", "0", *words]))


@pytest.mark.process
@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_process_says_where_it_listens_and_ends_on_a_signal(spawn, number, tmp_path):
    file = tmp_path / "bytes.jsonl"
    child = spawn("--log", str(file))
    with socket.create_connection(("127.0.0.1", port_of(child)), LIMIT_S) as client:
        client.sendall(b"CONNECT Robot_access\r\n")
        assert client.recv(3) == b"OK:"
        child.send_signal(number)
        assert child.wait(LIMIT_S) == 0
    assert '"text": "CONNECT Robot_access\\r\\n"' in file.read_text()


@pytest.mark.process
def test_process_ends_with_its_standard_input_if_asked(spawn):
    child = spawn("--exit-with-stdin", "--control-port", "0")
    assert port_of(child, "control") != port_of(child)
    child.stdin.close()
    assert child.wait(LIMIT_S) == 0
    child.stdin = None


def test_arguments_become_options(tmp_path):
    script = tmp_path / "faults.toml"
    script.write_text('[[fault]]\nat_s = 1.5\nkind = "slow"\nms = 250\n')
    options = parsed(
        *("--segments", "late-lf", "--answer-delay-ms", "5", "--second", "ignore", "--strict"),
        *("--pose", "700,1,2,180,0,5", "--resume-after-hold", "--ladder-ms", "400"),
        *("--tool", "3", "--tool-mm", "0,-5,120"),
        *("--idle-close-s", "30", "--script", str(script), "--servo-on-delay-ms", "800"),
    )
    assert options.segments is Segments.LATE_LF
    assert options.answer_delay_s == 0.005
    assert options.second is Second.IGNORE
    assert options.is_strict
    assert options.idle_close_s == 30.0
    assert options.controller.start_pose == Pose(700.0, 1.0, 2.0, 180.0, 0.0, 5.0)
    assert (options.controller.tool, options.controller.tool_mm) == (3, (0.0, -5.0, 120.0))
    assert options.controller.resumes_after_hold
    assert options.controller.ladder_s == 0.4
    assert options.controller.servo_on_delay_s == 0.8
    ((at_s, fault),) = [(entry.at_s, entry.fault) for entry in options.script]
    assert (at_s, fault.kind, fault.delay_s) == (1.5, FaultKind.SLOW, 0.25)


@pytest.mark.parametrize(
    "words",
    [("--tool", "24"), ("--tool", "x"), ("--tool-mm", "1,2"), ("--tool-mm", "1,2,nan")],
)
def test_a_tool_that_no_controller_has_is_a_wrong_usage(words, capsys):
    with pytest.raises(SystemExit):
        parsed(*words)
    assert "wanted" in capsys.readouterr().err


def test_arguments_left_out_are_the_defaults():
    assert parsed() == Nx100Options()


@pytest.mark.parametrize(
    "words",
    [
        ("--accel-mm-s2", "0"),
        ("--accel-deg-s2", "nan"),
        ("--answer-delay-ms", "-1"),
        ("--idle-close-s", "0"),
        ("--ladder-ms", "inf"),
    ],
)
def test_numbers_the_model_cannot_use_are_refused(words):
    with pytest.raises(ConfigError, match=words[0]):
        parsed(*words)


@pytest.mark.parametrize("pose", ["1,2,3", "1,2,3,4,5,x", "1,2,3,4,5,nan"])
def test_pose_that_is_none_is_a_usage_error(pose, capsys):
    with pytest.raises(SystemExit) as ended:
        parsed("--pose", pose)
    assert ended.value.code == 2
    assert "--pose" in capsys.readouterr().err


@pytest.mark.parametrize(
    "text",
    [
        "fault = 3",
        "[[fault]]\nkind = 'slow'",
        "[[fault]]\nat_s = -1\nkind = 'slow'",
        "[[fault]]\nat_s = 1\nkind = 'tired'",
        "not toml",
    ],
)
def test_script_that_makes_no_sense_is_refused(text, tmp_path):
    script = tmp_path / "faults.toml"
    script.write_text(text)
    with pytest.raises(ConfigError):
        read_script(script)


def test_error_is_one_line(tmp_path, capsys):
    assert main(["--port", "0", "--script", str(tmp_path / "none.toml")]) == 1
    assert capsys.readouterr().err.count("\n") == 1
