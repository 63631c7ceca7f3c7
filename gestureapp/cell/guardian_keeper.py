"""Keeps a guardian: starts one when there is none, notices a silent one, owes it a stop. Pure."""

from collections.abc import Callable

from gestureapp.cell.inputs import GuardianPort
from gestureapp.errors import GuardianLost
from gestureapp.robot import messages as m
from gestureapp.robot.leftover import KeptMoves

RESTART_S = 0.2
"""Between two attempts to start a guardian."""
SILENT_TICKS = 30
"""A guardian is heard every 0.1 s. Counted in our own ticks: we may have stood still ourselves."""


class GuardianKeeper:
    """The guardian there is, if there is one. Owned by the control thread.

    Args:
        start: Starts one, given what is known of the controller; raises GuardianLost.
        address: Of the controller.

    Attributes:
        trouble: Why the last attempt to start one failed; empty when it did not.
    """

    def __init__(self, start: Callable[[KeptMoves], GuardianPort], address: str) -> None:
        self._start, self._address = start, address
        self._kept: dict[str, KeptMoves] = {}
        self._guardian: GuardianPort | None = None
        self._tried_s = float("-inf")
        self.trouble = ""
        self._n_silent = 0
        self._owed_stop: m.Stop | None = None

    @property
    def is_there(self) -> bool:
        """One was started and is not gone."""
        return self._guardian is not None

    def keep(self, now_s: float) -> str:
        """Start one if there is none. Returns a trouble that is new, or nothing."""
        if self._guardian is not None or now_s - self._tried_s < RESTART_S:
            return ""
        self._tried_s = now_s
        try:
            self._guardian = self._start(self._known)
        except GuardianLost as error:
            before, self.trouble = self.trouble, str(error)
            return "" if before == self.trouble else self.trouble  # told once
        self.trouble, self._n_silent = "", 0
        if self._owed_stop is not None:
            self._guardian.send(self._owed_stop)
            self._owed_stop = None
        return ""

    def send(self, message: m.ToGuardian) -> None:
        """Say something; without a guardian only a stop is kept, for the next one."""
        if self._guardian is not None:
            self._guardian.send(message)
        elif isinstance(message, m.Stop):
            self._owed_stop = message

    @property
    def _known(self) -> KeptMoves:
        return self._kept.get(self._address, KeptMoves())

    def heard(self, message: m.FromGuardian) -> None:
        """It has said something; what it has learned of the controller outlives it."""
        self._n_silent = 0
        if isinstance(message, m.Hindrances):
            self._kept[self._address] = self._known.after(message.refusals)

    def is_silent(self) -> bool:
        """Whether it has said nothing for too many of our ticks; asked once a tick."""
        self._n_silent += 1
        return self._guardian is not None and self._n_silent > SILENT_TICKS

    def forget(self) -> None:
        """It is gone, and nobody knows what it left of a move."""
        self._guardian = None
        self._kept[self._address] = self._known.unattended()

    def renew(self, now_s: float, address: str) -> None:
        """Let it go; another one follows, as limits and address come only at the start.

        The next start waits ``RESTART_S``: a guardian has ended 80 ms after the goodbye.
        """
        if self._guardian is not None:
            self._guardian.dismiss()
            self._guardian, self._tried_s = None, now_s
        self._address = address
