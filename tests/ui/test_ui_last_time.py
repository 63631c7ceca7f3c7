"""What the guardian did when no window could show it: a bar, put away by a press."""

from pathlib import Path

from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QApplication, QLabel, QPushButton

from gestureapp.cell.last_time import LastTime
from ui.app import run_window
from ui.main_window import MainWindow

TEXT = "At 14:03:12 the program ended while the robot could move. Look at the robot."
EVENT = "last run: the robot was stopped at 14:03:12"
DETAILS = "application gone, at 14:03:12\n/data/guardian.log"


def test_the_bar_is_there_until_it_is_put_away_and_noted_as_shown(qtbot, window, tmp_path: Path):
    bar = window.findChild(QLabel, "lastTimeBar")
    assert not bar.isVisible()
    told = LastTime(TEXT, EVENT, DETAILS, "7 key", tmp_path / "guardian.shown")
    window.tell_last_time(told)
    assert bar.isVisible()
    assert bar.text() == bar.accessibleName() == TEXT
    assert DETAILS in bar.parentWidget().toolTip()
    assert told.shown_file.read_text() == "7 key\n"
    window.findChild(QPushButton, "lastTimeAway").click()
    assert not bar.isVisible()


def test_the_window_of_the_application_tells_it(qapp, cell, tmp_path: Path):
    told = LastTime(TEXT, EVENT, DETAILS, "7 key", tmp_path / "guardian.shown")
    seen: list[str] = []

    def look() -> None:
        (window,) = [w for w in QApplication.topLevelWidgets() if isinstance(w, MainWindow)]
        bar = window.findChild(QLabel, "lastTimeBar")
        assert isinstance(bar, QLabel)
        seen.append(bar.text() if bar.isVisible() else "")

    QTimer.singleShot(100, look)
    run_window(cell, exit_after_s=0.3, last_time=told)
    assert seen == [TEXT]
    assert told.shown_file.exists()
