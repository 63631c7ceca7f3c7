"""What a take is: its samples, whose gesture it shows and what it is worth. Frozen values."""

from dataclasses import dataclass
from enum import Enum
from typing import Final

import numpy as np
from numpy.typing import NDArray

F64 = NDArray[np.float64]

BEFORE_S: Final = 0.5
"""A take begins this long before its activation …"""
AFTER_S: Final = 1.0
"""… and ends this long after it: 1.5 s, the paper's nine minutes for 12 x 30 takes."""


_CONFIRMED: Final = " confirmed"


class Verdict(Enum):
    """What a take is worth; the value is the word on the screen."""

    GOOD = "good"
    NO_MOVEMENT = "no movement"
    TOO_EARLY = "too early"
    TOO_LATE = "too late"
    NOT_LEVEL = "not level"
    GAP = "gap"
    SATURATED = "saturated"
    UNLIKE = "unlike the others"


@dataclass(frozen=True, slots=True)
class Judgement:
    """A verdict with its words, ``gap of 43 ms``, ``looks like RZ+``."""

    verdict: Verdict
    words: str

    @property
    def is_good(self) -> bool:
        """The take counts."""
        return self.verdict is Verdict.GOOD


@dataclass(frozen=True, slots=True)
class Take:
    """One repetition of a gesture by the right arm. Arrays are read-only.

    Attributes:
        id: Number in the person's database.
        label: The gesture that was asked for, or that it was moved to.
        session: The sitting it is from: its begin, ISO 8601; see ``confirmed``.
        wall_s: When it was activated, seconds since the epoch.
        judgement: The verdict it got at once.
        is_excluded: A person has taken it out; it can be taken back.
        is_deleted: It lies in the bin.
        times_s: Receive times from the activation, shape (k,), from about -0.5 to 1.0.
        accel_g: Specific force, shape (k, 3), in g.
    """

    id: int
    label: str
    session: str
    wall_s: float
    judgement: Judgement
    is_excluded: bool
    is_deleted: bool
    times_s: F64
    accel_g: F64

    @property
    def counts(self) -> bool:
        """It is trained from."""
        return self.judgement.is_good and not self.is_excluded and not self.is_deleted

    @property
    def is_confirmed(self) -> bool:
        """It was not recorded: somebody said of what was heard that it was right."""
        return self.session.endswith(_CONFIRMED)


def confirmed(session: str) -> str:
    """What stands as the session of takes that were confirmed in this sitting.

    They are told from recorded ones, so that a model does not count as out of date because of them.
    """
    return f"{sitting_of(session)}{_CONFIRMED}"


def sitting_of(session: str) -> str:
    """The sitting of a take's session, whether the take was recorded or confirmed."""
    return session.removesuffix(_CONFIRMED)
