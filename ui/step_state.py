"""How far a step of a page is, and whether its page can be opened. Pure; no widget."""

from dataclasses import dataclass

from gestureapp.cell.snapshot import CellState, Snapshot

REST_STATES = (CellState.NOT_READY, CellState.READY, CellState.ARMED, CellState.STOPPED)
"""In these nothing moves; opening such a page takes the permission back."""


@dataclass(frozen=True, slots=True)
class StepState:
    """How far a step is.

    Attributes:
        done: So many.
        total: Of so many; 0 while there is nothing to count.
        text: Both in words, or why there are none.
        barrier: Why it cannot be entered; empty when it can.
        is_problem: Something there wants a person; ``text`` says what.
    """

    done: int
    total: int
    text: str
    barrier: str = ""
    is_problem: bool = False

    @property
    def is_done(self) -> bool:
        """Nothing is missing."""
        return 0 < self.total <= self.done


def place_barrier(snapshot: Snapshot) -> str:
    """Why a page that locks arming cannot be opened now; empty when it can."""
    if snapshot.is_stop_unconfirmed:
        return "not before the stop is confirmed"
    if snapshot.state not in REST_STATES or snapshot.robot.is_moving:
        return "not while the robot moves"
    return ""
