"""The gate: what may go to the robot. White list, permission, field, speed, age. Pure.

It decides last and cannot be switched off. A ``Permit`` is the only thing the exchange takes, and
only this module makes one.
"""

import math
from dataclasses import dataclass

from gestureapp.robot import nx100
from gestureapp.robot.nx100 import Request
from gestureapp.robot.values import Caps, Direction, Position, Refusal, RobotStatus, StopReason
from gestureapp.robot.workspace import (
    MIN_LENGTH_MM,
    FieldOfOperation,
    Plan,
    find_outside,
    plan,
    shortened,
)

SPEED_CAP_MM_S = 250.0
"""Manual reduced speed of ISO 10218, as quoted by secondary sources; no site may go above."""
SPEED_CAP_DEG_S = 30.0
"""Our own choice for wrist turns: field reports call 9 deg/s "very fast"."""
POSE_MAX_AGE_S = 0.2
"""An increment is computed from a position read less than this ago."""
STATUS_MAX_AGE_S = 0.8
"""Older than that, nobody knows whether the robot may move."""
PROPOSAL_MAX_AGE_S = 0.15
"""A decision that took longer to arrive is not what the person means now."""
AHEAD_S = 0.05
"""A stamp this far in the future is not from our clock."""
LEAST_SPEED_MM_S = 0.1
"""The wire says one decimal."""
TEST_MOST = Caps(length_mm=20.0, speed_mm_s=20.0)
"""No stop test is longer or faster, whatever caps it comes with."""
ROBOT_FRAMES = (0, 1)
"""Base and robot: the same place, as the robot stands on no base axis."""


@dataclass(frozen=True, slots=True)
class Limits:
    """What the guardian is given at its start and nobody can change afterwards.

    Attributes:
        field: Where the tool may go.
        speed_mm_s: Of translations.
        speed_deg_s: Of rotations.
        frame: Frame of increments and positions.
        tool: Tool number.
        is_hold_to_run: Moves only while the left arm holds the start posture.
        trip_level_s: Left sensor silent longer than this stops the robot.
        control_limit_s: The same for the control thread.
        gui_limit_s: The same for the window.
        supervision_input: Network input that is toggled for the controller's ladder; 0 for none.
        supervision_hz: How often a second.

    Raises:
        ValueError: a limit is outside its bounds; the text names limit, value and bounds.
    """

    field: FieldOfOperation
    speed_mm_s: float
    speed_deg_s: float
    frame: int
    tool: int
    is_hold_to_run: bool
    trip_level_s: float
    control_limit_s: float
    gui_limit_s: float
    supervision_input: int = 0
    supervision_hz: float = 5.0

    def __post_init__(self) -> None:
        for name, low, high in (
            ("speed_mm_s", LEAST_SPEED_MM_S, SPEED_CAP_MM_S),
            ("speed_deg_s", 0.1, SPEED_CAP_DEG_S),
            ("frame", 0, 25),
            ("tool", 0, 23),
            ("trip_level_s", 0.05, 0.3),
            ("control_limit_s", 0.05, 0.5),
            ("gui_limit_s", 0.1, 1.0),
            ("supervision_hz", 2.0, 10.0),
        ):
            value = getattr(self, name)
            if not (math.isfinite(value) and low <= value <= high):
                raise ValueError(f"{name} = {value}: must lie between {low} and {high}")
        if self.supervision_input and self.supervision_input not in nx100.NETWORK_INPUTS:
            first, last = nx100.NETWORK_INPUTS[0], nx100.NETWORK_INPUTS[-1]
            inputs = f"0, or a multiple of 10 from {first} to {last}"
            raise ValueError(f"supervision_input = {self.supervision_input}: must be {inputs}")


@dataclass(frozen=True, slots=True)
class Proposal:
    """What the cell asks: one increment, for one activation.

    Attributes:
        activation_id: Counts up; one activation gives at most one increment.
        direction: Where to.
        t_s: When it was decided, monotonic clock.
        caps: A stop test's: the move is narrowed to them, and the left arm rests. Else None.
    """

    activation_id: int
    direction: Direction
    t_s: float
    caps: Caps | None = None


@dataclass(frozen=True, slots=True)
class GateView:
    """Everything the gate looks at, as it is at this moment.

    Attributes:
        is_armed: The operator's permission.
        latch: The stop that has not been left yet, or None.
        is_stopping: A stop is under way.
        is_releasing: A hold is being released.
        is_moving: A command is open.
        last_activation_id: Of the newest command let through.
        status: Last RSTATS, read at ``status_s``.
        position: Last RPOSC, read at ``position_s``.
        left_s: Receive time of the newest left sample.
        is_left_start: The left arm holds the start posture.
        is_left_stop: The left arm holds the stop posture.
        is_link_open: The controller has taken the session.
        hindrances: What stands against arming and no status shows.
    """

    is_armed: bool
    latch: StopReason | None
    is_stopping: bool
    is_releasing: bool
    is_moving: bool
    last_activation_id: int
    status: RobotStatus | None
    status_s: float
    position: Position | None
    position_s: float
    left_s: float
    is_left_start: bool
    is_left_stop: bool
    is_link_open: bool
    hindrances: tuple[Refusal, ...] = ()


@dataclass(frozen=True, slots=True)
class Permit:
    """A request that may be sent. Made by the gate only."""

    request: Request


@dataclass(frozen=True, slots=True)
class Command:
    """A proposal that was let through.

    Attributes:
        proposal: What was asked.
        plan: What will be done.
        speed: mm/s, or deg/s for a rotation.
        permit: The IMOV that says it.
    """

    proposal: Proposal
    plan: Plan
    speed: float
    permit: Permit

    @property
    def duration_s(self) -> float:
        """Length over speed; acceleration adds to it."""
        return self.plan.length / self.speed


_ALWAYS = frozenset({nx100.READ_STATUS, nx100.READ_ALARMS, nx100.HOLD_ON, nx100.SERVO_OFF})


def permit(request: Request, view: GateView, limits: Limits) -> Permit | Refusal:
    """Let through what is not a move: reads and stops always, the rest only at standstill.

    Of the network inputs only the site's own may be written, and only with 0 or 1.
    """
    if request in _ALWAYS or request.name == "RPOSC":
        return Permit(request)
    supervised = limits.supervision_input
    if supervised and request in (nx100.write_input(supervised, value) for value in (0, 1)):
        return Permit(request)
    if request == nx100.SERVO_ON:
        return servo_blocker(view) or Permit(request)
    if request == nx100.HOLD_OFF:
        if view.is_stopping or view.is_moving:
            return Refusal("stopping", "a hold is released only after standstill was read back")
        return Permit(request)
    return Refusal("not_listed", f"{request.name} is not on the list of what may be sent")


def servo_blocker(view: GateView) -> Refusal | None:
    """What stands against switching servo power at the operator's wish."""
    if not view.is_link_open:
        return Refusal("no_link", "the robot does not answer")
    if view.is_armed or view.is_moving or view.is_stopping:
        return Refusal("armed", "servo power is switched only while disarmed and standing")
    return None


def decide(proposal: Proposal, view: GateView, limits: Limits, now_s: float) -> Command | Refusal:
    """Let a move through, or refuse it with the limit it met."""
    refusal = (
        _foreign_frame(limits)
        or _permission(proposal, view)
        or _freshness(proposal, view, limits, now_s)
        or robot_blocker(view.status)
        or find_foreign_tool(view.position, limits.tool)
        or _not_testable(proposal)
        or _left_arm(proposal, view, limits, now_s)
    )
    if refusal is not None:
        return refusal
    assert view.position is not None
    planned = plan(view.position, proposal.direction, limits.field)
    if isinstance(planned, Refusal):
        return planned
    asked = limits.speed_deg_s if proposal.direction.is_rotation else limits.speed_mm_s
    if (caps := proposal.caps) is not None:
        asked = min(asked, caps.speed_mm_s, TEST_MOST.speed_mm_s)
        longest_mm = min(caps.length_mm, TEST_MOST.length_mm)
        planned = shortened(planned, proposal.direction, longest_mm, "length of a stop test")
    speed = nx100.wire_speed(asked)
    request = nx100.move_increment(planned.increment, speed, limits.frame, limits.tool)
    return Command(proposal, planned, speed, Permit(request))


def arm_blocker(
    view: GateView, limits: Limits, now_s: float, *, ignore_own_hold: bool
) -> Refusal | None:
    """What stands against giving permission.

    Args:
        view: As everything is now.
        limits: Of the site.
        now_s: Monotonic clock.
        ignore_own_hold: A HOLD by command does not count: arming releases it.
    """
    if not view.is_link_open:
        return Refusal("no_link", "the robot does not answer")
    if (foreign := _foreign_frame(limits)) is not None:
        return foreign
    if view.is_stopping or view.is_releasing or view.is_moving:
        return Refusal("busy", "a move or a stop is under way")
    for t_s, text in (
        (view.status_s, "the robot's state"),
        (view.position_s, "the robot's position"),
    ):
        age_s = now_s - t_s
        if not 0 <= age_s <= STATUS_MAX_AGE_S:
            asked, limit = f"{age_s:.2f} s", f"{STATUS_MAX_AGE_S:.2f} s"
            return Refusal("status_age", f"{text} is {asked} old, limit {limit}", asked, limit)
    refusal = robot_blocker(view.status, ignore_own_hold=ignore_own_hold)
    refusal = refusal or next(iter(view.hindrances), None)
    refusal = refusal or _position_blocker(view.position, limits)
    return refusal or _left_silent(view, limits, now_s) or _left_not_stop(view)


def robot_blocker(status: RobotStatus | None, *, ignore_own_hold: bool = False) -> Refusal | None:
    """What in the controller's own state stands against a move."""
    if status is None:
        return Refusal("no_status", "the robot has not told its state yet")
    held_elsewhere = status.is_held_by_pendant or status.is_held_externally
    for is_bad, reason, text in (
        (status.has_alarm, "alarm", "the robot has an alarm: clear it on the pendant"),
        (status.has_error, "error", "the robot has an error: clear it on the pendant"),
        (status.is_teach, "teach", "the pendant is in TEACH: turn its key to REMOTE"),
        (not status.is_remote, "not_remote", "command remote is off: turn the key to REMOTE"),
        (not status.is_play, "not_play", "the robot is not in play mode: select it on the pendant"),
        (not status.is_servo_on, "servo_off", "servo power is off: press Servo on"),
        (held_elsewhere, "held", "the robot is held by the pendant or an input: release it there"),
        (
            status.is_held_by_command and not ignore_own_hold,
            "held",
            "the robot is held by command: arm again",
        ),
        (status.is_running, "running", "the robot is running: wait until it stands"),
    ):
        if is_bad:
            return Refusal(reason, text)
    return None


def find_foreign_tool(position: Position | None, tool: int) -> Refusal | None:
    """Why a position says nothing about our tool: it is the point of another one."""
    if position is None or position.tool == tool:
        return None
    asked, limit = f"tool {position.tool}", f"tool {tool}"
    text = f"the controller tells the position of {asked}, the settings have {limit}"
    return Refusal("foreign_tool", f"{text}: select that tool on the pendant", asked, limit)


def _position_blocker(position: Position | None, limits: Limits) -> Refusal | None:
    if position is None:
        return Refusal("pose_age", "the robot has not told its position yet")
    return find_foreign_tool(position, limits.tool) or find_outside(position, limits.field)


def _foreign_frame(limits: Limits) -> Refusal | None:
    """In a user frame neither the position nor the increment can be held against the field."""
    if limits.frame in ROBOT_FRAMES:
        return None
    text = f"the field of operation is known in the robot's frame only, not in {limits.frame}"
    return Refusal("frame", f"{text}: set frame to 0 or 1", f"frame {limits.frame}", "0 or 1")


def _permission(proposal: Proposal, view: GateView) -> Refusal | None:
    if view.latch is not None:
        return Refusal("latched", f"stopped ({view.latch.value}): arm again first")
    if not view.is_armed:
        return Refusal("not_armed", "the cell is not armed")
    if view.is_stopping or view.is_releasing or view.is_moving:
        return Refusal("busy", "a move or a stop is under way")
    if proposal.activation_id <= view.last_activation_id:
        asked, limit = f"activation {proposal.activation_id}", f"{view.last_activation_id} was used"
        return Refusal("activation_used", "one activation gives one increment", asked, limit)
    return None


def _freshness(proposal: Proposal, view: GateView, limits: Limits, now_s: float) -> Refusal | None:
    ages = (
        ("proposal", proposal.t_s, PROPOSAL_MAX_AGE_S, "the decision came too late"),
        ("status", view.status_s, STATUS_MAX_AGE_S, "the robot's state is too old"),
        ("pose", view.position_s, POSE_MAX_AGE_S, "the robot's position is too old"),
    )
    for name, t_s, limit_s, text in ages:
        age_s = now_s - t_s
        if not 0 <= age_s <= limit_s:
            asked, limit = f"{age_s:.3f} s", f"{limit_s:.3f} s"
            return Refusal(f"{name}_age", f"{text}: {asked}, limit {limit}", asked, limit)
    if view.position is None:
        return Refusal("pose_age", "the robot has not told its position yet")
    return None


def _not_testable(proposal: Proposal) -> Refusal | None:
    """A stop test goes straight, some way, at some speed."""
    caps = proposal.caps
    if caps is None:
        return None
    if proposal.direction.is_rotation:
        return Refusal("stop_test", "a stop test moves straight, it does not turn")
    for value, least, unit in (
        (caps.length_mm, MIN_LENGTH_MM, "mm"),
        (caps.speed_mm_s, LEAST_SPEED_MM_S, "mm/s"),
    ):
        if not value >= least:
            asked, limit = f"{value:g} {unit}", f"{least:g} {unit}"
            text = f"a stop test of {asked} is too little, at least {limit}"
            return Refusal("stop_test", text, asked, limit)
    return None


def _left_arm(proposal: Proposal, view: GateView, limits: Limits, now_s: float) -> Refusal | None:
    if proposal.caps is not None:
        return _left_not_stop(view) or _left_silent(view, limits, now_s)
    if not view.is_left_start:
        return Refusal("left_not_start", "the left arm is not in the start posture")
    return _left_silent(view, limits, now_s)


def _left_not_stop(view: GateView) -> Refusal | None:
    if view.is_left_stop:
        return None
    return Refusal("left_not_stop", "the left arm is not in the stop posture")


def _left_silent(view: GateView, limits: Limits, now_s: float) -> Refusal | None:
    age_s = now_s - view.left_s
    if not -AHEAD_S <= age_s <= limits.trip_level_s:
        asked, limit = f"{age_s:.3f} s", f"{limits.trip_level_s:.3f} s"
        text = f"left sensor silent for {asked}, limit {limit}"
        return Refusal("left_silent", text, asked, limit)
    return None
