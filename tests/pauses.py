"""A test during which the machine stood still says nothing: it is run again.

The cell stops the robot when its processes are kept from running for longer than the left sensor
may be silent. That is what it is for, and on a shared machine it happens. So the longest pause is
measured beside every test that runs processes or threads in real time; one that fails after a pause
longer than the shortest trip level in use is run again, a few times. One that fails without a pause
has failed.
"""

import threading
import time

LOOK_S = 0.005
PAUSE_S = 0.08
"""A little less than the trip level of 100 ms that such tests use at the least."""


class MachinePaused(AssertionError):
    """The test failed, and the machine had stood still meanwhile."""


class PauseMeter:
    """Measures for how long a thread that only sleeps was kept from running."""

    def __init__(self) -> None:
        self.worst_s = 0.0
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, name="pause meter", daemon=True)

    def start(self) -> None:
        self._thread.start()

    def stop(self) -> None:
        self._ended.set()
        self._thread.join()

    def _run(self) -> None:
        before_s = time.monotonic()
        while not self._ended.wait(LOOK_S):
            now_s = time.monotonic()
            self.worst_s = max(self.worst_s, now_s - before_s - LOOK_S)
            before_s = now_s
