"""What setting up asks of a person, done by the virtual operator. GUI thread only."""

from typing import Protocol

from gestureapp.sensing.values import ArmPosture, Side
from gestureapp.setup.snapshot import SetupSnapshot
from gestureapp.setup.values import Position

Wish = tuple[Side, Position] | ArmPosture | None
"""A sensor laid down so, the left arm in this posture, or nothing."""


class Hands(Protocol):
    """The part of the virtual operator that is needed."""

    def left_start(self) -> None:
        """The left arm takes the start posture."""

    def left_stop(self) -> None:
        """The left arm takes the stop posture."""

    def right_rest(self) -> None:
        """The right arm goes back to rest."""

    def lay(self, side: Side, position: str) -> None:
        """A sensor is taken off its arm and laid down; its arm's next move wears it again."""


class SetupFollower:
    """Lays sensors down and takes postures as they are asked for, each once."""

    def __init__(self, hands: Hands) -> None:
        self._hands = hands
        self._wish: Wish = None

    def follow(self, setup: SetupSnapshot | None) -> None:
        """Do what is asked for now; called at every refresh, with None where nobody asks."""
        wish = wish_of(setup)
        if wish == self._wish:
            return
        before, self._wish = self._wish, wish
        if isinstance(before, tuple) and not (isinstance(wish, tuple) and wish[0] is before[0]):
            self._wear_again(before[0])
        if isinstance(wish, tuple):
            self._hands.lay(wish[0], wish[1].value)
        elif wish is ArmPosture.START:
            self._hands.left_start()
        elif wish is ArmPosture.STOP:
            self._hands.left_stop()

    def _wear_again(self, side: Side) -> None:
        if side is Side.LEFT:
            self._hands.left_stop()
        else:
            self._hands.right_rest()


def wish_of(setup: SetupSnapshot | None) -> Wish:
    """What a person who looks at this is to do now."""
    if setup is None:
        return None
    calibration, postures = setup.calibration, setup.postures
    if calibration.is_on and calibration.side is not None and calibration.wanted is not None:
        return calibration.side, calibration.wanted
    if postures.is_on:
        return ArmPosture.START if postures.is_stop_done else ArmPosture.STOP
    return None
