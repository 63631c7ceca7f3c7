"""The exchange: scripted conversations in manual time, end of stream anywhere, any rubbish."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gestureapp.robot import nx100
from gestureapp.robot.exchange import (
    ANSWER_LIMIT_S,
    OPENING_LIMIT_S,
    Answered,
    Exchange,
    LinkBroken,
    Opened,
    Phase,
)
from gestureapp.robot.gate import Permit
from gestureapp.robot.nx100 import Done, Failure
from gestureapp.robot.values import Pose, PoseIncrement, Position, Posture, RobotStatus

BANNER = b"OK: NX Information Server( 1.07) Keep-Alive:-1.\r\n"
MOVE = nx100.move_increment(PoseIncrement(dz_mm=5.0), 20.0, frame=1, tool=0)
POSE = b"612.340,-55.020,101.700,179.98,-0.11,92.40,0,0\r"


def opened(now_s=0.0):
    exchange = Exchange()
    exchange.connected(now_s)
    exchange.receive(BANNER, now_s)
    return exchange


def asked(request, now_s=0.0, **how):
    exchange = opened(now_s)
    exchange.send(Permit(request), now_s, **how)
    return exchange


def test_a_session_opens_with_the_banner():
    exchange = Exchange()
    assert not exchange.is_open

    assert exchange.connected(1.0) == b"CONNECT Robot_access Keep-Alive:-1\r\n"
    assert exchange.phase is Phase.OPENING
    assert not exchange.can_send
    assert exchange.deadline_s == 1.0 + OPENING_LIMIT_S
    assert exchange.receive(BANNER, 1.1) == ([Opened(BANNER.decode().strip())], b"")
    assert exchange.can_send
    assert exchange.is_open
    assert exchange.deadline_s == float("inf")


def test_a_command_with_data_goes_header_ok_data_answer():
    exchange = opened()

    assert exchange.send(Permit(nx100.HOLD_ON), 1.0) == b"HOSTCTRL_REQUEST HOLD 2\r\n"
    assert exchange.receive(b"OK: HOLD\r\n", 1.02) == ([], b"1\r")
    assert exchange.phase is Phase.DATA_SENT
    assert exchange.receive(b"0000\r\n", 1.25) == ([Answered(nx100.HOLD_ON, Done(), 0.25)], b"")
    assert exchange.can_send


def test_a_command_without_data_sends_nothing_after_ok():
    exchange = asked(nx100.READ_STATUS)

    events, out = exchange.receive(b"OK: RSTATS\r\n194,64\r", 0.25)

    assert events == [Answered(nx100.READ_STATUS, RobotStatus(194, 64), 0.25)]
    assert out == b""


HERE = Position(Pose(612.34, -55.02, 101.7, 179.98, -0.11, 92.4), Posture(0), 0)
SCRIPT = (  # the controller's words, one request after another, with the request that is awaiting
    (nx100.HOLD_ON, (b"OK: HOLD\r\n", b"0000\r\n"), Done()),
    (nx100.READ_STATUS, (b"OK: RSTATS\r\n", b"202,64\r"), RobotStatus(202, 64)),
    (nx100.read_pose(), (b"OK: RPOSC\r\n", POSE), HERE),
    (MOVE, (b"OK: IMOV\r\n", b"0000\r\n"), Done()),
)


def late_lf(parts):
    """Every LF in a segment of its own, after what stood before it was taken."""
    for part in parts:
        if part.endswith(b"\n"):
            yield part[:-1]
            yield b"\n"
        else:
            yield part


@pytest.mark.parametrize("cut", ["separate", "bytewise", "late-lf"])
def test_every_way_of_cutting_gives_the_same_conversation(cut):
    exchange, answers, sent = opened(), [], []
    for request, said, _ in SCRIPT:
        sent.append(exchange.send(Permit(request), 0.0))
        for part in said:
            pieces = {
                "separate": [part],
                "bytewise": [part[i : i + 1] for i in range(len(part))],
                "late-lf": list(late_lf([part])),
            }[cut]
            for piece in pieces:
                events, out = exchange.receive(piece, 0.0)
                answers += events
                sent += [out] if out else []

    assert answers == [Answered(request, answer, 0.0) for request, _, answer in SCRIPT]
    wanted = [part for r, _, _ in SCRIPT for part in (r.header, r.payload) if part]
    assert sent == wanted


def test_the_lf_of_an_answer_may_come_after_the_next_request_was_sent():
    exchange = asked(nx100.HOLD_ON)
    exchange.receive(b"OK: HOLD\r\n", 0.0)
    exchange.receive(b"0000\r", 0.0)
    exchange.send(Permit(nx100.READ_STATUS), 0.1)

    assert exchange.receive(b"\n", 0.2) == ([], b"")
    events, _ = exchange.receive(b"OK: RSTATS\r194,64\r", 0.3)

    assert [event.answer for event in events] == [RobotStatus(194, 64)]


def test_at_most_one_request_is_in_flight():
    exchange = asked(nx100.READ_STATUS)

    with pytest.raises(RuntimeError, match=r"HOLD 1 .*header sent"):
        exchange.send(Permit(nx100.HOLD_ON), 0.0)
    exchange.receive(b"OK: RSTATS\r\n", 0.0)
    with pytest.raises(RuntimeError, match="data sent"):
        exchange.send(Permit(nx100.HOLD_ON), 0.0)


def test_nothing_is_sent_before_the_session_is_open():
    exchange = Exchange()
    with pytest.raises(RuntimeError, match="closed"):
        exchange.send(Permit(nx100.HOLD_ON), 0.0)
    exchange.connected(0.0)
    with pytest.raises(RuntimeError, match="opening"):
        exchange.send(Permit(nx100.HOLD_ON), 0.0)


def phases():
    """Every phase an open socket can be in, with the request that is in flight."""
    opening = Exchange()
    opening.connected(0.0)
    data_sent = asked(nx100.HOLD_ON)
    data_sent.receive(b"OK: HOLD\r\n", 0.0)
    return {
        "opening": (opening, None),
        "idle": (opened(), None),
        "header": (asked(nx100.HOLD_ON), nx100.HOLD_ON),
        "data": (data_sent, nx100.HOLD_ON),
    }


@pytest.mark.parametrize("phase", ["opening", "idle", "header", "data"])
def test_the_end_of_the_stream_is_told_once_with_what_was_in_flight(phase):
    exchange, request = phases()[phase]

    assert exchange.end("cable") == [LinkBroken(request, "cable")]
    assert exchange.end("cable") == []
    assert exchange.phase is Phase.CLOSED
    assert exchange.request is None
    assert exchange.deadline_s == float("inf")
    assert exchange.check(1e9) == []


@pytest.mark.parametrize("phase", ["opening", "idle", "header", "data"])
@pytest.mark.parametrize("line", [b"hello\r\n", b"\r\n", b"\xff\xfe\r", b"OK: RSTATS\r\n"])
def test_a_line_that_was_not_awaited_breaks_the_link(phase, line):
    exchange, request = phases()[phase]

    events, out = exchange.receive(line + b"0000\r\n", 0.0)

    assert [event.request for event in events] == [request]
    assert isinstance(events[0], LinkBroken)
    assert out == b""
    assert not exchange.is_open


@pytest.mark.parametrize("phase", ["opening", "header", "data"])
def test_an_awaited_line_is_overdue_exactly_at_its_limit(phase):
    exchange, request = phases()[phase]
    limit_s = OPENING_LIMIT_S if phase == "opening" else ANSWER_LIMIT_S["HOLD"]

    assert exchange.check(limit_s - 0.001) == []
    (broken,) = exchange.check(limit_s)

    assert broken.request == request
    assert f"no answer to {'CONNECT' if request is None else 'HOLD 1'} within" in broken.reason
    assert exchange.phase is Phase.CLOSED


def test_an_idle_line_is_never_overdue():
    assert opened().check(1e9) == []


@pytest.mark.parametrize(("name", "limit_s"), [*ANSWER_LIMIT_S.items(), ("RJSEQ", 0.3)])
def test_every_command_has_its_limit_and_the_data_its_own(name, limit_s):
    exchange = opened()
    exchange.send(Permit(nx100.Request(name, "1")), 10.0)
    assert exchange.deadline_s == 10.0 + limit_s

    exchange.receive(f"OK: {name}\r\n".encode(), 10.0 + limit_s / 2)

    assert exchange.deadline_s == pytest.approx(10.0 + limit_s * 1.5)


def test_while_stopping_a_read_may_take_as_long_as_a_hold():
    exchange = asked(nx100.READ_STATUS, is_stopping=True)
    assert exchange.deadline_s == ANSWER_LIMIT_S["HOLD"]

    longest = asked(nx100.SERVO_OFF, is_stopping=True)
    assert longest.deadline_s == ANSWER_LIMIT_S["SVON"]


@pytest.mark.parametrize("data_sent", [False, True])
def test_an_error_is_an_answer_and_the_session_goes_on(data_sent):
    exchange = asked(MOVE)
    if data_sent:
        exchange.receive(b"OK: IMOV\r\n", 0.0)

    events, _ = exchange.receive(b"ERROR: IMOV is not successful(2010).\r\n", 0.5)

    assert events == [Answered(MOVE, Failure(2010, "ERROR: IMOV is not successful(2010)."), 0.5)]
    assert exchange.can_send


@pytest.mark.parametrize("data_sent", [False, True])
def test_ng_ends_the_session(data_sent):
    exchange = asked(MOVE)
    if data_sent:
        exchange.receive(b"OK: IMOV\r\n", 0.0)

    ((broken,), out) = exchange.receive(b"NG: no\r\n", 0.5)

    assert broken == LinkBroken(MOVE, "the controller refused IMOV: 'NG: no'")
    assert out == b""
    assert not exchange.is_open


def test_a_bare_code_is_no_answer_to_a_header_but_one_to_the_data():
    exchange = asked(MOVE)
    ((broken,), _) = exchange.receive(b"2060\r\n", 0.0)
    assert isinstance(broken, LinkBroken)

    exchange = asked(MOVE)
    exchange.receive(b"OK: IMOV\r\n", 0.0)
    ((answered,), _) = exchange.receive(b"2060\r\n", 0.0)
    assert answered.answer == Failure(2060, "2060")


def test_the_ok_of_another_command_breaks_the_link():
    exchange = asked(nx100.HOLD_ON)

    ((broken,), out) = exchange.receive(b"OK: IMOV\r\n", 0.0)

    assert "instead of OK" in broken.reason
    assert out == b""


def test_an_unreadable_answer_says_what_was_expected():
    exchange = asked(nx100.READ_STATUS)

    ((broken,), _) = exchange.receive(b"OK: RSTATS\r\n" + b"9" * 80 + b"\r", 0.0)

    assert broken.reason.endswith("…', expected two bytes")


@pytest.mark.parametrize("end", [b"", b"\r\n"])
def test_an_overlong_line_breaks_the_link_with_and_without_its_end(end):
    exchange = Exchange()
    exchange.connected(0.0)

    ((broken,), out) = exchange.receive(BANNER[:-2] + b"x" * nx100.MAX_LINE + end, 0.0)

    assert isinstance(broken, LinkBroken)
    assert out == b""
    assert not exchange.is_open


def test_no_data_goes_out_when_an_overlong_line_follows_the_ok():
    exchange = asked(MOVE)

    events, out = exchange.receive(b"OK: IMOV\r\n" + b"x" * 600, 0.0)

    assert [type(event) for event in events] == [LinkBroken]
    assert out == b""


@pytest.mark.parametrize("line", [b"0000\r\n", b"ERROR: IMOV is not successful(2010).\r\n"])
def test_an_answer_before_the_data_was_sent_breaks_the_link_and_the_data_stays(line):
    exchange = asked(MOVE)

    ((broken,), out) = exchange.receive(b"OK: IMOV\r\n" + line, 0.0)

    assert "before it had the data" in broken.reason
    assert out == b""


def test_a_closed_exchange_hears_nothing():
    exchange = Exchange()

    assert exchange.receive(b"OK: x\r\n" * 200, 0.0) == ([], b"")


def test_what_was_left_of_the_old_session_is_not_in_the_new_one():
    exchange = Exchange()
    exchange.connected(0.0)
    exchange.receive(b"OK: NX Inf", 0.0)
    exchange.end("cable")
    exchange.connected(1.0)

    assert exchange.receive(BANNER, 1.0)[0] == [Opened(BANNER.decode().strip())]


@pytest.mark.parametrize("request_", [MOVE, nx100.HOLD_OFF, nx100.SERVO_ON])
def test_what_is_no_stop_can_be_taken_back_until_its_data_has_gone_out(request_):
    exchange = asked(request_)

    broken = exchange.withdraw()

    assert broken.request == request_
    assert exchange.receive(f"OK: {request_.name}\r\n".encode(), 0.0) == ([], b"")

    exchange = asked(request_)
    exchange.receive(f"OK: {request_.name}\r\n".encode(), 0.0)
    assert exchange.withdraw() is None


@pytest.mark.parametrize(
    "request_", [nx100.HOLD_ON, nx100.SERVO_OFF, nx100.READ_STATUS, nx100.read_pose()]
)
def test_stops_and_reads_are_not_taken_back(request_):
    exchange = asked(request_)

    assert exchange.withdraw() is None
    assert exchange.is_open


def test_nothing_is_taken_back_from_an_idle_line():
    assert opened().withdraw() is None


WIRE = st.sampled_from(
    [BANNER, b"OK: HOLD\r\n", b"OK: IMOV\r\n", b"0000\r\n", b"\n", b"NG: x\r\n", b"ERROR(2060)\r\n"]
) | st.binary(max_size=30)
STEPS = st.lists(
    WIRE
    | st.floats(0, 2)
    | st.sampled_from([nx100.HOLD_ON, MOVE, nx100.READ_STATUS, "end", "connected", "withdraw"]),
    max_size=40,
)


def carry_out(exchange, step, now_s):
    """One step; the events and the bytes that came of it."""
    if isinstance(step, bytes):
        return exchange.receive(step, now_s)
    if isinstance(step, float):
        return exchange.check(now_s), b""
    if step == "end":
        return exchange.end("x"), b""
    if step == "withdraw":
        broken = exchange.withdraw()
        return [] if broken is None else [broken], b""
    if step == "connected":
        return [], exchange.connected(now_s)
    return [], exchange.send(Permit(step), now_s) if exchange.can_send else b""


@given(STEPS)
def test_any_bytes_at_any_time_never_raise_and_a_broken_link_sends_nothing(steps):
    exchange, now_s, is_down = Exchange(), 0.0, True
    for step in steps:
        now_s += step if isinstance(step, float) else 0.0
        before = exchange.request
        events, out = carry_out(exchange, step, now_s)

        is_down = is_down and step != "connected"
        assert not (is_down and (events or out))
        if isinstance(step, bytes):
            assert out in (b"", b"" if before is None else before.payload)
        for event in events:
            assert isinstance(event, Opened) or event.request == before
            before = None
        if any(isinstance(event, LinkBroken) for event in events):
            assert isinstance(events[-1], LinkBroken)
            assert out == b""
            is_down = True
        assert not (is_down and (exchange.can_send or exchange.is_open or exchange.request))
