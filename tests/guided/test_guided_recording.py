"""A simulated person records with the desk that the guided thread drives; time is compressed."""

import itertools
import math
from contextlib import closing
from dataclasses import replace

import numpy as np
import pytest

from gestureapp.config import Settings, TrainingSettings
from gestureapp.errors import RecordingError
from gestureapp.gestures import LABELS
from gestureapp.guided.order import SUGGESTED
from gestureapp.guided.values import Pace, Phase, Quality
from gestureapp.recording.take_store import NewTake, TakeStore, to_take_set
from gestureapp.recording.take_values import Judgement, Verdict
from gestureapp.sensing.values import Side
from gestureapp.simulation.people import draw_person
from tests.guided.bench import WALL_S, Bench


def test_without_a_person_nothing_is_recorded_and_it_says_so(bench):
    bench.desk.start()
    bench.run(5.0)

    assert bench.picture.phase is Phase.CLOSED
    assert bench.picture.sentence == "Choose whose takes these are."


def test_a_batch_by_rhythm_counts_in_and_takes_ten_on_the_beat(bench):
    bench.desk.open("Ana")
    bench.desk.set_pace(Pace.RHYTHM, 1.5)
    bench.desk.start()
    begin_s = bench.now_s
    bench.tick()
    assert (bench.picture.phase, bench.picture.count_in) == (Phase.COUNT_IN, 3)
    assert bench.picture.sentence == "Get ready: push forward."
    bench.run(1.0)
    assert bench.picture.count_in == 2

    bench.run_until(lambda picture: picture.phase is Phase.IDLE)

    takes = bench.desk.takes
    assert [take.label for take in takes] == ["X+"] * 10
    assert {take.judgement.verdict for take in takes} == {Verdict.GOOD}
    assert bench.now_s - begin_s == pytest.approx(3.0 + 9 * 1.5 + 1.1, abs=0.05)
    steps = {round(b.wall_s - a.wall_s, 6) for a, b in itertools.pairwise(takes)}
    assert steps == {1.5}
    assert takes[0].wall_s == pytest.approx(WALL_S + begin_s + 3.0, abs=0.02)


def test_changed_settings_are_used_at_once_and_only_they(bench):
    def shown() -> tuple[int, Pace, float]:
        return bench.picture.progress[0].wanted, bench.picture.pace, bench.picture.beat_s

    bench.desk.open("Ana")
    bench.desk.set_pace(Pace.RHYTHM, 1.5)
    bench.arms.settings = replace(bench.arms.settings, training=TrainingSettings(n_takes=11))
    bench.tick()
    assert shown() == (11, Pace.RHYTHM, 1.5)
    bench.arms.settings = replace(bench.arms.settings, training=TrainingSettings(11, 2.5))
    bench.tick()
    assert shown() == (11, Pace.RHYTHM, 2.5)


def test_a_batch_hands_free_takes_ten_by_the_left_arm(bench):
    bench.desk.open("Ana")
    bench.run_batch()

    takes = bench.desk.takes
    assert [take.judgement.verdict for take in takes] == [Verdict.GOOD] * 10
    assert all(take.times_s[0] >= -0.5 and take.times_s[-1] < 1.0 for take in takes)
    assert all(len(take.times_s) in (149, 150, 151) for take in takes)


@pytest.mark.parametrize("pace", list(Pace))
def test_all_twelve_gestures_are_recorded_in_the_suggested_order(tmp_path, pace):
    """An ordinary person, whose takes are not all good: the batches go on until enough are."""
    settings = Settings(training=TrainingSettings(n_takes=5))
    bench = Bench(tmp_path, draw_person(5, 1), settings)
    bench.desk.open("Ana")
    bench.desk.set_pace(pace, 2.0)
    labels = []
    while bench.picture.suggested:
        labels.append(bench.picture.label)
        bench.run_batch()
        bench.run(2.0)
    bench.desk.close()

    assert labels == list(SUGGESTED)
    assert sorted(labels) == sorted(LABELS)
    bench.desk.open("Ana")
    assert [progress.good for progress in bench.picture.progress] == [5] * 12
    assert all(progress.quality is not Quality.FEW for progress in bench.picture.progress)
    assert bench.picture.sentence == "All takes are there: look at them, then train."
    counting = to_take_set(bench.desk.takes, "Ana")
    assert len(counting) == 60
    assert len(set(counting.session)) == 1
    bench.desk.close()


def test_bad_takes_do_not_count_and_the_batch_goes_on(bench):
    bench.desk.open("Ana")
    bench.slips[2] = bench.rest
    bench.slips[5] = lambda label, activation_s: bench.right.perform(label, activation_s + 0.3)
    bench.run_batch()

    takes = bench.desk.takes
    assert len(takes) == 12
    assert takes[2].judgement.words == "no movement"
    assert takes[5].judgement.words.startswith("too late by 3")
    assert sum(take.counts for take in takes) == 10
    assert bench.picture.n_in_batch == 10


def test_a_wrong_gesture_is_named(bench):
    bench.desk.open("Ana")
    for _ in range(3):
        bench.run_batch()
    bench.desk.sitting.choose("X+")
    first = bench.n_answers
    bench.slips[first] = lambda _, activation_s: bench.right.perform_for("Y+", activation_s)
    bench.run_batch()

    takes = [take for take in bench.desk.takes if take.label == "X+"]
    assert [take.judgement.words for take in takes if not take.counts] == ["looks like Y+"]


def test_after_a_batch_the_next_gesture_is_chosen_already(bench):
    bench.desk.open("Ana")
    assert bench.picture.label == "X+"
    bench.run_batch()
    assert (bench.picture.label, bench.picture.suggested) == ("RX+", "RX+")
    assert [take.label for take in bench.picture.batch] == ["X+"] * 10
    bench.desk.sitting.choose("Z-")
    bench.tick()
    assert bench.picture.sentence == "Z-: push down. Start when you are ready."


def test_a_pause_keeps_what_was_taken(bench):
    bench.desk.open("Ana")
    bench.desk.start()
    bench.run_until(lambda picture: picture.n_in_batch == 3)
    bench.desk.sitting.pause()
    bench.run(30.0)
    assert bench.picture.phase is Phase.PAUSED
    assert bench.picture.sentence == "Paused; 3 good takes are kept."
    bench.desk.go_on()
    bench.tick()
    assert bench.picture.count_in == 3
    bench.run_until(lambda picture: picture.phase is Phase.IDLE)
    assert bench.picture.n_in_batch == 10


@pytest.mark.parametrize("pace", list(Pace))
def test_a_lost_sensor_drops_the_take_and_says_what_is_kept(bench, pace):
    bench.desk.open("Ana")
    bench.desk.set_pace(pace, 2.5)
    bench.run_batch()
    bench.desk.sitting.choose("X+")
    bench.desk.start()
    bench.run_until(lambda picture: picture.n_in_batch == 3)
    bench.run_until(lambda picture: picture.phase is Phase.TAKING)
    bench.lose(Side.RIGHT)
    bench.run(5.0)

    assert bench.picture.phase is Phase.SENSOR_LOST
    assert math.isinf(bench.picture.next_beat_s)
    assert bench.picture.sentence == (
        "Right sensor lost during take 14; 13 good takes are kept. "
        "It goes on by itself when the sensor is back."
    )
    assert len(bench.desk.takes) == 13
    bench.restore(Side.RIGHT)
    bench.run_until(lambda picture: picture.count_in == 3, 1.0)
    bench.run_until(lambda picture: picture.phase is Phase.IDLE)
    assert len(bench.desk.takes) == 20


def test_the_left_sensor_is_not_missed_by_rhythm(bench):
    bench.desk.open("Ana")
    bench.desk.set_pace(Pace.RHYTHM, 2.5)
    bench.lose(Side.LEFT)
    bench.run_batch()
    assert len(bench.desk.takes) == 10
    bench.desk.set_pace(Pace.HANDS_FREE, 2.5)
    bench.desk.start()
    bench.run(1.0)
    assert bench.picture.sentence.startswith("Left sensor lost during take 1; 0 good takes")


def test_samples_that_are_missing_make_a_gap(bench):
    bench.desk.open("Ana")
    bench.desk.start()
    bench.run_until(lambda picture: picture.phase is Phase.TAKING)
    bench.silent.add(Side.RIGHT)
    bench.run(0.04)
    bench.silent.discard(Side.RIGHT)
    bench.run_until(lambda picture: bool(picture.batch))
    assert bench.picture.batch[0].judgement.words == "gap of 50 ms"
    assert bench.picture.n_in_batch == 0


def test_the_last_take_is_done_again(bench):
    bench.desk.open("Ana")
    bench.desk.start()
    bench.run_until(lambda picture: picture.n_in_batch == 4)
    last = bench.picture.batch[-1].id
    bench.desk.sitting.redo_last()
    bench.tick()
    assert bench.picture.n_in_batch == 3
    assert bench.picture.undo == "deletion of take 4 of X+"
    bench.run_until(lambda picture: picture.phase is Phase.IDLE)
    assert len(bench.desk.takes) == 10
    assert last not in [take.id for take in bench.desk.takes]


def test_takes_are_put_right_and_every_change_is_seen(bench):
    bench.desk.open("Ana")
    bench.run_batch()
    sitting, first = bench.desk.sitting, bench.desk.takes[0].id
    versions = [bench.picture.version]

    for change in (
        lambda: sitting.exclude(first, is_excluded=True),
        lambda: sitting.move(first, "Y+"),
        lambda: sitting.delete(first),
        sitting.undo,
        sitting.undo,
        sitting.undo,
        sitting.redo,
    ):
        change()
        bench.tick()
        versions.append(bench.picture.version)

    assert versions == sorted(set(versions))
    assert [take.is_excluded for take in bench.desk.takes] == [True] + [False] * 9
    assert bench.picture.progress[0].good == 9
    assert (bench.picture.undo, bench.picture.redo) == (
        "exclusion of take 1 of X+",
        "move to Y+ of take 1 of X+",
    )
    sitting.move(first, "somewhere")
    bench.tick()
    assert bench.picture.version == versions[-1]


def test_another_person_has_takes_of_their_own(bench):
    bench.desk.open("Ana")
    bench.run_batch()
    version = bench.picture.version
    bench.desk.open("Bob")
    assert (bench.picture.person, bench.desk.takes) == ("Bob", ())
    assert bench.picture.version > version
    bench.desk.open("Ana")
    assert len(bench.desk.takes) == 10
    assert bench.picture.suggested == "RX+"


def test_who_comes_back_soon_goes_on_with_the_same_sitting(bench):
    bench.desk.open("Ana")
    bench.run_batch()
    bench.desk.close()
    bench.desk.open("Ana")
    bench.run_batch()
    assert len({take.session for take in bench.desk.takes}) == 1
    bench.desk.close()
    bench.is_idle = True
    bench.now_s += 7200.0
    bench.run(1.0)
    bench.is_idle = False
    bench.desk.open("Ana")
    bench.run_batch()
    assert len({take.session for take in bench.desk.takes}) == 2


def test_a_disk_that_fails_pauses_and_says_why_and_it_goes_on_afterwards(bench):
    bench.desk.open("Ana")
    bench.desk.start()
    bench.run_until(lambda picture: picture.n_in_batch == 2)
    db = bench.desk.sitting._store._db
    pages = int(db.rows("PRAGMA page_count")[0][0])
    db.rows(f"PRAGMA max_page_count = {pages}")

    bench.run_until(lambda picture: picture.phase is Phase.PAUSED)

    assert "no room is left on the disk; free some and go on" in bench.picture.trouble
    n_kept = bench.picture.n_in_batch
    db.rows("PRAGMA max_page_count = 1000000")
    bench.desk.go_on()
    bench.run_until(lambda picture: picture.phase is Phase.IDLE)
    assert bench.picture.trouble == ""
    assert n_kept < 10 == bench.picture.n_in_batch


def test_the_level_indicator_follows_the_hand(bench):
    assert bench.picture.is_level
    assert bench.picture.tilt_deg < 6.0
    bench.right.perform("RX+", bench.now_s)
    bench.is_idle = True
    bench.run(1.5)
    assert not bench.picture.is_level
    assert bench.picture.tilt_deg > 60.0
    bench.lose(Side.RIGHT)
    bench.run(1.0)
    assert math.isnan(bench.picture.tilt_deg)
    assert not bench.picture.is_level


def test_a_person_who_cannot_be_opened_leaves_the_other_open(bench, tmp_path):
    bench.desk.open("Ana")
    with closing(TakeStore(tmp_path, "Bob")), pytest.raises(RecordingError, match="in use"):
        bench.desk.open("Bob")
    bench.tick()
    assert bench.picture.person == "Ana"
    bench.desk.open(" Ana ")
    assert bench.picture.person == "Ana"


def test_takes_of_a_person_who_has_all_can_be_changed_and_more_be_wanted(tmp_path):
    few = Settings(training=TrainingSettings(n_takes=5))
    with closing(TakeStore(tmp_path, "Ana")) as store:
        for label in LABELS * 5:
            good = Judgement(Verdict.GOOD, "")
            store.add(NewTake(label, "today", WALL_S, good, np.zeros(3), np.ones((3, 3))))
    bench = Bench(tmp_path, settings=few)
    bench.desk.open("Ana")
    assert (bench.picture.label, bench.picture.suggested) == ("", "")

    bench.desk.sitting.delete(bench.desk.takes[-1].id)
    bench.tick()
    assert bench.picture.suggested == LABELS[-1]
    assert "Start when you are ready" in bench.picture.sentence

    bench.desk.sitting.undo()
    bench.desk.set_wanted(6)
    bench.tick()
    assert bench.picture.label in LABELS
    bench.desk.close()


def test_redo_last_after_a_batch_chooses_its_gesture_again(bench):
    bench.desk.open("Ana")
    bench.run_batch()
    assert bench.picture.label != "X+"

    bench.desk.sitting.redo_last()
    bench.tick()
    assert bench.picture.label == "X+"
    assert len(bench.desk.takes) == 9
