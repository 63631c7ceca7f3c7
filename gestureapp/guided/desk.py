"""What the guided thread drives: both arms, the open person, the plan, and a live test.

No thread of its own, and its clocks are passed in: tests hold the time in their hand.
"""

import random
from dataclasses import replace
from pathlib import Path
from typing import Final

from gestureapp.clock import Clock
from gestureapp.config import N_TAKES_RANGE
from gestureapp.errors import RecordingError
from gestureapp.guided.arms import Arms, SensedCell
from gestureapp.guided.heard import LastHeard
from gestureapp.guided.sitting import Plan, Sitting
from gestureapp.guided.tried_model import TriedModel
from gestureapp.guided.trying import LiveTest
from gestureapp.guided.values import GuidedSnapshot, Pace, Phase, Trying
from gestureapp.guided.verdict import LEVEL_DEG
from gestureapp.guided.words import CHOOSE_PERSON, kept_words, whose_words
from gestureapp.recording.people import clean_name, list_people, model_path, note_last_person
from gestureapp.recording.take_values import Take

_BUSY: Final = (Phase.COUNT_IN, Phase.WAITING, Phase.TAKING, Phase.SENSOR_LOST)


class Desk:
    """What the thread owns: both arms, the open person and the plan. No thread of its own.

    Args:
        cell: Whose sensors.
        data: The data folder.
        clock: Monotonic seconds.
        wall_clock: Seconds since the epoch.
        chance: Decides in which order gestures are tried.

    Attributes:
        picture: The newest; any thread.
        takes: Those of the open person without the bin's, oldest first; any thread.
    """

    def __init__(
        self,
        cell: SensedCell,
        data: Path,
        clock: Clock,
        wall_clock: Clock,
        chance: random.Random | None = None,
    ) -> None:
        self._data = data
        self._chance = chance or random.Random()
        self._clock, self._wall_clock = clock, wall_clock
        self._cell, self._arms = cell, Arms(cell)
        self._settings = settings = cell.settings.training
        self._plan = Plan(Pace.HANDS_FREE, settings.beat_s, settings.n_takes)
        self.sitting: Sitting | None = None
        self._test: LiveTest | None = None
        self._tried = Trying()
        self._model: TriedModel | None = None
        self._heard = LastHeard()
        self._version_before = 0
        self._version = -1
        self.picture = GuidedSnapshot()
        self.takes: tuple[Take, ...] = ()

    @property
    def is_busy(self) -> bool:
        """Something is recorded or tried: every tick counts."""
        return self._test is not None or self.picture.phase in _BUSY

    def step(self) -> None:
        """One tick: take what has come, let time pass, draw the picture."""
        now_s = self._clock()
        self._follow_settings()
        news = self._arms.step(now_s)
        if self.sitting is not None:
            self.sitting.step(now_s, self._wall_clock(), news.postures)
        if self._test is not None:
            self._test.step(now_s, news, self._arms.lost(with_left=True))
            self._look_at_test(self._test)
        self._heard.operated(news.recognition, news.person)
        self._heard.step(now_s, self._arms)
        self._draw(now_s)

    def open(self, person: str) -> None:
        """Open a person's takes, putting those of another away.

        Raises:
            RecordingError: they cannot be opened; those of another stay open.
        """
        if self.sitting is not None and self.sitting.person == clean_name(person):
            self.close()
        opened = Sitting(self._data, person, self._plan, self._arms, self._wall_clock())
        self.close()
        self.sitting, self._tried = opened, Trying()
        note_last_person(self._data, person)
        self._draw(self._clock())

    def close(self) -> None:
        """Put the person's takes away. Idempotent."""
        self.stop_trying()
        if self.sitting is not None:
            self.sitting.close()
            self._version_before += self.sitting.version + 1
        self.sitting = None
        self._draw(self._clock())

    def start(self) -> None:
        """Begin a batch; ends a live test."""
        self.stop_trying()
        if self.sitting is not None:
            self.sitting.start(self._clock())

    def go_on(self) -> None:
        """Go on after a pause."""
        if self.sitting is not None:
            self.sitting.go_on(self._clock())

    def set_pace(self, pace: Pace, beat_s: float) -> None:
        """Record like this from the next batch on."""
        self._set_plan(replace(self._plan, pace=pace, beat_s=beat_s))

    def set_wanted(self, n_takes: int) -> None:
        """Want so many good takes of each gesture."""
        wanted = min(max(n_takes, N_TAKES_RANGE[0]), N_TAKES_RANGE[1])
        self._set_plan(replace(self._plan, wanted=wanted))

    def start_trying(self, per_gesture: int) -> None:
        """Ask for every gesture of the person's model so often; ends a batch."""
        self.stop_trying()
        if self.sitting is None:
            return
        self.sitting.end_batch()
        self._model = TriedModel(model_path(self._data, self.sitting.person))
        recogniser = self._model.recogniser
        if recogniser is None:
            self._tried = Trying(text=self._model.problem)
            return
        labels, posture = recogniser.labels, self._arms.posture
        now_s, chance = self._clock(), self._chance
        self._test = LiveTest(recogniser, labels, per_gesture, now_s, posture, chance)
        self._tried = self._test.view

    def stop_trying(self) -> None:
        """End the live test; what was counted is kept in the picture."""
        if self._test is not None:
            self._test.stop()
            self._tried = self._test.view
        self._test = None

    def keep_heard(self, number: int) -> None:
        """Make the last activation a take of whoever did it; what comes of it is in the picture.

        Args:
            number: Of the activation that the person has seen.
        """
        samples = self._heard.samples(number)
        if samples is None:
            return
        heard, person = self._heard, self._heard.person
        try:
            self._open_for(person)
        except RecordingError as error:
            heard.refused(str(error))
            return
        sitting = self.sitting
        if sitting is None or not person or sitting.person != clean_name(person):
            heard.refused(whose_words(person, sitting.person if sitting else ""))
            return
        wall_s = self._wall_clock() - (self._clock() - heard.activation_s)
        take = sitting.keep(heard.view.label, samples, wall_s)
        if take is None:
            heard.refused(sitting.trouble)
        else:
            heard.kept(kept_words(take))

    def _open_for(self, person: str) -> None:
        """In operation nobody's takes need be open: those of the model's person, if there are."""
        if self.sitting is None and person and person in list_people(self._data):
            self.open(person)

    def _look_at_test(self, test: LiveTest) -> None:
        """Show where the live test stands; one that is over is kept with the model."""
        if test.view.n_done > self._tried.n_done and self.sitting is not None:
            self._heard.tried(test.view.answered, test.activation_s, self.sitting.person)
        self._tried = test.view
        if not test.is_over:
            return
        self._test = None
        live = test.view.live
        if self._model is not None and live is not None:
            problem = self._model.keep(live.evaluation, self._wall_clock())
            self._tried = replace(test.view, text=problem or test.view.text)

    def _follow_settings(self) -> None:
        """Record as the settings say, once they have changed; until then as the window does."""
        before, self._settings = self._settings, self._cell.settings.training
        now = self._settings
        if now.beat_s != before.beat_s:
            self.set_pace(self._plan.pace, now.beat_s)
        if now.n_takes != before.n_takes:
            self.set_wanted(now.n_takes)

    def _set_plan(self, plan: Plan) -> None:
        self._plan = plan
        if self.sitting is not None:
            self.sitting.set_plan(plan)

    def _draw(self, now_s: float) -> None:
        tilt_deg = self._arms.tilt_deg(now_s)
        common = GuidedSnapshot(
            t_s=now_s,
            pace=self._plan.pace,
            beat_s=self._plan.beat_s,
            tilt_deg=tilt_deg,
            is_level=tilt_deg <= LEVEL_DEG,
            posture=self._arms.posture,
            version=self._version_before,
            sentence=CHOOSE_PERSON,
            trying=self._tried,
            heard=self._heard.view,
        )
        self.picture = common if self.sitting is None else self._with_sitting(common, self.sitting)

    def _with_sitting(self, common: GuidedSnapshot, sitting: Sitting) -> GuidedSnapshot:
        batch = sitting.batch
        version = self._version_before + sitting.version
        if version != self._version:
            self._version, self.takes = version, sitting.takes
        picture = replace(
            common,
            person=sitting.person,
            phase=sitting.phase,
            label=sitting.label,
            suggested=sitting.suggested,
            progress=sitting.progress,
            sentence=sitting.sentence(),
            trouble=sitting.trouble,
            undo=sitting.undo_words,
            redo=sitting.redo_words,
            version=version,
        )
        if batch is None:
            return picture
        return replace(
            picture,
            count_in=batch.count_in(common.t_s),
            activation_s=batch.activation_s,
            next_beat_s=batch.next_beat_s,
            n_in_batch=sitting.n_in_batch,
            batch_size=batch.size,
            batch=sitting.batch_takes,
        )
