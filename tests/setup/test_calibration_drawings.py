"""The drawings of the six positions: files as the script writes them, right-handed, on paper."""

import importlib.util
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gestureapp.setup.values import Position

FOLDER = Path(__file__).resolve().parents[2] / "resources" / "calibration"
_PLACE = st.tuples(st.floats(-2, 2), st.floats(-2, 2))


def _script():
    spec = importlib.util.spec_from_file_location("draw_calibration", FOLDER / "draw.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


DRAW = _script()


def test_there_is_a_drawing_for_every_position_and_no_other():
    assert {path.stem for path in FOLDER.glob("*.svg")} == {one.value for one in Position}


@pytest.mark.parametrize("position", [one.value for one in Position])
def test_a_file_is_what_the_script_draws_now_and_has_no_colour_of_its_own(position):
    text = (FOLDER / f"{position}.svg").read_text(encoding="utf-8")
    assert text == DRAW.svg_of(position)
    root = ElementTree.fromstring(text)
    assert root.find("{http://www.w3.org/2000/svg}title").text.startswith(position[0].upper())
    for element in root.iter():
        assert element.get("fill", "none") in ("none", "currentColor")
        assert element.get("stroke", "none") in ("none", "currentColor")


@pytest.mark.parametrize("position", [one.value for one in Position])
def test_the_axes_are_those_of_a_right_handed_sensor_lying_so(position):
    axes = np.array(DRAW.TOWARDS[position])
    assert np.linalg.det(axes) == pytest.approx(-1.0)
    up = axes["xyz".index(position[0])]
    assert tuple(up) == (0, 0, 1 if position.endswith("up") else -1)
    assert (axes >= 0).sum() >= 8  # nothing but what points down is out of sight


@given(_PLACE, _PLACE)
def test_what_a_box_hides_of_a_line_is_left_out(start, end):
    square = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
    length = np.hypot(end[0] - start[0], end[1] - start[1])
    for one, other in DRAW.outside(square, start, end):
        middle = ((one[0] + other[0]) / 2, (one[1] + other[1]) / 2)
        assert max(map(abs, middle)) >= 1.0 - 1e-6 or length < 1e-6
    if max(map(abs, start)) > 1.0 + 1e-6 and length > 1e-3:
        assert DRAW.outside(square, start, end)[0][0] == start
