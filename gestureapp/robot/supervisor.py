"""The guardian's mind: permission, latch, watchdogs, the one open command and the stop path. Pure.

Bytes, messages and the time come in; bytes and messages go out. Nothing here waits, and nothing
here can be switched off by the application: limits come once, at the start.

Order of what goes on the wire: the stop path first, then releasing a hold, then a command, then
servo power, then the supervised input, then polling; see ``heartbeat`` for when that input is so
late that it goes before. At most one request is in flight, so a stop waits for one answer at the
most.
"""

from gestureapp.robot import messages as m
from gestureapp.robot import nx100
from gestureapp.robot.beats import Beats
from gestureapp.robot.commands import Commands
from gestureapp.robot.exchange import Answered, Exchange, ExchangeEvent, LinkBroken, Opened
from gestureapp.robot.gate import GateView, Limits, Permit, arm_blocker, permit, servo_blocker
from gestureapp.robot.heartbeat import Heartbeat
from gestureapp.robot.leftover import KeptMoves, Leftover
from gestureapp.robot.motion import StoppedShort
from gestureapp.robot.nx100 import Alarms, Failure, Request
from gestureapp.robot.outbox import Outbox
from gestureapp.robot.outputs import Output
from gestureapp.robot.permission import Permission, ServoWish
from gestureapp.robot.polling import Pace, Polling
from gestureapp.robot.readings import Readings
from gestureapp.robot.release import Release
from gestureapp.robot.stopping import Standstill, StopPath
from gestureapp.robot.values import Position, Refusal, RobotStatus, StopReason
from gestureapp.robot.watchdog import Cause, find_change


class Supervisor:
    """Everything the guardian decides. Owned by the guardian's loop; one thread.

    Every input method and ``tick`` may add outputs; the loop takes them with ``take_outputs``.

    Attributes:
        limits: Given at the start, never changed.
    """

    def __init__(self, limits: Limits, kept: KeptMoves | None = None) -> None:
        self.limits = limits
        self._permission = Permission()
        self._out = Outbox()
        self._exchange = Exchange()
        self._stop = StopPath()
        self._commands = Commands()
        self._release = Release()
        self._polling = Polling(limits.frame)
        self._heartbeat = Heartbeat(limits.supervision_input, limits.supervision_hz)
        self._leftover = Leftover(kept or KeptMoves())
        self._servo = ServoWish()
        self._beats = Beats(limits)
        self._read = Readings()
        self._sent_s = 0.0

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
        look_s = self._beats.next_look_s(now_s, may_move=self.may_move)
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
        self._out.tell(self._out.link, m.Hindrances(self._out.hindrances))
        self._out.tell(self._read.report(now_s))

    def message(self, message: m.Message, now_s: float) -> None:
        """A message from the application."""
        match message:
            case m.Beat():
                self._take_beat(message, now_s)
            case m.Stop():
                self.stop(message.reason, message.text, now_s)
            case m.Propose():
                self._out.tell(self._commands.propose(message, self._view(), self.limits, now_s))
            case m.Arm():
                self._ask_arm(now_s)
            case m.Disarm():
                self._disarm(now_s)
            case m.ServoOn():
                self._out.tell(self._servo.ask(nx100.SERVO_ON, servo_blocker(self._view())))
            case m.ServoOff():
                self._out.tell(self._servo.ask(nx100.SERVO_OFF, servo_blocker(self._view())))
        self.tick(now_s)

    def stop(self, reason: StopReason, text: str, now_s: float) -> None:
        """The one place through which every stop goes, whoever asks."""
        self._commands.take_pending()
        self._servo.cancel()
        self._release.cancel()
        if reason.is_latched:
            self._permission.latch = self.latch or reason
            self._out.tell(self._permission.give_up(text))
        if self._stop.ask(reason, now_s):
            self._out.tell(m.StopAsked(reason, text, now_s))
        if reason.is_latched:  # told after the reason, or the cell would take it for one
            self._out.tell(self._permission.lose())
        if (withdrawn := self._exchange.withdraw()) is not None:
            self._forget_robot(withdrawn, now_s)

    def tick(self, now_s: float) -> None:
        """Look at every clock, then use the line if it is free."""
        self._watch(now_s)  # before the line: after a sleep its answer is overdue as well
        self._handle(self._exchange.check(now_s), now_s)
        self._check_stop(now_s)
        self._check_motion(now_s)
        self._check_release(now_s)
        self._check_arming(now_s)
        self._out.tell_hindrances(self._leftover.refusal, self._heartbeat.find_trouble(now_s))
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

    # The heartbeat and the watchdogs.

    def _take_beat(self, beat: m.Beat, now_s: float) -> None:
        self._beats.take(beat, now_s)
        if self.has_commanded and not self._stop.is_active:
            self._stop_for(self._beats.find_left_end(is_test=self._commands.is_test), now_s)

    def _watch(self, now_s: float) -> None:
        self._beats.watched(now_s)
        if self._stop.is_active and self._stop.reason is not StopReason.LEFT_ARM:
            return
        if self.is_armed or self.has_commanded:
            self._stop_for(self._beats.find_stale(now_s), now_s)

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
            position=self._read.position,
            position_s=self._read.position_s,
            left_s=self._beats.left_s,
            is_left_start=self._beats.is_left_start,
            is_left_stop=self._beats.is_left_stop,
            is_link_open=self._exchange.is_open,
            hindrances=self._out.hindrances,
        )

    def _send_next(self, now_s: float) -> None:
        if (toggle := self._toggle(now_s)) is not None:
            self._send_if_allowed(toggle, now_s)
        elif self._stop.is_active:
            self._send_if_allowed(self._stop.next_request(now_s, self.limits.frame), now_s)
        elif (request := self._release.next_request(self.limits.frame)) is not None:
            self._send_if_allowed(request, now_s)
        elif (command := self._commands.take_pending()) is not None:
            told = self._commands.begin(command, self._view(), self.limits, now_s)
            if self._commands.motion is not None:
                self._send(self._commands.motion.command.permit, now_s)
            self._out.tell(told)
        elif (request := self._servo.take()) is not None:
            self._send_if_allowed(request, now_s)
        elif (poll := self._polling.next_request(now_s, self._pace(now_s))) is not None:
            self._send_if_allowed(poll, now_s)

    def _toggle(self, now_s: float) -> Request | None:
        """The supervised input, if its time has come: never before a command or servo power."""
        if self._commands.pending is not None or self._servo.request is not None:
            return None
        status = self._read.status
        return self._heartbeat.next_request(now_s, self._beats, self._stop, self._release, status)

    def _pace(self, now_s: float) -> Pace:
        if self._commands.motion is not None:
            return Pace.ENDING if self._commands.motion.seems_ended else Pace.MOVING
        if self.is_armed and self._beats.is_deciding(now_s):
            return Pace.DECIDING
        if self._release.is_watching(now_s):
            return Pace.WATCHING
        return Pace.ARMED if self.is_armed else Pace.IDLE

    def _send_if_allowed(self, request: Request, now_s: float) -> None:
        allowed = permit(request, self._view(), self.limits)
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
        for part in (self._stop, self._release, self._heartbeat):
            part.answered(event.request, event.answer, now_s)
        match event.answer:
            case RobotStatus():
                self._take_status(event.answer, now_s)
            case Position():
                self._take_position(event.answer, now_s)
            case Alarms():
                self._read.alarms = event.answer.codes
                self._out.tell(self._read.report(now_s))
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
        is_needed = request.name in ("RSTATS", "RPOSC", "IOWRITE")
        if is_needed and self.may_move and not self._stop.is_active:
            self.stop(StopReason.ROBOT_CHANGED, text, now_s)

    def _take_status(self, status: RobotStatus, now_s: float) -> None:
        """A robot that changes by itself while it may move is stopped, latched."""
        self._read.take_status(status, now_s)
        if self._read.wants_alarms:
            self._polling.want_alarms()
        self._out.tell(self._read.report(now_s))
        self._leftover.note_status(status)
        if self._commands.motion is not None:
            self._commands.motion.note_status(status, self._sent_s)
        if self._stop.is_active:
            return
        is_released = self._release.may_resume(now_s)
        change = find_change(
            status,
            is_commanded=self.has_commanded,
            may_move=self.may_move,
            may_resume=self._permission.is_arming or is_released,
        )
        if is_released and change is not None and change.reason is StopReason.UNEXPECTED_MOTION:
            self._leftover.went_on()
        self._stop_for(change, now_s)

    def _take_position(self, position: Position, now_s: float) -> None:
        if self._read.take_position(position, now_s) and not self.has_commanded:
            self._polling.want_status()
        self._out.tell(m.PoseReport(now_s, position))
        if self._commands.motion is not None:
            self._commands.motion.note_pose(position.pose, self._sent_s)

    def _link_broken(self, event: LinkBroken, now_s: float) -> None:
        may_resume = self._release.may_resume(now_s)
        self._forget_robot(event, now_s)
        if self.is_armed or self.has_commanded or may_resume:
            self.stop(StopReason.LINK_LOST, event.reason, now_s)
        self._lose_permission(event.reason)

    def _forget_robot(self, event: LinkBroken, now_s: float) -> None:
        """The session is over: nothing that was read counts any more."""
        self._out.drop(event.reason)
        self._heartbeat.link_broken(event.request, event.reason, now_s)
        self._read = Readings()
        self._servo.cancel()
        self._stop.link_broken()

    # What the clocks say.

    def _check_stop(self, now_s: float) -> None:
        outcome = self._stop.check(now_s)
        if isinstance(outcome, Standstill):
            if self.has_commanded:
                self._leftover.interrupted()
            if self._leftover.is_kept:  # told before: it does not go on by itself
                self._out.tell(self._permission.lose())
            self._commands.motion = None
            self._out.tell(m.StopConfirmed(outcome.reason, outcome.took_s, outcome.pose))
        elif outcome is not None:
            self._out.tell(m.StopUnconfirmed(outcome.reason, outcome.text))

    def _check_motion(self, now_s: float) -> None:
        if self._stop.is_active:
            return
        was_test, outcome = self._commands.is_test, self._commands.check(now_s)
        if isinstance(outcome, StoppedShort):
            return self.stop(outcome.reason, outcome.text, now_s)
        self._out.tell(outcome)
        if was_test and outcome is not None:  # it leaves nobody armed
            self._lose_permission("the stop test has ended")

    def _check_release(self, now_s: float) -> None:
        """After the left arm's own stop the hold is released, once that arm is back in stop."""
        if self._release.take_done():
            self._out.tell(m.HoldReleased())
        is_wanted = self.is_armed and self._beats.is_left_stop and self._read.is_held_by_command
        is_busy = self._stop.is_active or self.has_commanded
        if is_wanted and not is_busy and self._release.may_begin(now_s):
            self._release.begin()
