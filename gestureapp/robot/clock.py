"""The one clock of every process: monotonic seconds that go on while the computer sleeps."""

import functools
import sys
import time
from collections.abc import Callable

if sys.platform == "linux":
    # CLOCK_MONOTONIC stands still during a suspend: after ten seconds of sleep no watchdog would
    # find anything old. Source: clock_gettime(2). A partial costs as little as time.monotonic.
    monotonic: Callable[[], float] = functools.partial(time.clock_gettime, time.CLOCK_BOOTTIME)
else:
    # On Windows it counts the sleep, too.
    monotonic = time.monotonic
