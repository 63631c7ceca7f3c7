"""Training beside the cell: nothing is armed meanwhile, and a model changes only at rest."""

from dataclasses import replace

import numpy as np

from gestureapp.cell import events as e
from gestureapp.cell.controls import TRAINING_OPEN
from gestureapp.cell.ear import describe_model, open_model
from gestureapp.cell.inputs import ArmingHeld, ModelChosen
from gestureapp.cell.snapshot import CellState
from gestureapp.recognition.decision import Decision
from gestureapp.recognition.ensemble import Ensemble, Layer
from gestureapp.recognition.model_file import LiveFigure, load_model, save_model
from gestureapp.recognition.onset import OnsetRecogniser
from gestureapp.recognition.window import N_INPUTS
from gestureapp.robot import messages as m
from gestureapp.robot.values import StopReason
from gestureapp.simulation.demo import MODEL

S = CellState


def blockers(desk) -> dict[str, tuple[str, str]]:
    desk.control.tick(desk.now_s)
    return {b.id: (b.text, b.remedy) for b in desk.control.picture.blockers}


def test_open_training_stands_against_arming_until_it_is_closed(desk):
    desk.ready()
    desk.press(ArmingHeld(TRAINING_OPEN))
    desk.press(e.ArmPressed(desk.now_s))

    assert blockers(desk) == {"lock": ("training is open", "go back to Operate")}
    assert not desk.guardian.of(m.Arm)

    desk.press(ArmingHeld(""))
    assert desk.state is S.READY
    desk.press(e.ArmPressed(desk.now_s))
    assert desk.run(0.5, S.ARMED)


def test_a_model_of_kind_onset_is_opened_with_its_own_recogniser(tmp_path):
    shape = (1, N_INPUTS)
    layer = Layer(np.zeros((1, N_INPUTS, 3)), np.zeros((1, 3)))
    model = replace(
        load_model(MODEL),
        kind="onset",
        labels=("X+", "X-"),
        network=Ensemble(np.zeros(shape), np.ones(shape), (layer,)),
        cross_validation=None,
        decision=Decision(),
    )
    save_model(tmp_path / "m.json", model)

    opened = open_model(tmp_path / "m.json")

    assert isinstance(opened.recogniser, OnsetRecogniser)
    assert (opened.recogniser.labels, opened.problem) == (("X+", "X-"), "")


def test_opening_training_takes_the_permission_back(desk):
    desk.armed()
    desk.press(ArmingHeld(TRAINING_OPEN))

    assert desk.state is S.NOT_READY
    assert desk.guardian.of(m.Disarm)


def test_opening_training_while_arming_leaves_nothing_armed(desk):
    desk.ready()
    desk.press(e.ArmPressed(desk.now_s))
    desk.press(ArmingHeld(TRAINING_OPEN))
    desk.run(1.0)

    assert desk.state is S.NOT_READY
    assert desk.guardian.of(m.Disarm)


def test_opening_training_stops_a_robot_that_moves_as_disarm_does(desk):
    desk.moving()
    desk.press(ArmingHeld(TRAINING_OPEN))

    (stop,) = desk.guardian.of(m.Stop)
    assert stop.reason is StopReason.DISARMED
    assert desk.run(1.0, S.STOPPED)
    assert "lock" in blockers(desk)


def test_a_model_out_of_date_cannot_be_armed_and_says_why(desk):
    desk.ready()
    why = "the takes have changed since the model was trained"
    desk.press(ModelChosen(open_model(MODEL, why)))

    assert blockers(desk) == {"model": (why, "train again")}
    desk.press(e.ArmPressed(desk.now_s))
    assert not desk.guardian.of(m.Arm)

    desk.press(ModelChosen(open_model(MODEL)))
    assert desk.run(0.1, S.READY)


def test_a_model_is_changed_only_while_nothing_may_move(desk, tmp_path):
    path = tmp_path / "model.json"
    save_model(path, replace(load_model(MODEL), person="Ana"))
    desk.armed()
    desk.press(ModelChosen(open_model(path)))
    desk.run(0.1)

    assert desk.control.picture.person == "p1"
    desk.gesture()
    assert desk.run(2.0, S.MOVING)

    desk.press(e.DisarmPressed(desk.now_s))
    desk.run(1.0)
    assert desk.control.picture.person == "Ana"
    assert desk.control.picture.model.startswith("Ana, 12 gestures, not tried live")
    assert any(line.text.startswith("model: Ana") for line in desk.control.picture.events)


def test_a_new_model_hears_gestures_after_arming(desk):
    desk.ready()
    desk.press(ModelChosen(open_model(MODEL)))
    desk.moving().run(0.02)

    assert desk.control.picture.recognition.label == "X+"


def test_a_model_is_described_by_how_it_did_when_it_was_tried():
    model = load_model(MODEL)
    live = LiveFigure(60, 56, 1, 3, "2026-01-02T00:00:00+00:00")

    assert describe_model(model) == "p1, 12 gestures, not tried live, at most 1 in 200 wrong"
    assert (
        describe_model(replace(model, person="", cross_validation=None), "spare")
        == "spare, 12 gestures, not tried live, at most 1 in 200 wrong: not known"
    )
    words = describe_model(replace(model, live=live))
    assert words == "p1, 12 gestures, tried live: 93 % of 60, at most 1 in 200 wrong"
