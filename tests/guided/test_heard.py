"""What was heard becomes a take when a person says so: in a live test, and in operation."""

import shutil
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import pytest

from gestureapp.guided.trained import TAKES_CHANGED, find_out_of_date, set_of
from gestureapp.recognition.model_file import load_model
from gestureapp.recognition.values import Recognition
from gestureapp.recording.people import model_path
from gestureapp.recording.take_values import AFTER_S, sitting_of
from gestureapp.sensing.values import Side
from tests.guided.bench import WALL_S, Bench

DEMO_MODEL = Path(__file__).parents[2] / "resources" / "demo" / "model.json"
WHEN_DONE_S = AFTER_S + 0.1


def hear(bench: Bench, label: str | None = "X+", person: str = "Ana", activation_id: int = 1):
    """The person makes a gesture in operation, and the cell hears this."""
    bench.is_idle = True
    bench.run(1.0)
    activation_s = bench.now_s + 0.2
    bench.right.perform_for("X+", activation_s)
    bench.run(0.3)
    times = (activation_s, activation_s + 0.02, activation_s + 0.03)
    bench.arms.recognition = Recognition(
        activation_id, label, "", (), *times, activation_s=activation_s
    )
    bench.arms.person = person


def keep(bench: Bench) -> str:
    bench.desk.keep_heard(bench.picture.heard.number)
    bench.tick()
    return bench.picture.heard.text


def test_a_gesture_of_operation_is_kept_when_its_last_sample_is_there(bench):
    bench.desk.open("Ana")
    hear(bench)
    assert not bench.picture.heard.can_keep
    bench.run(WHEN_DONE_S)
    assert bench.picture.heard.can_keep

    assert keep(bench) == "Kept as a take of X+: the next training learns from it."

    (take,) = bench.desk.takes
    assert (take.label, take.is_confirmed, take.counts) == ("X+", True, True)
    assert take.wall_s == pytest.approx(WALL_S + bench.arms.recognition.activation_s)
    assert take.times_s[-1] > AFTER_S - 0.02
    assert not bench.picture.heard.can_keep
    keep(bench)
    assert len(bench.desk.takes) == 1


def test_what_is_not_good_is_kept_with_its_verdict_and_does_not_count(bench):
    bench.desk.open("Ana")
    bench.is_idle = True
    hear(bench)
    activation_s = bench.arms.recognition.activation_s - 0.6
    bench.arms.recognition = replace(bench.arms.recognition, activation_s=activation_s)
    bench.run(WHEN_DONE_S)
    assert "but it does not count: too late" in keep(bench)
    assert [take.counts for take in bench.desk.takes] == [False]


def test_takes_of_who_operates_are_opened_when_nobodys_are(bench):
    bench.desk.open("Ana")
    bench.desk.close()
    hear(bench)
    bench.run(WHEN_DONE_S)
    assert keep(bench).startswith("Kept")
    assert bench.picture.person == "Ana"


@pytest.mark.parametrize(
    ("opened", "person", "words"),
    [
        ("Ana", "Ben", "The takes of Ana are open: choose Ben"),
        ("Ana", "", "The model in use is nobody's"),
        ("", "Ben", "Ben has no takes here"),
    ],
)
def test_nobody_gets_takes_of_somebody_else(bench, opened, person, words):
    if opened:
        bench.desk.open(opened)
    hear(bench, person=person)
    bench.run(WHEN_DONE_S)
    assert keep(bench).startswith(words)
    assert bench.picture.heard.can_keep
    assert bench.desk.takes == ()


def test_not_recognised_can_be_no_take(bench):
    bench.desk.open("Ana")
    hear(bench, label=None)
    bench.run(WHEN_DONE_S)
    keep(bench)
    assert not bench.picture.heard.can_keep
    assert bench.desk.takes == ()


def test_an_older_gesture_than_the_last_is_not_kept(bench):
    bench.desk.open("Ana")
    hear(bench)
    bench.run(WHEN_DONE_S)
    seen = bench.picture.heard.number
    hear(bench, activation_id=2)
    bench.run(WHEN_DONE_S)
    bench.desk.keep_heard(seen)
    bench.tick()
    assert bench.desk.takes == ()
    assert "only the last" in bench.picture.heard.text
    assert keep(bench).startswith("Kept")


def test_without_samples_it_is_said_that_there_are_none(bench):
    bench.desk.open("Ana")
    bench.silent.add(Side.RIGHT)
    bench.is_idle = True
    bench.run(5.0)
    hear(bench)
    bench.run(WHEN_DONE_S)
    assert "cannot be kept" in bench.picture.heard.text
    assert not bench.picture.heard.can_keep


def test_what_was_asked_for_is_kept_of_a_live_test(bench, tmp_path):
    bench.desk.open("Ana")
    shutil.copy(DEMO_MODEL, model_path(tmp_path, "Ana"))
    bench.desk.start_trying(1)
    bench.run_until(lambda picture: picture.heard.can_keep)
    heard = bench.picture.heard
    assert heard.is_tried
    keep(bench)
    assert [take.label for take in bench.desk.takes] == [heard.label]


def test_a_confirmed_take_is_of_the_sitting_and_leaves_the_model_as_it_is(bench):
    bench.desk.open("Ana")
    bench.run_batch()
    takes = bench.desk.takes
    made = datetime.fromtimestamp(bench.now_s + WALL_S, UTC).isoformat()
    fingerprint = set_of(takes, "Ana").fingerprint()
    model = replace(
        load_model(DEMO_MODEL),
        takes_fingerprint=fingerprint,
        created=made,
        labels=(takes[0].label,),
    )
    hear(bench)
    bench.run(WHEN_DONE_S)
    keep(bench)

    assert len(bench.desk.takes) == len(takes) + 1
    assert {sitting_of(take.session) for take in bench.desk.takes} == {takes[0].session}
    assert find_out_of_date(model, bench.desk.takes, "Ana") == ""
    assert find_out_of_date(model, bench.desk.takes[1:], "Ana") == TAKES_CHANGED
    later = replace(model, created=datetime.fromtimestamp(bench.now_s + WALL_S, UTC).isoformat())
    assert find_out_of_date(later, bench.desk.takes, "Ana") != ""
