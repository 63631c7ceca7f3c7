"""Figures as a table and as JSON."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gestureapp.benchmark import measure
from gestureapp.benchmark.report import Report, Row
from gestureapp.errors import ConfigError

VALUES = st.lists(st.floats(0.0, 1e6), min_size=1, max_size=300).map(tuple)


@given(VALUES, st.floats(0.01, 1.0))
def test_a_quantile_is_a_measured_value_with_that_share_at_or_below_it(values, share):
    found = Row("x", "ms", values).quantile(share)
    assert found in values
    assert sum(value <= found for value in values) >= share * len(values)
    below = [value for value in values if value < found]
    assert len(below) < share * len(values)


def test_the_99th_percentile_of_a_hundred_is_the_second_largest():
    assert Row("x", "ms", tuple(float(n) for n in range(1, 101))).quantile(0.99) == 99.0


def test_the_table_shows_every_row_with_unit_count_and_aim():
    rows = [Row("whole IMOV", "ms", (1.0, 2.0, 9.0), "99 % within 10 ms"), Row("nothing", "s", ())]
    lines = Report("Latency", rows, ["a note"]).as_table().splitlines()
    assert "| whole IMOV | 3 | 2.0 ms | 9.0 ms | 9.0 ms | 99 % within 10 ms |" in lines
    assert "| nothing | 0 | | | |  |" in lines
    assert lines[-1] == "a note"


def test_json_names_the_machine_and_keeps_an_empty_row():
    found = Report("Latency", [Row("nothing", "s", ())]).as_json()
    assert found["machine"]
    assert found["rows"] == [{"name": "nothing", "unit": "s", "n": 0, "aim": ""}]


def test_a_figure_that_needs_a_window_says_so_without_one():
    with pytest.raises(ConfigError, match="needs the window"):
        measure("latency", 1.0, None)
