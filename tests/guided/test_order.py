"""What to record next, how many of it, and what is said."""

from hypothesis import given
from hypothesis import strategies as st

from gestureapp.gestures import GESTURES, LABELS, Kind, gesture
from gestureapp.guided.batch import Batch
from gestureapp.guided.order import BATCH_SIZE, SUGGESTED, batch_size, progress, suggest
from gestureapp.guided.values import Pace, Phase, Quality
from gestureapp.guided.words import batch_sentence, idle_sentence
from gestureapp.sensing.values import ArmPosture, Side

COUNTS = st.fixed_dictionaries({label: st.integers(0, 40) for label in LABELS})


def test_the_order_has_every_gesture_once_and_spares_the_arm():
    assert sorted(SUGGESTED) == sorted(LABELS)
    kinds = [gesture(label).kind for label in SUGGESTED]
    assert kinds == [Kind.MOVEMENT, Kind.POSTURE] * 6
    axes = [gesture(label).axis for label in SUGGESTED]
    assert all(axes[k] != axes[(k + 2) % 12] for k in range(12))


@given(COUNTS, st.integers(5, 60))
def test_following_the_suggestions_ends_with_all_that_is_wanted(good, wanted):
    for _ in range(12 * 60):
        label = suggest(good, wanted)
        if not label:
            break
        assert good[label] < wanted
        size = batch_size(good[label], wanted)
        assert 1 <= size <= BATCH_SIZE
        good[label] += size
        assert good[label] <= wanted
    assert all(count >= wanted for count in good.values())


def test_every_gesture_has_its_first_batch_before_any_has_its_second():
    good, order = dict.fromkeys(LABELS, 0), []
    while label := suggest(good, 30):
        order.append(label)
        good[label] += batch_size(good[label], 30)
    assert order == [*SUGGESTED] * 3


def test_more_than_is_wanted_can_be_recorded_by_tens():
    assert batch_size(30, 30) == 10
    assert batch_size(35, 30) == 10
    assert batch_size(24, 30) == 6


def test_progress_is_told_in_the_order_of_the_set():
    good = dict.fromkeys(LABELS, 3)
    told = progress(good, 30, {"X+": Quality.FEW})
    assert [each.label for each in told] == list(LABELS)
    assert (told[0].quality, told[1].quality) == (Quality.FEW, Quality.NONE)


@given(
    st.sampled_from(list(Phase)),
    st.sampled_from(list(Pace)),
    st.sampled_from(GESTURES),
    st.integers(0, 30),
    st.sampled_from([None, *Side]),
    st.booleans(),
)
def test_every_moment_of_a_batch_has_a_sentence(phase, pace, wanted, n_good, lost, is_rested):
    batch = Batch(pace, 1.5, 10, 0.0, ArmPosture.STOP)
    batch.phase, batch.lost, batch.is_left_rested = phase, lost, is_rested
    sentence = batch_sentence(batch, wanted.label, n_good)
    assert sentence[0].isupper()
    assert sentence.endswith(".")
    assert "\n" not in sentence


def test_one_take_is_kept_and_two_are():
    batch = Batch(Pace.RHYTHM, 1.5, 10, 0.0, ArmPosture.STOP)
    batch.pause()
    assert batch_sentence(batch, "X+", 1) == "Paused; 1 good take is kept."
    assert batch_sentence(batch, "X+", 2) == "Paused; 2 good takes are kept."


def test_between_batches_it_says_what_comes_or_that_all_is_done():
    assert idle_sentence("X+", "X+") == "X+: push forward. Start when you are ready."
    assert idle_sentence("", "") == "All takes are there: look at them, then train."
    assert "Or record more of X+" in idle_sentence("X+", "")
