"""The step People: who is here, one click to switch, and whose model that brings."""

from dataclasses import replace

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QLineEdit

from gestureapp.recording.person_profile import Handedness
from gestureapp.setup.site_values import PersonRow
from tests.ui.setup_bench import NOW_S, SetupRoom

ANA = PersonRow("Ana", True, Handedness.RIGHT, 360, "trained 2026-11-20", "margin 34\u00b0")
BO = PersonRow("Bo", False, Handedness.LEFT, 0, "", "the built-in ones")


@pytest.fixture
def room(qtbot, cell):
    room = SetupRoom(cell)
    room.setup.folk = (ANA, BO)
    cell.shown = replace(cell.shown, person="Ana", model="ana.json, 360 takes")
    qtbot.addWidget(room.window)
    room.enter("People")
    yield room
    room.window.close()


def add(room, name: str) -> None:
    line = room.window.findChild(QLineEdit, "setupNewPerson")
    line.clear()
    QTest.keyClicks(line, name)
    QTest.keyClick(line, Qt.Key.Key_Return)
    room.look()


def test_everybody_is_shown_with_what_is_known(room):
    shown = [room.text(f"person1{what}") for what in ("Name", "Takes", "Model", "Postures")]
    assert shown == ["Bo", "no takes", "Model: none", "Postures: the built-in ones"]
    assert room.button("person1Left").isChecked()
    assert room.button("person0Right").isChecked()
    assert room.text("peopleInUse") == "In use: Ana. Model: ana.json, 360 takes."


def test_one_click_switches_and_says_what_it_changes(room):
    assert not room.button("usePerson0").isEnabled()
    assert "model and postures of Bo" in room.text("person1What")
    room.press("usePerson1")
    assert room.setup.calls == ["choose_person Bo"]
    assert room.button("usePerson1").text() == "In use"
    assert room.button("usePerson0").text() == "Use Ana"


def test_the_model_of_somebody_else_is_never_used_without_a_word(room):
    room.press("usePerson1")
    text = room.text("peopleInUse")
    assert "Bo is chosen, but the model in use is for Ana" in text


def test_a_refusal_is_told_and_nothing_changes(room):
    room.setup.answer = "The robot moves; stop it first."
    room.press("usePerson1")
    assert room.text("peopleTrouble") == "The robot moves; stop it first."
    assert room.button("usePerson0").text() == "In use"


def test_somebody_new_is_added_with_a_tidy_name(room):
    add(room, "   ")
    assert room.text("peopleTrouble") == "Enter a name first."
    add(room, "  Cleo   Marie ")
    assert room.setup.calls == ["choose_person Cleo Marie"]
    assert room.window.findChild(QLineEdit, "setupNewPerson").text() == ""


def test_a_look_alike_name_stays_typed_beside_the_reason(room):
    room.setup.answer = "there is already Ana; choose her or another name"
    add(room, "ana")
    assert room.text("peopleTrouble") == room.setup.answer
    assert room.window.findChild(QLineEdit, "setupNewPerson").text() == "ana"


def test_the_hand_is_changed_with_one_click(room):
    room.press("person0Left")
    assert room.setup.calls == ["set_handedness Ana left-handed"]
    room.show(t_s=NOW_S + 5)
    assert room.button("person0Left").isChecked()


def test_a_hand_that_cannot_be_noted_is_told_and_taken_back(room):
    room.setup.answer = "the disk is full"
    room.press("person0Left")
    assert room.text("peopleTrouble") == "the disk is full"
    assert room.button("person0Right").isChecked()


def test_a_place_without_people_says_what_to_do(room):
    room.setup.folk = ()
    room.show(t_s=NOW_S + 5)
    assert "Enter a name" in room.text("peopleNobody")
    assert "Nobody is chosen" in room.text("peopleInUse")
    room.setup.folk = (BO,)
    room.show(t_s=NOW_S + 10)
    assert room.text("person0Name") == "Bo"
    assert room.text("peopleNobody") == ""


@pytest.mark.parametrize("size", [(1366, 768), (1920, 1080)])
def test_a_long_name_keeps_to_its_room(room, size):
    room.window.resize(*size)
    room.setup.folk = (replace(BO, name="W" * 60), *(replace(BO, name=f"P{i}") for i in range(9)))
    room.show(t_s=NOW_S + 5)
    assert room.widget("peopleArea").horizontalScrollBar().maximum() == 0
    assert room.widget("workArea").horizontalScrollBar().maximum() == 0
