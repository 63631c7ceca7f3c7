"""Person and sensors: who wears them, and whether they are fine."""

from dataclasses import replace

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QLabel, QLineEdit, QListWidget, QPushButton, QWidget

from gestureapp.guided.guided import Guided
from gestureapp.sensing.values import LinkState, Side
from tests.ui.sitting import NoTrainer, Room
from ui.main_window import MainWindow
from ui.person_step import PersonStep


@pytest.fixture
def guided(cell, tmp_path):
    guided = Guided(cell, tmp_path)
    guided.start_thread()
    yield guided
    guided.shutdown()


@pytest.fixture
def page(qtbot, cell, operator, guided):
    window = MainWindow(cell, operator, guided=guided, trainer=NoTrainer())
    qtbot.addWidget(window)
    window.resize(1366, 768)
    window.show()
    click(window, "navTrain")
    yield window
    window.close()


def click(window, name: str) -> None:
    QTest.mouseClick(window.findChild(object, name), Qt.MouseButton.LeftButton)


def text_of(window, name: str) -> str:
    return window.findChild(QLabel, name).text()


def enter(window, name: str) -> None:
    field = window.findChild(QLineEdit, "newPersonName")
    field.setText(name)
    QTest.keyClick(field, Qt.Key.Key_Return)


def names(window) -> list[str]:
    people = window.findChild(QListWidget, "peopleList")
    return [people.item(i).text() for i in range(people.count())]


def test_without_a_person_only_person_and_sensors_can_be_opened(page):
    can = [name for name in STEPS if page.findChild(object, f"step{name}").isEnabled()]
    assert can == ["Person", "Sensors"]
    assert "choose a person first" in page.findChild(object, "stepRecord").toolTip()


def test_a_new_name_begins_and_leads_on_to_the_sensors(qtbot, page):
    enter(page, "  Ana   Maria ")
    assert page.findChild(object, "sensorsStep").isVisible()
    qtbot.waitUntil(lambda: page.findChild(object, "stepRecord").isEnabled(), timeout=5000)
    click(page, "stepPerson")
    assert names(page) == ["Ana Maria"]
    page.poll()
    assert text_of(page, "personChosen") == "Ana Maria"
    assert text_of(page, "personProgress") == "0 of 360 takes. Next X+ push forward: 0 of 30."


def test_somebody_who_was_here_before_continues(qtbot, page, guided):
    for name in ("Ana", "Bo"):
        guided.open(name)
    page.poll()
    assert names(page) == ["Ana", "Bo"]
    people = page.findChild(QListWidget, "peopleList")
    spot = people.visualItemRect(people.item(0)).center()
    QTest.mouseClick(people.viewport(), Qt.MouseButton.LeftButton, pos=spot)
    qtbot.waitUntil(lambda: text_of(page, "personChosen") == "Ana", timeout=5000)
    click(page, "continuePerson")
    assert page.findChild(object, "sensorsStep").isVisible()


def test_whoever_recorded_last_is_offered_in_the_next_run(qtbot, cell, tmp_path, guided):
    guided.open("Ana")
    guided.open("Bo")
    guided.shutdown()
    again = Guided(cell, tmp_path)
    again.start_thread()
    step = PersonStep(again)
    qtbot.addWidget(step)
    led_on: list[bool] = []
    step.finished.connect(lambda: led_on.append(True))
    step.show_snapshot(again.snapshot())
    assert text_of(step, "personChosen") == "Bo"
    assert step.findChild(object, "continuePerson").text() == "Continue as Bo"
    click(step, "continuePerson")
    assert led_on == [True]
    assert again.snapshot().person == "Bo"
    again.shutdown()


@pytest.mark.parametrize("size", [(1366, 768), (1920, 1080)])
def test_a_long_name_without_spaces_keeps_to_its_room(qtbot, page, guided, size):
    page.resize(*size)
    guided.open("Ana")
    page.poll()
    QApplication.processEvents()
    before = page.findChild(QWidget, "personStep").minimumSizeHint().width()
    guided.open("W" * 60)
    page.poll()
    QApplication.processEvents()
    step = page.findChild(QWidget, "personStep")
    assert step.minimumSizeHint().width() <= before
    for name in ("personChosen", "continuePerson"):
        widget = step.findChild(QWidget, name)
        corner = widget.mapTo(page, widget.rect().bottomRight())
        assert widget.visibleRegion().boundingRect() == widget.rect()
        assert page.rect().contains(corner)
        assert widget.toolTip() == "W" * 60
    button = step.findChild(QPushButton, "continuePerson")
    assert button.text().startswith("Continue as WWW")
    assert button.text().endswith("\u2026")
    assert button.sizeHint().width() <= button.width() <= 420


def test_a_name_with_an_ampersand_marks_no_shortcut(page, guided):
    guided.open("Ana & Bo")
    page.poll()
    button = page.findChild(QPushButton, "continuePerson")
    assert button.text() == "Continue as Ana && Bo"
    assert button.shortcut().isEmpty()
    assert text_of(page, "personChosen") == button.toolTip() == "Ana & Bo"


def test_an_empty_name_is_told_and_the_step_stays(page):
    enter(page, "   ")
    assert text_of(page, "personTrouble") == "Enter a name first."
    assert page.findChild(object, "personStep").isVisible()


def test_takes_that_cannot_be_opened_are_told_in_words(page, tmp_path):
    (tmp_path / "people").write_text("in the way")
    enter(page, "Ana")
    assert "cannot be made" in text_of(page, "personTrouble")
    assert page.findChild(object, "personStep").isVisible()


def test_the_name_in_the_settings_is_offered(qtbot, guided):
    step = PersonStep(guided, "Operator 1")
    qtbot.addWidget(step)
    assert step.findChild(QLineEdit, "newPersonName").text() == "Operator 1"


@pytest.fixture
def room(qtbot, cell, operator, tmp_path):
    room = Room(cell, operator, tmp_path)
    qtbot.addWidget(room.window)
    room.press("navTrain")
    room.controls.open("Ana")
    room.run(2.5)
    room.press("stepSensors")
    yield room
    room.window.close()
    room.bench.desk.close()


@pytest.mark.parametrize("link", LinkState)
def test_one_of_four_states_stands_out_with_its_remedy(room, link):
    fine = room.cell.shown.left
    health = replace(fine, link=link)
    if link is not LinkState.RECEIVING:
        health = replace(health, is_alive=False, reason="silent: switch it on")
    room.cell.shown = replace(room.cell.shown, left=health)
    room.window.poll()
    bold = [s for s in LinkState if label(room, f"leftState_{s.name}").font().bold()]
    assert bold == [link]
    if link is not LinkState.RECEIVING:
        assert room.text("leftArmText") == "silent: switch it on"


def test_both_arms_fine_lead_on_to_the_recording(room):
    assert room.text("sensorsTold") == "Both arms are fine."
    assert "was seen" in room.text("leftPosture")
    room.press("sensorsNext")
    assert room.widget("recordStep").isVisible()


def test_without_the_right_sensor_there_is_no_next(room):
    room.bench.lose(Side.RIGHT)
    room.run(1.0)
    assert "right arm's sensor is needed" in room.text("sensorsTold")
    assert not room.button("sensorsNext").isEnabled()
    assert room.button("stepSensors").state.text == "1 of 2"


def test_without_the_left_sensor_it_goes_on_by_the_beat(room):
    room.bench.lose(Side.LEFT)
    room.run(1.0)
    assert room.text("sensorsTold") == "Without the left sensor, takes are recorded by the beat."
    assert room.button("sensorsNext").isEnabled()


def test_of_a_silent_left_arm_no_posture_is_told(room):
    height = label(room, "leftPosture").height()
    room.bench.lose(Side.LEFT)
    room.run(1.0)
    assert room.text("leftPosture") == ""
    assert label(room, "leftPosture").height() == height
    room.bench.restore(Side.LEFT)
    room.run(1.0)
    assert room.text("leftPosture").startswith("Left arm now:")


def label(room: Room, name: str) -> QLabel:
    return room.window.findChild(QLabel, name)


STEPS = ("Person", "Sensors", "Record", "Check", "Train", "Try")
