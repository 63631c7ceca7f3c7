"""The setup's page before a running demonstration: emulated sensors, a real desk, real presses."""

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import QCoreApplication, QEvent, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QAbstractButton, QComboBox, QLabel

from gestureapp.cell.snapshot import CellState
from gestureapp.config import Settings
from gestureapp.running import RunningCell, running_cell
from gestureapp.sensing.values import Side
from gestureapp.setup.values import Check
from gestureapp.simulation.demo import DemoOptions
from ui.main_window import MainWindow

LIMIT_MS = 30_000
NOBODY = "socket://127.0.0.1:9"
"""Nothing listens there."""


class Demo:
    """The window of a demonstration, with its own timer running."""

    def __init__(self, qtbot, running: RunningCell) -> None:
        self.qtbot, self.running = qtbot, running
        self.window = MainWindow(
            running.cell,
            running.operator,
            guided=running.guided,
            trainer=running.trainer,
            setup=running.setup,
        )
        qtbot.addWidget(self.window)
        self.window.resize(1366, 768)
        self.window.show()

    def see(self, condition: Callable[[], bool]) -> None:
        self.qtbot.waitUntil(condition, timeout=LIMIT_MS)

    def press(self, name: str) -> None:
        button = self.window.findChild(QAbstractButton, name)
        self.see(lambda: button.isVisible() and button.isEnabled())
        QTest.mouseClick(button, Qt.MouseButton.LeftButton)

    def text(self, name: str) -> str:
        return self.window.findChild(QLabel, name).text()

    def type_port(self, side: Side, port: str) -> None:
        box = self.window.findChild(QComboBox, f"{side.value}Port")
        box.setFocus()
        box.lineEdit().selectAll()
        QTest.keyClicks(box, port)
        QTest.keyClick(box, Qt.Key.Key_Return)


@pytest.fixture
def demo(qtbot, tmp_path: Path) -> Iterator[Demo]:
    files = [tmp_path / "settings.toml"]
    with running_cell(Settings(), tmp_path / "data", DemoOptions(), files) as running:
        demo = Demo(qtbot, running)
        demo.see(lambda: running.cell.snapshot().state is CellState.READY)
        yield demo
        demo.window.close()
        demo.window.deleteLater()
        QCoreApplication.sendPostedEvents(demo.window, QEvent.Type.DeferredDelete.value)


@pytest.mark.process
def test_a_sensor_is_lost_by_a_wrong_port_and_found_again_by_the_right_one(demo):
    port = demo.running.cell.settings.left.port
    demo.press("navSetup")
    demo.see(lambda: demo.text("leftSensorState") == "receiving")
    demo.see(lambda: demo.text("stripLine").startswith("Setup is open: arming is locked"))
    demo.type_port(Side.LEFT, NOBODY)
    demo.see(lambda: demo.text("leftSensorState") == "not connected")
    demo.see(lambda: demo.text("leftAdvice") != "")
    assert demo.text("rightSensorState") == "receiving"
    demo.type_port(Side.LEFT, port)
    demo.see(lambda: demo.text("leftSensorState") == "receiving")


@pytest.mark.process
def test_postures_are_recorded_and_arming_is_possible_after_the_setup(demo):
    operator = demo.running.operator
    assert operator is not None
    demo.running.setup.choose_person("Ana")
    demo.see(lambda: demo.running.setup.snapshot().postures.person == "Ana")
    demo.press("navSetup")
    demo.press("setupStepCalibrate")
    demo.press("calibratePostures")
    demo.press("beginPostures")
    demo.see(lambda: demo.running.setup.snapshot().postures.is_stop_done)
    operator.left_start()
    demo.see(lambda: demo.text("posturesOutcome").startswith(Check.PASSED.value))
    margin = demo.text("posturesMargin")
    assert margin.endswith("\u00b0")
    assert int(margin[:-1]) > 5
    operator.left_stop()
    blockers = {each.id for each in demo.running.cell.snapshot().blockers}
    assert "setup" in blockers
    demo.press("navOperate")

    def is_open() -> bool:
        blockers = {each.id for each in demo.running.cell.snapshot().blockers}
        return not blockers & {"setup", "postures", "left_unfit", "right_unfit", "left_stop"}

    demo.see(is_open)


@pytest.mark.process
def test_a_sensor_is_calibrated_by_whoever_follows_the_sentences(demo):
    demo.press("navSetup")
    demo.press("setupStepCalibrate")
    demo.press("followPrompts")
    demo.press("beginCalibration")
    demo.see(lambda: demo.text("calibrateOutcome").startswith(Check.PASSED.value))
    assert demo.text("calibrateAfter").endswith("mg")
    demo.see(lambda: demo.window.findChild(QAbstractButton, "calibrate_left").state != "")
    record = demo.running.setup.snapshot().left
    assert record.problem == ""
