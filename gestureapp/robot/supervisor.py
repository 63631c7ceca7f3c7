"""The guardian's mind: permission, latch, watchdogs, the one open command and the stop path. Pure.

Bytes, messages and the time come in; bytes and messages go out. Nothing here waits, and nothing
here can be switched off by the application: limits come once, at the start.

Order of what goes on the wire: the stop path first, then releasing a hold, then a command, then
servo power, then polling. At most one request is in flight, so a stop waits for one answer at the
most.
"""

from gestureapp.robot import messages as m
from gestureapp.robot import nx100
from gestureapp.robot.commands import Commands
from gestureapp.robot.exchange import Answered, Exchange, ExchangeEvent, LinkBroken, Opened
from gestureapp.robot.gate import GateView, Limits, Permit, arm_blocker, permit
from gestureapp.robot.motion import StoppedShort
from gestureapp.robot.nx100 import Alarms, Failure, Request
from gestureapp.robot.outbox import Outbox
from gestureapp.robot.outputs import Output
from gestureapp.robot.permission import Permission
from gestureapp.robot.polling import Pace, Polling
from gestureapp.robot.readings import Readings
from gestureapp.robot.release import Release
from gestureapp.robot.stopping import Standstill, StopPath
from gestureapp.robot.values import Pose, Refusal, RobotStatus, StopReason
from gestureapp.robot.watchdog import (
    Cause,
    find_change,
    find_left_end,
    find_stale,
    find_stall,
    next_look_s,
)

DECIDING_S = 0.3
"""A decision follows the left arm's start within 160 ms; the line is kept free meanwhile."""


class Supervisor:
    """Everything the guardian decides. Owned by the guardian's loop; one thread.

    Every input method and ``tick`` may add outputs; the loop takes them with ``take_outputs``.

    Attributes:
        limits: Given at the start, never changed.
    """

    def __init__(self, limits: Limits) -> None:
        self.limits = limits
        self._permission = Permission()
        self._out = Outbox()
        self._exchange = Exchange()
        self._stop = StopPath()
        self._commands = Commands()
        self._release = Release()
        self._polling = Polling(limits.frame)
        self._servo_wanted = False
        self._beat: m.Beat | None = None
        self._start_seen_s = float("-inf")
        self._read = Readings()
        self._sent_s = 0.0
        self._watched_s = float("inf")

    # What the loop asks.

    @property
    def is_armed(self) -> bool:
        """The operator's permission."""
        return self._permission.is_armed

    @property
    def latch(self) -> StopReason | None:
        """The stop that has not been left yet, or None."""
        return self._permission.latch

    @property
    def is_stopping(self) -> bool:
        """A stop is under way and not confirmed."""
        return self._stop.is_active

    @property
    def is_link_open(self) -> bool:
        """The controller has taken the session."""
        return self._exchange.is_open

    @property
    def may_move(self) -> bool:
        """Armed, or a command is open, or a stop is not confirmed."""
        return self.is_armed or self.has_commanded or self._stop.is_active

    @property
    def has_commanded(self) -> bool:
        """A move was sent and no standstill has been read back since."""
        return self._commands.motion is not None

    def take_outputs(self) -> list[Output]:
        """What has to be done now, oldest first; asked for after every input."""
        return self._out.take()

    def next_due_s(self, now_s: float) -> float:
        """When ``tick`` has something to do at the latest."""
        look_s = next_look_s(self._beat, self.limits, now_s, may_move=self.may_move)
        return min(look_s, self._exchange.deadline_s)

    # Inputs from the robot's side.

    def robot_connected(self, now_s: float) -> None:
        """The socket to the controller is open."""
        self._out.send(self._exchange.connected(now_s))

    def robot_bytes(self, data: bytes, now_s: float) -> None:
        """Bytes from the controller."""
        self._watch(now_s)  # the data of a move may leave now
        events, out = self._exchange.receive(data, now_s)
        self._out.send(out)
        self._handle(events, now_s)
        self.tick(now_s)

    def robot_ended(self, reason: str, now_s: float, remedy: str = "") -> None:
        """The socket was closed or could not be opened; what to do, where that is known."""
        events = self._exchange.end(reason)
        if not events and reason != self._out.link.text:
            self._out.tell_link(False, reason, remedy)
        if not events and self.is_armed:
            self.stop(StopReason.LINK_LOST, reason, now_s)
        self._handle(events, now_s)

    # Inputs from the application's side.

    def greeted(self, now_s: float) -> None:
        """The application has just connected: tell it what is known."""
        self._out.tell(self._out.link)
        self._report_status(now_s)

    def message(self, message: m.Message, now_s: float) -> None:
        """A message from the application."""
        match message:
            case m.Beat():
                self._take_beat(message, now_s)
            case m.Stop():
                self.stop(message.reason, message.text, now_s)
            case m.Propose():
                view = self._view()
                self._out.tell(self._commands.propose(message, view, self.limits, now_s))
            case m.Arm():
                self._ask_arm(now_s)
            case m.Disarm():
                self._disarm(now_s)
            case m.ServoOn():
                self._ask_servo()
        self.tick(now_s)

    def stop(self, reason: StopReason, text: str, now_s: float) -> None:
        """The one place through which every stop goes, whoever asks."""
        self._commands.take_pending()
        self._servo_wanted = False
        self._release.cancel()
        if reason.is_latched:
            self._permission.latch = self.latch or reason
            self._out.tell(self._permission.give_up(text))
        if self._stop.ask(reason, now_s):
            self._out.tell(m.StopAsked(reason, text, now_s))
        if reason.is_latched:  # told after the reason, or the cell would take it for one
            self._out.tell(self._permission.lose())
        if (withdrawn := self._exchange.withdraw()) is not None:
            self._forget_robot(withdrawn.reason)

    def tick(self, now_s: float) -> None:
        """Look at every clock, then use the line if it is free."""
        self._handle(self._exchange.check(now_s), now_s)
        self._watch(now_s)
        self._check_stop(now_s)
        self._check_motion(now_s)
        self._check_release(now_s)
        self._check_arming(now_s)
        if self._exchange.can_send:
            self._send_next(now_s)

    # Permission.

    def _ask_arm(self, now_s: float) -> None:
        refusal = arm_blocker(self._view(), self.limits, now_s, ignore_own_hold=True)
        if refusal is not None:
            self._out.tell(m.ArmRefused(refusal))
            return
        self._permission.ask(now_s)
        if self._read.is_held_by_command:
            self._release.begin()

    def _check_arming(self, now_s: float) -> None:
        if self._permission.is_arming and not self._release.is_active:
            refusal = arm_blocker(self._view(), self.limits, now_s, ignore_own_hold=False)
            self._out.tell(self._permission.settle(refusal, now_s))

    def _disarm(self, now_s: float) -> None:
        if self._commands.is_any:
            self.stop(StopReason.DISARMED, "disarmed while the robot was moving", now_s)
        self._lose_permission("disarmed")

    def _lose_permission(self, text: str) -> None:
        self._release.cancel()
        self._out.tell(self._permission.give_up(text), self._permission.lose())

    def _ask_servo(self) -> None:
        """Now or not at all: servo power never comes on later, when nobody expects it."""
        allowed = permit(nx100.SERVO_ON, self._view())
        if not self._exchange.is_open:
            allowed = Refusal("no_link", "the robot does not answer")
        self._servo_wanted = isinstance(allowed, Permit)
        if isinstance(allowed, Refusal):
            self._out.tell(m.Notice(f"servo power was not switched on: {allowed.text}"))

    # The heartbeat and the watchdogs.

    def _take_beat(self, beat: m.Beat, now_s: float) -> None:
        if beat.is_left_start and not (self._beat and self._beat.is_left_start):
            self._start_seen_s = now_s
        self._beat = beat
        if self.has_commanded and not self._stop.is_active:
            self._stop_for(find_left_end(beat, self.limits), now_s)

    def _watch(self, now_s: float) -> None:
        stalled_s, self._watched_s = now_s - self._watched_s, now_s
        if self._stop.is_active and self._stop.reason is not StopReason.LEFT_ARM:
            return
        if not (self.is_armed or self.has_commanded):
            return
        if self._beat is not None:
            stall = find_stall(stalled_s, self.limits)
            self._stop_for(stall or find_stale(self._beat, self.limits, now_s), now_s)

    def _stop_for(self, cause: Cause | None, now_s: float) -> None:
        if cause is not None:
            self.stop(cause.reason, cause.text, now_s)

    # The wire.

    def _view(self) -> GateView:
        return GateView(
            is_armed=self.is_armed,
            latch=self.latch,
            is_stopping=self._stop.is_active,
            is_releasing=self._release.is_active,
            is_moving=self._commands.is_any,
            last_activation_id=self._commands.last_activation_id,
            status=self._read.status,
            status_s=self._read.status_s,
            pose=self._read.pose,
            pose_s=self._read.pose_s,
            left_s=self._beat.left_s if self._beat else float("-inf"),
            is_left_start=self._beat is not None and self._beat.is_left_start,
            is_left_stop=self._beat is not None and self._beat.is_left_stop,
            is_link_open=self._exchange.is_open,
        )

    def _send_next(self, now_s: float) -> None:
        if self._stop.is_active:
            self._send_if_allowed(self._stop.next_request(now_s, self.limits.frame), now_s)
        elif (request := self._release.next_request(self.limits.frame)) is not None:
            self._send_if_allowed(request, now_s)
        elif (command := self._commands.take_pending()) is not None:
            told = self._commands.begin(command, self._view(), self.limits, now_s)
            if self._commands.motion is not None:
                self._send(self._commands.motion.command.permit, now_s)
            self._out.tell(told)
        elif self._servo_wanted:
            self._servo_wanted = False
            self._send_if_allowed(nx100.SERVO_ON, now_s)
        elif (poll := self._polling.next_request(now_s, self._pace(now_s))) is not None:
            self._send_if_allowed(poll, now_s)

    def _pace(self, now_s: float) -> Pace:
        if self._commands.motion is not None:
            return Pace.ENDING if self._commands.motion.seems_ended else Pace.MOVING
        if self.is_armed and now_s - self._start_seen_s < DECIDING_S:
            return Pace.DECIDING
        if self._release.is_watching(now_s):
            return Pace.WATCHING
        return Pace.ARMED if self.is_armed else Pace.IDLE

    def _send_if_allowed(self, request: Request, now_s: float) -> None:
        allowed = permit(request, self._view())
        if isinstance(allowed, Refusal):
            self._release.cancel()
            self._out.tell(m.Notice(f"{request} was not sent: {allowed.text}"))
            return
        self._send(allowed, now_s)

    def _send(self, allowed: Permit, now_s: float) -> None:
        is_stopping = self._stop.is_active
        self._out.send(self._exchange.send(allowed, now_s, is_stopping=is_stopping))
        self._sent_s = now_s
        self._stop.sent(allowed.request, now_s)

    # What the controller says.

    def _handle(self, events: list[ExchangeEvent], now_s: float) -> None:
        for event in events:
            match event:
                case Opened():
                    self._out.tell_link(True, event.banner)
                    self._polling.restart()
                case Answered():
                    self._answered(event, now_s)
                case LinkBroken():
                    self._link_broken(event, now_s)

    def _answered(self, event: Answered, now_s: float) -> None:
        self._stop.answered(event.request, event.answer, now_s)
        self._release.answered(event.request, event.answer, now_s)
        match event.answer:
            case RobotStatus():
                self._take_status(event.answer, now_s)
            case Pose():
                self._take_pose(event.answer, now_s)
            case Alarms():
                self._read.alarms = event.answer.codes
                self._report_status(now_s)
            case Failure() if event.request.name != "IMOV":
                self._refusal_came(event.request, event.answer.words, now_s)
        if event.request.name == "IMOV":
            self._out.tell(self._commands.answered(event.answer, now_s))
        elif not isinstance(event.answer, Failure):
            self._out.forget_refused(event.request)

    def _refusal_came(self, request: Request, words: str, now_s: float) -> None:
        """Told once until it is taken again; without reads nobody knows what the robot does."""
        text = f"the robot refused {request}: {words}"
        self._out.tell_refused(request, text)
        is_read = request == nx100.READ_STATUS or request.name == "RPOSC"
        if is_read and self.may_move and not self._stop.is_active:
            self.stop(StopReason.ROBOT_CHANGED, text, now_s)

    def _take_status(self, status: RobotStatus, now_s: float) -> None:
        """A robot that changes by itself while it may move is stopped, latched."""
        self._read.status, self._read.status_s = status, now_s
        if not (status.has_alarm or status.has_error):
            self._read.alarms = ()
        elif not self._read.alarms:
            self._polling.want_alarms()
        self._report_status(now_s)
        if self._commands.motion is not None:
            self._commands.motion.note_status(status, self._sent_s)
        if self._stop.is_active:
            return
        change = find_change(
            status,
            is_commanded=self.has_commanded,
            may_move=self.may_move,
            may_resume=self._permission.is_arming or self._release.is_watching(now_s),
        )
        self._stop_for(change, now_s)

    def _take_pose(self, pose: Pose, now_s: float) -> None:
        self._read.pose, self._read.pose_s = pose, now_s
        self._out.tell(m.PoseReport(now_s, pose))
        if self._commands.motion is not None:
            self._commands.motion.note_pose(pose, self._sent_s)

    def _report_status(self, now_s: float) -> None:
        status = self._read.status
        if status is not None:
            alarms = self._read.alarms
            self._out.tell(m.StatusReport(now_s, status.data_1, status.data_2, alarms))

    def _link_broken(self, event: LinkBroken, now_s: float) -> None:
        may_resume = self._release.is_active or self._release.is_watching(now_s)
        self._forget_robot(event.reason)
        if self.is_armed or self.has_commanded or may_resume:
            self.stop(StopReason.LINK_LOST, event.reason, now_s)
        self._lose_permission(event.reason)

    def _forget_robot(self, reason: str) -> None:
        """The session is over: nothing that was read counts any more."""
        self._out.drop(reason)
        self._read = Readings()
        self._servo_wanted = False
        self._stop.link_broken()

    # What the clocks say.

    def _check_stop(self, now_s: float) -> None:
        outcome = self._stop.check(now_s)
        if outcome is None:
            return
        if isinstance(outcome, Standstill):
            self._commands.motion = None
            self._out.tell(m.StopConfirmed(outcome.reason, outcome.took_s, outcome.pose))
        else:
            self._out.tell(m.StopUnconfirmed(outcome.reason, outcome.text))

    def _check_motion(self, now_s: float) -> None:
        if self._stop.is_active:
            return
        outcome = self._commands.check(now_s)
        if isinstance(outcome, StoppedShort):
            self.stop(outcome.reason, outcome.text, now_s)
        else:
            self._out.tell(outcome)

    def _check_release(self, now_s: float) -> None:
        """After the left arm's own stop the hold is released, once that arm is back in stop."""
        if self._release.take_done():
            self._out.tell(m.HoldReleased())
        is_free = not (self._stop.is_active or self.has_commanded) and self._release.may_begin(
            now_s
        )
        is_left_stop = self._beat is not None and self._beat.is_left_stop
        if self.is_armed and is_free and is_left_stop and self._read.is_held_by_command:
            self._release.begin()
