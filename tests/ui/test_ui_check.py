"""The step Check, on a person's real takes: what is odd is seen, and put right by its buttons."""

from collections.abc import Iterator

import pytest
from PySide6.QtCore import QPointF, Qt
from PySide6.QtWidgets import QLabel, QListWidget, QPushButton, QTableWidget, QToolButton

from gestureapp.config import Settings
from gestureapp.guided.guided import Guided
from tests.guided.bench import SensedArms
from tests.ui.filled import N_TAKES, PERSON, fill
from ui.check_step import CheckStep
from ui.take_curves import TakeCurves
from ui.take_map import TakeMapView
from ui.theme import DARK, palette_of


class Desk:
    """The step in a window, and the person before it."""

    def __init__(self, qtbot, guided: Guided) -> None:
        self.qtbot, self.guided = qtbot, guided
        self.step = CheckStep(guided)
        qtbot.addWidget(self.step)
        self.step.resize(1100, 590)
        self.step.show()
        self.list = self.step.findChild(QTableWidget, "takeList")
        self.gestures = self.step.findChild(QListWidget, "checkGestures")
        self.curves = self.step.findChild(TakeCurves, "takeCurves")
        self.map = self.step.findChild(TakeMapView, "takeMapView")

    def see(self, condition) -> None:
        """Let the window refresh until something is seen."""

        def is_seen() -> bool:
            self.step.show_snapshot(self.guided.snapshot())
            return condition()

        self.qtbot.waitUntil(is_seen, timeout=5000)

    def settle(self) -> None:
        """Every gesture was looked at, and the map drawn."""
        self.see(lambda: self.step.is_settled)

    def text(self, name: str) -> str:
        return self.step.findChild(QLabel, name).text()

    def button(self, name: str) -> QPushButton:
        return self.step.findChild(QPushButton, name)

    def press(self, name: str) -> None:
        button = self.button(name)
        assert button.isVisible()
        assert button.isEnabled()
        self.qtbot.mouseClick(button, Qt.MouseButton.LeftButton)

    def lines(self) -> list[list[str]]:
        return [
            [self.list.item(row, column).text() for column in range(3)]
            for row in range(self.list.rowCount())
        ]

    def choose(self, row: int, keys: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier) -> None:
        place = self.list.visualItemRect(self.list.item(row, 0)).center()
        self.qtbot.mouseClick(self.list.viewport(), Qt.MouseButton.LeftButton, keys, place)

    def choose_gesture(self, label: str) -> None:
        row = next(
            i for i in range(self.gestures.count()) if self.gesture_text(i).startswith(f"{label} ")
        )
        place = self.gestures.visualItemRect(self.gestures.item(row)).center()
        self.qtbot.mouseClick(self.gestures.viewport(), Qt.MouseButton.LeftButton, pos=place)

    def gesture_text(self, row: int) -> str:
        return self.gestures.item(row).text()

    def row_of(self, number: int) -> int:
        return next(i for i, line in enumerate(self.lines()) if line[0] == str(number))

    def click_map(self, label: str, number: int) -> None:
        """Click where a take lies on the map."""
        takes = sorted(take.id for take in self.guided.takes(label))
        x, y = self.map.place_of(takes[number - 1])
        plot = self.map._plot
        scene = plot.getViewBox().mapViewToScene(QPointF(x, y))
        place = plot.mapFromScene(scene)
        self.qtbot.mouseClick(plot.viewport(), Qt.MouseButton.LeftButton, pos=place)


@pytest.fixture
def guided(tmp_path) -> Iterator[Guided]:
    guided = Guided(SensedArms(Settings()), tmp_path)
    guided.start_thread()
    yield guided
    guided.shutdown()


@pytest.fixture
def desk(qtbot, tmp_path, guided) -> Desk:
    fill(tmp_path)
    guided.open(PERSON)
    desk = Desk(qtbot, guided)
    desk.settle()
    desk.choose_gesture("X+")
    return desk


def test_without_a_person_or_takes_it_says_what_to_do(qtbot, guided):
    desk = Desk(qtbot, guided)
    desk.see(lambda: desk.text("checkEmpty") == "Choose a person first.")
    guided.open(PERSON)
    desk.see(lambda: desk.text("checkEmpty").startswith("No takes yet"))
    assert desk.step.findChild(QLabel, "checkEmpty").isVisible()


def test_the_late_take_stands_on_top_and_the_one_with_a_gap_at_the_bottom(desk):
    first, *_, last = desk.lines()
    assert first[0] == "4"
    assert first[2].startswith("▲ ")
    assert first[2].endswith("× as far as usual")
    assert last[:2] == ["5", "gap of 43 ms"]
    assert desk.text("takeCurvesTitle") == (
        "X+ push forward: 5 takes count, 1 of them odd, 1 does not count"
    )
    assert desk.gesture_text(0).startswith("X+   5 of 30, 1 odd\n")
    assert desk.curves.n_drawn == N_TAKES


def test_a_take_is_excluded_and_included_again(desk):
    desk.choose(0)
    desk.press("excludeTakes")
    desk.see(lambda: desk.lines()[desk.row_of(4)][1] == "excluded")
    assert desk.gesture_text(0).startswith("X+   4 of 30\n")
    assert desk.button("excludeTakes").text() == "Include"
    desk.press("excludeTakes")
    desk.see(lambda: desk.lines()[0][1] == "good")


def test_several_takes_are_excluded_at_once(desk):
    desk.choose(0)
    desk.choose(2, Qt.KeyboardModifier.ShiftModifier)
    desk.press("excludeTakes")
    desk.see(lambda: [line[1] for line in desk.lines()].count("excluded") == 3)


def test_a_take_is_deleted_and_the_deletion_taken_back_and_done_again(desk):
    desk.choose(0)
    desk.press("deleteTakes")
    desk.see(lambda: desk.list.rowCount() == N_TAKES - 1)
    desk.see(lambda: desk.text("checkUndoWords") == "Undo: deletion of take 4 of X+")
    desk.press("checkUndo")
    desk.see(lambda: desk.list.rowCount() == N_TAKES)
    desk.see(lambda: desk.button("checkRedo").isEnabled())
    desk.press("checkRedo")
    desk.see(lambda: desk.list.rowCount() == N_TAKES - 1)


def test_keys_undo_wherever_the_focus_is_in_the_step(desk, qtbot):
    desk.choose(0)
    qtbot.keyClick(desk.list, Qt.Key.Key_Delete)
    desk.see(lambda: desk.list.rowCount() == N_TAKES - 1)
    desk.see(lambda: desk.button("checkUndo").isEnabled())
    qtbot.keyClick(desk.gestures, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    desk.see(lambda: desk.list.rowCount() == N_TAKES)


def test_a_take_is_moved_to_another_gesture(desk):
    desk.choose(0)
    menu = desk.step.findChild(QToolButton, "moveTakes").menu()
    actions = {action.data(): action for action in menu.actions()}
    assert not actions["X+"].isVisible()
    actions["RZ-"].trigger()
    desk.see(lambda: desk.list.rowCount() == N_TAKES - 1)
    desk.settle()
    desk.choose_gesture("RZ-")
    assert desk.list.rowCount() == N_TAKES + 1
    assert desk.lines()[0][2].endswith("as far as usual")


def test_a_click_on_the_map_chooses_the_take_and_its_gesture(desk):
    desk.click_map("RY-", 2)
    assert desk.text("takeCurvesTitle").startswith("RY- ")
    assert len(desk.list.selectionModel().selectedRows()) == 1
    assert desk.curves.n_chosen == 1


def test_two_takes_of_one_gesture_are_compared(desk):
    desk.choose(0)
    desk.choose(3, Qt.KeyboardModifier.ControlModifier)
    assert desk.curves.n_chosen == 2
    assert desk.text("compareHint").endswith("g apart.")
    desk.choose(4)
    assert desk.curves.n_chosen == 1
    assert desk.text("compareHint") == ""


def test_takes_of_two_gestures_are_compared(desk):
    desk.choose(0)
    desk.press("compareTakes")
    assert desk.text("compareHint").startswith("Take 4 of X+ is held")
    desk.choose_gesture("Z-")
    desk.choose(desk.row_of(2))
    words = desk.text("compareHint")
    assert words.startswith("Take 4 of X+ (solid) and Take 2 of Z- (dashed) are ")
    assert desk.curves.n_chosen == 2
    desk.press("compareTakes")
    assert desk.curves.n_chosen == 1


def test_a_held_take_that_is_deleted_is_let_go(desk):
    desk.choose(0)
    desk.press("compareTakes")
    desk.press("deleteTakes")
    desk.see(lambda: desk.list.rowCount() == N_TAKES - 1)
    assert not desk.button("compareTakes").isChecked()
    assert desk.curves.n_chosen == 0


def test_takes_are_asked_for_only_when_they_have_changed(desk, monkeypatch):
    asked = []
    takes = desk.guided.takes
    monkeypatch.setattr(desk.guided, "takes", lambda *label: asked.append(1) or takes(*label))
    for _ in range(20):
        desk.step.show_snapshot(desk.guided.snapshot())
    assert not asked
    desk.choose(0)
    desk.press("excludeTakes")
    desk.see(lambda: bool(asked))
    desk.settle()
    assert len(asked) == 1


def test_another_colour_scheme_changes_nothing_but_colours(desk):
    desk.choose(0)
    before = desk.lines()
    desk.step.setPalette(palette_of(DARK))
    desk.step.grab()
    assert desk.lines() == before
    assert desk.curves.n_chosen == 1
