"""The one way to start a thread: named, stoppable, its death reported."""

import threading

import pytest

from gestureapp.errors import WorkerError
from gestureapp.worker import Worker

LIMIT_S = 5.0


def test_a_worker_runs_under_its_name_until_it_is_told_to_stop():
    seen: list[str] = []
    has_begun = threading.Event()

    def run(stopping: threading.Event) -> None:
        seen.append(threading.current_thread().name)
        has_begun.set()
        stopping.wait(LIMIT_S)

    worker = Worker("left reader", run)
    assert not worker.is_alive
    worker.start()
    assert has_begun.wait(LIMIT_S)
    assert worker.is_alive
    assert worker.stop()
    assert worker.stop()
    assert (worker.is_alive, seen, worker.error) == (False, ["left reader"], None)


@pytest.mark.logs_errors
def test_what_kills_a_worker_is_kept_logged_and_reported_once(caplog: pytest.LogCaptureFixture):
    told: list[WorkerError] = []
    is_told = threading.Event()

    def on_error(error: WorkerError) -> None:
        told.append(error)
        is_told.set()

    def run(_: threading.Event) -> None:
        raise ZeroDivisionError("a tick of no length")

    worker = Worker("control", run, on_error)
    worker.start()
    assert is_told.wait(LIMIT_S)
    assert worker.stop()
    assert str(worker.error) == "control: ZeroDivisionError: a tick of no length"
    assert told == [worker.error]
    assert "control ended by an error" in caplog.text


@pytest.mark.logs_errors
def test_a_worker_without_a_listener_keeps_its_error():
    def run(_: threading.Event) -> None:
        raise OSError("the port is gone")

    worker = Worker("left reader", run)
    worker.start()
    assert worker.stop(LIMIT_S)
    assert worker.error is not None
    assert worker.error.worker == "left reader"


def test_stopping_before_starting_is_fine():
    worker = Worker("recorder", lambda stopping: None)
    assert worker.stop()
    assert worker.stopping.is_set()


def test_a_worker_may_stop_itself():
    stopped: list[bool] = []
    workers: list[Worker] = []
    worker = Worker("recorder", lambda stopping: stopped.append(workers[0].stop()))
    workers.append(worker)
    worker.start()
    assert worker.stop(LIMIT_S)
    assert stopped == [False]


def test_one_that_does_not_end_in_time_is_said_not_to_have_ended():
    may_end = threading.Event()

    def run(_: threading.Event) -> None:
        may_end.wait(LIMIT_S)

    worker = Worker("slow", run)
    worker.start()
    assert worker.stop(wait_s=0.01) is False
    may_end.set()
    assert worker.stop(LIMIT_S)
