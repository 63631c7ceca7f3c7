"""What is drawn: plots, the field of operation, bars, the arrow."""

from dataclasses import replace
from math import sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PySide6.QtCore import QRectF, QSizeF

from gestureapp.config import KeepOutSettings, RobotSettings
from gestureapp.robot.values import Direction, Pose, PoseIncrement
from gestureapp.sensing.store import SampleStore
from gestureapp.sensing.values import Sample
from ui.arm_plot import RANGE_G, SPAN_S, ArmPlot
from ui.direction_view import DirectionView
from ui.field_names import beside, best_place, short_name, within
from ui.output_bars import OutputBars
from ui.robot_view import FieldView
from ui.theme import colours_of


def filled(n: int, rate_hz: float = 100.0) -> SampleStore:
    store = SampleStore()
    for i in range(n):
        store.append(Sample(i / rate_hz, i, (sin(i / 9), 0.2, 1.0)))
    return store


@pytest.fixture
def plot(qtbot) -> ArmPlot:
    plot = ArmPlot("leftPlot", "Left arm")
    qtbot.addWidget(plot)
    plot.resize(380, 200)
    plot.show()
    return plot


def test_a_plot_shows_the_last_eight_seconds_up_to_now(plot):
    plot.show_samples(filled(2000), 20.0, True)
    times, values = plot.curve(0)
    assert times.min() >= -SPAN_S - 0.1
    assert times.max() == pytest.approx(0.0, abs=0.1)
    assert values.max() == pytest.approx(1.0, abs=0.01)
    assert plot.note == ""


def test_a_plot_has_about_one_point_per_pixel(plot):
    plot.show_samples(filled(6000, rate_hz=750.0), 8.0, True)
    times, _ = plot.curve(0)
    assert 100 < len(times) <= 384


def test_a_stream_that_is_gone_says_no_data_and_scrolls_away(plot):
    store = filled(1000)
    plot.show_samples(store, 10.0, True)
    plot.show_samples(store, 14.0, False)
    times, _ = plot.curve(2)
    assert times.max() == pytest.approx(-4.0, abs=0.1)
    assert plot.note == "no data"
    plot.show_samples(store, 30.0, False)
    assert len(plot.curve(2)[0]) == 0


def test_a_plot_before_the_first_sample_says_no_data(plot):
    plot.show_samples(SampleStore(), 5.0, False)
    assert plot.note == "no data"
    assert len(plot.curve(0)[0]) == 0


def test_the_range_of_a_plot_never_moves(plot):
    store = filled(100)
    store.append(Sample(1.0, 100, (40.0, -40.0, 40.0)))
    plot.show_samples(store, 1.0, True)
    (left, right), (low, high) = plot._plot.getViewBox().viewRange()
    assert (left, right) == (-SPAN_S, 0)
    assert (low, high) == (-RANGE_G, RANGE_G)


def test_the_used_window_is_marked_where_it_was_and_wide_enough_to_see(plot):
    plot.mark_window((9.48, 9.5), 10.0)
    assert plot._mark.isVisible()
    start, end = plot._mark.getRegion()
    assert start < -0.52 < -0.5 < end
    assert end - start == pytest.approx(4 * SPAN_S / plot._plot.getViewBox().width(), rel=0.05)
    plot.mark_window((9.48, 9.5), 20.0)
    assert not plot._mark.isVisible()
    plot.mark_window(None, 20.0)
    assert not plot._mark.isVisible()


@pytest.fixture
def field(qtbot, cell) -> FieldView:
    field = FieldView(cell.settings.robot)
    qtbot.addWidget(field)
    field.resize(480, 270)
    field.show()
    return field


def test_the_path_grows_with_the_move_and_begins_anew_with_the_next(field, scenes):
    for share in np.linspace(0, 1, 50):
        field.show_robot(scenes.moving(share=float(share)).robot)
    assert len(field.path_mm) == 50
    assert field.path_mm[0] == (600.0, 100.0, 300.0)
    assert field.path_mm[-1][0] == pytest.approx(1135.3)
    field.show_robot(scenes.moving("RX+", 0.0).robot)
    assert len(field.path_mm) == 1


def test_a_robot_that_stands_adds_nothing_to_the_path(field, scenes):
    for _ in range(20):
        field.show_robot(scenes.ready().robot)
    assert len(field.path_mm) == 1


def test_the_path_is_bounded(field, scenes):
    robot = scenes.ready().robot
    for i in range(2500):
        pose = Pose(600.0 + 100 * (i % 2), 0.0, 0.0, 180.0, 0.0, 0.0)
        field.show_robot(replace(robot, pose=pose))
    assert len(field.path_mm) == 2000


@pytest.mark.parametrize(
    "pose",
    [None, Pose(0, 0, 0, 0, 0, 0), Pose(1e6, -1e6, 1e6, 180, 0, 0)],
    ids=["none", "origin", "far outside"],
)
def test_the_field_can_be_drawn_wherever_the_robot_claims_to_be(field, scenes, pose):
    robot = replace(scenes.ready().robot, pose=pose, start=pose, increment=PoseIncrement(dx_mm=9.0))
    field.show_robot(robot)
    image = field.grab().toImage()
    assert image.pixelColor(90, 90).name() == colours_of(field.palette()).base


def hatched(field: FieldView, x_mm: float, up_mm: float, *, from_above: bool) -> bool:
    """Whether there is hatching about a place: pixels that are not all alike."""
    image = field.grab().toImage()
    half, middle_y = field.width() / 2, (13 + 6 + 2 + field.height() - 4) / 2
    scale = (min(half - 8, field.height() - 28) / 2 - 10) / 1200.0
    x = round(half / 2 + (half if from_above else 0) + x_mm * scale)
    y = round(middle_y - up_mm * scale)
    patch = [image.pixelColor(x + i, y + j).name() for i in range(-6, 7) for j in range(-6, 7)]
    return len(set(patch)) > 1


@pytest.mark.parametrize(
    ("x_mm", "up_mm", "from_above", "setting"),
    [
        (-750.0, -500.0, False, {"floor_mm": -1500.0}),
        (-250.0, 1090.0, False, {"ceiling_mm": 1500.0}),
        (-240.0, 650.0, False, {"column_radius_mm": 0.0}),
        (150.0, -150.0, True, {"column_radius_mm": 0.0}),
        (650.0, 650.0, False, {"keep_outs": ()}),
        (650.0, -600.0, True, {"keep_outs": ()}),
    ],
    ids=["floor", "ceiling", "column", "column from above", "box", "box from above"],
)
def test_what_the_tool_stays_out_of_is_hatched(qtbot, scenes, x_mm, up_mm, from_above, setting):
    box = KeepOutSettings("post", (550.0, -700.0, 550.0), (850.0, -500.0, 850.0))
    bounded = RobotSettings(keep_outs=(box,))
    for settings, is_there in ((bounded, True), (replace(bounded, **setting), False)):
        field = FieldView(settings)
        qtbot.addWidget(field)
        field.resize(960, 540)
        field.show_robot(replace(scenes.ready().robot, pose=None))
        assert hatched(field, x_mm, up_mm, from_above=from_above) is is_there


KEEP_OUTS = (
    KeepOutSettings("welding table with long name X", (600, -300, -300), (1100, 300, 250)),
    KeepOutSettings("post", (-600, 400, -300), (-500, 500, 900)),
    KeepOutSettings("fixture", (700, -400, 0), (900, -200, 400)),
)


@pytest.fixture(params=[(400, 190), (480, 270), (960, 540)], ids=str)
def named(request, qtbot, scenes) -> tuple[FieldView, FieldView]:
    """The same field with names on its boxes and without, the tool on one of them."""
    fields = []
    for boxes in (KEEP_OUTS, tuple(replace(box, name="") for box in KEEP_OUTS)):
        field = FieldView(RobotSettings(keep_outs=boxes))
        qtbot.addWidget(field)
        field.resize(*request.param)
        field.show_robot(replace(scenes.ready().robot, pose=Pose(700, -250, 200, 180, 0, 0)))
        fields.append(field)
    return fields[0], fields[1]


def test_a_box_is_in_sight_beside_its_name(named):
    """Of each box in each view the outline is as it would be without names, or nearly so."""
    with_names, without = (field.grab().toImage() for field in named)
    width, height = named[0].width(), named[0].height()
    half, middle_y = width / 2, (13 + 6 + 5 + height - 4) / 2
    scale = (min(half - 8, height - 28) / 2 - 10) / RobotSettings().ext_radius_mm
    for box in KEEP_OUTS:
        for i, up in enumerate((2, 1)):
            left, right = (half * (i + 0.5) + at[0] * scale for at in (box.low_mm, box.high_mm))
            top, bottom = (middle_y - at[up] * scale for at in (box.high_mm, box.low_mm))
            across, down = range(round(left), round(right) + 1), range(round(top), round(bottom))
            edge = [(x, round(y)) for x in across for y in (top, bottom)]
            edge += [(round(x), y) for y in down for x in (left, right)]
            alike = sum(
                abs(with_names.pixelColor(*at).lightness() - without.pixelColor(*at).lightness())
                < 60
                for at in edge
            )
            assert alike >= 0.9 * len(edge), (box.name, i)


def test_a_long_name_is_cut_in_the_drawing_and_whole_in_the_tooltip(named):
    assert short_name(KEEP_OUTS[0].name) == "welding tab…"
    assert short_name("twelve lette") == "twelve lette"
    assert named[0].toolTip() == KEEP_OUTS[0].name
    assert named[1].toolTip() == ""


areas = st.builds(
    QRectF, st.floats(-50, 450), st.floats(-50, 250), st.floats(1, 200), st.floats(1, 200)
).filter(lambda area: area.intersects(QRectF(0, 0, 400, 200)))


@given(areas, st.lists(areas, max_size=8))
def test_a_name_is_in_the_view_wherever_its_box_is(box, others):
    view, size = QRectF(0, 0, 400, 200), QSizeF(80, 14)
    for places in (beside(size, box, view), within(size, box, view, 6)):
        assert view.contains(best_place(places, others, [box]))


def test_a_name_keeps_off_its_box_another_name_and_the_tool():
    view, size, box = QRectF(0, 0, 400, 200), QSizeF(80, 14), QRectF(150, 80, 60, 60)
    taken: list[QRectF] = []
    for _ in range(4):
        place = best_place(beside(size, box, view), taken, [box])
        assert not any(place.intersects(other) for other in [*taken, box])
        taken.append(place)


def test_both_views_have_the_same_scale(field, scenes):
    """The outer circle is as far from each view's centre to the right as up."""
    field.show_robot(replace(scenes.ready().robot, pose=None))
    image = field.grab().toImage()
    base = colours_of(field.palette()).base

    def reach(x: int, y: int, dx: int, dy: int) -> int:
        steps = range(118)  # half a view
        inside = [
            i
            for i in steps
            if image.rect().contains(x + dx * i, y + dy * i)
            and image.pixelColor(x + dx * i, y + dy * i).name() == base
        ]
        return max(inside)

    middle_y = (13 + 6 + 2 + 266) // 2
    for middle_x in (120, 360):
        across = reach(middle_x + 1, middle_y + 9, 1, 0)
        up = reach(middle_x + 9, middle_y, 0, -1)
        assert across == pytest.approx(up, abs=4)


@pytest.mark.parametrize("is_rotation", [False, True])
def test_each_direction_has_a_picture_of_its_own(qtbot, is_rotation):
    view = DirectionView()
    qtbot.addWidget(view)
    view.resize(160, 140)
    view.show()
    pictures = []
    for axis in range(3):
        for sign in (-1, 1):
            view.show_direction(Direction(axis, sign, is_rotation))
            pictures.append(view.grab().toImage())
    view.show_direction(None)
    pictures.append(view.grab().toImage())
    for i, one in enumerate(pictures):
        assert all(one != other for other in pictures[i + 1 :])


def test_a_bar_over_the_threshold_stands_out(qtbot, scenes):
    bars = OutputBars()
    qtbot.addWidget(bars)
    bars.resize(300, 90)
    bars.show()
    info = colours_of(bars.palette()).info

    def coloured() -> int:
        image = bars.grab().toImage()
        return sum(image.pixelColor(x, 60).name() == info for x in range(300))

    def show(answer) -> int:
        bars.show_outputs(answer.outputs, answer.thresholds)
        return coloured()

    assert show(scenes.not_recognised()) == 0
    assert 10 < show(scenes.recognised("X+")) < 25
    assert 10 < show(scenes.followed("Y+", 0.7)) < 25
    assert show(scenes.followed(None, 0.55)) == 0


def test_the_bars_say_what_an_answer_needs_and_that_it_may_be_none(qtbot, scenes):
    bars = OutputBars()
    qtbot.addWidget(bars)
    answer = scenes.followed("Y+", 0.97)
    bars.show_outputs(answer.outputs, answer.thresholds)
    assert bars.accessibleName().endswith("none 0.02; needed: 0.95 or 0.60")
