"""The confusion matrix and the table: what stands in them, and that it can be read."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PySide6.QtCore import QPoint
from PySide6.QtGui import QColor, QHelpEvent
from PySide6.QtWidgets import QToolTip

from gestureapp.gestures import LABELS
from gestureapp.recognition.evaluation import Evaluation
from ui.confusion_matrix import ConfusionMatrix, readable_on, spoken
from ui.recognition_table import RecognitionTable, table_rows
from ui.theme import DARK, colours_of, palette_of


def some() -> Evaluation:
    confusion = 28 * np.eye(len(LABELS), len(LABELS) + 1, dtype=np.int64)
    confusion[:, -1] = 2
    confusion[10, 10], confusion[10, 11], confusion[10, 12] = 20, 9, 1
    confusion[3] = 0
    return Evaluation(LABELS, confusion, (24.0, 31.0))


@pytest.fixture
def matrix(qtbot) -> ConfusionMatrix:
    matrix = ConfusionMatrix()
    qtbot.addWidget(matrix)
    matrix.resize(640, 420)
    matrix.show()
    matrix.show_evaluation(some())
    return matrix


def test_a_cell_has_its_count_and_its_share_of_the_row(matrix):
    assert matrix.cell_text(0, 0) == ("28", "93 %")
    assert matrix.cell_text(10, 11) == ("9", "30 %")
    assert matrix.cell_text(0, 12) == ("2", "7 %")
    assert matrix.cell_text(0, 5) == ("", "")
    assert matrix.cell_text(3, 3) == ("", "")


def test_the_matrix_is_said_in_words_too(matrix):
    words = matrix.accessibleDescription()
    assert "RZ+: 20 of 30 recognised, 9 heard as RZ-, 1 not recognised." in words
    assert " Y-: " not in words
    assert matrix.accessibleName() == "Confusion matrix: rows you did, columns system heard"


def test_the_mouse_says_what_a_cell_means(matrix, qtbot):
    cell = matrix._cell(10, 11).center().toPoint()
    for place, words in (
        (cell, "you did RZ+, system heard RZ-: 9 (30.0 %)"),
        (matrix._cell(0, 12).center().toPoint(), "you did X+, not recognised: 2 (6.7 %)"),
    ):
        event = QHelpEvent(QHelpEvent.Type.ToolTip, place, matrix.mapToGlobal(place))
        matrix.event(event)
        assert QToolTip.text() == words
    outside = QHelpEvent(QHelpEvent.Type.ToolTip, QPoint(2, 2), matrix.mapToGlobal(QPoint(2, 2)))
    matrix.event(outside)
    qtbot.waitUntil(lambda: not QToolTip.isVisible())


def test_cells_lie_beside_each_other_and_inside(matrix):
    n = len(LABELS)
    cells = [matrix._cell(row, column) for row in range(n) for column in range(n + 1)]
    area = sum(cell.width() * cell.height() for cell in cells)
    whole = matrix._cells()
    assert area == pytest.approx(whole.width() * whole.height())
    assert all(whole.adjusted(-1, -1, 1, 1).contains(cell) for cell in cells)


def test_twelve_gestures_have_room_in_half_a_small_screen(matrix):
    least = matrix.minimumSizeHint()
    assert least.width() <= 560
    assert least.height() <= 300


def test_right_wrong_and_unrecognised_cells_differ_in_colour(matrix):
    picture = matrix.grab().toImage()

    def shade(row: int, column: int) -> str:
        corner = matrix._cell(row, column).topLeft().toPoint() + QPoint(4, 4)
        return picture.pixelColor(corner).name()

    right, wrong, none, empty = shade(0, 0), shade(10, 11), shade(0, 12), shade(0, 5)
    assert len({right, wrong, none, empty}) == 4
    assert empty == colours_of(matrix.palette()).base


def test_without_figures_it_says_so(matrix):
    matrix.show_evaluation(None)
    assert matrix.accessibleDescription() == "nothing heard yet"
    assert matrix.cell_text(0, 0) == ("", "")
    matrix.grab()
    empty = Evaluation(LABELS, np.zeros((12, 13), dtype=np.int64), (0.0, 0.0))
    assert spoken(empty) == "nothing heard yet"


def test_any_set_of_gestures_and_a_dark_screen_can_be_drawn(matrix):
    two = Evaluation(("wave", "X+"), np.array([[3, 1, 0], [0, 0, 4]]), (0.0, 0.0))
    matrix.setPalette(palette_of(DARK))
    matrix.show_evaluation(two)
    matrix.grab()
    assert matrix.cell_text(1, 2) == ("4", "100 %")


@given(st.integers(0, 255), st.integers(0, 255), st.integers(0, 255))
def test_text_stands_out_on_any_shade(red, green, blue):
    # 4.5 is what WCAG asks of small text.
    shade = QColor(red, green, blue)
    assert _contrast(readable_on(shade), shade) >= 4.5


def _contrast(one: QColor, other: QColor) -> float:
    low, high = sorted((_luminance(one), _luminance(other)))
    return (high + 0.05) / (low + 0.05)


def _luminance(colour: QColor) -> float:
    parts = np.array([colour.red(), colour.green(), colour.blue()]) / 255
    linear = np.where(parts <= 0.04045, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4)
    return float(linear @ [0.2126, 0.7152, 0.0722])


def test_the_table_has_a_row_for_each_gesture_that_was_done_and_one_for_all():
    rows = table_rows(some())
    assert len(rows) == 12
    assert rows[0] == ("X+", "28 (93.3 %)", "0 (0.0 %)", "2 (6.7 %)")
    assert rows[-2] == ("RZ-", "28 (93.3 %)", "0 (0.0 %)", "2 (6.7 %)")
    assert rows[-1] == ("All", "300 (90.9 %)", "9 (2.7 %)", "21 (6.4 %)")


def test_the_table_shows_these_rows(qtbot):
    table = RecognitionTable()
    qtbot.addWidget(table)
    table.show_evaluation(some())
    shown = [
        tuple(table.item(row, column).text() for column in range(table.columnCount()))
        for row in range(table.rowCount())
    ]
    assert shown == table_rows(some())
    assert table.horizontalHeaderItem(3).text() == "not recognised"
