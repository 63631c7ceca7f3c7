"""The virtual operator's hands on two real sensor emulators."""

import contextlib
import socket
from collections.abc import Iterator

import pytest

from gestureapp.clock import monotonic
from gestureapp.sensing.posture import PostureDetector
from gestureapp.sensing.protocols import protocol
from gestureapp.sensing.values import ArmPosture, Frame, Side
from gestureapp.simulation.control_link import ControlLink
from gestureapp.simulation.operator import OperatorClient
from gestureapp.simulation.operator_plan import Timing
from gestureapp.simulation.sensor import SensorEmulator, SensorOptions
from gestureapp.simulation.sensor_model import FaultKind
from gestureapp.simulation.wearer import person_of

LIMIT_S = 10.0
PERSON = person_of(7, 2, is_practised=True)


@pytest.fixture
def sensors() -> Iterator[dict[Side, SensorEmulator]]:
    with (
        SensorEmulator(SensorOptions(Side.LEFT, 0, 0)) as left,
        SensorEmulator(SensorOptions(Side.RIGHT, 0, 0)) as right,
    ):
        yield {Side.LEFT: left, Side.RIGHT: right}


@pytest.fixture
def operator(sensors: dict[Side, SensorEmulator]) -> Iterator[OperatorClient]:
    client = client_of(sensors[Side.LEFT].control_port, sensors[Side.RIGHT].control_port)
    client.start()
    yield client
    client.close()


def client_of(left_port: int, right_port: int) -> OperatorClient:
    return OperatorClient(
        ("127.0.0.1", left_port), ("127.0.0.1", right_port), Timing.of(PERSON), seed=1
    )


def state(sensor: SensorEmulator) -> dict[str, object]:
    with ControlLink("sensor", "127.0.0.1", sensor.control_port) as link:
        return link.ask({"do": "state"})


class ArmReader:
    """Reads a stream and tells when something is first seen in it."""

    def __init__(self, port: int) -> None:
        self._socket = socket.create_connection(("127.0.0.1", port), LIMIT_S)
        self._decoder = protocol("csv").new_decoder()

    def seen_s(self, shows) -> float:
        """When a sample first satisfies the condition, by the test's clock."""
        deadline_s = monotonic() + LIMIT_S
        while monotonic() < deadline_s:
            events = self._decoder.feed(self._socket.recv(4096))
            now_s = monotonic()
            if any(shows(event.raw) for event in events if isinstance(event, Frame)):
                return now_s
        raise AssertionError("not seen")

    def close(self) -> None:
        self._socket.close()


@contextlib.contextmanager
def readers(sensors):
    both = [ArmReader(sensors[side].port) for side in (Side.LEFT, Side.RIGHT)]
    yield both
    for reader in both:
        reader.close()


def test_a_gesture_raises_the_left_arm_and_moves_the_right(operator, sensors):
    detector = PostureDetector(25.0, 40.0, 3)
    with readers(sensors) as (left, right):
        operator.gesture("X+")
        left.seen_s(lambda accel_g: detector.feed(accel_g) is ArmPosture.START)
        right.seen_s(lambda accel_g: accel_g[0] > 0.5)
    assert "Left arm in start posture" in operator.describe()
    assert "X+, push forward" in operator.describe()


def test_a_held_turn_is_there_when_the_left_arm_rises_and_rests_after_it(operator, sensors):
    with readers(sensors) as (left, right):
        operator.gesture("RY-")
        right.seen_s(lambda accel_g: accel_g[0] < -0.8)
        left.seen_s(lambda accel_g: accel_g[0] < -0.8)
        operator.left_stop()
        left.seen_s(lambda accel_g: accel_g[2] > 0.8)
        right.seen_s(lambda accel_g: accel_g[2] > 0.9 and abs(accel_g[0]) < 0.1)


def test_single_arms_do_what_the_buttons_say(operator, sensors):
    operator.left_start()
    operator.right_rest()
    assert operator.wait_idle(LIMIT_S)
    assert state(sensors[Side.LEFT])["doing"] == "take start"
    assert state(sensors[Side.RIGHT])["doing"] == "rest"
    operator.left_stop()
    assert operator.wait_idle(LIMIT_S)
    assert state(sensors[Side.LEFT])["doing"] == "take stop"


def test_faults_reach_the_sensors_and_stand_in_the_description(operator, sensors):
    operator.silence_left()
    operator.fault(Side.RIGHT, FaultKind.SLOW, rate_hz=25.0)
    assert operator.wait_idle(LIMIT_S)
    assert state(sensors[Side.LEFT])["fault"] == "silent"
    assert state(sensors[Side.RIGHT])["rate_hz"] == 25.0
    assert "left sensor silent" in operator.describe()
    assert "right sensor slow" in operator.describe()
    operator.restore_sensors()
    assert operator.wait_idle(LIMIT_S)
    assert state(sensors[Side.LEFT])["fault"] == state(sensors[Side.RIGHT])["fault"] == "none"
    assert "silent" not in operator.describe()


def test_only_the_newest_of_several_gestures_is_made(sensors):
    client = client_of(sensors[Side.LEFT].control_port, sensors[Side.RIGHT].control_port)
    for label in ("X+", "Y+", "RX-", "Z-"):
        client.gesture(label)
    client.start()
    assert client.wait_idle(LIMIT_S)
    assert "right arm Z-" in client.describe()
    with readers(sensors) as (_, right):
        right.seen_s(lambda accel_g: accel_g[2] < 0.6)
    assert state(sensors[Side.RIGHT])["doing"] == "perform Z-"
    client.close()


def test_an_unknown_gesture_is_the_callers_mistake(operator):
    with pytest.raises(KeyError):
        operator.gesture("Q")


def test_a_lost_emulator_stands_in_the_description_until_it_answers_again(operator, sensors):
    gone = sensors[Side.LEFT]
    operator.left_start()
    assert operator.wait_idle(LIMIT_S)
    gone.stop()
    operator.left_stop()
    assert operator.wait_idle(LIMIT_S)
    assert "left sensor emulator: does not answer at 127.0.0.1" in operator.describe()
    assert "start it again" in operator.describe()
    back = SensorOptions(Side.LEFT, 0, gone.control_port)
    with SensorEmulator(back):
        operator.left_stop()
        assert operator.wait_idle(LIMIT_S)
        assert "does not answer" not in operator.describe()


def test_an_emulator_that_hangs_blocks_nobody_and_the_end_is_quick():
    with socket.create_server(("127.0.0.1", 0)) as mute:
        port = mute.getsockname()[1]
        client = client_of(port, port)
        client.start()
        before_s = monotonic()
        for _ in range(1000):
            client.left_start()
            client.gesture("X+")
        asked_s = monotonic() - before_s
        client.close()
    assert asked_s < LIMIT_S


def test_something_else_at_the_port_is_reported_in_words():
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
        client = client_of(port, port)
        client.start()
        client.left_start()
        connection, _ = server.accept()
        connection.sendall(b"220 mail ready\r\n")
        assert client.wait_idle(LIMIT_S)
        connection.close()
        assert "left sensor emulator: does not answer" in client.describe()
        client.close()


def test_closing_twice_or_without_start_is_fine():
    client = client_of(1, 1)
    client.close()
    client.close()
