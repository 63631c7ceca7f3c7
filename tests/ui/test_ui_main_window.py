"""The window as a person sees and uses it, on a fake cell."""

import logging
from dataclasses import replace

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QAbstractButton,
    QApplication,
    QLabel,
    QProgressBar,
    QPushButton,
    QScrollArea,
    QWidget,
)

from gestureapp.cell.snapshot import Blocker, CellState
from gestureapp.gestures import GESTURES, LABELS
from gestureapp.robot.values import RobotStatus
from ui.alarm_bars import UNCONFIRMED, AlarmBars
from ui.blocker_list import BlockerList
from ui.main_window import MainWindow
from ui.theme import DARK, LIGHT, palette_of


def text_of(window: QWidget, name: str) -> str:
    label = window.findChild(QLabel, name)
    assert label is not None, name
    return label.text()


def button(window: QWidget, name: str) -> QPushButton:
    found = window.findChild(QPushButton, name)
    assert found is not None, name
    return found


def show(window: MainWindow, cell, snapshot) -> None:
    cell.shown = snapshot
    window.poll()


def test_the_poll_runs_by_itself_and_ticks_each_time(qtbot, window, cell):
    before = cell.n_ticks
    qtbot.waitUntil(lambda: cell.n_ticks >= before + 10, timeout=5000)
    assert cell.n_ticks == cell.n_polls


def test_each_state_stands_in_one_word_with_its_sentence(window, cell):
    for state in CellState:
        show(window, cell, replace(cell.shown, state=state, sentence=f"About {state.value}"))
        assert text_of(window, "stateLabel") == state.value
        assert text_of(window, "sentenceLabel") == f"About {state.value}"


def test_the_state_can_be_read_from_three_metres(window):
    metrics = window.findChild(QLabel, "stateLabel").fontMetrics()
    assert metrics.capHeight() >= 48


def test_every_blocker_is_listed_with_its_remedy(window, cell, scenes):
    show(window, cell, scenes.blocked(9))
    rows = window.findChild(BlockerList).rows
    listed = [(row.text, row.remedy) for row in rows]
    assert listed == [(b.text, b.remedy) for b in cell.shown.blockers]
    show(window, cell, scenes.ready())
    assert window.findChild(BlockerList).rows == ()
    assert text_of(window, "blockerTitle") == "Nothing stands against arming"


def test_holding_the_arm_button_arms(qtbot, window, cell):
    qtbot.mousePress(button(window, "armButton"), Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: cell.calls == ["arm"], timeout=5000)


def test_the_arm_button_is_dead_while_something_stands_against_arming(qtbot, window, cell, scenes):
    show(window, cell, scenes.blocked())
    assert not button(window, "armButton").isEnabled()


def test_disarm_works_while_the_permission_is_given(qtbot, window, cell, scenes):
    assert not button(window, "disarmButton").isEnabled()
    show(window, cell, scenes.moving())
    qtbot.mouseClick(button(window, "disarmButton"), Qt.MouseButton.LeftButton)
    assert cell.calls == ["disarm"]


def test_servo_on_works_only_while_the_servo_is_off(qtbot, window, cell):
    assert not button(window, "servoButton").isEnabled()
    off = replace(cell.shown.robot, status=RobotStatus(data_1=0xC0, data_2=0))
    show(window, cell, replace(cell.shown, state=CellState.NOT_READY, robot=off, can_arm=False))
    qtbot.mouseClick(button(window, "servoButton"), Qt.MouseButton.LeftButton)
    assert cell.calls == ["servo_on"]


def test_a_blocker_with_a_long_path_is_not_cut(window, cell):
    path = "/home/operator/" + "a_very_long_folder-name/" * 9 + "model.onnx"
    long = Blocker("model", f"{path}: is damaged", f"train anew, or choose another than {path}")
    show(window, cell, replace(cell.shown, state=CellState.NOT_READY, blockers=(long,)))
    area = window.findChild(QScrollArea, "blockerArea")
    (row,) = window.findChild(BlockerList, "blockerList").rows
    assert row.text == long.text
    assert row.width() <= area.viewport().width()


def test_servo_off_is_offered_while_the_controller_keeps_a_move(qtbot, window, cell):
    kept = Blocker("move_kept", "the controller goes on with the move", "press Servo off")
    stopped = replace(cell.shown, state=CellState.STOPPED, blockers=(kept,), can_arm=False)
    show(window, cell, stopped)
    assert button(window, "servoButton").text() == "Servo off"
    qtbot.mouseClick(button(window, "servoButton"), Qt.MouseButton.LeftButton)
    off = replace(cell.shown.robot, status=RobotStatus(data_1=0xC0, data_2=8))
    show(window, cell, replace(stopped, blockers=(), robot=off))
    assert button(window, "servoButton").text() == "Servo on"
    qtbot.mouseClick(button(window, "servoButton"), Qt.MouseButton.LeftButton)
    assert cell.calls == ["servo_off", "servo_on"]


@pytest.mark.parametrize(
    ("robot", "text"),
    [
        ({}, "off"),
        ({"supervision": "on, #22010, 5 Hz"}, "on, #22010, 5 Hz"),
        ({"supervision": "on, #22010, 5 Hz", "is_supervision_working": False}, "not working"),
    ],
)
def test_the_strip_shows_whether_the_controller_supervises(window, cell, robot, text):
    show(window, cell, replace(cell.shown, robot=replace(cell.shown.robot, **robot)))
    assert text_of(window, "supervisionChipValue") == text


def test_each_recognised_gesture_is_named_with_its_certainty_and_time(window, cell, scenes):
    for gesture in GESTURES:
        show(window, cell, replace(cell.shown, recognition=scenes.recognised(gesture.label)))
        assert text_of(window, "gestureLabel") == gesture.label
        assert text_of(window, "gestureWords") == gesture.words
        assert window.findChild(QProgressBar, "certaintyBar").value() == 93
        assert "22 ms" in text_of(window, "decisionLabel")


def test_not_recognised_names_the_two_best(window, cell, scenes):
    show(window, cell, replace(cell.shown, recognition=scenes.not_recognised()))
    words = text_of(window, "gestureWords").replace("\u00a0", " ")
    assert words == "not recognised: no clear gesture (X+ 0.48, RY- 0.41)"


def test_an_answer_from_the_onset_says_how_long_it_took_and_what_it_needed(window, cell, scenes):
    for certainty, needed in ((0.97, "0.95 at once"), (0.7, "0.60 in the end")):
        answer = scenes.followed("Y+", certainty)
        show(window, cell, replace(cell.shown, recognition=answer))
        assert text_of(window, "decisionLabel") == "decided 62 ms after the onset"
        bar = window.findChild(QProgressBar, "certaintyBar")
        assert bar.format() == f"certainty {certainty:.2f}, needed {needed}"


def test_an_answer_without_an_onset_is_timed_from_the_activation(window, cell, scenes):
    answer = replace(scenes.followed("RY+", 0.97), onset_s=None)
    held = replace(answer, activation_s=answer.decided_s - 0.012)
    show(window, cell, replace(cell.shown, recognition=held))
    assert text_of(window, "decisionLabel") == "decided 12 ms after the activation"


def test_two_candidates_are_named_once(window, cell, scenes):
    answer = scenes.followed(None, 0.47, "two candidates (Y+ 0.47, RZ+ 0.41)")
    show(window, cell, replace(cell.shown, recognition=answer))
    words = text_of(window, "gestureWords")
    assert words == "not recognised: two candidates (Y+ 0.47, RZ+ 0.41)"


def test_a_move_is_told_before_and_while_it_runs(window, cell, scenes):
    show(window, cell, scenes.moving(share=0.4))
    assert text_of(window, "motionTitle") == "The robot moves"
    assert text_of(window, "motionDirection") == "along X+ (forward)"
    assert text_of(window, "motionStart") == "X 600.0  Y 100.0  Z 300.0 mm"
    assert text_of(window, "motionEnd") == "X 1135.3  Y 100.0  Z 300.0 mm"
    assert text_of(window, "motionDistance") == "535.3 mm"
    assert text_of(window, "motionSpeed") == "100.0 mm/s"
    assert text_of(window, "motionEndsat") == "535.3 mm: outer sphere"
    assert window.findChild(QProgressBar, "motionBar").value() == 400


def test_angles_of_a_rotation_go_on_from_the_start_beyond_the_half_turn(window, cell, scenes):
    show(window, cell, scenes.moving("RX+", share=0.5))
    assert cell.shown.robot.pose.rx_deg < 0
    assert text_of(window, "motionStart") == "Rx 180.0°  Ry 0.0°  Rz 0.0°"
    assert text_of(window, "motionNowat") == "Rx 209.0°  Ry 0.0°  Rz 0.0°"
    assert text_of(window, "motionEnd") == "Rx 238.0°  Ry 0.0°  Rz 0.0°"


def test_the_last_five_events_stand_with_milliseconds_newest_first(window, cell, scenes):
    show(window, cell, replace(cell.shown, events=tuple(scenes.events(7))))
    assert text_of(window, "event_0") == "The robot stands"
    assert text_of(window, "event_4") == "Recognised X+ with certainty 0.93"
    assert text_of(window, "eventTime_0").endswith(":06.062")


def test_an_unconfirmed_stop_shows_the_red_bar_for_as_long_as_it_lasts(window, cell):
    bar = window.findChild(QLabel, "stopUnconfirmedBar")
    assert not bar.isVisible()
    show(window, cell, replace(cell.shown, is_stop_unconfirmed=True))
    assert bar.isVisible()
    assert bar.text() == UNCONFIRMED
    show(window, cell, replace(cell.shown, is_stop_unconfirmed=False))
    assert not bar.isVisible()


def test_an_unconfirmed_stop_sounds_again_and_again(qtbot, clock):
    heard: list[float] = []
    bars = AlarmBars(clock, beep=lambda: heard.append(clock.now_s))
    qtbot.addWidget(bars)
    clock.step_s = 0.25
    for _ in range(13):
        bars.show_unconfirmed(True)
    assert len(heard) == 4, "at once, and then every second"
    bars.show_unconfirmed(False)
    assert len(heard) == 4
    bars.show_unconfirmed(True)
    assert len(heard) == 5


@pytest.mark.logs_errors
def test_a_snapshot_that_raises_is_logged_once_and_the_window_stays(qtbot, window, cell, caplog):
    cell.failure = RuntimeError("the cell is gone")
    ticks = cell.n_ticks
    with caplog.at_level(logging.WARNING):
        qtbot.waitUntil(lambda: window.n_failed >= 5, timeout=5000)
    assert [r.levelname for r in caplog.records] == ["ERROR"]
    assert cell.n_ticks == ticks, "a blind window must not report itself alive"
    assert window.isVisible()
    assert "the cell is gone" in text_of(window, "blindBar")
    assert window.findChild(QLabel, "blindBar").isVisible()
    qtbot.mousePress(window.findChild(QWidget, "stopButton"), Qt.MouseButton.LeftButton)
    assert cell.calls == ["stop"]
    with caplog.at_level(logging.WARNING):
        cell.failure = None
        qtbot.waitUntil(lambda: cell.n_ticks > ticks, timeout=5000)
    assert not window.findChild(QLabel, "blindBar").isVisible()


def test_closing_stops_disarms_and_shuts_down_without_asking(window, cell, scenes):
    show(window, cell, scenes.moving())
    assert window.close()
    assert cell.calls == ["stop", "disarm", "shutdown"]


@pytest.mark.logs_errors
def test_closing_goes_on_when_the_cell_fails(window, cell, caplog):
    def fail() -> None:
        raise RuntimeError("no guardian")

    cell.stop = fail
    assert window.close()
    assert cell.calls == ["disarm", "shutdown"]
    assert "while closing the window" in caplog.text


def test_keys_are_left_alone_once_the_window_is_closed(qtbot, window, cell):
    window.close()
    cell.calls.clear()
    other = QWidget()
    qtbot.addWidget(other)
    qtbot.keyClick(other, Qt.Key.Key_Escape)
    assert cell.calls == []


@pytest.mark.parametrize("size", [(1366, 768), (1920, 1080)])
def test_everything_fits_without_clipping_or_overlap(qtbot, window, cell, scenes, size):
    window.resize(*size)
    qtbot.waitUntil(lambda: (window.width(), window.height()) == size)
    stopped = replace(scenes.blocked(), state=CellState.STOPPED, is_stop_unconfirmed=True)
    after = replace(scenes.moving(), state=CellState.STOPPED, blockers=scenes.blocked(9).blockers)
    for snapshot in (scenes.ready(), scenes.blocked(), scenes.moving(), stopped, after):
        show(window, cell, snapshot)
        QApplication.processEvents()
        assert_fits(window)


def assert_fits(window: MainWindow) -> None:
    area = window.findChild(QWidget, "workArea")
    assert area.widget().width() <= area.viewport().width(), "the middle must not scroll"
    assert area.widget().height() <= area.viewport().height(), "the middle must not scroll"
    names = ["statusStrip", "workArea", "stopButton"]
    parts = [window.findChild(QWidget, name) for name in names]
    frames = [part.rect().translated(part.mapTo(window, part.rect().topLeft())) for part in parts]
    assert not any(a.intersects(b) for i, a in enumerate(frames) for b in frames[i + 1 :])
    for label in window.findChildren(QLabel):
        if label.isVisible() and not label.wordWrap() and label.objectName() in _WHOLE:
            assert label.width() >= label.fontMetrics().horizontalAdvance(label.text())
    for each in window.findChildren(QPushButton):
        lines = each.text().split("\n")
        assert each.width() >= max(each.fontMetrics().horizontalAdvance(line) for line in lines)


_WHOLE = {"stateLabel", "gestureLabel", "motionTitle", "blockerTitle", "leftPlotTitle"}


def test_every_interactive_widget_has_a_name_for_tests_and_for_people(window):
    buttons = window.findChildren(QPushButton)
    assert len(buttons) >= 3 + len(LABELS) + 5
    for each in [*buttons, window.findChild(QWidget, "stopButton")]:
        assert each.objectName()
        assert each.accessibleName()


def test_the_scheme_can_change_while_the_window_is_open(window, cell, scenes):
    app = QApplication.instance()
    for colours in (DARK, LIGHT):
        app.setPalette(palette_of(colours))
        show(window, cell, scenes.moving())
        QApplication.processEvents()
        assert button(window, "armButton").palette().button().color().name() == colours.button
        corner = window.grab().toImage().pixelColor(2, window.height() - 2)
        assert corner.name() == colours.window


def test_a_key_still_held_from_arming_presses_no_other_button(
    qtbot, window, cell, operator, scenes
):
    arm = button(window, "armButton")
    arm.setFocus()
    qtbot.keyPress(arm, Qt.Key.Key_Space)
    qtbot.waitUntil(lambda: cell.calls == ["arm"], timeout=5000)
    show(window, cell, scenes.moving())
    focused = QApplication.focusWidget()
    assert not isinstance(focused, QAbstractButton)
    qtbot.keyRelease(window if focused is None else focused, Qt.Key.Key_Space)
    assert cell.calls == ["arm"]
    assert operator.done == []


def test_the_window_asks_for_no_more_than_the_screen_has(window):
    available = window.screen().availableSize()
    assert window.minimumWidth() <= available.width()
    assert window.minimumHeight() <= available.height()


def test_what_stands_against_arming_is_shown_only_before_a_move(window, cell, scenes):
    show(window, cell, scenes.blocked())
    assert window.findChild(QWidget, "blockerList").isVisible()
    show(window, cell, scenes.moving())
    assert not window.findChild(QWidget, "blockerList").isVisible()
