"""What the emulated NX100 reads and says, byte for byte, with the time in the hand."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gestureapp.robot.values import Pose, Posture
from gestureapp.simulation.controller import Controller
from gestureapp.simulation.nx100_commands import NAMES, NEEDS_REMOTE, execute
from gestureapp.simulation.nx100_conversation import Conversation
from gestureapp.simulation.nx100_lines import Bad, Refused, Request, RequestReader
from gestureapp.simulation.nx100_options import Fault, FaultKind, Nx100Options, Segments
from gestureapp.simulation.nx100_values import ControllerOptions

KEEP = b"CONNECT Robot_access Keep-Alive:-1\r\n"
BANNER = b"OK: NX Information Server( 1.07) Keep-Alive:-1.\r\n"
UP_5 = "0,20.0,1,0.000,0.000,5.000,0.00,0.00,0.00,0,0,0,0,0,0,0,0"


def header(name, data=""):
    return f"HOSTCTRL_REQUEST {name} {len(data) + 1 if data else 0}\r\n".encode()


class Talk:
    """A conversation, its controller and its time."""

    def __init__(self, cell=None, fault=None, **options):
        self.controller = Controller(cell or ControllerOptions(), 0.0)
        self.fault = fault or Fault()
        self.now_s = 0.0
        options = Nx100Options(**options)
        self.talk = Conversation(
            options, lambda request, now_s: execute(request, self.controller, now_s), 0.0
        )

    def says(self, data):
        """Send bytes now; all segments of the answer with their times."""
        self.talk.receive(data, self.now_s, self.fault)
        return self.rest()

    def rest(self):
        said = []
        while not self.talk.is_drained:
            self.now_s = max(self.now_s, self.talk.next_s)
            said += [(self.now_s, data) for data in self.talk.take(self.now_s, self.fault)]
        self.talk.take(self.now_s, self.fault)
        return said

    def bytes(self, data):
        return b"".join(part for _, part in self.says(data))

    def asks(self, name, data=""):
        """Ask as a client does that waits for OK; the answer behind it."""
        ok = f"OK: {name}\r\n".encode()
        if not data:
            answer = self.bytes(header(name))
            assert answer.startswith(ok)
            return answer.removeprefix(ok)
        assert self.bytes(header(name, data)) == ok
        self.now_s += 0.001
        return self.bytes(data.encode() + b"\r")


def connected(**options):
    talk = Talk(**options)
    assert talk.bytes(KEEP).replace(b"\r", b"").endswith(b"\n")
    talk.now_s += 0.1
    return talk


@pytest.mark.parametrize(
    ("line", "banner"),
    [
        (b"CONNECT Robot_access\r\n", b"OK: NX Information Server( 1.07).\r\n"),
        (b"CONNECT Robot_access \r\n", b"OK: NX Information Server( 1.07).\r\n"),
        (KEEP, BANNER),
        (b"CONNECT Robot_access Keep-Alive:50000\r", BANNER.replace(b"-1", b"50000")),
        (b"CONNECT Robot_access KeepAlive:-1\r\n", BANNER),
    ],
)
def test_start_line_is_answered_by_the_banner(line, banner):
    talk = Talk()
    assert talk.bytes(line) == banner
    assert not talk.talk.is_closing


@pytest.mark.parametrize(
    "line",
    [
        b"GET / HTTP/1.1\r\n",
        b"CONNECT\r\n",
        b"CONNECT Robot_access Keep-Alive:0\r\n",
        b"CONNECT Robot_access Keep-Alive:-2\r\n",
        b"CONNECT Robot_access Keep-Alive:many\r\n",
        b"HOSTCTRL_REQUEST RSTATS 0\r\n",
    ],
)
def test_bad_start_line_is_answered_ng_and_closed(line):
    talk = Talk()
    assert talk.bytes(line) == b"NG: 400 Bad Connect\r\n"
    assert talk.talk.is_refused


@pytest.mark.parametrize(
    ("line", "text"),
    [
        (b"HOSTCTRL_REQUEST START 6\r\n", b"NG: 501 Not Implemented\r\n"),
        (b"HOSTCTRL_REQUEST rstats 0\r\n", b"NG: 501 Not Implemented\r\n"),
        (b"HOSTCTRL_REQUEST RSTATS\r\n", b"NG: 400 Bad Request\r\n"),
        (b"HOSTCTRL_REQUEST RSTATS -1\r\n", b"NG: 400 Bad Request\r\n"),
        (b"HOSTCTRL_REQUEST RSTATS x\r\n", b"NG: 400 Bad Request\r\n"),
        (b"HOSTCTRL_REQUEST  RSTATS 0\r\n", b"NG: 400 Bad Request\r\n"),
        (KEEP, b"NG: 400 Bad Request\r\n"),
        (b"x" * 5000, b"NG: 414 Line Too Long\r\n"),
    ],
)
def test_bad_header_is_answered_ng_and_closed(line, text):
    talk = connected()
    assert talk.bytes(line) == text
    assert talk.talk.is_refused
    assert talk.says(header("RSTATS")) == []


def test_data_answers_end_in_cr_only_and_all_others_in_crlf():
    talk = connected()
    assert talk.asks("RSTATS") == b"194,64\r"
    assert talk.asks("RALARM") == b"0,0,0,0,0,0,0,0,0,0\r"
    assert talk.asks("SVON", "1") == b"0000\r\n"
    assert talk.asks("HOLD", "1") == b"0000\r\n"
    assert talk.asks("IMOV", UP_5) == b"ERROR: IMOV is not successful(2050).\r\n"


def test_position_has_three_and_two_decimals_and_the_documented_fields():
    talk = connected(cell=ControllerOptions(start_pose=Pose(612.34, -55.02, 101.7, 180, 0, 92.4)))
    wanted = "612.340,-55.020,101.700,180.00,0.00,92.40,1,0"
    assert talk.asks("RPOSC", "1,0") == wanted.encode() + b"\r"
    assert talk.asks("RPOSC", "0, 1") == wanted.encode() + b",0,0,0,0,0,0\r"
    assert len(talk.asks("RPOSJ").split(b",")) == 12


def test_position_tells_posture_and_tool_as_the_arm_has_them():
    flipped = ControllerOptions(start_posture=Posture(0), tool=7)
    assert connected(cell=flipped).asks("RPOSC", "1,0").endswith(b",180.00,0.00,0.00,0,7\r")

    talk = connected()
    turn = "1,30.0,1,0.000,0.000,0.000,0.00,0.00,{}.00,0,0,0,0,0,0,0,0"
    for angle in (-150, -150):
        assert talk.asks("IMOV", turn.format(angle)) == b"0000\r\n"
        talk.now_s += 10.0
    # T follows a tool that hangs down the other way: it stands at 300 degrees now, not at -60.
    assert talk.asks("RPOSC", "1,0").endswith(b",180.00,0.00,60.00,17,0\r")
    assert talk.asks("RPOSJ").split(b",")[5] == b"186600"


def test_worked_example_of_a_move():
    talk = connected()
    assert talk.asks("IMOV", UP_5) == b"0000\r\n"
    talk.now_s += 0.1
    assert talk.asks("RSTATS") == b"202,64\r"
    assert talk.asks("IMOV", UP_5) == b"ERROR: IMOV is not successful(2010).\r\n"
    talk.now_s += 5.0
    assert talk.asks("RSTATS") == b"194,64\r"
    assert talk.asks("RPOSC", "1,0").startswith(b"800.000,0.000,305.000,180.00,")


MOVE = UP_5.split(",")


def changed(i, word):
    return ",".join([*MOVE[:i], word, *MOVE[i + 1 :]])


@pytest.mark.parametrize(
    ("name", "data", "code"),
    [
        ("IMOV", ",".join(MOVE[:16]), 1011),
        ("IMOV", UP_5 + ",0", 1011),
        ("IMOV", "", 1011),
        ("IMOV", changed(1, "fast"), 1012),
        ("IMOV", changed(3, "nan"), 1012),
        ("IMOV", changed(3, "1e-05"), 1012),
        ("IMOV", changed(2, "1.5"), 1012),
        ("IMOV", changed(3, ""), 1013),
        ("IMOV", changed(3, "0" * 40), 1013),
        ("IMOV", changed(0, "2"), 5200),
        ("IMOV", changed(1, "0.0"), 5200),
        ("IMOV", changed(1, "1500.1"), 5200),
        ("IMOV", changed(2, "26"), 5200),
        ("IMOV", changed(10, "24"), 5200),
        ("IMOV", changed(3, "10000.1"), 5200),
        ("IMOV", changed(2, "2"), 3350),
        ("RPOSC", "2,0", 3350),
        ("RPOSC", "26,0", 1012),
        ("RPOSC", "1,2", 1012),
        ("RPOSC", "1", 1011),
        ("HOLD", "2", 1012),
        ("SVON", "on", 1012),
        ("SVON", "1,1", 1011),
        ("IOWRITE", "30010,8,1", 2110),
        ("IOWRITE", "23290,8,1", 2110),
        ("IOWRITE", "22011,8,1", 1012),
        ("IOWRITE", "22010,8,256", 1012),
        ("IOWRITE", "22010,16,1", 1011),
        ("IOWRITE", "22010,0,1", 1012),
        ("IOWRITE", "22010,8", 1011),
        ("IOREAD", "22010,0", 1012),
        ("IOREAD", "22010,1032", 1012),
        ("IOREAD", "90010,8", 2110),
        ("MODE", "3", 1012),
        ("MODE", "1", 2080),
        ("CYCLE", "0", 1012),
        ("MDSP", "x" * 31, 1013),
        ("LOADV", "0,1", 1011),
        ("LOADV", "0,1,256", 5200),
        ("LOADV", "1,1,-32769", 5200),
        ("LOADV", "2,100,0", 1012),
        ("LOADV", "7,0," + "x" * 17, 1013),
        ("LOADV", "3,0,nan", 5200),
        ("LOADV", "4,0,1,0,0,0,0,0,0,0,0,0", 2120),
        ("LOADV", "9,0,1", 1012),
        ("SAVEV", "0", 1011),
        ("RSTATS", "1", 1011),
        ("RESET", "1", 1011),
    ],
)
def test_wrong_operands_are_refused_with_the_documented_code(name, data, code):
    talk = connected()
    before = talk.controller.pose(0.0)
    answer = talk.asks(name, data)
    assert answer == f"ERROR: {name} is not successful({code}).\r\n".encode()
    assert talk.asks("RSTATS") == b"194,64\r"
    assert talk.controller.pose(talk.now_s + 1.0) == before


def test_inputs_are_read_as_they_were_written():
    talk = connected()
    assert talk.asks("IOWRITE", "22010,16,5,255") == b"0000\r\n"
    assert talk.asks("IOREAD", "22010,24") == b"5,255,0\r"


def test_other_contacts_are_read_as_off():
    """A read of three bytes from 50010 was recorded on an NX100."""
    assert connected().asks("IOREAD", "50010,24") == b"0,0,0\r"


@pytest.mark.parametrize(
    ("operands", "word"),
    [
        ("0,1,255", "255"),
        ("1,0,-5", "-5"),
        ("2,1,1234", "1234"),
        ("3,9,1.5", "1.500"),
        ("7,99,two, three", "two,three"),
    ],
)
def test_variables_are_read_as_they_were_written(operands, word):
    talk = connected()
    name = ",".join(operands.split(",")[:2])
    assert talk.asks("SAVEV", name) in (b"0\r", b"0.000\r", b"\r")
    assert talk.asks("LOADV", operands) == b"0000\r\n"
    assert talk.asks("SAVEV", name) == word.encode() + b"\r"


def test_mode_is_switched_over_the_network_where_the_controller_allows_it():
    talk = connected(cell=ControllerOptions(allows_mode_switch=True))
    assert talk.asks("MODE", "1") == b"0000\r\n"
    assert talk.asks("RSTATS") == b"162,64\r"
    assert talk.asks("IMOV", UP_5) == b"ERROR: IMOV is not successful(2080).\r\n"
    assert talk.asks("MODE", "2") == b"0000\r\n"
    assert talk.asks("RSTATS") == b"194,64\r"


def test_cycle_shows_in_the_status_and_a_message_is_taken():
    talk = connected()
    for cycle, status in (("1", b"193,64\r"), ("3", b"196,64\r"), ("2", b"194,64\r")):
        assert talk.asks("CYCLE", cycle) == b"0000\r\n"
        assert talk.asks("RSTATS") == status
    assert talk.asks("MDSP", "x" * 30) == b"0000\r\n"


def test_alarm_is_read_reset_and_its_error_cancelled():
    talk = connected()
    talk.controller.raise_error(2060, 3, talk.now_s)
    talk.controller.raise_alarm(4100, 7, talk.now_s)
    assert talk.asks("RALARM") == b"2060,3,4100,7,0,0,0,0,0,0\r"
    assert talk.asks("RSTATS") == b"194,48\r"
    assert talk.asks("RESET") == b"0000\r\n"
    assert talk.asks("CANCEL") == b"0000\r\n"
    assert talk.asks("RSTATS") == b"194,0\r"


@pytest.mark.parametrize("name", sorted(NEEDS_REMOTE))
def test_commands_that_change_something_need_remote(name):
    talk = connected()
    talk.controller.set_remote(False, talk.now_s)
    data = {"IMOV": UP_5, "HOLD": "1", "SVON": "1", "IOWRITE": "22010,8,1"}.get(name, "")
    assert talk.asks(name, data) == f"ERROR: {name} is not successful(2100).\r\n".encode()


def test_separate_mode_leaves_time_between_ok_and_an_answer_without_data():
    talk = connected()
    t_s = talk.now_s
    (first, second) = talk.says(header("RSTATS"))
    assert first == (t_s, b"OK: RSTATS\r\n")
    assert second == (pytest.approx(t_s + 0.02), b"194,64\r")
    talk.says(header("HOLD", "1"))
    talk.now_s = t_s = talk.now_s + 0.001
    assert talk.says(b"1\r") == [(t_s, b"0000\r\n")]


def test_separate_mode_leaves_time_also_when_the_data_came_with_the_header():
    talk = connected()
    (first, second) = talk.says(header("HOLD", "1") + b"1\r")
    assert second[0] - first[0] == pytest.approx(0.02)


def test_coalesced_mode_sends_all_in_one_segment():
    talk = connected(segments=Segments.COALESCED)
    assert [data for _, data in talk.says(header("RSTATS"))] == [b"OK: RSTATS\r\n194,64\r"]
    both = [data for _, data in talk.says(header("HOLD", "1") + b"1\r")]
    assert both == [b"OK: HOLD\r\n0000\r\n"]
    assert [data for _, data in talk.says(header("HOLD", "0"))] == [b"OK: HOLD\r\n"]
    assert [data for _, data in talk.says(b"0\r")] == [b"0000\r\n"]


def test_bytewise_mode_sends_one_byte_at_a_time():
    talk = connected(segments=Segments.BYTEWISE)
    said = talk.says(header("RSTATS"))
    assert b"".join(data for _, data in said) == b"OK: RSTATS\r\n194,64\r"
    assert {len(data) for _, data in said} == {1}
    times = [t_s for t_s, _ in said]
    assert times == sorted(set(times))


def test_late_lf_mode_sends_the_lf_with_what_follows():
    talk = connected(segments=Segments.LATE_LF)
    (ok, rest) = talk.says(header("RSTATS"))
    assert ok[1] == b"OK: RSTATS\r"
    assert rest[1] == b"\n194,64\r"
    assert rest[0] - ok[0] == pytest.approx(0.02)


def test_answer_delay_delays_the_answer_not_the_effect():
    talk = connected(answer_delay_s=0.3)
    talk.says(header("HOLD", "1"))
    t_s = talk.now_s
    talk.talk.receive(b"1\r", t_s, Fault())
    assert talk.controller.status(t_s) == (194, 72)
    ((at_s, answer),) = talk.rest()
    assert (at_s, answer) == (pytest.approx(t_s + 0.3), b"0000\r\n")


def test_late_servo_answers_late():
    talk = connected(cell=ControllerOptions(servo_on_delay_s=2.0))
    assert talk.asks("SVON", "0") == b"0000\r\n"
    talk.says(header("SVON", "1"))
    talk.now_s = t_s = talk.now_s + 0.001
    ((at_s, answer),) = talk.says(b"1\r")
    assert (at_s, answer) == (pytest.approx(t_s + 2.0), b"0000\r\n")


def test_single_command_session_closes_after_time_to_read():
    talk = Talk()
    talk.says(b"CONNECT Robot_access\r\n")
    assert talk.asks("RSTATS") == b"194,64\r"
    assert not talk.talk.is_over(talk.now_s + 0.29)
    assert talk.talk.is_over(talk.now_s + 0.31)
    assert talk.says(header("RSTATS")) == []


def test_keep_alive_counts_commands():
    talk = Talk()
    talk.says(b"CONNECT Robot_access Keep-Alive:3\r\n")
    for _ in range(3):
        assert not talk.talk.is_closing
        assert talk.asks("RSTATS") == b"194,64\r"
    assert talk.talk.is_closing


def test_silent_connection_is_closed_after_its_idle_time():
    talk = connected(idle_close_s=30.0)
    talk.asks("RSTATS")
    assert not talk.talk.is_over(talk.now_s + 29.0)
    assert talk.talk.is_over(talk.now_s + 30.0)


def test_empty_buffer_after_ok_is_nothing():
    talk = connected()
    assert talk.asks("RSTATS") == b"194,64\r"
    assert talk.bytes(b"\r\n") == b""
    assert talk.asks("RSTATS") == b"194,64\r"


@pytest.mark.parametrize(
    ("size", "data", "is_odd"),
    [
        (2, b"1\r", False),
        (1, b"1\r", False),
        (3, b"1\r\n", False),
        (2, b"1 \r", False),
        (9, b"1\r", True),
        (2, b"1            \r", True),
    ],
)
def test_sizes_of_working_clients_are_taken_and_others_flagged(size, data, is_odd):
    reader = RequestReader(NAMES)
    reader.receive(KEEP)
    (_, request) = reader.receive(f"HOSTCTRL_REQUEST SVON {size}\r".encode() + data)
    assert request == Request("SVON", "1", size, is_odd)


def test_strict_mode_refuses_odd_sizes_and_spellings():
    reader = RequestReader(NAMES, is_strict=True)
    reader.receive(KEEP)
    (_, bad) = reader.receive(b"HOSTCTRL_REQUEST SVON 1\r\n1\r")
    assert isinstance(bad, Bad)
    assert bad.refused is Refused.SIZE
    (bad,) = RequestReader(NAMES, is_strict=True).receive(
        b"CONNECT Robot_access Keep-Alive:50000\r\n"
    )
    assert isinstance(bad, Bad)


WORDS = st.sampled_from(
    [
        *(KEEP, header("RSTATS"), header("IMOV", UP_5), UP_5.encode() + b"\r", b"\r", b"\n"),
        *(header("RPOSC", "1,0"), b"1,0\r", b"HOSTCTRL_REQUEST HOLD 2\r", b"1\r\n", b"CONNECT "),
    ]
)
STREAMS = st.lists(WORDS | st.binary(max_size=40), max_size=12).map(b"".join)


@settings(max_examples=60)
@given(STREAMS, st.data())
def test_any_split_of_the_bytes_is_read_the_same(stream, data):
    stream = KEEP + stream
    whole = RequestReader(NAMES).receive(stream)
    cuts = sorted(data.draw(st.lists(st.integers(0, len(stream)), max_size=8)))
    reader, events = RequestReader(NAMES), []
    for start, end in zip([0, *cuts], [*cuts, len(stream)], strict=True):
        events += reader.receive(stream[start:end])
    assert events == whole


@settings(max_examples=60)
@given(
    STREAMS,
    st.sampled_from(Segments),
    st.sampled_from([k for k in FaultKind if k not in (FaultKind.DROP, FaultKind.REFUSE)]),
    st.booleans(),
)
def test_rubbish_never_breaks_a_conversation(stream, segments, kind, is_connected):
    talk = Talk(segments=segments, fault=Fault(kind))
    said = talk.bytes((KEEP if is_connected else b"") + stream)
    assert talk.talk.is_drained
    assert math.isfinite(talk.now_s)
    if kind is FaultKind.SILENT:
        assert said == b""
    elif kind is not FaultKind.GARBAGE:
        assert all(
            line[:2] in (b"OK", b"NG", b"ER") or line[:1].isdigit() or line[:1] == b"-"
            for line in said.replace(b"\n", b"").split(b"\r")
            if line
        )


def test_faults_that_lose_commands_do_not_move_the_robot_unless_told():
    for kind in (FaultKind.SILENT, FaultKind.NG, FaultKind.ERROR):
        for executes in (None, True):
            talk = connected()
            talk.says(header("IMOV", UP_5))
            talk.fault = Fault(kind, executes=executes)
            talk.says(UP_5.encode() + b"\r")
            assert talk.controller.is_running(talk.now_s + 0.1) is bool(executes)


def test_error_fault_answers_every_command_with_its_code():
    talk = connected()
    talk.fault = Fault(FaultKind.ERROR, code=2060)
    assert talk.asks("RSTATS") == b"ERROR: RSTATS is not successful(2060).\r\n"


def test_slow_fault_sends_everything_late_but_acts_at_once():
    talk = connected()
    talk.fault = Fault(FaultKind.SLOW, delay_s=0.5)
    t_s = talk.now_s
    assert [at_s - t_s for at_s, _ in talk.says(header("HOLD", "1"))] == pytest.approx([0.5])
    t_s = talk.now_s
    talk.talk.receive(b"1\r", t_s, talk.fault)
    assert talk.controller.status(t_s)[1] == 72
    assert [at_s - t_s for at_s, _ in talk.rest()] == pytest.approx([0.5])


def test_pieces_fault_cuts_answers():
    talk = connected()
    talk.fault = Fault(FaultKind.PIECES, piece_bytes=4, gap_s=0.05)
    said = [data for _, data in talk.says(header("RSTATS"))]
    assert said == [b"OK: ", b"RSTA", b"TS\r\n", b"194,", b"64\r"]
