"""The step Settings: found, read, changed, refused, locked; and the PIN."""

from dataclasses import replace
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QCheckBox, QComboBox, QLineEdit, QTreeWidget, QTreeWidgetItemIterator

from gestureapp.settings_check import SettingsFinding
from gestureapp.setup.site_values import LockView
from tests.ui.setup_bench import NOW_S, SetupRoom

NAME, VALUE, ORIGIN, MARK = range(4)


@pytest.fixture
def room(qtbot, cell):
    room = SetupRoom(cell)
    qtbot.addWidget(room.window)
    room.enter("Settings")
    yield room
    room.window.close()


def lines(room) -> dict[str, object]:
    """Every line of the list that is in sight, by dotted name."""
    found = {}
    tree = room.window.findChild(QTreeWidget, "settingsList")
    each = QTreeWidgetItemIterator(tree, QTreeWidgetItemIterator.IteratorFlag.NotHidden)
    while (item := each.value()) is not None:
        if name := item.data(0, Qt.ItemDataRole.UserRole):
            found[name] = item
        each += 1
    return found


def choose(room, name: str) -> None:
    tree = room.window.findChild(QTreeWidget, "settingsList")
    item = lines(room)[name]
    tree.scrollToItem(item)
    spot = tree.visualItemRect(item).center()
    QTest.mouseClick(tree.viewport(), Qt.MouseButton.LeftButton, pos=spot)
    room.look()


def enter(room, name: str, text: str) -> None:
    line = room.window.findChild(QLineEdit, name)
    assert line.isVisible(), f"{name} is not in sight"
    line.selectAll()
    QTest.keyClicks(line, text)
    room.look()


def apply(qtbot, room) -> None:
    qtbot.waitUntil(room.button("settingsDraftApply").isEnabled, timeout=5000)
    room.press("settingsDraftApply")
    qtbot.waitUntil(lambda: "Applied" in room.text("settingsDraftText"), timeout=5000)


def test_every_setting_is_listed_with_its_value_and_where_it_comes_from(room):
    shown = lines(room)
    assert sorted(shown) == sorted(row.name for row in room.setup.rows)
    speed = shown["robot.speed_mm_s"]
    assert (speed.text(VALUE), speed.text(ORIGIN)) == ("100 mm/s", "built-in")


def test_a_setting_chosen_tells_all_that_is_known_of_it(room):
    row = next(row for row in room.setup.rows if row.name == "site.trip_level_s")
    choose(room, row.name)
    assert room.text("settingName") == row.name
    assert room.text("settingAbout") == row.about
    assert room.text("settingOrigin") == "Comes from: built-in"
    assert room.text(f"note_{row.name}") == "Allowed: 0.05 to 0.3"


@pytest.mark.parametrize(
    ("wanted", "found"),
    [
        ("translation speed", {"robot.speed_mm_s"}),
        ("supervision_hz", {"robot.supervision_hz"}),
        ("TRIP", {"site.trip_level_s"}),
    ],
)
def test_looking_for_words_leaves_what_has_all_of_them(room, wanted, found):
    enter(room, "settingsSearch", wanted)
    assert set(lines(room)) == found


def test_looking_for_nothing_that_exists_says_so(room):
    enter(room, "settingsSearch", "xyzzy")
    assert not lines(room)
    assert "xyzzy" in room.text("settingsNone")
    enter(room, "settingsSearch", "speed")
    assert room.text("settingsNone") == ""


def test_a_number_is_changed_and_its_origin_follows(qtbot, room):
    choose(room, "training.n_takes")
    enter(room, "setting_training.n_takes", "20")
    assert lines(room)["training.n_takes"].text(MARK) == "changed"
    apply(qtbot, room)
    assert room.setup.calls == ["change_settings {'training.n_takes': 20}"]
    line = lines(room)["training.n_takes"]
    assert (line.text(VALUE), line.text(MARK)) == ("20", "")
    assert room.text("settingOrigin") == "Comes from: settings.toml, line 1"


def test_a_choice_and_a_switch_are_changed_together(qtbot, room):
    choose(room, "site.drive_mode")
    choice = room.window.findChild(QComboBox, "setting_site.drive_mode")
    choice.setFocus()
    assert choice.currentText() == "hold to run"
    assert "hold to run: the robot moves only" in room.text("settingAbout")
    QTest.keyClick(choice, Qt.Key.Key_Down)
    assert choice.currentText() == "start and stop"
    choose(room, "site.stop_on_right_lost")
    switch = room.window.findChild(QCheckBox, "setting_site.stop_on_right_lost")
    switch.setFocus()
    QTest.keyClick(switch, Qt.Key.Key_Space)
    room.look()
    assert "Drive mode, Stop if right is lost" in room.text("settingsDraftText")
    apply(qtbot, room)
    assert room.setup.calls == [
        "change_settings {'site.drive_mode': 'start_stop', 'site.stop_on_right_lost': False}"
    ]


def test_a_wrong_value_is_marked_in_the_list_and_beside_the_field(qtbot, room):
    choose(room, "robot.speed_mm_s")
    enter(room, "setting_robot.speed_mm_s", "400")
    qtbot.waitUntil(
        lambda: "allowed is 1 to 250 mm/s" in room.text("note_robot.speed_mm_s"), timeout=5000
    )
    assert lines(room)["robot.speed_mm_s"].text(MARK) == "wrong"
    assert not room.button("settingsDraftApply").isEnabled()


def test_what_is_locked_says_so_in_the_list_and_cannot_be_typed_over(room):
    room.setup.rows = tuple(
        replace(row, is_locked=row.name.startswith("robot")) for row in room.setup.rows
    )
    room.show(lock=LockView(True, False, "locked"), t_s=NOW_S + 9)
    marks = {name: line.text(MARK) for name, line in lines(room).items()}
    assert marks["robot.tool"] == "locked"
    assert marks["training.n_takes"] == ""
    choose(room, "robot.tool")
    assert not room.window.findChild(QLineEdit, "setting_robot.tool").isEnabled()


def test_what_a_file_named_at_the_start_sets_cannot_be_changed_here(room):
    why = "set by bench.toml, line 3; change it there"
    room.setup.rows = tuple(
        replace(row, fixed=why if row.name == "robot.tool" else "") for row in room.setup.rows
    )
    room.show(t_s=NOW_S + 9)
    choose(room, "robot.tool")
    assert not room.window.findChild(QLineEdit, "setting_robot.tool").isEnabled()
    assert "Set by bench.toml, line 3" in room.text("note_robot.tool")


def test_what_is_wrong_in_the_files_stands_on_top_with_file_and_line(room):
    assert room.text("findingsTitle") == ""
    finding = SettingsFinding("robot.sped", "unknown; did you mean speed?", Path("site.toml"), 12)
    room.show(findings=(finding,))
    assert room.text("finding0") == "site.toml, line 12: robot.sped: unknown; did you mean speed?"
    room.show(findings=())
    assert room.text("findingsTitle") == ""


def type_pin(room, pin: str, again: str) -> None:
    enter(room, "newPin", pin)
    enter(room, "newPinAgain", again)
    room.press("setPin")


def said(room) -> str:
    room.look()
    return room.text("pinSaid")


def test_a_pin_is_set_when_it_was_typed_twice_alike(qtbot, room):
    type_pin(room, "4711", "4712")
    assert "different" in room.text("pinSaid")
    assert not room.setup.calls
    type_pin(room, "4711", "4711")
    qtbot.waitUntil(lambda: said(room) == "The PIN is set.", timeout=5000)
    assert room.setup.calls == ["set_pin 4711"]
    assert "no protection" in room.text("pinWorth")
    room.look()


def test_a_pin_that_is_refused_is_refused_in_words(qtbot, room):
    room.setup.answer = "A PIN has 4 to 12 digits and nothing else."
    type_pin(room, "47", "47")
    qtbot.waitUntil(lambda: room.text("pinSaid") == room.setup.answer, timeout=5000)


def test_the_pin_is_taken_away_only_while_it_was_given(qtbot, room):
    room.show(lock=LockView(True, False, "locked"))
    assert not room.button("clearPin").isEnabled()
    assert "Give the PIN first" in room.text("pinSaid")
    room.show(lock=LockView(True, True, "open"))
    room.press("clearPin")
    qtbot.waitUntil(lambda: room.setup.calls == ["set_pin "], timeout=5000)
    qtbot.waitUntil(lambda: said(room) == "There is no PIN any more.", timeout=5000)
    assert not room.button("settingsLockClose").isVisible()


def test_what_was_opened_can_be_locked_again(room):
    room.show(lock=LockView(True, True, "Open for 10 more minutes."))
    assert room.text("settingsLockText") == "Open for 10 more minutes."
    room.press("settingsLockClose")
    assert room.setup.calls == ["close_lock"]


def test_what_was_typed_in_one_step_waits_there(room):
    choose(room, "training.n_takes")
    enter(room, "setting_training.n_takes", "20")
    room.press("setupStepPeople")
    room.press("setupStepSettings")
    assert "Not applied yet: Takes of each gesture" in room.text("settingsDraftText")
