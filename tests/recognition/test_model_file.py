import json
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gestureapp.errors import ModelInvalid
from gestureapp.recognition.decision import Decision
from gestureapp.recognition.ensemble import Ensemble, Layer
from gestureapp.recognition.evaluation import tally
from gestureapp.recognition.model_file import (
    CrossValidation,
    LiveFigure,
    Model,
    TrainingRecord,
    load_model,
    save_model,
    with_live,
)
from gestureapp.recognition.network import Network
from gestureapp.recognition.window import INPUT_ONSET, N_INPUTS

LIVE = LiveFigure(n=60, recognised=56, wrong=1, rejected=3, when="2026-01-02T00:00:00+00:00")
RECORD = TrainingRecord("paper", "by hand", 100_000, 0.25, 3, 360, 0.001, 7.5, "somewhere")


def model_of():
    rng = np.random.default_rng(0)
    network = Network(
        rng.normal(0, 1, (4, 9)), rng.normal(0, 1, 4), rng.normal(0, 1, (2, 4)), np.zeros(2)
    )
    return Model(
        kind="paper",
        labels=("X+", "grüßen"),
        network=network,
        person="p1",
        training=RECORD,
        takes_fingerprint="sha256:00",
        app_version="0.1.0",
        created="2026-01-01T00:00:00+00:00",
        cross_validation=CrossValidation(
            tally(("X+", "grüßen"), [("X+", "X+"), ("grüßen", None)], [20.0, 30.0]), "by hand"
        ),
        live=LIVE,
    )


def onset_model_of(members=2, hidden=(3, 2)):
    rng = np.random.default_rng(1)
    sizes = (N_INPUTS, *hidden, 3)
    layers = tuple(
        Layer(rng.normal(0, 1, (members, a, b)), rng.normal(0, 1, (members, b)))
        for a, b in pairwise(sizes)
    )
    network = Ensemble(
        rng.normal(0, 1, (members, N_INPUTS)), rng.uniform(0.1, 1, (members, N_INPUTS)), layers, 0.7
    )
    return replace(
        model_of(),
        kind="onset",
        network=network,
        input_words=INPUT_ONSET,
        decision=Decision(early=0.96, last=0.6, onset_g=0.14),
    )


@pytest.fixture
def onset_path(tmp_path):
    save_model(tmp_path / "onset.json", onset_model_of())
    return tmp_path / "onset.json"


@pytest.fixture
def path(tmp_path):
    save_model(tmp_path / "model.json", model_of())
    return tmp_path / "model.json"


def rewrite(path, *keys, to):
    content = json.loads(path.read_text(encoding="utf-8"))
    inner = content
    for key in keys[:-1]:
        inner = inner[key]
    inner[keys[-1]] = to
    path.write_text(json.dumps(content), encoding="utf-8")


def test_a_model_written_and_read_is_the_same_to_the_last_bit(path):
    back, made = load_model(path), model_of()

    for name in ("hidden", "hidden_bias", "output", "output_bias"):
        assert np.array_equal(getattr(back.network, name), getattr(made.network, name))
    again = replace(back, network=made.network, cross_validation=made.cross_validation)
    assert again == made
    heard, meant = back.cross_validation, made.cross_validation
    assert heard.folds == meant.folds
    assert heard.evaluation.as_json() == meant.evaluation.as_json()


def test_an_onset_model_written_and_read_hears_the_same(onset_path):
    back, made = load_model(onset_path), onset_model_of()

    inputs = np.random.default_rng(2).normal(0, 1, (50, N_INPUTS))
    assert np.array_equal(back.network.outputs(inputs), made.network.outputs(inputs))
    assert np.array_equal(back.network.outputs(inputs)[7], made.network.outputs(inputs[7]))
    assert (back.decision, back.kind, back.shape) == (made.decision, "onset", (N_INPUTS, 3, 2, 3))
    assert back.network.outputs(inputs).sum(axis=1) == pytest.approx(np.ones(50))


def test_an_onset_model_of_three_members_stays_below_a_megabyte(tmp_path):
    save_model(tmp_path / "m.json", onset_model_of(members=3, hidden=(64, 32)))

    assert (tmp_path / "m.json").stat().st_size < 1_000_000


@pytest.mark.parametrize(
    ("keys", "to", "words"),
    [
        (["decision"], None, "'decision' is missing"),
        (["decision", "early"], 1.5, "'early' is 1.5, expected 0 to 1"),
        (["decision", "last"], 0.97, r"'last' is 0.97, expected 0 to 'early' \(0.96\)"),
        (["decision", "onset_g"], 0, "'onset_g' is 0.0"),
        (["decision", "budget_s"], "x", "'budget_s' must be a number"),
        (["weights", "layers"], [], "'layers' is missing"),
        (["weights", "layers"], [3], "'layers' must hold objects"),
        (["weights", "layers", 0, "bias"], [[1.0, 2.0, 3.0]], "do not fit each other"),
        (["weights", "layers", 1, "weights"], [[[1.0]]], "do not fit each other"),
        (["weights", "mean"], [[0.0] * N_INPUTS], "'mean' and 'scale' do not fit"),
        (["weights", "scale"], [[0.0] * N_INPUTS] * 2, "'scale' must be at least"),
        (["weights", "mean"], [[1e9] * N_INPUTS] * 2, "'mean' hold a number beyond"),
        (["weights", "temperature"], 0, "'temperature' is 0"),
        (["labels"], ["X+", "X-", "Y+"], "2 outputs for 3 labels"),
        (["kind"], "paper", "'hidden' must be numbers"),
    ],
)
def test_damage_of_an_onset_model_is_named_in_one_line(onset_path, keys, to, words):
    rewrite(onset_path, *keys, to=to)

    with pytest.raises(ModelInvalid, match=words) as caught:
        load_model(onset_path)

    assert "\n" not in str(caught.value)


def test_a_file_without_figures_as_older_versions_wrote_it_is_read(path):
    content = json.loads(path.read_text(encoding="utf-8"))
    del content["live"], content["cross_validation"]
    path.write_text(json.dumps(content), encoding="utf-8")

    back = load_model(path)

    assert (back.live, back.cross_validation) == (None, None)
    assert back.labels == model_of().labels


def test_the_live_figure_is_kept_with_the_model_and_replaces_the_one_before(path):
    evaluation = tally(("X+", "grüßen"), [("X+", "X+"), ("X+", "grüßen"), ("grüßen", None)])
    live = LiveFigure.of(evaluation, "2026-01-03T00:00:00+00:00")

    with_live(path, live)

    back = load_model(path)
    assert back.live == live
    assert (live.n, live.recognised, live.wrong, live.rejected) == (3, 1, 1, 1)
    assert np.array_equal(back.network.hidden, model_of().network.hidden)
    assert back.cross_validation.evaluation.n == 2


def test_a_person_can_read_the_file(path):
    content = json.loads(path.read_text(encoding="utf-8"))

    assert content["shape"] == [9, 4, 2]
    assert content["training"]["learning_rate"] == 0.25
    assert "grüßen" in path.read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("keys", "to", "words"),
    [
        (["format"], "other", "is not a model of this application"),
        (["schema"], 2, r"from a newer version \(schema 2"),
        (["schema"], "1", "no usable schema version"),
        (["kind"], "other", "unknown kind 'other'"),
        (["kind"], "onset", "'layers' is missing"),
        (["labels"], [], "'labels' is missing"),
        (["labels"], ["X+", 3], "'labels' must hold texts"),
        (["labels"], ["X+", "X+"], "names a gesture twice"),
        (["labels"], ["X+", "X-", "Y+"], "2 outputs for 3 labels"),
        (["shape"], [9, 10, 12], "'shape' says"),
        (["weights"], None, "'weights' is missing"),
        (["weights", "hidden"], [[1.0] * 9] * 3, "do not fit each other"),
        (
            ["weights", "hidden"],
            [[1.0] * 9, [1.0]],
            "'hidden'|inhomogeneous",
        ),
        (["weights", "hidden_bias"], [1.0, 2.0, 3.0, "x"], "'hidden_bias' must be numbers"),
        (["weights", "hidden_bias"], [1.0, 2.0, 3.0, 10**400], "'hidden_bias'"),
        (["training", "loss"], None, "'loss' must be a number"),
        (["training", "cycles"], 10**400, "'cycles' is too large"),
        (["person"], 5, "'person' must be a text"),
        (["live"], [], "'live' is missing"),
        (["live", "recognised"], 57, r"\(57, 1, 3\) do not add up to 60"),
        (["live", "wrong"], 0.5, "'wrong' must be a count"),
        (["live", "when"], None, "'when' must be a text"),
        (["cross_validation", "folds"], 3, "'folds' must be a text"),
        (["cross_validation", "confusion"], [[1, 2]], r"'confusion' has shape \(1, 2\)"),
        (["cross_validation", "confusion"], [[1, 2, 3], [4, -5, 6]], "must hold counts"),
        (["cross_validation", "confusion"], [[1, 2, 3], [4, 0.5, 6]], "must hold counts"),
    ],
)
def test_damage_is_named_in_one_line(path, keys, to, words):
    rewrite(path, *keys, to=to)

    with pytest.raises(ModelInvalid, match=words) as caught:
        load_model(path)

    assert str(path) in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("word", ["NaN", "Infinity", "-Infinity", "1e999"])
def test_weights_that_are_not_finite_are_refused(path, word):
    first = str(model_of().network.hidden[0, 0])
    path.write_text(path.read_text(encoding="utf-8").replace(first, word, 1), encoding="utf-8")

    with pytest.raises(ModelInvalid):
        load_model(path)


def test_a_network_for_other_inputs_is_refused(tmp_path):
    network = Network(np.zeros((4, 6)), np.zeros(4), np.zeros((2, 4)), np.zeros(2))
    save_model(tmp_path / "m.json", replace(model_of(), network=network))

    with pytest.raises(ModelInvalid, match="6 inputs, expected 9"):
        load_model(tmp_path / "m.json")


@pytest.mark.parametrize(
    "content", [b"", b"null", b"[]", b"{}", b"\xff\xfe", b"[" * 100_000, b"\x00" * 50]
)
def test_a_file_of_another_kind_is_refused(tmp_path, content):
    (tmp_path / "m.json").write_bytes(content)

    with pytest.raises(ModelInvalid) as caught:
        load_model(tmp_path / "m.json")

    assert "\n" not in str(caught.value)


def test_a_missing_file_and_a_folder_are_refused(tmp_path):
    with pytest.raises(ModelInvalid, match="cannot be read"):
        load_model(tmp_path / "none.json")
    with pytest.raises(ModelInvalid, match="cannot be read"):
        load_model(tmp_path)


def test_a_huge_file_is_refused_before_it_is_read(tmp_path):
    with (tmp_path / "m.json").open("wb") as file:
        file.truncate(20_000_000)

    with pytest.raises(ModelInvalid, match="far too large"):
        load_model(tmp_path / "m.json")


@pytest.fixture(scope="module", params=["paper", "onset"])
def whole_file(request, tmp_path_factory):
    path = tmp_path_factory.mktemp("model") / "whole.json"
    save_model(path, model_of() if request.param == "paper" else onset_model_of())
    return path.read_bytes()


@settings(max_examples=60, deadline=None)
@given(share=st.floats(0.0, 0.999))
def test_a_file_cut_off_anywhere_is_refused(whole_file, tmp_path_factory, share):
    path = tmp_path_factory.mktemp("cut") / "cut.json"
    path.write_bytes(whole_file[: int(share * (len(whole_file) - 2))])

    with pytest.raises(ModelInvalid):
        load_model(path)


VALUES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=5), inner),
    max_leaves=8,
)


@settings(max_examples=200, deadline=None)
@given(data=st.data())
def test_any_value_in_any_place_is_read_or_refused_in_one_line(whole_file, tmp_path_factory, data):
    content = inner = json.loads(whole_file)
    while True:
        key = data.draw(st.sampled_from(sorted(inner) if isinstance(inner, dict) else [0]))
        if not isinstance(inner[key], dict | list) or not inner[key] or data.draw(st.booleans()):
            break
        inner = inner[key]
    inner[key] = data.draw(VALUES)
    path = tmp_path_factory.getbasetemp() / "any.json"
    path.write_text(json.dumps(content), encoding="utf-8")

    read_or_refused_in_one_line(path)


@settings(max_examples=200, deadline=None)
@given(place=st.floats(0.0, 1.0), new=st.binary(min_size=1, max_size=3))
def test_a_file_with_other_bytes_anywhere_is_read_or_refused_in_one_line(
    whole_file, tmp_path_factory, place, new
):
    at = int(place * len(whole_file))
    path = tmp_path_factory.getbasetemp() / "bytes.json"
    path.write_bytes(whole_file[:at] + new + whole_file[at + len(new) :])

    read_or_refused_in_one_line(path)


def read_or_refused_in_one_line(path):
    words = ""
    try:
        model = load_model(path)
    except ModelInvalid as refused:
        words = str(refused)
    else:
        assert model.shape[-1] == len(model.labels) + (model.kind == "onset")
    assert not words or (str(path) in words and len(words.splitlines()) == 1)
