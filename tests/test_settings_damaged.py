"""Files that are no settings files give one line, whatever is in them."""

import os

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gestureapp.config import Settings
from gestureapp.errors import ConfigError, SettingsRefused
from gestureapp.settings_check import named_values
from gestureapp.settings_file import check_settings, load_settings, read_settings


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"schema = 1\n[robot\n", "line 2: not TOML"),
        (b"schema = 1\nx = \n", "line 2: not TOML"),
        (b"schema = 1\nx = [1,\n2", "line 3: not TOML"),
        (b"schema = 1\nx = 1\nx = 2\n", "not TOML: Cannot overwrite a value"),
        (b"schema = 1\n\xff\n", "line 2: not UTF-8"),
        (b"x = " + b"[" * 40_000, "nested too deeply"),
        (b"x = " + b"1" * 5000, "not TOML"),
        (b"#" * 100_001, "larger than"),
        (b"schema = 2\n", "reads schema 1"),
        (b"\n\nschema = 'x'\n", "line 3: this application reads schema 1"),
        (b"schema = true\n", "reads schema 1"),
    ],
)
def test_a_file_that_is_no_settings_file_is_refused_in_one_line(tmp_path, data, words):
    path = tmp_path / "site.toml"
    path.write_bytes(data)
    with pytest.raises(ConfigError) as caught:
        read_settings([path])
    assert words in str(caught.value)
    assert str(path) in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_file_named_by_hand_must_be_there(tmp_path):
    with pytest.raises(ConfigError, match="cannot be read: No such file"):
        read_settings([], tmp_path / "absent.toml")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no named pipes here")
def test_a_folder_and_a_pipe_are_no_settings_files(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path, tmp_path / "pipe"):
        with pytest.raises(ConfigError, match="not a file"):
            read_settings([path])


def test_a_statement_of_absurd_length_costs_only_the_line_numbers(tmp_path):
    path = tmp_path / "site.toml"
    path.write_text("schema = 1\n[robot]\nx = [\n" + "1,\n" * 2000 + "]\ntol = 1\n")
    _, found = read_settings([path])
    assert [one.setting for one in found] == ["robot.x", "robot.tol"]
    assert found[1].line is None
    assert str(found[1]).startswith(f"{path}: robot.tol: ")


@settings(max_examples=100, deadline=None)
@given(data=st.binary(max_size=200) | st.text().map(str.encode))
def test_any_bytes_give_settings_or_one_line(tmp_path_factory, data):
    path = tmp_path_factory.getbasetemp() / "rubbish.toml"
    path.write_bytes(data)
    try:
        loaded, found = read_settings([path])
    except ConfigError as error:
        lines = [str(error)]
    else:
        assert check_settings(loaded) == []
        lines = [str(finding) for finding in found]
        if any(finding.is_refused for finding in found):
            with pytest.raises(SettingsRefused) as caught:
                load_settings([path])
            assert list(caught.value.findings) == lines
        else:
            assert load_settings([path]) == (loaded, found)
    assert all(len(line.splitlines()) == 1 for line in lines)


_TOML_VALUES = st.sampled_from(
    [
        "1",
        "-1",
        "0.1",
        "1e9",
        "nan",
        "''",
        "'x'",
        "true",
        "[]",
        "[1, 2]",
        "[0, 0, 0]",
        "{}",
        "{a=1}",
    ]
)
_KEYS = st.sampled_from(
    [name for name, _, _ in named_values(Settings())] + ["left.x", "robot.x", "x", "schema"]
)


@settings(max_examples=100, deadline=None)
@given(items=st.dictionaries(_KEYS, _TOML_VALUES, max_size=12))
def test_any_values_give_allowed_settings_and_the_right_lines(tmp_path_factory, items):
    path = tmp_path_factory.getbasetemp() / "values.toml"
    items = {"schema": "1"} | {key: value for key, value in items.items() if key != "schema"}
    path.write_text("".join(f"{key} = {value}\n" for key, value in items.items()))
    loaded, found = read_settings([path])
    assert check_settings(loaded) == []
    lines = {key: number for number, key in enumerate(items, 1)}
    for finding in found:
        assert finding.line == lines[finding.setting]
