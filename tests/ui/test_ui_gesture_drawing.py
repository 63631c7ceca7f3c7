"""The drawing of a gesture: that it shows what the gesture is, and when it moves."""

import os

import pytest
from hypothesis import given
from hypothesis import strategies as st

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

from PySide6.QtGui import QColor, QImage

from gestureapp.gestures import GESTURES
from ui.arm_figure import FIGURES, LEFT_START, LEFT_STOP, Look, box_of, figure
from ui.gesture_drawing import (
    BACK_S,
    CYCLE_S,
    HOLD_S,
    ICON_PX,
    MOVE_S,
    PAUSE_S,
    GestureDrawing,
    share_at,
)
from ui.theme import DARK, LIGHT, palette_of

ON_PAPER = {
    "X+": (+1, +1),
    "X-": (-1, -1),
    "Y+": (-1, +1),
    "Y-": (+1, -1),
    "Z+": (0, +1),
    "Z-": (0, -1),
    "RX+": (+1, +1),  # the left edge up and over to the right
    "RX-": (-1, +1),
    "RY+": (-1, +1),  # the fingers up and back
    "RY-": (-1, -1),
    "RZ+": (-1, +1),
    "RZ-": (+1, -1),
    LEFT_START: (-1, -1),
}
"""Which way an arrow leads from behind, from the right and from above; y up."""


def way_of_arrow(name: str) -> tuple[float, float]:
    arrow = next(shape for shape in figure(name, 0.3) if shape.look is Look.ARROW).points
    (x0, y0), (x1, y1), tip = arrow[0], arrow[-1], arrow[len(arrow) // 2]
    return tip[0] - (x0 + x1) / 2, tip[1] - (y0 + y1) / 2


def sensor_at(name: str, share: float) -> tuple[float, float]:
    points = [p for s in figure(name, share) if s.look is Look.SENSOR for p in s.points]
    return sum(x for x, _ in points) / len(points), sum(y for _, y in points) / len(points)


def sign(value: float) -> int:
    return 0 if abs(value) < 1e-6 else 1 if value > 0 else -1


@pytest.mark.parametrize("name", ON_PAPER)
def test_the_arrow_leads_where_the_gesture_goes(name):
    dx, dy = way_of_arrow(name)
    assert (sign(dx), sign(dy)) == ON_PAPER[name]


@pytest.mark.parametrize("name", [g.label for g in GESTURES if g.label[0] != "R"])
def test_the_hand_of_a_movement_goes_along_its_arrow(name):
    (x0, y0), (x1, y1) = sensor_at(name, 0.0), sensor_at(name, 1.0)
    assert (sign(x1 - x0), sign(y1 - y0)) == ON_PAPER[name]


def test_the_left_arm_in_stop_has_no_arrow():
    assert Look.ARROW not in {shape.look for shape in figure(LEFT_STOP, 1.0)}


@given(st.sampled_from(FIGURES), st.floats(0.0, 1.0), st.booleans())
def test_every_moment_of_a_figure_is_drawn_within_its_box(name, share, is_icon):
    box = box_of(name, is_icon)
    for shape in figure(name, share, is_icon):
        assert len(shape.points) >= 2
        for x, y in shape.points:
            assert box.left - 0.01 <= x <= box.right + 0.01
            assert box.bottom - 0.01 <= y <= box.top + 0.01


def test_the_hand_waits_moves_holds_and_comes_back():
    assert share_at(0.0) == share_at(PAUSE_S) == 0.0
    assert share_at(PAUSE_S + MOVE_S / 2) == pytest.approx(0.5)
    assert share_at(PAUSE_S + MOVE_S) == share_at(PAUSE_S + MOVE_S + HOLD_S) == 1.0
    assert share_at(PAUSE_S + MOVE_S + HOLD_S + BACK_S / 2) == pytest.approx(0.5)
    assert share_at(CYCLE_S) == pytest.approx(0.0)


@given(st.floats(0.0, 1e6))
def test_the_hand_never_jumps(t_s):
    assert abs(share_at(t_s + 0.001) - share_at(t_s)) < 0.01


class HandClock:
    """Moves when the test says so."""

    def __init__(self) -> None:
        self.now_s = 100.0

    def __call__(self) -> float:
        return self.now_s

    def advance(self, by_s: float) -> None:
        self.now_s += by_s


@pytest.fixture
def clock() -> HandClock:
    return HandClock()


@pytest.fixture
def drawing(qtbot, clock) -> GestureDrawing:
    drawing = GestureDrawing("X+", clock)
    drawing.setPalette(palette_of(LIGHT))
    qtbot.addWidget(drawing)
    drawing.resize(420, 320)
    return drawing


def picture(drawing: GestureDrawing) -> QImage:
    return drawing.grab().toImage()


def count_of(image: QImage, colour: str) -> int:
    wanted = QColor(colour).rgb()
    return sum(
        image.pixel(x, y) == wanted for x in range(image.width()) for y in range(image.height())
    )


def test_the_drawing_follows_the_clock(drawing, clock):
    drawing.show()
    before = picture(drawing)
    clock.advance(PAUSE_S + MOVE_S / 2)
    assert drawing.share == pytest.approx(0.5)
    assert picture(drawing) != before


def test_a_shown_drawing_is_painted_again_by_itself(drawing, clock, qtbot):
    drawing.show()
    before = picture(drawing)
    clock.advance(PAUSE_S + MOVE_S)
    qtbot.waitUntil(lambda: picture(drawing) != before, timeout=5000)


def test_nothing_is_timed_while_nobody_sees_it(drawing):
    assert not drawing.is_running
    drawing.show()
    assert drawing.is_running
    drawing.hide()
    assert not drawing.is_running


def test_a_still_drawing_shows_the_end_of_the_movement(drawing, clock):
    drawing.show()
    drawing.set_animated(False)
    assert not drawing.is_running
    before = picture(drawing)
    clock.advance(1.0)
    assert drawing.share == 1.0
    assert picture(drawing) == before


def test_another_gesture_begins_from_its_start(drawing, clock):
    drawing.show()
    clock.advance(PAUSE_S + MOVE_S)
    drawing.set_gesture("RZ-")
    assert drawing.share == 0.0
    assert drawing.accessibleName() == "Drawing: RZ- turn right and hold"


def test_the_same_gesture_again_goes_on(drawing, clock):
    drawing.show()
    clock.advance(PAUSE_S + MOVE_S)
    drawing.set_gesture("X+")
    assert drawing.share == 1.0


def test_nothing_is_drawn_without_a_gesture(drawing):
    drawing.set_gesture("")
    drawing.show()
    assert not drawing.is_running
    assert count_of(picture(drawing), LIGHT.info) == 0
    assert drawing.accessibleName() == "Drawing: nothing"


def test_a_name_that_cannot_be_drawn_is_refused_and_the_drawing_stays(drawing):
    with pytest.raises(KeyError):
        drawing.set_gesture("W+")
    assert drawing.label == "X+"


@pytest.mark.parametrize("colours", [LIGHT, DARK])
@pytest.mark.parametrize("size", [(24, 24), (ICON_PX, ICON_PX), (640, 480)])
def test_arrow_and_sensor_are_seen_in_both_schemes_and_every_size(drawing, colours, size):
    drawing.setPalette(palette_of(colours))
    drawing.resize(*size)
    image = picture(drawing)
    assert count_of(image, colours.info) > 0.004 * image.width() * image.height()
    assert count_of(image, colours.text) > 0
