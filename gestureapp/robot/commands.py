"""The one command: proposed, waiting for the line, open, ended. Pure."""

from gestureapp.robot import messages as m
from gestureapp.robot.gate import Command, GateView, Limits, Proposal, decide
from gestureapp.robot.motion import Motion, Reached, StoppedShort
from gestureapp.robot.nx100 import Answer, Failure
from gestureapp.robot.values import Refusal


class Commands:
    """From proposal to end, one at a time. Owned by the supervisor.

    Attributes:
        pending: Let through by the gate, waits for the line; or None.
        motion: Sent and not ended, or None.
        last_activation_id: Of the newest one sent.
    """

    def __init__(self) -> None:
        self.pending: Command | None = None
        self.motion: Motion | None = None
        self.last_activation_id = 0

    @property
    def is_test(self) -> bool:
        """The open one is a stop test's."""
        return self.motion is not None and self.motion.command.proposal.caps is not None

    @property
    def is_any(self) -> bool:
        """One waits or is open."""
        return self.pending is not None or self.motion is not None

    def propose(
        self, message: m.Propose, view: GateView, limits: Limits, now_s: float
    ) -> m.CommandRefused | None:
        """Ask the gate; what it lets through waits for the line."""
        proposal = Proposal(message.activation_id, message.direction, message.t_s, message.caps)
        decision = decide(proposal, view, limits, now_s)
        if isinstance(decision, Refusal):
            return m.CommandRefused(message.activation_id, decision)
        self.pending = decision
        return None

    def take_pending(self) -> Command | None:
        """The one that waits; it does not wait any more."""
        command, self.pending = self.pending, None
        return command

    def begin(
        self, command: Command, view: GateView, limits: Limits, now_s: float
    ) -> m.CommandSent | m.CommandRefused:
        """Look once more with the newest values, immediately before the bytes leave."""
        again = decide(command.proposal, view, limits, now_s)
        if isinstance(again, Refusal):
            return m.CommandRefused(command.proposal.activation_id, again)
        self.motion = Motion(again, now_s)
        self.last_activation_id = self.motion.activation_id
        return self.motion.report

    def answered(self, answer: Answer, now_s: float) -> m.CommandAccepted | m.CommandRefused | None:
        """The controller has answered the move; None when no move is open any more."""
        motion = self.motion
        if motion is None:
            return None
        if isinstance(answer, Failure):
            self.motion = None
            refusal = Refusal("robot_refused", f"the robot refused: {answer.words}")
            return m.CommandRefused(motion.activation_id, refusal)
        motion.accepted(now_s)
        return m.CommandAccepted(motion.activation_id, now_s)

    def check(self, now_s: float) -> m.MotionEnded | StoppedShort | None:
        """Has the open move come to an end?"""
        motion = self.motion
        outcome = None if motion is None else motion.check(now_s)
        if motion is not None and isinstance(outcome, Reached):
            self.motion = None
            return m.MotionEnded(motion.activation_id, outcome.pose)
        return outcome if isinstance(outcome, StoppedShort) else None
