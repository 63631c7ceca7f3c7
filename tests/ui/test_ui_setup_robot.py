"""The step Robot: connecting, the field and its picture, the operator's place, the stop test."""

from dataclasses import replace

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import (
    QAbstractButton,
    QApplication,
    QComboBox,
    QLineEdit,
    QPlainTextEdit,
    QStackedWidget,
    QTabBar,
    QTreeWidget,
)

from gestureapp.recording.person_profile import Handedness
from gestureapp.setup.site_values import (
    LockView,
    PersonRow,
    RobotCard,
    RobotRow,
    StopTestPhase,
    StopTestView,
)
from gestureapp.setup.values import Check, Outcome
from tests.ui.setup_bench import NOW_S, SetupRoom
from ui.facing_view import FacingView, robot_axis
from ui.marks import Level, Mark

CONNECTION, FIELD, DRIVE, STOP_TEST = range(4)
ROWS = (
    RobotRow("Banner", Outcome(Check.PASSED, "NX Information Server(Ver 1.00)")),
    RobotRow("Status", Outcome(Check.FAILED, "the pendant's key is in TEACH")),
    RobotRow("Tool", Outcome(Check.NOT_RUN)),
)


@pytest.fixture
def room(qtbot, cell):
    room = SetupRoom(cell)
    qtbot.addWidget(room.window)
    room.enter("Robot")
    yield room
    room.window.close()


def open_tab(room, number: int) -> None:
    bar = room.window.findChild(QTabBar, "robotTabs")
    QTest.mouseClick(bar, Qt.MouseButton.LeftButton, pos=bar.tabRect(number).center())
    room.look()


def field(room, name: str) -> QLineEdit:
    found = room.window.findChild(QLineEdit, name)
    assert found is not None, name
    assert found.isVisible(), f"{name} is not in sight"
    return found


def enter(room, name: str, text: str) -> None:
    line = field(room, name)
    line.setFocus()
    line.selectAll()
    QTest.keyClicks(line, text)
    room.look()


def press_when_possible(qtbot, room, name: str) -> None:
    qtbot.waitUntil(room.button(name).isEnabled, timeout=5000)
    room.press(name)


def made(room, start: str) -> list[str]:
    return [call for call in room.setup.calls if call.startswith(start)]


def test_connecting_asks_for_the_address_typed(qtbot, room):
    enter(room, "robotHost", "192.168.1.31")
    enter(room, "robotPort", "8080")
    room.press("connectRobot")
    qtbot.waitUntil(lambda: room.setup.calls == ["choose_robot 192.168.1.31 8080"], timeout=5000)
    assert room.text("robotTrouble") == ""


def test_a_wrong_address_is_refused_in_words(qtbot, room):
    room.setup.answer = "'nx100' is no address; give the controller's IP address"
    enter(room, "robotHost", "nx100")
    QTest.keyClick(field(room, "robotHost"), Qt.Key.Key_Return)
    qtbot.waitUntil(lambda: room.text("robotTrouble") == room.setup.answer, timeout=5000)


def test_a_port_that_is_no_number_is_not_asked_for(room):
    enter(room, "robotPort", "eighty")
    room.press("connectRobot")
    assert "enter a whole number" in room.text("robotTrouble")
    assert not room.setup.calls


def test_each_row_of_the_connection_test_ends_in_words(room):
    room.show(robot=RobotCard("192.168.1.31:80", True, "connected, reading only", ROWS))
    shown = [(room.text(f"robotRow{i}Word"), room.text(f"robotRow{i}Text")) for i in range(3)]
    assert shown == [
        ("passed", "NX Information Server(Ver 1.00)"),
        ("failed because", "the pendant's key is in TEACH"),
        ("not run", ""),
    ]
    room.show(robot=RobotCard("192.168.1.31:80", True, "connected", ROWS[:1]))
    assert room.text("robotRow1Word") == ""


def test_a_value_in_its_range_is_applied(qtbot, room):
    open_tab(room, FIELD)
    enter(room, "setting_robot.ext_radius_mm", "1000")
    press_when_possible(qtbot, room, "robotDraftApply")
    qtbot.waitUntil(lambda: bool(made(room, "change_settings")), timeout=5000)
    assert room.setup.calls == ["change_settings {'robot.ext_radius_mm': 1000.0}"]
    qtbot.waitUntil(lambda: "Applied" in room.text("robotDraftText"), timeout=5000)
    assert not room.button("robotDraftApply").isEnabled()


@pytest.mark.parametrize(
    ("typed", "words"),
    [
        ("5000", "allowed is 100 to 1378.5 mm"),
        ("far", "enter a number"),
        ("", "enter a number"),
    ],
)
def test_a_value_out_of_range_is_refused_beside_its_field(qtbot, room, typed, words):
    open_tab(room, FIELD)
    assert room.text("note_robot.ext_radius_mm") == "Allowed: 100 to 1378.5"
    line = field(room, "setting_robot.ext_radius_mm")
    line.selectAll()
    QTest.keyClick(line, Qt.Key.Key_Delete)
    QTest.keyClicks(line, typed)
    qtbot.waitUntil(lambda: words in room.text("note_robot.ext_radius_mm"), timeout=5000)
    qtbot.waitUntil(lambda: "Cannot be applied" in room.text("robotDraftText"), timeout=5000)
    assert not room.button("robotDraftApply").isEnabled()
    room.press("robotDraftUndo")
    assert line.text() == "1200"
    assert room.text("note_robot.ext_radius_mm") == "Allowed: 100 to 1378.5"
    assert not made(room, "change_settings")


def test_what_only_the_engine_refuses_is_said_beside_the_field_too(qtbot, room):
    open_tab(room, FIELD)
    room.setup.refused = {"robot.margin_mm": "5 is wider than the site allows"}
    enter(room, "setting_robot.margin_mm", "5")
    qtbot.waitUntil(
        lambda: room.text("note_robot.margin_mm") == "5 is wider than the site allows", timeout=5000
    )


def test_the_picture_follows_what_is_typed_before_it_is_applied(qtbot, room):
    open_tab(room, FIELD)
    picture = room.widget("fieldPicture")
    before = picture.grab().toImage()
    enter(room, "setting_robot.floor_mm", "-100")
    qtbot.waitUntil(lambda: picture.grab().toImage() != before, timeout=5000)
    with_floor = picture.grab().toImage()
    boxes = room.window.findChild(QPlainTextEdit, "setting_robot.keep_outs")
    QTest.keyClicks(boxes, "table: 600, -200, 0 to 900, 200, 300")
    qtbot.waitUntil(lambda: picture.grab().toImage() != with_floor, timeout=5000)
    assert not made(room, "change_settings")
    room.press("robotDraftUndo")
    assert picture.grab().toImage() == before


def test_a_line_that_is_no_box_says_how_one_is_written(qtbot, room):
    open_tab(room, FIELD)
    boxes = room.window.findChild(QPlainTextEdit, "setting_robot.keep_outs")
    QTest.keyClicks(boxes, "table 600")
    qtbot.waitUntil(
        lambda: "name: x, y, z to x, y, z" in room.text("note_robot.keep_outs"), timeout=5000
    )


def test_locked_settings_say_that_they_need_the_pin(room):
    room.setup.rows = tuple(replace(row, is_locked=True) for row in room.setup.rows)
    room.show(lock=LockView(True, False, "Settings that bear on motion are locked."), t_s=NOW_S + 9)
    open_tab(room, FIELD)
    assert not field(room, "setting_robot.speed_mm_s").isEnabled()
    assert room.text("note_robot.speed_mm_s").startswith("Locked.")
    assert room.text("robotLockText") == "Settings that bear on motion are locked."


def test_the_pin_opens_the_lock(qtbot, room):
    room.show(lock=LockView(True, False, "locked"))
    enter(room, "robotLockPin", "4711")
    room.press("robotLockOpen")
    qtbot.waitUntil(lambda: room.setup.calls == ["open_lock 4711"], timeout=5000)
    assert field_text(room, "robotLockPin") == ""


def field_text(room, name: str) -> str:
    return room.window.findChild(QLineEdit, name).text()


@pytest.mark.parametrize("turn", [90, 180, -90])
def test_where_the_operator_faces_is_drawn_and_said(qtbot, room, turn):
    open_tab(room, DRIVE)
    room.press(f"faces_{turn}")
    view = room.window.findChild(FacingView, "facingView")
    qtbot.waitUntil(lambda: view.turn_deg == turn, timeout=5000)
    assert f"along its {robot_axis('X+', turn)}" in room.text("facingWords")
    press_when_possible(qtbot, room, "robotDraftApply")
    qtbot.waitUntil(lambda: bool(made(room, "change_settings")), timeout=5000)
    assert f"'robot.yaw_deg': {turn}" in room.setup.calls[-1]


def hold(qtbot, room, key: Qt.Key = Qt.Key.Key_Space):
    button = room.button("holdStopTest")
    button.setFocus()
    QTest.keyPress(button, key)
    qtbot.waitUntil(lambda: bool(made(room, "begin_stop_test")), timeout=5000)
    return button


def test_holding_moves_the_way_that_was_chosen_and_letting_go_stops(qtbot, room):
    open_tab(room, STOP_TEST)
    room.press("stopTest_X-")
    button = hold(qtbot, room)
    assert room.setup.calls == ["begin_stop_test X-"]
    room.show(
        stop_test=StopTestView(StopTestPhase.MOVING, "Press STOP now.", "a test is under way")
    )
    assert button.isEnabled(), "what stands against another test must not let this one go"
    assert room.text("stopTestSentence") == "Press STOP now."
    assert not room.button("stopTest_Z+").isEnabled()
    QTest.keyRelease(button, Qt.Key.Key_Space)
    assert room.setup.calls[-1] == "release_stop_test"


def test_a_short_press_moves_nothing(room):
    open_tab(room, STOP_TEST)
    room.press("holdStopTest")
    assert not room.setup.calls


def test_stop_is_pressed_with_the_mouse_while_space_holds_the_button(qtbot, room):
    open_tab(room, STOP_TEST)
    hold(qtbot, room)
    QTest.mousePress(room.button("stopButton"), Qt.MouseButton.LeftButton)
    assert room.cell.calls.count("stop") == 1
    assert not made(room, "release"), "the button is still held"


@pytest.mark.parametrize("leave", ["stepbar", "place", "tab"])
def test_leaving_the_test_lets_go(qtbot, room, leave):
    open_tab(room, STOP_TEST)
    hold(qtbot, room)
    if leave == "tab":
        open_tab(room, CONNECTION)
    else:
        room.press("setupStepSensors" if leave == "stepbar" else "navOperate")
    assert made(room, "release") == ["release_stop_test"]


def test_what_stands_against_a_test_is_said(room):
    open_tab(room, STOP_TEST)
    room.show(stop_test=StopTestView(why_not="Servo power is off"))
    assert "Servo power is off" in room.text("stopTestWhyNot")
    assert not room.button("holdStopTest").isEnabled()


def test_the_result_is_told_with_its_date_and_what_it_is_worth(room):
    open_tab(room, STOP_TEST)
    assert room.text("stopTestResult") == "None yet."
    room.show(stop_test=StopTestView(StopTestPhase.DONE, "stood", "", 186.4, 1.94))
    text = "186 ms from the press to standstill, 1.9 mm further"
    assert room.text("stopTestResult") == text
    assert room.text("stopTestSentence") == "Stood"
    room.show(robot=RobotCard(stop_test=Outcome(Check.PASSED, text, 1.79e9)))
    assert room.text("stopTestResult").startswith(text)
    assert "2026-09-" in room.text("stopTestResult")
    assert Level.OK in [mark.level for mark in room.widget("stopTestPanel").findChildren(Mark)]
    assert "typical of that move" in room.text("stopTestWorth")


@pytest.mark.parametrize("number", range(4))
@pytest.mark.parametrize("size", [(1366, 768), (1920, 1080)])
def test_nothing_is_wider_than_the_screen(room, number, size):
    room.window.resize(*size)
    open_tab(room, number)
    area = room.widget("workArea")
    assert area.horizontalScrollBar().maximum() == 0
    assert area.verticalScrollBar().maximum() == 0
    stop = room.button("stopButton")
    assert stop.visibleRegion().boundingRect() == stop.rect()


def reached_by_tab(room) -> list[str]:
    """Names of what the keyboard reaches, in its order."""
    room.window.activateWindow()
    assert QTest.qWaitForWindowActive(room.window, 5000)
    reached: list[str] = []
    for _ in range(80):
        QTest.keyClick(QApplication.focusWidget() or room.window, Qt.Key.Key_Tab)
        reached.append(QApplication.focusWidget().objectName())
    return reached


def wanted_in_step(room) -> set[str]:
    """Names of what can be used in the step in sight."""
    kinds = (QAbstractButton, QLineEdit, QPlainTextEdit, QComboBox, QTreeWidget)
    step = room.window.findChild(QStackedWidget, "setupSteps").currentWidget()
    found = [widget for kind in kinds for widget in step.findChildren(kind)]
    can_be_used = [w for w in found if w.isVisible() and w.isEnabled() and w.focusPolicy()]
    return {w.objectName() for w in can_be_used if w.objectName() and w.objectName()[:3] != "qt_"}


@pytest.mark.parametrize("number", range(4))
def test_each_part_is_reached_by_keyboard(room, number):
    open_tab(room, number)
    reached, wanted = reached_by_tab(room), wanted_in_step(room)
    directions = {f"stopTest_{label}" for label in ("X+", "X-", "Y+", "Y-", "Z+", "Z-")}
    turns = {"faces_0", "faces_90", "faces_180", "faces_-90"}
    one_of_each = directions | turns  # of an exclusive group the chosen one; arrows do the rest
    assert wanted - one_of_each <= set(reached)
    assert not wanted & directions or directions & set(reached)
    assert not wanted & turns or turns & set(reached)
    assert "robotTabs" in reached


@pytest.mark.parametrize("step", ["Settings", "People"])
def test_the_other_steps_are_reached_by_keyboard(room, step):
    room.setup.folk = (PersonRow("Ana", False, Handedness.RIGHT, 3, "", ""),)
    room.press(f"setupStep{step}")
    reached, wanted = reached_by_tab(room), wanted_in_step(room)
    assert wanted - {"person0Left"} <= set(reached)


def test_the_tabs_are_changed_with_the_arrows(room):
    tabs = room.window.findChild(QTabBar, "robotTabs")
    tabs.setFocus()
    QTest.keyClick(tabs, Qt.Key.Key_Right)
    room.look()
    assert room.widget("fieldForm").isVisible()


@pytest.mark.parametrize("step", ["Robot", "Settings", "People"])
def test_everything_that_can_be_used_has_names(room, step):
    room.setup.folk = (PersonRow("Ana", False, Handedness.RIGHT, 3, "", ""),)
    room.press(f"setupStep{step}")
    for number in range(4) if step == "Robot" else (0,):
        if step == "Robot":
            open_tab(room, number)
        stack = room.window.findChild(QStackedWidget, "setupSteps").currentWidget()
        for kind in (QAbstractButton, QLineEdit, QPlainTextEdit, QComboBox):
            for widget in stack.findChildren(kind):
                if widget.isVisible() and widget.focusPolicy() is not Qt.FocusPolicy.NoFocus:
                    assert widget.objectName(), widget
                    assert widget.accessibleName() or widget.text(), widget.objectName()


def test_the_keyboard_stays_where_it_was_used_when_a_button_goes(qtbot, room):
    room.window.activateWindow()
    assert QTest.qWaitForWindowActive(room.window, 5000)
    room.show(lock=LockView(True, False, "locked"))
    enter(room, "robotLockPin", "4711")
    QTest.keyClick(field(room, "robotLockPin"), Qt.Key.Key_Return)
    qtbot.waitUntil(lambda: bool(room.setup.calls), timeout=5000)
    room.look()
    assert QApplication.focusWidget().objectName() == "robotLock"
    open_tab(room, FIELD)
    enter(room, "setting_robot.margin_mm", "30")
    qtbot.waitUntil(room.button("robotDraftApply").isEnabled, timeout=5000)
    room.button("robotDraftApply").setFocus()
    QTest.keyClick(room.button("robotDraftApply"), Qt.Key.Key_Space)
    qtbot.waitUntil(lambda: "Applied" in room.text("robotDraftText"), timeout=5000)
    assert QApplication.focusWidget().objectName() == "robotDraft"
