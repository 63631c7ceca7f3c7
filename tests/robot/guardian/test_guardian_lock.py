"""One application for each robot: two real guardians at one emulated controller."""

import os
import signal
import sys

import pytest

from gestureapp.robot import messages as m
from gestureapp.simulation.nx100_log import What

pytestmark = [
    pytest.mark.process,
    pytest.mark.skipif(sys.platform != "linux", reason="no lock that tells its holder"),
]


def blocked(report):
    return report.remedy == "close that one"


def test_a_second_application_is_told_who_is_first_and_follows_it(start):
    started, application = start
    emulator, guardian = started()
    first = application(guardian)
    first.wait_for(m.LinkReport, lambda x: x.is_open)
    _, other = started(port=emulator.port)
    second = application(other)
    report = second.wait_for(m.LinkReport, blocked)
    assert report == m.LinkReport(
        False,
        f"the robot at 127.0.0.1:{emulator.port} is in use by another gestureapp "
        f"(process {os.getpid()})",
        "close that one",
    )
    assert len(emulator.log.events(What.OPEN)) == 1

    first.say(m.Bye())
    first.control.close()
    assert guardian.ended() == 0
    second.arm()
    assert len(second.heard(m.LinkReport)) == 3, "not connected, in use, open: each told once"


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGTERM])
def test_a_guardian_that_is_ended_leaves_the_robot_to_the_next(start, how):
    started, application = start
    emulator, guardian = started()
    application(guardian).wait_for(m.LinkReport, lambda x: x.is_open)
    _, other = started(port=emulator.port)
    second = application(other)
    second.wait_for(m.LinkReport, blocked)
    guardian.child.send_signal(how)
    second.arm()


def test_a_guardian_that_still_stops_a_robot_keeps_it(start):
    started, application = start
    emulator, guardian = started()
    first = application(guardian)
    first.move(emulator)
    _, other = started(port=emulator.port)
    second = application(other)
    second.wait_for(m.LinkReport, blocked)
    n_before = len(emulator.log.events(What.OPEN))
    first.close()
    second.wait_for(m.LinkReport, lambda x: x.is_open)

    assert guardian.ended() == 0
    (end,) = emulator.log.events(What.MOTION_END)
    later = emulator.log.events(What.OPEN)[n_before:]
    assert all(connect.t_s > end.t_s for connect in later)
    assert not emulator.is_running()


def test_a_stop_in_an_application_without_the_robot_reaches_it_as_soon_as_it_is_free(start):
    started, application = start
    emulator, guardian = started()
    application(guardian).wait_for(m.LinkReport, lambda x: x.is_open)
    _, other = started(port=emulator.port)
    second = application(other)
    second.wait_for(m.LinkReport, blocked)
    connection = emulator.log.events(What.OPEN)[-1].connection
    second.window.sendall(m.encode(m.Stop(m.StopReason.STOP_PRESSED, "STOP was pressed", 0.0)))
    second.wait_for(m.StopUnconfirmed)
    guardian.child.kill()
    second.wait_for(m.StopConfirmed)

    new = [r.name for r in emulator.log.requests() if r.connection > connection]
    assert new[0] == "HOLD"


def test_an_application_that_never_got_the_robot_ends_at_once(start):
    started, application = start
    emulator, guardian = started()
    application(guardian).wait_for(m.LinkReport, lambda x: x.is_open)
    _, other = started(port=emulator.port)
    second = application(other)
    second.wait_for(m.LinkReport, blocked)
    second.close()

    assert other.ended() == 0
    assert emulator.log.requests("HOLD") == []
