"""A window at its training page, with a simulated person whose time passes only when told."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QAbstractButton, QApplication, QLabel, QWidget

from gestureapp.guided.sitting import Sitting
from gestureapp.guided.values import GuidedSnapshot, Pace, TrainingView
from gestureapp.recognition.presets import Preset
from gestureapp.recording.take_values import Take
from tests.guided.bench import Bench
from ui.main_window import MainWindow


class DeskControls:
    """``GuidedControls`` on a desk without its thread: wishes are granted at the next tick."""

    def __init__(self, bench: Bench) -> None:
        self.bench = bench
        self.names: tuple[str, ...] = ()

    def snapshot(self) -> GuidedSnapshot:
        return self.bench.picture

    def people(self) -> tuple[str, ...]:
        return self.names

    def last_person(self) -> str:
        return self.names[-1] if self.names else ""

    def open(self, person: str) -> None:
        self.bench.desk.open(person)
        self.names = tuple({*self.names, person})

    def close(self) -> None:
        self.bench.desk.close()

    def choose(self, label: str) -> None:
        self._sitting.choose(label)

    def set_pace(self, pace: Pace, beat_s: float) -> None:
        self.bench.desk.set_pace(pace, beat_s)

    def set_wanted(self, n_takes: int) -> None:
        self.bench.desk.set_wanted(n_takes)

    def start(self) -> None:
        self.bench.desk.start()

    def pause(self) -> None:
        self._sitting.pause()

    def go_on(self) -> None:
        self.bench.desk.go_on()

    def end_batch(self) -> None:
        self._sitting.end_batch()

    def redo_last(self) -> None:
        self._sitting.redo_last()

    def undo(self) -> None:
        self._sitting.undo()

    def redo(self) -> None:
        self._sitting.redo()

    def exclude(self, take_id: int, *, is_excluded: bool = True) -> None:
        self._sitting.exclude(take_id, is_excluded=is_excluded)

    def move(self, take_id: int, label: str) -> None:
        self._sitting.move(take_id, label)

    def delete(self, take_id: int) -> None:
        self._sitting.delete(take_id)

    def takes(self, label: str = "") -> tuple[Take, ...]:
        takes = self.bench.desk.takes
        return tuple(take for take in takes if take.label == label) if label else takes

    def start_trying(self, per_gesture: int = 5) -> None:
        self.bench.desk.start_trying(per_gesture)

    def stop_trying(self) -> None:
        self.bench.desk.stop_trying()

    def keep_heard(self, number: int) -> None:
        self.bench.desk.keep_heard(number)

    @property
    def _sitting(self) -> Sitting:
        sitting = self.bench.desk.sitting
        assert sitting is not None
        return sitting


class NoTrainer:
    """``TrainerControls`` of somebody who has no model and trains none."""

    def view(self) -> TrainingView:
        return TrainingView()

    def start(self, preset: Preset = Preset.DEFAULT, seed: int = 0) -> None:
        raise NotImplementedError

    def cancel(self) -> None:
        raise NotImplementedError


class Room:
    """The window with the person before it.

    Attributes:
        window: Shown; polled only here.
        bench: The person, the sensors and the clock.
    """

    def __init__(self, cell, operator, folder: Path) -> None:
        self.bench = Bench(folder)
        self.controls = DeskControls(self.bench)
        self.cell = cell
        cell.left, cell.right = self.bench.arms.left, self.bench.arms.right
        self.window = MainWindow(
            cell, operator, lambda: self.bench.now_s, self.controls, NoTrainer()
        )
        self.window.resize(1366, 768)
        self.window.show()
        self.look()

    def look(self) -> None:
        """The window's timer comes round."""
        picture = self.bench.arms.snapshot()
        self.cell.shown = replace(
            self.cell.shown,
            t_s=self.bench.now_s,
            left=picture.left,
            right=picture.right,
            posture=self.bench.picture.posture,
        )
        self.window.poll()

    def run(self, span_s: float) -> None:
        """Let time pass, then look."""
        self.bench.run(span_s)
        self.look()

    def run_until(self, condition: Callable[[GuidedSnapshot], bool]) -> None:
        """Let time pass until it is so, then look."""
        self.bench.run_until(condition)
        self.look()

    def press(self, name: str) -> None:
        """Press a button that is in sight and can be pressed."""
        found = self.button(name)
        assert found.isVisible(), f"{name} is not in sight"
        assert found.isEnabled(), f"{name} cannot be pressed"
        QTest.mouseClick(found, Qt.MouseButton.LeftButton)
        self.run(0.01)

    def key(self, key: Qt.Key, modifier: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier):
        """Press a key where the keyboard is."""
        QTest.keyClick(QApplication.focusWidget() or self.window, key, modifier)
        self.run(0.01)

    def button(self, name: str) -> QAbstractButton:
        found = self.window.findChild(QAbstractButton, name)
        assert found is not None, name
        return found

    def text(self, name: str) -> str:
        label = self.window.findChild(QLabel, name)
        assert label is not None, name
        return label.text()

    def widget(self, name: str) -> QWidget:
        found = self.window.findChild(QWidget, name)
        assert found is not None, name
        return found

    def record(self, person: str = "Ana") -> None:
        """Go through person and sensors to the recording."""
        self.press("navTrain")
        self.controls.open(person)
        self.run(0.05)
        self.press("stepRecord")
