"""The training child: a job on standard input, progress and the outcome on standard output.

Started by the application with the hidden command ``training-child``; ends at once when its
standard input does, also in the middle of a pass: the application cancels it so, and does not leave
it behind when it is killed.
"""

import math
import os
import sys
import threading
from typing import BinaryIO

from gestureapp.clock import monotonic
from gestureapp.errors import GestureAppError
from gestureapp.recognition.model_file import save_model
from gestureapp.recognition.takes import load_takes
from gestureapp.recognition.training import train
from gestureapp.recognition.training_job import Failed, Finished, Job, Progress, parse_job

CANCELLED = 3
"""Exit code; nobody is left to read it."""


def main() -> int:
    """Do one job; exit code 0 when its model is written, 1 when not, 2 without a job."""
    inbox, outbox = sys.stdin.buffer, sys.stdout.buffer
    try:
        job = parse_job(inbox.readline())
    except ValueError:
        sys.stderr.write("training-child: it is started by the application, not by hand\n")
        return 2
    threading.Thread(target=_end_with, args=(inbox,), name="end with input", daemon=True).start()
    answer = _do(job, outbox)
    _say(outbox, answer)
    return 0 if isinstance(answer, Finished) else 1


def _do(job: Job, outbox: BinaryIO) -> Finished | Failed:
    first: tuple[int, float] | None = None

    def progress(done: int, total: int, loss: float) -> None:
        nonlocal first
        now_s = monotonic()
        first = first or (done, now_s)  # what came before was the loading of torch
        first_done, first_s = first
        pace_s = (now_s - first_s) / (done - first_done) if done > first_done else math.nan
        _say(outbox, Progress(done, total, loss, pace_s * (total - done)))

    try:
        takes = load_takes(job.takes)
        model = train(takes, job.preset, job.seed, progress, takes_from=job.takes_from)
        save_model(job.out, model)
    except GestureAppError as error:
        return Failed(str(error))
    except ModuleNotFoundError as error:
        remedy = "pip install 'gestureapp[training]'" if error.name == "torch" else "install it"
        return Failed(f"training needs {error.name}, which is not here: {remedy}")
    except MemoryError:
        return Failed("the memory is full: close other programs, then train again")
    return Finished()


def _say(outbox: BinaryIO, answer: Progress | Finished | Failed) -> None:
    try:
        outbox.write(answer.as_line())
        outbox.flush()
    except OSError:  # nobody listens any more
        os._exit(CANCELLED)


def _end_with(inbox: BinaryIO) -> None:
    """Wait for the end of the input: torch cannot be asked to stop, so the process just ends."""
    while os.read(inbox.fileno(), 4096):
        pass
    os._exit(CANCELLED)
