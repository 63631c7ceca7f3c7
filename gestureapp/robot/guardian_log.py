"""The guardian's own log file: bounded, and written only when nothing else waits."""

import logging
import logging.handlers
from collections.abc import Callable

MOST_BYTES = 1_000_000
"""Then the file is kept once, with ``.1`` after its name, and another is begun."""
KEPT_LINES = 1000
"""In memory at most, when nobody has had the time to write them."""
_FORM = "%(asctime)s %(levelname)s %(message)s"


def open_log(path: str) -> Callable[[], None]:
    """Have the process' log in a file; returns what writes the lines that have come since.

    A disk is slow at times: lines wait in memory until the bytes for the robot are out. A guardian
    that cannot write its log still stops the robot.
    """
    logging.raiseExceptions = False  # a full disk is no reason for a traceback a person sees
    if not path:
        return _nothing
    try:
        file = logging.handlers.RotatingFileHandler(
            path, maxBytes=MOST_BYTES, backupCount=1, encoding="utf-8"
        )
    except OSError as error:
        logging.getLogger("guardian").warning("no guardian log: %s", error)
        return _nothing
    file.setFormatter(logging.Formatter(_FORM))
    waiting = logging.handlers.MemoryHandler(KEPT_LINES, logging.CRITICAL, file)
    logging.basicConfig(level=logging.INFO, handlers=[waiting])
    return waiting.flush


def _nothing() -> None:
    """There is no file."""
