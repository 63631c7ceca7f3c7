"""The emulated NX100's state: modes, holds, servo, alarms, one move at a time. Pure.

Written from the documents, independently of the client, so that a mistake of the
client cannot hide here. Where no document says what a controller does, the docstring names the
choice.
"""

import math
from dataclasses import dataclass, replace

from gestureapp.robot import hp6
from gestureapp.robot.values import Pose
from gestureapp.simulation.nx100_arm import Arm, Travel
from gestureapp.simulation.nx100_motion import Path, Profile, into_frame, normal, trapezoid
from gestureapp.simulation.nx100_values import (
    ALARM_BIT,
    CONTACTS,
    ERROR_BIT,
    LIMIT_ALARM,
    MAX_ALARMS,
    REMOTE,
    RUNNING,
    SERVO_BIT,
    Code,
    ControllerOptions,
    Cycle,
    EndReason,
    Hold,
    Mode,
    MotionEnded,
    MotionEvent,
    MotionStarted,
    Move,
)
from gestureapp.simulation.nx100_variables import Variables

_NOTHING_LEFT = 1e-9
"""Fraction of a path below which a hold has left nothing to go on with."""


@dataclass(frozen=True, slots=True)
class _Motion:
    """A move under way; rates in fractions of its path."""

    travel: Travel
    rate: float
    accel: float
    profile: Profile
    limit_s: float = math.inf
    has_started: bool = False
    stop_reason: EndReason = EndReason.DONE

    @property
    def end_s(self) -> float:
        return min(self.profile.end_s, self.limit_s)

    @property
    def path(self) -> Path:
        return self.travel.path

    @property
    def limit(self) -> float:
        return self.travel.limit

    def with_profile(self, profile: Profile, reason: EndReason) -> "_Motion":
        limit_s = profile.time_of(self.limit) if self.limit <= profile.final else math.inf
        return replace(self, profile=profile, limit_s=limit_s, stop_reason=reason)


@dataclass(frozen=True, slots=True)
class _Rest:
    """What a hold left of a move: where on its path the arm stands."""

    motion: _Motion
    fraction: float


class Controller:
    """The controller's state; its owner calls it from one thread with a time that never goes back.

    Attributes:
        options: What the emulated cell is like.
        is_servo_on: Servo power.
        is_remote: Command remote is selected.
        mode: Key position.
        cycle: How a job would go on; nothing here has jobs.
        variables: What LOADV has written.
        holds: Who holds the robot.
        alarms: Code and data of up to four alarms, oldest first.
        error: Code and data of the present error, or None.
        inputs: Network inputs as written: byte by the address of its bit 0.
    """

    def __init__(self, options: ControllerOptions, now_s: float) -> None:
        self.options = options
        self.is_servo_on = True
        self.is_remote = True
        self.mode = Mode.PLAY
        self.cycle = Cycle.ONE
        self.variables = Variables()
        self.holds = Hold.NONE
        self.alarms: list[tuple[int, int]] = []
        self.error: tuple[int, int] | None = None
        self.inputs: dict[int, int] = {}
        self._arm = Arm(options.tool_mm, options.joint_ranges_deg)
        self._pose = normal(options.start_pose)
        self._joints = hp6.joints_deg(self._pose, options.tool_mm, options.start_posture)
        self._motion: _Motion | None = None
        self._rest: _Rest | None = None
        self._servo_on_s = math.inf
        self._ladder_trip_s = math.inf
        self._has_ladder_tripped = False
        self._events: list[MotionEvent] = []
        self._now_s = now_s

    # Reading

    def advance(self, now_s: float) -> None:
        """Let everything happen that is due, in the order of its own times."""
        while (due_s := self.next_event_s) <= now_s:
            self._happen(due_s)
        self._now_s = max(self._now_s, now_s)

    @property
    def next_event_s(self) -> float:
        """When something happens by itself next; infinity when nothing is under way."""
        motion_s = math.inf
        if self._motion is not None:
            motion_s = self._motion.profile.start_s
            if self._motion.has_started:
                motion_s = self._motion.end_s
        return min(motion_s, self._servo_on_s, self._ladder_trip_s)

    def take_events(self) -> list[MotionEvent]:
        """Give the starts and ends of motion since the last call."""
        events, self._events = self._events, []
        return events

    def pose(self, now_s: float) -> Pose:
        """Give the tool pose in the robot frame, angles in (-180, 180] degrees."""
        self.advance(now_s)
        if self._motion is None:
            return self._pose
        return normal(self._motion.path.pose_at(self._motion.profile.fraction_at(now_s)))

    def joints(self, now_s: float) -> hp6.Joints:
        """Give S, L, U, R, B, T in degrees."""
        self.advance(now_s)
        if self._motion is None:
            return self._joints
        return self._motion.travel.joints_at(self._motion.profile.fraction_at(now_s))

    def pose_in(self, frame: int, now_s: float) -> Pose | Code:
        """Give the tool pose in frame 0 (base), 1 (robot) or 2 to 25 (user 1 to 24)."""
        pose = self.pose(now_s)
        if frame in (0, 1):
            return pose
        if not 2 <= frame <= 25:
            return Code.OPERAND_VALUE
        user = self.options.user_frames.get(frame - 1)
        return Code.USER_FRAME if user is None else normal(into_frame(user, pose))

    def is_running(self, now_s: float) -> bool:
        """Whether the arm moves: the running bit."""
        self.advance(now_s)
        return self._motion is not None and self._motion.has_started

    def status(self, now_s: float) -> tuple[int, int]:
        """Give the two bytes of RSTATS. Source: data transmission manual p. 76."""
        running = RUNNING if self.is_running(now_s) else 0
        remote = REMOTE if self.is_remote else 0
        alarm = ALARM_BIT if self.alarms else 0
        error = ERROR_BIT if self.error is not None else 0
        servo = SERVO_BIT if self.is_servo_on else 0
        return (
            self.cycle.value | running | self.mode.value | remote,
            int(self.holds) | alarm | error | servo,
        )

    # Over the network

    def move(self, move: Move, now_s: float) -> Code:
        """Accept or refuse an increment. Accepted is not finished; nothing ever queues.

        Note:
            The order in which several reasons are looked at is ours: remote, mode, alarm, hold,
            servo, moving.
        """
        self.advance(now_s)
        code = self._readiness()
        if code is not Code.OK:
            return code
        path = self._path(move, now_s)
        if isinstance(path, Code):
            return path
        if not (any(move.increment.translation_mm) or move.increment.is_rotation):
            return Code.OK
        rate, accel = self._rates(move)
        travel = Travel.of(path, self._arm, self._joints)
        profile = trapezoid(now_s + self.options.start_delay_s, 0.0, rate, accel)
        motion = _Motion(travel, rate, accel, profile)
        self._motion = motion.with_profile(profile, EndReason.DONE)
        return Code.OK

    def command_hold(self, is_on: bool, now_s: float) -> Code:
        """HOLD: a decelerated stop on the path, servo stays on; or its release."""
        self.set_hold(Hold.COMMAND, is_on, now_s)
        return Code.OK

    def command_servo(self, is_on: bool, now_s: float) -> Code:
        """SVON: power on after the delay of the options, or off at once with the brakes."""
        self.advance(now_s)
        if is_on and self.mode is not Mode.PLAY:
            return Code.MODE
        if is_on and self.alarms:
            return Code.ALARM
        if not is_on:
            self.set_servo(False, now_s)
        elif not self.is_servo_on:
            self._servo_on_s = now_s + self.options.servo_on_delay_s
            self.advance(now_s)
        return Code.OK

    def reset(self, now_s: float) -> Code:
        """RESET: clear the alarms. Servo power stays off until SVON."""
        self.advance(now_s)
        self.alarms.clear()
        return Code.OK

    def cancel(self, now_s: float) -> Code:
        """CANCEL: clear the error."""
        self.advance(now_s)
        self.error = None
        return Code.OK

    def write_inputs(self, first: int, values: list[int], now_s: float) -> Code:
        """IOWRITE: set network inputs, one byte per eight contacts; the next byte is 10 higher."""
        self.advance(now_s)
        addresses = [first + 10 * i for i in range(len(values))]
        if any(address not in CONTACTS or address + 7 not in CONTACTS for address in addresses):
            return Code.NO_ACCESS
        before = self.inputs.get(CONTACTS.start, 0)
        self.inputs.update(zip(addresses, values, strict=True))
        if (before ^ self.inputs.get(CONTACTS.start, 0)) & 1 and self.options.ladder_s is not None:
            self._ladder_trip_s = now_s + self.options.ladder_s
            if self._has_ladder_tripped:
                self._has_ladder_tripped = False
                self.set_hold(Hold.EXTERNAL, False, now_s)
        return Code.OK

    # At the pendant and in the cell

    def set_hold(self, who: Hold, is_on: bool, now_s: float) -> None:
        """Hold or release. The last release discards the rest of the move, or goes on with it."""
        self.advance(now_s)
        self.holds = self.holds | who if is_on else self.holds & ~who
        if is_on:
            self._slow_down(EndReason.HOLD, now_s)
        elif not self.holds and self._motion is None:
            self._go_on(now_s)

    def set_servo(self, is_on: bool, now_s: float) -> None:
        """Switch servo power. Off while moving: brakes, the arm stands where it is."""
        self.advance(now_s)
        self._servo_on_s = math.inf
        self.is_servo_on = is_on
        if not is_on:
            self._end(EndReason.SERVO_OFF, now_s)

    def set_remote(self, is_on: bool, now_s: float) -> None:
        """Select command remote or not. A move under way goes on (not documented)."""
        self.advance(now_s)
        self.is_remote = is_on

    def set_mode(self, mode: Mode, now_s: float) -> None:
        """Turn the key. Leaving play slows a move down to a stand and discards its rest."""
        self.advance(now_s)
        self.mode = mode
        if mode is not Mode.PLAY:
            self._rest = None
            self._slow_down(EndReason.MODE, now_s)

    def set_pose(self, pose: Pose, now_s: float) -> bool:
        """Put the arm elsewhere, as by jogging; not while a move is under way."""
        self.advance(now_s)
        if self._motion is not None:
            return False
        self._pose, self._rest = normal(pose), None
        self._joints = self._arm.joints_at(self._pose, self._joints)
        return True

    def raise_alarm(self, code: int, data: int, now_s: float) -> None:
        """Raise an alarm: servo power drops, the arm stands at once."""
        self.advance(now_s)
        self._alarm(code, data, now_s)

    def raise_error(self, code: int, data: int, now_s: float) -> None:
        """Show an error: moves are refused until CANCEL, servo stays on."""
        self.advance(now_s)
        self.error = (code, data)

    # Within

    def _readiness(self) -> Code:
        reasons = (
            (not self.is_remote, Code.NOT_REMOTE),
            (self.mode is not Mode.PLAY, Code.MODE),
            (bool(self.alarms) or self.error is not None, Code.ALARM),
            (Hold.COMMAND in self.holds, Code.COMMAND_HOLD),
            (Hold.EXTERNAL in self.holds, Code.EXTERNAL_HOLD),
            (Hold.PENDANT in self.holds, Code.PENDANT_HOLD),
            (not self.is_servo_on, Code.SERVO_OFF),
            (self._motion is not None, Code.MOVING),
        )
        return next((code for is_so, code in reasons if is_so), Code.OK)

    def _path(self, move: Move, now_s: float) -> Path | Code:
        start = self.pose_in(move.frame, now_s)
        if isinstance(start, Code):
            return Code.DATA_RANGE if start is Code.OPERAND_VALUE else start
        frame = self.options.user_frames[move.frame - 1] if move.frame > 1 else None
        return Path(frame, start, move.increment)

    def _rates(self, move: Move) -> tuple[float, float]:
        """Give speed and acceleration in fractions of the path: the slower of arm and wrist."""
        options, by_turning = self.options, move.speed_class == 1
        length_mm = math.hypot(*move.increment.translation_mm)
        turn_deg = math.hypot(*move.increment.rotation_deg)
        speed_mm_s = options.max_speed_mm_s if by_turning else move.speed
        speed_deg_s = move.speed if by_turning else options.max_speed_deg_s
        limits = []
        if length_mm > 0.0:
            limits.append((speed_mm_s / length_mm, options.accel_mm_s2 / length_mm))
        if turn_deg > 0.0:
            limits.append((speed_deg_s / turn_deg, options.accel_deg_s2 / turn_deg))
        return min(rate for rate, _ in limits), min(accel for _, accel in limits)

    def _happen(self, due_s: float) -> None:
        self._now_s = max(self._now_s, due_s)
        if due_s == self._ladder_trip_s:
            self._ladder_trip_s, self._has_ladder_tripped = math.inf, True
            self.holds |= Hold.EXTERNAL
            self._slow_down(EndReason.HOLD, due_s)
        elif due_s == self._servo_on_s:
            self._servo_on_s = math.inf
            self.is_servo_on = True
        elif self._motion is not None and not self._motion.has_started:
            self._motion = replace(self._motion, has_started=True)
            self._events.append(MotionStarted(due_s, self._pose))
        elif self._motion is not None and self._motion.limit_s <= due_s:
            self._alarm(LIMIT_ALARM, 0, due_s)
        elif self._motion is not None:
            self._end(self._motion.stop_reason, due_s)

    def _slow_down(self, reason: EndReason, now_s: float) -> None:
        motion = self._motion
        if motion is None:
            return
        if not motion.has_started:
            self._motion = None
            if reason is EndReason.HOLD:
                self._rest = _Rest(motion, motion.profile.begin)
        elif motion.stop_reason is EndReason.DONE:
            profile = motion.profile.stopped(now_s, motion.accel)
            self._motion = motion.with_profile(profile, reason)
        elif reason is EndReason.MODE:
            self._motion = replace(motion, stop_reason=reason)

    def _end(self, reason: EndReason, now_s: float) -> None:
        motion, self._motion = self._motion, None
        self._rest = None
        if motion is None:
            return
        reached = min(motion.profile.fraction_at(now_s), motion.limit)
        if reason is EndReason.HOLD:
            self._rest = _Rest(motion, reached)
        self._pose = normal(motion.path.pose_at(reached))
        self._joints = motion.travel.joints_at(reached)
        if motion.has_started:
            self._events.append(MotionEnded(now_s, self._pose, reason))
        if reason is EndReason.HOLD and not self.holds:
            self._go_on(now_s)

    def _alarm(self, code: int, data: int, now_s: float) -> None:
        if len(self.alarms) < MAX_ALARMS:
            self.alarms.append((code, data))
        self.is_servo_on, self._servo_on_s = False, math.inf
        self._end(EndReason.ALARM, now_s)

    def _go_on(self, now_s: float) -> None:
        rest, self._rest = self._rest, None
        is_ready = self.is_servo_on and not self.alarms and self.mode is Mode.PLAY
        if rest is None or not self.options.resumes_after_hold or not is_ready:
            return
        if rest.fraction < 1.0 - _NOTHING_LEFT:
            move, start_s = rest.motion, now_s + self.options.start_delay_s
            profile = trapezoid(start_s, rest.fraction, move.rate, move.accel)
            resumed = replace(move, has_started=False)
            self._motion = resumed.with_profile(profile, EndReason.DONE)
