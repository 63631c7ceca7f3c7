"""The guardian's loop in this process, turn by turn: what comes in one round of the selector."""

import socket
import struct

from gestureapp.clock import monotonic
from gestureapp.robot import messages as m
from gestureapp.robot.guardian import Guardian
from gestureapp.robot.values import StopReason

RESET_ON_CLOSE = struct.pack("ii", 1, 0)


def until(guardian, is_so, limit_s=5.0):
    deadline_s = monotonic() + limit_s
    while not is_so():
        assert monotonic() < deadline_s
        guardian._turn()


def test_a_line_that_is_reset_in_the_round_of_a_stop_is_lost_and_nothing_more(limits):
    with (
        socket.create_server(("127.0.0.1", 0)) as controller,
        socket.create_server(("127.0.0.1", 0)) as listener,
    ):
        port = controller.getsockname()[1]
        guardian = Guardian(m.Start("t", "127.0.0.1", port, limits, ""), listener)
        with socket.create_connection(listener.getsockname()) as application:
            now_s = monotonic()
            application.sendall(m.encode(m.Hello("t", m.Role.CONTROL)))
            application.sendall(m.encode(m.Beat(now_s, False, True, now_s, now_s)))
            until(guardian, lambda: guardian._robot is not None)
            robot, _ = controller.accept()
            robot.sendall(b"OK: NX Information Server(1.07) Keep-Alive:-1.\r\n")
            until(guardian, lambda: guardian._supervisor.is_link_open)
            robot.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, RESET_ON_CLOSE)
            robot.close()
            stop = m.Stop(StopReason.STOP_PRESSED, "STOP was pressed", monotonic())
            application.sendall(m.encode(stop))
            until(guardian, lambda: guardian._supervisor.is_stopping)
            until(guardian, lambda: not guardian._supervisor.is_link_open)
        guardian.close()
