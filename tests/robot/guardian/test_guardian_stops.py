"""The guardian stops the robot: the emulator's own log is the truth."""

import os
import signal
import socket
import subprocess
import sys

import pytest

from gestureapp.children import child_environment
from gestureapp.clock import monotonic
from gestureapp.robot import messages as m
from gestureapp.robot.values import StopReason
from gestureapp.simulation.nx100_log import What
from gestureapp.simulation.nx100_options import Fault, FaultKind, Nx100Options, Segments

pytestmark = pytest.mark.process

LIMIT_S = 10.0


@pytest.mark.parametrize("segments", list(Segments))
def test_a_move_goes_through_and_is_stopped_by_the_left_arm(start, segments):
    started, application = start
    emulator, guardian = started(Nx100Options(segments=segments))
    app = application(guardian)
    app.move(emulator)
    app.posture = "stop"
    app.wait_for(m.StopConfirmed, lambda x: x.reason is StopReason.LEFT_ARM)
    app.wait_for(m.HoldReleased)

    assert not emulator.is_running()
    assert len(emulator.log.requests("IMOV")) == 1
    assert emulator.log.events(What.BAD) == []
    app.say(m.Disarm())
    app.wait_for(m.Disarmed)


@pytest.mark.parametrize("ending", ["control", "window", "both"])
def test_an_application_whose_connection_ends_leaves_no_robot_running(start, ending, hold_after):
    started, application = start
    emulator, guardian = started()
    app = application(guardian)
    app.move(emulator)
    gone_s = monotonic()
    for name in ("control", "window") if ending == "both" else (ending,):
        getattr(app, name).shutdown(socket.SHUT_RDWR)

    hold_after(emulator, gone_s, f"{ending} connection closed to HOLD")
    assert guardian.ended() == 0
    assert not emulator.is_running()
    (end,) = emulator.log.events(What.MOTION_END)
    assert end.name == "hold"


STAND_IN = """
import socket, sys
from gestureapp.clock import monotonic
from gestureapp.robot import messages as m
from gestureapp.robot.values import Direction
port, token = int(sys.argv[1]), sys.argv[2]
socks = []
for role in m.Role:
    sock = socket.create_connection(("127.0.0.1", port), 10)
    sock.sendall(m.encode(m.Hello(token, role)))
    socks.append(sock)
control, unread, has_armed, is_start = socks[0], b"", False, False
control.settimeout(0.01)
seen = set()
while True:
    t_s = monotonic()
    control.sendall(m.encode(m.Beat(t_s, is_start, not is_start, t_s, t_s)))
    try:
        unread += control.recv(65536)
    except TimeoutError:
        pass
    *lines, unread = unread.split(b"\\n")
    for line in lines:
        message = m.decode(line)
        seen.add(type(message))
        if isinstance(message, m.Armed):
            is_start = True
            t_s = monotonic()
            control.sendall(m.encode(m.Beat(t_s, True, False, t_s, t_s)))
            control.sendall(m.encode(m.Propose(1, Direction(0, 1, False), t_s)))
        elif isinstance(message, m.CommandAccepted):
            print("moving", flush=True)
    if {m.StatusReport, m.PoseReport} <= seen and not has_armed:
        has_armed = True
        control.sendall(m.encode(m.Arm()))
"""


@pytest.mark.skipif(os.name == "nt", reason="kill -9")
def test_an_application_killed_while_moving_leaves_no_robot_running(start, hold_after):
    started, _ = start
    emulator, guardian = started()
    app = subprocess.Popen(
        [sys.executable, "-c", STAND_IN, str(guardian.port), guardian.token],
        stdout=subprocess.PIPE,
        env=child_environment(),
    )
    try:
        assert app.stdout.readline() == b"moving\n"
        assert emulator.log.wait_for(lambda e: e.what is What.MOTION_START)
        gone_s = monotonic()
        os.kill(app.pid, signal.SIGKILL)
        hold_after(emulator, gone_s, "kill -9 to HOLD")
        assert guardian.ended() == 0
    finally:
        app.kill()
        app.wait(LIMIT_S)
        app.stdout.close()
    assert not emulator.is_running()


@pytest.mark.skipif(os.name == "nt", reason="SIGSTOP")
def test_an_application_that_hangs_while_moving_is_stopped_by_the_watchdog(start, hold_after):
    started, _ = start
    emulator, guardian = started()
    app = subprocess.Popen(
        [sys.executable, "-c", STAND_IN, str(guardian.port), guardian.token],
        stdout=subprocess.PIPE,
        env=child_environment(),
    )
    try:
        assert app.stdout.readline() == b"moving\n"
        gone_s = monotonic()
        os.kill(app.pid, signal.SIGSTOP)
        hold_after(emulator, gone_s, "hang to HOLD (trip level 300 ms)")
        assert guardian.child.poll() is None
    finally:
        app.kill()
        app.wait(LIMIT_S)
        app.stdout.close()
    assert guardian.ended() == 0
    assert not emulator.is_running()


@pytest.mark.skipif(os.name == "nt", reason="SIGTERM ends at once there")
@pytest.mark.parametrize("is_moving", [True, False])
def test_sigterm_stops_first_and_ends_then(start, is_moving, hold_after):
    started, application = start
    emulator, guardian = started()
    app = application(guardian)
    if is_moving:
        app.move(emulator)
    else:
        app.wait_for(m.StatusReport)
    gone_s = monotonic()
    guardian.child.terminate()

    hold_after(emulator, gone_s, "SIGTERM to HOLD")
    assert guardian.ended() == 0
    assert not emulator.is_running()


def test_stop_from_the_window_goes_past_the_control_connection(start, hold_after):
    started, application = start
    emulator, guardian = started()
    app = application(guardian)
    app.move(emulator)
    pressed_s = monotonic()
    app.window.sendall(m.encode(m.Stop(StopReason.STOP_PRESSED, "STOP was pressed", pressed_s)))

    hold_after(emulator, pressed_s, "STOP to HOLD")
    app.wait_for(m.StopConfirmed, lambda x: x.reason is StopReason.STOP_PRESSED)
    app.wait_for(m.Disarmed)
    assert guardian.child.poll() is None


def test_the_window_can_stop_and_nothing_else(start):
    started, application = start
    _, guardian = started()
    app = application(guardian)
    app.wait_for(m.StatusReport)
    app.window.sendall(m.encode(m.Arm()) + m.encode(m.ServoOn()))
    app.window.sendall(m.encode(m.Stop(StopReason.STOP_PRESSED, "x", 0.0)))
    app.wait_for(m.StopConfirmed)

    assert app.heard(m.Armed) == app.heard(m.ArmRefused) == app.heard(m.Notice) == []


def test_a_robot_link_cut_while_moving_is_reopened_and_hold_comes_first(start, hold_after):
    started, application = start
    emulator, guardian = started()
    app = application(guardian)
    app.move(emulator)
    cut_s = monotonic()
    emulator.fault(Fault(FaultKind.DROP))
    app.wait_for(m.StopConfirmed, lambda x: x.reason is StopReason.LINK_LOST)

    hold_after(emulator, cut_s, "robot link cut to HOLD on the next")
    later = [e for e in emulator.log.requests() if e.t_s > cut_s]
    assert (later[0].name, later[0].text) == ("HOLD", "1")
    assert not emulator.is_running()


@pytest.mark.parametrize(
    "kind", [FaultKind.SLOW, FaultKind.NG, FaultKind.SILENT, FaultKind.GARBAGE]
)
def test_a_faulty_controller_ends_in_a_named_stop(start, kind):
    started, application = start
    emulator, guardian = started()
    app = application(guardian)
    app.move(emulator)
    emulator.fault(Fault(kind, delay_s=0.32))
    app.wait_for(m.StopAsked, lambda x: x.reason is StopReason.LINK_LOST)
    if kind is not FaultKind.SLOW:
        emulator.fault(Fault())
    app.wait_for(m.StopConfirmed)

    assert not emulator.is_running()


def test_answers_in_pieces_are_read_all_the_same(start):
    started, application = start
    emulator, guardian = started()
    emulator.fault(Fault(FaultKind.PIECES, gap_s=0.002))
    app = application(guardian)
    app.move(emulator)
    app.posture = "stop"
    app.wait_for(m.StopConfirmed, lambda x: x.reason is StopReason.LEFT_ARM)

    assert not emulator.is_running()
