"""Who belongs on which arm: noticed when they are swapped, remembered, and never guessed."""

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gestureapp.sensing.values import Side
from gestureapp.setup.sides import (
    SAME,
    SWAPPED,
    Sides,
    find_swapped,
    load_sides,
    save_sides,
)

IDS = st.sampled_from(["", "A", "B", "C"])


@pytest.mark.parametrize(
    ("assigned", "seen", "problem"),
    [
        (Sides("A", "B"), Sides("A", "B"), ""),
        (Sides("A", "B"), Sides("B", "A"), SWAPPED),
        (Sides("A", "B"), Sides("B", ""), SWAPPED),
        (Sides("A", "B"), Sides("", "A"), SWAPPED),
        (Sides("A", "B"), Sides("C", "B"), ""),
        (Sides("A", "B"), Sides("", ""), ""),
        (Sides("", ""), Sides("A", "B"), ""),
        (Sides("A", "B"), Sides("A", "A"), SAME),
    ],
)
def test_what_is_wrong_with_who_is_seen(assigned: Sides, seen: Sides, problem: str):
    assert find_swapped(assigned, seen)[0] == problem


@given(st.builds(Sides, IDS, IDS))
def test_nothing_is_wrong_with_those_that_were_assigned_and_swapping_twice_is_nothing(sides: Sides):
    if sides.left != sides.right:
        assert find_swapped(sides, sides) == ("", "")
        assert sides.swapped().swapped() == sides


@given(st.builds(Sides, IDS, IDS), st.sampled_from(Side), IDS)
def test_no_sensor_is_assigned_to_both_arms(sides: Sides, side: Side, sensor_id: str):
    after = sides.assigned(side, sensor_id)
    assert after.of(side) == sensor_id
    if sensor_id:
        assert after.left != after.right


@given(cut=st.integers(0, 400))
def test_a_file_that_was_cut_off_knows_nobody(tmp_path_factory: pytest.TempPathFactory, cut: int):
    folder = tmp_path_factory.mktemp("sides")
    save_sides(folder, Sides("wrist A", "wrist B"))
    assert load_sides(folder) == (Sides("wrist A", "wrist B"), "")
    (path,) = folder.iterdir()
    whole = path.read_bytes()
    path.write_bytes(whole[:cut])
    sides, damage = load_sides(folder)
    assert sides == (Sides("wrist A", "wrist B") if cut >= len(whole) else Sides())
    assert (damage == "") == (cut >= len(whole))


def test_without_a_file_nobody_is_known(tmp_path: Path):
    assert load_sides(tmp_path) == (Sides(), "")
