"""The emulated NX100 on a real socket: raw bytes, faults, the log."""

import json
import socket

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from gestureapp.clock import monotonic
from gestureapp.errors import RobotError
from gestureapp.robot.values import Pose
from gestureapp.simulation.nx100 import Nx100Emulator
from gestureapp.simulation.nx100_log import What
from gestureapp.simulation.nx100_options import (
    Fault,
    FaultKind,
    Nx100Options,
    ScriptedFault,
    Second,
    Segments,
)
from gestureapp.simulation.nx100_values import Hold, Mode

LIMIT_S = 10.0
KEEP = b"CONNECT Robot_access Keep-Alive:-1\r\n"
BANNER = b"OK: NX Information Server( 1.07) Keep-Alive:-1.\r\n"
SINGLE_BANNER = b"OK: NX Information Server( 1.07).\r\n"


def move(dz="5.000", speed="20.0"):
    return f"0,{speed},1,0.000,0.000,{dz},0.00,0.00,0.00,0,0,0,0,0,0,0,0\r"


@pytest.fixture
def emulator():
    with Nx100Emulator() as running:
        yield running


@pytest.fixture
def link():
    """Open raw connections; all closed in the end."""
    opened = []

    def open_to(running, start=KEEP, banner=BANNER):
        client = socket.create_connection(("127.0.0.1", running.port), LIMIT_S)
        opened.append(client)
        if start:
            client.sendall(start)
            assert exactly(client, len(banner)) == banner
        return client

    yield open_to
    for client in opened:
        client.close()


def exactly(client, n):
    """Read n bytes, or what came before the end."""
    data = b""
    while len(data) < n and (part := client.recv(n - len(data))):
        data += part
    return data


def to_end(client):
    data = b""
    try:
        while part := client.recv(4096):
            data += part
    except ConnectionResetError:
        data += b"<reset>"
    return data


def raise_reset(said):
    if said.endswith(b"<reset>"):
        raise ConnectionResetError


def ask(client, name, data="", n=6):
    client.sendall(f"HOSTCTRL_REQUEST {name} {len(data)}\r\n".encode())
    ok = f"OK: {name}\r\n".encode()
    assert exactly(client, len(ok)) == ok
    client.sendall(data.encode())
    return exactly(client, n)


@pytest.mark.parametrize("segments", list(Segments))
def test_bytes_are_the_same_in_every_segment_mode(segments, link):
    with Nx100Emulator(Nx100Options(segments=segments)) as running:
        client = link(running)
        assert ask(client, "RSTATS", n=7) == b"194,64\r"
        assert ask(client, "SVON", "1\r") == b"0000\r\n"
        assert ask(client, "RALARM", n=20) == b"0,0,0,0,0,0,0,0,0,0\r"


def test_single_command_connection_is_closed_after_the_answer(emulator, link):
    client = link(emulator, b"CONNECT Robot_access\r\n", SINGLE_BANNER)
    assert ask(client, "RSTATS", n=7) == b"194,64\r"
    assert to_end(client) == b""


def test_ng_closes_the_connection(emulator, link):
    client = link(emulator)
    client.sendall(b"HOSTCTRL_REQUEST MOVJ 10\r\n")
    assert to_end(client) == b"NG: 501 Not Implemented\r\n"


def test_move_goes_on_when_the_connection_is_gone(emulator, link):
    client = link(emulator)
    assert ask(client, "IMOV", move("8.000", "200.0")) == b"0000\r\n"
    client.close()
    ended = emulator.log.wait_for(lambda e: e.what is What.MOTION_END, LIMIT_S)
    assert ended is not None
    assert (ended.name, ended.pose) == ("done", Pose(800.0, 0.0, 308.0, 180.0, 0.0, 0.0))


def test_log_has_bytes_requests_and_motion_in_memory_and_in_its_file(tmp_path, link):
    file = tmp_path / "nx100.jsonl"
    with Nx100Emulator(Nx100Options(log_file=file)) as running:
        before_s = monotonic()
        client = link(running)
        ask(client, "IMOV", move("2.000", "100.0"))
        assert running.log.wait_for(lambda e: e.what is What.MOTION_END, LIMIT_S)
        after_s = monotonic()
        (request,) = running.log.requests("IMOV")
        assert before_s <= request.t_s <= after_s
        heard = b"".join(e.data for e in running.log.events(What.IN))
        assert heard.startswith(KEEP)
        assert heard.endswith(move("2.000", "100.0").encode())
    lines = [json.loads(line) for line in file.read_text().splitlines()]
    kinds = [line["event"] for line in lines]
    assert kinds[0] == "open"
    assert {"bytes", "request", "motion_start", "motion_end", "close"} <= set(kinds)
    said = "".join(line["text"] for line in lines if line.get("direction") == "out")
    assert said.encode() == BANNER + b"OK: IMOV\r\n0000\r\n"
    (asked,) = [line for line in lines if line["event"] == "request"]
    assert (asked["request"], asked["data"]) == ("IMOV", move("2.000", "100.0").strip())
    assert asked["t_s"] == request.t_s


def test_second_connection_is_served_independently_by_default(emulator, link):
    first, second = link(emulator), link(emulator)
    first.sendall(b"HOSTCTRL_REQUEST IMOV 58\r\n")
    assert exactly(first, 10) == b"OK: IMOV\r\n"
    assert ask(second, "HOLD", "1\r") == b"0000\r\n"
    first.sendall(move().encode())
    assert exactly(first, 36) == b"ERROR: IMOV is not successful(2050)."


def test_second_connection_is_reset_where_it_is_refused(link):
    with Nx100Emulator(Nx100Options(second=Second.REFUSE)) as running:
        first = link(running)
        with pytest.raises(ConnectionError):  # at once, or at the first answer
            raise_reset(to_end(link(running, b"")))
        assert ask(first, "RSTATS", n=7) == b"194,64\r"
        first.close()
        link(running)


def test_second_connection_waits_for_its_turn_where_it_is_ignored(link):
    with Nx100Emulator(Nx100Options(second=Second.IGNORE)) as running:
        first, second = link(running), link(running, b"")
        second.sendall(KEEP)
        assert ask(first, "RSTATS", n=7) == b"194,64\r"
        assert len(running.log.events(What.OPEN)) == 1
        first.close()
        assert exactly(second, len(BANNER)) == BANNER


def test_dropped_connections_are_reset_and_new_ones_served(emulator, link):
    client = link(emulator)
    emulator.fault(Fault(FaultKind.DROP))
    assert to_end(client) == b"<reset>"
    assert ask(link(emulator), "RSTATS", n=7) == b"194,64\r"


def test_refused_connections_meet_nobody_until_the_fault_is_over(emulator, link):
    first = link(emulator)
    emulator.fault(Fault(FaultKind.REFUSE))
    with pytest.raises(ConnectionRefusedError):
        link(emulator)
    assert ask(first, "RSTATS", n=7) == b"194,64\r"
    emulator.fault(Fault())
    link(emulator)


def test_refused_connections_and_ignored_ones_go_together(link):
    with Nx100Emulator(Nx100Options(second=Second.IGNORE)) as running:
        link(running)
        running.fault(Fault(FaultKind.REFUSE))
        with pytest.raises(ConnectionRefusedError):
            link(running, b"")
        running.fault(Fault(FaultKind.DROP))
        link(running)


def test_silent_controller_hears_but_says_nothing(emulator, link):
    client = link(emulator)
    emulator.fault(Fault(FaultKind.SILENT))
    client.sendall(b"HOSTCTRL_REQUEST HOLD 2\r\n1\r")
    assert emulator.log.wait_for(lambda e: e.name == "HOLD", LIMIT_S)
    assert emulator.log.events(What.OUT)[-1].data == BANNER
    assert emulator.controller.holds is Hold.NONE


def test_scripted_fault_begins_by_itself(link):
    script = (ScriptedFault(0.0, Fault(FaultKind.NG)),)
    with Nx100Emulator(Nx100Options(script=script)) as running:
        assert running.log.wait_for(lambda e: e.what is What.FAULT, LIMIT_S)
        client = link(running, b"")
        client.sendall(KEEP)
        assert to_end(client) == b"NG: 503 Service Unavailable\r\n"


def test_pendant_stops_a_move_and_shows_it(emulator, link):
    client = link(emulator)
    ask(client, "IMOV", move("50.000"))
    assert emulator.log.wait_for(lambda e: e.what is What.MOTION_START, LIMIT_S)
    emulator.hold(Hold.PENDANT, True)
    ended = emulator.log.wait_for(lambda e: e.what is What.MOTION_END, LIMIT_S)
    assert ended is not None
    assert ended.name == "hold"
    assert ended.pose == emulator.pose()
    assert not emulator.is_running()
    assert ask(client, "RSTATS", n=7) == b"194,66\r"


def test_switches_show_in_the_status_bits(emulator, link):
    client = link(emulator)
    emulator.remote(False)
    emulator.mode(Mode.TEACH)
    emulator.servo(False)
    emulator.error(2060)
    assert ask(client, "RSTATS", n=6) == b"34,32\r"
    assert emulator.place(Pose(700.0, 0.0, 0.0, 180.0, 0.0, 0.0))
    assert ask(client, "RPOSC", "1,0\r", n=7) == b"700.000"


def test_port_in_use_is_an_error_with_a_remedy(emulator):
    with pytest.raises(RobotError, match="name another port"):
        Nx100Emulator(Nx100Options(port=emulator.port)).start()


def test_control_port_in_use_is_an_error_with_a_remedy(emulator):
    with pytest.raises(RobotError, match="control port"):
        Nx100Emulator(Nx100Options(control_port=emulator.port)).start()


def test_stop_is_idempotent_and_closes_every_connection(link):
    running = Nx100Emulator()
    running.start()
    client = link(running)
    running.stop()
    running.stop()
    assert to_end(client) in (b"", b"<reset>")


def test_manual_clock_moves_the_robot_when_woken(link):
    now_s = [100.0]
    with Nx100Emulator(clock=lambda: now_s[0]) as running:
        client = link(running)
        assert ask(client, "IMOV", move("50.000", "50.0")) == b"0000\r\n"
        assert not running.is_running()
        now_s[0] += 0.5
        running.wake()
        started = running.log.wait_for(lambda e: e.what is What.MOTION_START, LIMIT_S)
        assert started is not None
        assert started.t_s == pytest.approx(100.004)
        assert running.is_running()
        assert running.pose().z_mm == pytest.approx(300 + 50 * (0.496 - 0.025))


@settings(max_examples=40, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(st.binary(min_size=1, max_size=80), max_size=5), st.booleans())
def test_rubbish_never_kills_the_server(emulator, parts, is_connected):
    with socket.create_connection(("127.0.0.1", emulator.port), LIMIT_S) as client:
        try:
            for part in ([KEEP] if is_connected else []) + parts:
                client.sendall(part)
        except ConnectionError:
            pass
    with socket.create_connection(("127.0.0.1", emulator.port), LIMIT_S) as client:
        client.sendall(KEEP)
        assert exactly(client, len(BANNER)) == BANNER
        assert ask(client, "RALARM", n=2) == b"0,"


class Pendant:
    """A client of the control port."""

    def __init__(self, port):
        self.socket = socket.create_connection(("127.0.0.1", port), LIMIT_S)
        self.file = self.socket.makefile("rwb")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.file.close()
        self.socket.close()

    def says(self, line):
        self.file.write(line + b"\n")
        self.file.flush()
        return json.loads(self.file.readline())

    def does(self, **fields):
        return self.says(json.dumps(fields).encode())


@pytest.fixture
def pendant():
    with (
        Nx100Emulator(Nx100Options(control_port=0)) as running,
        Pendant(running.control_port) as client,
    ):
        client.emulator = running
        yield client


def test_control_port_shows_the_state_and_works_every_switch(pendant):
    assert pendant.does(do="servo", on=False) == {"ok": True}
    assert pendant.does(do="remote", on=False) == {"ok": True}
    assert pendant.does(do="pendant_hold", on=True) == {"ok": True}
    assert pendant.does(do="external_hold", on=True) == {"ok": True}
    assert pendant.does(do="alarm", code=4100, data=2) == {"ok": True}
    assert pendant.does(do="error", code=2060) == {"ok": True}
    assert pendant.does(do="mode", mode="teach") == {"ok": True}
    assert pendant.does(do="pose", x=700.0, rz=20) == {"ok": True}
    state = pendant.does(do="state")
    assert state.pop("t_s") <= monotonic()
    assert state == {
        "ok": True,
        "pose": [700.0, 0.0, 300.0, 180.0, 0.0, 20.0],
        "running": False,
        "status": [34, 0x36],
        "servo": False,
        "remote": False,
        "mode": "teach",
        "holds": ["pendant", "external"],
        "alarms": [[4100, 2]],
        "error": [2060, 0],
    }


def test_control_port_begins_faults(pendant, link):
    assert pendant.does(do="fault", kind="error", code=2100) == {"ok": True}
    client = link(pendant.emulator)
    assert ask(client, "RSTATS", n=39) == b"ERROR: RSTATS is not successful(2100)."[:39] + b"\r"


@pytest.mark.parametrize(
    "line",
    [
        b"rubbish",
        b"[1]",
        b'{"do": "dance"}',
        b'{"do": ["servo"]}',
        b'{"do": "servo"}',
        b'{"do": "servo", "on": 1}',
        b'{"do": "alarm"}',
        b'{"do": "alarm", "code": "x"}',
        b'{"do": "alarm", "code": 1e999}',
        b'{"do": "mode", "mode": "auto"}',
        b'{"do": "pose", "x": "far"}',
        b'{"do": "pose", "x": 1e9}',
        b'{"do": "fault", "kind": "tired"}',
        b'{"do": "fault", "kind": "slow", "ms": -1}',
        b'{"do": "fault", "kind": "silent", "execute": 3}',
        b"\xff\xfe",
    ],
)
def test_control_port_refuses_what_makes_no_sense_in_words(pendant, line):
    answer = pendant.says(line)
    assert answer["ok"] is False
    assert answer["error"]
    assert pendant.does(do="state")["ok"] is True
