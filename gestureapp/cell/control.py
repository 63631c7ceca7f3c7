"""The control thread's work: samples, messages and presses in, machine steps and their effects out.

``handle`` and ``tick`` do all of it and take the time as an argument, so that tests drive them
without a thread; ``run`` is the thread. Nothing here waits for window, disk or training.
"""

import queue
import threading
from collections.abc import Callable, Mapping

from gestureapp.cell import events as e
from gestureapp.cell.adjustments import Adjustments, Taken, address_of
from gestureapp.cell.arms import Arms
from gestureapp.cell.ear import Ear, ModelInUse
from gestureapp.cell.guardian_keeper import GuardianKeeper
from gestureapp.cell.inputs import (
    GuardianPort,
    GuardianSaid,
    Input,
    ModelChosen,
    ReaderPort,
    SampleCame,
    SensorJudged,
    SensorTold,
    ServoAsked,
    SetupInput,
)
from gestureapp.cell.limits import field_of
from gestureapp.cell.machine import step
from gestureapp.cell.machine_state import MachineState, rules_of
from gestureapp.cell.readiness import Facts, find_blockers
from gestureapp.cell.records import Record, Recorder, Topic, fields_of
from gestureapp.cell.robot_memory import (
    RobotMemory,
    direction_of,
    events_of,
    robot_fields,
    with_cause,
)
from gestureapp.cell.snapshot import Blocker, CellState, RecordingView, Snapshot
from gestureapp.cell.stop_test import TEST_CAPS, StopTests
from gestureapp.cell.story import Story
from gestureapp.cell.words import sentence
from gestureapp.clock import Clock
from gestureapp.config import Settings, SiteSettings
from gestureapp.robot import messages as m
from gestureapp.robot.leftover import KeptMoves
from gestureapp.robot.values import StopReason
from gestureapp.sensing.values import ArmPosture, Sample, Side

TICK_S = 0.01
"""The control thread's own clock; also the longest time between two heartbeats."""
JUDGE_S = 0.05
"""How often readiness is judged."""


class Control:
    """Drives the cell machine. Belongs to the control thread, but for ``put`` and ``picture``.

    Args:
        settings: Of the cell, at first.
        model: What gestures are recognised with at first.
        start_guardian: Starts a guardian with the limits of these settings; raises GuardianLost.
        readers: Of both sensors.
        gui_seen_s: When the window's timer last ran.
        record: Takes everything that happens.
        clock: Monotonic seconds.
        wall_clock: Seconds since the epoch, for people.

    Attributes:
        state: The machine's.
        adjusted: Settings and postures in use, and what setting up still waits to change.
        picture: The newest snapshot; any thread.
        at_rest: Set while nothing may move; any thread may wait for it.
    """

    def __init__(
        self,
        settings: Settings,
        model: ModelInUse,
        start_guardian: Callable[[Settings, KeptMoves], GuardianPort],
        readers: Mapping[Side, ReaderPort],
        gui_seen_s: Callable[[], float],
        record: Recorder,
        clock: Clock,
        wall_clock: Clock,
    ) -> None:
        self.adjusted = Adjustments(settings, readers, record)
        self._ear = Ear(model, record)
        self._gui_seen_s, self._record, self._clock = gui_seen_s, record, clock
        self._field, self._rules = field_of(settings), rules_of(settings)
        self._inbox: queue.SimpleQueue[Input] = queue.SimpleQueue()
        self._arms = Arms(settings.site)
        self._robot = RobotMemory(settings.robot)
        self._guardian = GuardianKeeper(
            lambda kept: start_guardian(self.adjusted.settings, kept), address_of(settings.robot)
        )
        self._story, self._stop_tests = Story(record, wall_clock), StopTests(wall_clock)
        self._judged_s = float("-inf")
        self._now_s = self._ticked_s = clock()
        self.n_overruns = 0
        self.state = MachineState(since_s=self._now_s)
        self.at_rest = threading.Event()
        self.at_rest.set()
        self.picture = self._take_picture()

    def put(self, item: Input) -> None:
        """Hand something to the control thread. Any thread; never blocks."""
        self._inbox.put(item)

    def run(self, stopping: threading.Event) -> None:
        """The thread: everything in the order it came, and a tick every 10 ms, never caught up."""
        due_s = self._clock() + TICK_S
        while not stopping.is_set():
            try:
                item = self._inbox.get(timeout=max(0.0, due_s - self._clock()))
            except queue.Empty:
                pass
            else:
                self.handle(item, self._clock())
            now_s = self._clock()
            if now_s >= due_s:
                self.tick(now_s)
                self.n_overruns += now_s - due_s > TICK_S
                due_s = max(due_s + TICK_S, now_s)

    def handle(self, item: Input, now_s: float) -> None:
        """Take one input."""
        self._now_s = now_s
        match item:
            case SampleCame(side=Side.LEFT):
                self._left_sample(item.sample)
            case SampleCame():
                self._right_sample(item.sample)
            case SensorTold():
                self._arms.told(item)
            case GuardianSaid():
                self._guardian_said(item.message)
            case ServoAsked():
                self._send(m.ServoOn() if item.is_on else m.ServoOff())
            case e.GuardianGone():
                self._guardian_gone(item)
            case ModelChosen():
                self._ear.choose(item.model)
            case _ if isinstance(item, SetupInput):
                self._adjust(item)
            case e.Say():
                self._say(item)
            case _:
                self._step(item)

    def tick(self, now_s: float) -> None:
        """Look at the clocks; say that we are alive; give the window a new picture."""
        self._now_s = now_s
        if stall := self._own_stall():
            self._step(e.Stalled(now_s, stall))
        self._ticked_s = now_s
        self._check_guardian()
        self._keep_guardian()
        self._check_streams()
        if (late := self._ear.check(now_s)) is not None:
            self._step(late)
        self._take_choices()
        self._step(e.Ticked(now_s, self._blockers()))
        self._beat()
        self.picture = self._take_picture()

    @property
    def _site(self) -> SiteSettings:
        return self.adjusted.settings.site

    def _own_stall(self) -> str:
        """A process that was kept from running has heard no sensor: that is not the sensor's."""
        stalled_s, limit_s = self._now_s - self._ticked_s, self._site.trip_level_s
        if stalled_s <= limit_s:
            return ""
        words = StopReason.APPLICATION_STALLED.value
        return f"{words} for {stalled_s * 1000:.0f} ms, limit {limit_s * 1000:.0f} ms"

    # Sensors.

    def _left_sample(self, sample: Sample) -> None:
        if (changed := self._arms.left(sample)) is not None:
            self._step(changed)
        self._beat()

    def _right_sample(self, sample: Sample) -> None:
        self._arms.right(sample)
        if (answer := self._ear.feed(sample, self._now_s)) is not None:
            self._step(answer)

    def _check_streams(self) -> None:
        if (forgotten := self._arms.forget_posture(self._now_s)) is not None:
            self._step(forgotten)
        if self.state.state in (CellState.ARMED, CellState.ACTIVATED, CellState.MOVING):
            for lost in self._arms.lost(self._now_s):
                self._step(lost)

    # Setting up and training.

    def _adjust(self, item: SetupInput) -> None:
        """What takes the permission takes it at once; what moves is stopped as by Disarm."""
        if self.adjusted.note(item, self._now_s):
            self._step(e.DisarmPressed(self._now_s))
        if isinstance(item, SensorJudged):
            self._arms.note_judged(item.side, self._now_s)
        self._take_choices()
        self._judge_again()

    def _take_choices(self) -> None:
        """What was chosen is taken while nothing may move."""
        if not self.state.is_at_rest or self.state.is_arming:
            return
        if (taken := self.adjusted.take(self._now_s)) is not None:
            self._refit(taken)
            self._judge_again()
        if (model := self._ear.take_choice()) is not None:
            self._say(e.Say(f"model: {model.problem or model.words}"))
            self._judge_again()

    def _refit(self, taken: Taken) -> None:
        """Work with other settings; a guardian has its limits for good, so it is another one."""
        settings = self.adjusted.settings
        self._arms.use(settings.site, self.adjusted.postures, taken.sensors)
        if self.state.posture is not ArmPosture.NEITHER:
            self._step(e.LeftPosture(self._now_s, ArmPosture.NEITHER))
        self._field, self._rules = field_of(settings), rules_of(settings)
        if taken.is_guardian_concerned:
            self._robot = RobotMemory(settings.robot)
            self._guardian.renew(self._now_s, address_of(settings.robot))
        if taken.is_other_robot:
            self._stop_tests.forget()
        if taken.has_settings:
            self._say(e.Say("other settings are in use"))

    def _judge_again(self) -> None:
        self._judged_s = float("-inf")
        self._step(e.Ticked(self._now_s, self._blockers()))

    # The guardian.

    def _keep_guardian(self) -> None:
        if trouble := self._guardian.keep(self._now_s):
            self._say(e.Say(trouble, is_alarm=True))
        if self._guardian.trouble:
            self._robot.note(m.LinkReport(False, self._guardian.trouble))

    def _check_guardian(self) -> None:
        """One that says nothing where it must is gone for us: frozen, or its line is stuck."""
        s = self.state
        is_awaited = not s.is_at_rest and not s.is_stop_unconfirmed
        if self._guardian.is_silent() and is_awaited:
            text = "the guardian process is silent; a new one holds the robot first"
            self._guardian_gone(e.GuardianGone(self._now_s, text))

    def _guardian_gone(self, gone: e.GuardianGone) -> None:
        self._guardian.forget()
        self._robot.note(m.LinkReport(False, gone.text))
        self._step(gone)

    def _guardian_said(self, message: m.FromGuardian) -> None:
        self._guardian.heard(message)
        self._robot.note(message)
        self._stop_tests.guardian_said(message, self.state)
        if isinstance(message, m.StatusReport | m.PoseReport):
            self._record(Record(Topic.ROBOT, message.t_s, robot_fields(message)))
        elif not isinstance(message, m.Alive):
            self._record(Record(Topic.COMMAND, self._now_s, fields_of(message)))
        if isinstance(message, m.Notice):
            self._say(e.Say(message.text))
        left = self._arms.health(Side.LEFT, self._now_s)
        for event in events_of(message, self._now_s):
            self._step(with_cause(event, self._own_stall(), left))

    def _beat(self) -> None:
        if not self._guardian.is_there:
            return
        posture = self._arms.posture
        self._guardian.send(
            m.Beat(
                left_s=self._arms.last_left_s(self._now_s),
                is_left_start=posture is ArmPosture.START,
                is_left_stop=posture is ArmPosture.STOP,
                control_s=self._now_s,
                gui_s=self._gui_seen_s(),
            )
        )

    def _send(self, message: m.ToGuardian) -> None:
        self._record(Record(Topic.COMMAND, self._now_s, fields_of(message)))
        self._guardian.send(message)

    # The machine.

    def _step(self, event: e.Event) -> None:
        before = self.state
        self.state, effects = step(before, event, self._rules)
        self._stop_tests.stepped(event, before, self.state)
        if not isinstance(event, e.Ticked) or self.state != before:
            self._record(Record(Topic.INPUT, event.t_s, fields_of(event)))
        for effect in effects:
            self._carry_out(effect)
        if self.state.state is not before.state:
            self._beat()
        if _shown(self.state) != _shown(before):
            self._tell_state()

    def _tell_state(self) -> None:
        if self.state.is_at_rest:
            self.at_rest.set()
        else:
            self.at_rest.clear()
        fields = {
            "state": self.state.state.value,
            "sentence": sentence(self.state, self._rules.drive_mode),
            "activation_id": self.state.activation_id,
        }
        self._record(Record(Topic.STATE, self._now_s, fields))

    def _carry_out(self, effect: e.Effect) -> None:
        match effect:
            case e.BeginCollecting():
                self._ear.activate(effect.activation_id, effect.t_s)
            case e.EndCollecting():
                self._ear.cancel()
            case e.SendProposal():
                direction = direction_of(effect.label, self.adjusted.settings.robot.yaw_deg)
                caps = TEST_CAPS if effect.is_test else None
                self._send(m.Propose(effect.activation_id, direction, effect.t_s, caps))
            case e.SendStop():
                self._send(m.Stop(effect.reason, effect.text, self._now_s))
            case e.SendArm():
                self._send(m.Arm())
            case e.SendDisarm():
                self._send(m.Disarm())
            case e.Say():
                self._say(effect)

    def _say(self, said: e.Say) -> None:
        self._story.say(said, self._now_s)

    # What stands against arming, and what the window sees.

    def _blockers(self) -> tuple[Blocker, ...]:
        if self._now_s - self._judged_s < JUDGE_S:
            return self.state.blockers
        self._judged_s = self._now_s
        since_s, fitness = self.state.stop_since_s, self.adjusted.fitness
        return find_blockers(
            Facts(
                left=self._arms.health(Side.LEFT, self._now_s),
                right=self._arms.health(Side.RIGHT, self._now_s),
                stop_seen_s=None if since_s is None else self._now_s - since_s,
                stop_wanted_s=self._site.stop_seen_s,
                model_problem=self._ear.model.problem,
                model_remedy=self._ear.model.remedy,
                lock=self.adjusted.hold,
                left_fit=self._arms.fit_of(Side.LEFT, fitness.of(Side.LEFT), self._now_s),
                right_fit=self._arms.fit_of(Side.RIGHT, fitness.of(Side.RIGHT), self._now_s),
                postures_fit=fitness.postures,
                is_link_open=self._robot.is_open,
                link_text=self._robot.text,
                link_remedy=self._robot.remedy,
                hindrances=self._robot.hindrances,
                status=self._robot.status,
                status_age_s=self._now_s - self._robot.status_s,
                position=self._robot.position,
                pose_age_s=self._now_s - self._robot.pose_s,
                field=self._field,
                tool=self.adjusted.settings.robot.tool,
            )
        )

    def _take_picture(self) -> Snapshot:
        s, settings = self.state, self.adjusted.settings
        model, recognition = self._ear.model, self._ear.recognition
        label = recognition.label if recognition is not None else None
        return Snapshot(
            t_s=self._now_s,
            state=s.state,
            sentence=sentence(s, self._rules.drive_mode),
            blockers=s.blockers if s.is_at_rest else (),
            can_arm=s.can_arm,
            is_stop_unconfirmed=s.is_stop_unconfirmed,
            left=self._arms.health(Side.LEFT, self._now_s),
            right=self._arms.health(Side.RIGHT, self._now_s),
            posture=s.posture,
            trip_level_s=settings.site.trip_level_s,
            recognition=recognition,
            direction=direction_of(label, settings.robot.yaw_deg) if label is not None else None,
            robot=self._robot.view(self._now_s),
            events=self._story.lines,
            is_simulation=settings.is_simulation,
            recording=RecordingView(),
            person=model.person or settings.person.name,
            model=model.words,
            stop_test=self._stop_tests.result,
        )


def _shown(s: MachineState) -> tuple[CellState, str, bool]:
    return s.state, s.note, s.is_stop_unconfirmed
