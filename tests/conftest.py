"""What every test gets: nothing left running, and no warning nobody announced."""

import logging
import os
import threading
from collections.abc import Iterator

import pytest
from hypothesis import settings

from tests.pauses import PAUSE_S, MachinePaused, PauseMeter

JOIN_LIMIT_S = 3.0

if not os.environ.get("CI"):  # there hypothesis has its own profile, with the same examples always
    settings.register_profile("here", deadline=None)  # a busy machine is no failure
    settings.load_profile("here")


@pytest.fixture(autouse=True, scope="session")
def no_settings_of_this_machine(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """No test, and no process of one, reads or writes the settings of whoever runs it."""
    with pytest.MonkeyPatch.context() as patch:
        folder = str(tmp_path_factory.mktemp("settings"))
        for name in ("XDG_CONFIG_HOME", "XDG_CONFIG_DIRS"):
            patch.setenv(name, folder)
        yield


@pytest.fixture(autouse=True)
def no_thread_left() -> Iterator[None]:
    """A test that leaves a thread behind fails."""
    before = set(threading.enumerate())
    yield
    left = [thread for thread in threading.enumerate() if thread not in before]
    for thread in left:
        thread.join(JOIN_LIMIT_S)
    names = [thread.name for thread in left if thread.is_alive()]
    assert not names, f"threads left running: {names}"


@pytest.fixture(autouse=True)
def no_error_unannounced(
    request: pytest.FixtureRequest, caplog: pytest.LogCaptureFixture
) -> Iterator[None]:
    """A test that logs an error it did not announce with the ``logs_errors`` mark fails."""
    yield
    if request.node.get_closest_marker("logs_errors"):
        return
    errors = [r.getMessage() for r in caplog.get_records("call") if r.levelno >= logging.ERROR]
    assert not errors, f"unannounced errors in the log: {errors}"


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item: pytest.Item) -> Iterator[None]:
    """A failure in real time during which the machine paused becomes ``MachinePaused``."""
    if item.get_closest_marker("process") is None:
        return (yield)
    meter = PauseMeter()
    meter.start()
    try:
        return (yield)
    except Exception as error:
        if meter.worst_s < PAUSE_S:
            raise
        text = f"the machine stood still for {meter.worst_s * 1000:.0f} ms: {error}"
        raise MachinePaused(text) from error
    finally:
        meter.stop()
