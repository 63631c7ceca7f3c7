"""A connection that ends at once when this process is killed.

The kernel gives a killed process's memory back before it closes its files: 7 to 10 ms with a
window (measured), in which the robot moves on. So one thread has a table of files of its own, and
in it this connection alone: it closes when that thread ends, which is at once. Linux has such
tables (``close_range(2)``); elsewhere the ends of the other connections have to do.
"""

import contextlib
import ctypes
import os
import queue
import socket
import sys
import threading

from gestureapp.worker import Worker

CLOSE_RANGE_UNSHARE = 1 << 1
FIRST, LAST = 3, 0xFFFF_FFFF
"""Files after standard input, output and error."""


def hold_lifeline(sock: socket.socket, hello: bytes) -> bool:
    """Have a thread hold a connection until the other side or this process ends.

    Args:
        sock: Connected and blocking; closed here, the thread has it under the same number.
        hello: What is said on it, once it is held.

    Returns:
        Whether it is held.
    """
    number = sock.fileno()
    answer: queue.SimpleQueue[bool] = queue.SimpleQueue()

    def hold(_stopping: threading.Event) -> None:
        is_held = _keep_only(number)
        answer.put(is_held)
        if is_held:  # from here on no file of Python's may be used: this table does not have it
            with contextlib.suppress(OSError):
                os.write(number, hello)
                os.read(number, 1)

    Worker("lifeline", hold).start()
    with sock:
        return answer.get()


def _keep_only(number: int) -> bool:
    """Give this thread a table of files of its own, with the standard ones and this one in it."""
    if sys.platform != "linux":
        return False
    close_range = getattr(ctypes.CDLL(None), "close_range", None)  # from glibc 2.34
    if close_range is None:
        return False
    last = ctypes.c_uint(LAST)
    if close_range(number + 1, last, CLOSE_RANGE_UNSHARE) != 0:
        return False
    return number == FIRST or close_range(FIRST, number - 1, 0) == 0
