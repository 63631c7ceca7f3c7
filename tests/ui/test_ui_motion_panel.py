"""The figures of a move: what will be, what is, and, after a stop, what has been."""

from dataclasses import replace

import pytest
from PySide6.QtWidgets import QLabel, QProgressBar, QWidget

from gestureapp.cell.snapshot import CellState


def text_of(window, name: str) -> str:
    return window.findChild(QLabel, name).text()


def show(window, cell, snapshot) -> None:
    cell.shown = snapshot
    window.poll()


def stopped(scenes, label: str = "X+", share: float = 0.4, n_blockers: int = 0):
    blockers = scenes.blocked(n_blockers).blockers
    return replace(scenes.moving(label, share), state=CellState.STOPPED, blockers=blockers)


@pytest.mark.parametrize("n_blockers", [0, 1, 4])
def test_a_stop_leaves_the_move_in_sight_and_speaks_of_the_past(window, cell, scenes, n_blockers):
    show(window, cell, scenes.moving())
    show(window, cell, stopped(scenes, n_blockers=n_blockers))
    assert window.findChild(QWidget, "motionPanel").isVisible()
    assert text_of(window, "motionTitle") == "Last move of the robot"
    assert text_of(window, "motionEndsatCaption") == "Stopped"
    value = window.findChild(QLabel, "motionEndsat")
    assert value.isVisible()
    assert value.text() == "after 214 mm of 535 mm; would have ended at: outer sphere"
    assert text_of(window, "motionEndCaption") == "Planned end"


def test_before_the_first_move_what_stands_against_arming_has_the_room(window, cell, scenes):
    show(window, cell, scenes.blocked())
    assert not window.findChild(QWidget, "motionPanel").isVisible()


def test_a_move_under_way_and_one_that_came_to_its_end_say_where(window, cell, scenes):
    show(window, cell, scenes.moving())
    assert text_of(window, "motionEndsatCaption") == "Ends at"
    show(window, cell, replace(scenes.moving(share=1.0), state=CellState.ARMED))
    assert text_of(window, "motionEndsatCaption") == "Ended at"
    assert text_of(window, "motionEndsat") == "535.3 mm: outer sphere"
    assert text_of(window, "motionEndCaption") == "End"


def test_while_it_is_stopping_no_end_is_promised(window, cell, scenes):
    show(window, cell, replace(scenes.moving(), state=CellState.STOPPING))
    assert text_of(window, "motionEndsatCaption") == "Stopping"
    assert "would have ended at" in text_of(window, "motionEndsat")


def test_where_the_robot_is_led_after_a_stop_is_not_the_moves_way(window, cell, scenes):
    show(window, cell, scenes.moving(share=0.2))
    show(window, cell, stopped(scenes, share=0.4))
    later = replace(stopped(scenes, share=0.8), t_s=scenes.now_s + 5.0)
    show(window, cell, later)
    assert text_of(window, "motionEndsat").startswith("after 214 mm of 535 mm")
    assert window.findChild(QProgressBar, "motionBar").value() == 400
    show(window, cell, replace(scenes.moving("RX+", 0.0), t_s=scenes.now_s + 9.0))
    assert window.findChild(QProgressBar, "motionBar").value() == 0


def test_a_rotation_turns(window, cell, scenes):
    show(window, cell, scenes.moving("RX+"))
    assert text_of(window, "motionDistanceCaption") == "Turn"
    assert text_of(window, "motionDistance") == "58.0°"
    show(window, cell, stopped(scenes, "RX+", 0.5))
    assert text_of(window, "motionEndsat").startswith("after 29° of 58°; ")
    show(window, cell, scenes.moving())
    assert text_of(window, "motionDistanceCaption") == "Distance"
