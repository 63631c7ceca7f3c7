"""A bar that comes or goes moves nothing that can be pressed."""

from dataclasses import replace
from pathlib import Path

import pytest
from PySide6.QtCore import QRect, Qt
from PySide6.QtWidgets import QAbstractButton, QApplication, QLabel, QPushButton, QWidget

from gestureapp.cell.last_time import LastTime
from ui.alarm_bars import UNCONFIRMED

SIZES = [(1280, 720), (1366, 768), (1920, 1080)]
TOLD = (
    "IT IS NOT CONFIRMED THAT THE ROBOT STOPPED. At 22:11:02 on 23 November 2026 the robot was "
    "held or switched elsewhere while the robot could move. Look at the robot before you arm."
)


def frame_of(window: QWidget, each: QWidget) -> QRect:
    return QRect(each.mapTo(window, each.rect().topLeft()), each.size())


def buttons_of(window: QWidget) -> dict[str, QRect]:
    QApplication.processEvents()
    return {
        each.objectName(): frame_of(window, each)
        for each in window.findChildren(QAbstractButton)
        if each.objectName() != "lastTimeAway" and each.isVisible()
    }


def label(window: QWidget, name: str) -> QLabel:
    return window.findChild(QLabel, name)


def make_blind(window, cell) -> None:
    cell.failure = RuntimeError("the cell is gone " * 9)
    window.poll()


def make_unconfirmed(window, cell) -> None:
    cell.shown = replace(cell.shown, is_stop_unconfirmed=True)
    window.poll()


@pytest.fixture(params=SIZES, ids=str)
def sized_window(request, qtbot, window):
    window.resize(*request.param)
    qtbot.waitUntil(lambda: (window.width(), window.height()) == request.param)
    return window


@pytest.mark.logs_errors
def test_no_button_moves_whatever_bar_comes_or_goes(sized_window, cell, tmp_path: Path):
    window = sized_window
    before = buttons_of(window)
    assert {"armButton", "disarmButton", "servoButton", "stopButton"} <= set(before)
    window.tell_last_time(LastTime(TOLD, "", "", "key", tmp_path / "guardian.shown"))
    assert buttons_of(window) == before
    make_unconfirmed(window, cell)
    assert buttons_of(window) == before
    make_blind(window, cell)
    assert buttons_of(window) == before
    cell.failure = None
    cell.shown = replace(cell.shown, is_stop_unconfirmed=False)
    window.poll()
    assert buttons_of(window) == before
    window.findChild(QPushButton, "lastTimeAway").click()
    assert buttons_of(window) == before


def test_no_button_moves_however_long_the_sentence_is(sized_window, cell):
    before = buttons_of(sized_window)
    cell.shown = replace(cell.shown, sentence="The left sensor is silent. " * 9)
    sized_window.poll()
    assert buttons_of(sized_window) == before


def test_the_alarm_has_the_whole_width_and_one_line(sized_window, cell):
    make_unconfirmed(sized_window, cell)
    QApplication.processEvents()
    bar = label(sized_window, "stopUnconfirmedBar")
    assert bar.width() == sized_window.width()
    assert bar.height() >= 40
    assert bar.fontMetrics().horizontalAdvance(UNCONFIRMED) < bar.width()
    assert bar.font().pixelSize() == 22


@pytest.mark.logs_errors
def test_alarm_and_blindness_can_both_be_read(sized_window, cell):
    make_unconfirmed(sized_window, cell)
    make_blind(sized_window, cell)
    QApplication.processEvents()
    for name in ("stopUnconfirmedBar", "blindBar"):
        bar = label(sized_window, name)
        assert bar.isVisible()
        assert bar.height() >= bar.fontMetrics().height()
    assert cell.failure.args[0] in label(sized_window, "blindBar").toolTip()


def test_the_alarm_covers_the_notice_and_gives_it_back(qtbot, window, cell, tmp_path: Path):
    window.tell_last_time(LastTime(TOLD, "", "", "key", tmp_path / "guardian.shown"))
    away = window.findChild(QPushButton, "lastTimeAway")
    make_unconfirmed(window, cell)
    QApplication.processEvents()
    at = away.mapTo(window, away.rect().center())
    assert window.childAt(at) is label(window, "stopUnconfirmedBar")
    cell.shown = replace(cell.shown, is_stop_unconfirmed=False)
    window.poll()
    assert window.childAt(at) is away
    qtbot.mouseClick(away, Qt.MouseButton.LeftButton)
    assert not label(window, "lastTimeBar").isVisible()


def test_the_notice_has_room_for_its_words(sized_window, tmp_path: Path):
    sized_window.tell_last_time(LastTime(TOLD, "", "", "key", tmp_path / "guardian.shown"))
    QApplication.processEvents()
    bar = label(sized_window, "lastTimeBar")
    assert bar.heightForWidth(bar.width()) <= bar.height()
