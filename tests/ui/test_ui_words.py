"""Words for values, and fewer points for the same curve."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gestureapp.robot.values import Pose, PoseIncrement, RobotStatus
from gestureapp.sensing.values import LinkState, Side
from ui.decimate import decimate
from ui.marks import Level
from ui.words import (
    end_of,
    increment_text,
    outcome_text,
    pose_age_text,
    progress,
    robot_chip,
    stream_chip,
    strip_line,
)

TRIP_S = 0.1
distances = st.floats(-2000, 2000).filter(lambda mm: abs(mm) > 1e-3)
angles = st.floats(-179, 179).filter(lambda deg: abs(deg) > 1e-3)
poses = st.builds(Pose, *[st.floats(-1500, 1500)] * 3, *[st.floats(-180, 180)] * 3)


def test_a_stream_that_is_well_has_a_calm_mark_and_its_rate(scenes):
    chip = stream_chip(scenes.healthy(Side.LEFT), TRIP_S)
    assert (chip.level, chip.text, chip.reason) == (Level.OK, "OK  100 Hz", "")


@pytest.mark.parametrize("link", [link for link in LinkState if link is not LinkState.RECEIVING])
def test_each_way_of_having_no_stream_has_its_own_word(scenes, link):
    health = replace(scenes.healthy(Side.LEFT), link=link, reason="switch it on")
    chip = stream_chip(health, TRIP_S)
    assert chip.level is Level.ATTENTION
    assert chip.text in link.value
    assert chip.reason == "switch it on"


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"is_alive": False, "age_s": 0.104}, "silent 104 ms"),
        ({"is_alive": False, "age_s": 12.5}, "silent 12.5 s"),
        ({"is_alive": False, "age_s": float("inf")}, "silent from the start"),
        ({"is_valid": False}, "wrong data"),
        ({"is_freq_ok": False, "rate_hz": 20.0}, "rate 20 Hz"),
        ({"age_s": 0.06}, "late 60 ms"),
    ],
)
def test_a_stream_that_is_not_well_says_what_with_a_number(scenes, change, text):
    chip = stream_chip(replace(scenes.healthy(Side.RIGHT), **change), TRIP_S)
    assert (chip.level, chip.text) == (Level.ATTENTION, text)


@pytest.mark.parametrize(
    ("status", "level", "text"),
    [
        (RobotStatus(0xC0, 0x40), Level.OK, "OK  servo on"),
        (RobotStatus(0xC8, 0x40), Level.BUSY, "running"),
        (RobotStatus(0xC0, 0x00), Level.ATTENTION, "servo off"),
        (RobotStatus(0x20, 0x40), Level.ATTENTION, "not in remote"),
        (RobotStatus(0xC0, 0x42), Level.ATTENTION, "hold"),
        (RobotStatus(0xC0, 0x50), Level.ALARM, "alarm"),
        (None, Level.ATTENTION, "no answer yet"),
    ],
)
def test_the_robot_says_the_gravest_thing_first(scenes, status, level, text):
    chip = robot_chip(replace(scenes.ready().robot, status=status))
    assert (chip.level, chip.text) == (level, text)


def test_a_robot_without_connection_says_why_in_plain_text(scenes):
    gone = replace(scenes.ready().robot, is_connected=False, text="10.0.0.2 does not answer")
    line = strip_line(replace(scenes.ready(), robot=gone))
    assert "Robot: 10.0.0.2 does not answer" in line


def test_an_old_position_is_said_to_be_old(scenes):
    robot = scenes.ready().robot
    assert pose_age_text(robot) == ""
    assert pose_age_text(replace(robot, pose_age_s=3.21)) == "position is 3.2 s old"
    assert pose_age_text(replace(robot, pose=None)) == "no position"


@pytest.mark.parametrize(
    ("increment", "direction", "distance"),
    [
        (PoseIncrement(dx_mm=535.3), "along X+ (forward)", "535.3 mm"),
        (PoseIncrement(dy_mm=-12.0), "along Y- (right)", "12.0 mm"),
        (PoseIncrement(dz_mm=1.0), "along Z+ (up)", "1.0 mm"),
        (PoseIncrement(drz_deg=-88.0), "turn about Z, -", "88.0°"),
    ],
)
def test_a_move_is_told_by_direction_and_distance(increment, direction, distance):
    assert increment_text(increment) == (direction, distance)


@pytest.mark.parametrize(
    ("increment", "done", "caption", "text"),
    [
        (
            PoseIncrement(dx_mm=516.1),
            97 / 516.1,
            "Stopped",
            "after 97 mm of 516 mm; would have ended at: inner sphere",
        ),
        (
            PoseIncrement(drz_deg=-58.0),
            0.5,
            "Stopped",
            "after 29° of 58°; would have ended at: inner sphere",
        ),
        (PoseIncrement(dx_mm=516.1), 0.9995, "Ended at", "516.1 mm: inner sphere"),
        (
            PoseIncrement(dx_mm=516.1),
            0.0,
            "Not made",
            "0 mm of 516 mm; would have ended at: inner sphere",
        ),
    ],
)
def test_a_move_that_is_over_is_told_in_the_past(increment, done, caption, text):
    assert outcome_text(increment, done, "inner sphere") == (caption, text)


@given(poses, distances, st.floats(0, 1))
def test_progress_of_a_move_is_the_share_of_its_way(start, mm, share):
    now = end_of(start, PoseIncrement(dy_mm=mm * share))
    assert progress(start, PoseIncrement(dy_mm=mm), now) == pytest.approx(share, abs=1e-4)


@given(poses, angles, st.floats(0, 1))
def test_progress_of_a_rotation_does_not_mind_where_the_full_turn_lies(start, deg, share):
    turned = end_of(start, PoseIncrement(drx_deg=deg * share))
    read_back = replace(turned, rx_deg=(turned.rx_deg + 180) % 360 - 180)
    assert progress(start, PoseIncrement(drx_deg=deg), read_back) == pytest.approx(share, abs=1e-4)


def test_no_move_is_no_progress():
    here = Pose(0, 0, 0, 0, 0, 0)
    assert progress(here, PoseIncrement(), here) == 0.0


samples = st.lists(st.floats(-3, 3), min_size=0, max_size=600)


@given(samples, st.integers(2, 400))
def test_fewer_points_keep_every_peak_and_the_order_of_time(values, n_points):
    rows = np.column_stack([5.0 + np.arange(len(values)) * 0.01, np.array(values, dtype=float)])
    points = decimate(rows, 8.0, n_points)
    if not values:
        assert len(points) == 0
        return
    assert points[:, 1].min() == rows[:, 1].min()
    assert points[:, 1].max() == rows[:, 1].max()
    assert np.all(np.diff(points[:, 0]) >= 0)
    assert len(points) <= max(n_points, 0) + 4


def test_a_curve_that_scrolls_keeps_its_points():
    t_s = np.arange(2000) * 0.01
    rows = np.column_stack([t_s, np.sin(t_s * 37)])
    first, later = decimate(rows[:1500], 8.0, 100), decimate(rows[3:1503], 8.0, 100)
    inside = slice(4, -4)
    common = np.isin(first[inside, 0], later[:, 0])
    assert common.all()
    at = np.searchsorted(later[:, 0], first[inside, 0])
    assert np.array_equal(later[at, 1], first[inside, 1])


@pytest.mark.parametrize(("span_s", "n_points"), [(0.0, 100), (8.0, 1)])
def test_no_room_is_refused(span_s, n_points):
    with pytest.raises(ValueError, match="no room"):
        decimate(np.zeros((3, 2)), span_s, n_points)
