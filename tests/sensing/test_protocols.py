"""Protocols by name, and the way from raw values to g."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gestureapp.errors import ConfigError
from gestureapp.sensing.calibration import NOMINAL, Calibration, Matrix, accel_of
from gestureapp.sensing.protocols import BUILT_IN, protocol
from gestureapp.sensing.values import Frame, Garbage, Impossible

axis_g = st.floats(-4, 4)
gain = st.floats(0.5, 2)


def diagonal(x: float, y: float, z: float) -> Matrix:
    return ((x, 0.0, 0.0), (0.0, y, 0.0), (0.0, 0.0, z))


@pytest.mark.parametrize("known", BUILT_IN, ids=lambda known: known.name)
def test_each_protocol_is_found_by_its_name(known):
    assert protocol(known.name) is known
    assert known.words


def test_each_connection_gets_a_decoder_of_its_own():
    assert protocol("csv").new_decoder() is not protocol("csv").new_decoder()


def test_unknown_protocol_names_the_likeliest_and_all_known():
    with pytest.raises(
        ConfigError, match=r"did you mean 'adxl330'\? known are: adxl330, binary, csv"
    ):
        protocol("ADXL-330")


def test_a_name_like_none_gets_the_list_without_a_guess():
    with pytest.raises(ConfigError) as caught:
        protocol("zigbee")
    assert "did you mean" not in str(caught.value)
    assert caught.value.value == "zigbee"


@given(st.tuples(axis_g, axis_g, axis_g), st.tuples(axis_g, axis_g, axis_g), gain)
def test_calibration_undoes_offset_and_gain(true_g, offset, factor: float):
    gains = (factor, 1.0, 1 / factor)
    read_g = tuple(t / k + o for t, o, k in zip(true_g, offset, gains, strict=True))
    assert Calibration(offset, diagonal(*gains)).applied(read_g) == pytest.approx(true_g, abs=1e-9)


def test_calibration_takes_what_one_axis_shows_of_another_out_of_it():
    matrix = ((1.0, 0.1, 0.0), (0.0, 1.0, 0.2), (0.3, 0.0, 1.0))
    assert Calibration(matrix=matrix).applied((1.0, 2.0, 3.0)) == pytest.approx((1.2, 2.6, 3.3))


def test_a_level_adxl330_reads_one_g_on_z():
    frame = Frame(1, (512.0, 512.0, 614.0))
    accel_g = accel_of(frame, protocol("adxl330"), NOMINAL)
    assert accel_g == pytest.approx((0, 0, 1), abs=0.005)


@pytest.mark.parametrize(("value_g", "is_possible"), [(16.0, True), (-16.0, True), (16.01, False)])
def test_csv_beyond_what_a_sensor_gives_is_impossible(value_g: float, is_possible: bool):
    accel_g = accel_of(Frame(None, (0.0, value_g, 1.0)), protocol("csv"), NOMINAL)
    assert isinstance(accel_g, Impossible) is not is_possible


@pytest.mark.parametrize("counts", [0.0, 1023.0])
def test_an_adxl330_at_a_rail_is_impossible(counts: float):
    reading = accel_of(Frame(1, (512.0, 512.0, counts)), protocol("adxl330"), NOMINAL)
    assert isinstance(reading, Impossible)
    assert "on Z" in reading.reason
    assert reading.first_bytes == f"512,512,{counts:g}".encode()


@pytest.mark.parametrize("counts", [40.0, 950.0])
def test_an_adxl330_at_the_end_of_its_own_swing_is_possible(counts: float):
    frame = Frame(1, (counts, 512.0, 614.0))
    assert isinstance(accel_of(frame, protocol("adxl330"), NOMINAL), tuple)


def test_a_jump_to_40_g_names_value_axis_and_limit():
    reading = accel_of(Frame(None, (0.0, 0.0, 40.0)), protocol("csv"), NOMINAL)
    assert isinstance(reading, Garbage)
    assert reading.reason == "40.0 g on Z, the sensor can give 16 g"


def test_the_limit_is_the_sensors_not_the_calibrations():
    narrow = Calibration(matrix=diagonal(0.1, 0.1, 0.1))
    assert isinstance(accel_of(Frame(None, (40.0, 0.0, 0.0)), protocol("csv"), narrow), Impossible)
    wide = Calibration(matrix=diagonal(2.0, 2.0, 2.0))
    assert accel_of(Frame(None, (15.0, 0.0, 0.0)), protocol("csv"), wide) == (30.0, 0.0, 0.0)


def test_a_value_that_is_no_number_is_impossible():
    frame = Frame(None, (float("nan"), 0.0, 1.0))
    assert isinstance(accel_of(frame, protocol("csv"), NOMINAL), Impossible)
