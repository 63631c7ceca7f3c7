"""The running cell: its threads, its guardian, and the surface that the window uses."""

import logging
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from gestureapp.cell import events as e
from gestureapp.cell.adjustments import with_limits_of
from gestureapp.cell.control import Control
from gestureapp.cell.ear import open_model
from gestureapp.cell.fitness import Judgement
from gestureapp.cell.guardian_link import GuardianLink
from gestureapp.cell.guardian_process import SpareGuardian
from gestureapp.cell.inputs import (
    ArmingHeld,
    CalibrationChosen,
    GuardianPort,
    GuardianSaid,
    ModelChosen,
    PosturesChosen,
    SampleCame,
    SensorChosen,
    SensorJudged,
    SensorTold,
    ServoAsked,
    SettingsChosen,
)
from gestureapp.cell.limits import checked_limits, limits_of
from gestureapp.cell.records import Record, Recorder, Topic
from gestureapp.cell.snapshot import CellState, RecordingView, Snapshot
from gestureapp.clock import Clock, monotonic
from gestureapp.config import SensorSettings, Settings
from gestureapp.errors import GuardianLost, WorkerError
from gestureapp.robot import messages as m
from gestureapp.robot.leftover import KeptMoves
from gestureapp.robot.values import StopReason
from gestureapp.sensing.calibration import Calibration
from gestureapp.sensing.posture import LeftPostures
from gestureapp.sensing.protocols import protocol
from gestureapp.sensing.reader import SensorReader
from gestureapp.sensing.store import SampleStore
from gestureapp.sensing.values import Garbage, Sample, SensorEvent, Side
from gestureapp.worker import Worker

log = logging.getLogger(__name__)

STALE_PICTURE_S = 0.5
"""An older picture is not what is: the control thread has stopped or is stuck."""
CLOSING_LIMIT_S = 2.0
"""A robot stands within 0.5 s; the guardian goes on stopping one that does not, also without us."""
OLD_GUARDIAN_S = 0.02
"""A guardian that has ended is gone by then; one that hangs is killed, so that only one holds."""


class Cell:
    """Owns readers, control thread and the link to the guardian; implements ``CellControls``.

    Args:
        settings: Of the cell.
        record: Takes everything that happens; any thread.
        recording: How the recording is; polled with every picture.
        guardian_log: File for the guardian's own log, or None.
        clock: Monotonic seconds.
        wall_clock: Seconds since the epoch.

    Raises:
        ConfigError: the settings contradict each other or a limit that nobody may leave.

    Attributes:
        left: The left arm's newest samples.
        right: The right arm's.
    """

    def __init__(
        self,
        settings: Settings,
        record: Recorder,
        recording: Callable[[], RecordingView],
        guardian_log: Path | None,
        wall_clock: Clock,
        clock: Clock = monotonic,
    ) -> None:
        checked_limits(settings)
        self.left, self.right = SampleStore(), SampleStore()
        self._record, self._recording = record, recording
        self._guardian_log, self._clock = guardian_log, clock
        self._gui_s = clock()
        self._link: GuardianLink | None = None
        self._spare = SpareGuardian()
        self._is_closing = False
        self._readers = {
            Side.LEFT: self._reader(Side.LEFT, settings.left, self.left, Topic.LEFT_ACCEL),
            Side.RIGHT: self._reader(Side.RIGHT, settings.right, self.right, Topic.RIGHT_ACCEL),
        }
        self._control = Control(
            settings=settings,
            model=replace(open_model(settings.person.model), person=""),
            start_guardian=self._start_guardian,
            readers=self._readers,
            gui_seen_s=lambda: self._gui_s,
            record=record,
            clock=clock,
            wall_clock=wall_clock,
        )
        self._worker = Worker("control", self._control.run, self._control_died)

    @property
    def settings(self) -> Settings:
        """In use now."""
        return self._control.adjusted.settings

    @property
    def postures(self) -> LeftPostures:
        """Of the left arm, in use now."""
        return self._control.adjusted.postures

    def start(self) -> None:
        """Start every thread; the guardian is started by the control thread."""
        self._gui_s = self._clock()
        self._worker.start()
        for reader in self._readers.values():
            reader.start()

    def snapshot(self) -> Snapshot:
        """The newest picture of the cell. Any thread."""
        picture = replace(self._control.picture, recording=self._recording())
        if self._worker.error is not None:
            return _orphaned(picture, is_open=not self._control.at_rest.is_set())
        age_s = self._clock() - picture.t_s
        if age_s > STALE_PICTURE_S and not self._is_closing:
            sentence = f"The control thread is silent for {age_s:.1f} s: restart the application."
            return replace(picture, sentence=sentence, can_arm=False)
        return picture

    def gui_tick(self) -> None:
        """The window's timer has run."""
        self._gui_s = self._clock()

    def arm(self) -> None:
        """The operator has held the arm button long enough."""
        self._control.put(e.ArmPressed(self._clock()))

    def disarm(self) -> None:
        """The operator takes the permission back."""
        self._control.put(e.DisarmPressed(self._clock()))

    def stop(self, why: str = e.STOP_WORDS) -> None:
        """STOP: first straight to the guardian, then to the cell's own knowledge."""
        link, pressed_s = self._link, self._clock()
        if link is not None and self.settings.robot.host:
            link.stop_now(why)
        self._control.put(e.StopPressed(pressed_s, why))

    def servo_on(self) -> None:
        """The operator asks for servo power."""
        self._control.put(ServoAsked(is_on=True))

    def servo_off(self) -> None:
        """The operator asks for servo power to go off."""
        self._control.put(ServoAsked(is_on=False))

    def use_model(self, path: Path | None, problem: str = "", person: str = "") -> None:
        """Recognise with another model, once nothing may move; with none, nothing is armed."""
        own = self.settings.person
        if path is None and person == own.name:
            path = own.model
        self._control.put(ModelChosen(open_model(path, problem, person)))

    def hold_arming(self, why: str) -> None:
        """Something is open beside which nothing can be armed; an empty reason lets arm again."""
        self._control.put(ArmingHeld(why))

    def use_sensor(self, side: Side, settings: SensorSettings) -> None:
        """Read this arm's sensor from elsewhere, once nothing may move; else ConfigError."""
        protocol(settings.protocol)
        self._control.put(SensorChosen(side, settings))

    def use_calibration(self, side: Side, calibration: Calibration) -> None:
        """Take this sensor's own errors out of the samples from now on."""
        self._control.put(CalibrationChosen(side, calibration))

    def judge_sensor(self, side: Side, problem: str, remedy: str = "") -> None:
        """Say why this sensor must not be armed with; an empty problem means that it may be."""
        self._control.put(SensorJudged(side, Judgement(problem, remedy)))

    def use_postures(self, postures: LeftPostures, problem: str = "", remedy: str = "") -> None:
        """Take these postures of the left arm, once nothing may move."""
        self._control.put(PosturesChosen(postures, Judgement(problem, remedy)))

    def use_settings(self, settings: Settings) -> None:
        """Take other settings of site, robot and joints, once nothing may move; or ConfigError."""
        checked_limits(with_limits_of(self.settings, settings))
        self._control.put(SettingsChosen(settings))

    def begin_stop_test(self, label: str) -> None:
        """Arm, then move at most 20 mm slowly this way, to be stopped with STOP."""
        self._control.put(e.StopTestPressed(self._clock(), label))

    def release_stop_test(self) -> None:
        """The button was let go: a stop test under way is stopped, not measured."""
        self._control.put(e.StopTestReleased(self._clock()))

    def tell(self, text: str) -> None:
        """One line for the cell's story, no alarm."""
        self._control.put(e.Say(text))

    def shutdown(self) -> None:
        """End everything; what may still move is stopped by the guardian first. Idempotent."""
        if self._is_closing:
            return
        self._is_closing = True
        self._control.put(e.DisarmPressed(self._clock()))
        if self._worker.is_alive:
            self._control.at_rest.wait(CLOSING_LIMIT_S)
        for reader in self._readers.values():
            reader.stop()
        self._worker.stop()
        if self._link is not None:
            self._link.close()
        self._spare.close()

    # Parts.

    def _reader(
        self, side: Side, settings: SensorSettings, store: SampleStore, topic: Topic
    ) -> SensorReader:
        def on_sample(sample: Sample) -> None:
            self._control.put(SampleCame(side, sample))
            store.append(sample)
            self._record(Record(topic, sample.t_s, _sample_fields(sample)))

        def on_event(event: SensorEvent) -> None:
            now_s = self._clock()
            self._control.put(SensorTold(now_s, side, event))
            if isinstance(event, Garbage):
                self._record(Record(Topic.GARBAGE, now_s, _garbage_fields(side, event)))

        return SensorReader(side, settings, on_sample, on_event, self._clock, self._reader_died)

    def _start_guardian(self, settings: Settings, kept: KeptMoves) -> GuardianPort:
        old, robot = self._link, settings.robot
        if old is not None:
            old.close(wait_s=OLD_GUARDIAN_S, is_killed=True)
        link = GuardianLink(
            self._spare.take(),
            host=robot.host,
            port=robot.port,
            limits=limits_of(settings),
            is_simulation=settings.is_simulation,
            kept=kept,
            log_file=self._guardian_log,
            on_message=self._guardian_said,
            on_lost=lambda text: self._control.put(e.GuardianGone(self._clock(), text)),
            clock=self._clock,
        )
        self._link = link
        if self._is_closing:  # it came too late to be closed with the rest
            link.close()
            raise GuardianLost("the application is closing")
        return link

    def _guardian_said(self, message: m.FromGuardian) -> None:
        self._control.put(GuardianSaid(message))
        self._spare.prepare()  # in the link's own thread: the control thread does not wait for it

    def _reader_died(self, error: WorkerError) -> None:
        self._control.put(e.Faulted(self._clock(), f"{error}; restart the application"))

    def _control_died(self, error: WorkerError) -> None:
        """Without a control thread nobody can be trusted: the guardian stops what moves."""
        if self._link is not None:
            self._link.stop_now(f"cell fault: {error}", StopReason.CELL_FAULT)


def _orphaned(picture: Snapshot, *, is_open: bool) -> Snapshot:
    """The last picture of a control thread that has ended: nobody reads a stop back any more."""
    sentence = "The control thread has ended by an error; the guardian stops the robot."
    return replace(
        picture,
        state=CellState.STOPPING if is_open else CellState.NOT_READY,
        sentence=f"{sentence} Restart the application.",
        can_arm=False,
        is_stop_unconfirmed=is_open,
    )


def _sample_fields(sample: Sample) -> dict[str, int | float | None]:
    x, y, z = sample.accel_g
    return {"seq": sample.seq, "ax_g": x, "ay_g": y, "az_g": z, "counter": sample.counter}


def _garbage_fields(side: Side, event: Garbage) -> dict[str, int | str]:
    return {
        "side": side.value,
        "n_bytes": event.n_bytes,
        "first_bytes": event.first_bytes.hex(),
        "reason": event.reason,
    }
