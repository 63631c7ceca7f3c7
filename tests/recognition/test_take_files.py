import io
import stat
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gestureapp.errors import RecordingError, RecordingInvalid
from gestureapp.gestures import LABELS
from gestureapp.recognition.takes import TakeSet, load_takes, save_takes
from gestureapp.simulation.takes import make_takes


def takes_of(**changes):
    rng = np.random.default_rng(0)
    values = {
        "samples": rng.normal([0.0, 0.0, 1.0], 0.1, (10, 3)).astype(np.float32),
        "offsets": [0, 4, 10],
        "labels": ("X+", "left"),
        "activation": [1, 0],
        "user": ("p1", "p2"),
        "session": ("1", "2"),
        "rate_hz": 100.0,
    }
    return TakeSet(**(values | changes))


def arrays_of(**changes):
    arrays = {
        "samples": np.ones((10, 3)),
        "offsets": np.array([0, 4, 10]),
        "labels": np.array(["X+", "Y-"]),
        "activation": np.array([1, 0]),
        "rate_hz": np.array(100.0),
    }
    arrays |= changes
    return {name: array for name, array in arrays.items() if array is not None}


def write(path, **changes):
    np.savez(path, **arrays_of(**changes))
    return path


def test_takes_written_and_read_are_the_same(tmp_path):
    takes = takes_of()
    save_takes(tmp_path / "t.npz", takes)

    back = load_takes(tmp_path / "t.npz")

    assert np.array_equal(back.samples, takes.samples)
    assert back.labels == ("X+", "left")
    assert back.activation.tolist() == [1, 0]
    assert (back.user, back.session, back.rate_hz) == (("p1", "p2"), ("1", "2"), 100.0)
    assert back.source == tmp_path / "t.npz"
    assert back.fingerprint() == takes.fingerprint()


def test_the_fingerprint_outlives_the_file_also_for_finer_samples(tmp_path):
    takes = takes_of(samples=np.random.default_rng(1).normal([0, 0, 1], 0.1, (10, 3)))
    save_takes(tmp_path / "t.npz", takes)

    assert load_takes(tmp_path / "t.npz").fingerprint() == takes.fingerprint()


def test_an_unknown_rate_stays_unknown(tmp_path):
    save_takes(tmp_path / "t.npz", takes_of(rate_hz=None))

    assert load_takes(tmp_path / "t.npz").rate_hz is None


@pytest.mark.parametrize("rate_hz", [None, np.array(np.nan)])
def test_it_is_said_which_rate_is_taken_where_none_is_known(tmp_path, rate_hz):
    takes = load_takes(write(tmp_path / "t.npz", rate_hz=rate_hz))

    (remark,) = takes.remarks
    assert "'rate_hz' is missing: 100 Hz is taken" in remark


@pytest.mark.parametrize("rate_hz", [20.0, 2000])
def test_a_rate_at_which_gestures_can_be_told_is_taken(tmp_path, rate_hz):
    takes = load_takes(write(tmp_path / "t.npz", rate_hz=np.array(rate_hz)))

    assert (takes.rate_hz, takes.remarks) == (rate_hz, ())


def test_what_is_optional_may_be_absent(tmp_path):
    takes = load_takes(write(tmp_path / "t.npz", activation=None, rate_hz=None))

    assert takes.activation.tolist() == [0, 0]
    assert (takes.user, takes.session, takes.rate_hz) == ((), (), None)


def test_whole_numbers_and_other_arrays_are_accepted(tmp_path):
    path = write(
        tmp_path / "t.npz",
        samples=np.ones((10, 3), dtype=np.int16),
        session=np.array([1, 2]),
        repetition=np.array([1, 1]),
        offsets=np.array([0, 4, 10], dtype=np.uint32),
    )

    takes = load_takes(path)

    assert takes.session == ("1", "2")
    assert takes.samples.dtype == np.float64


DAMAGE = {
    "samples missing": ({"samples": None}, "'samples' is missing"),
    "labels missing": ({"labels": None}, "'labels' is missing"),
    "two columns": ({"samples": np.ones((10, 2))}, r"shape \(n, 3\)"),
    "texts as samples": ({"samples": np.full((10, 3), "a")}, "'samples' must hold numbers"),
    "offsets of floats": ({"offsets": np.array([0.0, 4.0, 10.0])}, "'offsets' must be one row"),
    "offsets too short": ({"offsets": np.array([0, 10])}, "one more entry than 'labels'"),
    "offsets not from 0": ({"offsets": np.array([1, 4, 10])}, "must begin with 0"),
    "offsets fall": ({"offsets": np.array([0, 12, 10])}, "take 1 ends"),
    "an empty take": ({"offsets": np.array([0, 0, 10])}, "take 0 ends"),
    "offsets beyond": ({"offsets": np.array([0, 4, 11])}, r"number of samples \(10\)"),
    "offsets huge": ({"offsets": np.array([0, 4, 2**64 - 1], dtype=np.uint64)}, "too large"),
    "activation outside": ({"activation": np.array([4, 0])}, "take 0 is 4, outside its 4 samples"),
    "activation negative": ({"activation": np.array([0, -1])}, "take 1 is -1"),
    "activation short": ({"activation": np.array([0])}, "'activation' must have one entry a take"),
    "user short": ({"user": np.array(["a"])}, "'user' must have one entry a take"),
    "numbers as labels": ({"labels": np.array([1.5, 2.5])}, "'labels' must be one row of texts"),
    "a label empty": ({"labels": np.array(["X+", ""])}, "'labels' is empty for take 1"),
    "rate zero": ({"rate_hz": np.array(0.0)}, "'rate_hz' must lie"),
    "rates": ({"rate_hz": np.array([100.0, 50.0])}, "'rate_hz' must be one number"),
    "rate of nothing that moves": (
        {"rate_hz": np.array(5.0)},
        "is 5, outside 20 to 2000 Hz: correct",
    ),
    "rate of sound": ({"rate_hz": np.array(20_000)}, "is 20000, outside .* leave out samples"),
    "rate infinite": ({"rate_hz": np.array(np.inf)}, "'rate_hz' must lie"),
}


@pytest.mark.parametrize(("changes", "words"), DAMAGE.values(), ids=DAMAGE)
def test_damage_is_named_in_one_line(tmp_path, changes, words):
    path = write(tmp_path / "t.npz", **changes)

    with pytest.raises(RecordingInvalid, match=words) as caught:
        load_takes(path)

    assert str(path) in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_a_sample_that_is_no_number_is_found_by_row_and_take(tmp_path, bad):
    samples = np.ones((10, 3))
    samples[6, 1] = bad

    with pytest.raises(RecordingInvalid, match=r"row 6 \(take 1\)"):
        load_takes(write(tmp_path / "t.npz", samples=samples))


def test_pickled_objects_are_never_loaded(tmp_path):
    path = tmp_path / "t.npz"
    np.savez(path, **arrays_of(labels=np.array(["X+", None], dtype=object)))

    with pytest.raises(RecordingInvalid, match="cannot be read"):
        load_takes(path)


@pytest.mark.parametrize("content", [b"", b"no zip at all", b"PK\x03\x04", b"\x80\x04K\x01."])
def test_a_file_of_another_kind_is_refused(tmp_path, content):
    path = tmp_path / "t.npz"
    path.write_bytes(content)

    with pytest.raises(RecordingInvalid, match="not an NPZ file"):
        load_takes(path)


def test_a_missing_file_is_refused(tmp_path):
    with pytest.raises(RecordingInvalid, match="cannot be read"):
        load_takes(tmp_path / "none.npz")


@pytest.fixture(scope="module")
def whole_file(tmp_path_factory):
    path = tmp_path_factory.mktemp("takes") / "whole.npz"
    save_takes(path, takes_of())
    return path.read_bytes()


@settings(max_examples=60, deadline=None)
@given(data=st.data())
def test_a_file_cut_off_or_changed_anywhere_is_refused_or_read_whole(
    whole_file, tmp_path_factory, data
):
    cut = data.draw(st.integers(0, len(whole_file)))
    content = bytearray(whole_file[:cut])
    if content:
        content[data.draw(st.integers(0, len(content) - 1))] ^= data.draw(st.integers(0, 255))
    path = tmp_path_factory.mktemp("cut") / "cut.npz"
    path.write_bytes(content)

    takes, refusal = None, ""
    try:
        takes = load_takes(path)
    except RecordingInvalid as error:
        refusal = str(error)

    assert "\n" not in refusal
    assert bool(refusal) == (takes is None)
    if takes is not None:
        assert np.array_equal(takes.samples, takes_of().samples)


def test_a_failed_save_leaves_the_old_file_and_nothing_else(tmp_path):
    path = tmp_path / "gone" / "t.npz"
    with pytest.raises(RecordingError, match="cannot be written"):
        save_takes(path, takes_of())

    folder = tmp_path / "folder.npz"
    folder.mkdir()
    with pytest.raises(RecordingError, match="cannot be written"):
        save_takes(folder, takes_of())
    assert [p.name for p in tmp_path.iterdir()] == ["folder.npz"]


def test_a_saved_file_is_plain_npz_that_others_may_read(tmp_path):
    path = tmp_path / "t.npz"
    save_takes(path, takes_of())

    assert stat.S_IMODE(path.stat().st_mode) & 0o444 == 0o444
    with np.load(io.BytesIO(path.read_bytes()), allow_pickle=False) as archive:
        assert archive["samples"].shape == (10, 3)
        assert archive["labels"].tolist() == ["X+", "left"]


def test_a_selection_keeps_each_take_with_its_own_facts():
    takes = takes_of()

    chosen = takes.select([1])

    assert np.array_equal(chosen.accel_g(0), takes.accel_g(1))
    assert (chosen.labels, chosen.user, chosen.session) == (("left",), ("p2",), ("2",))
    assert len(takes.select([])) == 0


def test_the_fingerprint_changes_with_a_sample_and_with_a_label():
    takes = takes_of()
    moved = takes.samples.copy()
    moved[3, 2] += 1e-6

    prints = {
        t.fingerprint() for t in (takes, takes_of(samples=moved), takes_of(labels=("a", "b")))
    }

    assert len(prints) == 3


def marked(path, **changes):
    """A file of another maker: three quiet samples, then a push along the device's own Y."""
    samples = np.zeros((10, 3))
    samples[[3, 7, 8]] = (0.0, 0.8, 0.0)
    marks = {"activation": None, "samples": samples, "target_start": np.array([3, 3])}
    return write(path, **(marks | changes))


def test_a_marked_begin_is_taken_for_the_activation_and_gravity_is_given_back(tmp_path):
    turn = np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])

    takes = load_takes(marked(tmp_path / "t.npz", R_device_to_paper=turn))

    assert takes.activation.tolist() == [3, 3]
    assert np.allclose(takes.accel_g(0)[:2], [[0.0, 0.0, 1.0]] * 2)
    assert np.allclose(takes.accel_g(0)[3], [0.8, 0.0, 1.0])
    assert ["target_start" in takes.remarks[0], len(takes.remarks)] == [True, 3]


def test_marked_takes_with_gravity_are_left_as_they_are(tmp_path):
    path = marked(tmp_path / "t.npz", samples=np.tile([0.0, 0.0, 1.0], (10, 1)))

    takes = load_takes(path)

    assert np.allclose(takes.samples, [0.0, 0.0, 1.0])
    assert len(takes.remarks) == 1


@pytest.mark.parametrize("activation", [0, 1])
def test_with_an_activation_only_gravity_is_given_back(tmp_path, activation):
    takes = load_takes(marked(tmp_path / "t.npz", activation=np.array([activation] * 2)))

    assert takes.activation.tolist() == [activation] * 2
    (remark,) = takes.remarks
    assert "without gravity, 1 g is added on Z" in remark
    assert np.allclose(takes.accel_g(0)[3], [0.0, 0.8, 1.0])


def moving_already(path, gestures, n_samples, removed_g):
    """Takes that begin at the activation, when the hand moves, without so much on Z."""
    made = make_takes(1, 6, 31, gestures=gestures)
    parts = [
        made.accel_g(i)[start : start + n_samples] - [0.0, 0.0, removed_g]
        for i, start in enumerate(made.activation.tolist())
    ]
    return write(
        path,
        samples=np.concatenate(parts),
        offsets=np.cumsum([0, *map(len, parts)]),
        labels=np.array(made.labels),
        activation=np.zeros(len(made), dtype=int),
        rate_hz=np.array(100.0),
    )


SETS = [LABELS, LABELS[:6], ("RX+", "RX-", "RY+", "RY-"), ("Y+", "Y-"), ("X+", "RZ-")]


@pytest.mark.parametrize("gestures", SETS, ids="".join)
@pytest.mark.parametrize("n_samples", [20, 30])
def test_removed_gravity_is_noticed_though_the_hand_moves_from_the_first_sample_on(
    tmp_path, gestures, n_samples
):
    whole = load_takes(moving_already(tmp_path / "with.npz", gestures, n_samples, 0.0))
    bare = load_takes(moving_already(tmp_path / "without.npz", gestures, n_samples, 1.0))

    assert whole.remarks == ()
    assert "1 g is added on Z" in bare.remarks[0]
    assert np.allclose(bare.samples, whole.samples)


def test_with_an_activation_and_gravity_nothing_is_put_right(tmp_path):
    path = write(tmp_path / "t.npz", samples=np.tile([0.0, 0.0, 1.0], (10, 1)))

    takes = load_takes(path)

    assert takes.remarks == ()
    assert np.allclose(takes.samples, [0.0, 0.0, 1.0])


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"R_device_to_paper": np.ones((3, 3))}, "must be a rotation"),
        ({"R_device_to_paper": np.eye(2)}, "must be a rotation"),
        ({"target_start": np.array([3, 6])}, "'activation' of take 1 is 6"),
    ],
)
def test_marks_that_cannot_be_used_are_refused(tmp_path, changes, words):
    with pytest.raises(RecordingInvalid, match=words):
        load_takes(marked(tmp_path / "t.npz", **changes))


@pytest.mark.parametrize("label", ["\x1b[31mX+", "X+\nY-", "X+\x7f", "X+\u2028", "\x9b31m"])
def test_a_label_with_a_control_character_is_refused_in_one_line(tmp_path, label):
    path = write(tmp_path / "t.npz", labels=np.array(["X+", label]))
    with pytest.raises(RecordingInvalid, match=r"control character in .* \(take 1\)") as refused:
        load_takes(path)
    assert str(refused.value).isprintable()


def test_a_number_that_is_not_finite_is_told_with_its_row(tmp_path):
    samples = np.ones((10, 3))
    samples[5, 1] = np.nan
    with pytest.raises(RecordingInvalid, match="holds a number that is not finite at row 5"):
        load_takes(write(tmp_path / "t.npz", samples=samples))


def test_takes_in_metres_per_second_squared_are_refused_with_the_remedy(tmp_path):
    made = make_takes(1, 2, 31)
    path = tmp_path / "t.npz"
    save_takes(path, replace(made, samples=made.samples * 9.80665))

    with pytest.raises(RecordingInvalid, match=r"look like m/s2; divide them by 9\.80665"):
        load_takes(path)


def test_takes_in_counts_of_a_sensor_are_refused_with_the_remedy(tmp_path):
    samples = np.tile([30, -20, 16384], (10, 1)).astype(np.int16)

    with pytest.raises(RecordingInvalid, match="what the sensor reads for 1 g"):
        load_takes(write(tmp_path / "t.npz", samples=samples))


@pytest.mark.parametrize("value", [101.0, -1e30, 1e308])
def test_a_reading_that_no_hand_makes_is_refused_with_its_take(tmp_path, value):
    samples = np.tile([0.0, 0.0, 1.0], (10, 1))
    samples[6, 1] = value

    with pytest.raises(RecordingInvalid, match=r"row 6 \(take 1\): beyond 100 g is no reading"):
        load_takes(write(tmp_path / "t.npz", samples=samples))


def test_a_blow_within_the_range_of_sensors_is_read(tmp_path):
    samples = np.tile([0.0, 0.0, 1.0], (10, 1))
    samples[6] = [-16.0, 16.0, 16.0]

    assert load_takes(write(tmp_path / "t.npz", samples=samples)).samples[6, 0] == -16.0


def test_takes_without_gravity_are_asked_about_when_they_go_far_beyond_what_hands_do(tmp_path):
    made = make_takes(1, 6, 31)
    save_takes(tmp_path / "g.npz", replace(made, samples=made.samples - [0.0, 0.0, 1.0]))
    ms2 = (made.samples - [0.0, 0.0, 1.0]) * 9.80665
    save_takes(tmp_path / "ms2.npz", replace(made, samples=ms2))

    assert len(load_takes(tmp_path / "g.npz").remarks) == 1
    assert "if the samples are in m/s2, divide" in load_takes(tmp_path / "ms2.npz").remarks[0]
