"""The drawings of the gestures as files: one source with what the window paints."""

import importlib.util
from pathlib import Path
from xml.etree import ElementTree

import pytest

from ui.arm_figure import FIGURES, words_of

FOLDER = Path(__file__).resolve().parents[2] / "resources" / "gestures"


@pytest.fixture(scope="module")
def script():
    spec = importlib.util.spec_from_file_location("draw", FOLDER / "draw.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_there_is_a_file_for_every_figure_and_no_other(script):
    files = {path.name for path in FOLDER.glob("*.svg")}
    assert files == {script.file_name(name) for name in FIGURES}


@pytest.mark.parametrize("name", FIGURES)
def test_a_file_is_what_the_script_draws_now(script, name):
    path = FOLDER / script.file_name(name)
    assert path.read_text(encoding="utf-8") == script.svg_of(name)


@pytest.mark.parametrize("name", FIGURES)
def test_a_file_says_what_it_shows(script, name):
    root = ElementTree.parse(FOLDER / script.file_name(name)).getroot()
    assert root.find("{http://www.w3.org/2000/svg}title").text == f"{name}: {words_of(name)}"
