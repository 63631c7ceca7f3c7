"""The training child as a process: it does one job, and ends with its input."""

import math
import subprocess
import time

import pytest

from gestureapp.children import child_command, start_beside
from gestureapp.clock import monotonic
from gestureapp.recognition.model_file import load_model
from gestureapp.recognition.presets import Preset
from gestureapp.recognition.takes import save_takes
from gestureapp.recognition.training_job import (
    Failed,
    Finished,
    Job,
    Progress,
    parse_answer,
    parse_job,
)
from gestureapp.simulation.takes import make_takes

LIMIT_S = 60.0

pytestmark = pytest.mark.process


@pytest.fixture
def child():
    process = start_beside(child_command("training-child"), is_spoken_with=True)
    yield process
    process.kill()
    process.wait()
    process.stdin.close()
    process.stdout.close()


@pytest.fixture
def job(tmp_path):
    save_takes(tmp_path / "takes.npz", make_takes(1, 6, 7))
    return Job(tmp_path / "takes.npz", tmp_path / "out.json", Preset.DEFAULT, 3, "a test")


def give(child: subprocess.Popen, job: Job) -> None:
    child.stdin.write(job.as_line())
    child.stdin.flush()


def test_a_job_ends_with_a_model_after_progress_up_to_the_end(child, job):
    give(child, job)
    answers = [parse_answer(line) for line in child.stdout]

    assert child.wait(LIMIT_S) == 0
    assert answers[-1] == Finished()
    told = answers[:-1]
    assert all(isinstance(answer, Progress) for answer in told)
    assert math.isnan(told[0].remaining_s)
    assert [a.done for a in told] == sorted(a.done for a in told)
    assert (told[-1].done, told[-1].remaining_s) == (told[-1].total, 0.0)
    model = load_model(job.out)
    assert (model.training.seed, model.training.takes_from) == (3, "a test")
    assert model.cross_validation.evaluation.n == 72


def test_it_ends_at_once_when_its_input_ends_in_the_middle_of_the_training(child, job):
    give(child, Job(job.takes, job.out, Preset.PAPER))
    assert isinstance(parse_answer(child.stdout.readline()), Progress)
    child.stdin.close()
    begun_s = monotonic()
    while child.poll() is None and monotonic() - begun_s < LIMIT_S:
        time.sleep(0.005)

    assert child.returncode == 3
    assert not job.out.exists()


def test_what_cannot_be_done_is_said_in_one_line(child, job):
    job.takes.write_bytes(b"rubbish")
    give(child, job)
    answers = [parse_answer(line) for line in child.stdout]

    assert child.wait(LIMIT_S) == 1
    (failed,) = answers
    assert isinstance(failed, Failed)
    assert str(job.takes) in failed.text
    assert len(failed.text.splitlines()) == 1


def test_it_is_not_started_by_hand(child):
    child.stdin.write(b"hello\n")
    child.stdin.close()

    assert child.wait(LIMIT_S) == 2


def test_a_job_survives_its_line(job):
    assert parse_job(job.as_line()) == job


@pytest.mark.parametrize("line", [b"", b"[]", b"{}", b'{"progress": 3}', b"\xff\n", b"3"])
def test_a_line_that_is_no_answer_is_none(line):
    assert parse_answer(line) is None
