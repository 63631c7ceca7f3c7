"""The step Sensors: what each card says in each state, and what its buttons ask for."""

from dataclasses import replace

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QComboBox, QProgressBar, QScrollBar, QWidget

from gestureapp.sensing.store import SampleStore
from gestureapp.sensing.values import LinkState, Sample, Side
from gestureapp.setup.values import (
    Check,
    FindingView,
    FoundSensor,
    LinkTestView,
    Outcome,
    PortChoice,
    Remedy,
    ShakeView,
)
from tests.ui.setup_bench import BUSY_PORT, LEFT_PORT, SetupRoom, card, fine
from ui.arm_plot import ArmPlot
from ui.gap_histogram import GapHistogram

RUNNING = LinkTestView(
    Side.LEFT, Outcome(Check.RUNNING), 12.0, histogram=((0.01, 900), (float("inf"), 1))
)


@pytest.fixture
def room(qtbot, cell):
    room = SetupRoom(cell)
    qtbot.addWidget(room.window)
    room.enter("Sensors")
    yield room
    room.window.close()


def combo(room: SetupRoom, name: str) -> QComboBox:
    found = room.window.findChild(QComboBox, name)
    assert found is not None
    return found


def choose(room: SetupRoom, name: str, row: int) -> None:
    """Open the list and press a line of it."""
    box = combo(room, name)
    box.showPopup()
    view = box.view()
    place = view.visualRect(box.model().index(row, 0)).center()
    QTest.mouseClick(view.viewport(), Qt.MouseButton.LeftButton, pos=place)
    QTest.qWait(QApplication.doubleClickInterval() // 8)
    room.look()


@pytest.mark.parametrize("link", LinkState)
def test_the_four_states_are_told_apart_in_words_and_by_their_mark(room, link):
    room.show(left=card(Side.LEFT, link))
    assert room.text("leftSensorState") == link.value
    assert room.text("rightSensorState") == "receiving"
    is_plot = room.widget("leftSetupPlot").isVisible()
    assert is_plot is (link is LinkState.RECEIVING)


def test_figures_of_the_stream_are_shown_with_their_units(room):
    names = ("Rate", "Jitter", "WorstGap", "Lost", "Bad", "Battery")
    shown = [room.text(f"left{name}") for name in names]
    assert shown == ["100 Hz", "6.2 ms", "34 ms", "17", "2", "87 %"]


def test_a_card_says_what_was_checked_and_that_a_link_was_not(room):
    checked = "level, 0.4 degrees, today at 07:58\nlink tested on 21 November 2026, carries 60 ms"
    assert room.text("leftKept") == f"calibrated 2026-11-22, within 4 mg\n{checked}"
    room.show(left=replace(card(Side.LEFT), level="", link="link not tested"))
    assert room.text("leftKept") == "calibrated 2026-11-22, within 4 mg\nlink not tested"


def test_what_is_not_known_is_a_dash(room):
    room.show(left=card(Side.LEFT, LinkState.NO_DATA))
    assert room.text("leftRate") == "\u2013"
    health = replace(room.setup.shown.right.health, battery_percent=None)
    room.show(right=replace(room.setup.shown.right, health=health))
    assert room.text("rightBattery") == "not sent"


def test_advice_and_offending_bytes_stand_where_the_plot_was(room):
    advice = ("switch it on", "pair it")
    room.show(right=card(Side.RIGHT, LinkState.WRONG_DATA, advice=advice, bad_bytes="55 51"))
    assert room.text("rightAdvice") == "1.  switch it on\n2.  pair it"
    assert room.text("rightBadBytes") == "came: 55 51"
    room.show(right=card(Side.RIGHT, LinkState.NO_DATA, advice=advice))
    assert room.text("rightBadBytes") == ""


def test_a_stream_that_is_received_but_not_well_says_why(room):
    health = replace(room.setup.shown.left.health, is_freq_ok=False, reason="52 Hz, 90 wanted")
    room.show(left=card(Side.LEFT, health=health))
    assert room.text("leftSensorState").startswith("receiving,")
    assert room.text("leftProblem") == "52 Hz, 90 wanted"


def test_a_port_is_chosen_from_the_list(room):
    choose(room, "leftPort", 1)
    assert room.setup.calls == ["choose_port left /dev/rfcomm1 witmotion"]


def test_a_port_that_cannot_be_opened_says_why(room):
    assert "in use by another program" in combo(room, "leftPort").itemText(2)
    room.show(left=card(Side.LEFT, LinkState.NOT_CONNECTED, port=BUSY_PORT.url))
    assert room.text("leftPortAbout") == "Port: in use by another program"


def test_any_other_port_can_be_typed(room):
    line = combo(room, "rightPort").lineEdit()
    line.selectAll()
    QTest.keyClicks(line, "socket://10.0.0.7:4001")
    room.look()
    assert line.text() == "socket://10.0.0.7:4001", "what is being typed stays"
    QTest.keyClick(line, Qt.Key.Key_Return)
    room.look()
    assert room.setup.calls == ["choose_port right socket://10.0.0.7:4001 witmotion"]
    assert combo(room, "rightPort").currentText() == "socket://10.0.0.7:4001"


def test_a_protocol_is_chosen_for_the_same_port(room):
    choose(room, "leftProtocol", 0)
    assert room.setup.calls == ["choose_port left /dev/rfcomm0 csv"]
    assert room.text("leftPortAbout").startswith("one line a sample, in g")


def test_a_wish_that_was_not_taken_is_not_shown_for_long(room, qtbot):
    room.setup.takes_ports = False
    choose(room, "leftProtocol", 0)
    assert combo(room, "leftProtocol").currentText() == "csv"
    line = combo(room, "rightPort").lineEdit()
    line.selectAll()
    QTest.keyClicks(line, "socket://10.0.0.7:4001")
    QTest.keyClick(line, Qt.Key.Key_Return)

    def are_back():
        room.look()
        assert combo(room, "leftProtocol").currentText() == "witmotion"
        assert combo(room, "rightPort").currentText() == "BWT901CL right  (/dev/rfcomm1)"

    qtbot.waitUntil(lambda: are_back() is None, timeout=5000)


def test_ports_that_come_and_go_leave_the_chosen_one(room):
    room.show(ports=(PortChoice("/dev/ttyACM0", "Arduino"), LEFT_PORT))
    assert combo(room, "leftPort").currentText() == "BWT901CL left  (/dev/rfcomm0)"
    room.show(ports=())
    assert combo(room, "leftPort").currentText() == "/dev/rfcomm0"
    assert room.setup.calls == []


@pytest.mark.parametrize(
    ("act", "call"),
    [
        (Remedy.SWAP, "swap_sensors"),
        (Remedy.TEST_LINK, "begin_link_test left"),
        (Remedy.FIND, "find_sensors"),
    ],
)
def test_a_problem_has_its_remedy_and_the_button_that_does_it(room, act, call):
    room.show(left=card(Side.LEFT, problem="not well", remedy="mend it", act=act))
    assert (room.text("leftProblem"), room.text("leftRemedy")) == ("not well", "mend it")
    assert room.button("leftAct").text() == act.value
    room.press("leftAct")
    assert room.setup.calls == [call]


def test_calibrating_is_offered_where_it_is_missing(room):
    room.show(right=card(Side.RIGHT, problem="not calibrated", act=Remedy.CALIBRATE))
    room.press("rightAct")
    assert room.widget("setupCalibrateStep").isVisible()
    assert not room.button("setupStepSensors").isChecked()


def test_a_sensor_without_a_problem_has_no_button_for_one(room):
    assert not room.button("leftAct").isVisible()
    assert room.text("leftProblem") == "nothing stands against this sensor"


def test_shaking_takes_the_whole_step_and_can_be_given_up(room):
    room.press("assignByShaking")
    room.show(shake=ShakeView(True, "Shake the sensor on your LEFT arm", 0.1, 0.8))
    assert room.text("shakeSentence") == "Shake the sensor on your LEFT arm"
    bars = [room.window.findChild(QProgressBar, f"{side}Shake") for side in ("left", "right")]
    assert [bar.value() for bar in bars] == [10, 80]
    assert not room.widget("leftSensorCard").isVisible()
    room.press("shakeClose")
    assert room.setup.calls == ["begin_shake", "end_shake"]
    assert room.widget("leftSensorCard").isVisible()


def test_what_came_of_shaking_stays_until_it_is_put_away(room):
    room.press("assignByShaking")
    room.show(shake=ShakeView(False, "The two are swapped now."))
    assert room.text("shakeSentence") == "The two are swapped now."
    assert room.button("shakeClose").text() == "Back"


def test_shaking_needs_data_from_both(room):
    room.show(left=card(Side.LEFT, LinkState.NO_DATA))
    assert not room.button("assignByShaking").isEnabled()
    assert room.text("setupSensorsTold") == "Shaking needs data from both sensors."


def test_a_link_that_brings_nothing_is_not_tested(room):
    room.show(left=card(Side.LEFT, LinkState.WRONG_DATA))
    assert not room.button("leftTestLink").isEnabled()
    assert room.button("rightTestLink").isEnabled()


def test_found_sensors_are_given_to_an_arm(room):
    room.press("findSensors")
    strange = FoundSensor(BUSY_PORT, "", 0.0, "FT232R: bytes that no protocol reads")
    band = FoundSensor(PortChoice("/dev/rfcomm2", "band"), "binary", 99.0, "band: binary, 99 Hz")
    mine = FoundSensor(LEFT_PORT, "witmotion", 100.0, "BWT901CL left: witmotion, 100 Hz")
    room.show(finding=FindingView(False, "Three ports send.", (mine, strange, band)))
    assert room.text("found_2") == "band: binary, 99 Hz"
    assert room.button("found_0_left").text() == "is the left arm's"
    assert not room.button("found_0_left").isEnabled()
    assert not room.button("found_1_left").isEnabled()
    room.press("found_2_right")
    assert room.setup.calls == ["find_sensors", "choose_port right /dev/rfcomm2 binary"]
    assert room.button("found_2_right").text() == "is the right arm's"
    room.press("findClose")
    assert room.widget("leftSensorCard").isVisible()


def test_the_link_test_shows_its_progress_its_figures_and_its_verdict(room):
    room.press("leftTestLink")
    room.show(link_test=RUNNING)
    assert room.text("linkTestTitle") == "Link test: left arm's sensor"
    assert not room.button("linkTestAgain").isEnabled()
    assert room.text("linkLowestTrip") == "\u2013"
    failed = Outcome(Check.FAILED, "worst gap 134 ms")
    ended = replace(RUNNING, outcome=failed, lowest_trip_s=0.2, set_trip_s=0.1)
    room.show(link_test=ended)
    assert room.text("linkOutcome") == "failed: worst gap 134 ms"
    assert room.text("linkLowestTrip") == "200 ms or more"
    histogram = room.window.findChild(GapHistogram, "linkHistogram")
    assert "901, of these 1 longer than 100 ms" in histogram.accessibleName()
    room.press("linkTestAgain")
    room.press("linkTestClose")
    assert room.setup.calls == ["begin_link_test left", "begin_link_test left"]
    assert room.text("leftLinkTested") == "failed: worst gap 134 ms"


def test_a_link_test_under_way_can_be_stopped(room):
    room.press("rightTestLink")
    room.show(link_test=replace(RUNNING, side=Side.RIGHT))
    room.press("linkTestClose")
    assert room.setup.calls == ["begin_link_test right", "end_link_test"]


def test_going_away_ends_what_nobody_would_see(room):
    room.press("assignByShaking")
    room.press("setupStepCalibrate")
    room.press("setupStepSensors")
    room.press("findSensors")
    room.press("navOperate")
    assert room.setup.calls == [
        "begin_shake",
        "end_shake",
        "find_sensors",
        "stop_finding",
        "setup closed",
    ]


def test_swapping_asks_for_two_sensors(room):
    room.press("swapSensors")
    assert room.setup.calls == ["swap_sensors"]
    room.show(right=card(Side.RIGHT, LinkState.NOT_CONNECTED, port=""))
    assert not room.button("swapSensors").isEnabled()


def test_a_long_path_leaves_both_cards_as_wide_as_each_other(room):
    path = "/home/operator/" + "a_very_long_folder-name/" * 9 + "wrist.json"
    room.show(
        left=card(Side.LEFT, problem=f"{path} is damaged", remedy=path, act=Remedy.CALIBRATE),
        right=card(Side.RIGHT, LinkState.NO_DATA, name=path),
    )
    cards = [room.widget(f"{side.value}SensorCard") for side in Side]
    assert abs(cards[0].width() - cards[1].width()) <= 1
    assert room.window.width() == 1366
    assert room.text("leftProblem") == f"{path} is damaged"
    bar = room.window.findChildren(QScrollBar)
    shown = [
        one for one in bar if one.isVisible() and one.orientation() is Qt.Orientation.Horizontal
    ]
    assert shown == []


def test_the_charge_of_a_sensor_that_is_away_is_not_shown(room):
    assert room.text("leftBattery") == "87 %"
    away = replace(room.setup.shown.left.health, link=LinkState.NOT_CONNECTED, rate_hz=0.0)
    room.show(left=card(Side.LEFT, health=away))
    assert room.text("leftBattery") == "\u2013"


def test_a_plot_bridges_no_gap_and_begins_anew_with_another_sensor(qtbot):
    plot = ArmPlot("gapPlot", "Left arm")
    qtbot.addWidget(plot)
    store = SampleStore()
    for tick in [*range(100), *range(150, 200)]:
        store.append(Sample(tick * 0.01, tick, (0.0, 0.0, 1.0)))
    plot.show_samples(store, 2.0, True)
    connect = plot._curves[0].opts["connect"]
    assert [int(at) for at in np.flatnonzero(connect == 0)] == [99, 149]
    plot.begin_anew()
    plot.show_samples(store, 2.0, True)
    assert len(plot.curve(0)[0]) == 0
    store.append(Sample(2.01, 200, (0.0, 0.0, 1.0)))
    plot.show_samples(store, 2.02, True)
    assert len(plot.curve(0)[0]) == 1


def test_nothing_moves_as_a_problem_comes_and_goes(room):
    card_before = room.widget("leftSensorCard").geometry()
    room.show(left=card(Side.LEFT, problem="not calibrated", remedy="calibrate it"))
    assert room.widget("leftSensorCard").geometry() == card_before
    room.setup.shown = fine()
    room.look()
    assert room.widget("leftSensorCard").geometry() == card_before


@pytest.mark.parametrize("key", [Qt.Key.Key_Escape, Qt.Key.Key_Pause])
def test_the_stop_keys_stop_while_a_port_is_typed(room, key):
    line: QWidget = combo(room, "leftPort").lineEdit()
    line.setFocus()
    QTest.keyClick(line, key)
    assert room.cell.calls == ["stop"]


def test_typing_a_port_moves_no_arm_of_the_demonstration(qtbot, cell, operator):
    room = SetupRoom(cell, operator)
    qtbot.addWidget(room.window)
    room.enter("Sensors")
    room.window.activateWindow()
    assert QTest.qWaitForWindowActive(room.window, 5000)
    combo(room, "leftPort").setFocus()
    combo(room, "leftPort").lineEdit().selectAll()
    for letter in "sad fog rat":
        QTest.keyClick(QApplication.focusWidget(), letter)
    assert combo(room, "leftPort").currentText() == "sad fog rat"
    assert operator.done == []
    room.window.close()


@pytest.mark.parametrize("name", ["assignByShaking", "findSensors", "leftTestLink"])
def test_a_second_space_does_not_press_what_came_instead(room, name):
    room.window.activateWindow()
    assert QTest.qWaitForWindowActive(room.window, 5000)
    room.button(name).setFocus(Qt.FocusReason.TabFocusReason)
    QTest.keyClick(room.button(name), Qt.Key.Key_Space)
    room.look()
    asked = list(room.setup.calls)
    assert len(asked) == 1
    QTest.keyClick(QApplication.focusWidget() or room.window, Qt.Key.Key_Space)
    room.look()
    assert room.setup.calls == asked
