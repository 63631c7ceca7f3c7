"""The one clock: the same everywhere, and it counts a sleep of the computer."""

import shutil
import subprocess
import sys

import pytest

from gestureapp.children import child_environment
from gestureapp.clock import monotonic
from gestureapp.robot import clock

SLEPT_S = 1000.0
SHOW = "import time, gestureapp.clock as c; print(c.monotonic() - time.monotonic())"


def test_the_robots_end_and_the_rest_have_one_clock():
    assert monotonic is clock.monotonic


@pytest.mark.skipif(sys.platform != "linux", reason="time namespaces")
def test_a_sleep_of_the_computer_counts():
    unshare = shutil.which("unshare")
    if unshare is None:
        pytest.skip("no unshare here")
    # A time namespace with another boot time is what a computer looks like that has slept.
    slept = subprocess.run(
        [unshare, "--time", "--boottime", str(int(SLEPT_S)), sys.executable, "-c", SHOW],
        capture_output=True,
        text=True,
        check=False,
        env=child_environment(),
    )
    if slept.returncode:
        pytest.skip(f"no time namespace here: {slept.stderr.strip()}")
    here = subprocess.run([sys.executable, "-c", SHOW], capture_output=True, text=True, check=True)
    assert float(slept.stdout) - float(here.stdout) == pytest.approx(SLEPT_S, abs=1.0)
