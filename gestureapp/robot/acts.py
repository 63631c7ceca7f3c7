"""What a guardian did, as it stands in its log, and what of it no application has shown. Pure.

A line of the log is words for a person; where it is an act, a tab and one JSON object follow.
"""

import dataclasses
import json
from collections.abc import Iterable
from dataclasses import dataclass
from enum import Enum

from gestureapp.robot import messages as m
from gestureapp.robot.values import StopReason

_MOST_S = 1e11
"""Some thousand years: no clock says more."""
_REASONS = {reason.value: reason for reason in StopReason}


class Did(Enum):
    """Kinds of acts."""

    STARTED = "started"
    MOVES = "moves"
    ARRIVED = "arrived"
    """Or not begun: no command is open any more."""
    STOPPING = "stopping"
    STANDS = "stands"
    UNCONFIRMED = "unconfirmed"
    GONE = "gone"
    """The application is."""
    ENDED = "ended"


@dataclass(frozen=True, slots=True)
class Act:
    """One thing a guardian did.

    Attributes:
        did: Its kind.
        run: Which guardian: no other has this word.
        wall_s: When, seconds since the epoch.
        t_s: When, on the clock of all processes.
        text: Why, or how, for a person.
        reason: Of a stop: the value of its StopReason; else empty.
        could_move: A stop: the robot was moving or might have. Gone: without a goodbye.
        seen_s: Gone: when control thread and window were last both alive. Stands: after how long.
    """

    did: Did
    run: str
    wall_s: float
    t_s: float
    text: str = ""
    reason: str = ""
    could_move: bool = False
    seen_s: float = 0.0

    @property
    def line(self) -> str:
        """As it stands in the log, without time and line end."""
        words = " ".join(f"{self.did.value}: {self.text or self.reason}".split())
        fields = dataclasses.asdict(self) | {"did": self.did.value}
        return f"{words}\t{json.dumps(fields)}"


@dataclass(frozen=True, slots=True)
class Unseen:
    """A stop that no application has shown.

    Attributes:
        stop: The act.
        outcome: What became of it, for a person.
        stood_after_s: How long after the stop the robot was read back to stand; None: it was not.
    """

    stop: Act
    outcome: str
    stood_after_s: float | None = None

    @property
    def key(self) -> str:
        """The same for the same stop with the same outcome."""
        return f"{self.stop.run} {self.stop.wall_s:.3f} {self.outcome}"


def act_of(message: m.FromGuardian, run: str, wall_s: float, could_move: bool) -> Act | None:
    """The act that a message tells of; None when it is none. Stops carry their own time."""
    match message:
        case m.CommandSent():
            text = f"increment {message.activation_id}, limited by {message.limited_by}"
            return Act(Did.MOVES, run, wall_s, message.t_s, text, could_move=True)
        case m.MotionEnded() | m.CommandRefused():
            return Act(Did.ARRIVED, run, wall_s, 0.0, f"increment {message.activation_id}")
        case m.StopAsked():
            text, reason = message.text, message.reason.value
            return Act(Did.STOPPING, run, wall_s, message.t_s, text, reason, could_move)
        case m.StopConfirmed():
            reason = message.reason.value
            return Act(Did.STANDS, run, wall_s, 0.0, "", reason, seen_s=message.took_s)
        case m.StopUnconfirmed():
            text, reason = message.text, message.reason.value
            return Act(Did.UNCONFIRMED, run, wall_s, 0.0, text, reason)
    return None


def read_act(line: str) -> Act | None:
    """The act of one line of the log; None when it has none that can be read."""
    try:
        fields = json.loads(line.rpartition("\t")[2])
        act = Act(**{**fields, "did": Did(fields["did"])})
    except (ValueError, TypeError, KeyError, RecursionError):
        return None
    numbers = (act.wall_s, act.t_s, act.seen_s)
    are_numbers = all(type(n) in (int, float) and 0 <= n < _MOST_S for n in numbers)
    are_texts = all(isinstance(text, str) for text in (act.run, act.text, act.reason))
    is_act = are_numbers and are_texts and isinstance(act.could_move, bool)
    return act if is_act else None


def find_unseen(lines: Iterable[str]) -> Unseen | None:
    """The newest stop of a robot that might have moved and that no application has shown.

    Args:
        lines: Of the log, oldest first; anything may stand between the acts.
    """
    runs: dict[str, list[Act]] = {}
    for line in lines:
        if (act := read_act(line)) is not None:
            runs.setdefault(act.run, []).append(act)
    found = [unseen for acts in runs.values() if (unseen := _unseen_in(acts)) is not None]
    if runs and (cut_short := _cut_short(list(runs.values())[-1])) is not None:
        return cut_short
    return max(found, key=lambda unseen: unseen.stop.wall_s, default=None)


def _unseen_in(acts: list[Act]) -> Unseen | None:
    """Of one guardian: the first stop after its application was last alive."""
    gone = next((act for act in acts if act.did is Did.GONE), None)
    if gone is not None and not gone.could_move:
        return None
    for i, act in enumerate(acts):
        if act.did is not Did.STOPPING or not act.could_move or not _is_latched(act):
            continue
        stands = next((later for later in acts[i:] if later.did is Did.STANDS), None)
        if gone is not None:
            is_unseen = act.t_s > gone.seen_s
        else:  # the guardian was killed as well: only a stop it did not finish is news
            is_unseen = stands is None and acts[-1].did is not Did.ENDED
        if is_unseen:
            outcome = _outcome(stands, {later.did for later in acts[i:]})
            return Unseen(act, outcome, None if stands is None else stands.seen_s)
    return None


def _cut_short(acts: list[Act]) -> Unseen | None:
    """Of the last guardian: it ended, as its application, while a move was open."""
    if acts[-1].did is not Did.MOVES:
        return None
    return Unseen(acts[-1], "nothing stopped it here: program and guardian had ended")


def _outcome(stands: Act | None, after: set[Did]) -> str:
    if stands is None and after & {Did.UNCONFIRMED, Did.ENDED}:
        return "the robot did not confirm that it stands"
    if stands is None:  # the guardian was killed, or is still at it
        return "no standstill is noted"
    return f"standstill confirmed after {stands.seen_s:.2f} s"


def _is_latched(act: Act) -> bool:
    reason = _REASONS.get(act.reason)
    return reason is None or reason.is_latched
