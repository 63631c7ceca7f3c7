"""The emulated NX100 and an independent client, in every segment mode that the client can stand.

It cannot stand single bytes: it takes the letters OK for the whole line, and what is left of that
line for the answer. Where OK and answer come in one segment it loses the answer, unless its own
data has to come between.
"""

from dataclasses import replace

import pytest
import yrcom

from gestureapp.simulation.nx100 import Nx100Emulator
from gestureapp.simulation.nx100_log import What
from gestureapp.simulation.nx100_options import Fault, FaultKind, Nx100Options, Segments
from gestureapp.simulation.nx100_values import START_POSE, ControllerOptions

LIMIT_S = 10.0


def move(dz="5.000", speed="20.0"):
    return f"0,{speed},1,0.000,0.000,{dz},0.00,0.00,0.00,0,0,0,0,0,0,0,0\r"


@pytest.mark.parametrize("segments", [Segments.SEPARATE, Segments.LATE_LF])
def test_the_client_does_its_round(segments):
    with (
        Nx100Emulator(Nx100Options(segments=segments)) as running,
        yrcom.YaskawaClient("127.0.0.1", running.port, timeout=LIMIT_S) as client,
    ):
        assert client.send_start(keep_alive=-1).startswith("OK: NX Information Server")
        status = client.read_rstats(persistent=True)
        assert [word for word, is_on in status.items() if is_on] == [
            *("one_cycle", "play", "cmd_remote", "servo_on"),
        ]
        position = client.read_position_cartesian(1, persistent=True)
        assert position["X"] == 800.0
        assert position["Rx"] == 180.0
        assert len(client.read_position_joint(persistent=True)) == 12
        assert client.read_alarm(persistent=True) == [0] * 10
        assert client.send_command("IMOV", len(move()), move()).strip() == "0000"
        assert running.log.wait_for(lambda e: e.what is What.MOTION_START, LIMIT_S)
        assert client.hold(True, persistent=True)
        ended = running.log.wait_for(lambda e: e.what is What.MOTION_END, LIMIT_S)
        assert ended is not None
        assert ended.name == "hold"
        assert client.read_rstats(persistent=True)["hold_cmd"]
        assert client.hold(False, persistent=True)
        assert client.servo_on(False, persistent=True)
        assert client.servo_on(True, persistent=True)
        assert client.io_write(22010, [1, 2], persistent=True)
        assert client.io_read(22010, 16, persistent=True) == [1, 2]
        assert client.io_read(50010, 24, persistent=True) == [0, 0, 0]
        assert client.write_variable(yrcom.VarType.DOUBLE, 1, 1234, persistent=True)
        assert client.read_variable(yrcom.VarType.DOUBLE, 1, persistent=True) == 1234
        assert client.set_cycle(3, persistent=True)
        assert client.display_message("moving", persistent=True)
        assert client.reset(persistent=True)
        assert client.cancel(persistent=True)


def test_the_client_stands_coalesced_answers_where_its_data_comes_between():
    """It reads OK and answer one after the other, so commands without data find nothing left."""
    with (
        Nx100Emulator(Nx100Options(segments=Segments.COALESCED)) as running,
        yrcom.YaskawaClient("127.0.0.1", running.port, timeout=LIMIT_S) as client,
    ):
        client.send_start(keep_alive=-1)
        assert client.hold(True, persistent=True)
        assert client.hold(False, persistent=True)
        assert client.read_position_cartesian(1, persistent=True)["X"] == 800.0
        assert client.send_command("IMOV", len(move()), move()).strip() == "0000"
        assert running.log.wait_for(lambda e: e.what is What.MOTION_END, LIMIT_S)
        assert client.servo_on(False, persistent=True)
        assert client.servo_on(True, persistent=True)
        assert client.io_write(22010, [1], persistent=True)
        assert client.io_read(22010, 8, persistent=True) == [1]
        assert client.write_variable(yrcom.VarType.BYTE, 0, 7, persistent=True)
        assert client.read_variable(yrcom.VarType.BYTE, 0, persistent=True) == 7


def test_the_client_does_its_round_though_everything_comes_late():
    fault = Fault(FaultKind.SLOW, delay_s=0.05)
    with Nx100Emulator(Nx100Options(answer_delay_s=0.02)) as running:
        running.fault(fault)
        with yrcom.YaskawaClient("127.0.0.1", running.port, timeout=LIMIT_S) as client:
            client.send_start(keep_alive=4)
            assert client.read_rstats(persistent=True)["play"]
            assert client.servo_on(False, persistent=True)
            assert client.servo_on(True, persistent=True)
            assert client.read_alarm(persistent=True) == [0] * 10
            assert client.sock.recv(1) == b""  # its four commands are used up


def test_the_client_recovers_from_an_alarm_at_the_limit_with_a_late_servo():
    cell = ControllerOptions(servo_on_delay_s=0.2, start_pose=replace(START_POSE, x_mm=1100.0))
    with (
        Nx100Emulator(Nx100Options(controller=cell)) as running,
        yrcom.YaskawaClient("127.0.0.1", running.port, timeout=LIMIT_S) as client,
    ):
        client.send_start(keep_alive=-1)
        far = move(dz="1500.000", speed="1500.0")
        assert client.send_command("IMOV", len(far), far).strip() == "0000"
        ended = running.log.wait_for(lambda e: e.what is What.MOTION_END, LIMIT_S)
        assert ended is not None
        assert ended.name == "alarm"
        status = client.read_rstats(persistent=True)
        assert (status["alarm"], status["servo_on"], status["running"]) == (True, False, False)
        assert client.read_alarm(persistent=True)[2] != 0
        assert "(2060)" in client.send_command("IMOV", len(far), far)
        assert client.reset(persistent=True)
        assert "(2070)" in client.send_command("IMOV", len(far), far)
        assert client.servo_on(True, persistent=True)
        back = move(dz="-5.000")
        assert client.send_command("IMOV", len(back), back).strip() == "0000"
        assert "(2010)" in client.send_command("IMOV", len(back), back)


@pytest.fixture
def emulator():
    with Nx100Emulator() as running:
        yield running


def test_the_client_does_single_transactions(emulator):
    client = yrcom.YaskawaClient("127.0.0.1", emulator.port, timeout=LIMIT_S)
    assert client.read_rstats(decode=False) in ([194, 64], "194,64\r")
    assert client.read_position_cartesian(0, external_axis=True)["Z"] == 300.0
    assert client.servo_on(False)
    assert not client.read_rstats()["servo_on"]
    assert client.reset()
    assert client.cancel()
