"""What is kept of sensors and people's postures: written, damaged anywhere, judged by date."""

import json
import math
from dataclasses import replace

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from gestureapp.config import SiteSettings
from gestureapp.errors import RecordingError
from gestureapp.recording.people import person_folder
from gestureapp.recording.person_profile import (
    PROFILE_FILE,
    Handedness,
    PersonProfile,
    load_profile,
    save_profile,
)
from gestureapp.recording.sensor_records import (
    LevelRecord,
    LinkRecord,
    SensorRecord,
    judge_record,
    load_record,
    record_path,
    save_record,
)
from gestureapp.sensing.calibration import NOMINAL, Calibration
from gestureapp.sensing.posture import LeftPostures

NOW_S = 1_800_000_000.0
DAY_S = 86_400.0
SITE = SiteSettings()
MATRIX = ((1.01, 0.0, -0.003), (0.0, 0.97, 0.0), (0.001, 0.0, 1.1))
CALIBRATION = Calibration((0.01, -0.02, 0.03), MATRIX)
RECORD = SensorRecord(
    "Sensor 00:11:22 (left)",
    CALIBRATION,
    NOW_S,
    70.1,
    1.5,
    2.5,
    "Good: within 3 mg.",
    LevelRecord(NOW_S + 5, True, 0.4, -3.0, replace(CALIBRATION, offset_g=(0.1, 0.0, 0.0))),
    LinkRecord(NOW_S + 9, 99.8, 0.002, 0.031, 0.05, 3, 1, "/dev/rfcomm0", "csv"),
)
PROFILE = PersonProfile(Handedness.LEFT, LeftPostures((0.0, 0.6, 0.8), (-1.0, 0.0, 0.0)), NOW_S)

_SENSOR_ID = st.text(max_size=80)
_NUMBER = st.floats(-3, 3)
_VECTOR = st.tuples(_NUMBER, _NUMBER, _NUMBER)
_CALIBRATION = st.builds(Calibration, _VECTOR, st.tuples(_VECTOR, _VECTOR, _VECTOR))


@given(sensor_id=_SENSOR_ID, calibration=_CALIBRATION, verdict=st.text(max_size=50))
def test_what_is_kept_is_read_back(tmp_path_factory, sensor_id, calibration, verdict):
    data = tmp_path_factory.getbasetemp()
    record = replace(RECORD, sensor_id=sensor_id, calibration=calibration, verdict=verdict)
    save_record(data, record)
    assert load_record(data, sensor_id) == (record, "")


def test_a_sensor_nobody_knows_is_not_calibrated(tmp_path):
    record, trouble = load_record(tmp_path, "new")
    assert (record, trouble) == (SensorRecord("new"), "")
    assert judge_record(record, NOW_S, SITE)[0] == "not calibrated"
    assert list(tmp_path.iterdir()) == []


def test_two_sensors_share_no_file_whatever_their_names(tmp_path):
    names = ["/dev/rfcomm0", "/dev/rfcomm1", "DEV-RFCOMM0", "dev rfcomm0", "..", "", "ß" * 300]
    assert len({record_path(tmp_path, name) for name in names}) == len(names)
    assert all(record_path(tmp_path, name).parent == tmp_path / "sensors" for name in names)


@pytest.mark.parametrize("level", [None, RECORD.level, replace(RECORD.level, is_level=False)])
def test_a_passed_level_check_is_what_is_used(level):
    used = replace(RECORD, level=level).used
    assert used == (RECORD.level.used if level is RECORD.level else CALIBRATION)


# Damage.


@settings(max_examples=150)
@given(st.data())
def test_a_file_cut_off_or_with_flipped_bits_is_told_and_left_alone(tmp_path_factory, data):
    folder = tmp_path_factory.getbasetemp() / "damaged"
    save_record(folder, RECORD)
    path = record_path(folder, RECORD.sensor_id)
    whole = path.read_bytes()
    if data.draw(st.booleans()):
        bad = whole[: data.draw(st.integers(0, len(whole) - 1))]
    else:
        at, bit = data.draw(st.integers(0, len(whole) - 1)), data.draw(st.integers(0, 7))
        bad = whole[:at] + bytes([whole[at] ^ 1 << bit]) + whole[at + 1 :]
    path.write_bytes(bad)
    record, trouble = load_record(folder, RECORD.sensor_id)
    assert path.read_bytes() == bad
    if trouble:
        assert record == SensorRecord(RECORD.sensor_id)
        assert judge_record(record, NOW_S, SITE)[0] == "not calibrated"
        assert len(trouble.splitlines()) == 1
        assert path.name in trouble
        assert "calibrate the sensor anew" in trouble
    else:
        assert record == RECORD


@settings(max_examples=80)
@given(st.binary(max_size=300) | st.text(max_size=100).map(str.encode))
def test_any_rubbish_is_told(tmp_path_factory, raw):
    folder = tmp_path_factory.getbasetemp() / "rubbish"
    path = record_path(folder, "a")
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(raw)
    record, trouble = load_record(folder, "a")
    assert record == SensorRecord("a")
    assert len(trouble.splitlines()) == 1


_DEEP = b'{"format": "gestureapp sensor", "schema": 1, "content": {"a": ' + b"[" * 900 + b"]" * 900


@pytest.mark.parametrize(
    ("raw", "words"),
    [
        (b"", "is damaged"),
        (b"[" * 100_000, "is damaged"),
        (_DEEP + b"}}", "is damaged"),
        (b"x" * 100_001, "too large"),
        (b'{"format": "other"}', "is no file of kind"),
        (b'{"format": "gestureapp sensor", "schema": 2}', "newer version (schema 2, this one"),
        (b'{"format": "gestureapp sensor", "schema": true}', "its version is missing"),
        (b'{"format": "gestureapp sensor", "schema": 1}', "'content' is missing"),
    ],
)
def test_each_kind_of_bad_file_has_its_words(tmp_path, raw, words):
    path = record_path(tmp_path, "a")
    path.parent.mkdir()
    path.write_bytes(raw)
    assert words in load_record(tmp_path, "a")[1]


def test_a_bad_file_is_kept_under_another_name_when_a_new_one_is_written(tmp_path):
    path = record_path(tmp_path, RECORD.sensor_id)
    path.parent.mkdir()
    for raw in (b"one", b"two"):
        path.write_bytes(raw)
        save_record(tmp_path, RECORD)
        assert load_record(tmp_path, RECORD.sensor_id) == (RECORD, "")
    kept = sorted(p.name for p in path.parent.iterdir() if p != path)
    assert kept == [f"{path.stem}.damaged-1.json", f"{path.stem}.damaged-2.json"]
    assert (path.parent / kept[0]).read_bytes() == b"one"


def test_another_sensors_file_is_not_used(tmp_path):
    save_record(tmp_path, RECORD)
    record_path(tmp_path, RECORD.sensor_id).rename(record_path(tmp_path, "other"))
    record, trouble = load_record(tmp_path, "other")
    assert not record.is_calibrated
    assert "is that of another sensor" in trouble


def test_a_folder_that_cannot_be_made_is_told(tmp_path):
    (tmp_path / "sensors").write_text("in the way")
    with pytest.raises(RecordingError, match="--data-dir"):
        save_record(tmp_path, RECORD)
    assert "cannot be read" in load_record(tmp_path, RECORD.sensor_id)[1]


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("calibration", {"offset_g": [0, 0, 0], "matrix": [[1, 0], [0, 1]]}),
        ("calibration", {"offset_g": [0, 0, 1e9], "matrix": MATRIX}),
        ("calibration", {"offset_g": [0, 0, float("nan")], "matrix": MATRIX}),
        ("calibrated_wall_s", "yesterday"),
        ("calibrated_wall_s", -1.0),
        ("calibrated_wall_s", 1e18),
        ("level", {"is_level": 1}),
        ("level", []),
        ("link", {"n_lost": -1}),
        ("link", {"port": 7}),
    ],
)
def test_values_that_cannot_be_are_refused_even_with_the_right_digest(tmp_path, name, value):
    from gestureapp.recording.kept_json import _digest

    save_record(tmp_path, RECORD)
    path = record_path(tmp_path, RECORD.sensor_id)
    whole = json.loads(path.read_bytes())
    whole["content"][name] = value
    whole["sha256"] = _digest(whole["content"])
    path.write_text(json.dumps(whole))
    record, trouble = load_record(tmp_path, RECORD.sensor_id)
    assert (record.calibration, record.is_calibrated) == (NOMINAL, False)
    assert "calibrate the sensor anew" in trouble


# Dates.


@pytest.mark.parametrize(
    ("calibrated_days", "level_hours", "problem"),
    [
        (0, None, ""),
        (0.49, None, ""),
        (0.51, None, "level checked 12 hours ago, 12 are allowed"),
        (100, 0, ""),
        (100, 12, ""),
        (100, 12.1, "level checked 12 hours ago"),
        (180, 0, ""),
        (180.01, 0, "calibrated 180 days ago, 180 are allowed"),
        (-0.01, 0, "calibrated in the future"),
        (10, -1, "checked for level in the future"),
    ],
)
def test_a_record_is_judged_by_its_dates(calibrated_days, level_hours, problem):
    level = None
    if level_hours is not None:
        level = replace(RECORD.level, wall_s=NOW_S - level_hours * 3600)
    record = replace(RECORD, calibrated_wall_s=NOW_S - calibrated_days * DAY_S, level=level)
    found, remedy = judge_record(record, NOW_S, SITE)
    assert found.startswith(problem)
    assert bool(found) is bool(remedy) is bool(problem)


def test_a_site_that_wants_no_level_check_still_hears_of_a_failed_one():
    site = replace(SITE, level_check_hours=0.0)
    old = replace(RECORD, calibrated_wall_s=NOW_S - 9 * DAY_S, level=None)
    assert judge_record(old, NOW_S, site) == ("", "")
    failed = replace(old, level=LevelRecord(NOW_S, False, 3.94, 0.0))
    assert judge_record(failed, NOW_S, site)[0] == "3.9 degrees off level"


@given(st.floats(allow_nan=True, allow_infinity=True), st.floats(allow_nan=True))
@example(1.0, math.inf)
@example(-math.inf, 1.0)
def test_no_date_at_all_makes_a_sensor_that_may_not_be_judged_ready(wall_s, now_s):
    record = replace(RECORD, calibrated_wall_s=wall_s, level=None)
    problem, _ = judge_record(record, now_s, SITE)
    assert problem or -60.0 <= now_s - wall_s <= 0.5 * DAY_S


# People.


def test_a_persons_profile_is_read_back(tmp_path):
    assert load_profile(tmp_path, "Ada") == (PersonProfile(), "")
    save_profile(tmp_path, "Ada", PROFILE)
    assert load_profile(tmp_path, "Ada") == (PROFILE, "")
    assert load_profile(tmp_path, "Bea") == (PersonProfile(), "")


@settings(max_examples=100)
@given(st.data())
def test_a_damaged_profile_is_told_and_left_alone(tmp_path_factory, data):
    folder = tmp_path_factory.getbasetemp() / "people-damaged"
    save_profile(folder, "Ada", PROFILE)
    path = person_folder(folder, "Ada") / PROFILE_FILE
    whole = path.read_bytes()
    at = data.draw(st.integers(0, len(whole) - 1))
    cut, bit = data.draw(st.booleans()), data.draw(st.integers(0, 7))
    bad = whole[:at] if cut else whole[:at] + bytes([whole[at] ^ 1 << bit]) + whole[at + 1 :]
    path.write_bytes(bad)
    profile, trouble = load_profile(folder, "Ada")
    assert path.read_bytes() == bad
    assert (profile == PROFILE) is (trouble == "")
    if trouble:
        assert profile == PersonProfile()
        assert trouble.startswith("Ada's profile.json is ")
