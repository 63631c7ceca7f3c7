"""The guardian and who speaks to it: goodbyes, strangers, rubbish, its start, its log, its end."""

import contextlib
import socket
import subprocess

import pytest

from gestureapp.children import child_command, child_environment
from gestureapp.clock import monotonic
from gestureapp.robot import messages as m
from gestureapp.robot.acts import Did, find_unseen, read_act
from gestureapp.robot.guardian import Guardian
from gestureapp.robot.guardian_log import MOST_BYTES
from gestureapp.robot.values import StopReason
from gestureapp.simulation.nx100_options import Fault, FaultKind

pytestmark = pytest.mark.process

LIMIT_S = 10.0


def test_goodbye_while_disarmed_ends_without_a_hold(start):
    started, application = start
    emulator, guardian = started()
    app = application(guardian)
    app.wait_for(m.StatusReport)
    app.say(m.Bye())
    app.control.shutdown(socket.SHUT_WR)

    assert guardian.ended() == 0
    assert emulator.log.requests("HOLD") == []


def test_goodbye_while_moving_is_no_excuse(start, hold_after):
    started, application = start
    emulator, guardian = started()
    app = application(guardian)
    app.move(emulator)
    gone_s = monotonic()
    app.say(m.Bye())
    app.window.shutdown(socket.SHUT_WR)

    hold_after(emulator, gone_s, "application gone to HOLD")
    assert guardian.ended() == 0
    assert not emulator.is_running()


def test_a_connection_without_the_token_is_closed_and_changes_nothing(start):
    started, application = start
    emulator, guardian = started()
    app = application(guardian)
    stop = m.encode(m.Stop(StopReason.LINK_LOST, "", 0.0))
    for line in (
        m.encode(m.Hello("wrong", m.Role.CONTROL)),
        m.encode(m.Hello("wrong", m.Role.WINDOW)) + stop,
        m.encode(m.Arm()),
        b"rubbish\n",
        b"\xff\x00\n",
    ):
        with guardian.connect() as stranger:
            stranger.sendall(line)
            with contextlib.suppress(ConnectionResetError):
                assert stranger.recv(100) == b""
    app.arm()

    assert emulator.log.requests("HOLD") == []


def test_the_right_token_on_a_second_line_comes_too_late(start):
    started, application = start
    emulator, guardian = started()
    app = application(guardian)
    hello = m.encode(m.Hello(guardian.token, m.Role.CONTROL))
    stop = m.encode(m.Stop(StopReason.STOP_PRESSED, "", 0.0))
    with guardian.connect() as stranger:
        stranger.sendall(b"rubbish\n" + hello + stop)
        with contextlib.suppress(ConnectionResetError):
            assert stranger.recv(100) == b""
    app.arm()

    assert emulator.log.requests("HOLD") == []


def test_rubbish_from_the_application_is_overheard(start):
    started, application = start
    _, guardian = started()
    app = application(guardian)
    huge = b'{"is": "CommandAccepted", "activation_id": 1, "t_s": ' + b"9" * 400 + b"}\n"
    app.control.sendall(b"\n{}\nnull\n\xff\xfe\n" + b"[" * 5000 + b"\n" + huge)
    app.arm()

    assert app.heard(m.StopAsked) == []


def test_a_line_that_never_ends_counts_as_an_application_gone(start, hold_after):
    started, application = start
    emulator, guardian = started()
    app = application(guardian)
    app.move(emulator)
    begun_s = monotonic()
    with contextlib.suppress(OSError):
        app.window.sendall(b"x" * (3 << 20))

    hold_after(emulator, begun_s, "application gone to HOLD")
    assert guardian.ended() == 0


@pytest.mark.parametrize(("host", "port"), [("", 1), ("a..b", 80), ("127.0.0.1", 70000)])
def test_an_address_that_is_none_is_told_and_ends_nothing(start, host, port):
    started, application = start
    _, guardian = started(host=host, port=port)
    app = application(guardian)
    if host:
        assert not app.wait_for(m.LinkReport, lambda x: host in x.text).is_open
    app.say(m.Arm())

    assert app.wait_for(m.ArmRefused).refusal.reason == "no_link"
    app.say(m.Bye())
    app.control.shutdown(socket.SHUT_WR)
    assert guardian.ended() == 0


def test_what_it_did_stands_in_its_log(start, tmp_path):
    started, application = start
    log = tmp_path / "guardian.log"
    emulator, guardian = started(log=log)
    app = application(guardian)
    app.move(emulator)
    app.window.shutdown(socket.SHUT_RDWR)
    assert guardian.ended() == 0

    text = log.read_text()
    acts = [act for line in text.splitlines() if (act := read_act(line)) is not None]
    assert [act.did for act in acts] == [
        *(Did.STARTED, Did.MOVES, Did.GONE, Did.STOPPING, Did.STANDS, Did.ENDED)
    ]
    unseen = find_unseen(text.splitlines())
    assert unseen is not None
    assert unseen.stop.text == "application gone: its window connection ended"
    assert unseen.outcome.startswith("standstill confirmed after 0.")


def test_a_log_that_has_grown_is_kept_once_and_begun_anew(start, tmp_path):
    started, application = start
    log, old = tmp_path / "guardian.log", tmp_path / "guardian.log.1"
    log.write_text("an old line\n" * (MOST_BYTES // 12))
    old.write_text("an older file")
    _, guardian = started(log=log)
    app = application(guardian)
    app.wait_for(m.StatusReport)
    app.say(m.Bye())
    app.control.shutdown(socket.SHUT_WR)
    assert guardian.ended() == 0

    assert old.read_text().startswith("an old line\n")
    assert log.stat().st_size < 5000
    assert "ended" in log.read_text()


def test_nobody_inherits_the_permission_of_an_application_that_is_gone(start):
    started, application = start
    emulator, guardian = started()
    first = application(guardian)
    first.move(emulator)
    emulator.fault(Fault(FaultKind.SILENT))
    first.close()
    second = application(guardian)  # it even knows the token
    second.say(m.Arm())
    second.wait_for(m.ArmRefused)
    emulator.fault(Fault())
    second.wait_for(m.StopConfirmed)
    stood_s = monotonic()

    assert guardian.ended() == 0
    print(f"ended {(monotonic() - stood_s) * 1000:.0f} ms after the standstill")  # noqa: T201
    assert second.heard(m.Armed) == []
    assert len(emulator.log.requests("IMOV")) == 1


def test_a_log_that_cannot_be_written_keeps_no_guardian_from_its_work(start, tmp_path):
    started, application = start
    _, guardian = started(log=tmp_path / "no" / "such" / "folder.log")
    application(guardian).arm()


@pytest.mark.parametrize("line", [b"\n", m.encode(m.Bye())])
def test_it_is_not_started_by_hand(line):
    done = subprocess.run(
        child_command("guardian"),
        input=line,
        capture_output=True,
        timeout=LIMIT_S,
        check=False,
        env=child_environment(),
    )

    assert done.returncode == 2
    assert done.stdout == b""
    assert done.stderr.splitlines() == [b"guardian: it is started by the application, not by hand"]


def test_a_guardian_nobody_greets_ends_by_itself(lonely):
    assert lonely.ended() == 0


class Failing(Guardian):
    """Fails in every turn, as a bug would."""

    def _keep_robot(self, now_s):
        raise ZeroDivisionError("a bug")


@pytest.mark.logs_errors
def test_a_guardian_that_fails_says_so_and_ends(limits, caplog):
    start = m.Start("t", "", 0, limits, "")
    with socket.create_server(("127.0.0.1", 0)) as listener:
        assert Failing(start, listener).run() == 1

    assert "the guardian failed; it stops the robot and ends" in caplog.text
    assert "application gone: the guardian failed: a bug" in caplog.text
